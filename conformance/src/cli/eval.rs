//! `lightmeter eval`.

use super::Status;
use super::mistakes::by_name;
use super::options::Choice;
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::arithmetic::{Accept, Profile};
use lightmeter::cases::Input;
use lightmeter::cases::blend::{aliases, separate_of};
use lightmeter::document::Number;
use lightmeter::document::eval::{EvalAnswer, EvalRefusal, EvalRequest};
use lightmeter::faults::{Fault, Variation};
use lightmeter::nearest::did_you_mean;
use lightmeter::select::{Member, catalogue, separate_member};
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::io::{BufRead, Read as _, Write as _};

/// Evaluate formulas: JSON lines in, JSON lines with value, interval and condition out.
///
/// A line is {"id": …, "formula": "fog/linear", "inputs": {"p": [0, 0, -5], "dmin": 1, …}}. Numbers are read as the nearest
/// f32; NaN, Inf and -Inf are strings. `lightmeter list --formulas` names the inputs. A line that cannot be answered gets
/// {"id": …, "error": …}, and the command ends with 2.
#[derive(Debug, Args)]
pub(crate) struct Eval {
    /// Accuracy rules: wgsl, vulkan or opengl
    #[arg(long, value_name = "NAME", default_value = "wgsl", value_parser = Choice::profile)]
    profile: &'static Profile,
    /// Evaluate as a renderer with this mistake would; `lightmeter mistakes` lists them
    #[arg(long, value_name = "NAME", value_parser = by_name)]
    mistake: Option<&'static Fault>,
}

impl Eval {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let catalogue = catalogue();
        let mut by_id: HashMap<String, &Member> = catalogue.iter().map(|m| (m.spec.id.clone(), m)).collect();
        for (alias, canonical) in aliases() {
            let member = by_id[&canonical];
            by_id.insert(alias, member);
        }
        let mut status = Status::Success;
        match self.answers(&by_id, &mut status) {
            // Whoever does not read the answers any more has read enough. A line that was refused before is still a wrong one.
            Err(error) if is_broken_pipe(&error) => Ok(status),
            answered => answered.map(|()| status),
        }
    }

    /// Answers each line: one that nothing can be made of by what is wrong with it.
    fn answers(&self, by_id: &HashMap<String, &Member>, status: &mut Status) -> anyhow::Result<()> {
        let mut out = std::io::BufWriter::new(std::io::stdout().lock());
        let (mut stream, mut line, mut number) = (std::io::stdin().lock(), vec![], 0_u64);
        while next_line(&mut stream, &mut line)? {
            number += 1;
            if line.trim_ascii().is_empty() {
                continue;
            }
            let answer =
                line_text(&line).and_then(|line| self.answer(line, by_id).map_err(|error| (id_of(line), error)));
            match answer {
                Ok(answer) => writeln!(out, "{}", serde_json::to_string(&answer)?)?,
                Err((id, error)) => {
                    *status = Status::BadInput;
                    let refused = EvalRefusal { id, error: format!("line {number}: {error:#}") };
                    writeln!(out, "{}", serde_json::to_string(&refused)?)?;
                }
            }
        }
        Ok(out.flush()?)
    }

    fn answer(&self, line: &str, by_id: &HashMap<String, &Member>) -> anyhow::Result<EvalAnswer> {
        let EvalRequest { id, formula, inputs } = EvalRequest::read(line)?;
        // Of the states separate for alpha the catalogue has some; any can be named.
        let separate = separate_formula(&formula);
        let member = by_id.get(&formula).copied().or(separate.as_ref());
        let member = member.with_context(|| {
            let meant = did_you_mean(&formula, by_id.keys().map(String::as_str));
            format!("field `formula`: no formula `{formula}`{meant} See `lightmeter list`")
        })?;
        let inputs = row(member, &inputs)?;

        let outputs = member.spec.output_len();
        let (mut value, mut legal) = (vec![0.0; outputs], vec![Accept::ANY; outputs]);
        match self.mistake {
            None => {
                member.formula.reference(&inputs, &mut value);
                member.formula.promised_interval(member.spec.kind, &inputs, self.profile, &mut legal);
            }
            Some(fault) => {
                let mistaken = Variation::new(member, &[fault]);
                let mistaken =
                    mistaken.with_context(|| format!("`{}` does not concern {}", fault.name, member.spec.id))?;
                mistaken.evaluate(&inputs, &mut value);
                mistaken.interval(&inputs, self.profile, &mut legal);
            }
        }
        let condition = member
            .formula
            .condition(&inputs)
            .into_iter()
            .fold(0.0, |most: f64, c| if c.is_nan() || most.is_nan() { f64::NAN } else { most.max(c) });
        let numbers = |f: &dyn Fn(usize) -> f64| (0..outputs).map(|k| Number(f(k))).collect::<Vec<_>>();
        Ok(EvalAnswer {
            id,
            value: numbers(&|k| value[k]),
            low: numbers(&|k| legal[k].low()),
            high: numbers(&|k| legal[k].high()),
            condition: Number(condition),
        })
    }
}

