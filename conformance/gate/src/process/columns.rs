//! A formula asked in columns: all cases of a batch by one request, their inputs and outputs as binary arrays.
//!
//! A request is a line, and behind it its bytes; so is an answer. What a renderer does not answer in this way, and every batch in which it
//! ends or hangs, is asked by lines, where the case that it fails at is found.

use super::super::answer::clipped;
use super::super::problems::note;
use super::queue::MOST_OF_FORMULA;
use super::running::Event;
use super::session::{Ended, MOMENT, ROWS, SURPLUS, Session};
use lightmeter_catalogue::cases::{Spec, ValueShape};
use lightmeter_document::protocol::{ColumnsAnswer, ColumnsRequest, RequestedColumn};
use lightmeter_engine::rows::Rows;
use lightmeter_judge::cases::{Answers, Unanswered};
use std::ops::Range;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Instant;

/// Bytes of a request, at most, beyond its first row.
const MOST_REQUEST: usize = 8 << 20;

/// What came of a batch.
enum Came {
    /// The outputs of all cases, column by column.
    Values(Vec<f32>),
    /// Nothing of use, for this reason.
    Nothing(Unanswered),
    /// Its cases are to be asked by lines.
    Lines,
    /// The process failed.
    Failed(Ended),
}

impl Session {
    /// Asks rows of a formula in columns. What is left is to be asked by lines.
    pub(super) fn columns(
        &mut self,
        rows: &Rows<'_>,
        answers: &mut Answers,
        advanced: &mut dyn FnMut(u64),
    ) -> Vec<usize> {
        let (spec, count) = (&rows.members[0].spec, rows.of.len());
        let most = (MOST_REQUEST / (4 * rows.stride())).max(1);
        let (mut left, mut first, mut failures) = (vec![], 0, 0);
        while first < count && !self.is_over() && failures < MOST_OF_FORMULA {
            if self.running.is_none() && !self.starts_again(count - first) {
                self.has_broken_off = true;
                break;
            }
            let batch = first..count.min(first + self.rows.min(most));
            first = batch.end;
            match self.ask_columns(spec, rows, batch.clone()) {
                Came::Values(values) => {
                    for place in batch.clone() {
                        let words = &mut answers.words[place * rows.outputs..(place + 1) * rows.outputs];
                        put(spec, &values, batch.len(), place - batch.start, words);
                    }
                }
                Came::Nothing(why) => {
                    let id = |place: usize| rows.members[0].case_id(rows.cases[place]);
                    for place in batch.clone() {
                        let why = match why.clone() {
                            Unanswered::Skipped(reason) => self.skips.skipped(&id(place), reason),
                            other => other,
                        };
                        answers.unanswered.insert(place, why);
                    }
                }
                Came::Lines => {
                    left.extend(batch);
                    continue;
                }
                Came::Failed(ended @ (Ended::OutOfTime | Ended::Stopped)) => {
                    left.extend(batch);
                    self.breaks_off(ended);
                    break;
                }
                Came::Failed(ended) => {
                    let how = self.kill(ended);
                    self.used.incidents.push(format!(
                        "{}: with {} cases asked in columns {}: {how}; they are asked by lines",
                        spec.id,
                        batch.len(),
                        ended.message()
                    ));
                    self.rows = ROWS[0];
                    failures += 1;
                    left.extend(batch);
                    continue;
                }
            }
            self.answered += batch.len();
            advanced(batch.len() as u64);
        }
        left.extend(first..count);
        left
    }

    /// Asks a batch of rows and waits for what comes of it.
    fn ask_columns(&mut self, spec: &Spec, rows: &Rows<'_>, batch: Range<usize>) -> Came {
        self.number += 1;
        let (number, count) = (self.number, batch.len());
        let Some(mut running) = self.running.take() else { return Came::Failed(Ended::Crashed) };
        let mut text = self.description(spec).into_bytes();
        text.extend(request(spec, rows, batch, number));
        let writing = running.send(text);
        let (limit, start) = (self.asking.limits.case, Instant::now());
        let until = start + limit;
        let mut surplus = 0;
        let came = loop {
            if surplus > SURPLUS {
                break Came::Failed(Ended::Flooded);
            }
            if self.is_stopped() {
                break Came::Failed(Ended::Stopped);
            }
            let wait = self.over(until).saturating_duration_since(Instant::now());
            if wait.is_zero() {
                break Came::Failed(if self.is_out_of_time() { Ended::OutOfTime } else { Ended::Hung });
            }
            match running.events.recv_timeout(wait.min(MOMENT)) {
                Ok(Event::Line(line)) if line.iter().all(u8::is_ascii_whitespace) => surplus += 1,
                Ok(Event::Line(line)) => {
                    self.lines += 1;
                    if let Some(came) = self.told(&line, spec, number) {
                        break came;
                    }
                    surplus += 1;
                }
                Ok(Event::Columns(answer, bytes)) => {
                    self.lines += 1;
                    if answer.columns == spec.id && answer.batch == number {
                        break values(spec, count, &answer, &bytes);
                    }
                    self.is_not_asked(&answer);
                    surplus += 1;
                }
                Ok(Event::TooLong) => {
                    surplus += 1;
                    note(&mut self.used.problems, "oversized", || "a line or an array without end".into());
                }
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => break Came::Failed(Ended::Crashed),
                // The next turn tells which time is over.
                Err(RecvTimeoutError::Timeout) => {}
            }
        };
        if matches!(came, Came::Failed(_)) {
            self.running = Some(running);
            return came;
        }
        let has_read = self.has_read(&mut running, writing, until);
        if start.elapsed() * 8 < limit {
            self.rows = (2 * self.rows).min(ROWS[1]);
        }
        self.running = Some(running);
        if has_read { came } else { Came::Failed(Ended::Deaf) }
    }

