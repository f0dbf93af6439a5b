//! Answers as files.

use super::answer::{self, Hello, Unread};
use super::error::ProcessError;
use super::ledger::Ledger;
use super::pack;
use super::problems::note;
use super::process::Ending;
use lightmeter_document::event::Stop;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// The name of a folder's answers.
pub const ANSWERS: &str = "answers.jsonl";
/// Lines that are judged at once.
pub const LINES: usize = 1 << 14;

/// A file of answers, or that of a folder.
pub struct Answers {
    /// The file.
    pub path: PathBuf,
    stream: BufReader<File>,
    /// Where images lie.
    folder: PathBuf,
    /// Lines that were read.
    number: u64,
    /// The first line, where it is an answer.
    first: Vec<(u64, Vec<u8>)>,
    /// Who answers, where the first line says so.
    pub hello: Option<Hello>,
}

impl Answers {
    /// Opens it and reads who answers.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn open(answers: &Path) -> Result<Self, pack::PackError> {
        let path = if answers.is_dir() { answers.join(ANSWERS) } else { answers.to_owned() };
        let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        let file = File::open(&path)
            .map_err(|error| pack::PackError::Read { path: path.clone(), message: error.to_string() })?;
        let stream = BufReader::with_capacity(1 << 20, file);
        let mut opened = Self { path, stream, folder, number: 0, first: vec![], hello: None };
        if let Some(Ok(line)) = opened.next()? {
            match answer::read(&line) {
                Ok(answer::Line::Hello(hello)) => opened.hello = Some(*hello),
                Err(message) if answer::is_hello(&line) => {
                    return Err(pack::PackError::Manifest { path: opened.path, message: format!("line 1: {message}") });
                }
                _ => opened.first.push((opened.number, line)),
            }
        }
        Ok(opened)
    }

    /// The next line that is not blank, or that it is too long.
    fn next(&mut self) -> Result<Option<Result<Vec<u8>, Unread>>, pack::PackError> {
        let mut line = vec![];
        loop {
            self.number += 1;
            return match answer::next(&mut self.stream, &mut line) {
                Ok(false) => Ok(None),
                Ok(true) if line.iter().all(u8::is_ascii_whitespace) => continue,
                Ok(true) => Ok(Some(Ok(line))),
                Err(error @ Unread::TooLong) => Ok(Some(Err(error))),
                Err(Unread::Io(error)) => {
                    Err(pack::PackError::Read { path: self.path.clone(), message: error.to_string() })
                }
            };
        }
    }

    /// Judges all of it.
    ///
    /// # Errors
    /// Where the file cannot be read.
    fn judge(
        mut self,
        ledger: &mut Ledger<'_>,
        stop: &Stop,
        progress: &mut impl FnMut(u64),
    ) -> Result<(), pack::PackError> {
        let mut lines = std::mem::take(&mut self.first);
        loop {
            let next = self.next()?;
            let is_end = next.is_none();
            match next {
                Some(Ok(line)) => lines.push((self.number, line)),
                Some(Err(error)) => {
                    let line = ledger.line(self.number);
                    note(&mut ledger.problems, "oversized", || format!("{line}: {error}"));
                }
                None => {}
            }
            let is_over = is_end || stop.is_set();
            if lines.len() == LINES || is_over {
                ledger.lines(&lines, &self.folder);
                progress(lines.len() as u64);
                lines.clear();
            }
            if is_over {
                return Ok(());
            }
        }
    }
}

/// Judges files of answers: the first of each case, and that further files answer the same. Who answers is what the first says.
///
/// # Errors
/// Where a file cannot be read, or what it declares.
pub fn judge(
    ledger: &mut Ledger<'_>,
    all: Vec<Answers>,
    stop: &Stop,
    progress: &mut impl FnMut(u64),
) -> Result<Ending, ProcessError> {
    let mut who: Option<Hello> = None;
    let is_one = all.len() == 1;
    for mut answers in all {
        let hello = answers.hello.take();
        ledger.source = (!is_one).then(|| answers.path.display().to_string());
        let Some(first) = &who else {
            let first = hello.unwrap_or_else(Hello::everything);
            ledger.begin(&first)?;
            who = Some(first);
            answers.judge(ledger, stop, progress)?;
            continue;
        };
        if hello.is_some_and(|hello| hello != *first) {
            let what = format!("{}: another hello than that of the first file", ledger.line(1));
            note(&mut ledger.problems, "malformed", || what);
        }
        ledger.begin_again();
        answers.judge(ledger, stop, progress)?;
        if !stop.is_set() {
            ledger.end_again(|_| false);
        }
    }
    Ok(Ending { hello: who.unwrap_or_default(), signal: stop.signal(), ..Ending::default() })
}
