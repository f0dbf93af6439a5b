//! Makes a piece of a shader readable: stubs for what it uses and does not declare, and without the statements that no reader accepts.
//!
//! The reader (naga or a compiler) reports one missing thing at a time. A name gets a type from how it is used; if the line is then refused, the
//! other types are tried. If none fits, the statement is left out. Each stub and each omission is a note in the report.

mod cut;
mod dialect;
mod scan;
mod stubs;

use super::lines::Lines;
use super::macros::Definitions;
pub(super) use dialect::Dialect;
use stubs::Stubs;

/// Why a text is not read.
#[derive(Debug)]
pub(super) struct Unread {
    /// The line of the text that was read, from 1; 0 where it is not known.
    pub(super) line: usize,
    pub(super) what: Missing,
}

/// What is missing.
#[derive(Debug)]
pub(super) enum Missing {
    /// Nobody declares a variable.
    Variable(String),
    /// Nobody declares a function of these arguments.
    Function(String),
    /// Something else.
    Other(String),
}

impl Unread {
    pub(super) fn other(line: usize, words: impl Into<String>) -> Self {
        Self { line, what: Missing::Other(words.into()) }
    }

    pub(super) fn words(&self) -> String {
        match &self.what {
            Missing::Variable(name) => format!("`{name}` is not declared"),
            Missing::Function(name) => format!("there is no function `{name}` of these arguments"),
            Missing::Other(words) => words.clone(),
        }
    }
}

/// A text as it was read.
pub(super) struct Repaired<T> {
    pub(super) read: T,
    pub(super) lines: Lines,
    pub(super) notes: Vec<String>,
    /// Whether something is left out.
    pub(super) is_partial: bool,
    /// Whether functions are called that are not there.
    pub(super) lacks_functions: bool,
}

/// Statements that are left out at most.
const MOST_CUTS: usize = 12;
/// Choices that are tried for a line at most.
const MOST_TRIALS: usize = 60;

/// Choices of types for a line that is not read.
struct Trial {
    line: usize,
    said: String,
    before: Vec<(usize, usize)>,
    plan: Vec<Vec<(usize, usize)>>,
}

impl Trial {
    fn of(stubs: &Stubs, unread: &Unread, candidates: &[usize]) -> Self {
        let before: Vec<(usize, usize)> = candidates.iter().map(|&guess| (guess, stubs.chosen(guess))).collect();
        let others = |&(guess, now): &(usize, usize)| -> Vec<(usize, usize)> {
            (0..stubs.choices(guess)).filter(|at| *at != now).map(|at| (guess, at)).collect()
        };
        let mut plan: Vec<Vec<(usize, usize)>> =
            before.iter().flat_map(|own| others(own).into_iter().map(|one| vec![one])).collect();
        for (k, first) in before.iter().enumerate() {
            for second in &before[k + 1..] {
                let firsts: Vec<_> = others(first).into_iter().take(4).collect();
                plan.extend(
                    firsts.iter().flat_map(|one| others(second).into_iter().take(4).map(|two| vec![*one, two])),
                );
            }
        }
        plan.truncate(MOST_TRIALS);
        plan.reverse();
        Self { line: unread.line, said: unread.words(), before, plan }
    }

    /// Sets the next choices; false if none are left.
    fn next(&mut self, stubs: &mut Stubs) -> bool {
        self.before.iter().for_each(|&(guess, at)| stubs.choose(guess, at));
        let Some(choices) = self.plan.pop() else { return false };
        choices.iter().for_each(|&(guess, at)| stubs.choose(guess, at));
        true
    }
}

/// Reads a text with stubs for what is missing.
///
/// # Errors
/// The line of the file, or 0, and what is wrong there.
pub(super) fn repaired<T>(
    own: &Lines,
    (definitions, is_wrapped): (&Definitions, bool),
    dialect: Dialect,
    turns: usize,
    read: &dyn Fn(&Lines) -> Result<T, Unread>,
) -> Result<Repaired<T>, (u32, String)> {
    let mut stubs = Stubs::of(own, definitions, dialect);
    let mut trial: Option<Trial> = None;
    let mut first: Option<(u32, String)> = None;
    for _ in 0..turns {
        let (lines, before) = stubs.text(definitions, is_wrapped);
        let unread = match read(&lines) {
            Ok(read) => {
                return Ok(Repaired {
                    read,
                    lines,
                    notes: stubs.notes(),
                    is_partial: stubs.cuts > 0,
                    lacks_functions: stubs.lacks_functions(),
                });
            }
            Err(unread) => unread,
        };
        let place = unread.line.saturating_sub(before);
        first.get_or_insert_with(|| (if place > 0 { lines.line(unread.line) } else { 0 }, unread.words()));
        // A choice is right that leads to a later line.
        if let Some(own) = &mut trial {
            let is_known = matches!(&unread.what, Missing::Function(name) if name.contains("::"));
            if unread.line <= own.line && !is_known && own.next(&mut stubs) {
                continue;
            }
            if unread.line > own.line {
                trial = None;
            }
        }
        let is_stubbed = trial.is_none()
            && match &unread.what {
                Missing::Variable(name) => stubs.declare(name),
                Missing::Function(name) => stubs.declare_function(name),
                Missing::Other(words) => {
                    let extension = words
                        .strip_prefix("the `")
                        .and_then(|own| own.strip_suffix("` enable extension is not enabled"));
                    extension.is_some_and(|own| stubs.enable(own))
                        || words.contains("found Identifier(")
                            && stubs.declare_qualifier(words.split('"').nth(1).unwrap_or_default())
                }
            };
        if is_stubbed {
            continue;
        }
        if trial.is_none() {
            let mut own = Trial::of(&stubs, &unread, &stubs.candidates(place));
            if own.next(&mut stubs) {
                trial = Some(own);
                continue;
            }
        }
        let (line, said) = trial.take().map_or_else(|| (unread.line, unread.words()), |own| (own.line, own.said));
        let place = line.saturating_sub(before);
        if place == 0 || stubs.cuts >= MOST_CUTS || !stubs.cut(place, &said) {
            break;
        }
    }
    Err(first.unwrap_or((0, "more is missing than is stubbed".into())))
}
