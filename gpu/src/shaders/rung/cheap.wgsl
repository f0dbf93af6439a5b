// Approximations that cost little, in binary32: Schlick's power, exponentials and logarithms by the bits of a number, and the
// inverse root by its bits with one step of Newton's.

// t / (n - nt + t) for t in [0, 1] (Schlick 1994); of other bases by the bits.
fn rung_pow_1(base: f32, exponent: f32) -> f32 {
    if base <= 1.0 && exponent > 0.0 {
        return base / (exponent - exponent * base + base);
    }
    return rung_exp2_1(exponent * rung_log2_1(base));
}

// The exponent, and t(1.3465 - 0.3465 t) for log2(1 + t): within 0.008.
fn rung_log2_1(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    let t = bitcast<f32>((bits & 0x007fffffu) | 0x3f800000u) - 1.0;
    return f32(i32(bits >> 23u) - 127) + t * (1.3465 - 0.3465 * t);
}

fn rung_log_1(x: f32) -> f32 {
    return rung_log2_1(x) * 0.6931472;
}

// A power of two by its bits, and 1 + t(0.6565 + 0.3435 t) for 2^t: within 0.3 %. 0 below 2^-126.
fn rung_exp2_1(x: f32) -> f32 {
    let held = clamp(x, -127.0, 127.99999);
    let whole = floor(held);
    let t = held - whole;
    return bitcast<f32>(u32(i32(whole) + 127) << 23u) * (1.0 + t * (0.6565 + 0.3435 * t));
}

fn rung_exp_1(x: f32) -> f32 {
    return rung_exp2_1(x * 1.442695);
}

// Within 0.2 %.
fn rung_inverseSqrt_1(x: f32) -> f32 {
    let y = bitcast<f32>(0x5f3759dfu - (bitcast<u32>(x) >> 1u));
    return y * (1.5 - 0.5 * x * y * y);
}

fn rung_normalize_2(v: vec2f) -> vec2f {
    return v * rung_inverseSqrt_1(dot(v, v));
}

fn rung_normalize_3(v: vec3f) -> vec3f {
    return v * rung_inverseSqrt_1(dot(v, v));
}

fn rung_normalize_4(v: vec4f) -> vec4f {
    return v * rung_inverseSqrt_1(dot(v, v));
}
