//! What subjects answer to cases, and the same counted by cases.

use crate::diagnose::Made;
use crate::{telling, worse};
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::Number;
use lightmeter_document::by_case::KnownFailure;
use lightmeter_document::by_case::{CaseCounts, CaseTotals};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Reasons of skips that are kept.
const KEPT_REASONS: usize = 16;
/// Cases without a value that are kept with what was said instead: the first.
const KEPT_REFUSED: usize = 16;

/// What a subject gives to the cases of a chunk.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answers {
    /// The outputs, bit for bit, row after row.
    pub words: Vec<u32>,
    /// Cases whose rows mean nothing, by their places in the chunk.
    pub unanswered: BTreeMap<usize, Unanswered>,
}

impl Unanswered {
    /// What was said in the place of a value.
    #[must_use]
    pub fn message(&self) -> &str {
        match self {
            Self::Skipped(message) | Self::Undeclared(message) | Self::Unjudged(message) | Self::Broken(message) => {
                message
            }
            Self::Missing | Self::Unasked => "never answered",
        }
    }
}

impl From<Vec<u32>> for Answers {
    fn from(words: Vec<u32>) -> Self {
        Self { words, unanswered: BTreeMap::new() }
    }
}

/// Why a case has no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unanswered {
    /// The renderer does not do it, says why, and declared before that it would.
    Skipped(String),
    /// The renderer does not do it and says why, and nobody declared that it would.
    Undeclared(String),
    /// What was answered cannot be judged.
    Unjudged(String),
    /// The renderer ended or hung at it.
    Broken(String),
    /// Nothing was answered.
    Missing,
    /// It was not asked, since the renderer broke off or too much of the formula had failed: nobody can say that the answer changed.
    Unasked,
}

/// A known failure, written down with its reason, and the filter of its glob.
#[derive(Clone, Debug)]
pub struct ExpectedFailure {
    /// What is written of it; its counts are filled in as cases are judged.
    pub known: KnownFailure,
    /// Selects its cases.
    pub filter: Filter,
    /// The mistakes that it excuses; whatever is wrong without them.
    pub made: Option<Arc<dyn Made>>,
}

impl ExpectedFailure {
    /// Whether it has a case on a stage or a target.
    #[must_use]
    pub fn has(&self, id: &str, on: &[&str]) -> bool {
        self.known.on.as_ref().is_none_or(|known| on.contains(&known.as_str())) && self.filter.selects(id)
    }
}

/// What became of a case that did not pass, as reports group them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NotPassed {
    /// A verdict failed, or the answer could not be judged.
    Failed,
    /// Skipped.
    Skipped,
    /// Never answered.
    Missing,
}

impl NotPassed {
    const fn name(self) -> &'static str {
        match self {
            Self::Failed => "failed",
            Self::Skipped => "skipped",
            Self::Missing => "missing",
        }
    }
}

/// Cases of one formula that came one after the other and share a fate: the first and the last of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct CaseRange {
    member: usize,
    first: CaseRef,
    last: CaseRef,
    state: NotPassed,
}

/// What has become of a group's cases.
#[derive(Clone, Debug, Default)]
pub struct CaseTally {
    counts: CaseTotals,
    /// The largest error of a case that passes.
    error_passing: f64,
    /// The sum of the finite errors of cases that pass, and how many there are.
    errors: (f64, u64),
    reasons: Vec<String>,
    /// What was said in the place of a value, where it counts as a failure.
    pub refused: BTreeMap<(usize, CaseRef), Unanswered>,
    /// The failing case with the simplest inputs, and how simple they are.
    smallest: Option<(u32, (usize, CaseRef))>,
    not_passed: Vec<CaseRange>,
    /// Cases of each expectation that failed, and that passed.
    expected: Vec<[u64; 2]>,
}

impl CaseTally {
    /// The counts so far.
    #[must_use]
    pub const fn counts(&self) -> &CaseTotals {
        &self.counts
    }

    /// Counts a case whose verdicts were judged: whether one failed, the greatest error, and the sum and the number of the finite ones.
    pub fn judged(&mut self, case: (usize, CaseRef), inputs: &[f32], has_failed: bool, error: f64, errors: (f64, u64)) {
        self.counts.asked += 1;
        if has_failed {
            let simple = telling(inputs, matches!(case.1, CaseRef::Random(_)));
            if self.smallest.is_none_or(|least| (simple, case) < least) {
                self.smallest = Some((simple, case));
            }
            self.counts.failed += 1;
            self.push(case, NotPassed::Failed);
        } else {
            self.counts.passed += 1;
            self.error_passing = worse(self.error_passing, error);
            self.errors = (self.errors.0 + errors.0, self.errors.1 + errors.1);
        }
    }

