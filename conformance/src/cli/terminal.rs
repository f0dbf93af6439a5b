//! What people see: how much of it, how wide, and in which colours.

use clap::{Args, ValueEnum};
use lightmeter::report::Level;
use std::io::{IsTerminal, Write};
use std::sync::OnceLock;

/// Columns of a terminal that does not say how many it has.
const COLUMNS: usize = 80;
/// The columns of the longest line that is read with ease.
const MOST_COLUMNS: usize = 120;

/// How results for people are shown.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct Shown {
    /// Whether to use colours; `auto` does on a terminal, unless NO_COLOR is set
    #[arg(
        long,
        global = true,
        value_name = "WHEN",
        value_enum,
        default_value = "auto",
        help_heading = "How it is shown"
    )]
    color: Color,
    /// Say only what fails, and the verdict
    #[arg(short, long, global = true, conflicts_with = "verbose", help_heading = "How it is shown")]
    quiet: bool,
    /// Say more: how near each family comes to its limits, hard cases, bits, what known deviations excuse
    #[arg(short, long, global = true, help_heading = "How it is shown")]
    verbose: bool,
}

/// When colours are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Color {
    /// On a terminal, unless NO_COLOR is set or TERM is `dumb`
    #[default]
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

static SHOWN: OnceLock<Shown> = OnceLock::new();

/// Settles how results are shown, once, before there is any.
pub(crate) fn settle(shown: Shown) {
    let _ = SHOWN.set(shown);
}

/// How much is said.
pub(crate) fn level() -> Level {
    match SHOWN.get() {
        Some(Shown { quiet: true, .. }) => Level::Quiet,
        Some(Shown { verbose: true, .. }) => Level::Verbose,
        _ => Level::Normal,
    }
}

/// Text for people on a stream: wrapped to a terminal's width, or to that which COLUMNS says, and coloured where that is wanted. A file or
/// a pipe has all the room that lines take.
pub(crate) fn dressed(text: &str, stream: &impl IsTerminal) -> String {
    let wrapped = columns(stream).map_or_else(|| text.to_owned(), |columns| wrapped(text, columns));
    if has_colors(stream) { painted(&wrapped) } else { wrapped }
}

fn has_colors(stream: &impl IsTerminal) -> bool {
    match SHOWN.get().map(|shown| shown.color).unwrap_or_default() {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => {
            let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
            let is_dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
            stream.is_terminal() && !is_set("NO_COLOR") && !is_dumb
        }
    }
}

/// The columns that text is wrapped to; `None` where it is not.
fn columns(stream: &impl IsTerminal) -> Option<usize> {
    let asked = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let own = || terminal_size::terminal_size().map_or(COLUMNS, |(width, _)| usize::from(width.0));
    let columns: Option<usize> = asked.or_else(|| stream.is_terminal().then(own));
    columns.map(|columns| columns.clamp(COLUMNS / 2, MOST_COLUMNS))
}

/// Lines of at most `columns` columns. What a line continues with stands two columns further in; a command to copy stays whole.
fn wrapped(text: &str, columns: usize) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let content = line.trim_end_matches('\n');
        if is_command(content.trim_start()) || textwrap::core::display_width(content) <= columns {
            out.push_str(line);
            continue;
        }
        let indent = " ".repeat(content.len() - content.trim_start_matches(' ').len() + 2);
        let options = textwrap::Options::new(columns).subsequent_indent(&indent);
        let options = options.break_words(false).word_splitter(textwrap::WordSplitter::NoHyphenation);
        out.push_str(&textwrap::wrap(content, options).join("\n"));
        out.push_str(&line[content.len()..]);
    }
    out
}

const BOLD: anstyle::Style = anstyle::Style::new().bold();
const RED: anstyle::Style = anstyle::AnsiColor::Red.on_default().bold();
const GREEN: anstyle::Style = anstyle::AnsiColor::Green.on_default().bold();
const YELLOW: anstyle::Style = anstyle::AnsiColor::Yellow.on_default();
const CYAN: anstyle::Style = anstyle::AnsiColor::Cyan.on_default();

/// Beginnings of lines with their colours.
const BEGINNINGS: [(&str, anstyle::Style); 9] = [
    ("✗", RED),
    ("FAIL", RED),
    ("error:", RED),
    ("FALSE ALARM", RED),
    ("✓", GREEN),
    ("warning:", YELLOW),
    ("known deviations", YELLOW),
    ("known deviation", YELLOW),
    ("skipped", YELLOW),
];

/// The text with the marks at the beginnings of its lines, and the commands that it names, in colours.
fn painted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + text.len() / 8);
    for line in text.split_inclusive('\n') {
        let content = line.trim_start_matches(' ');
        let (indent, rest) = line.split_at(line.len() - content.len());
        out.push_str(indent);
        if let Some((word, style)) = BEGINNINGS.iter().find(|(word, _)| begins(rest, word)) {
            out.push_str(&format!("{style}{word}{style:#}{}", &rest[word.len()..]));
        } else if let Some((before, cause)) = rest.split_once("explained by: ") {
            let end = cause.trim_end_matches('\n');
            out.push_str(&format!("{before}explained by: {BOLD}{end}{BOLD:#}{}", &cause[end.len()..]));
        } else if let Some(place) = rest.find("lightmeter ").filter(|_| is_command(rest)) {
            let (before, command) = rest.split_at(place);
            let end = command.trim_end_matches('\n');
            out.push_str(&format!("{before}{CYAN}{end}{CYAN:#}{}", &command[end.len()..]));
        } else {
            out.push_str(rest);
        }
    }
    out
}

/// Whether a line begins with a word, and not with a longer one.
fn begins(line: &str, word: &str) -> bool {
    line.strip_prefix(word).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
}

/// Whether a line is a command that may be copied.
fn is_command(line: &str) -> bool {
    ["lightmeter ", "again ", "explained  "].iter().any(|word| line.starts_with(word))
}

/// Writes text for people to a stream.
pub(crate) fn write(text: &str, stream: &mut (impl Write + IsTerminal)) -> std::io::Result<()> {
    let text = dressed(text, stream);
    stream.write_all(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_wrapped_below_where_they_begin() {
        let text = "  a line of words that is too long\nshort\n  again   lightmeter run something long\n";
        let expected = "  a line of words\n    that is too long\nshort\n  again   lightmeter run something long\n";
        assert_eq!(wrapped(text, 20), expected);
    }

    #[test]
    fn marks_and_commands_have_colors() {
        let text = painted("✗ fog/exp: 1 failed\n  again  lightmeter run x\n  ✗ not alone\nplain lightmeter words\n");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "\u{1b}[1m\u{1b}[31m✗\u{1b}[0m fog/exp: 1 failed");
        assert_eq!(lines[1], "  again  \u{1b}[36mlightmeter run x\u{1b}[0m");
        assert_eq!(lines[3], "plain lightmeter words");
    }
}
