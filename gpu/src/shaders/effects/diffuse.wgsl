// CD = LD * MD * max(l·n, 0).

//@ at shine_diffuse
(*sum).diffuse += colors.diffuse * scene_material.diffuse * incidence
    //@ when weighted
    * weight
    //@ end
    ;
