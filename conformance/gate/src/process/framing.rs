//! Arrays among lines: how many bytes stand behind a line that answers in columns, and how many of them have come.
//!
//! Nothing in an array marks its end. So an answer whose line announces another number of bytes than the batch has is not read on: what
//! is a line behind it and what is not can no longer be told.

use super::super::words::{MOST_QUOTED, clipped_to};
use lightmeter_document::protocol::ColumnsAnswer;
use std::io::{ErrorKind, Read};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Bytes of an answer to no batch that waits, at most.
const MOST_ARRAY: usize = 64 << 20;
/// Bytes of a line that are kept while its end has not come: some more than are quoted.
const MOST_NOTED: usize = 4 * MOST_QUOTED + 4;
/// What every line has that answers in columns.
const WORD: &[u8] = b"\"columns\"";

/// The batch that waits for an answer in columns.
#[derive(Clone, Copy)]
struct Awaited {
    batch: u64,
    /// Numbers of its answer.
    numbers: usize,
}

/// Which arrays may stand behind a line, shared between who asks and who hears.
#[derive(Default)]
pub(super) struct Framing {
    has_columns: AtomicBool,
    awaited: Mutex<Option<Awaited>>,
    /// Bytes that the array under way was announced to have; 0 where none is.
    announced: AtomicUsize,
    /// Bytes of it that have come.
    came: AtomicUsize,
    /// The beginning of a line whose end has not come, and how many bytes of it have.
    open_line: Mutex<(Vec<u8>, usize)>,
}

impl Framing {
    /// Says whether arrays may stand behind lines from now on.
    pub(super) fn has_columns(&self, has_columns: bool) {
        self.has_columns.store(has_columns, Ordering::Release);
    }

    /// Says which batch waits, and how many numbers its answer has.
    pub(super) fn awaits(&self, batch: u64, numbers: usize) {
        *self.awaited.lock().unwrap_or_else(PoisonError::into_inner) = Some(Awaited { batch, numbers });
    }

    /// Bytes behind the line of an answer; `None` where there are none, or another number of them than there has to be.
    pub(super) fn length(&self, answer: &ColumnsAnswer) -> Option<usize> {
        let is_array = answer.skip.is_none() && answer.error.is_none() && !answer.lines;
        let count = answer.bytes.filter(|_| is_array && self.has_columns.load(Ordering::Acquire))?;
        let awaited = *self.awaited.lock().unwrap_or_else(PoisonError::into_inner);
        let is_right = match awaited.filter(|awaited| awaited.batch == answer.batch) {
            Some(awaited) => width(answer.dtype.as_deref()).is_some_and(|width| count == awaited.numbers * width),
            // It is none of this batch's, and is read so that what stands behind it can be.
            None => count <= MOST_ARRAY,
        };
        is_right.then_some(count)
    }

    /// Reads an array; `None` where the stream ends within it.
    pub(super) fn array(&self, stream: &mut impl Read, count: usize) -> Option<Vec<u8>> {
        self.came.store(0, Ordering::Release);
        self.announced.store(count, Ordering::Release);
        let (mut bytes, mut came) = (vec![0; count], 0);
        while came < count {
            match stream.read(&mut bytes[came..]) {
                Ok(0) => return None,
                Ok(read) => came += read,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return None,
            }
            self.came.store(came, Ordering::Release);
        }
        self.announced.store(0, Ordering::Release);
        Some(bytes)
    }

    /// Notes the beginning of a line whose end has not come, and how many bytes of it have; nothing once the end has.
    pub(super) fn has_come(&self, line: &[u8], bytes: usize) {
        let mut open = self.open_line.lock().unwrap_or_else(PoisonError::into_inner);
        open.0.clear();
        open.0.extend_from_slice(&line[..line.len().min(MOST_NOTED)]);
        open.1 = bytes;
    }

    /// The line whose end has not come, in words; nothing where there is none.
    pub(super) fn open_line(&self) -> Option<String> {
        let open = self.open_line.lock().unwrap_or_else(PoisonError::into_inner);
        let (line, bytes) = (clipped_to(&String::from_utf8_lossy(&open.0), MOST_QUOTED), open.1);
        (bytes > 0).then(|| {
            format!("{bytes} bytes without a newline behind them came, `{line}`; expected one behind each line")
        })
    }

    /// What it wrote of an array or a line whose end has not come, in words.
    pub(super) fn cut_short(&self) -> Option<String> {
        self.array_cut_short().or_else(|| self.open_line())
    }

    /// What it wrote of an array that it was waited for in vain, in words: one that ends too soon, or one whose line lacks its newline.
    pub(super) fn array_cut_short(&self) -> Option<String> {
        self.array_under_way().or_else(|| {
            let open = self.open_line.lock().unwrap_or_else(PoisonError::into_inner);
            let noted = open.0.len();
            behind_answer(&open.0).map(|behind| {
                let bytes = behind + open.1 - noted;
                format!(
                    "{bytes} bytes came behind the line of an answer in columns, and no newline between; expected one"
                )
            })
        })
    }

    /// Of the array under way how many bytes were announced and how many came, in words; nothing where none is.
    fn array_under_way(&self) -> Option<String> {
        let announced = self.announced.load(Ordering::Acquire);
        let came = self.came.load(Ordering::Acquire);
        (announced > 0).then(|| format!("it announced {announced} bytes in columns, and {came} of them came"))
    }
}

/// Bytes of a number by its type; `None` of a type that is no answer's.
pub(super) fn width(dtype: Option<&str>) -> Option<usize> {
    match dtype.unwrap_or("<f4") {
        "<f4" => Some(4),
        "<f8" => Some(8),
        _ => None,
    }
}

/// The answer in columns that a line is; `None` of any other line.
pub(super) fn columns_of(line: &[u8]) -> Option<ColumnsAnswer> {
    word(line)?;
    serde_json::from_slice::<ColumnsAnswer>(line).ok().filter(|answer| !answer.columns.is_empty())
}

/// Bytes before the answer in columns in a line; `None` where it has none.
pub(super) fn before(line: &[u8]) -> Option<usize> {
    let word = word(line)?;
    line[..word].iter().rposition(|&byte| byte == b'{')
}

/// Bytes behind the answer in columns that a line begins with; `None` where it begins otherwise, or ends there.
pub(super) fn behind_answer(line: &[u8]) -> Option<usize> {
    let mut answers = serde_json::Deserializer::from_slice(line).into_iter::<ColumnsAnswer>();
    answers.next()?.ok().filter(|answer| !answer.columns.is_empty())?;
    Some(line.len() - answers.byte_offset()).filter(|&bytes| bytes > 0)
}

/// Where the word of an answer in columns stands in a line.
fn word(line: &[u8]) -> Option<usize> {
    line.windows(WORD.len()).position(|part| part == WORD)
}
