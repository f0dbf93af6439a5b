//! A line that a renderer writes.

use super::error::ProcessError;
use super::frame;
use lightmeter_arithmetic::Profile;
use lightmeter_arithmetic::profile::PROFILES;
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::nearest::did_you_mean;
use lightmeter_document::gate::RendererIdentity;
use lightmeter_document::protocol::PROTOCOL;
use lightmeter_scene::frame::Frame;
use serde::de::{Deserializer, Visitor};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::io::BufRead;

/// Bytes of a line, at most.
pub const MOST_BYTES: usize = 1 << 20;

/// Who answers, and what is to be asked.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Hello {
    /// Its name.
    pub renderer: String,
    /// Its version.
    pub version: String,
    /// What it computes on, such as a GPU's name.
    pub device: Option<String>,
    /// The driver of that, with its version.
    pub driver: Option<String>,
    /// What tells its code from other code of the same version, such as a commit or a hash. Shards of one run have the same.
    pub build: Option<String>,
    /// Globs of the formulas that it evaluates.
    pub formulas: Vec<String>,
    /// Globs of the scenes that it draws.
    pub scenes: Vec<String>,
    /// What it does not, though the others name it: globs of formulas and scenes, or such as `function:lighting_spot`, `file:fog.wgsl`,
    /// `shape:mat4`, `effect:lightmap` and `format:rgba32float`.
    pub excludes: Vec<String>,
    /// Formats of targets that it draws on; `None` for all.
    pub formats: Option<Vec<String>>,
    /// Effects that it has; `None` for all. A scene that calls for another is not asked for.
    pub effects: Option<Vec<String>>,
    /// The accuracy rules that it is held to.
    pub profile: Option<String>,
    /// Formats of targets that it blends on, step for step; none where it is asked for blending as arithmetic alone.
    pub targets: Vec<String>,
    /// Cases that it may skip, by globs, each with the reason.
    pub skips: Vec<DeclaredSkip>,
    /// The pack that a file answers, as the pack's manifest has it; answers in columns say so.
    pub pack: Option<String>,
    /// Whether a process is asked in columns: binary batches of a formula.
    pub columns: bool,
    /// Whether the gate describes each formula to the process before its first case: its inputs, its outputs and what computes it.
    pub describe: bool,
    /// Whether it is asked for special values: NaN, infinity, subnormals, signed zero and rounding, an operation at a time.
    pub special: bool,
    /// Where its code of formulas and scenes stands, which annotations point to.
    pub sources: Vec<DeclaredSource>,
}

/// Where a renderer's code of formulas or scenes stands.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a source such as {\"id\": \"fog/exp\", \"file\": \"src/fog.glsl\", \"line\": 12}"
)]
pub struct DeclaredSource {
    /// A glob of formulas or scenes.
    pub id: String,
    /// The file, as it is called from the root of the repository.
    pub file: String,
    /// The line, from 1; `None` for the whole file.
    #[serde(default)]
    pub line: Option<u64>,
}

/// Cases that a renderer may skip.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a skip such as {\"id\": \"fog/exp\", \"reason\": \"not built\"}")]
pub struct DeclaredSkip {
    /// A glob of cases, or of an ancestor of theirs.
    pub id: String,
    /// Why it skips them.
    pub reason: String,
}

impl Hello {
    /// Of answers that do not say what they are to: everything is asked.
    #[must_use]
    pub fn everything() -> Self {
        Self { renderer: "unnamed".into(), formulas: vec!["**".into()], scenes: vec!["**".into()], ..Self::default() }
    }

    /// How reports name it.
    #[must_use]
    pub fn identity(&self) -> RendererIdentity {
        let told = |text: &Option<String>| text.as_ref().map(|text| clipped(text));
        RendererIdentity {
            name: clipped(&self.renderer),
            version: clipped(&self.version),
            device: told(&self.device),
            driver: told(&self.driver),
        }
    }

    /// What it declares besides its name and version, as reports have it: the fields that say something, but for where its code stands.
    #[must_use]
    pub fn declares(&self) -> serde_json::Map<String, serde_json::Value> {
        let says_nothing = |value: &serde_json::Value| {
            value.is_null() || value == &serde_json::json!([]) || value == &serde_json::json!(false)
        };
        let mut fields = self.fields();
        fields.retain(|name, value| {
            !says_nothing(value) && !["renderer", "version", "device", "driver", "sources"].contains(&name.as_str())
        });
        fields
    }

