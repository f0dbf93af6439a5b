//! What a result came to, before anything else: the verdict, of what, and by which command; and at the end what else there is to know.

use super::page::prose;
use super::verdict::Verdict;
use crate::against;
use crate::page::selftest::SelftestRun;
use crate::page::sweep::{Swept, command};
use crate::text::unbound;
use lightmeter_document::bench::BenchDocument;
use lightmeter_document::report::{Identity, Report};
use lightmeter_document::thousands;
use maud::{Markup, html};
use std::collections::BTreeSet;

/// What is said first.
pub(super) struct Facts {
    pub(super) title: String,
    /// Whether all is well; `None` where that is not the question.
    is_success: Option<bool>,
    /// What it came to, in sentences.
    says: Vec<String>,
    command: Option<String>,
    /// Names with what they are.
    facts: Vec<(String, String)>,
}

fn device(adapter: &Identity) -> (String, String) {
    // A renderer need not say what it runs on.
    let known: Vec<&str> =
        [&*adapter.device, &adapter.backend, &adapter.driver].into_iter().filter(|what| !what.is_empty()).collect();
    (adapter.name.clone(), known.join(", "))
}

/// By which version a result was made, when, and how long that took, as far as it says.
fn made(version: Option<&str>, at: Option<&str>, seconds: Option<f64>) -> Vec<(String, String)> {
    let mut facts = vec![];
    facts.extend(version.map(|version| ("lightmeter".to_owned(), version.to_owned())));
    // `2026-05-01T12:00:00Z` as people write it.
    facts.extend(at.map(|at| ("made at".to_owned(), at.replace('T', " ").replace('Z', " UTC"))));
    facts.extend(seconds.map(|seconds| ("took".to_owned(), format!("{seconds:.1} s"))));
    facts
}

impl Facts {
    pub(super) fn of_report(report: &Report, verdict: Verdict) -> Self {
        let subject = match (&report.renderer, report.adapters.as_slice()) {
            (Some(renderer), _) => format!("{} {}", renderer.identity.name, renderer.identity.version),
            (None, [one]) => one.name.clone(),
            (None, several) => format!("{} adapters", several.len()),
        };
        let mut facts: Vec<(String, String)> = report.adapters.iter().map(device).collect();
        if let Some(shader) = &report.shader {
            let of = shader.function.as_ref().map_or_else(String::new, |function| format!("function {function} of "));
            facts.push(("shader".into(), format!("{of}{}", shader.file)));
            facts.extend(shader.formulas.iter().filter_map(unbound).map(|says| ("shader".into(), says)));
        }
        facts.push(("seed".into(), report.seed.to_string()));
        facts.push(("profile".into(), report.profile.to_string()));
        facts.extend(made(report.version.as_deref(), report.made_at.as_deref(), Some(report.seconds)));
        facts.extend(report.config.iter().map(|config| ("settings".into(), config.to_string())));
        Self {
            title: format!("lightmeter: {subject}"),
            is_success: Some(verdict.is_success),
            says: verdict.sentences,
            command: report.command.clone(),
            facts,
        }
    }

    pub(super) fn of_sweeps(sweeps: &[Swept], is_success: bool) -> Self {
        let inputs = sweeps.iter().map(|swept| swept.document.sweep.inputs).sum::<u64>();
        let failed = sweeps.iter().map(|swept| swept.document.statistics.failed).sum::<u64>();
        let mut facts: Vec<(String, String)> = vec![];
        for swept in sweeps {
            let fact = device(&swept.document.sweep.adapter);
            if !facts.contains(&fact) {
                facts.push(fact);
            }
        }
        facts.push(("seed".into(), "none: every input of the range is tried".into()));
        let profiles: BTreeSet<&str> = sweeps.iter().map(|swept| swept.document.sweep.profile.as_str()).collect();
        facts.push(("profile".into(), profiles.into_iter().collect::<Vec<_>>().join(", ")));
        let last = sweeps.iter().max_by(|a, b| a.document.made_at.cmp(&b.document.made_at));
        let [version, made_at] = [
            last.and_then(|swept| swept.document.version.as_deref()),
            last.and_then(|swept| swept.document.made_at.as_deref()),
        ];
        facts.extend(made(version, made_at, Some(sweeps.iter().map(|swept| swept.document.seconds).sum())));
        let names: Vec<&str> = sweeps.iter().map(|swept| swept.document.sweep.formula.as_str()).collect();
        Self {
            title: format!("lightmeter sweep: {}", names.join(", ")),
            is_success: Some(is_success),
            says: vec![format!("{} inputs, of which {} give what is not legal.", thousands(inputs), thousands(failed))],
            command: match sweeps {
                [one] => Some(one.command.clone().unwrap_or_else(|| format!("lightmeter sweep {}", command(one)))),
                _ => None,
            },
            facts,
        }
    }

