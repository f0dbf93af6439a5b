//! A line that a renderer writes.

use super::hello::{self, Hello};
use super::words::{MOST_QUOTED, clipped_to};
use serde::Deserialize;
use serde::de::{Deserializer, Visitor};
use std::borrow::Cow;
use std::fmt;
use std::io::BufRead;

/// Bytes of a line, at most.
pub const MOST_BYTES: usize = 1 << 20;

/// What a line says.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Line<'a> {
    /// Who answers.
    Hello(Box<Hello>),
    /// A case's outputs.
    Value(Cow<'a, str>, Vec<f64>),
    /// The bits of a special value, as they are written.
    Hex(Cow<'a, str>, Cow<'a, str>),
    /// A scene's image, by the name of its file.
    Image(Cow<'a, str>, Cow<'a, str>),
    /// The renderer does not do this, and why.
    Skip(Cow<'a, str>, Cow<'a, str>),
    /// The renderer does not do these rows of a formula's columns, and why: said in a file of answers.
    SkipRows(Cow<'a, str>, Vec<usize>, Cow<'a, str>),
    /// The renderer could not do this, and why.
    Error(Cow<'a, str>, Cow<'a, str>),
}

impl Line<'_> {
    /// The id of the case that it answers; `None` of a hello.
    #[must_use]
    pub fn id(&self) -> Option<&str> {
        match self {
            Self::Hello(_) => None,
            Self::SkipRows(id, ..)
            | Self::Value(id, _)
            | Self::Hex(id, _)
            | Self::Image(id, _)
            | Self::Skip(id, _)
            | Self::Error(id, _) => Some(id),
        }
    }
}

/// What else a line has is the renderer's own.
#[derive(Deserialize)]
struct Raw<'a> {
    #[serde(borrow)]
    id: Cow<'a, str>,
    value: Option<Values>,
    #[serde(borrow)]
    hex: Option<Cow<'a, str>>,
    #[serde(borrow)]
    image: Option<Cow<'a, str>>,
    #[serde(borrow)]
    skip: Option<Cow<'a, str>>,
    /// Beside a skip alone: the rows of columns that it is of.
    rows: Option<serde_json::Value>,
    #[serde(borrow)]
    error: Option<Cow<'a, str>>,
}

/// Numbers, or one.
struct Values(Vec<f64>);

/// A number, or the word of one that JSON has not. An integer is exact, or the nearest f32 where f64 does not have it.
struct Float(f64);

impl<'de> Deserialize<'de> for Float {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// All integers up to this are numbers of f64.
        const EXACT: u64 = 1 << 53;
        struct Read;
        impl Visitor<'_> for Read {
            type Value = f64;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, \"NaN\", \"Inf\" or \"-Inf\"")
            }
            fn visit_f64<E>(self, x: f64) -> Result<f64, E> {
                Ok(x)
            }
            #[expect(clippy::cast_precision_loss, reason = "the nearest f32 is what is asked for")]
            fn visit_i64<E>(self, x: i64) -> Result<f64, E> {
                Ok(if x.unsigned_abs() <= EXACT { x as f64 } else { f64::from(x as f32) })
            }
            #[expect(clippy::cast_precision_loss, reason = "the nearest f32 is what is asked for")]
            fn visit_u64<E>(self, x: u64) -> Result<f64, E> {
                Ok(if x <= EXACT { x as f64 } else { f64::from(x as f32) })
            }
            // What JavaScript writes for NaN.
            fn visit_unit<E>(self) -> Result<f64, E> {
                Ok(f64::NAN)
            }
            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<f64, E> {
                match text {
                    "NaN" => Ok(f64::NAN),
                    "Inf" => Ok(f64::INFINITY),
                    "-Inf" => Ok(f64::NEG_INFINITY),
                    _ => Err(E::invalid_value(serde::de::Unexpected::Str(text), &self)),
                }
            }
        }
        deserializer.deserialize_any(Read).map(Self)
    }
}

impl<'de> Deserialize<'de> for Values {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers = Vec::<Float>::deserialize(deserializer)?;
        Ok(Self(numbers.into_iter().map(|Float(x)| x).collect()))
    }
}

