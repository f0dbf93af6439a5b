//! The card of a formula that fails: what it computes, of which inputs, where it departs, why, and how to see it again.

use super::card::{Card, failing_share, judged, source_of};
use super::matrix::{card_id, is_failing, unanswered};
use super::number::written;
use super::page::prose;
use super::plot;
use crate::text::{made_at, plain, unit_of};
use lightmeter_document::explained::{Explained, ShownMistake, ShownStep};
use lightmeter_document::report::{Failure, Group, Report, WorstAnswer};
use lightmeter_document::{Number, Word, distance_told, is_worse, thousands};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// The most cards of a page.
const MOST: usize = 400;
/// What is legal where both ends are a zero.
const ZEROS: &str = "0 or −0";
/// Cases that were not answered, or rows of them, that are named.
const MOST_NAMED: usize = 8;
/// Cards that are open at first.
const OPEN: usize = 3;

/// A command that can be copied.
pub(super) fn command(command: &str) -> Markup {
    html! { p.command { code { (command) } " " button type="button" data-copy=(command) { "copy" } } }
}

/// The cards of the formulas that fail, worst first, and how many more there are than a page has cards for.
pub(super) fn cards(report: &Report) -> (Vec<Card>, usize) {
    let failing = |group: &&Group| is_failing(group) && group.image.as_ref().is_none_or(|image| image.files.is_empty());
    let mut formulas: Vec<Vec<&Group>> = vec![];
    for group in report.groups.iter().filter(failing) {
        match formulas.iter_mut().find(|own| own[0].id == group.id && own[0].adapter == group.adapter) {
            Some(own) => own.push(group),
            None => formulas.push(vec![group]),
        }
    }
    formulas.sort_by(|a, b| failing_share(b).total_cmp(&failing_share(a)));
    let told = |(place, groups): (usize, &Vec<&Group>)| Card {
        anchor: card_id(&groups[0].id, &groups[0].adapter),
        name: groups[0].id.clone(),
        place: format!("{}, {}{}", groups[0].adapter, stages(groups), source_of(groups[0])),
        share: failing_share(groups),
        cause: groups.iter().find_map(|group| {
            group.cause().or_else(|| group.problem()).or_else(|| group.by_case.as_ref().and_then(unanswered))
        }),
        body: card(report, groups, place < OPEN),
    };
    (formulas.iter().take(MOST).enumerate().map(told).collect(), formulas.len().saturating_sub(MOST))
}

/// The stages of one formula that fail.
fn stages(groups: &[&Group]) -> String {
    groups.iter().map(|group| group.place()).collect::<Vec<_>>().join(", ")
}

/// The cards of formulas that pass, each with the case that comes nearest to what is illegal.
pub(super) fn passing_cards(report: &Report) -> Vec<Markup> {
    let is_of_a_failure = |one: &&Explained| report.failures.iter().any(|failure| failure.id == one.id);
    let card = |one: &Explained| {
        let answered = answer_of(report, one);
        let answer = answered.and_then(|group| group.worst_answer.as_ref());
        html! {
            details.card.passing {
                summary {
                    span.pass { "✓" } " its worst case: " b { (one.id) }
                    @if let Some(group) = answered { " " span.quiet { "on " (group.adapter) ", " (group.place()) } }
                }
                (formula(one))
                @if let Some(answer) = answer { (worst_answer(answer)) }
                (inputs_and_steps(&one.inputs, &one.units, Some(one), &Hint::None))
                @if let Some(course) = &one.course {
                    (plot::course(course, answer.filter(|answer| answer.output == course.output).map(|answer| answer.value.0)))
                }
                (command(&format!("lightmeter show {}", one.id)))
            }
        }
    };
    report.explained.iter().filter(|one| !is_of_a_failure(one)).map(card).collect()
}

/// The group whose worst case is explained, and which knows what was answered to it: of several the nearest to what is illegal.
fn answer_of<'a>(report: &'a Report, one: &Explained) -> Option<&'a Group> {
    let is_its = |group: &&Group| group.worst.as_ref() == Some(&one.id) && group.worst_answer.is_some();
    // Of equals the last of the reversed ones, which is the first.
    report.groups.iter().rev().filter(is_its).max_by(|a, b| a.margin_max.0.total_cmp(&b.margin_max.0))
}

