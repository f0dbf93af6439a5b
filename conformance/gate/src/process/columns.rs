//! A formula asked in columns: all cases of a batch by one request, their inputs and outputs as binary arrays.
//!
//! A request is a line, and behind it its bytes; so is an answer. What a renderer does not answer in this way, and every batch in which it
//! ends or hangs, is asked by lines, where the case that it fails at is found. So is what is left of a formula whose answer has another
//! number of bytes than it must have: the process is ended at once, since nothing tells where its next line begins. One that announces more bytes
//! than it writes, and so is waited for in vain, is asked all other formulas by lines, too.

use super::super::answer;
use super::super::problems::note;
use super::super::words::clipped;
use super::framing::{before, behind_answer, width};
use super::queue::MOST_OF_FORMULA;
use super::running::{Event, Running};
use super::session::{Ended, ROWS, SURPLUS, Session};
use lightmeter_catalogue::cases::{Spec, ValueShape};
use lightmeter_document::protocol::{ColumnsAnswer, ColumnsRequest, RequestedColumn};
use lightmeter_engine::rows::Rows;
use lightmeter_judge::cases::{Answers, Unanswered};
use std::ops::Range;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

/// Bytes of a request, at most, beyond its first row.
const MOST_REQUEST: usize = 8 << 20;

/// What an answer in columns looks like.
const EXPECTED: &str =
    "such as {\"columns\": \"fog/exp\", \"batch\": 7, \"bytes\": 4096}, and that many bytes behind it";

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
    /// What it wrote is no answer, a problem of this kind, for this reason. What stands behind it cannot be told.
    Refused(&'static str, String),
}

