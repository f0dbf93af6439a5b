//! What a blend unit makes of a case.

use lightmeter::arithmetic::Profile;
use lightmeter::blend_unit::draw::draw;
use lightmeter::blend_unit::expect::{ExpectedPixel, expect};
use lightmeter::blend_unit::pixel::Units;
use lightmeter::blend_unit::rules::{Rules, unit_name};
use lightmeter::blend_unit::run::targets_of;
use lightmeter::cases::Stage;
use lightmeter::cases::blend::Program;
use lightmeter::device::Code;
use lightmeter::document::Number;
use lightmeter::document::show::{ShownAnswer, ShownValue};
use lightmeter::judge::Outcome;
use lightmeter::piece::Piece;
use lightmeter::select::Member;
use lightmeter::subject::Subject;
use lightmeter_scene::blend::{Route, routes};
use lightmeter_scene::target::TargetFormat;
use std::fmt::Write as _;

/// A blend unit's answer, in the target's units.
pub(super) struct UnitAnswer {
    adapter: String,
    target: TargetFormat,
    route: Route,
    pixel: Result<(Units, ExpectedPixel), &'static str>,
}

/// What the blend unit makes of it, on each target and by each route.
pub(super) fn drawn(
    targets: &[TargetFormat],
    subject: &mut Subject,
    code: &Code,
    member: &Member,
    program: Program,
    inputs: &[f32],
    profile: &Profile,
) -> anyhow::Result<Vec<UnitAnswer>> {
    let mut answers = vec![];
    for target in targets_of(member, targets) {
        for &route in routes(program.layer(0).0) {
            let piece = Piece { program, route, inputs: inputs.to_vec(), stride: inputs.len() };
            let lacks = subject.lacks_blending(target).or(subject.lacks_route(code, route)?);
            let pixel = match lacks {
                Some(reason) => Err(reason),
                None => {
                    let pixel = draw(subject, code, target, &[&piece], false)?.pieces[0][0];
                    Ok((pixel, expect(program, target, &piece.case(0), &Rules::RIGHT, profile)))
                }
            };
            answers.push(UnitAnswer { adapter: subject.identity.name.clone(), target, route, pixel });
        }
    }
    Ok(answers)
}

/// The answers as text.
pub(super) fn unit_text(answers: &[UnitAnswer]) -> anyhow::Result<String> {
    let mut text = String::new();
    for UnitAnswer { adapter, target, route, pixel } in answers {
        let unit = unit_name(*target);
        writeln!(text, "\n{adapter}, fixed-function on {}, {}", target.name(), route.name())?;
        match pixel {
            Err(reason) => writeln!(text, "  skipped: {reason}")?,
            Ok((pixel, expected)) => {
                for k in 0..4 {
                    let verdict = expected.judge(*target, k, pixel[k]);
                    let (value, reference) = (Number(pixel[k]).to_string(), Number(expected.reference[k]));
                    let legal = match verdict.outcome {
                        Outcome::Indeterminate => "anything".into(),
                        _ => format!("{} to {}", Number(expected.low[k]), Number(expected.high[k])),
                    };
                    writeln!(
                        text,
                        "  color.{:<16} {value:<24} {}, {:.3} {unit} from {reference}; legal here {legal}",
                        COMPONENTS[k],
                        verdict.outcome.name(),
                        verdict.error
                    )?;
                }
            }
        }
    }
    Ok(text)
}

/// An answer as a part of the document.
pub(super) fn unit_answer(answer: &UnitAnswer) -> ShownAnswer {
    let UnitAnswer { adapter, target, route, pixel } = answer;
    let values = pixel.as_ref().map(|(pixel, expected)| {
        let value = |k: usize| {
            let verdict = expected.judge(*target, k, pixel[k]);
            ShownValue {
                output: format!("color.{}", COMPONENTS[k]),
                value: Number(pixel[k]),
                hex: None,
                reference: Some(Number(expected.reference[k])),
                interval: [Number(expected.low[k]), Number(expected.high[k])],
                outcome: verdict.outcome.name().into(),
                error_ulp: Number(verdict.error),
            }
        };
        (0..4).map(value).collect()
    });
    ShownAnswer {
        adapter: adapter.clone(),
        stage: Stage::FixedFunction.name().into(),
        target: Some(target.name().into()),
        route: Some(route.name().into()),
        skipped: values.as_ref().err().map(|&&reason| reason.into()),
        values: values.ok(),
    }
}

const COMPONENTS: [&str; 4] = ["r", "g", "b", "a"];
