// Lit at the fragments, with the interpolated normal normalised again. What fog hides is not lit.

fn scene_lit_at_fragment(
    //@ when lit_in
    in: SceneVaryings,
    //@ end
    //@ when fog
    f: f32,
    //@ end
) -> vec3f {
    var rgb = vec3f(0.0);
    //@ when fog
    // Every fragment's x is positive. Mesa 22.3's lavapipe crashes where a condition begins with a uniform, which f
    // does, and loops on uniforms follow: it takes the condition for one that it can decide before it draws.
    if (in.clip.x >= 0.0) & (f > 0.0)
    //@ end
    {
        rgb = scene_lit(
            //@ when vectors_in
            in,
            //@ end
            //@ when lit_position
            in.p,
            //@ end
            //@ when normals
            vector_normalize(in.normal),
            //@ end
        );
    }
    return rgb;
}

//@ at fragment_normal
vector_normalize(in.normal)

//@ at lit
scene_lit_at_fragment(
    //@ when lit_in
    in,
    //@ end
    //@ when fog
    f,
    //@ end
)
