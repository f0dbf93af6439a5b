//! The time of a conversation: the machine's, or a test's, which passes only when the renderer says so.
//!
//! A test of a time limit that waited for real time would depend on how fast and how busy the machine is. So a renderer of a test writes a
//! *mark* into its output: the byte 0xff, `passes:` and eight digits, the milliseconds that have passed. Marks may stand anywhere, within a line
//! or an array too; the limits see the time once everything before the mark was heard.

use std::cell::Cell;
use std::io::{Read, Result};
use std::time::{Duration, Instant};

/// What a mark begins with.
const MARK: &[u8] = b"\xffpasses:";
/// Digits of its milliseconds.
const DIGITS: usize = 8;

/// A clock that starts at 0.
pub(super) struct Clock {
    begun: Instant,
    /// The time that has passed, where the renderer tells it.
    told: Option<Cell<Duration>>,
}

impl Clock {
    pub(super) fn new(is_told: bool) -> Self {
        Self { begun: Instant::now(), told: is_told.then(Cell::default) }
    }

    /// Time since the conversation began.
    pub(super) fn now(&self) -> Duration {
        self.told.as_ref().map_or_else(|| self.begun.elapsed(), Cell::get)
    }

    /// Whether marks are read.
    pub(super) const fn is_told(&self) -> bool {
        self.told.is_some()
    }

    /// Adds time that the renderer says has passed.
    pub(super) fn pass(&self, time: Duration) {
        if let Some(told) = &self.told {
            told.set(told.get() + time);
        }
    }
}

/// A stream without its marks. Each is handed to `passes` after all bytes before it were read.
pub(super) struct Unmarked<R, F> {
    stream: R,
    passes: F,
    /// Bytes that were read from `stream` and not handed on yet.
    held: Vec<u8>,
}

impl<R: Read, F: FnMut(Duration)> Unmarked<R, F> {
    pub(super) const fn new(stream: R, passes: F) -> Self {
        Self { stream, passes, held: vec![] }
    }

    /// Hands on the first `count` bytes that are held, or as many of them as there is room for.
    fn give(&mut self, count: usize, into: &mut [u8]) -> usize {
        let count = count.min(into.len());
        into[..count].copy_from_slice(&self.held[..count]);
        self.held.drain(..count);
        count
    }
}

impl<R: Read, F: FnMut(Duration)> Read for Unmarked<R, F> {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        loop {
            let plain = self.held.iter().position(|&byte| byte == MARK[0]).unwrap_or(self.held.len());
            if plain > 0 {
                return Ok(self.give(plain, into));
            }
            let known = self.held.len().min(MARK.len());
            if self.held[..known] != MARK[..known] {
                return Ok(self.give(1, into));
            }
            if let Some(digits) = self.held.get(MARK.len()..MARK.len() + DIGITS) {
                let milliseconds = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
                self.held.drain(..MARK.len() + DIGITS);
                (self.passes)(Duration::from_millis(milliseconds.unwrap_or_default()));
                continue;
            }
            let mut part = [0; 1 << 12];
            let count = self.stream.read(&mut part)?;
            if count == 0 {
                return Ok(self.give(self.held.len(), into));
            }
            self.held.extend_from_slice(&part[..count]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stream that gives at most some bytes at once.
    struct Slow<'a>(&'a [u8], usize);

    impl Read for Slow<'_> {
        fn read(&mut self, into: &mut [u8]) -> Result<usize> {
            let limit = self.1.min(into.len());
            self.0.read(&mut into[..limit])
        }
    }

    #[test]
    fn marks_are_taken_out_wherever_they_stand() {
        let bytes = b"one\n\xffpasses:00001500two\xff\xffpa\xffpasses:00000001\n\xffpasses:9999";
        for at_once in 1..bytes.len() {
            let mut passed = vec![];
            let mut text = vec![];
            let mut stream = Unmarked::new(Slow(bytes, at_once), |time: Duration| passed.push(time.as_millis()));
            stream.read_to_end(&mut text).expect("memory can be read");
            assert_eq!(text, b"one\ntwo\xff\xffpa\n\xffpasses:9999", "{at_once} at once");
            assert_eq!(passed, [1500, 1], "{at_once} at once");
        }
    }

    #[test]
    fn time_passes_only_when_it_is_told() {
        let clock = Clock::new(true);
        assert_eq!(clock.now(), Duration::ZERO);
        clock.pass(Duration::from_secs(600));
        assert_eq!(clock.now(), Duration::from_secs(600));
    }
}