    /// What a line says of a batch; `None` where it answers another one, or nothing.
    fn told(&mut self, line: &[u8], spec: &Spec, number: u64) -> Option<Came> {
        let answer = match serde_json::from_slice::<ColumnsAnswer>(line) {
            Ok(answer) => answer,
            Err(error) => {
                let line = clipped(&String::from_utf8_lossy(line));
                note(&mut self.used.problems, "malformed", || {
                    format!("`{line}`: {error}; expected an answer in columns")
                });
                return None;
            }
        };
        if answer.columns != spec.id || answer.batch != number {
            self.is_not_asked(&answer);
            return None;
        }
        let ColumnsAnswer { skip, error, lines, .. } = answer;
        Some(match (skip, error, lines) {
            (Some(reason), None, false) => Came::Nothing(Unanswered::Skipped(clipped(&reason))),
            (None, Some(reason), false) => Came::Nothing(Unanswered::Unjudged(clipped(&reason))),
            (None, None, true) => Came::Lines,
            _ => Came::Nothing(Unanswered::Unjudged(
                "an answer in columns has none, or more than one, of `bytes`, `skip`, `error` and `lines`".into(),
            )),
        })
    }

    /// An answer in columns to nothing that waits for one is a problem.
    pub(super) fn is_not_asked(&mut self, answer: &ColumnsAnswer) {
        note(&mut self.used.problems, "unknown", || {
            format!("no batch {} of `{}` waits for an answer in columns", answer.batch, clipped(&answer.columns))
        });
    }
}

/// A request: its line, and its bytes.
fn request(spec: &Spec, rows: &Rows<'_>, batch: Range<usize>, number: u64) -> Vec<u8> {
    let (stride, count) = (rows.stride(), batch.len());
    let inputs = &rows.inputs[batch.start * stride..batch.end * stride];
    let of =
        |name: &'static str, shape: ValueShape| RequestedColumn { name: name.into(), components: shape.components() };
    let numbers: usize = spec.input_len() * count;
    let line = ColumnsRequest {
        columns: spec.id.clone(),
        batch: number,
        count,
        inputs: spec.inputs.iter().map(|input| of(input.name, input.shape)).collect(),
        outputs: spec.outputs.iter().map(|output| of(output.name, output.shape)).collect(),
        bytes: 4 * numbers,
    };
    let mut bytes = format!("{line}\n").into_bytes();
    bytes.reserve_exact(4 * numbers);
    let mut start = 0;
    for input in spec.inputs {
        let components = input.shape.components();
        for row in inputs.chunks_exact(stride) {
            bytes.extend(row[start..start + components].iter().flat_map(|x| x.to_le_bytes()));
        }
        start += components;
    }
    bytes
}

/// The numbers of an answer, held against what was asked.
fn values(spec: &Spec, count: usize, answer: &ColumnsAnswer, bytes: &[u8]) -> Came {
    let refused = |message: String| Came::Nothing(Unanswered::Unjudged(message));
    let dtype = answer.dtype.as_deref().unwrap_or("<f4");
    let width = match dtype {
        "<f4" => 4,
        "<f8" => 8,
        other => return refused(format!("its `dtype` is `{}`; expected <f4 or <f8", clipped(other))),
    };
    let outputs = spec.output_len();
    if bytes.len() != count * outputs * width {
        return refused(format!(
            "{} bytes in columns; expected {}: {outputs} numbers of {dtype} for each of {count} cases",
            bytes.len(),
            count * outputs * width
        ));
    }
    #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is what is asked for")]
    let number = |part: &[u8]| match width {
        8 => part.try_into().map_or(f64::NAN, f64::from_le_bytes) as f32,
        _ => part.try_into().map_or(f32::NAN, f32::from_le_bytes),
    };
    Came::Values(bytes.chunks_exact(width).map(number).collect())
}

/// The outputs of a case out of columns, as words.
fn put(spec: &Spec, values: &[f32], count: usize, row: usize, words: &mut [u32]) {
    let (mut start, mut rest) = (0, words);
    for output in spec.outputs {
        let components = output.shape.components();
        let (own, after) = rest.split_at_mut(components);
        let from = start + row * components;
        own.iter_mut().zip(&values[from..from + components]).for_each(|(word, value)| *word = value.to_bits());
        start += count * components;
        rest = after;
    }
}
