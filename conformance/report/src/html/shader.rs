//! Shaders as a page: each one's source with its steps beside it.

use super::page::{PageKind, page};
use lightmeter_document::report::{ShaderReview, ShaderStep, StepVerdict};
use maud::{Markup, html};

/// A verdict's mark, and the class that it is shown by.
const fn shown(step: &ShaderStep) -> (&'static str, &'static str) {
    match step.verdict {
        _ if step.accepted => ("✓", "skip"),
        StepVerdict::Right => ("✓", "pass"),
        StepVerdict::Dialect => ("~", "known"),
        StepVerdict::Mistake => ("✗", "fail"),
        StepVerdict::Perhaps => ("?", "known"),
    }
}

/// A step beside its line.
fn step(step: &ShaderStep) -> Markup {
    let (mark, class) = shown(step);
    let judged = step.judged.as_ref();
    let said = step.judged_says();
    html! {
        div .step .(class) {
            strong { (mark) " " (step.kind) }
            @if !step.name.is_empty() { " " code { (step.name) } }
            @if step.accepted { " (accepted)" }
            div .says { (step.sentence) }
            @if let Some(said) = said { div .says { (said) } }
            @if let Some(judged) = judged.filter(|own| own.problem.is_none() && own.random_wrong + own.hard_wrong == 0) {
                div .hint { "by " (judged.formula) ", all of " (judged.random + judged.hard) " cases pass" }
            }
        }
    }
}

/// Whether a step stands in the list above the source.
fn is_told(step: &ShaderStep) -> bool {
    step.verdict != StepVerdict::Right && step.line > 0
}

fn shader(own: &ShaderReview, source: &str, place: usize) -> Markup {
    let at = |line: u32| own.steps.iter().filter(move |step| step.line == line);
    let last = u32::try_from(source.lines().count()).unwrap_or(u32::MAX);
    html! {
        section id=(format!("shader-{place}")) {
            h2 { (own.file) }
            @if let Some(why) = &own.unread {
                p .fail { "not read: " (why) }
            } @else {
                p .hint { (own.language) @if own.reader != "naga" { ", read by " (own.reader) } }
            }
            @for note in &own.notes { p .hint { (note) } }
            @for what in &own.refused { p .fail { "line " (what.line) ": " (what.says) } }
            @for sum in &own.sums {
                p .formula {
                    (sum.output) " = " (sum.terms.join(" + "))
                    @for then in &sum.then { ", then " (then) }
                }
            }
            @if own.steps.iter().any(is_told) {
                ul {
                    @for step in own.steps.iter().filter(|step| is_told(step)) {
                        li {
                            a href=(format!("#shader-{place}-{}", step.line)) { "line " (step.line) } ": "
                            span .(shown(step).1) { (shown(step).0) " " (step.kind) } " " (step.name)
                        }
                    }
                }
            }
            @for own in own.steps.iter().filter(|step| step.line == 0 || step.line > last) { (step(own)) }
            @if !own.steps.is_empty() {
                div .wide {
                    table .source {
                        @for (line, text) in (1_u32..).zip(source.lines()) {
                            tr id=[at(line).next().map(|_| format!("shader-{place}-{line}"))] {
                                td .right .quiet { (line) }
                                td { pre { (text) } }
                                td { @for own in at(line) { (step(own)) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The page of shaders, each with its source; and notes on all of them.
#[must_use]
pub fn of_shaders(shaders: &[(&ShaderReview, String)], is_strict: bool, notes: &[String]) -> String {
    let steps = || shaders.iter().flat_map(|(own, _)| &own.steps);
    let wrong = steps().filter(|step| step.is_wrong(is_strict)).count();
    let unread = shaders.iter().filter(|(own, _)| own.unread.is_some()).count();
    let class = if wrong + unread == 0 { "good" } else { "bad" };
    let number = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let title = format!("{}: {} of {} wrong", number(shaders.len(), "shader"), wrong, number(steps().count(), "step"));
    let body = html! {
        div .head .(class) {
            h1 { (title) }
            @if unread > 0 { p { (number(unread, "file")) " not read" } }
            @for note in notes { p { (note) } }
        }
        @if shaders.len() > 1 {
            ul {
                @for (place, (own, _)) in shaders.iter().enumerate() {
                    @let wrong = own.steps.iter().filter(|step| step.is_wrong(is_strict)).count();
                    li {
                        a href=(format!("#shader-{place}")) { (own.file) }
                        @if own.unread.is_some() { ": not read" }
                        @else { ": " (number(own.steps.len(), "step")) @if wrong > 0 { ", " span .fail { (wrong) " wrong" } } }
                    }
                }
            }
        }
        @for (place, (own, source)) in shaders.iter().enumerate() { (shader(own, source, place)) }
    };
    page(&title, PageKind::Report, &body)
}
