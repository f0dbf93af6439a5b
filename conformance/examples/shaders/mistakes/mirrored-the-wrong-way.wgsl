// lighting/phong: WGSL's reflect takes the way in which the light comes, not the one towards the light.
struct Light {
    direction: vec3f,
    ambient: vec3f,
    diffuse: vec3f,
    specular: vec3f,
}

struct Material {
    ambient: vec3f,
    diffuse: vec3f,
    specular: vec3f,
    shininess: f32,
}

@group(0) @binding(0) var<uniform> light: Light;
@group(0) @binding(1) var<uniform> material: Material;

struct Varyings {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

@fragment
fn fragment(at: Varyings) -> @location(0) vec4f {
    let n = normalize(at.normal);
    let l = normalize(-light.direction);
    let v = normalize(-at.position);
    let r = reflect(l, n);
    let diffuse = light.diffuse * material.diffuse * max(dot(n, l), 0.0);
    let specular = light.specular * material.specular * pow(max(dot(r, v), 0.0), material.shininess);
    return vec4f(light.ambient * material.ambient + diffuse + specular, 1.0);
}
