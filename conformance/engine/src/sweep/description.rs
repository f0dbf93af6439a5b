//! What a sweep is: inputs, device and rules, by which files of the same sweep are told from others.

use super::plan::{Over, SweepPlan};
use super::span::Span;
use crate::device::Code;
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_document::hash;
use lightmeter_document::sweep::{Description, ExactFloat};

/// The shader that hands source colours to the blend unit.
const BLEND_FILE: &str = "blend_unit.wgsl";

/// What a plan sweeps on an adapter.
#[must_use]
pub fn describe(plan: &SweepPlan<'_>, subject: &Subject, profile: &Profile, code: &Code) -> Description {
    let (from, to, unit, file) = match plan.over {
        Over::Number { from, to, .. } => (Some(ExactFloat(from)), Some(ExactFloat(to)), "ULP", plan.member.spec.file()),
        Over::Bytes => (None, None, "step", BLEND_FILE.into()),
    };
    let adapter = &subject.identity;
    let text = subject.device().map_or_else(|| adapter.driver.clone(), |device| device.source(code, &file));
    let Span { inputs, block } = plan.span();
    Description {
        formula: plan.member.spec.id.clone(),
        over: plan.over_name(),
        from,
        to,
        fixed: plan.fixed(),
        output: plan.output_name(),
        unit: unit.into(),
        stage: plan.stage.name().into(),
        adapter: adapter.clone(),
        profile: profile.name.into(),
        shader: hash(text.as_bytes()),
        inputs,
        block,
    }
}

/// Whether a sweep is over the inputs of a plan, to the last bit.
#[must_use]
pub fn is_over_inputs_of(sweep: &Description, plan: &SweepPlan<'_>) -> bool {
    let bits = |x: Option<ExactFloat>| x.map(|ExactFloat(x)| x.to_bits());
    let ends = match plan.over {
        Over::Number { from, to, .. } => [Some(from), Some(to)].map(|x| x.map(f32::to_bits)),
        Over::Bytes => [None, None],
    };
    let fixed = plan.fixed();
    let pairs = || sweep.fixed.iter().zip(&fixed);
    [bits(sweep.from), bits(sweep.to)] == ends
        && (&sweep.over, &sweep.output) == (&plan.over_name(), &plan.output_name())
        && sweep.fixed.len() == fixed.len()
        && pairs().all(|((name, mine), (other, theirs))| name == other && mine.0.to_bits() == theirs.0.to_bits())
}

/// A sweep's inputs in blocks.
#[must_use]
pub const fn span(sweep: &Description) -> Span {
    Span { inputs: sweep.inputs, block: sweep.block }
}

/// What differs in two sweeps: `density: 0.01 there, 0.02 here`.
#[must_use]
pub(super) fn differences(sweep: &Description, other: &Description, [mine, others]: [&str; 2]) -> Vec<String> {
    let (a, b) = (leaves(sweep), leaves(other));
    let names = a.iter().chain(&b).map(|(name, _)| name.as_str());
    let mut seen: Vec<&str> = vec![];
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    let of = |leaves: &[(String, String)], name: &str| {
        leaves.iter().find(|(other, _)| other == name).map_or("nothing".to_owned(), |(_, value)| value.clone())
    };
    seen.into_iter()
        .map(|name| (name, of(&a, name), of(&b, name)))
        .filter(|(_, a, b)| a != b)
        .map(|(name, a, b)| format!("{name} is {a} {mine} and {b} {others}"))
        .collect()
}

/// A description's values by name.
fn leaves(description: &Description) -> Vec<(String, String)> {
    let exact = |ExactFloat(x): ExactFloat| format!("{x} (0x{:08x})", x.to_bits());
    let Description { formula, over, from, to, fixed, output, unit, stage, adapter, profile, shader, inputs, block } =
        description.clone();
    let mut leaves: Vec<(String, String)> = [("formula", formula), ("over", over)].map(|(k, v)| (k.into(), v)).into();
    leaves.extend([("from", from), ("to", to)].into_iter().filter_map(|(name, x)| Some((name.into(), exact(x?)))));
    leaves.extend(fixed.into_iter().map(|(name, x)| (name, exact(x))));
    let rest = [
        ("output", output),
        ("unit", unit),
        ("stage", stage),
        ("adapter", adapter.name),
        ("device", adapter.device),
        ("backend", adapter.backend.into()),
        ("driver", adapter.driver),
        ("profile", profile),
        ("the shader's text", shader),
        ("inputs", inputs.to_string()),
        ("block", block.to_string()),
    ];
    leaves.extend(rest.map(|(name, value)| (name.to_owned(), value)));
    leaves
}
