//! The probes, a row each, and what is looked up among them.

use super::gives::Gives;
use super::probe::Class::{Infinity, Nan, Rounding, SignedZero, Subnormal};
use super::probe::{Class, Probe, Way};
use super::promise::Promise;
use super::promise::Promise::{EitherZero, Exactly, Indeterminate, KeptOrFlushed, NearOrFlushed, OneOf};
use super::source::Source;
use super::source::Source::{Accuracy, Bitcast, Conversion, FiniteMath, Flush, Fusion, Packing, Selection, ZeroSign};

const fn f(x: f32) -> u32 {
    x.to_bits()
}

/// 2ⁿ, subnormal ones too.
const fn two(n: i32) -> f32 {
    if n < -126 { f32::from_bits(1 << (n + 149)) } else { f32::from_bits((n + 127).cast_unsigned() << 23) }
}

const ZERO: u32 = f(0.0);
const MINUS_ZERO: u32 = f(-0.0);
const ONE: u32 = f(1.0);
const HALF: u32 = f(0.5);
const INF: u32 = f(f32::INFINITY);
const MINUS_INF: u32 = f(f32::NEG_INFINITY);
const MAX: u32 = f(f32::MAX);
/// Quiet, as processors make it.
const NAN: u32 = 0x7fc0_0000;
const NEGATIVE_NAN: u32 = 0xffc0_0000;
/// The quiet bit is not set.
const SIGNALLING_NAN: u32 = 0x7fa0_0001;
const PAYLOAD_NAN: u32 = 0x7fc1_2345;
const TINY: u32 = f(1e-40);
const MINUS_TINY: u32 = f(-1e-40);
const BOOL: &[u32] = &[0, 1];

const fn probe(
    name: &'static str,
    class: Class,
    what: &'static str,
    function: &'static str,
    inputs: &'static [u32],
    promise: Promise,
    source: Source,
) -> Probe {
    Probe { name, class, what, way: Way::Function(function), inputs, gives: Gives::Float, promise, source }
}

/// A probe whose result is a u32, or the bits of an i32.
const fn word(probe: Probe) -> Probe {
    Probe { gives: Gives::Word, ..probe }
}

/// A comparison.
const fn truth(
    name: &'static str,
    class: Class,
    what: &'static str,
    function: &'static str,
    inputs: &'static [u32],
    promise: Promise,
    source: Source,
) -> Probe {
    Probe { gives: Gives::Truth, ..probe(name, class, what, function, inputs, promise, source) }
}

/// A value that the vertex stage hands to the fragment stage.
const fn varying(name: &'static str, what: &'static str, flat: bool, input: &'static [u32; 1]) -> Probe {
    Probe { way: Way::Varying { flat }, ..probe(name, Nan, what, "", input, Indeterminate, FiniteMath) }
}

/// The product of 1 + 2⁻¹² with itself is 1 + 2⁻¹¹ + 2⁻²⁴: rounded down or up, less 1 + 2⁻¹¹, it leaves 0 or 2⁻²³; fused,
/// 2⁻²⁴.
const FUSED: &[u32] = &[f(1.0 + two(-12)), f(1.0 + two(-12)), f(-1.0 - two(-11))];
const FUSED_OR_NOT: &[u32] = &[ZERO, MINUS_ZERO, f(two(-24)), f(two(-23))];

