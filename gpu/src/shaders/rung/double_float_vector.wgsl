// Component-wise operations on unevaluated sums hi + lo of two numbers of binary32, |lo| at most half an ULP of hi: some 48
// bits. Written for three components; the text for other widths is made of this one.
// Error-free transforms by Knuth and Dekker. A compiler that reassociates undoes them but for `rung_opaque`, an exclusive or
// with a zero that is known at run time alone; one that fuses products with sums does no harm, as each product that is added
// is exact.
// Beside what is infinite or NaN the low part is 0, so that guards see what they would of binary32.

struct DF3 {
    hi: vec3f,
    lo: vec3f,
}

fn rung_opaque_3(x: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(x) ^ vec3u(rung_zero));
}

// The error of a result, or 0 where that is no number.
fn rung_kept_3(value: vec3f, error: vec3f) -> vec3f {
    return select(error, vec3f(0.0), (bitcast<vec3u>(value) & vec3u(0x7f800000u)) == vec3u(0x7f800000u));
}

fn rung_two_sum_3(a: vec3f, b: vec3f) -> DF3 {
    let sum = rung_opaque_3(a + b);
    let of_b = rung_opaque_3(sum - a);
    let first = rung_opaque_3(a - rung_opaque_3(sum - of_b));
    return DF3(sum, rung_kept_3(sum, first + (b - of_b)));
}

// For |a| >= |b|.
fn rung_quick_two_sum_3(a: vec3f, b: vec3f) -> DF3 {
    let sum = rung_opaque_3(a + b);
    return DF3(sum, rung_kept_3(sum, b - rung_opaque_3(sum - a)));
}

fn rung_upper_3(x: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(x) & vec3u(0xfffff000u));
}

fn rung_two_product_3(a: vec3f, b: vec3f) -> DF3 {
    let product = rung_opaque_3(a * b);
    let a1 = rung_upper_3(a);
    let b1 = rung_upper_3(b);
    let a2 = a - a1;
    let b2 = b - b1;
    let first = rung_opaque_3(a1 * b1 - product);
    let second = rung_opaque_3(first + a1 * b2);
    return DF3(product, rung_kept_3(product, rung_opaque_3(second + a2 * b1) + a2 * b2));
}

fn rung_add_3(a: DF3, b: DF3) -> DF3 {
    let high = rung_two_sum_3(a.hi, b.hi);
    let low = rung_two_sum_3(a.lo, b.lo);
    let sum = rung_quick_two_sum_3(high.hi, high.lo + low.hi);
    return rung_quick_two_sum_3(sum.hi, sum.lo + low.lo);
}

fn rung_sub_3(a: DF3, b: DF3) -> DF3 {
    return rung_add_3(a, DF3(-b.hi, -b.lo));
}

fn rung_mul_3(a: DF3, b: DF3) -> DF3 {
    let product = rung_two_product_3(a.hi, b.hi);
    let crossed = product.lo + (a.hi * b.lo + a.lo * b.hi);
    return rung_quick_two_sum_3(product.hi, rung_kept_3(product.hi, crossed));
}

fn rung_div_3(a: DF3, b: DF3) -> DF3 {
    let zero = vec3f(0.0);
    let first = rung_opaque_3(a.hi / b.hi);
    let left = rung_sub_3(a, rung_mul_3(b, DF3(first, zero)));
    let second = rung_opaque_3(left.hi / b.hi);
    let last = rung_sub_3(left, rung_mul_3(b, DF3(second, zero)));
    let third = last.hi / b.hi;
    let quotient = rung_quick_two_sum_3(first, rung_kept_3(first, rung_kept_3(b.hi, second)));
    return rung_quick_two_sum_3(quotient.hi, quotient.lo + rung_kept_3(first, rung_kept_3(b.hi, third)));
}

fn rung_sqrt_3(a: DF3) -> DF3 {
    let root = rung_opaque_3(sqrt(a.hi));
    let left = rung_sub_3(a, rung_two_product_3(root, root));
    let more = select(left.hi / (2.0 * root), vec3f(0.0), a.hi <= vec3f(0.0));
    return rung_quick_two_sum_3(root, rung_kept_3(root, more));
}

fn rung_inverseSqrt_3(a: DF3) -> DF3 {
    return rung_div_3(DF3(vec3f(1.0), vec3f(0.0)), rung_sqrt_3(a));
}

fn rung_eq_3(a: DF3, b: DF3) -> vec3<bool> {
    return (a.hi == b.hi) & (a.lo == b.lo);
}

