// Double-floats: functions of numbers, and of vectors as a whole. The component-wise ones are in double_float_vector.wgsl.
// exp by x = k ln 2 + r and a series, log by the exponent and atanh; the terms below 2^-24 of the sum in binary32.
// Relative errors of some 2^-44; of a power, |exponent * log(base)| times 2^-46 besides. No branches, for the
// reason that f64.wgsl gives.

// 0, which entry points take from what no compiler knows.
var<private> rung_zero: u32;

// The two parts of a number.
fn rung_parts(x: DF1) -> vec2f {
    return vec2f(x.hi, x.lo);
}

fn rung_dot_2(a: DF2, b: DF2) -> DF1 {
    let c = rung_mul_2(a, b);
    return rung_add_1(DF1(c.hi.x, c.lo.x), DF1(c.hi.y, c.lo.y));
}

// Brought near 1 by a power of two first.
fn rung_length_2(v: DF2) -> DF1 {
    let largest = max(abs(v.hi.x), abs(v.hi.y));
    let exponent = clamp(bitcast<u32>(largest) >> 23u, 1u, 253u);
    let down = bitcast<f32>((254u - exponent) << 23u);
    let up = bitcast<f32>(exponent << 23u);
    let near = DF2(v.hi * down, v.lo * down);
    let length = rung_sqrt_1(rung_dot_2(near, near));
    return DF1(length.hi * up, length.lo * up);
}

fn rung_distance_2(a: DF2, b: DF2) -> DF1 {
    return rung_length_2(rung_sub_2(a, b));
}

fn rung_normalize_2(v: DF2) -> DF2 {
    let length = rung_length_2(v);
    return rung_div_2(v, DF2(vec2f(length.hi), vec2f(length.lo)));
}

fn rung_reflect_2(i: DF2, n: DF2) -> DF2 {
    let twice = rung_dot_2(i, n);
    return rung_sub_2(i, rung_mul_2(DF2(vec2f(2.0 * twice.hi), vec2f(2.0 * twice.lo)), n));
}

fn rung_dot_3(a: DF3, b: DF3) -> DF1 {
    let c = rung_mul_3(a, b);
    return rung_add_1(rung_add_1(DF1(c.hi.x, c.lo.x), DF1(c.hi.y, c.lo.y)), DF1(c.hi.z, c.lo.z));
}

// Brought near 1 by a power of two first.
fn rung_length_3(v: DF3) -> DF1 {
    let largest = max(max(abs(v.hi.x), abs(v.hi.y)), abs(v.hi.z));
    let exponent = clamp(bitcast<u32>(largest) >> 23u, 1u, 253u);
    let down = bitcast<f32>((254u - exponent) << 23u);
    let up = bitcast<f32>(exponent << 23u);
    let near = DF3(v.hi * down, v.lo * down);
    let length = rung_sqrt_1(rung_dot_3(near, near));
    return DF1(length.hi * up, length.lo * up);
}

fn rung_distance_3(a: DF3, b: DF3) -> DF1 {
    return rung_length_3(rung_sub_3(a, b));
}

fn rung_normalize_3(v: DF3) -> DF3 {
    let length = rung_length_3(v);
    return rung_div_3(v, DF3(vec3f(length.hi), vec3f(length.lo)));
}

fn rung_reflect_3(i: DF3, n: DF3) -> DF3 {
    let twice = rung_dot_3(i, n);
    return rung_sub_3(i, rung_mul_3(DF3(vec3f(2.0 * twice.hi), vec3f(2.0 * twice.lo)), n));
}

fn rung_dot_4(a: DF4, b: DF4) -> DF1 {
    let c = rung_mul_4(a, b);
    return rung_add_1(rung_add_1(rung_add_1(DF1(c.hi.x, c.lo.x), DF1(c.hi.y, c.lo.y)), DF1(c.hi.z, c.lo.z)), DF1(c.hi.w, c.lo.w));
}

// Brought near 1 by a power of two first.
fn rung_length_4(v: DF4) -> DF1 {
    let largest = max(max(max(abs(v.hi.x), abs(v.hi.y)), abs(v.hi.z)), abs(v.hi.w));
    let exponent = clamp(bitcast<u32>(largest) >> 23u, 1u, 253u);
    let down = bitcast<f32>((254u - exponent) << 23u);
    let up = bitcast<f32>(exponent << 23u);
    let near = DF4(v.hi * down, v.lo * down);
    let length = rung_sqrt_1(rung_dot_4(near, near));
    return DF1(length.hi * up, length.lo * up);
}