/// Bytes of a line, at most: more than any formula's inputs take.
const MOST_BYTES: u64 = 1 << 20;

/// Bytes of a line that is too long that are looked through for its end.
const MOST_SKIPPED: u64 = 64 << 20;

/// The next line, of which no more is kept than one byte beyond the most; `false` at the end.
fn next_line(stream: &mut impl BufRead, line: &mut Vec<u8>) -> std::io::Result<bool> {
    line.clear();
    if stream.by_ref().take(MOST_BYTES + 1).read_until(b'\n', line)? == 0 {
        return Ok(false);
    }
    if !line.ends_with(b"\n") && line.len() as u64 > MOST_BYTES {
        let mut rest = stream.take(MOST_SKIPPED);
        rest.skip_until(b'\n')?;
        if rest.limit() == 0 {
            let message = format!("a line of more than {MOST_SKIPPED} bytes; expected a JSON object on each line");
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidData, message));
        }
    }
    Ok(true)
}

/// A line's text, or why it is not text.
fn line_text(line: &[u8]) -> Result<&str, (Value, anyhow::Error)> {
    if line.len() as u64 > MOST_BYTES {
        return Err((Value::Null, anyhow::anyhow!("it has more than {MOST_BYTES} bytes")));
    }
    std::str::from_utf8(line).map_err(|_| (Value::Null, anyhow::anyhow!("it is not UTF-8")))
}

/// The id of a line that is refused, as far as it has one.
fn id_of(line: &str) -> Value {
    serde_json::from_str::<Value>(line).ok().and_then(|mut value| Some(value.get_mut("id")?.take())).unwrap_or_default()
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.downcast_ref::<std::io::Error>().is_some_and(|error| error.kind() == std::io::ErrorKind::BrokenPipe)
}

/// The formula of an id such as `blend/separate/add.src-alpha.one/min`.
fn separate_formula(id: &str) -> Option<Member> {
    let state = separate_of(id)?;
    let member = separate_member(state);
    (member.spec.id == id).then_some(member)
}

/// The row of a formula's inputs.
fn row(member: &Member, given: &Map<String, Value>) -> anyhow::Result<Vec<f32>> {
    let names: Vec<&str> = member.spec.inputs.iter().map(|input| input.name).collect();
    if let Some(unknown) = given.keys().find(|name| !names.contains(&name.as_str())) {
        bail!("field `inputs.{unknown}`: {} has no such input; expected {}", member.spec.id, names.join(", "));
    }
    let mut row = vec![];
    for input in member.spec.inputs {
        let expected = || expected(input);
        let value = given
            .get(input.name)
            .with_context(|| format!("field `inputs.{}` is missing; expected {}", input.name, expected()))?;
        let values = match value {
            Value::Array(values) if input.shape.components() > 1 => values.as_slice(),
            single if input.shape.components() == 1 && !single.is_array() => std::slice::from_ref(single),
            _ => bail!("field `inputs.{}`: expected {}", input.name, expected()),
        };
        if values.len() != input.shape.components() {
            bail!("field `inputs.{}`: {} numbers; expected {}", input.name, values.len(), expected());
        }
        for value in values {
            row.push(
                number(value).with_context(|| {
                    format!("field `inputs.{}`: {value} where {} is expected", input.name, expected())
                })?,
            );
        }
    }
    Ok(row)
}

fn expected(input: &Input) -> String {
    match input.shape.components() {
        1 => "a number (or \"NaN\", \"Inf\", \"-Inf\")".into(),
        many => format!("an array of {many} numbers"),
    }
}

/// The nearest f32. A finite number beyond the range of f32 has none.
fn number(value: &Value) -> Option<f32> {
    match value {
        Value::String(text) => match text.as_str() {
            "NaN" => Some(f32::NAN),
            "Inf" => Some(f32::INFINITY),
            "-Inf" => Some(f32::NEG_INFINITY),
            _ => None,
        },
        _ => {
            #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is what is asked for")]
            let nearest = value.as_f64()? as f32;
            nearest.is_finite().then_some(nearest)
        }
    }
}