/// Every probe.
#[rustfmt::skip]
pub const PROBES: &[Probe] = &[
    // NaN: kept, made, handed on.
    probe("keep-nan", Nan, "a quiet NaN, from buffer to buffer or target", "special_keep", &[NAN], Indeterminate, Bitcast),
    probe("keep-negative-nan", Nan, "a negative NaN, the same way", "special_keep", &[NEGATIVE_NAN], Indeterminate, Bitcast),
    probe("keep-signalling-nan", Nan, "a signalling NaN, the same way", "special_keep", &[SIGNALLING_NAN], Indeterminate, Bitcast),
    probe("keep-nan-payload", Nan, "a NaN with a payload, the same way", "special_keep", &[PAYLOAD_NAN], Indeterminate, Bitcast),
    varying("varying-nan", "a NaN with a payload as an interpolated attribute", false, &[PAYLOAD_NAN]),
    varying("varying-flat-nan", "a NaN with a payload as a flat attribute", true, &[PAYLOAD_NAN]),
    varying("varying-flat-signalling-nan", "a signalling NaN as a flat attribute", true, &[SIGNALLING_NAN]),
    probe("nan-plus-one", Nan, "NaN + 1", "special_add", &[NAN, ONE], Indeterminate, FiniteMath),
    probe("nan-payload-plus-one", Nan, "NaN with a payload + 1", "special_add", &[PAYLOAD_NAN, ONE], Indeterminate, FiniteMath),
    probe("nan-times-zero", Nan, "NaN · 0", "special_multiply", &[NAN, ZERO], Indeterminate, FiniteMath),
    probe("negate-nan", Nan, "−NaN", "special_negate", &[NAN], Indeterminate, FiniteMath),
    probe("abs-negative-nan", Nan, "abs(−NaN)", "special_abs", &[NEGATIVE_NAN], Indeterminate, FiniteMath),
    probe("zero-over-zero", Nan, "0 / 0", "special_divide", &[ZERO, ZERO], Indeterminate, Accuracy),
    probe("infinity-minus-infinity", Nan, "∞ − ∞", "special_subtract", &[INF, INF], Indeterminate, FiniteMath),
    probe("zero-times-infinity", Nan, "0 · ∞", "special_multiply", &[ZERO, INF], Indeterminate, FiniteMath),
    probe("infinity-over-infinity", Nan, "∞ / ∞", "special_divide", &[INF, INF], Indeterminate, FiniteMath),
    probe("min-nan-first", Nan, "min(NaN, 0.5)", "special_min", &[NAN, HALF], Indeterminate, FiniteMath),
    probe("min-nan-second", Nan, "min(0.5, NaN)", "special_min", &[HALF, NAN], Indeterminate, FiniteMath),
    probe("max-nan-first", Nan, "max(NaN, 0.5)", "special_max", &[NAN, HALF], Indeterminate, FiniteMath),
    probe("max-nan-second", Nan, "max(0.5, NaN)", "special_max", &[HALF, NAN], Indeterminate, FiniteMath),
    probe("clamp-nan", Nan, "clamp(NaN, 0, 1)", "special_clamp", &[NAN, ZERO, ONE], Indeterminate, FiniteMath),
    probe("clamp-nan-low", Nan, "clamp(0.5, NaN, 1)", "special_clamp", &[HALF, NAN, ONE], Indeterminate, FiniteMath),
    probe("clamp-nan-high", Nan, "clamp(0.5, 0, NaN)", "special_clamp", &[HALF, ZERO, NAN], Indeterminate, FiniteMath),
    probe("saturate-nan", Nan, "saturate(NaN)", "special_saturate", &[NAN], Indeterminate, FiniteMath),
    probe("select-other-than-nan", Nan, "select(NaN, 0.5, true)", "special_select", &[NAN, HALF, ONE], Exactly(HALF), Selection),
    probe("select-nan", Nan, "select(0.5, NaN, true)", "special_select", &[HALF, NAN, ONE], Indeterminate, FiniteMath),
    probe("sign-nan", Nan, "sign(NaN)", "special_sign", &[NAN], Indeterminate, FiniteMath),
    probe("floor-nan", Nan, "floor(NaN)", "special_floor", &[NAN], Indeterminate, FiniteMath),
    probe("fract-nan", Nan, "fract(NaN)", "special_fract", &[NAN], Indeterminate, FiniteMath),
    probe("round-nan", Nan, "round(NaN)", "special_round", &[NAN], Indeterminate, FiniteMath),
    probe("mix-with-unused-nan", Nan, "mix(1, NaN, 0)", "special_mix", &[ONE, NAN, ZERO], Indeterminate, FiniteMath),
    probe("step-nan-edge", Nan, "step(NaN, 0.5)", "special_step", &[NAN, HALF], Indeterminate, FiniteMath),
    probe("step-of-nan", Nan, "step(0.5, NaN)", "special_step", &[HALF, NAN], Indeterminate, FiniteMath),
    probe("smoothstep-of-nan", Nan, "smoothstep(0, 1, NaN)", "special_smoothstep", &[ZERO, ONE, NAN], Indeterminate, FiniteMath),
    probe("smoothstep-equal-edges", Nan, "smoothstep(1, 1, 1)", "special_smoothstep", &[ONE, ONE, ONE], Indeterminate, Accuracy),
    probe("sqrt-minus-one", Nan, "sqrt(−1)", "special_sqrt", &[f(-1.0)], Indeterminate, Accuracy),
    probe("inverse-sqrt-minus-one", Nan, "inverseSqrt(−1)", "special_inverse_sqrt", &[f(-1.0)], Indeterminate, Accuracy),
    probe("exp-nan", Nan, "exp(NaN)", "special_exp", &[NAN], Indeterminate, FiniteMath),
    probe("log-minus-one", Nan, "log(−1)", "special_log", &[f(-1.0)], Indeterminate, Accuracy),
    probe("pow-zero-zero", Nan, "pow(0, 0)", "special_pow", &[ZERO, ZERO], Indeterminate, Accuracy),
    probe("pow-zero-one", Nan, "pow(0, 1)", "special_pow", &[ZERO, ONE], Indeterminate, Accuracy),
    probe("pow-minus-one-two", Nan, "pow(−1, 2)", "special_pow", &[f(-1.0), f(2.0)], Indeterminate, Accuracy),
    probe("pow-nan-zero", Nan, "pow(NaN, 0)", "special_pow", &[NAN, ZERO], Indeterminate, FiniteMath),
    probe("pow-one-nan", Nan, "pow(1, NaN)", "special_pow", &[ONE, NAN], Indeterminate, FiniteMath),
    probe("normalize-zero", Nan, "normalize(0, 0, 0).x", "special_normalize", &[ZERO, ZERO, ZERO], Indeterminate, Accuracy),
    probe("normalize-infinite", Nan, "normalize(∞, 0, 0).x", "special_normalize", &[INF, ZERO, ZERO], Indeterminate, FiniteMath),
    truth("nan-equals-itself", Nan, "x == x, x NaN", "special_equals_itself", &[NAN], Indeterminate, FiniteMath),
    truth("nan-differs-from-itself", Nan, "x != x, x NaN", "special_differs_from_itself", &[NAN], Indeterminate, FiniteMath),
    truth("number-differs-from-itself", Nan, "x != x, x = 1", "special_differs_from_itself", &[ONE], Exactly(0), Accuracy),
    truth("nan-equals-nan", Nan, "NaN == NaN, two operands", "special_equal", &[NAN, NAN], Indeterminate, FiniteMath),
    truth("nan-less", Nan, "NaN < 1", "special_less", &[NAN, ONE], Indeterminate, FiniteMath),
    truth("less-than-nan", Nan, "1 < NaN", "special_less", &[ONE, NAN], Indeterminate, FiniteMath),
    truth("nan-not-less", Nan, "!(NaN < 1)", "special_not_less", &[NAN, ONE], Indeterminate, FiniteMath),
    truth("nan-by-its-bits", Nan, "bits of NaN above those of ∞", "special_is_nan_by_bits", &[NAN], Indeterminate, Bitcast),
    truth("number-by-its-bits", Nan, "bits of 1 above those of ∞", "special_is_nan_by_bits", &[ONE], Exactly(0), Accuracy),
    word(probe("nan-to-u32", Nan, "u32(NaN)", "special_to_u32", &[NAN], Indeterminate, FiniteMath)),
    word(probe("nan-to-i32", Nan, "i32(NaN)", "special_to_i32", &[NAN], Indeterminate, FiniteMath)),
    probe("quantize-nan", Nan, "quantizeToF16(NaN)", "special_quantize", &[NAN], Indeterminate, FiniteMath),
    word(probe("pack-nan-as-unorm", Nan, "pack4x8unorm(NaN, 0, 0.5, 1), the NaN's byte last", "special_pack_unorm", &[NAN], Indeterminate, FiniteMath)),
    word(probe("pack-nan-as-half", Nan, "pack2x16float(NaN, 1)", "special_pack_half", &[NAN], Indeterminate, FiniteMath)),

    // Infinity and overflow.
    probe("keep-infinity", Infinity, "∞, from buffer to buffer or target", "special_keep", &[INF], Indeterminate, Bitcast),
    probe("sum-overflow", Infinity, "greatest + greatest", "special_add", &[MAX, MAX], Indeterminate, FiniteMath),
    probe("difference-overflow", Infinity, "−greatest − greatest", "special_subtract", &[f(f32::MIN), MAX], Indeterminate, FiniteMath),
    probe("product-overflow", Infinity, "1e30 · 1e30", "special_multiply", &[f(1e30), f(1e30)], Indeterminate, FiniteMath),
    probe("quotient-overflow", Infinity, "1e30 / 1e-30", "special_divide", &[f(1e30), f(1e-30)], Indeterminate, FiniteMath),
    probe("one-over-zero", Infinity, "1 / 0", "special_divide", &[ONE, ZERO], Indeterminate, Accuracy),
    probe("one-over-minus-zero", Infinity, "1 / −0", "special_divide", &[ONE, MINUS_ZERO], Indeterminate, Accuracy),
    probe("one-over-infinity", Infinity, "1 / ∞", "special_divide", &[ONE, INF], Indeterminate, FiniteMath),
    probe("one-over-huge", Infinity, "1 / 3e38, beyond 2¹²⁶", "special_divide", &[ONE, f(3e38)], Indeterminate, Accuracy),
    probe("min-infinity", Infinity, "min(∞, 0.5)", "special_min", &[INF, HALF], Indeterminate, FiniteMath),
    probe("max-minus-infinity", Infinity, "max(−∞, 0.5)", "special_max", &[MINUS_INF, HALF], Indeterminate, FiniteMath),
    probe("saturate-infinity", Infinity, "saturate(∞)", "special_saturate", &[INF], Indeterminate, FiniteMath),
    probe("floor-infinity", Infinity, "floor(∞)", "special_floor", &[INF], Indeterminate, FiniteMath),
    probe("fract-infinity", Infinity, "fract(∞)", "special_fract", &[INF], Indeterminate, FiniteMath),
    // By x·(1 − t) + y·t it is 0; x + t·(y − x), which is legal too, overflows.
    probe("mix-far-ends", Infinity, "mix(3e38, −3e38, 0.5)", "special_mix", &[f(3e38), f(-3e38), HALF], Indeterminate, Accuracy),
    probe("mix-infinity-and-zero", Infinity, "mix(∞, 1, 1)", "special_mix", &[INF, ONE, ONE], Indeterminate, FiniteMath),
    probe("sqrt-infinity", Infinity, "sqrt(∞)", "special_sqrt", &[INF], Indeterminate, FiniteMath),
    probe("inverse-sqrt-zero", Infinity, "inverseSqrt(0)", "special_inverse_sqrt", &[ZERO], Indeterminate, Accuracy),
    probe("inverse-sqrt-infinity", Infinity, "inverseSqrt(∞)", "special_inverse_sqrt", &[INF], Indeterminate, FiniteMath),
    probe("exp-overflow", Infinity, "exp(1000)", "special_exp", &[f(1000.0)], Indeterminate, FiniteMath),
    probe("exp-infinity", Infinity, "exp(∞)", "special_exp", &[INF], Indeterminate, FiniteMath),
    probe("exp-minus-infinity", Infinity, "exp(−∞)", "special_exp", &[MINUS_INF], Indeterminate, FiniteMath),
    probe("exp2-overflow", Infinity, "exp2(128)", "special_exp2", &[f(128.0)], Indeterminate, FiniteMath),
    probe("log-zero", Infinity, "log(0)", "special_log", &[ZERO], Indeterminate, Accuracy),
    probe("log-infinity", Infinity, "log(∞)", "special_log", &[INF], Indeterminate, FiniteMath),
    probe("pow-zero-minus-one", Infinity, "pow(0, −1)", "special_pow", &[ZERO, f(-1.0)], Indeterminate, Accuracy),
    probe("length-of-huge", Infinity, "length(1e20, 0, 0)", "special_length", &[f(1e20), ZERO, ZERO], Indeterminate, FiniteMath),
    probe("dot-overflow", Infinity, "dot(v, v), v = (1e20, 1, 1)", "special_dot", &[f(1e20), ONE, ONE], Indeterminate, FiniteMath),
    probe("normalize-huge", Infinity, "normalize(1e20, 0, 0).x", "special_normalize", &[f(1e20), ZERO, ZERO], Indeterminate, FiniteMath),
    truth("infinity-equals-infinity", Infinity, "∞ == ∞", "special_equal", &[INF, INF], Indeterminate, FiniteMath),
    truth("greatest-less-than-infinity", Infinity, "greatest < ∞", "special_less", &[MAX, INF], Indeterminate, FiniteMath),
    word(probe("infinity-to-u32", Infinity, "u32(∞)", "special_to_u32", &[INF], Indeterminate, FiniteMath)),
    word(probe("too-large-to-u32", Infinity, "u32(1e20)", "special_to_u32", &[f(1e20)], OneOf(&[0xffff_ff00, 0xffff_ffff]), Conversion)),
    word(probe("negative-to-u32", Infinity, "u32(−1)", "special_to_u32", &[f(-1.0)], Exactly(0), Conversion)),
    word(probe("too-large-to-i32", Infinity, "i32(1e20)", "special_to_i32", &[f(1e20)], OneOf(&[0x7fff_ff80, 0x7fff_ffff]), Conversion)),
    word(probe("too-small-to-i32", Infinity, "i32(−1e20)", "special_to_i32", &[f(-1e20)], Exactly(0x8000_0000), Conversion)),
    probe("quantize-overflow", Infinity, "quantizeToF16(1e6)", "special_quantize", &[f(1e6)], Indeterminate, Conversion),
    word(probe("pack-overflow-as-half", Infinity, "pack2x16float(1e6, 1)", "special_pack_half", &[f(1e6)], Indeterminate, Packing)),
    probe("unpack-infinite-half", Infinity, "unpack2x16float(0x7c00).x", "special_unpack_half", &[0x7c00], Indeterminate, Packing),
    probe("unpack-nan-half", Infinity, "unpack2x16float(0x7e00).x", "special_unpack_half", &[0x7e00], Indeterminate, Packing),

    // Subnormals in and out.
    probe("keep-subnormal", Subnormal, "1e-40, from buffer to buffer or target", "special_keep", &[TINY], KeptOrFlushed(TINY), Flush),
    probe("subnormal-times-one", Subnormal, "1e-40 · 1", "special_multiply", &[TINY, ONE], KeptOrFlushed(TINY), Flush),
    probe("subnormal-plus-zero", Subnormal, "1e-40 + 0", "special_add", &[TINY, ZERO], KeptOrFlushed(TINY), Flush),
    probe("subnormal-plus-itself", Subnormal, "2⁻¹⁴⁰ + 2⁻¹⁴⁰", "special_add", &[f(two(-140)), f(two(-140))], OneOf(&[ZERO, MINUS_ZERO, f(two(-140)), f(two(-139))]), Flush),
    probe("subnormal-brought-back", Subnormal, "2⁻¹⁴⁰ · 2¹⁰⁰", "special_multiply", &[f(two(-140)), f(two(100))], KeptOrFlushed(f(two(-40))), Flush),
    probe("gradual-underflow", Subnormal, "1.5·2⁻¹²⁶ − 2⁻¹²⁶", "special_subtract", &[f(1.5 * two(-126)), f(two(-126))], KeptOrFlushed(f(two(-127))), Flush),
    probe("product-underflow", Subnormal, "2⁻⁷⁰ · 2⁻⁷⁰", "special_multiply", &[f(two(-70)), f(two(-70))], KeptOrFlushed(f(two(-140))), Flush),
    // 2.5 ULP there are 2.5 · 2⁻¹⁴⁹: 2 steps on the grid.
    probe("quotient-underflow", Subnormal, "2⁻¹⁰⁰ / 2⁴⁰", "special_divide", &[f(two(-100)), f(two(40))], NearOrFlushed(f32::from_bits(510), f32::from_bits(514)), Flush),
    probe("one-over-subnormal", Subnormal, "1 / 2⁻¹²⁷", "special_divide", &[ONE, f(two(-127))], Indeterminate, Accuracy),
    probe("subnormal-over-itself", Subnormal, "1e-40 / 1e-40", "special_divide", &[TINY, TINY], Indeterminate, Accuracy),
    probe("negate-subnormal", Subnormal, "−1e-40", "special_negate", &[TINY], KeptOrFlushed(MINUS_TINY), Flush),
    probe("abs-subnormal", Subnormal, "abs(−1e-40)", "special_abs", &[MINUS_TINY], KeptOrFlushed(TINY), Flush),
    probe("min-of-subnormals", Subnormal, "min(2e-40, 1e-40), either of which may be taken", "special_min", &[f(2e-40), TINY], OneOf(&[f(2e-40), TINY, ZERO, MINUS_ZERO]), Accuracy),
    probe("max-of-subnormals", Subnormal, "max(1e-40, 2e-40), either of which may be taken", "special_max", &[TINY, f(2e-40)], OneOf(&[f(2e-40), TINY, ZERO, MINUS_ZERO]), Accuracy),
    probe("clamp-subnormal", Subnormal, "clamp(1e-40, 0, 1)", "special_clamp", &[TINY, ZERO, ONE], KeptOrFlushed(TINY), Flush),
    probe("saturate-subnormal", Subnormal, "saturate(1e-40)", "special_saturate", &[TINY], KeptOrFlushed(TINY), Flush),
    probe("select-subnormal", Subnormal, "select(1, 1e-40, true)", "special_select", &[ONE, TINY, ONE], KeptOrFlushed(TINY), Flush),
    probe("sign-subnormal", Subnormal, "sign(1e-40)", "special_sign", &[TINY], OneOf(&[ONE, ZERO, MINUS_ZERO]), Flush),
    probe("floor-negative-subnormal", Subnormal, "floor(−1e-40)", "special_floor", &[MINUS_TINY], OneOf(&[f(-1.0), ZERO, MINUS_ZERO]), Flush),
    probe("ceil-subnormal", Subnormal, "ceil(1e-40)", "special_ceil", &[TINY], OneOf(&[ONE, ZERO, MINUS_ZERO]), Flush),
    probe("step-subnormal", Subnormal, "step(0, −1e-40)", "special_step", &[ZERO, MINUS_TINY], OneOf(&[ZERO, MINUS_ZERO, ONE]), Flush),
    truth("subnormal-equals-zero", Subnormal, "1e-40 == 0", "special_equal", &[TINY, ZERO], OneOf(BOOL), Flush),
    truth("zero-less-than-subnormal", Subnormal, "0 < 1e-40", "special_less", &[ZERO, TINY], OneOf(BOOL), Flush),
    probe("sqrt-subnormal", Subnormal, "sqrt(2⁻¹⁴⁰)", "special_sqrt", &[f(two(-140))], Indeterminate, Accuracy),
    probe("inverse-sqrt-subnormal", Subnormal, "inverseSqrt(2⁻¹⁴⁰)", "special_inverse_sqrt", &[f(two(-140))], Indeterminate, Accuracy),
    probe("log-subnormal", Subnormal, "log(1e-40)", "special_log", &[TINY], Indeterminate, Accuracy),
    // 3 + 2 · 100 steps of 2⁻¹⁴⁹ about 3.7e-44.
    probe("exp-underflow", Subnormal, "exp(−100)", "special_exp", &[f(-100.0)], NearOrFlushed(0.0, f32::from_bits(229)), Accuracy),
    // 3 + 2 · 1000 steps.
    probe("exp-far-underflow", Subnormal, "exp(−1000)", "special_exp", &[f(-1000.0)], NearOrFlushed(0.0, f32::from_bits(2003)), Accuracy),
    // 3 + 2 · 140 steps about 2⁻¹⁴⁰, which is 512 of them.
    probe("exp2-underflow", Subnormal, "exp2(−140)", "special_exp2", &[f(-140.0)], NearOrFlushed(f32::from_bits(229), f32::from_bits(795)), Accuracy),
    probe("length-of-tiny", Subnormal, "length(1e-22, 1e-22, 1e-22)", "special_length", &[f(1e-22), f(1e-22), f(1e-22)], Indeterminate, Accuracy),
    probe("dot-underflow", Subnormal, "dot(v, v), v = (2⁻⁷⁰, 0, 0)", "special_dot", &[f(two(-70)), ZERO, ZERO], KeptOrFlushed(f(two(-140))), Flush),
    probe("normalize-tiny", Subnormal, "normalize(1e-22, 1e-22, 1e-22).x", "special_normalize", &[f(1e-22), f(1e-22), f(1e-22)], Indeterminate, Accuracy),
    word(probe("subnormal-to-u32", Subnormal, "u32(1e-40)", "special_to_u32", &[TINY], Exactly(0), Conversion)),
    probe("quantize-to-subnormal", Subnormal, "quantizeToF16(2⁻²⁰)", "special_quantize", &[f(two(-20))], KeptOrFlushed(f(two(-20))), Flush),
    word(probe("pack-subnormal-half", Subnormal, "pack2x16float(2⁻²⁰, 1)", "special_pack_half", &[f(two(-20))], OneOf(&[0x3c00_0010, 0x3c00_0000, 0x3c00_8000]), Packing)),
    probe("unpack-subnormal-half", Subnormal, "unpack2x16float(0x0010).x, 2⁻²⁰", "special_unpack_half", &[0x0010], KeptOrFlushed(f(two(-20))), Packing),

    // The sign of zero.
    probe("keep-minus-zero", SignedZero, "−0, from buffer to buffer or target", "special_keep", &[MINUS_ZERO], EitherZero, ZeroSign),
    probe("negate-zero", SignedZero, "−(0)", "special_negate", &[ZERO], EitherZero, ZeroSign),
    probe("minus-zero-plus-zero", SignedZero, "−0 + 0", "special_add", &[MINUS_ZERO, ZERO], EitherZero, ZeroSign),
    probe("minus-zero-plus-minus-zero", SignedZero, "−0 + −0", "special_add", &[MINUS_ZERO, MINUS_ZERO], EitherZero, ZeroSign),
    probe("zero-times-minus-one", SignedZero, "0 · −1", "special_multiply", &[ZERO, f(-1.0)], EitherZero, ZeroSign),
    probe("abs-minus-zero", SignedZero, "abs(−0)", "special_abs", &[MINUS_ZERO], EitherZero, ZeroSign),
    probe("sign-minus-zero", SignedZero, "sign(−0)", "special_sign", &[MINUS_ZERO], EitherZero, ZeroSign),
    probe("min-of-zeros", SignedZero, "min(0, −0)", "special_min", &[ZERO, MINUS_ZERO], EitherZero, ZeroSign),
    probe("max-of-zeros", SignedZero, "max(−0, 0)", "special_max", &[MINUS_ZERO, ZERO], EitherZero, ZeroSign),
    probe("select-minus-zero", SignedZero, "select(1, −0, true)", "special_select", &[ONE, MINUS_ZERO, ONE], EitherZero, ZeroSign),
    probe("floor-minus-zero", SignedZero, "floor(−0)", "special_floor", &[MINUS_ZERO], EitherZero, ZeroSign),
    probe("ceil-to-minus-zero", SignedZero, "ceil(−0.3)", "special_ceil", &[f(-0.3)], EitherZero, ZeroSign),
    probe("round-to-minus-zero", SignedZero, "round(−0.3)", "special_round", &[f(-0.3)], EitherZero, ZeroSign),
    probe("trunc-to-minus-zero", SignedZero, "trunc(−0.3)", "special_trunc", &[f(-0.3)], EitherZero, ZeroSign),
    probe("step-minus-zero", SignedZero, "step(0, −0)", "special_step", &[ZERO, MINUS_ZERO], Exactly(ONE), Accuracy),
    probe("sqrt-minus-zero", SignedZero, "sqrt(−0)", "special_sqrt", &[MINUS_ZERO], Indeterminate, Accuracy),
    probe("sqrt-zero", SignedZero, "sqrt(0), by inverseSqrt(0)", "special_sqrt", &[ZERO], Indeterminate, Accuracy),
    probe("inverse-sqrt-minus-zero", SignedZero, "inverseSqrt(−0)", "special_inverse_sqrt", &[MINUS_ZERO], Indeterminate, Accuracy),
    truth("zeros-are-equal", SignedZero, "−0 == 0", "special_equal", &[MINUS_ZERO, ZERO], Exactly(1), ZeroSign),
    truth("minus-zero-is-not-less", SignedZero, "−0 < 0", "special_less", &[MINUS_ZERO, ZERO], Exactly(0), ZeroSign),

    // Which neighbour.
    probe("round-half", Rounding, "round(0.5)", "special_round", &[HALF], EitherZero, Accuracy),
    probe("round-one-and-a-half", Rounding, "round(1.5)", "special_round", &[f(1.5)], Exactly(f(2.0)), Accuracy),
    probe("round-two-and-a-half", Rounding, "round(2.5)", "special_round", &[f(2.5)], Exactly(f(2.0)), Accuracy),
    probe("round-below-half", Rounding, "round of the float below 0.5", "special_round", &[HALF - 1], EitherZero, Accuracy),
    probe("fract-of-tiny-negative", Rounding, "fract(−1e-10)", "special_fract", &[f(-1e-10)], OneOf(&[ONE, ONE - 1]), Accuracy),
    probe("fused-multiply-add", Rounding, "fma(x, x, −1 − 2⁻¹¹), x = 1 + 2⁻¹²", "special_fma", FUSED, OneOf(FUSED_OR_NOT), Fusion),
    probe("multiply-and-add", Rounding, "x · x + (−1 − 2⁻¹¹), x = 1 + 2⁻¹²", "special_multiply_add", FUSED, OneOf(FUSED_OR_NOT), Fusion),
    probe("odd-from-u32", Rounding, "f32(2²⁴ + 1)", "special_from_u32", &[0x0100_0001], OneOf(&[0x4b80_0000, 0x4b80_0001]), Conversion),
    probe("greatest-from-u32", Rounding, "f32(2³² − 1)", "special_from_u32", &[u32::MAX], OneOf(&[0x4f7f_ffff, 0x4f80_0000]), Conversion),
    probe("quantize-between", Rounding, "quantizeToF16(1 + 2⁻¹²)", "special_quantize", &[f(1.0 + two(-12))], OneOf(&[ONE, f(1.0 + two(-10))]), Accuracy),
];

