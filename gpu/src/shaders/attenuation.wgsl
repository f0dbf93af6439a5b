// Attenuation with distance and a spotlight's cone.
// d distance to the light, kc kl kq the coefficients, l the unit vector to the light, axis the spotlight's direction.
// requires: vector

fn attenuation_polynomial(kc: f32, kl: f32, kq: f32, d: f32) -> f32 {
    return 1.0 / (kc + d * (kl + d * kq));
}

fn attenuation_constant(d: f32) -> f32 {
    return attenuation_polynomial(1.0, 0.0, 0.0, d);
}

fn attenuation_linear(d: f32) -> f32 {
    return attenuation_polynomial(0.0, 1.0, 0.0, d);
}

fn attenuation_square(d: f32) -> f32 {
    return attenuation_polynomial(0.0, 0.0, 1.0, d);
}

fn attenuation_point(kc: f32, kl: f32, kq: f32, light: vec3f, p: vec3f) -> f32 {
    return attenuation_polynomial(kc, kl, kq, distance(light, p));
}

fn attenuation_cone(cosine: f32, cutoff_cosine: f32) -> f32 {
    return select(1.0, 0.0, cosine < cutoff_cosine);
}

fn attenuation_spot_exponent(l: vec3f, axis: vec3f, cutoff_cosine: f32, exponent: f32) -> f32 {
    let cosine = dot(-l, axis);
    if attenuation_cone(cosine, cutoff_cosine) <= 0.0 {
        return 0.0;
    }
    return vector_lobe(cosine, exponent);
}

fn attenuation_spot_cutoff(l: vec3f, axis: vec3f, cutoff_cosine: f32) -> f32 {
    return attenuation_cone(dot(-l, axis), cutoff_cosine);
}

// Other forms of the same: some lose what others keep.

fn attenuation_polynomial_expanded(kc: f32, kl: f32, kq: f32, d: f32) -> f32 {
    return 1.0 / (kc + kl * d + kq * (d * d));
}

// stable form of: attenuation_polynomial attenuation_polynomial_expanded
fn attenuation_polynomial_bounded(kc: f32, kl: f32, kq: f32, d: f32) -> f32 {
    return 1.0 / clamp(kc + d * (kl + d * kq), 0x1p-126, 0x1p126);
}

// stable form of: attenuation_point
fn attenuation_point_scaled(kc: f32, kl: f32, kq: f32, light: vec3f, p: vec3f) -> f32 {
    return attenuation_polynomial_bounded(kc, kl, kq, vector_length_scaled(light - p));
}

// stable form of: attenuation_spot_exponent
fn attenuation_spot_exponent_by_chord(l: vec3f, axis: vec3f, cutoff_cosine: f32, exponent: f32) -> f32 {
    if attenuation_cone(dot(-l, axis), cutoff_cosine) <= 0.0 {
        return 0.0;
    }
    return vector_cosine_power_by_chord(-l, axis, exponent);
}