fn rung_distance_4(a: DF4, b: DF4) -> DF1 {
    return rung_length_4(rung_sub_4(a, b));
}

fn rung_normalize_4(v: DF4) -> DF4 {
    let length = rung_length_4(v);
    return rung_div_4(v, DF4(vec4f(length.hi), vec4f(length.lo)));
}

fn rung_reflect_4(i: DF4, n: DF4) -> DF4 {
    let twice = rung_dot_4(i, n);
    return rung_sub_4(i, rung_mul_4(DF4(vec4f(2.0 * twice.hi), vec4f(2.0 * twice.lo)), n));
}

fn rung_cross_3(a: DF3, b: DF3) -> DF3 {
    let first = rung_mul_3(DF3(a.hi.yzx, a.lo.yzx), DF3(b.hi.zxy, b.lo.zxy));
    let second = rung_mul_3(DF3(a.hi.zxy, a.lo.zxy), DF3(b.hi.yzx, b.lo.yzx));
    return rung_sub_3(first, second);
}

fn rung_length_1(x: DF1) -> DF1 {
    return rung_abs_1(x);
}

fn rung_distance_1(a: DF1, b: DF1) -> DF1 {
    return rung_abs_1(rung_sub_1(a, b));
}

fn rung_whole(x: f32) -> DF1 {
    return DF1(x, 0.0);
}

fn rung_infinity() -> f32 {
    let great = rung_opaque_1(0x1p127);
    return great * great;
}

// c + r*p.
fn rung_horner(c: DF1, r: DF1, p: DF1) -> DF1 {
    return rung_add_1(c, rung_mul_1(r, p));
}

// exp(r) - 1 for |r| up to 0.35.
fn rung_exp_m1_series(r: DF1) -> DF1 {
    let tail = 2.4801588e-05 + r.hi * (2.7557319e-06 + r.hi * (2.755732e-07 + r.hi * 2.5052108e-08));
    var p = rung_horner(DF1(0.0001984127, -2.7255969e-12), r, rung_whole(tail));
    p = rung_horner(DF1(0.0013888889, -3.3631094e-11), r, p);
    p = rung_horner(DF1(0.008333334, -4.346172e-10), r, p);
    p = rung_horner(DF1(0.041666668, -1.2417635e-09), r, p);
    p = rung_horner(DF1(0.16666667, -4.967054e-09), r, p);
    p = rung_horner(DF1(0.5, 0.0), r, p);
    return rung_add_1(r, rung_mul_1(rung_mul_1(r, r), p));
}

// 2 atanh(s) for |s| up to 0.18.
fn rung_atanh_series(s: DF1) -> DF1 {
    let z = rung_mul_1(s, s);
    let tail = 0.09090909 + z.hi * (0.07692308 + z.hi * (0.06666667 + z.hi * (0.05882353 + z.hi * 0.05263158)));
    var p = rung_horner(DF1(0.11111111, -8.278423e-10), z, rung_whole(tail));
    p = rung_horner(DF1(0.14285715, -6.386212e-09), z, p);
    p = rung_horner(DF1(0.2, -2.9802323e-09), z, p);
    p = rung_horner(DF1(0.33333334, -9.934108e-09), z, p);
    let twice = DF1(2.0 * s.hi, 2.0 * s.lo);
    return rung_add_1(twice, rung_mul_1(twice, rung_mul_1(z, p)));
}

// x * 2^k, for k from -150 to 128, in two steps that are each a number.
fn rung_scaled(x: DF1, k: i32) -> DF1 {
    let half = k / 2;
    let first = bitcast<f32>(u32(half + 127) << 23u);
    let second = bitcast<f32>(u32(k - half + 127) << 23u);
    let hi = rung_opaque_1(x.hi * first) * second;
    return DF1(hi, rung_kept_1(hi, rung_opaque_1(x.lo * first) * second));
}

