//! Shards of a renderer's result, joined in any order, are what one run of everything reports: counts, failing cases, what explains them, and what
//! is wrong with whole groups.

use lightmeter::blend_unit::embedded::blend;
use lightmeter::blend_unit::rules::{FAULTS, Rules};
use lightmeter::cases::blend::{Program, UnitCase};
use lightmeter::cases::{GENERATOR_VERSION, Spec};
use lightmeter::device::Code;
use lightmeter::document::by_case::ComparedBy;
use lightmeter::document::event::Silent;
use lightmeter::document::pack::Choice;
use lightmeter::document::report::Report;
use lightmeter::document::{Document as _, Number};
use lightmeter::faults::{Mistakes, Variation, concerning};
use lightmeter::filter::Filter;
use lightmeter::gate::hello::Hello;
use lightmeter::gate::renderer::{InProcess, Renderer};
use lightmeter::merge::merge;
use lightmeter::options::Options;
use lightmeter::run::run;
use lightmeter::select::{Member, Shard, catalogue};
use lightmeter::subject::Subject;
use lightmeter_scene::target::TargetFormat;
use proptest::prelude::*;
use std::num::NonZeroU64;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

static CATALOGUE: LazyLock<Arc<[Member]>> = LazyLock::new(|| catalogue().into());

/// How a formula is computed.
#[derive(Clone, Debug)]
enum Wrong {
    /// With a mistake of the catalogue, the k-th that concerns the formula.
    Mistake(usize),
    /// Some factor times what is right: of one it is right, of one and a little each value is legal.
    Scaled(f32),
    /// By nothing that the catalogue knows, in every n-th case.
    Noise(u32),
}

/// A renderer whose formulas are wrong in these ways, and whose target of 8 bits truncates or not.
struct Faulty {
    wrong: Vec<(&'static str, Wrong)>,
    truncates: bool,
}

const FORMULAS: [&str; 3] = ["fog/exp", "vector/normalize", "attenuation/polynomial"];
const STATES: &str = "blend/add/{one,src-alpha}/{one,zero,one-minus-src-alpha}";

impl Renderer for Faulty {
    fn hello(&self) -> Hello {
        let mut formulas: Vec<String> = FORMULAS.map(String::from).to_vec();
        formulas.push(STATES.into());
        Hello { renderer: "faulty".into(), formulas, targets: vec!["rgba8unorm".into()], ..Hello::everything() }
    }

    fn evaluate(&mut self, spec: &Spec, inputs: &[f32]) -> Result<Vec<f32>, String> {
        let member = CATALOGUE.iter().find(|member| member.spec.id == spec.id).ok_or("no such formula")?;
        let mut out = vec![0.0_f32; spec.output_len()];
        member.formula.embedded(inputs, &mut out);
        match self.wrong.iter().find(|(id, _)| *id == spec.id).map(|(_, wrong)| wrong) {
            None => {}
            Some(Wrong::Mistake(k)) => {
                let faults = concerning(member);
                let variation = Variation::new(member, &[faults[k % faults.len()]]).ok_or("it does not concern it")?;
                variation.evaluate(inputs, &mut out);
            }
            Some(Wrong::Scaled(factor)) => out.iter_mut().for_each(|value| *value *= factor),
            Some(Wrong::Noise(n)) => {
                let bits = inputs.iter().fold(0_u32, |bits, x| bits.rotate_left(5) ^ x.to_bits());
                if bits.is_multiple_of(*n) {
                    out.iter_mut().for_each(|value| *value = f32::from_bits(bits & 0x3fff_ffff));
                }
            }
        }
        Ok(out)
    }