/// Reads a line. What Python writes for a number that JSON has not, bare `NaN` and `Infinity`, is understood.
///
/// # Errors
/// What is wrong with it, in words.
pub fn read(line: &[u8]) -> Result<Line<'_>, String> {
    let quoted = |what: String| format!("`{}`: {what}", clipped_to(&String::from_utf8_lossy(line), MOST_QUOTED));
    let text = std::str::from_utf8(line).map_err(|_| quoted("it is not UTF-8".into()))?;
    // A mark of the byte order, which some editors put first.
    let text = text.trim_start_matches('\u{feff}');
    match serde_json::from_str::<Raw<'_>>(text) {
        Ok(raw) => told(raw).map_err(quoted),
        Err(error) => {
            if hello::is_one(line) {
                return hello::read(text).map(|hello| Line::Hello(Box::new(hello)));
            }
            if BARE.iter().any(|(word, _)| text.contains(word)) {
                let words = with_strings(text);
                if let Ok(raw) = serde_json::from_str::<Raw<'_>>(&words) {
                    return told(raw).map(Line::into_owned).map_err(quoted);
                }
            }
            let begins_as_one = text.trim_start().starts_with('{');
            let what = match behind(text) {
                _ if !begins_as_one => "it is no JSON object".into(),
                Some(rest) if rest.starts_with('{') => {
                    "another answer stands behind it; expected each on a line of its own".into()
                }
                _ => error.to_string(),
            };
            Err(quoted(format!("{what}; expected {EXPECTED}")))
        }
    }
}

/// What stands behind a first object of JSON; `None` where there is none.
fn behind(text: &str) -> Option<&str> {
    let mut values = serde_json::Deserializer::from_str(text).into_iter::<serde::de::IgnoredAny>();
    values.next()?.ok()?;
    text.get(values.byte_offset()..).map(str::trim_start)
}

/// What Python, and C's printf, write for numbers that JSON has not; longer ones first.
const BARE: [(&str, &str); 8] = [
    ("-Infinity", "\"-Inf\""),
    ("Infinity", "\"Inf\""),
    ("NaN", "\"NaN\""),
    ("-nan(ind)", "\"NaN\""),
    ("-nan", "\"NaN\""),
    ("nan", "\"NaN\""),
    ("-inf", "\"-Inf\""),
    ("inf", "\"Inf\""),
];

/// Bare words for numbers that JSON has not, as strings.
fn with_strings(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 16);
    let mut is_string = false;
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if let Some((word, string)) = BARE.into_iter().find(|(word, _)| !is_string && rest.starts_with(word)) {
            out.push_str(string);
            rest = &rest[word.len()..];
            continue;
        }
        is_string ^= c == '"';
        out.push(c);
        rest = &rest[c.len_utf8()..];
    }
    out
}

fn told(raw: Raw<'_>) -> Result<Line<'_>, String> {
    let id = raw.id;
    match (raw.value, raw.hex, raw.image, raw.skip, raw.error) {
        (Some(Values(values)), None, None, None, None) => Ok(Line::Value(id, values)),
        (None, Some(digits), None, None, None) => Ok(Line::Hex(id, digits)),
        (None, None, Some(file), None, None) => Ok(Line::Image(id, file)),
        (None, None, None, Some(reason), None) => match raw.rows {
            None => Ok(Line::Skip(id, reason)),
            Some(rows) => serde_json::from_value(rows)
                .map(|rows| Line::SkipRows(id, rows, reason))
                .map_err(|error| format!("its `rows`: {error}; expected such as [0, 17]")),
        },
        (None, None, None, None, Some(reason)) => Ok(Line::Error(id, reason)),
        _ => Err(format!(
            "it has none, or more than one, of `value`, `hex`, `image`, `skip` and `error`; expected {EXPECTED}"
        )),
    }
}

impl Line<'_> {
    fn into_owned(self) -> Line<'static> {
        let own = |text: Cow<'_, str>| Cow::Owned(text.into_owned());
        match self {
            Self::Hello(hello) => Line::Hello(hello),
            Self::Value(id, values) => Line::Value(own(id), values),
            Self::Hex(id, digits) => Line::Hex(own(id), own(digits)),
            Self::Image(id, file) => Line::Image(own(id), own(file)),
            Self::Skip(id, reason) => Line::Skip(own(id), own(reason)),
            Self::SkipRows(id, rows, reason) => Line::SkipRows(own(id), rows, own(reason)),
            Self::Error(id, reason) => Line::Error(own(id), own(reason)),
        }
    }
}

