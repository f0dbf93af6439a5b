// Techniques that are measured against each other: the functions of a group take the same numbers.
// n normal, l surface to light, v surface to eye, i the direction that light travels in, p the point, all in eye space.
// requires: lighting fog interpolation

fn technique_viewer_local(p: vec3f, normal: vec3f, i: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    return lighting_intensity(vector_normalize(normal), vector_normalize(-i), vector_normalize(-p), kd, ks, shininess);
}

fn technique_viewer_nonlocal(p: vec3f, normal: vec3f, i: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    let n = vector_normalize(normal);
    let l = vector_normalize(-i);
    return kd * lighting_incidence(l, n) + ks * vector_lobe(vector_reflect(-l, n).z, shininess);
}

fn technique_light_assumed_unit(p: vec3f, normal: vec3f, i: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    return lighting_intensity(vector_normalize(normal), -i, vector_normalize(-p), kd, ks, shininess);
}

fn technique_highlight_phong_normalised(p: vec3f, normal: vec3f, i: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    let n = vector_normalize(normal);
    let l = vector_normalize(-i);
    let r = vector_normalize(vector_reflect(-l, n));
    return kd * lighting_incidence(l, n) + ks * vector_cosine_power(r, vector_normalize(-p), shininess);
}

fn technique_highlight_blinn(p: vec3f, normal: vec3f, i: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    let n = vector_normalize(normal);
    let l = vector_normalize(-i);
    return kd * lighting_incidence(l, n) + ks * lighting_highlight_blinn(n, l, vector_normalize(-p), shininess);
}

fn technique_highlight_blinn_fourfold(p: vec3f, normal: vec3f, i: vec3f, kd: f32, ks: f32, shininess: f32) -> f32 {
    return technique_highlight_blinn(p, normal, i, kd, ks, 4.0 * shininess);
}

fn technique_power(a: vec3f, b: vec3f, exponent: f32) -> f32 {
    return vector_cosine_power(a, b, exponent);
}

// stable form of: technique_power
fn technique_power_by_chord(a: vec3f, b: vec3f, exponent: f32) -> f32 {
    return vector_cosine_power_by_chord(a, b, exponent);
}

// t/(n − nt + t), which has the slope of t^n at t = 1 (Schlick 1994).
fn technique_power_by_schlick(a: vec3f, b: vec3f, exponent: f32) -> f32 {
    let t = max(dot(a, b), 0.0);
    return t / (exponent - exponent * t + t);
}

fn technique_distance_radial(p: vec3f, density: f32) -> f32 {
    return fog_exp_factor(fog_radial_distance(p), density);
}

fn technique_distance_planar(p: vec3f, density: f32) -> f32 {
    return fog_exp_factor(fog_planar_distance(p), density);
}

// A span of n pixels, each computed, as a number that depends on all: a ramp's greatest value is that of its last pixel.
fn technique_span(a: f32, b: f32, n: u32) -> f32 {
    var greatest = a;
    for (var k = 1u; k < n; k++) {
        greatest = max(greatest, interpolation_mix(a, b, f32(k) / f32(n)));
    }
    return greatest;
}

fn technique_span_by_differences(a: f32, b: f32, n: u32) -> f32 {
    let step = (b - a) / f32(n);
    var value = a;
    var greatest = a;
    for (var k = 1u; k < n; k++) {
        value += step;
        greatest = max(greatest, value);
    }
    return greatest;
}

fn technique_span_16(a: f32, b: f32) -> f32 {
    return technique_span(a, b, 16u);
}

fn technique_span_16_by_differences(a: f32, b: f32) -> f32 {
    return technique_span_by_differences(a, b, 16u);
}

fn technique_span_64(a: f32, b: f32) -> f32 {
    return technique_span(a, b, 64u);
}

fn technique_span_64_by_differences(a: f32, b: f32) -> f32 {
    return technique_span_by_differences(a, b, 64u);
}

fn technique_span_256(a: f32, b: f32) -> f32 {
    return technique_span(a, b, 256u);
}

fn technique_span_256_by_differences(a: f32, b: f32) -> f32 {
    return technique_span_by_differences(a, b, 256u);
}

fn technique_span_1024(a: f32, b: f32) -> f32 {
    return technique_span(a, b, 1024u);
}

fn technique_span_1024_by_differences(a: f32, b: f32) -> f32 {
    return technique_span_by_differences(a, b, 1024u);
}

fn technique_span_4096(a: f32, b: f32) -> f32 {
    return technique_span(a, b, 4096u);
}

fn technique_span_4096_by_differences(a: f32, b: f32) -> f32 {
    return technique_span_by_differences(a, b, 4096u);
}
