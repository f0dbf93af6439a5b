// lighting/diffuse-toward: the back of a surface is lit as its front is.
fn diffuse(n: vec3f, l: vec3f, lightColor: vec3f, albedo: vec3f) -> vec3f {
    return lightColor * albedo * abs(dot(n, l));
}