/// What was answered to the worst case of a formula that passes.
fn worst_answer(answer: &WorstAnswer) -> Markup {
    let [low, high] = answer.interval;
    html! {
        p {
            code { (answer.output) } " is " b.pass { (answer.value.narrow()) } "; " (legal_are(answer.interval))
            ", the reference is " (answer.reference) "."
        }
        (plot::line(low.0, high.0, answer.reference.0, answer.value.0))
    }
}

/// The inputs of a case, and beside them the steps of its formula.
fn inputs_and_steps(
    inputs: &serde_json::Map<String, serde_json::Value>,
    units: &BTreeMap<String, Word>,
    explained: Option<&Explained>,
    hint: &Hint,
) -> Markup {
    html! {
        div.columns {
            @if !inputs.is_empty() { div {
                h4 { "inputs" }
                div.wide tabindex="0" role="group" aria-label="inputs" { table.inputs {
                    @for (name, value) in inputs {
                        tr { th scope="row" { (name) } td.number { (plain(value)) } td.quiet { @if let Some(unit) = units.get(name).filter(|unit| &***unit != "1") { (unit) } } }
                    }
                } }
            } }
            @if let Some(explained) = explained.filter(|explained| !explained.steps.is_empty()) { div { (steps(explained, hint)) } }
        }
    }
}

fn failed_of(group: &Group) -> String {
    let (failed, of) = judged(group);
    let what = if group.by_case.is_some() { "cases" } else { "values" };
    let unanswered = group.by_case.as_ref().and_then(unanswered);
    match unanswered {
        Some(unanswered) if failed == 0 => unanswered,
        Some(unanswered) => format!("{} of {} {what} fail. {unanswered}", thousands(failed), thousands(of)),
        None => format!("{} of {} {what} fail.", thousands(failed), thousands(of)),
    }
}

/// Why cases of a group were not answered, or which these are.
fn why_unanswered(group: &Group) -> Option<String> {
    let counts = group.by_case.as_ref().filter(|counts| counts.totals.missing + counts.totals.undeclared > 0)?;
    let mut said = vec![];
    if let Some(named) = counts.not_passed.get("missing").filter(|_| counts.totals.missing > 0) {
        let more = if named.len() > MOST_NAMED { ", …" } else { "" };
        said.push(format!(
            "never answered: {}{more}",
            named.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ")
        ));
    }
    if counts.totals.undeclared > 0 {
        let why = counts.reason.as_deref().unwrap_or("no reason was given");
        said.push(format!("skipped without having been declared: {why}"));
    }
    (!said.is_empty()).then(|| said.join("; "))
}

fn card(report: &Report, groups: &[&Group], is_open: bool) -> Markup {
    let group = groups[0];
    let is_its = |failure: &&Failure| {
        let below = failure.id.strip_prefix(&group.id).is_some_and(|rest| rest.starts_with('/'));
        below && failure.adapter == group.adapter
    };
    let failure = report.failures.iter().find(is_its);
    let explained = failure.and_then(|failure| report.explained.iter().find(|one| one.id == failure.id));
    html! {
        details.card id=(card_id(&group.id, &group.adapter)) open[is_open] {
            summary {
                span.fail { "✗" } " " b { (group.id) } " on " (group.adapter) " "
                span.quiet { @for own in groups { (own.place()) ": " (failed_of(own)) " " } }
            }
            @for (place, own) in groups.iter().enumerate() {
                @for what in own.reasons() {
                    @if place == 0 || !groups[..place].iter().any(|other| other.reasons().any(|known| known == what)) {
                        p.cause { (written(&what)) }
                    }
                }
                @if let Some(why) = why_unanswered(own) { p.cause { (why) } }
            }
            @if let Some(shader) = &report.shader {
                @for place in shader.places(&group.id) { pre { (made_at(shader, place)) } }
            }
            @if let Some(explained) = explained { (formula(explained)) }
            @if let Some(failure) = failure { (case(failure, explained, &hint_of(groups, explained))) }
        }
    }
}

fn formula(explained: &Explained) -> Markup {
    html! {
        p.formula { (explained.formula) }
        @if !explained.rules.is_empty() { ul.rules { @for rule in &explained.rules { li { (prose(rule)) } } } }
        p.quiet { "Source: " (prose(&explained.source)) }
    }
}

