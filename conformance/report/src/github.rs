//! Lines that GitHub Actions shows as annotations.

use crate::against::wrong;
use crate::text::{is_told_by, one_line, sentence};
use lightmeter_document::cases;
use lightmeter_document::report::{Group, Report, ShaderReview, StepVerdict};

fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

fn annotation(kind: &str, title: &str, text: &str) -> String {
    let separator = if kind.contains(' ') { "," } else { " " };
    format!("::{kind}{separator}title={}::{}\n", property(title), data(text))
}

/// An error at the line where a group's code stands, as far as it is known: where a shader's mistake is made, or where a renderer's hello says.
fn at_code(group: &Group, report: &Report) -> String {
    let at = |file: &str, line: Option<String>| {
        let line = line.map_or_else(String::new, |line| format!(",line={line}"));
        format!("error file={}{line}", property(file))
    };
    if let Some(shader) = &report.shader {
        return at(&shader.file, shader.places(&group.id).next().map(|place| place.line.to_string()));
    }
    let source = group.source.as_ref();
    source.map_or_else(|| "error".into(), |source| at(&source.file, source.line.map(|line| line.to_string())))
}

/// The annotations of a result: one for each group that fails, with its first failing case.
#[must_use]
pub fn annotations(report: &Report) -> String {
    let mut out = String::new();
    if let Some(config) = &report.config {
        out += &annotation("notice", "settings", &config.to_string());
    }
    for group in report.groups.iter().filter(|group| group.is_failed()) {
        let smallest = group.asked().and_then(|counts| counts.smallest.as_ref());
        let mut of = report.failures.iter().filter(|failure| is_told_by(group, failure));
        let failure = of.find(|failure| group.asked().is_none() || smallest == Some(&failure.id));
        let which = if group.asked().is_some() { "smallest failing case " } else { "" };
        let case = failure.map_or_else(String::new, |failure| format!("\n{which}{}", one_line(failure)));
        let (title, of) = match group.asked() {
            Some(_) => (group.name(), String::new()),
            None => (group.id.clone(), format!("✗ {}: ", group.name())),
        };
        out += &annotation(&at_code(group, report), &title, &(of + &sentence(group) + &case));
    }
    for warning in report.renderer.iter().flat_map(|renderer| &renderer.warnings) {
        out += &annotation("warning", "doubtful", warning);
    }
    for note in &report.notes {
        out += &annotation("warning", "note", &note.to_string());
    }
    for deviation in report.deviations.iter().filter(|deviation| !deviation.still_needed) {
        let title = format!("deviation/{}", deviation.name);
        out += &annotation("error", &title, "unexpected pass: the deviation is no longer needed");
    }
    for (title, what) in wrong(report) {
        out += &annotation("error", &title, &what);
    }
    let said = match &report.renderer {
        Some(renderer) => {
            let totals = report.cases();
            let of = cases(totals.asked);
            format!("{}: {} of {of} pass, {} fail", renderer.identity.name, totals.passed, totals.failed)
        }
        None => {
            let totals = &report.totals;
            format!("{} of {} verdicts pass, {} fail", totals.passed, totals.verdicts, totals.failed)
        }
    };
    out + &annotation("notice", "lightmeter", &said)
}

/// The annotations of shaders: one at the line of each step that is not right, an error where it counts as wrong; and notes on all of them.
#[must_use]
pub fn of_shaders(shaders: &[ShaderReview], is_strict: bool, notes: &[String]) -> String {
    let mut out = String::new();
    for shader in shaders {
        let at = |kind: &str, line: u32| {
            let line = if line == 0 { String::new() } else { format!(",line={line}") };
            format!("{kind} file={}{line}", property(&shader.file))
        };
        if let Some(why) = &shader.unread {
            out += &annotation(&at("error", 0), "not read", why);
        }
        for what in &shader.refused {
            out += &annotation(&at("error", what.line), "accept", &what.says);
        }
        for step in shader.steps.iter().filter(|step| step.verdict != StepVerdict::Right) {
            let kind = match step.verdict {
                _ if step.is_wrong(is_strict) => "error",
                StepVerdict::Perhaps if !step.accepted => "warning",
                _ => "notice",
            };
            let title = format!("{}: {}", step.kind, step.name);
            let accepted = if step.accepted { " (accepted)" } else { "" };
            out += &annotation(
                &at(kind, step.line),
                title.trim_end_matches([':', ' ']),
                &format!("{}{accepted}", step.says()),
            );
        }
        for note in &shader.notes {
            out += &annotation(&at("notice", 0), "note", note);
        }
    }
    out + &notes.iter().map(|note| annotation("warning", "note", note)).collect::<String>()
}
