// What drivers lack in f64 or get wrong: exponentials, logarithms and powers. Powers of two are made of the bits of an f32.
// Relative errors of a few 2^-52; of exp besides |x| times 2^-53, as a compiler may join the two parts of ln 2, and of a power
// |exponent * log(base)| times that. No branches: Mesa 22.3's lavapipe crashes where one on what a uniform goes into is followed
// by loops on uniforms.

// A number as a sum of three f32.
fn rung_parts(x: f64) -> vec3f {
    let first = f32(x);
    if (bitcast<u32>(first) & 0x7f800000u) == 0x7f800000u {
        return vec3f(first, 0.0, 0.0);
    }
    let left = x - f64(first);
    let second = f32(left);
    return vec3f(first, second, f32(left - f64(second)));
}

// 2^k for k from -126 to 127.
fn rung_small_power(k: i32) -> f64 {
    return f64(bitcast<f32>(u32(k + 127) << 23u));
}

// 2^k for k from -1008 to 1023.
fn rung_power(k: i32) -> f64 {
    let eighth = k / 8;
    let p = rung_small_power(eighth);
    let p2 = p * p;
    let p4 = p2 * p2;
    return p4 * p4 * rung_small_power(k - 8 * eighth);
}

fn rung_infinity() -> f64 {
    let great = rung_power(1000);
    return great * great;
}

// exp(r) - 1 for |r| up to 0.35.
fn rung_exp_m1_series(r: f64) -> f64 {
    var p = 1.1470745597729725e-11lf;
    p = p * r + 1.6059043836821613e-10lf;
    p = p * r + 2.08767569878681e-09lf;
    p = p * r + 2.505210838544172e-08lf;
    p = p * r + 2.755731922398589e-07lf;
    p = p * r + 2.7557319223985893e-06lf;
    p = p * r + 2.48015873015873e-05lf;
    p = p * r + 0.0001984126984126984lf;
    p = p * r + 0.001388888888888889lf;
    p = p * r + 0.008333333333333333lf;
    p = p * r + 0.041666666666666664lf;
    p = p * r + 0.16666666666666666lf;
    p = p * r + 0.5lf;
    return r + r * r * p;
}

// 2 atanh(s) for |s| up to 0.18.
fn rung_atanh_series(s: f64) -> f64 {
    let z = s * s;
    var p = 0.04lf;
    p = p * z + 0.043478260869565216lf;
    p = p * z + 0.047619047619047616lf;
    p = p * z + 0.05263157894736842lf;
    p = p * z + 0.058823529411764705lf;
    p = p * z + 0.06666666666666667lf;
    p = p * z + 0.07692307692307693lf;
    p = p * z + 0.09090909090909091lf;
    p = p * z + 0.1111111111111111lf;
    p = p * z + 0.14285714285714285lf;
    p = p * z + 0.2lf;
    p = p * z + 0.3333333333333333lf;
    return 2.0lf * s + 2.0lf * s * z * p;
}

fn rung_exp_1(given: f64) -> f64 {
    let x = clamp(given, -698.0lf, 709.0lf);
    let k = floor(x * 1.4426950408889634lf + 0.5lf);
    let r = (x - k * 0.6931471803691238lf) - k * 1.9082149292705877e-10lf;
    let power = (1.0lf + rung_exp_m1_series(r)) * rung_power(i32(k));
    return select(select(power, rung_infinity(), given > 709.0lf), 0.0lf, given < -698.0lf);
}

fn rung_exp2_1(given: f64) -> f64 {
    let x = clamp(given, -1007.0lf, 1023.0lf);
    let k = floor(x + 0.5lf);
    let power = (1.0lf + rung_exp_m1_series((x - k) * 0.6931471805599453lf)) * rung_power(i32(k));
    return select(select(power, rung_infinity(), given > 1023.0lf), 0.0lf, given < -1007.0lf);
}