// A power, infinity beyond its range and 0 below.
fn rung_ranged(power: DF1, x: f32, least: f32, most: f32) -> DF1 {
    let ranged = rung_either_1(power, rung_whole(rung_infinity()), x > most);
    return rung_either_1(ranged, rung_whole(0.0), x < least);
}

fn rung_exp_1(given: DF1) -> DF1 {
    let x = rung_clamp_1(given, rung_whole(-104.0), rung_whole(89.0));
    let k = round(x.hi * 1.442695);
    // Products of at most 8 bits and 16.
    var r = rung_add_1(x, rung_whole(-(k * 0.69314575)));
    r = rung_add_1(r, rung_whole(-(k * 1.4281832e-06)));
    r = rung_add_1(r, rung_whole(-(k * 4.2365214e-10)));
    let power = rung_scaled(rung_add_1(rung_whole(1.0), rung_exp_m1_series(r)), i32(k));
    return rung_ranged(power, given.hi, -104.0, 89.0);
}

fn rung_exp2_1(given: DF1) -> DF1 {
    let x = rung_clamp_1(given, rung_whole(-150.0), rung_whole(128.0));
    let k = round(x.hi);
    let r = rung_mul_1(rung_add_1(x, rung_whole(-k)), DF1(0.6931472, -1.9046542e-09));
    let power = rung_scaled(rung_add_1(rung_whole(1.0), rung_exp_m1_series(r)), i32(k));
    return rung_ranged(power, given.hi, -150.0, 128.0);
}

fn rung_log_1(given: DF1) -> DF1 {
    let is_tiny = given.hi < 0x1p-90;
    let up = select(1.0, 0x1p64, is_tiny);
    let x = DF1(given.hi * up, given.lo * up);
    // The sign apart, so that what is negative stays in range.
    var exponent = i32((bitcast<u32>(x.hi) >> 23u) & 0xffu) - 127;
    // A significand above the root of 2 belongs to the next power.
    exponent += select(0, 1, (bitcast<u32>(x.hi) & 0x7fffffu) > 0x3504f3u);
    let m = rung_scaled(x, -exponent);
    let s = rung_div_1(rung_add_1(m, rung_whole(-1.0)), rung_add_1(m, rung_whole(1.0)));
    let e = f32(exponent - select(0, 64, is_tiny));
    let of_power = rung_add_1(rung_two_sum_1(e * 0.69314575, e * 1.4281832e-06), rung_whole(e * 4.2365214e-10));
    let log = rung_add_1(of_power, rung_atanh_series(s));
    // Of 0 minus infinity, of what is negative no number, of infinity itself.
    let lowest = rung_whole(select(sqrt(given.hi), -rung_infinity(), given.hi == 0.0));
    let is_great = (bitcast<u32>(given.hi) & 0x7f800000u) == 0x7f800000u;
    return rung_either_1(rung_either_1(log, lowest, given.hi <= 0.0), given, is_great && given.hi > 0.0);
}

fn rung_log2_1(x: DF1) -> DF1 {
    return rung_mul_1(rung_log_1(x), DF1(1.442695, 1.925963e-08));
}

fn rung_pow_1(base: DF1, exponent: DF1) -> DF1 {
    let of_zero = rung_whole(select(rung_infinity(), 0.0, exponent.hi > 0.0));
    let power = rung_either_1(rung_exp_1(rung_mul_1(exponent, rung_log_1(base))), of_zero, base.hi == 0.0);
    return rung_either_1(power, rung_whole(1.0), exponent.hi == 0.0);
}

// What elementary.wgsl has for binary32.

fn elementary_ln_1p(x: DF1) -> DF1 {
    if abs(x.hi) > 0.25 {
        return rung_log_1(rung_add_1(rung_whole(1.0), x));
    }
    return rung_atanh_series(rung_div_1(x, rung_add_1(rung_whole(2.0), x)));
}

fn elementary_exp_m1(x: DF1) -> DF1 {
    if abs(x.hi) > 0.34 {
        return rung_add_1(rung_exp_1(x), rung_whole(-1.0));
    }
    return rung_exp_m1_series(x);
}

fn elementary_opaque(x: DF1) -> DF1 {
    return x;
}

fn elementary_difference_of_products(a: DF1, b: DF1, c: DF1, d: DF1) -> DF1 {
    return rung_sub_1(rung_mul_1(a, b), rung_mul_1(c, d));
}