impl Probe {
    /// The probe of that id.
    #[must_use]
    pub fn by_id(id: &str) -> Option<&'static Self> {
        PROBES.iter().find(|probe| probe.id() == id)
    }

    /// The probe of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        PROBES.iter().find(|probe| probe.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::Accept;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_reference::Real;

    /// Where the acceptance intervals know an operation, table and intervals say the same.
    #[test]
    fn promises_agree_with_the_intervals() {
        let mut compared = 0;
        for probe in PROBES {
            let Way::Function(function) = probe.way else { continue };
            if probe.inputs.iter().any(|bits| !f32::from_bits(*bits).is_finite()) {
                continue;
            }
            let x: Vec<Accept> = probe.inputs.iter().map(|bits| Accept::input(f32::from_bits(*bits))).collect();
            let interval = WGSL.scope(|| {
                Some(match function {
                    "special_add" => x[0] + x[1],
                    "special_subtract" => x[0] - x[1],
                    "special_multiply" => x[0] * x[1],
                    "special_divide" => x[0] / x[1],
                    "special_multiply_add" => x[0] * x[1] + x[2],
                    "special_sqrt" => x[0].sqrt(),
                    "special_inverse_sqrt" => x[0].inverse_sqrt(),
                    "special_exp" => x[0].exp(),
                    "special_exp2" => x[0].exp2(),
                    "special_pow" => x[0].pow(x[1]),
                    "special_mix" => Accept::mix(x[0], x[1], x[2]),
                    _ => return None,
                })
            });
            let Some(interval): Option<Accept> = interval else { continue };
            compared += 1;
            let name = probe.name;
            assert_eq!(interval.is_any(), !probe.promise.is_definite(), "{name}: {interval:?}");
            let legal = |bits: u32| interval.contains(f32::from_bits(bits).into());
            match probe.promise {
                Promise::Exactly(bits) => assert!(legal(bits), "{name}"),
                Promise::OneOf(all) => assert!(all.iter().all(|bits| legal(*bits)), "{name}: {interval:?}"),
                Promise::KeptOrFlushed(bits) => assert!(legal(bits) && legal(0), "{name}: {interval:?}"),
                Promise::NearOrFlushed(low, high) => {
                    assert!(legal(low.to_bits()) && legal(high.to_bits()) && legal(0), "{name}: {interval:?}");
                }
                Promise::EitherZero => assert!(legal(0), "{name}: {interval:?}"),
                Promise::Indeterminate => {}
            }
        }
        assert!(compared >= 30, "{compared} probes were compared");
    }
}