fn rung_log_1(x: f64) -> f64 {
    var m = x;
    var e = 0;
    var is_far = false;
    is_far = m >= 1.3407807929942597e+154lf;
    m *= select(1.0lf, 7.458340731200207e-155lf, is_far);
    e += select(0, 512, is_far);
    is_far = m < 7.458340731200207e-155lf;
    m *= select(1.0lf, 1.3407807929942597e+154lf, is_far);
    e -= select(0, 512, is_far);
    is_far = m >= 1.157920892373162e+77lf;
    m *= select(1.0lf, 8.636168555094445e-78lf, is_far);
    e += select(0, 256, is_far);
    is_far = m < 8.636168555094445e-78lf;
    m *= select(1.0lf, 1.157920892373162e+77lf, is_far);
    e -= select(0, 256, is_far);
    is_far = m >= 3.402823669209385e+38lf;
    m *= select(1.0lf, 2.938735877055719e-39lf, is_far);
    e += select(0, 128, is_far);
    is_far = m < 2.938735877055719e-39lf;
    m *= select(1.0lf, 3.402823669209385e+38lf, is_far);
    e -= select(0, 128, is_far);
    is_far = m >= 1.8446744073709552e+19lf;
    m *= select(1.0lf, 5.421010862427522e-20lf, is_far);
    e += select(0, 64, is_far);
    is_far = m < 5.421010862427522e-20lf;
    m *= select(1.0lf, 1.8446744073709552e+19lf, is_far);
    e -= select(0, 64, is_far);
    let k = i32(bitcast<u32>(f32(m)) >> 23u) - 127;
    m *= rung_small_power(clamp(-k, -126, 127));
    let is_above = m > 1.4142135623730951lf;
    m *= select(1.0lf, 0.5lf, is_above);
    e += k + select(0, 1, is_above);
    let s = (m - 1.0lf) / (m + 1.0lf);
    let log = f64(e) * 0.6931471803691238lf + (f64(e) * 1.9082149292705877e-10lf + rung_atanh_series(s));
    // Of 0 minus infinity, of what is negative no number, of infinity itself.
    let lowest = select(sqrt(x), -rung_infinity(), x == 0.0lf);
    return select(select(log, lowest, x <= 0.0lf), x, x > 1.7e308lf);
}

fn rung_log2_1(x: f64) -> f64 {
    return rung_log_1(x) * 1.4426950408889634lf;
}

fn rung_pow_1(base: f64, exponent: f64) -> f64 {
    let of_zero = select(rung_infinity(), 0.0lf, exponent > 0.0lf);
    let power = select(rung_exp_1(exponent * rung_log_1(base)), of_zero, base == 0.0lf);
    return select(power, 1.0lf, exponent == 0.0lf);
}

fn rung_saturate_1(x: f64) -> f64 {
    return clamp(x, 0.0lf, 1.0lf);
}

fn rung_fract_1(x: f64) -> f64 {
    return x - floor(x);
}

fn rung_step_1(edge: f64, x: f64) -> f64 {
    return select(0.0lf, 1.0lf, edge <= x);
}

fn rung_length_1(x: f64) -> f64 {
    return abs(x);
}

fn rung_distance_1(a: f64, b: f64) -> f64 {
    return abs(a - b);
}

fn rung_length_2(v: vec2<f64>) -> f64 {
    return sqrt(dot(v, v));
}

fn rung_distance_2(a: vec2<f64>, b: vec2<f64>) -> f64 {
    return rung_length_2(a - b);
}

fn rung_normalize_2(v: vec2<f64>) -> vec2<f64> {
    return v / rung_length_2(v);
}

fn rung_reflect_2(i: vec2<f64>, n: vec2<f64>) -> vec2<f64> {
    return i - 2.0lf * dot(i, n) * n;
}

fn rung_length_3(v: vec3<f64>) -> f64 {
    return sqrt(dot(v, v));
}

fn rung_distance_3(a: vec3<f64>, b: vec3<f64>) -> f64 {
    return rung_length_3(a - b);
}

fn rung_normalize_3(v: vec3<f64>) -> vec3<f64> {
    return v / rung_length_3(v);
}

fn rung_reflect_3(i: vec3<f64>, n: vec3<f64>) -> vec3<f64> {
    return i - 2.0lf * dot(i, n) * n;
}

fn rung_length_4(v: vec4<f64>) -> f64 {
    return sqrt(dot(v, v));
}

fn rung_distance_4(a: vec4<f64>, b: vec4<f64>) -> f64 {
    return rung_length_4(a - b);
}

fn rung_normalize_4(v: vec4<f64>) -> vec4<f64> {
    return v / rung_length_4(v);
}

fn rung_reflect_4(i: vec4<f64>, n: vec4<f64>) -> vec4<f64> {
    return i - 2.0lf * dot(i, n) * n;
}

// What elementary.wgsl has for binary32.

fn elementary_ln_1p(x: f64) -> f64 {
    if abs(x) > 0.25lf {
        return rung_log_1(1.0lf + x);
    }
    return rung_atanh_series(x / (2.0lf + x));
}

fn elementary_exp_m1(x: f64) -> f64 {
    if abs(x) > 0.34lf {
        return rung_exp_1(x) - 1.0lf;
    }
    return rung_exp_m1_series(x);
}

fn elementary_opaque(x: f64) -> f64 {
    return x;
}

// Products of numbers of f32 are exact.
fn elementary_difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    return a * b - c * d;
}