    /// Adds what cases that pass err by: the greatest error, the sum of the finite ones and how many those are.
    pub fn passing(&mut self, (greatest, sum, count): (f64, f64, u64)) {
        self.error_passing = worse(self.error_passing, greatest);
        self.errors = (self.errors.0 + sum, self.errors.1 + count);
    }

    /// Counts a case without a value; whether it counts as a failure.
    pub fn unanswered(&mut self, case: (usize, CaseRef), why: &Unanswered) -> bool {
        self.counts.asked += 1;
        match why {
            Unanswered::Skipped(reason) | Unanswered::Undeclared(reason) => {
                self.counts.skipped += 1;
                self.counts.undeclared += u64::from(matches!(why, Unanswered::Undeclared(_)));
                self.push(case, NotPassed::Skipped);
                if !self.reasons.contains(reason) && self.reasons.len() < KEPT_REASONS {
                    self.reasons.push(reason.clone());
                }
                false
            }
            Unanswered::Missing | Unanswered::Unasked => {
                self.counts.missing += 1;
                self.push(case, NotPassed::Missing);
                false
            }
            Unanswered::Unjudged(_) | Unanswered::Broken(_) => {
                self.counts.failed += 1;
                self.counts.unjudged += 1;
                self.counts.broken += u64::from(matches!(why, Unanswered::Broken(_)));
                self.push(case, NotPassed::Failed);
                self.refused.insert(case, why.clone());
                if self.refused.len() > KEPT_REFUSED {
                    self.refused.pop_last();
                }
                true
            }
        }
    }

    /// Notes at the expectations that have a case on a stage or a target whether it failed; whether its failure was expected. `explains` says
    /// whether mistakes give what was answered.
    pub fn expect(
        &mut self,
        expected: &[ExpectedFailure],
        id: &str,
        on: &[&str],
        has_failed: bool,
        explains: impl Fn(&dyn Made) -> bool,
    ) -> bool {
        self.expected.resize(expected.len(), [0; 2]);
        let mut is_expected = false;
        for (counts, one) in self.expected.iter_mut().zip(expected).filter(|(_, one)| one.has(id, on)) {
            if has_failed && one.made.as_deref().is_some_and(|made| !explains(made)) {
                continue;
            }
            is_expected = true;
            counts[usize::from(!has_failed)] += 1;
        }
        self.counts.expected_failures += u64::from(is_expected && has_failed);
        is_expected && has_failed
    }

    /// Adds to the expectations how many of their cases failed and passed.
    pub fn note(&self, expectations: &mut [KnownFailure]) {
        for (known, [failed, passed]) in expectations.iter_mut().zip(&self.expected) {
            known.failed += failed;
            known.passed += passed;
        }
    }

    fn push(&mut self, (member, case): (usize, CaseRef), state: NotPassed) {
        if let Some(range) = self.not_passed.last_mut()
            && let (CaseRef::Random(last), CaseRef::Random(number))
            | (CaseRef::Boundary(last), CaseRef::Boundary(number)) = (range.last, case)
            && (range.member, range.state) == (member, state)
            && number == last + 1
        {
            range.last = case;
            return;
        }
        self.not_passed.push(CaseRange { member, first: case, last: case, state });
    }

    /// Adds what became of further cases.
    pub fn add(&mut self, other: Self) {
        self.counts.add(&other.counts);
        self.error_passing = worse(self.error_passing, other.error_passing);
        self.errors = (self.errors.0 + other.errors.0, self.errors.1 + other.errors.1);
        let unknown = other.reasons.into_iter().filter(|reason| !self.reasons.contains(reason)).collect::<Vec<_>>();
        self.reasons.extend(unknown);
        self.reasons.truncate(KEPT_REASONS);
        self.refused.extend(other.refused);
        while self.refused.len() > KEPT_REFUSED {
            self.refused.pop_last();
        }
        self.smallest = [self.smallest, other.smallest].into_iter().flatten().min();
        for range in other.not_passed {
            self.push(range.member_case(), range.state);
            if let Some(last) = self.not_passed.last_mut() {
                last.last = range.last;
            }
        }
        self.expected.resize(self.expected.len().max(other.expected.len()), [0; 2]);
        for (own, more) in self.expected.iter_mut().zip(other.expected) {
            *own = [own[0] + more[0], own[1] + more[1]];
        }
    }

