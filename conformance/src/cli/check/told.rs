//! What is found in shaders, in words.

use super::source_of;
use lightmeter::document::report::{JudgedStep, ShaderReview, ShaderStep, ShaderSum, StepVerdict};
use std::fmt::Write as _;

/// Characters of a source line that are shown.
const MOST_SOURCE: usize = 64;
/// Terms of a sum that are shown.
const MOST_TERMS: usize = 6;
/// Characters of a line.
const WIDTH: usize = 100;

const fn mark(verdict: StepVerdict) -> &'static str {
    match verdict {
        StepVerdict::Right => "✓",
        StepVerdict::Dialect => "~",
        StepVerdict::Mistake => "✗",
        StepVerdict::Perhaps => "?",
    }
}

/// `1 step`, `2 steps`.
fn number(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// Text of at most so many characters.
fn cut(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

pub(super) fn told(shaders: &[ShaderReview], is_strict: bool, notes: &[String]) -> String {
    let mut text = String::new();
    for shader in shaders {
        let _ = tell(shader, is_strict, &mut text);
    }
    if shaders.len() > 1 {
        let all = |verdict: StepVerdict| shaders.iter().map(|own| own.open(verdict)).sum::<usize>();
        let accepted = shaders.iter().flat_map(|own| &own.steps).filter(|step| step.accepted).count();
        let steps: usize = shaders.iter().map(|own| own.steps.len()).sum();
        let unread = shaders.iter().filter(|own| own.unread.is_some()).count();
        let mut parts = vec![number(shaders.len(), "file"), number(steps, "step")];
        for (verdict, word) in [
            (StepVerdict::Mistake, "wrong"),
            (StepVerdict::Perhaps, "perhaps wrong"),
            (StepVerdict::Dialect, "in a dialect"),
        ] {
            parts.extend((all(verdict) > 0).then(|| format!("{} {word}", all(verdict))));
        }
        parts.extend((accepted > 0).then(|| format!("{accepted} accepted")));
        parts.extend((unread > 0).then(|| format!("{unread} not read")));
        let _ = writeln!(text, "{}", parts.join(", "));
    }
    for note in notes {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

fn tell(shader: &ShaderReview, is_strict: bool, text: &mut String) -> std::fmt::Result {
    if let Some(why) = &shader.unread {
        // `12: what is wrong` is of a line.
        let colon = if why.starts_with(|c: char| c.is_ascii_digit()) { ":" } else { ": " };
        return writeln!(text, "{}{colon}{why}\n", shader.file);
    }
    let reader = if shader.reader == "naga" { String::new() } else { format!(" (read by {})", shader.reader) };
    let steps =
        if shader.steps.is_empty() { "no step that is known".to_owned() } else { number(shader.steps.len(), "step") };
    let judged: Vec<&JudgedStep> =
        shader.steps.iter().filter_map(|step| step.judged.as_ref()).filter(|own| own.problem.is_none()).collect();
    let by = |own: &str| if own == "f32" { "in f32".to_owned() } else { format!("on {own}") };
    let judged = judged.first().map_or_else(String::new, |own| format!(", {} judged {}", judged.len(), by(&own.by)));
    writeln!(text, "{}: {}{reader}, {steps}{judged}", shader.file, shader.language)?;
    for note in &shader.notes {
        writeln!(text, "  note: {note}")?;
    }
    for what in &shader.refused {
        writeln!(text, "  ✗ line {}: {}", what.line, what.says)?;
    }
    if shader.steps.is_empty() {
        return writeln!(text);
    }
    writeln!(text)?;
    let source = source_of(shader);
    let width = shader.steps.iter().map(|step| step.kind.len()).max().unwrap_or(0);
    for step in &shader.steps {
        tell_step(step, &source, width, text)?;
    }
    for sum in &shader.sums {
        tell_sum(sum, text)?;
    }
    let of = number(shader.steps.len(), "step");
    let are = |n: usize| if n == 1 { "is" } else { "are" };
    let wrong = shader.open(StepVerdict::Mistake);
    if wrong > 0 {
        writeln!(text, "✗ {wrong} of {of} {} wrong", are(wrong))?;
    }
    let dialects = shader.open(StepVerdict::Dialect);
    if is_strict && dialects > 0 {
        writeln!(text, "✗ {dialects} of {of} {} in a dialect, which --strict counts", are(dialects))?;
    }
    writeln!(text)
}

fn tell_step(step: &ShaderStep, source: &str, width: usize, text: &mut String) -> std::fmt::Result {
    let line = (step.line as usize).checked_sub(1).and_then(|k| source.lines().nth(k)).map(str::trim);
    let shown = line.filter(|own| !own.is_empty()).unwrap_or(&step.code);
    let place = if step.line == 0 { String::new() } else { step.line.to_string() };
    // Of what is right the formula is named by which it is right.
    let name = match (&step.judged, step.verdict) {
        (Some(judged), StepVerdict::Right) if judged.problem.is_none() => format!(" {}", judged.formula),
        (_, StepVerdict::Right) => String::new(),
        _ => format!(" {}", step.name),
    };
    let name = name.trim_end();
    let accepted = if step.accepted { " (accepted)" } else { "" };
    let shown = cut(shown, MOST_SOURCE);
    writeln!(text, "{place:>5}  {:<width$}  {shown:<MOST_SOURCE$}  {}{name}{accepted}", step.kind, mark(step.verdict))?;
    let indent = " ".repeat(9 + width);
    let options = textwrap::Options::new(WIDTH)
        .word_splitter(textwrap::WordSplitter::NoHyphenation)
        .initial_indent(&indent)
        .subsequent_indent(&indent);
    if step.verdict != StepVerdict::Right {
        writeln!(text, "{}", textwrap::fill(&step.sentence, &options))?;
    }
    // What contradicts the review is in its sentence.
    if let Some(said) = step.judged_says() {
        writeln!(text, "{}", textwrap::fill(&said, options))?;
    }
    Ok(())
}

fn tell_sum(sum: &ShaderSum, text: &mut String) -> std::fmt::Result {
    let more = sum.terms.len().saturating_sub(MOST_TERMS);
    let mut terms: Vec<String> = sum.terms.iter().take(MOST_TERMS).cloned().collect();
    terms.extend((more > 0).then(|| format!("{more} more")));
    let then: String = sum.then.iter().map(|own| format!(", then {own}")).collect();
    let said = format!("{} = {}{then}", sum.output, terms.join(" + "));
    let options = textwrap::Options::new(WIDTH).initial_indent("  ").subsequent_indent("      ");
    writeln!(text, "\n{}", textwrap::fill(&said, options))
}