fn rung_ne_3(a: DF3, b: DF3) -> vec3<bool> {
    return (a.hi != b.hi) | (a.lo != b.lo);
}

fn rung_lt_3(a: DF3, b: DF3) -> vec3<bool> {
    return (a.hi < b.hi) | ((a.hi == b.hi) & (a.lo < b.lo));
}

fn rung_le_3(a: DF3, b: DF3) -> vec3<bool> {
    return (a.hi < b.hi) | ((a.hi == b.hi) & (a.lo <= b.lo));
}

fn rung_gt_3(a: DF3, b: DF3) -> vec3<bool> {
    return rung_lt_3(b, a);
}

fn rung_ge_3(a: DF3, b: DF3) -> vec3<bool> {
    return rung_le_3(b, a);
}

fn rung_either_3(a: DF3, b: DF3, is_b: vec3<bool>) -> DF3 {
    return DF3(select(a.hi, b.hi, is_b), select(a.lo, b.lo, is_b));
}

fn rung_min_3(a: DF3, b: DF3) -> DF3 {
    return rung_either_3(a, b, rung_lt_3(b, a));
}

fn rung_max_3(a: DF3, b: DF3) -> DF3 {
    return rung_either_3(a, b, rung_lt_3(a, b));
}

fn rung_clamp_3(x: DF3, low: DF3, high: DF3) -> DF3 {
    return rung_min_3(rung_max_3(x, low), high);
}

fn rung_saturate_3(x: DF3) -> DF3 {
    return rung_clamp_3(x, DF3(vec3f(0.0), vec3f(0.0)), DF3(vec3f(1.0), vec3f(0.0)));
}

fn rung_abs_3(x: DF3) -> DF3 {
    return rung_either_3(x, DF3(-x.hi, -x.lo), x.hi < vec3f(0.0));
}

fn rung_sign_3(x: DF3) -> DF3 {
    return DF3(sign(x.hi), vec3f(0.0));
}

fn rung_floor_3(x: DF3) -> DF3 {
    let whole = floor(x.hi);
    return rung_quick_two_sum_3(whole, select(vec3f(0.0), floor(x.lo), whole == x.hi));
}

fn rung_ceil_3(x: DF3) -> DF3 {
    let whole = ceil(x.hi);
    return rung_quick_two_sum_3(whole, select(vec3f(0.0), ceil(x.lo), whole == x.hi));
}

fn rung_trunc_3(x: DF3) -> DF3 {
    return rung_either_3(rung_floor_3(x), rung_ceil_3(x), x.hi < vec3f(0.0));
}

fn rung_fract_3(x: DF3) -> DF3 {
    return rung_sub_3(x, rung_floor_3(x));
}

// To the even one of two; where the high part is half way the low one decides.
fn rung_round_3(x: DF3) -> DF3 {
    let low = floor(x.hi);
    let is_half = x.hi - low == vec3f(0.5);
    var whole = round(x.hi);
    whole = select(whole, low, is_half & (x.lo < vec3f(0.0)));
    whole = select(whole, low + 1.0, is_half & (x.lo > vec3f(0.0)));
    return rung_quick_two_sum_3(whole, select(vec3f(0.0), round(x.lo), low == x.hi));
}

fn rung_step_3(edge: DF3, x: DF3) -> DF3 {
    return DF3(select(vec3f(0.0), vec3f(1.0), rung_le_3(edge, x)), vec3f(0.0));
}

fn rung_mix_3(a: DF3, b: DF3, t: DF3) -> DF3 {
    let left = rung_sub_3(DF3(vec3f(1.0), vec3f(0.0)), t);
    return rung_add_3(rung_mul_3(a, left), rung_mul_3(b, t));
}

fn rung_from_u32_3(x: vec3u) -> DF3 {
    return rung_quick_two_sum_3(vec3f(x >> vec3u(16u)) * 65536.0, vec3f(x & vec3u(0xffffu)));
}

fn rung_from_i32_3(x: vec3i) -> DF3 {
    let size = rung_from_u32_3(vec3u(abs(x)));
    return rung_either_3(size, DF3(-size.hi, -size.lo), x < vec3i(0));
}

fn rung_to_i32_3(x: DF3) -> vec3i {
    let whole = rung_trunc_3(x);
    return vec3i(whole.hi) + vec3i(whole.lo);
}

fn rung_to_u32_3(x: DF3) -> vec3u {
    let whole = rung_trunc_3(x);
    return vec3u(whole.hi) + vec3u(vec3i(whole.lo));
}