    /// The failing case with the simplest inputs.
    #[must_use]
    pub fn smallest(&self) -> Option<(usize, CaseRef)> {
        self.smallest.map(|(_, case)| case)
    }

    /// All of it, of formulas whose group has an id.
    #[must_use]
    pub fn told(&self, members: &[&Member], group: &str) -> CaseCounts {
        #[expect(clippy::cast_precision_loss, reason = "a count of verdicts")]
        let mean = if self.errors.1 == 0 { 0.0 } else { self.errors.0 / self.errors.1 as f64 };
        CaseCounts {
            totals: self.counts,
            error_passing: Number(self.error_passing),
            error_mean: Number(mean),
            errors: self.errors.1,
            not_passed: self.not_passed(members, group),
            reason: (!self.reasons.is_empty()).then(|| self.reasons.join("; ")),
            smallest: self.smallest().map(|(member, case)| members[member].case_id(case)),
        }
    }

    /// The cases that did not pass, by what became of them: each by the end of its id, and cases in a row as `000003..000017`.
    fn not_passed(&self, members: &[&Member], group: &str) -> BTreeMap<String, Vec<String>> {
        let mut all: BTreeMap<String, Vec<Row>> = BTreeMap::new();
        // Some are judged before all others.
        let mut ranges: Vec<&CaseRange> = self.not_passed.iter().collect();
        ranges.sort_by_key(|range| range.member_case());
        for range in ranges {
            let [first, last] =
                [range.first, range.last].map(|case| ending(group, &members[range.member].case_id(case)));
            let rows = all.entry(range.state.name().to_owned()).or_default();
            match rows.last_mut() {
                Some(row) if row.goes_on(&first) => row.last = last,
                _ => rows.push(Row { first, last }),
            }
        }
        all.into_iter().map(|(name, rows)| (name, rows.into_iter().map(Row::text).collect())).collect()
    }
}

impl CaseRange {
    const fn member_case(&self) -> (usize, CaseRef) {
        (self.member, self.first)
    }
}

/// The end of a case's id behind that of its group.
#[must_use]
pub fn ending(group: &str, id: &str) -> String {
    id.strip_prefix(group).and_then(|rest| rest.strip_prefix('/')).unwrap_or(id).to_owned()
}

/// Cases whose numbers follow one another under the same path.
struct Row {
    first: String,
    last: String,
}

impl Row {
    /// Whether the number of an id is the next one.
    fn goes_on(&self, id: &str) -> bool {
        numbered(&self.last).zip(numbered(id)).is_some_and(|((a, k), (b, n))| a == b && n == k + 1)
    }

    fn text(self) -> String {
        let tail = self.last.rsplit('/').next().unwrap_or_default();
        if self.first == self.last { self.first } else { format!("{}..{tail}", self.first) }
    }
}

/// The path and the number of an id that ends in one.
fn numbered(id: &str) -> Option<(&str, u64)> {
    let (path, number) = id.rsplit_once('/').unwrap_or(("", id));
    number.bytes().all(|byte| byte.is_ascii_digit()).then_some(())?;
    Some((path, number.parse().ok()?))
}

/// Lists of cases that are written short, joined: in an order that their ids have, and short again.
#[must_use]
pub fn joined<K: Ord>(texts: Vec<String>, order: impl Fn(&str) -> K) -> Vec<String> {
    let mut all: Vec<String> = texts.iter().flat_map(|text| expanded(text)).collect();
    all.sort_by_cached_key(|id| order(id));
    let mut rows: Vec<Row> = vec![];
    for id in all {
        match rows.last_mut() {
            Some(row) if row.goes_on(&id) => row.last = id,
            _ => rows.push(Row { first: id.clone(), last: id }),
        }
    }
    rows.into_iter().map(Row::text).collect()
}

/// How many ids a text such as `random/000003..000017` stands for, which nothing but its reader limits.
#[must_use]
pub fn count_of(text: &str) -> u64 {
    let range = text.split_once("..").and_then(|(first, last)| {
        let (_, from) = numbered(first)?;
        Some(last.parse::<u64>().ok()?.saturating_sub(from).saturating_add(1))
    });
    range.unwrap_or(1)
}