    /// All fields, by their names.
    fn fields(&self) -> serde_json::Map<String, serde_json::Value> {
        match serde_json::to_value(self) {
            Ok(serde_json::Value::Object(fields)) => fields,
            _ => unreachable!("a hello is an object of strings, lists and truth values"),
        }
    }

    /// The accuracy rules that it is judged by: those that it is held to, or those that it asks for.
    ///
    /// # Errors
    /// Where it asks for rules that nobody knows.
    pub fn profile(&self, held_to: Option<&'static Profile>) -> Result<&'static Profile, ProcessError> {
        match (held_to, &self.profile) {
            (Some(profile), _) => Ok(profile),
            (None, Some(name)) => Profile::by_name(name).ok_or_else(|| ProcessError::Profile(clipped(name))),
            (None, None) => Ok(PROFILES[0]),
        }
    }

    /// What it says of itself, read as filters.
    ///
    /// # Errors
    /// Where a glob cannot be read.
    pub fn filters(&self) -> Result<[Option<Filter>; 2], lightmeter_catalogue::filter::FilterError> {
        // No glob matches everything in a filter, and nothing in a declaration.
        let read = |globs: &[String]| (!globs.is_empty()).then(|| Filter::new(globs)).transpose();
        Ok([read(&self.formulas)?, read(&self.scenes)?])
    }

    /// Why it does not draw a frame; `None` where it does.
    #[must_use]
    pub fn lacks(&self, frame: &Frame) -> Option<String> {
        let format = frame.target.format.name();
        if self.formats.as_ref().is_some_and(|formats| !formats.iter().any(|own| own == format)) {
            return Some(format!("it does not draw on {format}"));
        }
        let has = self.effects.as_ref()?;
        let missing: Vec<&str> =
            frame::called(frame).into_iter().filter(|name| !has.iter().any(|own| own == name)).collect();
        (!missing.is_empty()).then(|| format!("it has no {}", missing.join(", ")))
    }
}

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
            if is_hello(line) {
                return hello(text);
            }
            if BARE.iter().any(|(word, _)| text.contains(word)) {
                let words = with_strings(text);
                if let Ok(raw) = serde_json::from_str::<Raw<'_>>(&words) {
                    return told(raw).map(Line::into_owned).map_err(quoted);
                }
            }
            let begins_as_one = text.trim_start().starts_with('{');
            let what = if begins_as_one { error.to_string() } else { "it is no JSON object".into() };
            Err(quoted(format!("{what}; expected {EXPECTED}")))
        }
    }
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

/// Whether a line is meant to say who answers: it has the words, and no id.
#[must_use]
pub fn is_hello(line: &[u8]) -> bool {
    serde_json::from_slice::<serde_json::Value>(line.trim_ascii())
        .is_ok_and(|value| value["id"].is_null() && (!value["hello"].is_null() || !value["renderer"].is_null()))
}

/// What an entry of `skips` says.
const SKIPS: &str = "[{\"id\": \"fog/exp\", \"reason\": \"not built\"}]";
/// What an entry of `sources` says.
const SOURCES: &str = "[{\"id\": \"fog/exp\", \"file\": \"src/fog.glsl\", \"line\": 12}]";

