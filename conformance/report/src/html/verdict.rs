//! Whether a result passes, and the sentences that say why not: as the exit code of the command that wrote it has it.

use crate::against;
use lightmeter_document::by_case::{CaseTotals, Coverage};
use lightmeter_document::cases;
use lightmeter_document::report::Report;
use lightmeter_document::thousands;

/// Whether all is well, and what was counted, in sentences.
pub(super) struct Verdict {
    pub(super) is_success: bool,
    /// What must be read first, such as the end of a renderer; then the counts; then what else fails.
    pub(super) sentences: Vec<String>,
}

impl Verdict {
    /// Of a result.
    pub(super) fn new(report: &Report) -> Self {
        let (is_right, has_judged, coverage) = (report.is_success(), report.has_judged(), report.coverage());
        let lacking = report.required.filter(|required| !coverage.is_enough(required.0)).map(|required| {
            let Coverage { chosen, judged, excluded } = coverage;
            let [chosen, judged, excluded] = [chosen, judged, excluded].map(thousands);
            format!(
                "Of {chosen} chosen cases {judged} were judged and {excluded} excluded, which is less than the part of {required} \
                 that `--require` asks for."
            )
        });
        let mut sentences = ended(report);
        sentences.push(counted(report, is_right));
        sentences.extend(against::declared(report).map(|said| said.replacen("the", "The", 1) + "."));
        sentences.extend(wrong(report));
        let warnings = report.renderer.iter().flat_map(|renderer| &renderer.warnings);
        sentences.extend(warnings.map(|warning| format!("Warning: {warning}.")));
        if !has_judged && report.interrupted.is_none() && is_right {
            sentences.push("That is not a pass.".into());
        }
        let is_success = is_right && has_judged && lacking.is_none();
        // Where cases fail, what was left out is not why.
        sentences.extend(lacking.filter(|_| is_right && has_judged));
        Self { is_success, sentences }
    }
}

/// What ended a result before its time.
fn ended(report: &Report) -> Vec<String> {
    let mut said = vec![];
    if let Some(renderer) = report.renderer.as_ref().filter(|renderer| renderer.is_broken()) {
        if let Some((first, more)) = renderer.incidents.split_first() {
            said.push(format!("The renderer broke off: {first}."));
            match more.len() {
                0 => {}
                1 => said.push("One more incident is listed below.".into()),
                several => said.push(format!("{} more incidents are listed below.", thousands(several as u64))),
            }
        }
        let unread = renderer.problems.counts.values().sum::<u64>();
        said.extend((unread > 0).then(|| match unread {
            1 => "One line that it wrote cannot be read as an answer.".into(),
            several => format!("{} lines that it wrote cannot be read as answers.", thousands(several)),
        }));
    }
    said.extend(report.interrupted.as_ref().map(|interrupted| format!("It was interrupted: {interrupted}.")));
    said
}

/// How many verdicts there are, on how many cases, and how many of them are not legal though that is expected.
fn counted(report: &Report, is_right: bool) -> String {
    let verdicts = report.groups.iter().map(|group| group.totals.verdicts).sum::<u64>();
    let all = report.groups.iter().map(|group| group.totals.cases).sum::<u64>();
    let left_out = report.groups.iter().map(|group| group.totals.skipped).sum::<u64>() + report.cases().missing;
    let mut said = match verdicts {
        0 => "No value was judged".to_owned(),
        _ => format!("{} verdicts on {}", thousands(verdicts), cases(all.saturating_sub(left_out))),
    };
    let failing = report.groups.iter().filter(|group| group.totals.failed > 0 || !group.problems.is_empty()).count();
    let (by_verdict, by_case) = (
        report.groups.iter().map(|group| group.totals.expected_failures).sum::<u64>(),
        report.cases().expected_failures,
    );
    let expected = match (by_case, by_verdict) {
        (0, 0) => None,
        (0, 1) => Some("one verdict fails as expected".to_owned()),
        (0, several) => Some(format!("{} verdicts fail as expected", thousands(several))),
        (1, _) => Some("one case fails as expected".to_owned()),
        (several, _) => Some(format!("{} cases fail as expected", thousands(several))),
    };
    let as_whole = report.groups.iter().filter(|group| !group.expected_problems.is_empty()).count();
    let expected = expected.or_else(|| match as_whole {
        0 => None,
        1 => Some("one group fails as a whole, as expected".to_owned()),
        several => Some(format!("{several} groups fail as a whole, as expected")),
    });
    let undecided = report.groups.iter().map(|group| group.totals.indeterminate).sum::<u64>();
    said += &match (failing, expected) {
        (0, None) if verdicts == 0 => ".".to_owned(),
        (0, None) if undecided == verdicts => ": none is decided.".to_owned(),
        (0, None) if undecided > 0 => format!(": {} are legal.", thousands(verdicts - undecided)),
        (0, None) if is_right => ": all are legal.".to_owned(),
        (0, None) => ": each of them is legal.".to_owned(),
        (0, Some(expected)) if undecided > 0 => format!(": {expected}, and all others that are decided are legal."),
        (0, Some(expected)) => format!(": {expected}, and all others are legal."),
        (1, None) => ". One group of cases fails.".to_owned(),
        (several, None) => format!(". {several} groups of cases fail."),
        (1, Some(expected)) => format!(". One group of cases fails; besides, {expected}."),
        (several, Some(expected)) => format!(". {several} groups of cases fail; besides, {expected}."),
    };
    said + &left_open(report, undecided)
}

