//! What the property tests share: inputs as proptest strategies, and their evaluation in one dispatch.

pub mod branches;
pub mod callers;
pub mod certificate;
pub mod directives;
pub mod exact;
pub mod forms;
pub mod frames;
pub mod harness;
pub mod mutants;
pub mod needs;
pub mod place;
pub mod readers;
pub mod running;
pub mod skip;
pub mod techniques;

use lightmeter::arithmetic::Accept;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::cases::{AnyFormula, Domain, Kind, Spec, Stage};
use lightmeter::evaluate::Evaluator;
use lightmeter::formula::intervals;
use lightmeter::judge::{Outcome, judge};
use lightmeter::select::{CaseRef, Member, catalogue};
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::{code_of, open_device};
use lightmeter_gpu::native_adapters;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use std::cell::RefCell;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// The formulas of a family that stages of rows evaluate, in groups.
///
/// # Panics
/// Where there is no such family.
#[must_use]
pub fn groups(family: &str) -> Vec<Vec<Member>> {
    let mut groups: Vec<Vec<Member>> = vec![];
    let rows = |member: &Member| !member.spec.row_stages().is_empty();
    for member in catalogue().into_iter().filter(|member| member.spec.family() == family && rows(member)) {
        match groups.last_mut() {
            Some(group) if group[0].spec.group() == member.spec.group() => group.push(member),
            _ => groups.push(vec![member]),
        }
    }
    assert!(!groups.is_empty(), "no family `{family}`");
    groups
}

/// Rows of inputs of a formula, drawn by proptest from the domains of its description.
pub fn rows(spec: &Spec) -> BoxedStrategy<Vec<f32>> {
    let described = spec.clone();
    let inputs: Vec<BoxedStrategy<Vec<f32>>> =
        spec.inputs.iter().map(|input| numbers(input.domain, input.shape.components())).collect();
    inputs
        .prop_map(move |parts| {
            let mut row = parts.concat();
            if let Some(fit) = described.fit {
                fit(&described, &mut row);
            }
            row
        })
        .boxed()
}

fn numbers(domain: Domain, len: usize) -> BoxedStrategy<Vec<f32>> {
    let each = |strategy: BoxedStrategy<f32>| proptest::collection::vec(strategy, len).boxed();
    match domain {
        Domain::Uniform(low, high) => each((low..=high).boxed()),
        Domain::LogUniform(low, high) => each((low.log2()..=high.log2()).prop_map(f32::exp2).boxed()),
        Domain::Unit => each(prop_oneof![14 => 0.0_f32..=1.0, 1 => Just(0.0), 1 => Just(1.0)].boxed()),
        Domain::Around => each((0.0_f32..=1.0).boxed()),
        Domain::Whole(low, high) => each((low..=high).prop_map(whole).boxed()),
        Domain::Halves(low, high) => {
            each((0..=200_u32).prop_map(move |k| low + ((high - low) * whole(k) / 100.0).round() * 0.5).boxed())
        }
        Domain::Pixel => (64..192_u32, 64..192_u32).prop_map(|(x, y)| vec![whole(x), whole(y)]).boxed(),
        Domain::Direction => direction().prop_map(|v| v.to_vec()).boxed(),
        Domain::Vector(low, high) => (direction(), low.log2()..=high.log2())
            .prop_map(|(v, length)| v.map(|x| x * length.exp2()).to_vec())
            .boxed(),
        Domain::Weights => proptest::collection::vec(0.0_f32..=1.0, len)
            .prop_map(|raw| {
                let sum = raw.iter().sum::<f32>().max(f32::MIN_POSITIVE);
                raw.into_iter().map(|x| x / sum).collect()
            })
            .boxed(),
        Domain::Transform(low, high) => {
            let side = if len == 16 { 4 } else { 3 };
            (proptest::collection::vec(-0.3_f32..0.3, len), low..=high)
                .prop_map(move |(raw, scale)| {
                    raw.into_iter()
                        .enumerate()
                        .map(|(k, x)| match (k / side, k % side) {
                            (_, 3) => {
                                if k == 15 {
                                    1.0
                                } else {
                                    0.0
                                }
                            }
                            (column, row) if column == row => scale + x,
                            _ => x,
                        })
                        .collect()
                })
                .boxed()
        }
    }
}

/// Unit vectors, as near as f32 holds them; shrinks towards +z.
pub fn direction() -> impl Strategy<Value = [f32; 3]> {
    (-1.0_f32..=1.0, -1.0_f32..=1.0, -1.0_f32..=1.0).prop_map(|(x, y, z)| {
        let length = (x * x + y * y + z * z).sqrt();
        if length < 0.1 { [0.0, 0.0, 1.0] } else { [x / length, y / length, z / length] }
    })
}

#[expect(clippy::cast_precision_loss, reason = "small whole numbers are exact")]
fn whole(k: u32) -> f32 {
    k as f32
}

/// The one device of this process.
///
/// # Panics
/// Where there is no driver: `./x test` installs one.
pub fn device() -> MutexGuard<'static, Subject> {
    static DEVICE: OnceLock<Mutex<Subject>> = OnceLock::new();
    let open = || {
        let adapters = native_adapters();
        let adapter = adapters.first().expect("no Vulkan driver is here: `./x test` installs lavapipe");
        Mutex::new(open_device(adapter).expect("the adapter gives a device"))
    };
    DEVICE.get_or_init(open).lock().unwrap_or_else(PoisonError::into_inner)
}

