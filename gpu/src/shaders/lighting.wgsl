// Classical lighting: CF = CA + CD + CS. Symbols as in vector.wgsl; p the surface point, atten the light's attenuation.
// requires: vector attenuation

struct Light {
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

struct Falloff {
    kc: f32,
    kl: f32,
    kq: f32,
}

fn lighting_ambient(light: vec3f, material: vec3f) -> vec3f {
    return light * material;
}

fn lighting_ambient_constant(ambient: vec3f, diffuse: vec3f) -> vec3f {
    return ambient + diffuse;
}

fn lighting_incidence(l: vec3f, n: vec3f) -> f32 {
    return max(dot(l, n), 0.0);
}

fn lighting_diffuse_toward(light: vec3f, material: vec3f, l: vec3f, n: vec3f) -> vec3f {
    return light * material * lighting_incidence(l, n);
}

fn lighting_diffuse_travel(light: vec3f, material: vec3f, i: vec3f, n: vec3f) -> vec3f {
    return lighting_diffuse_toward(light, material, -i, n);
}

fn lighting_specular_phong(light: vec3f, material: vec3f, r: vec3f, v: vec3f, shininess: f32) -> vec3f {
    return light * material * vector_lobe(dot(r, v), shininess);
}

fn lighting_specular_blinn(light: vec3f, material: vec3f, n: vec3f, h: vec3f, shininess: f32) -> vec3f {
    return light * material * vector_lobe(dot(n, h), shininess);
}

fn lighting_specular_nonlocal(light: vec3f, material: vec3f, r: vec3f, shininess: f32) -> vec3f {
    return light * material * vector_lobe(r.z, shininess);
}

fn lighting_highlight_phong(n: vec3f, l: vec3f, v: vec3f, shininess: f32) -> f32 {
    return vector_cosine_power(vector_reflect(-l, n), v, shininess);
}

fn lighting_highlight_blinn(n: vec3f, l: vec3f, v: vec3f, shininess: f32) -> f32 {
    return vector_cosine_power(n, vector_halfway(v, l), shininess);
}

fn lighting_highlight_unnormalised(n: vec3f, l: vec3f, v: vec3f, shininess: f32) -> f32 {
    return vector_lobe(dot(n, vector_halfway_unnormalised(v, l)), shininess);
}

fn lighting_gate(n: vec3f, l: vec3f, highlight: f32) -> f32 {
    return select(highlight, 0.0, dot(l, n) <= 0.0);
}

fn lighting_sum_of_terms(light: Light, material: Material, incidence: f32, highlight: f32, atten: f32) -> vec3f {
    let ambient = lighting_ambient(light.ambient, material.ambient);
    let diffuse = light.diffuse * material.diffuse * incidence * atten;
    let specular = light.specular * material.specular * highlight * atten;
    return ambient + diffuse + specular;
}

// The unit vectors at a point.
struct Frame {
    n: vec3f,
    l: vec3f,
    v: vec3f,
}

fn lighting_frame(p: vec3f, normal: vec3f, l: vec3f) -> Frame {
    let n = vector_normalize(normal);
    return Frame(n, l, vector_normalize(-p));
}

fn lighting_lit(light: Light, material: Material, at: Frame, highlight: f32, atten: f32) -> vec4f {
    return vec4f(lighting_sum_of_terms(light, material, lighting_incidence(at.l, at.n), highlight, atten), 1.0);
}

fn lighting_phong(light: Light, material: Material, p: vec3f, normal: vec3f, direction: vec3f) -> vec4f {
    let at = lighting_frame(p, normal, vector_normalize(-direction));
    return lighting_lit(light, material, at, lighting_highlight_phong(at.n, at.l, at.v, material.shininess), 1.0);
}

fn lighting_blinn(light: Light, material: Material, p: vec3f, normal: vec3f, direction: vec3f) -> vec4f {
    let at = lighting_frame(p, normal, vector_normalize(-direction));
    return lighting_lit(light, material, at, lighting_highlight_blinn(at.n, at.l, at.v, material.shininess), 1.0);
}

fn lighting_blinn_unnormalised(light: Light, material: Material, p: vec3f, normal: vec3f, direction: vec3f) -> vec4f {
    let at = lighting_frame(p, normal, vector_normalize(-direction));
    return lighting_lit(light, material, at, lighting_highlight_unnormalised(at.n, at.l, at.v, material.shininess), 1.0);
}

fn lighting_phong_gated(light: Light, material: Material, p: vec3f, normal: vec3f, direction: vec3f) -> vec4f {
    let at = lighting_frame(p, normal, vector_normalize(-direction));
    let highlight = lighting_highlight_phong(at.n, at.l, at.v, material.shininess);
    return lighting_lit(light, material, at, lighting_gate(at.n, at.l, highlight), 1.0);
}

fn lighting_phong_unit_light(light: Light, material: Material, p: vec3f, normal: vec3f, direction: vec3f) -> vec4f {
    let at = lighting_frame(p, normal, -direction);
    return lighting_lit(light, material, at, lighting_highlight_phong(at.n, at.l, at.v, material.shininess), 1.0);
}

fn lighting_phong_nonlocal(light: Light, material: Material, normal: vec3f, direction: vec3f) -> vec4f {
    let n = vector_normalize(normal);
    let at = Frame(n, -direction, vec3f(0.0, 0.0, 1.0));
    return lighting_lit(light, material, at, vector_lobe(vector_reflect(-at.l, n).z, material.shininess), 1.0);
}

fn lighting_attenuation(falloff: Falloff, position: vec3f, p: vec3f) -> f32 {
    return attenuation_point(falloff.kc, falloff.kl, falloff.kq, position, p);
}

fn lighting_point_phong(
    light: Light, material: Material, p: vec3f, normal: vec3f, position: vec3f, falloff: Falloff,
) -> vec4f {
    let at = lighting_frame(p, normal, vector_toward(position, p));
    let highlight = lighting_highlight_phong(at.n, at.l, at.v, material.shininess);
    return lighting_lit(light, material, at, highlight, lighting_attenuation(falloff, position, p));
}

fn lighting_point_blinn(
    light: Light, material: Material, p: vec3f, normal: vec3f, position: vec3f, falloff: Falloff,
) -> vec4f {
    let at = lighting_frame(p, normal, vector_toward(position, p));
    let highlight = lighting_highlight_blinn(at.n, at.l, at.v, material.shininess);
    return lighting_lit(light, material, at, highlight, lighting_attenuation(falloff, position, p));
}

fn lighting_point_opengl(
    light: Light, material: Material, p: vec3f, normal: vec3f, position: vec3f, falloff: Falloff, alpha: f32,
) -> vec4f {
    let at = lighting_frame(p, normal, vector_toward(position, p));
    let atten = lighting_attenuation(falloff, position, p);
    let highlight = lighting_gate(at.n, at.l, lighting_highlight_blinn(at.n, at.l, at.v, material.shininess));
    let ambient = lighting_ambient(light.ambient, material.ambient) * atten;
    let diffuse = light.diffuse * material.diffuse * lighting_incidence(at.l, at.n) * atten;
    let specular = light.specular * material.specular * highlight * atten;
    return vec4f(ambient + diffuse + specular, alpha);
}

fn lighting_spot(
    light: Light, material: Material, p: vec3f, normal: vec3f, position: vec3f, axis: vec3f, falloff: Falloff,
    cutoff_cosine: f32, exponent: f32,
) -> vec4f {
    let at = lighting_frame(p, normal, vector_toward(position, p));
    let cone = attenuation_spot_exponent(at.l, vector_normalize(axis), cutoff_cosine, exponent);
    let highlight = lighting_highlight_phong(at.n, at.l, at.v, material.shininess);
    return lighting_lit(light, material, at, highlight, cone * lighting_attenuation(falloff, position, p));
}

fn lighting_scalar_material(
    ambient_color: vec3f, light_color: vec3f, ka: f32, kd: f32, ks: f32, shininess: f32,
    p: vec3f, normal: vec3f, position: vec3f,
) -> vec4f {
    let n = vector_normalize(normal);
    let l = vector_toward(position, p);
    let v = vector_normalize(-p);
    let ambient = ka * ambient_color;
    let diffuse = kd * light_color * lighting_incidence(l, n);
    let specular = ks * light_color * lighting_highlight_phong(n, l, v, shininess);
    return vec4f(ambient + diffuse + specular, 1.0);
}

fn lighting_two_lights(
    ambient: vec4f, color0: vec4f, color1: vec4f, diffuse: vec4f, specular: vec4f, shininess: f32,
    p: vec3f, normal: vec3f, direction: vec3f, position: vec3f,
) -> vec4f {
    let n = vector_normalize(normal);
    let v = vector_normalize(-p);
    let l0 = vector_normalize(direction);
    let l1 = vector_toward(position, p);
    let lit0 = diffuse * color0 * lighting_incidence(l0, n)
        + specular * color0 * lighting_highlight_blinn(n, l0, v, shininess);
    let lit1 = diffuse * color1 * lighting_incidence(l1, n)
        + specular * color1 * lighting_highlight_blinn(n, l1, v, shininess);
    return ambient + lit0 + lit1;
}

fn lighting_sum(
    emissive: vec3f, ambient: vec3f, diffuse0: vec3f, diffuse1: vec3f, specular0: vec3f, specular1: vec3f,
) -> vec3f {
    return emissive + ambient + diffuse0 + specular0 + diffuse1 + specular1;
}

fn lighting_highlight_plastic(light: vec3f, surface: vec3f, ks: f32, fs: f32) -> vec3f {
    return light * (ks * fs);
}

fn lighting_highlight_metal(light: vec3f, surface: vec3f, ks: f32, fs: f32) -> vec3f {
    return light * surface * (ks * fs);
}

// Shading frequency, for one white point light and a material of kd, ks and shininess.

fn lighting_intensity(n: vec3f, l: vec3f, v: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    return kd * lighting_incidence(l, n) + ks * lighting_highlight_phong(n, l, v, shininess);
}

fn lighting_at_vertex(p: vec3f, normal: vec3f, position: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    let n = vector_normalize(normal);
    return lighting_intensity(n, vector_toward(position, p), vector_normalize(-p), kd, ks, shininess);
}

fn lighting_gouraud(
    pa: vec3f, na: vec3f, pb: vec3f, nb: vec3f, t: f32, position: vec3f, kd: f32, ks: f32, shininess: f32,
) -> f32 {
    let a = lighting_at_vertex(pa, na, position, kd, ks, shininess);
    let b = lighting_at_vertex(pb, nb, position, kd, ks, shininess);
    return mix(a, b, t);
}

fn lighting_phong_shading(
    pa: vec3f, na: vec3f, pb: vec3f, nb: vec3f, t: f32, position: vec3f, kd: f32, ks: f32, shininess: f32,
) -> f32 {
    return lighting_at_vertex(mix(pa, pb, t), mix(na, nb, t), position, kd, ks, shininess);
}

fn lighting_phong_interpolated(
    pa: vec3f, na: vec3f, pb: vec3f, nb: vec3f, t: f32, position: vec3f, kd: f32, ks: f32, shininess: f32,
) -> f32 {
    let n = vector_normalize(mix(na, nb, t));
    let l = vector_normalize(mix(position - pa, position - pb, t));
    let v = vector_normalize(mix(-pa, -pb, t));
    return lighting_intensity(n, l, v, kd, ks, shininess);
}

fn lighting_flat(a: vec3f, b: vec3f, c: vec3f, position: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    let n = vector_face_normal(a, b, c);
    return lighting_intensity(n, vector_toward(position, a), vector_normalize(-a), kd, ks, shininess);
}

// Other forms of the same: some lose what others keep.

fn lighting_cosine_power(a: vec3f, b: vec3f, exponent: f32) -> f32 {
    return vector_cosine_power(a, b, exponent);
}

fn lighting_cosine_power_unguarded(a: vec3f, b: vec3f, exponent: f32) -> f32 {
    return pow(dot(a, b), exponent);
}

// stable form of: lighting_cosine_power lighting_cosine_power_unguarded
fn lighting_cosine_power_by_chord(a: vec3f, b: vec3f, exponent: f32) -> f32 {
    return vector_cosine_power_by_chord(a, b, exponent);
}

fn lighting_blinn_stable(light: Light, material: Material, p: vec3f, normal: vec3f, direction: vec3f) -> vec4f {
    let n = vector_normalize_scaled(normal);
    let l = vector_normalize_scaled(-direction);
    let h = vector_normalize_scaled(vector_normalize_scaled(-p) + l);
    let highlight = lighting_gate(n, l, vector_cosine_power_by_chord(n, h, material.shininess));
    return vec4f(lighting_sum_of_terms(light, material, lighting_incidence(l, n), highlight, 1.0), 1.0);
}
