// A light's own LA * MA.

//@ at shine_ambient
let ambient = lighting_ambient(colors.ambient, scene_material.ambient);
//@ choose weakened: vec3f from weakened_ambient else ambient
(*sum).diffuse += weakened;