/// What the counts leave open: verdicts that nothing decides, and the other shards of a run.
fn left_open(report: &Report, undecided: u64) -> String {
    let mut said = match undecided {
        0 => String::new(),
        1 => " One verdict is undecided: there the accuracy rules permit any value.".into(),
        several => {
            format!(" {} verdicts are undecided: there the accuracy rules permit any value.", thousands(several))
        }
    };
    if let Some(shard) = report.compared_by.as_ref().and_then(|by| by.shard.as_ref()) {
        said += &format!(" This is shard {shard} of a run, and not the whole.");
    }
    said
}

/// What is wrong besides values that are not legal.
fn wrong(report: &Report) -> Vec<String> {
    let CaseTotals { missing, undeclared, .. } = report.cases();
    let not_needed = report.deviations.iter().filter(|deviation| !deviation.still_needed).count() as u64;
    let [worse, unexpected] = [report.regressions.len(), report.passing_unexpectedly().count()].map(|n| n as u64);
    [
        (missing, " was never answered.", " were never answered.", "case"),
        (
            undeclared,
            " was skipped without having been declared.",
            " were skipped without having been declared.",
            "case",
        ),
        (
            report.unstable,
            " was answered in another way when it was asked again.",
            " were answered in another way when they were asked again.",
            "case",
        ),
        (worse, " is worse than in the baseline.", " are worse than in the baseline.", "result"),
        (unexpected, " passes that is expected to fail.", " pass that are expected to fail.", "known failure"),
        (not_needed, " is no longer seen.", " are no longer seen.", "named deviation"),
    ]
    .into_iter()
    .filter(|(count, ..)| *count > 0)
    .map(|(count, one, several, what)| match count {
        1 => format!("One {what}{one}"),
        _ => format!("{} {what}s{several}", thousands(count)),
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::Number;
    use lightmeter_document::by_case::{CaseCounts, ComparedBy, KnownFailure, RendererUse};
    use lightmeter_document::pack::Choice;
    use lightmeter_document::report::{Group, Totals};

    /// A group of a gate: cases that pass, fail, are expected to, were never answered, and were not asked.
    fn group([passed, failed, expected, missing, not_asked]: [u64; 5]) -> Group {
        let asked = passed + failed + expected + missing;
        let of_cases = CaseTotals {
            asked,
            not_asked,
            passed,
            failed: failed + expected,
            expected_failures: expected,
            missing,
            ..CaseTotals::default()
        };
        let by_case = CaseCounts { totals: of_cases, ..CaseCounts::default() };
        let totals = Totals { cases: asked, verdicts: asked - missing, failed, ..Totals::default() };
        Group { totals, by_case: Some(by_case), ..Group::new("fog/exp".into(), "renderer".into(), "answer") }
    }

    fn said(group: Group, change: impl FnOnce(&mut Report)) -> (bool, String) {
        let renderer = Some(RendererUse::default());
        let required = Some(Number(0.5));
        let mut report =
            Report { groups: vec![group], renderer, required, ..Report::empty(1, "wgsl".into(), vec![], vec![]) };
        change(&mut report);
        report.sum_up();
        let verdict = Verdict::new(&report);
        (verdict.is_success, verdict.sentences.join(" "))
    }

    #[test]
    fn a_warning_stands_in_the_verdict() {
        let warned = |report: &mut Report| {
            let warnings = vec!["the answers name no pack".into()];
            report.renderer = Some(RendererUse { warnings, ..RendererUse::default() });
        };
        let expected = "9 verdicts on 9 cases: all are legal. Warning: the answers name no pack.";
        assert_eq!(said(group([9, 0, 0, 0, 0]), warned), (true, expected.into()));
    }

    #[test]
    fn what_is_undecided_is_not_called_legal_and_a_shard_not_the_whole() {
        let undecided = |count| {
            let mut undecided = group([9, 0, 0, 0, 0]);
            undecided.totals.indeterminate = count;
            undecided
        };
        let why = "undecided: there the accuracy rules permit any value.";
        assert_eq!(said(undecided(0), |_| {}).1, "9 verdicts on 9 cases: all are legal.");
        let one = format!("9 verdicts on 9 cases: 8 are legal. One verdict is {why}");
        assert_eq!(said(undecided(1), |_| {}).1, one);
        let all = format!("9 verdicts on 9 cases: none is decided. 9 verdicts are {why}");
        assert!(said(undecided(9), |_| {}).1.starts_with(&all));
        let shard = |report: &mut Report| {
            report.compared_by = Some(ComparedBy { shard: Some("1/2".into()), ..ComparedBy::default() });
        };
        let said = said(undecided(0), shard).1;
        assert!(said.ends_with("all are legal. This is shard 1/2 of a run, and not the whole."), "{said}");
    }

    #[test]
    fn a_verdict_says_what_passes_and_why_it_fails() {
        for (counts, is_success, expected) in [
            ([9, 0, 0, 0, 0], true, "9 verdicts on 9 cases: all are legal."),
            ([9, 1, 0, 0, 0], false, "10 verdicts on 10 cases. One group of cases fails."),
            ([9, 0, 1, 0, 0], true, "10 verdicts on 10 cases: one case fails as expected, and all others are legal."),
            (
                [9, 1, 2, 0, 0],
                false,
                "12 verdicts on 12 cases. One group of cases fails; besides, 2 cases fail as expected.",
            ),
            ([9, 0, 0, 2, 0], false, "9 verdicts on 9 cases: each of them is legal. 2 cases were never answered."),
            ([0, 0, 0, 2, 0], false, "No value was judged. 2 cases were never answered."),
        ] {
            assert_eq!(said(group(counts), |_| {}), (is_success, expected.into()), "{counts:?}");
        }
    }

    #[test]
    fn what_a_renderer_does_not_declare_counts_where_it_was_asked_for_by_name() {
        let lacking = Group { id: "fog/linear".into(), ..group([0, 0, 0, 0, 10]) };
        for (filter, is_success, expected) in [
            (
                "fog/*",
                true,
                "The renderer declares 1 of 2 formulas and scenes that the filter selects; the others were not asked.",
            ),
            (
                "fog/linear",
                false,
                "Of 19 chosen cases 9 were judged and 10 excluded, which is less than the part of 0.5 that `--require` asks for.",
            ),
        ] {
            let of = |report: &mut Report| {
                report.groups.push(lacking.clone());
                let choice = Choice { filter: vec![filter.into()], ..Choice::default() };
                report.compared_by = Some(ComparedBy { choice, ..ComparedBy::default() });
            };
            let (is_right, sentences) = said(group([9, 0, 0, 0, 0]), of);
            assert!(is_right == is_success && sentences.contains(expected), "{filter}: {sentences}");
        }
        let (is_right, sentences) = said(lacking, |_| {});
        assert!(!is_right && sentences.ends_with("That is not a pass."), "{sentences}");
    }

    #[test]
    fn a_renderer_that_ended_is_told_first() {
        let (is_success, sentences) = said(group([9, 0, 0, 0, 0]), |report| {
            let incidents = vec!["it ended at fog/exp/random/000003".to_owned()];
            report.renderer = Some(RendererUse { incidents, ..RendererUse::default() });
        });
        assert!(
            !is_success && sentences.starts_with("The renderer broke off: it ended at fog/exp/random/000003."),
            "{sentences}"
        );
    }

    #[test]
    fn known_failures_that_pass_fail() {
        let (is_success, sentences) = said(group([9, 0, 0, 0, 0]), |report| {
            let (id, reason) = ("fog/*".to_owned(), "a reason".to_owned());
            report.expectations = vec![KnownFailure { id, reason, passed: 9, ..KnownFailure::default() }];
        });
        assert!(
            !is_success && sentences.ends_with("One known failure passes that is expected to fail."),
            "{sentences}"
        );
    }
}
