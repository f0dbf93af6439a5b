// Programmable blending: what the fixed-function unit computes, written out. Nothing is clamped here.
// src and dst the colours, constant the blend constant; factors and equations by their codes in the scene's tables.
// requires: elementary

fn blend_factor(code: u32, src: vec4f, dst: vec4f, constant: vec4f, saturation: f32) -> vec4f {
    switch code {
        case 0u: { return vec4f(0.0); }
        case 1u: { return vec4f(1.0); }
        case 2u: { return src; }
        case 3u: { return 1.0 - src; }
        case 4u: { return dst; }
        case 5u: { return 1.0 - dst; }
        case 6u: { return vec4f(src.a); }
        case 7u: { return vec4f(1.0 - src.a); }
        case 8u: { return vec4f(dst.a); }
        case 9u: { return vec4f(1.0 - dst.a); }
        case 10u: { return constant; }
        case 11u: { return 1.0 - constant; }
        case 12u: { return vec4f(constant.a); }
        case 13u: { return vec4f(1.0 - constant.a); }
        default: { return vec4f(vec3f(saturation), 1.0); }
    }
}

fn blend_saturation(src: vec4f, dst: vec4f) -> f32 {
    return min(src.a, 1.0 - dst.a);
}

fn blend_saturation_source_only(src: vec4f) -> f32 {
    return min(src.a, 1.0 - src.a);
}

fn blend_combine(equation: u32, src: vec4f, s: vec4f, dst: vec4f, d: vec4f) -> vec4f {
    switch equation {
        case 0u: { return src * s + dst * d; }
        case 1u: { return src * s - dst * d; }
        case 2u: { return dst * d - src * s; }
        case 3u: { return min(src, dst); }
        default: { return max(src, dst); }
    }
}

fn blend_state(equation: u32, src_factor: u32, dst_factor: u32, src: vec4f, dst: vec4f, constant: vec4f) -> vec4f {
    let saturation = blend_saturation(src, dst);
    let s = blend_factor(src_factor, src, dst, constant, saturation);
    let d = blend_factor(dst_factor, src, dst, constant, saturation);
    return blend_combine(equation, src, s, dst, d);
}

fn blend_saturate_source_only(src: vec4f, dst: vec4f) -> vec4f {
    let s = blend_factor(14u, src, dst, vec4f(0.0), blend_saturation_source_only(src));
    return blend_combine(0u, src, s, dst, vec4f(1.0));
}

// The named modes, on a back buffer without alpha.

fn blend_solid(src: vec4f, dst: vec3f) -> vec3f {
    return src.rgb;
}

fn blend_alpha(src: vec4f, dst: vec3f) -> vec3f {
    return src.rgb * src.a + dst * (1.0 - src.a);
}

fn blend_mul(src: vec4f, dst: vec3f) -> vec3f {
    return src.rgb * dst;
}

fn blend_additive(src: vec4f, dst: vec3f) -> vec3f {
    return src.rgb * src.a + dst;
}

// On a target of [0, 1].
fn blend_alpha_clamped(src: vec4f, dst: vec4f) -> vec4f {
    let s = saturate(src);
    let d = saturate(dst);
    return saturate(s * s.a + d * (1.0 - s.a));
}

// Other forms of the same: some lose what others keep.

// stable form of: blend_over_incremental
fn blend_over(src: vec4f, dst: vec3f) -> vec3f {
    return src.rgb * src.a + dst * (1.0 - src.a);
}

fn blend_over_incremental(src: vec4f, dst: vec3f) -> vec3f {
    return dst + src.a * (src.rgb - dst);
}

fn blend_opacity_of_layers(alpha: f32, layers: f32) -> f32 {
    return 1.0 - pow(1.0 - alpha, layers);
}

// stable form of: blend_opacity_of_layers
fn blend_opacity_of_layers_expm1(alpha: f32, layers: f32) -> f32 {
    return -elementary_exp_m1(layers * elementary_ln_1p(-alpha));
}

fn blend_unpremultiply(color: vec3f, alpha: f32) -> vec3f {
    return color / alpha;
}

// stable form of: blend_unpremultiply
fn blend_unpremultiply_guarded(color: vec3f, alpha: f32) -> vec3f {
    if alpha < 0x1p-126 {
        return vec3f(0.0);
    }
    return color / alpha;
}

fn blend_subtract(src: f32, s: f32, dst: f32, d: f32) -> f32 {
    return src * s - dst * d;
}

// stable form of: blend_subtract
fn blend_subtract_compensated(src: f32, s: f32, dst: f32, d: f32) -> f32 {
    return elementary_difference_of_products(src, s, dst, d);
}
