//! Who answers, and what is to be asked: the first line of a renderer.

use super::error::ProcessError;
use super::frame;
use super::words::clipped;
use lightmeter_arithmetic::Profile;
use lightmeter_arithmetic::profile::PROFILES;
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::nearest::did_you_mean;
use lightmeter_document::Unique;
use lightmeter_document::by_case::RendererIdentity;
use lightmeter_document::protocol::PROTOCOL;
use lightmeter_scene::frame::Frame;
use serde::{Deserialize, Serialize};

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
    /// Where the samples of a pixel lie, from its upper left corner, in pixels. One in the middle is all that is judged so far.
    pub samples: Option<Vec<[serde_json::Number; 2]>>,
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

    /// The first field in which another one says something else, with what both say; `None` where they say the same.
    pub(super) fn difference(&self, other: &Self) -> Option<String> {
        let (own, others) = (self.fields(), other.fields());
        let (name, value) = own.iter().find(|&(name, value)| others.get(name) != Some(value))?;
        let told = |value: &serde_json::Value| clipped(&value.to_string());
        let (Some(was), Some(is)) = (value.as_array(), others[name].as_array()) else {
            return Some(format!("`{name}` was {}, and is {}", told(value), told(&others[name])));
        };
        // Of lists what the other has not: they may be long.
        Some(match (was.iter().find(|one| !is.contains(one)), is.iter().find(|one| !was.contains(one))) {
            (Some(one), None) => format!("`{name}` had {}, and no longer has", told(one)),
            (None, Some(one)) => format!("`{name}` has {}, and had it not", told(one)),
            (Some(was), Some(is)) => format!("`{name}` had {}, and has {} now", told(was), told(is)),
            (None, None) => format!("`{name}` has the same in another order, or another number of times"),
        })
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

/// The field that has the protocol.
const GREETING: &str = "hello";
/// The field that has the renderer's name.
const NAME: &str = "renderer";

/// Whether a line is meant to say who answers: an object without an id that has one of the two words, or nearly one beside what only a
/// hello has.
#[must_use]
pub fn is_one(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    let line = line.strip_prefix("\u{feff}".as_bytes()).unwrap_or(line);
    let Ok(said) = serde_json::from_slice::<serde_json::Map<String, serde_json::Value>>(line) else { return false };
    let has = |name: &str| said.get(name).is_some_and(|value| !value.is_null());
    let is_near = || said.keys().any(|name| did_you_mean(name, [GREETING, NAME]) != ".");
    let is_a_hellos = || {
        let known = Hello::default().fields();
        said.iter().any(|(name, value)| known.contains_key(name) || value == PROTOCOL)
    };
    !has("id") && (has(GREETING) || has(NAME) || is_near() && is_a_hellos())
}

/// What an entry of `skips` says.
const SKIPS: &str = "[{\"id\": \"fog/exp\", \"reason\": \"not built\"}]";
/// What an entry of `sources` says.
const SOURCES: &str = "[{\"id\": \"fog/exp\", \"file\": \"src/fog.glsl\", \"line\": 12}]";

/// Reads one, by its text.
///
/// # Errors
/// What is wrong with it, in words.
pub(super) fn read(text: &str) -> Result<Hello, String> {
    let wrong = |error: serde_json::Error| format!("said a hello that cannot be read: {error}");
    // A field that stands twice is refused.
    let Unique(said) = serde_json::from_str(text).map_err(wrong)?;
    let mut said: serde_json::Map<String, serde_json::Value> = serde_json::from_value(said).map_err(wrong)?;
    // A file of answers may leave it out.
    let protocol = said.remove(GREETING).filter(|protocol| !protocol.is_null());
    if let Some(protocol) = protocol.filter(|protocol| protocol != PROTOCOL) {
        let protocol = protocol.as_str().map_or_else(|| protocol.to_string(), str::to_owned);
        return Err(format!("said a hello of `{}`; expected `{PROTOCOL}`", clipped(&protocol)));
    }
    let known = Hello::default().fields();
    for (name, value) in &said {
        if !known.contains_key(name) {
            let names = || std::iter::once(GREETING).chain(known.keys().map(String::as_str));
            let meant = did_you_mean(name, names());
            let meant = if meant == "." {
                format!("; expected one of {}", names().collect::<Vec<_>>().join(", "))
            } else {
                meant
            };
            return Err(format!("said a hello with the unknown field `{}`{meant}", clipped(name)));
        }
        if let Some(why) = is_no_value_of(name, value) {
            return Err(format!("said a hello in which `{name}` {why}"));
        }
    }
    if said.get(NAME).is_none_or(serde_json::Value::is_null) {
        return Err(format!(
            "said a hello without `{NAME}`; expected such as {{\"{GREETING}\": \"{PROTOCOL}\", \"{NAME}\": \"my-renderer\", …}}"
        ));
    }
    let hello: Hello = serde_json::from_value(said.into()).map_err(wrong)?;
    let build = hello.build.as_deref().map(clipped);
    Ok(Hello { renderer: clipped(&hello.renderer), version: clipped(&hello.version), build, ..hello })
}

/// What is wrong with the value of a field, and what would be right; `None` where nothing is that is told better than by its type.
fn is_no_value_of(name: &str, value: &serde_json::Value) -> Option<String> {
    let is_list = matches!(name, "formulas" | "scenes" | "excludes" | "formats" | "effects" | "targets" | "sources");
    if is_list && !value.is_array() && !value.is_null() {
        let example = if name == "sources" { SOURCES } else { "[\"fog/*\", \"lighting/blinn\"]" };
        return Some(format!("is no list; expected such as {example}"));
    }
    let unread = match name {
        "skips" => serde_json::from_value::<Vec<DeclaredSkip>>(value.clone()).err().map(|why| (why, SKIPS)),
        "sources" => serde_json::from_value::<Vec<DeclaredSource>>(value.clone()).err().map(|why| (why, SOURCES)),
        _ => None,
    };
    if let Some((why, example)) = unread {
        return Some(format!("cannot be read: {why}; expected such as {example}"));
    }
    if name == "samples" && !value.is_null() && *value != serde_json::json!([[0.5, 0.5]]) {
        return Some(no_samples(value));
    }
    let example = match name {
        NAME => "my-renderer",
        "version" => "1.2",
        "device" => "llvmpipe (LLVM 15.0.6, 256 bits)",
        "driver" => "Mesa 22.3.6",
        "build" => "3f2a91c",
        _ => return None,
    };
    (!value.is_string()).then(|| format!("is no string; expected such as \"{example}\""))
}

/// What is wrong with places of samples that are not one in the middle of the pixel.
fn no_samples(value: &serde_json::Value) -> String {
    let is_in_a_pixel = |place: &f64| (0.0..1.0).contains(place);
    match serde_json::from_value::<Vec<[f64; 2]>>(value.clone()) {
        Ok(places) if !places.is_empty() && places.iter().flatten().all(is_in_a_pixel) => {
            "places samples elsewhere than in the middle of the pixel; so far one sample there is judged, [[0.5, 0.5]]"
                .into()
        }
        _ => "is no list of places in a pixel, from 0 to below 1; expected such as [[0.5, 0.5]]".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_that_differs_is_told() {
        let hello = |text: &str| read(text).expect("a hello");
        let first = hello(r#"{"renderer":"r","version":"1","formulas":["fog/exp","fog/linear"]}"#);
        for (other, said) in [
            (r#"{"renderer":"r","version":"1","formulas":["fog/exp","fog/linear"]}"#, None),
            (
                r#"{"renderer":"r","version":"2","formulas":["fog/exp","fog/linear"]}"#,
                Some("`version` was \"1\", and is \"2\""),
            ),
            (r#"{"renderer":"r","version":"1","formulas":["fog/exp"]}"#, Some("had \"fog/linear\", and no longer has")),
            (r#"{"renderer":"r","version":"1","formulas":["fog/linear","fog/exp"]}"#, Some("in another order")),
        ] {
            let told = first.difference(&hello(other));
            assert!(
                told.as_deref().map_or(said.is_none(), |told| said.is_some_and(|said| told.contains(said))),
                "{told:?}"
            );
        }
    }

    #[test]
    fn what_only_looks_like_a_hello_is_none() {
        for line in [&br#"{"rendered": 5}"#[..], br#"{"id":"fog/exp","renderer":"r"}"#, b"[1]", b"hello"] {
            assert!(!is_one(line), "{}", String::from_utf8_lossy(line));
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
            (br#"{"renderer":"r","samples":4}"#, "`samples` is no list of places in a pixel"),
            (br#"{"renderer":"r","samples":[[0.5,1.5]]}"#, "from 0 to below 1; expected such as [[0.5, 0.5]]"),
            (br#"{"renderer":"r","samples":[]}"#, "`samples` is no list of places"),
            (
                br#"{"renderer":"r","samples":[[0.375,0.125],[0.875,0.375],[0.125,0.625],[0.625,0.875]]}"#,
                "`samples` places samples elsewhere than in the middle of the pixel; so far one sample there is judged",
            ),
            (br#"{"renderer":"r","exclude":["fog"]}"#, "unknown field `exclude`; did you mean `excludes`?"),
            (
                br#"{"renderer":"r","xyzzy":1}"#,
                "unknown field `xyzzy`; expected one of hello, renderer, version, device",
            ),
            (
                br#"{"hello":"lightmeter.protocol/1","rendrer":"r"}"#,
                "unknown field `rendrer`; did you mean `renderer`?",
            ),
            (br#"{"helo":"lightmeter.protocol/1","name":"r"}"#, "unknown field `helo`; did you mean `hello`?"),
            (br#"{"hello":1,"renderer":"r"}"#, "a hello of `1`; expected `lightmeter.protocol/1`"),
            (
                br#"{"hello":"lightmeter.protocol/1","renderer":"a","renderer":"b"}"#,
                "field `renderer` stands there twice",
            ),
            (br#"{"hello":"lightmeter.protocol/1"}"#, "a hello without `renderer`; expected such as"),
            ("\u{feff}{\"hello\":\"lightmeter.protocol/9\"}".as_bytes(), "expected `lightmeter.protocol/1`"),
            (br#"{"renderer":"r","sources":"a.c"}"#, "`sources` is no list; expected such as [{\"id\""),
            (
                br#"{"renderer":"r","sources":[{"id":"fog"}]}"#,
                "`sources` cannot be read: missing field `file`; expected such as",
            ),
            (
                br#"{"renderer":"r","skips":[{"id":"fog"}]}"#,
                "`skips` cannot be read: missing field `reason`; expected such as",
            ),
            (br#"{"renderer":5}"#, "`renderer` is no string; expected such as \"my-renderer\""),
        ] {
            assert!(is_one(line), "{said}");
            let text = std::str::from_utf8(line).expect("text");
            let error = read(text.trim_start_matches('\u{feff}')).expect_err(said);
            assert!(error.contains(said), "{error}");
        }
    }
}