const EXPECTED: &str = "an answer such as {\"id\": \"fog/exp/random/000017\", \"value\": [0.5, 1, 2, 3]}";

/// The id of an answer, whatever else is wrong with it: where it is no JSON, the string behind the first `"id":`.
#[must_use]
pub fn id(line: &[u8]) -> Option<Cow<'_, str>> {
    #[derive(Deserialize)]
    struct Id<'a> {
        #[serde(borrow)]
        id: Cow<'a, str>,
    }
    let text = std::str::from_utf8(line).ok()?.trim_start_matches('\u{feff}');
    if let Ok(Id { id }) = serde_json::from_str(text) {
        return Some(id);
    }
    let (_, rest) = text.split_once("\"id\"")?;
    let rest = rest.trim_start().strip_prefix(':')?.trim_start().strip_prefix('"')?;
    // Some writers escape a slash, of which ids have some, and nothing else in them is to be escaped.
    rest.split_once('"').map(|(id, _)| Cow::Owned(id.replace("\\/", "/")))
}

/// Why a line cannot be had.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Unread {
    /// It is longer than any answer is.
    #[error("a line of more than {} bytes", MOST_BYTES)]
    TooLong,
    /// The stream failed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// Bytes of a line that is too long that are looked through for its end.
const MOST_SKIPPED: usize = 16 << 20;

/// The next line without its end, in a buffer that never grows beyond [`MOST_BYTES`]; what is too long is read to its end and
/// dropped. `false` at the end of the stream.
///
/// # Errors
/// Where the line is too long, or the stream fails.
pub fn next(stream: &mut impl BufRead, line: &mut Vec<u8>) -> Result<bool, Unread> {
    next_told(stream, line, |_, _| {})
}

