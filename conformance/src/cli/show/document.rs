//! A case of a formula as the document of `show`.

use super::unit::{UnitAnswer, unit_answer};
use super::{Answer, Known, outcome};
use lightmeter::arithmetic::Accept;
use lightmeter::cases::Input;
use lightmeter::document::report::Examined;
use lightmeter::document::show::{SCHEMA, ShownAnswer, ShownCase, ShownMeaning, ShownOutput, ShownValue};
use lightmeter::document::{Number, Word};
use lightmeter::faults::shown_step;
use lightmeter::formula::by_name;
use lightmeter::select::{CaseRef, Member};

pub(super) fn case(
    member: &Member,
    case: CaseRef,
    known: &Known,
    answers: &[Answer],
    unit: &[UnitAnswer],
    forms: Vec<Examined>,
) -> ShownCase {
    let spec = &member.spec;
    let meaning = |one: &Input| ShownMeaning { name: one.name.into(), means: spec.input_means(one).into() };
    let means: Vec<&'static str> =
        spec.outputs.iter().flat_map(|one| vec![spec.output_means(one); one.shape.components()]).collect();
    let output = |k: usize| ShownOutput {
        name: spec.output_name(k),
        means: means[k].into(),
        reference: Number(known.outputs[k].value),
        interval: bounds(&known.outputs[k].interval),
        condition: Number(known.condition[k]),
    };
    let rows = answers.iter().map(|one| answer(member, known, one));
    ShownCase {
        schema: SCHEMA.into(),
        id: member.case_id(case),
        formula: member.spec.text.into(),
        rules: member.spec.rules().into_iter().map(Word::from).collect(),
        source: member.spec.source.into(),
        inputs_mean: spec.inputs.iter().map(meaning).collect(),
        inputs: by_name(member, &known.inputs, |x| serde_json::to_value(Number(x.into())).unwrap_or_default()),
        inputs_hex: by_name(member, &known.inputs, |x| format!("0x{:08x}", x.to_bits()).into()),
        steps: known.steps.iter().map(shown_step).collect(),
        outputs: (0..known.outputs.len()).map(output).collect(),
        conditioning: known.conditioning,
        answers: rows.chain(unit.iter().map(unit_answer)).collect(),
        forms,
        mistake: None,
    }
}

fn bounds(interval: &Accept) -> [Number; 2] {
    [Number(interval.low()), Number(interval.high())]
}

fn answer(member: &Member, known: &Known, answer: &Answer) -> ShownAnswer {
    let value = |(k, &(bits, legal)): (usize, &(u32, Accept))| {
        let (outcome, error) = outcome(bits, known.outputs[k].value, &legal);
        ShownValue {
            output: member.spec.output_name(k),
            value: Number(f32::from_bits(bits).into()),
            hex: Some(format!("0x{bits:08x}")),
            reference: None,
            interval: bounds(&legal),
            outcome: outcome.into(),
            error_ulp: Number(error),
        }
    };
    let values = answer.values.as_ref().map(|values| values.iter().enumerate().map(value).collect());
    ShownAnswer {
        adapter: answer.adapter.clone(),
        stage: answer.stage.into(),
        target: None,
        route: None,
        skipped: values.as_ref().err().map(|&&reason| reason.into()),
        values: values.ok(),
    }
}
