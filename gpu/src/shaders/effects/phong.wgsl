// Lit at the fragments, with the interpolated normal normalised again. What linear fog hides is not lit; exponential fog
// hides nothing before its factor underflows, at density times distance of 104, and Mesa 22.3.6 crashes over a branch on it.

fn scene_lit_at_fragment(
    in: SceneVaryings,
    //@ when fog_linear
    f: f32,
    //@ end
) -> vec3f {
    //@ if fog_linear
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
    //@ when fog_linear
    f,
    //@ end
)