fn hello(text: &str) -> Result<Line<'_>, String> {
    #[derive(Deserialize)]
    struct Greeting {
        /// The protocol; a file of answers may leave it out.
        hello: Option<String>,
        renderer: String,
        #[serde(flatten)]
        rest: serde_json::Map<String, serde_json::Value>,
    }
    let wrong = |error: serde_json::Error| format!("said a hello that cannot be read: {error}");
    let Greeting { hello, renderer, rest } = serde_json::from_str(text).map_err(wrong)?;
    if let Some(protocol) = hello.filter(|protocol| protocol != PROTOCOL) {
        return Err(format!("said a hello of `{}`; expected `{PROTOCOL}`", clipped(&protocol)));
    }
    let known = Hello::default().fields();
    for (name, value) in &rest {
        if !known.contains_key(name) {
            let meant = did_you_mean(name, known.keys().map(String::as_str));
            let meant = if meant == "." { format!("; expected one of {}", listed(&known)) } else { meant };
            return Err(format!("said a hello with the unknown field `{}`{meant}", clipped(name)));
        }
        let is_list =
            matches!(name.as_str(), "formulas" | "scenes" | "excludes" | "formats" | "effects" | "targets" | "sources");
        if is_list && !value.is_array() && !value.is_null() {
            let example = if name == "sources" { SOURCES } else { "[\"fog/*\", \"lighting/blinn\"]" };
            return Err(format!("said a hello in which `{name}` is no list; expected such as {example}"));
        }
        let unread = match name.as_str() {
            "skips" => serde_json::from_value::<Vec<DeclaredSkip>>(value.clone()).err().map(|why| (why, SKIPS)),
            "sources" => serde_json::from_value::<Vec<DeclaredSource>>(value.clone()).err().map(|why| (why, SOURCES)),
            _ => None,
        };
        if let Some((why, example)) = unread {
            return Err(format!("said a hello in which `{name}` cannot be read: {why}; expected such as {example}"));
        }
        let example = match name.as_str() {
            "version" => "1.2",
            "device" => "llvmpipe (LLVM 15.0.6, 256 bits)",
            "driver" => "Mesa 22.3.6",
            "build" => "3f2a91c",
            _ => continue,
        };
        if !value.is_string() {
            return Err(format!("said a hello in which `{name}` is no string; expected such as \"{example}\""));
        }
    }
    let hello: Hello = serde_json::from_value(rest.into()).map_err(wrong)?;
    let build = hello.build.as_deref().map(clipped);
    Ok(Line::Hello(Box::new(Hello { renderer: clipped(&renderer), version: clipped(&hello.version), build, ..hello })))
}

/// The names of fields, in a row.
fn listed(fields: &serde_json::Map<String, serde_json::Value>) -> String {
    fields.keys().map(String::as_str).collect::<Vec<_>>().join(", ")
}

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

/// Characters of a renderer's words that are told.
const MOST_TOLD: usize = 300;

/// Characters of a line that is no answer.
const MOST_QUOTED: usize = 60;

/// A renderer's words, as far as they are told: fit to be shown, and not without end.
#[must_use]
pub fn clipped(words: &str) -> String {
    clipped_to(words, MOST_TOLD)
}

fn clipped_to(words: &str, most: usize) -> String {
    let cut: String = words.trim().chars().take(most).collect();
    let mut told = lightmeter_files::shown(&cut).into_owned();
    if words.trim().chars().nth(most).is_some() {
        told.push('…');
    }
    told
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
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read_and_what_is_wrong_is_said() {
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
    fn what_is_wrong_with_a_hello_is_said() {
        for (line, said) in [
            (&br#"{"hello":"lightmeter.protocol/9","renderer":"r"}"#[..], "expected `lightmeter.protocol/1`"),
            (br#"{"renderer":"r","formulas":"fog"}"#, "`formulas` is no list"),
            (br#"{"renderer":"r","version":1.2}"#, "`version` is no string"),
            (br#"{"renderer":"r","driver":["Mesa"]}"#, "`driver` is no string; expected such as \"Mesa 22.3.6\""),
            (br#"{"renderer":"r","build":17}"#, "`build` is no string; expected such as \"3f2a91c\""),
            (br#"{"renderer":"r","excludes":"fog"}"#, "`excludes` is no list"),
            (br#"{"renderer":"r","special":"yes"}"#, "expected a boolean"),
            (br#"{"renderer":"r","exclude":["fog"]}"#, "unknown field `exclude`; did you mean `excludes`?"),
            (br#"{"renderer":"r","xyzzy":1}"#, "unknown field `xyzzy`; expected one of renderer, version, device"),
            (br#"{"renderer":"r","sources":"a.c"}"#, "`sources` is no list; expected such as [{\"id\""),
            (
                br#"{"renderer":"r","sources":[{"id":"fog"}]}"#,
                "`sources` cannot be read: missing field `file`; expected such as",
            ),
            (
                br#"{"renderer":"r","skips":[{"id":"fog"}]}"#,
                "`skips` cannot be read: missing field `reason`; expected such as",
            ),
            (br#"{"renderer":5}"#, "said a hello that cannot be read: invalid type: integer `5`, expected a string"),
        ] {
            let error = read(line).expect_err(said);
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn words_are_told_without_end_and_control() {
        assert_eq!(clipped(" a\u{1b}[2Jb\nc "), r"a\u{1b}[2Jb\u{a}c");
        let long = clipped(&"x".repeat(1 << 20));
        assert!(long.chars().count() == MOST_TOLD + 1 && long.ends_with('…'));
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
