//! The same cases asked once more: an answer that changes is no answer.

use lightmeter_document::run::Report;
use lightmeter_judge::cases::{Answers, Unanswered};
use lightmeter_judge::image::file::StoredImage;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// Cases with a changed answer that are named.
const MOST_NAMED: usize = 1000;
/// Stands for a case that was not asked.
pub(crate) const UNASKED: u32 = 0;
/// The least number that stands for values.
const LEAST: u32 = 8;

/// What was answered to each case in turn, as a number that other answers hardly ever have.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Digests(pub(crate) Vec<u32>);

impl Digests {
    /// Notes the answers to a chunk of cases, each with this number of outputs.
    pub(crate) fn note(&mut self, answers: &Answers, outputs: usize, cases: usize) {
        self.0.extend((0..cases).map(|case| match answers.unanswered.get(&case) {
            Some(why) => number(why),
            None => digest(answers.words[case * outputs..(case + 1) * outputs].iter().map(|&word| u64::from(word))),
        }));
    }
}

/// What stands for a case without a value.
pub(crate) const fn number(why: &Unanswered) -> u32 {
    match why {
        Unanswered::Unasked => UNASKED,
        Unanswered::Skipped(_) | Unanswered::Undeclared(_) => 1,
        Unanswered::Unjudged(_) => 2,
        Unanswered::Broken(_) => 3,
        Unanswered::Missing => 4,
    }
}

/// What stands for numbers.
pub(crate) fn digest(numbers: impl Iterator<Item = u64>) -> u32 {
    let mut hasher = DefaultHasher::new();
    numbers.for_each(|number| number.hash(&mut hasher));
    #[expect(clippy::cast_possible_truncation, reason = "a part of a hash")]
    let digest = hasher.finish() as u32;
    digest | LEAST
}

/// What stands for an image.
pub(crate) fn digest_of(image: &Result<StoredImage, Unanswered>) -> u32 {
    match image {
        Ok(image) => digest(image.pixels.iter().flatten().map(|component| component.to_bits())),
        Err(why) => number(why),
    }
}

/// Whether two answers to the same case are both there and differ.
pub(crate) const fn has_changed(before: u32, now: u32) -> bool {
    before != now && before != UNASKED && now != UNASKED
}

/// Notes in a report that a case's answer has changed.
pub(crate) fn changed(report: &mut Report, id: impl FnOnce() -> String) {
    report.unstable += 1;
    if report.unstable_cases.len() < MOST_NAMED {
        report.unstable_cases.push(id());
    }
}