    pub(super) fn of_bench(document: &BenchDocument) -> Self {
        let mut facts: Vec<(String, String)> = document
            .adapters
            .iter()
            .map(|one| (one.adapter.clone(), format!("{}, {}, {}", one.device, one.backend, one.driver)))
            .collect();
        facts.push(("seed".into(), document.seed.to_string()));
        facts.push(("cores".into(), document.cores.to_string()));
        facts.extend(made(Some(&document.version), document.made_at.as_deref(), Some(document.seconds)));
        let groups = document.adapters.iter().map(|adapter| adapter.groups.len()).sum::<usize>();
        Self {
            title: "lightmeter bench".into(),
            is_success: None,
            says: vec![match groups {
                1 => "What accuracy costs in time: one group of techniques and arithmetics.".into(),
                _ => format!("What accuracy costs in time: {groups} groups of techniques and arithmetics."),
            }],
            command: Some(document.command.clone()),
            facts,
        }
    }

    pub(super) fn of_selftest(run: &SelftestRun) -> Self {
        let mut facts = vec![("device".into(), "none: the embedded implementation makes every mistake".into())];
        facts.extend(run.seed.iter().map(|seed| ("seed".into(), seed.to_string())));
        facts.extend(made(run.version.as_deref(), run.made_at.as_deref(), None));
        Self {
            title: "lightmeter selftest".into(),
            is_success: Some(run.is_good()),
            says: vec![
                run.counted(),
                "The page shows what the suite catches of the mistakes that it knows, and how small an error it names."
                    .into(),
            ],
            command: run.command.clone(),
            facts,
        }
    }

    /// Of several results side by side.
    pub(super) fn of_matrix(reports: &[(&str, &Report)]) -> Self {
        let verdicts: Vec<Verdict> = reports.iter().map(|(_, report)| Verdict::new(report)).collect();
        let passing = verdicts.iter().filter(|verdict| verdict.is_success).count();
        let says = match (passing, verdicts.len()) {
            (1, 1) => "The result passes.".into(),
            (0, 1) => "The result fails.".into(),
            (all, of) if all == of => format!("All {of} results pass."),
            (0, of) => format!("None of {of} results passes."),
            (1, of) => format!("One of {of} results passes."),
            (several, of) => format!("{several} of {of} results pass."),
        };
        let facts = reports.iter().zip(&verdicts).map(|((name, report), verdict)| {
            let mark = if verdict.is_success { "✓ passes" } else { "✗ fails" };
            let mut lines = vec![format!("{mark}: {}", verdict.sentences.join(" "))];
            lines.extend(report.adapters.iter().map(device).map(|(name, what)| format!("{name}: {what}")));
            lines.push(format!("seed {}, profile {}", report.seed, report.profile));
            let made = made(report.version.as_deref(), report.made_at.as_deref(), Some(report.seconds));
            lines.push(made.iter().map(|(name, what)| format!("{name} {what}")).collect::<Vec<_>>().join(", "));
            lines.extend(report.command.clone());
            ((*name).to_owned(), lines.join("\n"))
        });
        Self {
            title: "lightmeter: formulas by subjects".into(),
            is_success: Some(passing == verdicts.len()),
            says: vec![
                says,
                "One column for each stage of each subject. A number is the greatest error as a share of what is legal.".into(),
            ],
            command: None,
            facts: facts.collect(),
        }
    }
}

/// The head of a page.
pub(super) fn head(facts: &Facts) -> Markup {
    let (class, mark) = match facts.is_success {
        Some(true) => ("head good", "✓ passes"),
        Some(false) => ("head bad", "✗ fails"),
        None => ("head", ""),
    };
    html! {
        header class=(class) {
            h1 { @if !mark.is_empty() { span.mark { (mark) } " " } (facts.title) }
            @for sentence in &facts.says { p { (prose(sentence)) } }
            @if let Some(command) = &facts.command { (super::failure::command(command)) }
        }
        @if !facts.facts.is_empty() {
            dl.facts { @for (name, what) in &facts.facts { dt { (name) } dd { @for (place, line) in what.lines().enumerate() { @if place > 0 { br; } (line) } } } }
        }
    }
}

/// What else a report says.
pub(super) fn notes(report: &Report) -> Markup {
    let mut skips: Vec<(&str, usize)> = vec![];
    for reason in report.groups.iter().filter_map(|group| group.skip_reason.as_deref()) {
        match skips.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, count)) => *count += 1,
            None => skips.push((reason, 1)),
        }
    }
    let has_notes = !(skips.is_empty()
        && report.deviations.is_empty()
        && report.expectations.is_empty()
        && report.notes.is_empty());
    html! {
        @if has_notes {
            section #notes {
                h2 { "What was excused, expected or left out" }
                ul {
                    @for note in &report.notes { li { (note) } }
                    @for deviation in &report.deviations {
                        li { b { (deviation.name) } " of " (deviation.adapter) ": " (deviation.reason) "; "
                            "it excuses " (thousands(deviation.excused)) " verdicts, and its witness "
                            @if deviation.still_needed { "still shows it." } @else { "no longer shows it." } }
                    }
                    @if let Some(said) = against::unused(report) { li { (said) } }
                    @for known in &report.expectations {
                        li { b { (known.id) } ", a known failure: " (known.reason) }
                    }
                    @for (reason, count) in skips { li { (count) " groups were skipped: " (reason) } }
                }
            }
        }
    }
}