/// The first failing case: a line with what is legal, its inputs, its steps, and its course along one input.
fn case(failure: &Failure, explained: Option<&Explained>, hint: &Hint) -> Markup {
    html! {
        h3 { "A failing case: " code { (failure.id) } }
        (verdict(failure))
        (inputs_and_steps(&failure.inputs, &failure.units, explained, hint))
        @if let Some(course) = explained.and_then(|explained| explained.course.as_ref()) {
            (plot::course(course, (course.output == failure.output).then_some(failure.value.0)))
        }
        @if !failure.rerun.is_empty() { (command(&failure.rerun)) }
    }
}

fn verdict(failure: &Failure) -> Markup {
    let [low, high] = failure.interval;
    if let Some(answer) = &failure.answer {
        return html! {
            div.wide tabindex="0" role="group" aria-label="outputs" { table {
                thead { tr { th scope="col" { "output" } th scope="col" { "answer" } th scope="col" { "legal" } th scope="col" { "reference" } } }
                @for (k, name) in answer.outputs.iter().enumerate() {
                    @let interval = answer.interval.get(k).copied().unwrap_or([Number(f64::NAN); 2]);
                    @let value = answer.value.get(k).copied();
                    @let is_out = value.is_none_or(|value| !(interval[0].0 <= value.0 && value.0 <= interval[1].0));
                    tr class=[is_out.then_some("fail")] {
                        th scope="row" { (name) }
                        td.number { @if let Some(value) = value { (value.narrow()) } @else { "—" } }
                        td.number { (legal(interval)) }
                        td.number { @if let Some(reference) = answer.reference.get(k) { (reference) } }
                    }
                }
            } }
            @if let Some(problem) = &answer.problem { p.cause { (problem) } }
        };
    }
    html! {
        p {
            code { (failure.output) } " is " b.fail { (failure.value.narrow()) } @if failure.unwritten { " (it was never written)" }
            "; " @match &failure.promise { Some(promise) => { "legal is " (promise) } None => { (legal_are(failure.interval)) ", the reference is " (failure.reference) } }
            ", so that it is " (written(&distance_told(failure.error_ulp, unit_of(failure), failure.value, failure.reference)))
            "."
        }
        @if failure.promise.is_none() { (plot::line(low.0, high.0, failure.reference.0, failure.value.0)) }
    }
}

/// The legal values, from the least to the greatest; either zero alone where no other value is legal.
fn legal([low, high]: [Number; 2]) -> String {
    if low.0 == 0.0 && high.0 == 0.0 {
        return ZEROS.into();
    }
    let [low, high] = [low, high].map(Number::narrow);
    if low == high { format!("{low} alone") } else { format!("{low} to {high}") }
}

/// The same in a sentence.
fn legal_are(interval: [Number; 2]) -> String {
    let [low, high] = interval.map(Number::narrow);
    match legal(interval) {
        zeros if zeros == ZEROS => "0 and −0 alone are legal".into(),
        _ if low == high => format!("{low} alone is legal"),
        range => format!("legal are {range}"),
    }
}

/// What is said below steps of which none is marked as the first that departs.
enum Hint {
    /// Nothing: nothing fails.
    None,
    /// The cause has a name, and it is made in the result, or in a step without a name.
    InTheResult,
    /// What fails is explained, but not by a mistake of the catalogue: the cause above says how.
    AsTheCauseSays,
    /// No cause is known.
    Unknown,
}

fn hint_of(groups: &[&Group], explained: Option<&Explained>) -> Hint {
    if explained.is_some_and(|explained| explained.mistake.is_some()) {
        Hint::InTheResult
    } else if groups.iter().any(|group| group.diagnosis.is_some()) {
        Hint::AsTheCauseSays
    } else {
        Hint::Unknown
    }
}

/// The names of steps, with their components. What is computed several times, such as for each of two lights, is numbered.
fn step_names(steps: &[ShownStep]) -> Vec<String> {
    let name = |step: &ShownStep| match &step.component {
        Some(component) => format!("{}.{component}", step.name),
        None => step.name.to_string(),
    };
    let names: Vec<String> = steps.iter().map(name).collect();
    let count = |among: &[String], name: &String| among.iter().filter(|other| *other == name).count();
    let numbered = |(place, name): (usize, &String)| match count(&names, name) {
        1 => name.clone(),
        _ => format!("{name} ({})", count(&names[..=place], name)),
    };
    names.iter().enumerate().map(numbered).collect()
}

