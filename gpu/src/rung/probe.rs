//! Whether a device's arithmetic is what a rung takes it for: a compiler may undo error-free transforms, and drivers have
//! functions of f64 that give garbage. Few numbers, each with what must come out of it.

use super::Rung;
use super::dialect::Prelude;
use crate::device::{Executor, Gpu};
use crate::error::GpuError;
use crate::work::{BindGroup, Buffer, ComputePass, ComputePipeline, Read, Resources, Step, Submission};
use wgpu_types::BufferUsages;

/// What is wrong with what came of two numbers.
type Judge = fn(f64, f64, &[f32]) -> Option<&'static str>;

/// Pairs of numbers that are tried.
const PAIRS: usize = 256;

/// Why the rung is unavailable, by what its arithmetic gives; `None` where it is as it should be.
pub(super) fn probe(rung: Rung, gpu: &Gpu) -> Result<Option<String>, GpuError> {
    probe_with(rung, &Prelude::of(rung).text, gpu)
}

pub(super) fn probe_with(rung: Rung, prelude: &str, gpu: &Gpu) -> Result<Option<String>, GpuError> {
    let (entry, words, judge): (_, _, Judge) = match rung {
        Rung::Cheap | Rung::F32 | Rung::Stable => return Ok(None),
        Rung::F16 => (HALF, 4, judge_half),
        Rung::DoubleFloat => (DOUBLE_FLOAT, 6, judge_double_float),
        Rung::F64 => (DOUBLE, 24, judge_double),
    };
    if let Some(reason) = gpu.lacks_compute() {
        return Ok(Some(reason.into()));
    }
    let pairs = pairs(rung);
    let given: Vec<f32> = pairs.iter().flatten().copied().collect();
    let enable = if rung == Rung::F16 { "enable f16;\n" } else { "" };
    let found = evaluate(gpu, rung, format!("{enable}{entry}\n{prelude}"), &given, words)?;
    let mut lost: Vec<&str> = vec![];
    for (&[x, y], found) in pairs.iter().zip(found.chunks_exact(words)) {
        lost.extend(judge(x.into(), y.into(), found));
    }
    Ok(lost.first().map(|first| format!("{first}: so of {} of {PAIRS} pairs of numbers that were tried", lost.len())))
}

/// Numbers of either sign whose sums and products f64 holds; for f16, such as are numbers of it, and not negative for f64.
fn pairs(rung: Rung) -> Vec<[f32; 2]> {
    let mut state = 0x9e37_79b9_u32;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        let bits = state;
        let (exponent, negative) = (120 + (bits >> 24) % 14, bits >> 31);
        match rung {
            Rung::F16 => f32::from_bits((exponent << 23) | (bits & 0x007f_e000)),
            Rung::F64 => f32::from_bits((exponent << 23) | (bits & 0x007f_ffff)),
            _ => f32::from_bits((negative << 31) | (exponent << 23) | (bits & 0x007f_ffff)),
        }
    };
    (0..PAIRS).map(|_| [next(), next()]).collect()
}

const DOUBLE_FLOAT: &str = "
fn probed(x: f32, y: f32) -> array<f32, 6> {
    let sum = rung_two_sum_1(x, y);
    let product = rung_two_product_1(x, y);
    // (x + y)(x - y)/y - x.
    let added = rung_add_1(DF1(x, 0.0), DF1(y, 0.0));
    let less = rung_sub_1(DF1(x, 0.0), DF1(y, 0.0));
    let chain = rung_sub_1(rung_div_1(rung_mul_1(added, less), DF1(y, 0.0)), DF1(x, 0.0));
    return array<f32, 6>(sum.hi, sum.lo, product.hi, product.lo, chain.hi, chain.lo);
}
";

fn judge_double_float(x: f64, y: f64, found: &[f32]) -> Option<&'static str> {
    let value = |k: usize| f64::from(found[k]) + f64::from(found[k + 1]);
    let chain = (x + y) * (x - y) / y - x;
    let size = ((x + y) * (x - y) / y).abs() + x.abs();
    // Exact: f64 holds both.
    let is_exact = value(0).to_bits() == (x + y).to_bits() && value(2).to_bits() == (x * y).to_bits();
    // Five operations of 2^-46 each, and f64's own.
    let is_kept = is_exact && (value(4) - chain).abs() <= 2.0_f64.powi(-43) * size;
    (!is_kept).then_some("the compiler takes error-free transforms apart")
}

