//! A text whose lines know which line of the file they are of.

/// Lines with the line of the file that each is of; 0 of those that the file does not have.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    pub(super) text: String,
    of: Vec<u32>,
}

impl Lines {
    /// The lines of a file. Some editors begin a file with a mark of its byte order, and some end lines with CR alone.
    pub(super) fn of_file(text: &str) -> Self {
        let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
        let mut own = Self::default();
        for (number, line) in (1..).zip(text.lines()) {
            own.push(line, number);
        }
        own
    }

    pub(super) fn push(&mut self, line: &str, number: u32) {
        self.text += line;
        self.text.push('\n');
        self.of.push(number);
    }

    /// Another text of as many lines, each of the same line of the file.
    pub(super) fn with_text(&self, text: &str) -> Self {
        let mut text = text.to_owned();
        if !text.ends_with('\n') {
            text.push('\n');
        }
        Self { text, of: self.of.clone() }
    }

    /// Lines that the file does not have.
    pub(super) fn push_all(&mut self, text: &str) {
        text.lines().for_each(|line| self.push(line, 0));
    }

    pub(super) fn append(&mut self, other: &Self) {
        self.text += &other.text;
        self.of.extend_from_slice(&other.of);
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, u32)> {
        self.text.lines().zip(self.of.iter().copied())
    }

    /// The file's line of a line of the text, both from 1. One that the file does not have is that of the last before it.
    pub(super) fn line(&self, place: usize) -> u32 {
        let before = &self.of[..place.min(self.of.len())];
        before.iter().rev().copied().find(|own| *own > 0).unwrap_or(0)
    }
}