/// The same, which tells what is kept of the line and how many bytes of it have come before more of it is waited for.
///
/// # Errors
/// Where the line is too long, or the stream fails.
pub(super) fn next_told(
    stream: &mut impl BufRead,
    line: &mut Vec<u8>,
    mut waits: impl FnMut(&[u8], usize),
) -> Result<bool, Unread> {
    line.clear();
    let (mut dropped, mut skipped) = (false, 0);
    loop {
        let available = match stream.fill_buf() {
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
            available => available?,
        };
        if available.is_empty() {
            if dropped {
                return Err(Unread::TooLong);
            }
            return Ok(!line.is_empty());
        }
        let end = available.iter().position(|&byte| byte == b'\n');
        let part = &available[..end.unwrap_or(available.len())];
        if !dropped && line.len() + part.len() <= MOST_BYTES {
            line.extend_from_slice(part);
        } else {
            dropped = true;
            skipped += part.len();
        }
        let used = part.len() + usize::from(end.is_some());
        stream.consume(used);
        // What has no end at all is told before it ends.
        if end.is_some() || skipped > MOST_SKIPPED {
            if dropped {
                return Err(Unread::TooLong);
            }
            if line.last() == Some(&b'\r') {
                line.pop();
            }
            return Ok(true);
        }
        waits(line, line.len() + skipped);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read() {
        let value = |numbers: &[f64]| Line::Value("a".into(), numbers.to_vec());
        assert_eq!(read(br#"{"id":"a","value":[1,-2.5,1e-3]}"#), Ok(value(&[1.0, -2.5, 1e-3])));
        assert_eq!(
            read(br#"{"id":"a","value":["Inf","-Inf",1e39]}"#),
            Ok(value(&[f64::INFINITY, f64::NEG_INFINITY, 1e39]))
        );
        // Words are exact, and what is no word is the nearest f32.
        assert_eq!(
            read(br#"{"id":"a","value":[4294967295,-2147483648,4611686018427387905]}"#),
            Ok(value(&[4_294_967_295.0, -2_147_483_648.0, 4_611_686_018_427_387_904.0]))
        );
        assert_eq!(read(br#"{"id":"a","hex":"0x7fc00000"}"#), Ok(Line::Hex("a".into(), "0x7fc00000".into())));
        assert_eq!(read(br#"{"id":"s","image":"s.png"}"#), Ok(Line::Image("s".into(), "s.png".into())));
        assert_eq!(read(br#"{"id":"s","skip":"no fog"}"#), Ok(Line::Skip("s".into(), "no fog".into())));
        let skipped = Line::SkipRows("fog/exp".into(), vec![0, 17], "no fog".into());
        assert_eq!(read(br#"{"id":"fog/exp","skip":"no fog","rows":[0,17]}"#), Ok(skipped));
        let hello = read(br#"{"hello":"lightmeter.protocol/1","renderer":"r","version":"2","formulas":["fog"]}"#);
        let Ok(Line::Hello(hello)) = hello else { panic!("{hello:?}") };
        assert_eq!((hello.renderer.as_str(), hello.formulas.as_slice()), ("r", ["fog".to_owned()].as_slice()));
        for bare in [
            &br#"{"id":"NaN","value":[NaN,-Infinity,Infinity]}"#[..],
            br#"{"id": "NaN", "value": ["NaN","-Inf","Inf"]}"#,
        ] {
            let Ok(Line::Value(id, values)) = read(bare) else { panic!("bare words are read") };
            assert!(id == "NaN" && values[0].is_nan() && values[1..] == [f64::NEG_INFINITY, f64::INFINITY]);
            assert_eq!(super::id(bare).as_deref(), Some("NaN"));
        }
        assert_eq!(read("\u{feff}{\"id\":\"a\",\"value\":[1]}".as_bytes()), Ok(value(&[1.0])));
        for bare in
            [&br#"{"id":"a","value":[nan,-nan,inf,-inf]}"#[..], br#"{"id":"a","value":[null,null,"Inf","-Inf"]}"#]
        {
            let Ok(Line::Value(_, values)) = read(bare) else { panic!("bare words are read") };
            assert!(values[0].is_nan() && values[1].is_nan() && values[2..] == [f64::INFINITY, f64::NEG_INFINITY]);
        }
        for (line, id) in [
            (&br#"{"id":"fog\/exp","value":[1]}"#[..], "fog/exp"),
            (br#"{"id":"fog\/exp","value":[nan]}"#, "fog/exp"),
            (br#"{"meta":{"id":5},"id":"fog/exp","value":[1]}"#, "fog/exp"),
        ] {
            assert_eq!(super::id(line).as_deref(), Some(id));
            assert!(matches!(read(line), Ok(Line::Value(read, _)) if read == id));
        }
        assert_eq!(super::id(br#"{"id":"a","value":[1,2"#).as_deref(), Some("a"));
    }

    #[test]
    fn what_is_wrong_with_a_line_is_said() {
        for (line, said) in [
            (&br#"{"id":"a","value":[1,2"#[..], "`{\"id\":\"a\",\"value\":[1,2`: EOF"),
            (br#"{"id":"a","value":["nan"]}"#, "expected"),
            (br#"{"id":"a"}"#, "`{\"id\":\"a\"}`: it has none, or more than one"),
            (br#"{"id":"a","value":[1],"skip":"x"}"#, "none, or more than one"),
            (br#"{"id":"a","value":[1],"hex":"0x1"}"#, "none, or more than one"),
            (br#"{"id":"a","values":[1]}"#, "none, or more than one"),
            (br#"{"id":"fog/exp","skip":"no fog","rows":[-1]}"#, "its `rows`"),
            (br#"[1]"#, "expected an answer"),
            (
                br#"{"id":"a","value":[1]}{"id":"b","value":[1]}"#,
                "another answer stands behind it; expected each on a line",
            ),
            (br#"{"id":"a","value":[1]} x"#, "trailing characters"),
            (
                br#"{"id":"a","value":[NaN],"skip":"x"}"#,
                "`{\"id\":\"a\",\"value\":[NaN],\"skip\":\"x\"}`: it has none, or",
            ),
            (b"\xff", "UTF-8"),
        ] {
            let error = read(line).expect_err(said);
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn a_line_that_never_ends_takes_no_memory_and_the_rest_is_read() {
        let long = vec![b'x'; 3 * MOST_BYTES];
        let mut stream = std::io::BufReader::new(std::io::Read::chain(
            std::io::Read::chain(&b"one\r\n"[..], long.as_slice()),
            &b"\ntwo"[..],
        ));
        let mut line = vec![];
        assert!(matches!(next(&mut stream, &mut line), Ok(true)) && line == b"one");
        assert!(matches!(next(&mut stream, &mut line), Err(Unread::TooLong)) && line.capacity() <= 2 * MOST_BYTES);
        assert!(matches!(next(&mut stream, &mut line), Ok(true)) && line == b"two");
        assert!(matches!(next(&mut stream, &mut line), Ok(false)));
    }
}