/// A batch that waits for its answer.
struct Batch<'a> {
    spec: &'a Spec,
    number: u64,
    /// Cases of it.
    count: usize,
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
        let (mut left, mut first) = (vec![], 0);
        while first < count && !self.is_over() && self.may_ask_in_columns(spec) {
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
                Came::Refused(kind, why) => {
                    note(&mut self.used.problems, kind, || {
                        format!("{}, batch {}: {why}; it is asked by lines", spec.id, self.number)
                    });
                    self.kill(Ended::Answered);
                    self.failed_in_columns.insert(spec.id.clone(), MOST_OF_FORMULA);
                    left.extend(batch);
                    break;
                }
                Came::Failed(ended) => {
                    self.fails_in_columns(spec, batch.len(), ended);
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

    /// Whether a formula is asked in columns: not where that failed too often.
    fn may_ask_in_columns(&self, spec: &Spec) -> bool {
        !self.hangs_in_arrays && self.failed_in_columns.get(&spec.id).is_none_or(|&failed| failed < MOST_OF_FORMULA)
    }

    /// Ends a process that failed in a batch, and tells it.
    fn fails_in_columns(&mut self, spec: &Spec, count: usize, ended: Ended) {
        let framing = self.running.as_ref().map(|running| &running.framing);
        let cut = framing.and_then(|framing| framing.array_cut_short());
        let open_line = framing.filter(|_| ended == Ended::Hung).and_then(|framing| framing.open_line());
        // One that stops within an array counts wrong, and does so again; where it is waited for in vain, at the next formula too.
        let hangs = cut.is_some() && ended == Ended::Hung;
        self.hangs_in_arrays |= hangs;
        *self.failed_in_columns.entry(spec.id.clone()).or_default() += if cut.is_some() { MOST_OF_FORMULA } else { 1 };
        let how = self.kill(ended);
        let those = if hangs { "they and all other formulas" } else { "they" };
        self.used.incidents.push(format!(
            "{}: with {count} cases asked in columns {}: {}{how}; {those} are asked by lines",
            spec.id,
            ended.message(),
            cut.or(open_line).map_or_else(String::new, |cut| format!("{cut}; "))
        ));
        self.rows = ROWS[0];
    }

    /// Asks a batch of rows and waits for what comes of it.
    fn ask_columns(&mut self, spec: &Spec, rows: &Rows<'_>, batch: Range<usize>) -> Came {
        self.number += 1;
        let asked = Batch { spec, number: self.number, count: batch.len() };
        let Some(mut running) = self.running.take() else { return Came::Failed(Ended::Crashed) };
        let mut text = self.description(spec).into_bytes();
        text.extend(request(spec, rows, batch, asked.number));
        running.framing.awaits(asked.number, asked.count * spec.output_len());
        running.send(text);
        let (limit, start) = (self.asking.limits.case, self.clock.now());
        let came = self.came_of(&asked, &running, start + limit);
        if matches!(came, Came::Failed(_) | Came::Refused(..)) {
            self.running = Some(running);
            return came;
        }
        let has_read = self.has_read(&mut running, start + limit);
        if (self.clock.now() - start) * 8 < limit {
            self.rows = (2 * self.rows).min(ROWS[1]);
        }
        self.running = Some(running);
        if has_read { came } else { Came::Failed(Ended::Deaf) }
    }

    /// Waits for what comes of a batch.
    fn came_of(&mut self, batch: &Batch<'_>, running: &Running, until: Duration) -> Came {
        let mut surplus = 0;
        loop {
            if surplus > SURPLUS {
                return Came::Failed(Ended::Flooded);
            }
            if self.is_stopped() {
                return Came::Failed(Ended::Stopped);
            }
            let over = self.over(until);
            if self.clock.now() >= over {
                return Came::Failed(if self.is_out_of_time() { Ended::OutOfTime } else { Ended::Hung });
            }
            match self.hear(running, over) {
                Ok(Event::Line(line)) if line.iter().all(u8::is_ascii_whitespace) => surplus += 1,
                Ok(Event::Line(line)) => {
                    self.lines += 1;
                    if let Some(came) = self.told(&line, batch) {
                        return came;
                    }
                    surplus += 1;
                }
                Ok(Event::Columns(answer, bytes)) => {
                    self.lines += 1;
                    if batch.is_of(&answer) {
                        return Came::Values(values(&answer, &bytes));
                    }
                    return Came::Refused("unknown", not_asked(&answer));
                }
                Ok(Event::TooLong) => {
                    return Came::Refused(
                        "oversized",
                        "a line or an array without end; expected the line of its answer".into(),
                    );
                }
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => return Came::Failed(Ended::Crashed),
                // The next turn tells which time is over.
                Ok(Event::Passed(_)) | Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// What a line says of a batch; `None` where it answers nothing, as what a library prints.
    fn told(&mut self, line: &[u8], batch: &Batch<'_>) -> Option<Came> {
        let refused = |why: String| Some(Came::Refused("malformed", why));
        let quoted = || clipped(&String::from_utf8_lossy(line));
        let answer = match serde_json::from_slice::<ColumnsAnswer>(line) {
            Ok(answer) if answer.columns.is_empty() && answer::id(line).is_some() => {
                return refused(format!("`{}` answers a case; expected {EXPECTED}", quoted()));
            }
            Ok(answer) if answer.columns.is_empty() => {
                self.is_not_asked(&answer);
                return None;
            }
            Ok(answer) => answer,
            Err(_) if let Some(behind) = behind_answer(line) => {
                return refused(format!(
                    "{behind} bytes stand between the line of its answer and the newline; expected none"
                ));
            }
            Err(error) => match before(line) {
                Some(0) => return refused(format!("`{}`: {error}; expected {EXPECTED}", quoted())),
                Some(bytes) => {
                    return refused(format!(
                        "{bytes} bytes stand before the line of its answer; expected none, and before it as many bytes of arrays as \
                         their lines announce"
                    ));
                }
                None => {
                    note(&mut self.used.problems, "malformed", || {
                        format!("`{}`: {error}; expected an answer in columns", quoted())
                    });
                    return None;
                }
            },
        };
        if !batch.is_of(&answer) {
            return Some(Came::Refused("unknown", not_asked(&answer)));
        }
        if let Some(why) = batch.refuses(&answer) {
            return refused(why);
        }
        let ColumnsAnswer { skip, error, .. } = answer;
        Some(match (skip, error) {
            (Some(reason), _) => Came::Nothing(Unanswered::Skipped(clipped(&reason))),
            (_, Some(reason)) => Came::Nothing(Unanswered::Unjudged(clipped(&reason))),
            _ => Came::Lines,
        })
    }

    /// An answer in columns to nothing that waits for one is a problem.
    pub(super) fn is_not_asked(&mut self, answer: &ColumnsAnswer) {
        note(&mut self.used.problems, "unknown", || not_asked(answer));
    }
}

/// That an answer in columns is to nothing that waits for one.
fn not_asked(answer: &ColumnsAnswer) -> String {
    if answer.batch == 0 {
        let columns = clipped(&answer.columns);
        return format!(
            "an answer of `{columns}` in columns has no `batch`, or 0; expected the number that its request has, from 1"
        );
    }
    format!("no batch {} of `{}` waits for an answer in columns", answer.batch, clipped(&answer.columns))
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

impl Batch<'_> {
    /// Whether an answer is to it.
    fn is_of(&self, answer: &ColumnsAnswer) -> bool {
        answer.columns == self.spec.id && answer.batch == self.number
    }

    /// What is wrong with the line of an answer to it that no array was read behind; `None` where nothing is.
    fn refuses(&self, answer: &ColumnsAnswer) -> Option<String> {
        let ways = [answer.bytes.is_some(), answer.skip.is_some(), answer.error.is_some(), answer.lines];
        if ways.into_iter().filter(|&is_there| is_there).count() != 1 {
            return Some(format!(
                "its line has none, or more than one, of `bytes`, `skip`, `error` and `lines`; expected {EXPECTED}"
            ));
        }
        let announced = answer.bytes?;
        let dtype = answer.dtype.as_deref().unwrap_or("<f4");
        let Some(width) = width(Some(dtype)) else {
            return Some(format!("its `dtype` is `{}`; expected <f4 or <f8", clipped(dtype)));
        };
        let (outputs, count) = (self.spec.output_len(), self.count);
        let right = count * outputs * width;
        Some(format!(
            "its line announces {announced} bytes in columns; expected {right}: {outputs} numbers of {dtype} for each of {count} cases"
        ))
    }
}

/// The numbers of an answer, whose length was held against what was asked.
fn values(answer: &ColumnsAnswer, bytes: &[u8]) -> Vec<f32> {
    let width = width(answer.dtype.as_deref()).unwrap_or(4);
    #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is what is asked for")]
    let number = |part: &[u8]| match width {
        8 => part.try_into().map_or(f64::NAN, f64::from_le_bytes) as f32,
        _ => part.try_into().map_or(f32::NAN, f32::from_le_bytes),
    };
    bytes.chunks_exact(width).map(number).collect()
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