/// The steps with what is legal of each, beside what they are with the mistake; the first that departs is marked.
fn steps(explained: &Explained, hint: &Hint) -> Markup {
    let mistake = explained.mistake.as_ref();
    let made = |place: usize| -> Option<Number> {
        // The components of a vector share a name: the same place among those of that name.
        let name = &explained.steps[place].name;
        let nth = explained.steps[..place].iter().filter(|step| step.name == *name).count();
        let seen: Vec<_> = mistake?.steps.iter().filter(|step| step.name == *name).collect();
        let right = explained.steps[place].value.0;
        // Only the numbers that differ are told of a mistake.
        let same = seen.iter().find(|step| step.right.0.to_bits() == right.to_bits());
        same.or_else(|| seen.get(nth)).filter(|step| step.right.0.to_bits() == right.to_bits()).map(|step| step.made)
    };
    let departs = (0..explained.steps.len()).find(|&place| {
        let [low, high] = explained.steps[place].interval;
        made(place).is_some_and(|made| is_worse(made.0, high.0) || is_worse(low.0, made.0))
    });
    let names = step_names(&explained.steps);
    html! {
        h4 { "steps" }
        div.wide tabindex="0" role="group" aria-label="steps" { table.steps {
            thead { tr {
                th scope="col" { "step" } th scope="col" { "reference" } th scope="col" { "legal" }
                @if let Some(ShownMistake { name, .. }) = mistake { th scope="col" { "with " (name) } }
            } }
            @for (place, step) in explained.steps.iter().enumerate() {
                tr class=[(departs == Some(place)).then_some("departs")] {
                    th scope="row" { (names[place]) @if departs == Some(place) { " ← departs here" } }
                    td.number { (step.value.narrow()) }
                    td.number { (legal(step.interval)) }
                    @if mistake.is_some() { td.number { @if let Some(made) = made(place) { (made.narrow()) } } }
                }
            }
        } }
        @if departs.is_none() {
            @match hint {
                Hint::None => {}
                Hint::InTheResult => { p.hint { "All steps are right with this mistake: it is made in the result itself, or in a step that has no name." } }
                Hint::AsTheCauseSays => { p.hint { "Only the result is known of whoever answered. What is said above explains it as a whole, so no step can be said to be the first that departs." } }
                Hint::Unknown => { p.hint { "Only the result is known of whoever answered, and no mistake by name explains it, so no step can be said to be the first that departs." } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::report::{Diagnosis, Explanation, Standing};

    fn step(name: &'static str, component: Option<&'static str>) -> ShownStep {
        let value = Number(0.0);
        ShownStep { name: name.into(), component: component.map(Into::into), value, interval: [value; 2] }
    }

    #[test]
    fn steps_have_their_components_and_what_is_computed_twice_is_numbered() {
        let steps = [
            step("l·n", None),
            step("CD", Some("r")),
            step("CD", Some("g")),
            step("l·n", None),
            step("CD", Some("r")),
            step("CD", Some("g")),
            step("CF", Some("r")),
        ];
        let expected = ["l·n (1)", "CD.r (1)", "CD.g (1)", "l·n (2)", "CD.r (2)", "CD.g (2)", "CF.r"];
        assert_eq!(step_names(&steps), expected);
    }

    #[test]
    fn what_is_legal_is_a_range_or_one_value() {
        let said = |low, high| (legal([Number(low), Number(high)]), legal_are([Number(low), Number(high)]));
        assert_eq!(said(0.0, -0.0), ("0 or −0".into(), "0 and −0 alone are legal".into()));
        assert_eq!(said(0.5, 0.5), ("0.5 alone".into(), "0.5 alone is legal".into()));
        assert_eq!(said(0.25, 0.5), ("0.25 to 0.5".into(), "legal are 0.25 to 0.5".into()));
    }

    #[test]
    fn a_cause_that_is_known_is_not_called_unknown() {
        let mut group = Group::new("fog/exp".into(), "renderer".into(), "answer");
        assert!(matches!(hint_of(&[&group], None), Hint::Unknown));
        let explanation = Explanation {
            says: "fog uses radial distance".into(),
            mistakes: vec!["fog-radial".into()],
            parameter: None,
            explained: 1,
            open: 0,
            standing: Standing::Best,
        };
        group.diagnosis = Some(Diagnosis { explanations: vec![explanation], ..Diagnosis::default() });
        assert!(matches!(hint_of(&[&group], None), Hint::AsTheCauseSays));
    }
}