/// Agreement of the GPU with the reference on a whole group: proptest draws thousands of rows, one dispatch a stage
/// evaluates them, and a failure shrinks to one row.
///
/// # Panics
/// Where a value lies outside its interval.
pub fn agree(group: &[Member], rows_at_most: usize) {
    let mut subject = device();
    let code = code_of(None).expect("the built-in shaders are valid");
    let members: Vec<&Member> = group.iter().collect();
    let evaluator = Evaluator::new(&mut subject, &members, &code).expect("the group compiles");
    let row = (0..members.len()).prop_flat_map({
        let strategies: Vec<_> = members.iter().map(|member| rows(&member.spec)).collect();
        move |of| (Just(of), strategies[of].clone())
    });
    let batch = proptest::collection::vec(row, 1..=rows_at_most);
    let config =
        ProptestConfig { cases: 2, max_shrink_iters: 2000, failure_persistence: None, ..ProptestConfig::default() };
    let mut runner = proptest::test_runner::TestRunner::new_with_rng(
        config,
        proptest::test_runner::TestRng::deterministic_rng(proptest::test_runner::RngAlgorithm::ChaCha),
    );
    let subject = RefCell::new(subject);
    let result = runner.run(&batch, |batch| {
        let mut subject = subject.borrow_mut();
        let of: Vec<usize> = batch.iter().map(|(of, _)| *of).collect();
        let inputs: Vec<f32> = batch.iter().flat_map(|(_, row)| row.iter().copied()).collect();
        let stages =
            evaluator.run(&mut subject, &of, &inputs).map_err(|error| TestCaseError::fail(error.to_string()))?;
        for (stage, words) in stages {
            let Ok(words) = words else { continue };
            let outputs = members[0].spec.output_len();
            for ((of, row), words) in batch.iter().zip(words.chunks_exact(outputs)) {
                verdict(members[*of], row, stage, &subject, words)?;
            }
        }
        Ok(())
    });
    if let Err(error) = result {
        panic!("{}: {error}", members[0].spec.group());
    }
}

fn verdict(member: &Member, row: &[f32], stage: Stage, subject: &Subject, words: &[u32]) -> Result<(), TestCaseError> {
    let outputs = words.len();
    let mut reference = vec![0.0; outputs];
    member.formula.reference(row, &mut reference);
    let mut legal = vec![Accept::ANY; outputs];
    let mut profile = WGSL;
    for deviation in &subject.known.deviations {
        profile = lightmeter::devices::grant(deviation, profile);
    }
    intervals(member, row, stage, &subject.known, &profile, &mut legal);
    for (output, &bits) in words.iter().enumerate() {
        if judge(bits, reference[output], &legal[output]).outcome == Outcome::Fail {
            let hex: Vec<String> = row.iter().map(|x| format!("0x{:08x}", x.to_bits())).collect();
            return Err(TestCaseError::fail(format!(
                "{} {}, {}: {:?} (0x{bits:08x}) where {} is right and {:?} legal; inputs {row:?} ({})",
                member.spec.id,
                stage.name(),
                member.spec.output_name(output),
                f32::from_bits(bits),
                reference[output],
                (legal[output].low(), legal[output].high()),
                hex.join(" "),
            )));
        }
    }
    Ok(())
}

/// Controls for a family: for every formula the value just outside either end of its interval must fail, the reference
/// rounded to f32 must pass, and so must both ends.
///
/// # Panics
/// Where the comparator lets a wrong value pass, or fails a right one.
pub fn control(family: &str) {
    for member in groups(family).iter().flatten() {
        for k in 0..32 {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), 7, &mut row);
            control_row(member, &row);
        }
    }
}

fn control_row(member: &Member, row: &[f32]) {
    let outputs = member.spec.output_len();
    let mut reference = vec![0.0; outputs];
    let formula: &dyn AnyFormula = member.formula.as_ref();
    formula.reference(row, &mut reference);
    let mut legal = vec![Accept::ANY; outputs];
    match member.spec.kind {
        Kind::Raster(kind) => formula.raster_interval(kind, row, &WGSL, &mut legal),
        Kind::Arithmetic | Kind::Blend(_) | Kind::Depth(_) => formula.interval(row, &WGSL, &mut legal),
    }
    for (reference, legal) in reference.iter().zip(&legal).filter(|(_, legal)| !legal.is_any()) {
        control_value(&member.spec.id, *reference, legal);
    }
}

fn control_value(id: &str, reference: f64, legal: &Accept) {
    #[expect(clippy::cast_possible_truncation, reason = "ends lie on the grid of f32, but where they were flushed")]
    let narrow = |x: f64| x as f32;
    let outcome = |value: f32| judge(value.to_bits(), reference, legal).outcome;
    assert!(legal.contains(reference), "{id}: the reference itself, {reference} in {legal:?}");
    assert_eq!(outcome(narrow(legal.low())), Outcome::Pass, "{id}: the lower end of {legal:?}");
    assert_eq!(outcome(narrow(legal.high())), Outcome::Pass, "{id}: the upper end of {legal:?}");
    assert_eq!(outcome(narrow(legal.low()).next_down()), Outcome::Fail, "{id}: below {legal:?}");
    assert_eq!(outcome(narrow(legal.high()).next_up()), Outcome::Fail, "{id}: above {legal:?}");
    assert_eq!(outcome(f32::NAN), Outcome::Fail, "{id}: NaN");
}
