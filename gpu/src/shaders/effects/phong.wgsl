// Lit at the fragments, with the interpolated normal normalised again. What fog hides is not lit.

fn scene_lit_at_fragment(
    in: SceneVaryings,
    //@ when fog
    f: f32,
    //@ end
) -> vec3f {
    //@ if fog
    if f <= 0.0 {
        return vec3f(0.0);
    }
    //@ end
    return scene_lit(
        //@ when lit_position
        in.p,
        //@ end
        //@ when normals
        vector_normalize(in.normal),
        //@ end
    );
}

//@ at fragment_normal
vector_normalize(in.normal)

//@ at lit
scene_lit_at_fragment(
    in,
    //@ when fog
    f,
    //@ end
)