/// The ids that a text such as `random/000003..000017` stands for.
pub fn expanded(text: &str) -> impl Iterator<Item = String> {
    let range = text.split_once("..").and_then(|(first, last)| {
        let (path, from) = numbered(first)?;
        let slash = if first.contains('/') { "/" } else { "" };
        Some((format!("{path}{slash}"), last.len(), from, last.parse::<u64>().ok()?))
    });
    let (one, many) = match range {
        None => (Some(text.to_owned()), None),
        Some((path, width, from, to)) => (None, Some((from..=to).map(move |n| format!("{path}{n:0width$}")))),
    };
    one.into_iter().chain(many.into_iter().flatten())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::select::catalogue;

    #[test]
    fn a_known_failure_has_its_cases_where_it_is_on() {
        let known = |on: Option<&str>| ExpectedFailure {
            known: KnownFailure {
                id: "fog/exp".into(),
                reason: "it is known".into(),
                on: on.map(Into::into),
                ..KnownFailure::default()
            },
            made: None,
            filter: Filter::new(&["fog/exp"]).expect("it is a glob"),
        };
        for (on, id, at, has) in [
            (None, "fog/exp/random/000001", "compute", true),
            (None, "fog/linear/random/000001", "compute", false),
            (Some("compute"), "fog/exp/random/000001", "compute", true),
            (Some("fragment"), "fog/exp/random/000001", "compute", false),
            (Some("compute"), "fog/linear/random/000001", "compute", false),
        ] {
            assert_eq!(known(on).has(id, &[at]), has, "{on:?} {id} {at}");
        }
    }

    #[test]
    fn what_was_said_in_the_place_of_a_value_is_told() {
        for said in [Unanswered::Skipped, Unanswered::Undeclared, Unanswered::Unjudged, Unanswered::Broken] {
            assert_eq!(said("why".into()).message(), "why");
        }
        for silent in [Unanswered::Missing, Unanswered::Unasked] {
            assert_eq!(silent.message(), "never answered");
        }
    }

    fn member(id: &str) -> Member {
        catalogue().into_iter().find(|member| member.spec.id == id).expect("the catalogue has it")
    }

    /// Cases with a fate by their number, in parts of some cases each.
    fn tally(cases: &[CaseRef], part: usize) -> CaseTally {
        let mut tally = CaseTally::default();
        for (number, cases) in cases.chunks(part).enumerate() {
            let mut own = CaseTally::default();
            for (k, &case) in cases.iter().enumerate() {
                match (number * part + k) % 11 {
                    0..3 => own.judged((0, case), &[1.0], false, 0.25, (0.25, 1)),
                    3..8 => own.judged((0, case), &[1.0], true, 9.0, (0.0, 0)),
                    8 => drop(own.unanswered((0, case), &Unanswered::Unjudged("no number".into()))),
                    9 => drop(own.unanswered((0, case), &Unanswered::Skipped("no fog".into()))),
                    _ => drop(own.unanswered((0, case), &Unanswered::Missing)),
                }
            }
            tally.add(own);
        }
        tally
    }

    #[test]
    fn ids_are_counted_as_they_are_written() {
        for text in ["hard/on-the-edge", "random/000003", "random/000003..000017", "0003..0003"] {
            assert_eq!(count_of(text), expanded(text).count() as u64, "{text}");
        }
        assert_eq!(count_of("random/0..18446744073709551615"), u64::MAX);
    }

    #[test]
    fn cases_in_a_row_are_written_short_and_read_back() {
        for id in ["fog/exp", "blend/add/one/zero"] {
            let member = member(id);
            let hard = (0..member.spec.hard.len()).map(CaseRef::Hard);
            let cases: Vec<CaseRef> = hard.chain((0..60).map(CaseRef::Random)).collect();
            let whole = tally(&cases, cases.len()).told(&[&member], member.spec.group());
            for part in [1, 2, 7, 30] {
                let parts = tally(&cases, part).told(&[&member], member.spec.group());
                assert_eq!(format!("{parts:?}"), format!("{whole:?}"), "in parts of {part}");
            }
            for (name, fates) in [("failed", 3..9), ("skipped", 9..10), ("missing", 10..11)] {
                let is_so = |(k, case): (usize, &CaseRef)| {
                    fates.contains(&(k % 11)).then(|| ending(member.spec.group(), &member.case_id(*case)))
                };
                let expected: Vec<String> = cases.iter().enumerate().filter_map(is_so).collect();
                let texts = &whole.not_passed[name];
                let read: Vec<String> = texts.iter().flat_map(|text| expanded(text)).collect();
                assert_eq!(read, expected, "{texts:?}");
                assert!(name != "failed" || texts.len() * 2 < expected.len(), "{texts:?}");
            }
        }
    }
}
