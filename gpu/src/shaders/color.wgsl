// Colours and how they are stored: c linear, e sRGB-encoded, byte a whole number from 0 to 255.

fn color_to_unorm8(c: f32) -> f32 {
    return round(255.0 * clamp(c, 0.0, 1.0));
}

fn color_from_unorm8(byte: f32) -> f32 {
    return byte / 255.0;
}

fn color_srgb_encode_component(c: f32) -> f32 {
    if c <= 0.0031308 {
        return 12.92 * c;
    }
    return 1.055 * pow(c, 1.0 / 2.4) - 0.055;
}

fn color_srgb_decode_component(e: f32) -> f32 {
    if e <= 0.04045 {
        return e / 12.92;
    }
    return pow((e + 0.055) / 1.055, 2.4);
}

fn color_srgb_encode(c: vec4f) -> vec4f {
    return vec4f(
        color_srgb_encode_component(c.r),
        color_srgb_encode_component(c.g),
        color_srgb_encode_component(c.b),
        c.a,
    );
}

fn color_srgb_decode(e: vec4f) -> vec4f {
    return vec4f(
        color_srgb_decode_component(e.r),
        color_srgb_decode_component(e.g),
        color_srgb_decode_component(e.b),
        e.a,
    );
}

fn color_modulate(texel: vec4f, color: vec4f) -> vec4f {
    return texel * color;
}

fn color_replace(texel: vec4f, color: vec4f) -> vec4f {
    return texel;
}

fn color_sum(a: vec3f, b: vec3f) -> vec3f {
    return clamp(a + b, vec3f(0.0), vec3f(1.0));
}

fn color_uniform(color: vec3f) -> vec4f {
    return vec4f(color, 1.0);
}

fn color_per_vertex(weights: vec3f, a: vec3f, b: vec3f, c: vec3f) -> vec4f {
    return vec4f(weights.x * a + weights.y * b + weights.z * c, 1.0);
}

// Other forms of the same: some lose what others keep.

fn color_gamma_encode(c: f32) -> f32 {
    return pow(c, 1.0 / 2.2);
}

fn color_srgb_encode_power(c: f32) -> f32 {
    return 1.055 * pow(c, 1.0 / 2.4) - 0.055;
}
