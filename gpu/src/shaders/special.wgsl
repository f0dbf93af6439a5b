// NaN, infinity, subnormals and signed zero as data: one operation a function, its operands known at run time alone, so
// that no compiler folds it. What comes of them is on record by driver; see conformance/src/special.

fn special_keep(x: f32) -> f32 {
    return x;
}

fn special_add(x: f32, y: f32) -> f32 {
    return x + y;
}

fn special_subtract(x: f32, y: f32) -> f32 {
    return x - y;
}

fn special_multiply(x: f32, y: f32) -> f32 {
    return x * y;
}

fn special_divide(x: f32, y: f32) -> f32 {
    return x / y;
}

fn special_negate(x: f32) -> f32 {
    return -x;
}

fn special_fma(x: f32, y: f32, z: f32) -> f32 {
    return fma(x, y, z);
}

fn special_multiply_add(x: f32, y: f32, z: f32) -> f32 {
    return x * y + z;
}

fn special_min(x: f32, y: f32) -> f32 {
    return min(x, y);
}

fn special_max(x: f32, y: f32) -> f32 {
    return max(x, y);
}

fn special_clamp(x: f32, low: f32, high: f32) -> f32 {
    return clamp(x, low, high);
}

fn special_saturate(x: f32) -> f32 {
    return saturate(x);
}

fn special_select(x: f32, y: f32, which: f32) -> f32 {
    return select(x, y, which > 0.5);
}

fn special_abs(x: f32) -> f32 {
    return abs(x);
}

fn special_sign(x: f32) -> f32 {
    return sign(x);
}

fn special_floor(x: f32) -> f32 {
    return floor(x);
}

fn special_ceil(x: f32) -> f32 {
    return ceil(x);
}

fn special_fract(x: f32) -> f32 {
    return fract(x);
}

fn special_round(x: f32) -> f32 {
    return round(x);
}

fn special_trunc(x: f32) -> f32 {
    return trunc(x);
}

fn special_mix(x: f32, y: f32, t: f32) -> f32 {
    return mix(x, y, t);
}

fn special_step(edge: f32, x: f32) -> f32 {
    return step(edge, x);
}

fn special_smoothstep(low: f32, high: f32, x: f32) -> f32 {
    return smoothstep(low, high, x);
}

fn special_sqrt(x: f32) -> f32 {
    return sqrt(x);
}

fn special_inverse_sqrt(x: f32) -> f32 {
    return inverseSqrt(x);
}

fn special_exp(x: f32) -> f32 {
    return exp(x);
}

fn special_exp2(x: f32) -> f32 {
    return exp2(x);
}

fn special_log(x: f32) -> f32 {
    return log(x);
}

fn special_pow(x: f32, y: f32) -> f32 {
    return pow(x, y);
}

fn special_normalize(x: f32, y: f32, z: f32) -> f32 {
    return normalize(vec3f(x, y, z)).x;
}

fn special_length(x: f32, y: f32, z: f32) -> f32 {
    return length(vec3f(x, y, z));
}

fn special_dot(x: f32, y: f32, z: f32) -> f32 {
    return dot(vec3f(x, y, z), vec3f(x, y, z));
}

// Comparisons: 1 where they hold.

fn special_equal(x: f32, y: f32) -> u32 {
    return select(0u, 1u, x == y);
}

fn special_equals_itself(x: f32) -> u32 {
    return select(0u, 1u, x == x);
}

fn special_differs_from_itself(x: f32) -> u32 {
    return select(0u, 1u, x != x);
}

fn special_less(x: f32, y: f32) -> u32 {
    return select(0u, 1u, x < y);
}

fn special_not_less(x: f32, y: f32) -> u32 {
    return select(0u, 1u, !(x < y));
}

fn special_is_nan_by_bits(x: f32) -> u32 {
    return select(0u, 1u, (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u);
}

// Conversions.

fn special_to_u32(x: f32) -> u32 {
    return u32(x);
}

fn special_to_i32(x: f32) -> u32 {
    return bitcast<u32>(i32(x));
}

fn special_from_u32(x: u32) -> f32 {
    return f32(x);
}

fn special_quantize(x: f32) -> f32 {
    return quantizeToF16(x);
}

fn special_pack_unorm(x: f32) -> u32 {
    return pack4x8unorm(vec4f(x, 0.0, 0.5, 1.0));
}

fn special_pack_half(x: f32) -> u32 {
    return pack2x16float(vec2f(x, 1.0));
}

fn special_unpack_half(bits: u32) -> f32 {
    return unpack2x16float(bits).x;
}
