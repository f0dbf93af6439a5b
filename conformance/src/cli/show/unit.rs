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
use lightmeter::judge::Outcome;
use lightmeter::piece::Piece;
use lightmeter::select::Member;
use lightmeter::subject::Subject;
use lightmeter_scene::blend::{Route, routes};
use lightmeter_scene::target::TargetFormat;
use serde_json::{Value, json};
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

/// The same as JSON.
pub(super) fn unit_json(answer: &UnitAnswer) -> Value {
    let UnitAnswer { adapter, target, route, pixel } = answer;
    let mut json = json!({
        "adapter": adapter, "stage": Stage::FixedFunction.name(), "target": target.name(), "route": route.name(),
    });
    match pixel {
        Err(reason) => json["skipped"] = (*reason).into(),
        Ok((pixel, expected)) => {
            let value = |k: usize| {
                let verdict = expected.judge(*target, k, pixel[k]);
                json!({
                    "output": format!("color.{}", COMPONENTS[k]), "value": Number(pixel[k]),
                    "reference": Number(expected.reference[k]),
                    "interval": [Number(expected.low[k]), Number(expected.high[k])],
                    "outcome": verdict.outcome.name(), "error_ulp": Number(verdict.error),
                })
            };
            json["values"] = (0..4).map(value).collect();
        }
    }
    json
}

const COMPONENTS: [&str; 4] = ["r", "g", "b", "a"];