const DOUBLE: &str = "
fn probed(x32: f32, y32: f32) -> array<f32, 24> {
    let x = f64(x32);
    let y = f64(y32);
    let values = array<f64, 8>(
        x + y, x - y, x * y, x / y, sqrt(x), rung_exp_1(-x), rung_log_1(x), rung_pow_1(x / (x + y), y),
    );
    var words: array<f32, 24>;
    for (var k = 0u; k < 8u; k++) {
        let parts = rung_parts(values[k]);
        words[3u * k] = parts.x;
        words[3u * k + 1u] = parts.y;
        words[3u * k + 2u] = parts.z;
    }
    return words;
}
";

fn judge_double(x: f64, y: f64, found: &[f32]) -> Option<&'static str> {
    let value = |k: usize| f64::from(found[3 * k]) + f64::from(found[3 * k + 1]) + f64::from(found[3 * k + 2]);
    let expected = [x + y, x - y, x * y, x / y, x.sqrt(), (-x).exp(), x.ln(), (x / (x + y)).powf(y)];
    let names = ["+ of f64 is off", "- of f64 is off", "* of f64 is off", "/ of f64 is off", "sqrt of f64 is off"];
    let others = ["exp of f64 is off", "log of f64 is off", "pow of f64 is off"];
    // Beyond what f32 holds of the least part, and a hundred roundings of the largest.
    let is_off = |k: usize| (value(k) - expected[k]).abs() > 1e-13 * expected[k].abs() + 1e-42 || value(k).is_nan();
    names.into_iter().chain(others).enumerate().find(|(k, _)| is_off(*k)).map(|(_, name)| name)
}

const HALF: &str = "
fn probed(x: f32, y: f32) -> array<f32, 4> {
    let a = f16(x);
    let b = f16(y);
    return array<f32, 4>(f32(a + b), f32(a - b), f32(a * b), f32(a * b + a));
}
";

fn judge_half(x: f64, y: f64, found: &[f32]) -> Option<&'static str> {
    let value = |k: usize| f64::from(found[k]);
    let fused = as_half(x * y + x);
    let twice = as_half(as_half(x * y) + x);
    let is_exact = |k: usize, exact: f64| value(k).to_bits() == as_half(exact).to_bits();
    let is_right = is_exact(0, x + y)
        && (is_exact(1, x - y) || x - y == 0.0)
        && is_exact(2, x * y)
        && [fused, twice].iter().any(|legal| legal.to_bits() == value(3).to_bits());
    (!is_right).then_some("f16 is not rounded as binary16 is")
}

/// The nearest number of binary16, the even one of two, where it is a normal one.
fn as_half(x: f64) -> f64 {
    if x == 0.0 {
        return x;
    }
    let exponent = i32::try_from((x.to_bits() >> 52) & 0x7ff).unwrap_or(0) - 1023;
    let ulp = 2.0_f64.powi(exponent.max(-14) - 10);
    (x / ulp).round_ties_even() * ulp
}

/// What `probed` gives of each pair.
fn evaluate(gpu: &Gpu, rung: Rung, source: String, given: &[f32], words: usize) -> Result<Vec<f32>, GpuError> {
    let source = format!(
        "{source}
@group(0) @binding(0) var<storage, read> given: array<vec2f, {PAIRS}>;
@group(0) @binding(1) var<storage, read_write> found: array<f32, {count}>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {{
    {zero}
    var words = probed(given[id.x].x, given[id.x].y);
    for (var k = 0u; k < {words}u; k++) {{
        found[id.x * {words}u + k] = words[k];
    }}
}}
",
        count = PAIRS * words,
        zero = if rung == Rung::DoubleFloat { "rung_zero = id.y;" } else { "" },
    );
    let mut resources = Resources::default();
    let shader = resources.shader("probe", source);
    let pipeline = resources.pipeline(ComputePipeline::new("probe", shader, "main"));
    let mut executor = Executor::default();
    executor.make(gpu, &resources, "rung/probe")?;
    let mut work = Submission::default();
    let given = work.buffer(Buffer::of(given, BufferUsages::STORAGE));
    let found = work.buffer(Buffer::sentinels(PAIRS * words, BufferUsages::STORAGE | BufferUsages::COPY_SRC));
    let group = work.group(BindGroup::of_buffers(pipeline, &[given, found]));
    let workgroups = [u32::try_from(PAIRS / 64).unwrap_or(u32::MAX), 1, 1];
    work.steps.push(Step::Compute(ComputePass { pipeline, group, workgroups }));
    work.reads.push(Read::Buffer { buffer: found, bytes: 4 * PAIRS * words });
    let bits = executor.submit(gpu, &work).wait(gpu)?;
    Ok(bits.into_iter().map(f32::from_bits).collect())
}
