// lighting/blinn as it is, in WGSL.
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

@fragment
fn fragment(@location(0) vPosition: vec3f, @location(1) vNormal: vec3f) -> @location(0) vec4f {
    let n = normalize(vNormal);
    let l = normalize(-light.direction);
    let h = normalize(normalize(-vPosition) + l);
    let diffuse = light.diffuse * material.diffuse * max(dot(l, n), 0.0);
    let specular = light.specular * material.specular * pow(max(dot(n, h), 0.0), material.shininess);
    return vec4f(light.ambient * material.ambient + diffuse + specular, 1.0);
}