    fn blend(&mut self, program: Program, target: TargetFormat, case: &UnitCase) -> Result<[f32; 4], String> {
        let truncated = FAULTS.iter().find(|fault| self.truncates && fault.name == "truncate");
        let rules = truncated.map_or(Rules::RIGHT, |fault| fault.rules);
        #[expect(clippy::cast_possible_truncation, reason = "steps of 8 bits")]
        Ok(blend(program, target, case, &rules).map(|value| value as f32))
    }
}

/// One that it does not declare.
const LACKING: &str = "color/modulate";

/// What the renderer's result is, of all cases or of a shard.
fn judged(wrong: &[(&'static str, Wrong)], truncates: bool, cases: u64, shard: Shard) -> Report {
    let renderer = Faulty { wrong: wrong.to_vec(), truncates };
    let renderer = InProcess::new(renderer, PathBuf::new()).expect("what it declares can be read");
    let mut filter: Vec<String> = FORMULAS.map(String::from).to_vec();
    filter.extend([STATES.into(), LACKING.into()]);
    let options = Options {
        filter: Filter::new(&filter).expect("the globs are valid"),
        cases,
        shard,
        targets: vec![TargetFormat::Rgba8Unorm],
        diagnose: Some(&Mistakes),
        counts_cases: true,
        ..Options::new(Code::default())
    };
    let mut subject = Subject::renderer(renderer.identity(), Box::new(renderer));
    let report =
        run(std::slice::from_mut(&mut subject), &options, &mut Silent).expect("nothing fails but the renderer");
    let is_part = shard != Shard::WHOLE;
    let compared_by = ComparedBy {
        choice: Choice { filter, cases, seed: 1, ..Choice::default() },
        generator: GENERATOR_VERSION,
        shard: is_part.then(|| format!("{}/{}", shard.index + 1, shard.count)),
        ..ComparedBy::default()
    };
    let report = Report { compared_by: Some(compared_by), ..report };
    // As a file has it.
    Report::read(&report.to_json().expect("a report is JSON")).expect("what is written is read")
}

/// A report but for what a sum over parts has otherwise: times, how often the renderer was started, and the last digits of a mean.
fn alike(mut report: Report) -> String {
    report.seconds = 0.0;
    report.timing = Default::default();
    if let Some(renderer) = &mut report.renderer {
        renderer.starts = 0;
        renderer.warnings.clear();
    }
    for group in &mut report.groups {
        group.seconds = 0.0;
        if let Some(counts) = &mut group.by_case {
            let shown = format!("{:.9e}", counts.error_mean.0);
            counts.error_mean = Number(shown.parse().expect("a number"));
        }
        if let Some(store) = &mut group.store {
            store.bias = format!("{:.6e}", store.bias).parse().expect("a number");
        }
    }
    report.to_json().expect("a report is JSON")
}

fn wrong() -> impl Strategy<Value = Wrong> {
    prop_oneof![
        (0..64_usize).prop_map(Wrong::Mistake),
        prop_oneof![Just(1.0_f32), Just(1.000_000_4), Just(1.02), Just(0.4)].prop_map(Wrong::Scaled),
        (2..9_u32).prop_map(Wrong::Noise),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5, max_shrink_iters: 0, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn shards_in_any_order_are_the_whole(
        ways in proptest::array::uniform3(wrong()),
        truncates: bool,
        cases in prop_oneof![Just(64_u64), Just(300), Just(4200)],
        count in 2..6_u64,
        order: u64,
    ) {
        let wrong: Vec<(&'static str, Wrong)> = FORMULAS.into_iter().zip(ways).collect();
        let whole = judged(&wrong, truncates, cases, Shard::WHOLE);
        let count = NonZeroU64::new(count).expect("it is at least 2");
        let shard = |index| judged(&wrong, truncates, cases, Shard { index, count });
        let mut parts: Vec<(PathBuf, Report)> =
            (0..count.get()).map(|index| (PathBuf::from(format!("{index}.json")), shard(index))).collect();
        parts.sort_by_key(|(path, _)| {
            use std::hash::{Hash as _, Hasher as _};
            let mut hasher = std::hash::DefaultHasher::new();
            (order, path).hash(&mut hasher);
            hasher.finish()
        });
        let merged = merge(parts, &Mistakes).expect("they are of one run");
        // What they are compared by says that the one is the whole.
        let compared_by = whole.compared_by.clone();
        prop_assert_eq!(alike(Report { compared_by, ..merged }), alike(whole));
    }
}
