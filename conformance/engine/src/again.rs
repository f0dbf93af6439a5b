//! The same cases asked once more: an answer that changes is no answer.

use lightmeter_document::report::Report;
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
            None => {
                let words = &answers.words[case * outputs..(case + 1) * outputs];
                digest_of_values(words.iter().map(|&word| f32::from_bits(word).into()))
            }
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

/// What stands for values. Those below f32's normal range count as 0, of either sign: whether they are flushed is open for each operation anew,
/// and llvmpipe does it in some of its threads.
pub(crate) fn digest_of_values(values: impl Iterator<Item = f64>) -> u32 {
    digest(values.map(|x| if x.abs() < f64::from(f32::MIN_POSITIVE) { 0 } else { x.to_bits() }))
}

/// What stands for numbers, bit for bit.
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
        Ok(image) => digest_of_values(image.pixels.iter().flatten().copied()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flushed_answer_has_not_changed() {
        let digests = |x: f32| {
            let mut digests = Digests::default();
            digests.note(&Answers { words: vec![x.to_bits(), 1.0_f32.to_bits()], ..Answers::default() }, 2, 1);
            digests.0[0]
        };
        assert!([1e-40, -1e-40, -0.0].iter().all(|&x| !has_changed(digests(0.0), digests(x))));
        assert!([f32::MIN_POSITIVE, 1.0, f32::NAN].iter().all(|&x| has_changed(digests(0.0), digests(x))));
    }
}
