//! The ladder: the same WGSL in more digits agrees with the f64 reference, as far as the condition allows.

use lightmeter::cases::{Kind, Size};
use lightmeter::select::{CaseRef, Member, catalogue};
use lightmeter::stability::{condition, size};
use lightmeter_gpu::{Gpu, Kernel, RepeatPipeline, Rung, Shaders, adapters};

/// Random rows of each formula.
const ROWS: u64 = 64;

/// The values of a formula's outputs in a rung's arithmetic, row after row; `None` where it is unavailable.
fn values(gpu: &Gpu, shaders: &Shaders, member: &Member, rung: Rung, rows: &[Vec<f32>]) -> Result<Vec<f64>, String> {
    let file = format!("{}.wgsl", member.spec.family());
    let failed = |error: lightmeter_gpu::GpuError| panic!("{} at {}: {error}", member.spec.id, rung.name());
    let kernel = Kernel::new(shaders, &file, member.spec.function).unwrap_or_else(failed);
    let selectors = member.spec.selectors.iter().map(|&code| f32::from_bits(code));
    let given: Vec<f32> = rows.iter().flat_map(|row| selectors.clone().chain(row.iter().copied())).collect();
    let pipeline = RepeatPipeline::new(gpu, shaders, &kernel, rung, &given).unwrap_or_else(|error| {
        panic!("{} at {}: {error}", member.spec.id, rung.name());
    })?;
    let words =
        pipeline.outputs(gpu, &given).unwrap_or_else(|error| panic!("{} at {}: {error}", member.spec.id, rung.name()));
    let value = |parts: &[u32]| parts.iter().rev().map(|&part| f64::from(f32::from_bits(part))).sum();
    Ok(words.chunks_exact(rung.parts()).map(value).collect())
}

/// Naive forms, which subtract from 1 what is nearly 1: their errors are shares of 1 in any arithmetic.
const CANCELLING: [&str; 3] = ["fog/opacity", "blend/opacity-of-layers", "interpolation/last-weight-by-difference"];

/// What departs farther from the reference than `share` of the size, times the condition where that is above 1.
fn offenders(gpu: &Gpu, rung: Rung, share: f64, step: usize) -> (usize, (f64, String), Vec<String>) {
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let (mut checked, mut most, mut found) = (0, (0.0, String::new()), vec![]);
    let catalogue = catalogue();
    let members = catalogue.iter().filter(|member| matches!(member.spec.kind, Kind::Arithmetic));
    for member in members.step_by(step) {
        let rows: Vec<Vec<f32>> = (0..ROWS)
            .map(|k| {
                let mut row = vec![];
                member.inputs(CaseRef::Random(k), 17, &mut row);
                row
            })
            .collect();
        let values = match values(gpu, &shaders, member, rung, &rows) {
            Ok(values) => values,
            Err(reason) => {
                found.push(format!("{}: {reason}", member.spec.id));
                continue;
            }
        };
        let outputs = member.spec.output_len();
        let size = if CANCELLING.contains(&member.spec.id.as_str()) { Size::Unit } else { size(&member.spec) };
        let mut worst: Option<(f64, String)> = None;
        for (row, values) in rows.iter().zip(values.chunks_exact(outputs)) {
            let mut exact = vec![0.0; outputs];
            member.formula.reference(row, &mut exact);
            let is_normal = |x: &f64| *x == 0.0 || (x.is_finite() && (1e-30..1e30).contains(&x.abs()));
            let condition = condition(member.formula.as_ref(), row, size);
            if !exact.iter().all(is_normal) || !condition.is_finite() {
                continue;
            }
            checked += 1;
            let own = exact.iter().map(|x| x * x).sum::<f64>().sqrt();
            let size = if size == Size::Unit { own.max(1.0) } else { own };
            let off = values.iter().zip(&exact).map(|(v, x)| (v - x).powi(2)).sum::<f64>().sqrt();
            let times = off / (share * condition.max(1.0) * size);
            if off != 0.0 && times > most.0 {
                most = (times, member.spec.id.clone());
            }
            // What is 0 is to be 0.
            let is_off = off != 0.0 && (times.is_nan() || times > 1.0);
            if is_off && worst.as_ref().is_none_or(|(worst, _)| times.is_nan() || times > *worst) {
                let text = format!(
                    "{}: {times:e} times the bound, condition {condition:e}: {values:?} for {exact:?} of {row:?}",
                    member.spec.id
                );
                worst = Some((times, text));
            }
        }
        found.extend(worst.map(|(_, text)| text));
    }
    (checked, most, found)
}

#[expect(clippy::print_stdout, reason = "how close they are is worth seeing with `--nocapture`")]
fn every_adapter(rung: Rung, share: f64) {
    for (place, adapter) in adapters().into_iter().enumerate() {
        let gpu = adapter.open().unwrap_or_else(|error| panic!("{error}"));
        if rung.unavailable(&gpu).unwrap_or_else(|error| panic!("{error}")).is_some() {
            continue;
        }
        // What takes long is to compile: the first adapter is asked everything, the others every fourth formula.
        let step = if place == 0 { 1 } else { 4 };
        let (checked, most, found) = offenders(&gpu, rung, share, step);
        println!("{}, {}: {checked} rows, at most {:.2} of the bound: {}", adapter.name, rung.name(), most.0, most.1);
        assert!(found.is_empty(), "{}: {} offenders\n{}", adapter.name, found.len(), found.join("\n"));
        assert!(checked > 4000 / step, "{}: only {checked} rows were checked", adapter.name);
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn f64_agrees_with_the_reference() {
    every_adapter(Rung::F64, 1e-12);
}

#[test]
#[ignore = "long: ./x campaign long"]
fn double_floats_agree_with_the_reference() {
    every_adapter(Rung::DoubleFloat, 2.0_f64.powi(-38));
}

/// The control: f32 does not.
#[test]
#[ignore = "long: ./x campaign long"]
fn f32_is_found_out() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let adapters = adapters();
    let gpu = adapters[0].open().unwrap_or_else(|error| panic!("{error}"));
    let (_, _, found) = offenders(&gpu, Rung::F32, 2.0_f64.powi(-38), 1);
    assert!(found.len() > 60, "{} formulas depart", found.len());
}
