//! Known failures, written down with their reason: they do not fail a gate, and it says so when they pass.

use super::given::{is_everything, refused};
use lightmeter_catalogue::cases::Stage;
use lightmeter_catalogue::filter::Filter;
use lightmeter_document::by_case::KnownFailure;
use lightmeter_faults::KnownMistakes;
use lightmeter_files::read::MOST_TEXT;
use lightmeter_judge::cases::ExpectedFailure;
use lightmeter_judge::diagnose::Made;
use lightmeter_scene::target::TargetFormat;
use semver::{Version, VersionReq};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A known failure, as the file has it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    /// A glob of cases, or of an ancestor of theirs.
    id: String,
    /// Why they fail.
    reason: String,
    /// The renderer's name; any without it.
    renderer: Option<String>,
    /// The renderer's versions, as `>=0.150, <0.170`; any without it.
    version: Option<String>,
    /// The stage, or the target of a blend state or an image, that they fail on; any without it.
    on: Option<String>,
    /// The mistakes that make them fail, by name: nothing else is excused. Whatever makes them fail without it.
    #[serde(default, deserialize_with = "one_or_several")]
    mistake: Vec<String>,
    /// Whether the renderer ends or hangs at them: such a run is no broken one.
    #[serde(default)]
    crash: bool,
    /// Whether they may pass: what fails on some machines, or in some cases of many.
    #[serde(default)]
    may_pass: bool,
}

/// A name, or a list of names.
fn one_or_several<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<String>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a mistake such as \"fog-radial\", or a list of mistakes")]
    enum Names {
        One(String),
        Several(Vec<String>),
    }
    match Names::deserialize(deserializer)? {
        Names::One(name) => Ok(vec![name]),
        Names::Several(names) if names.is_empty() => Err(D::Error::custom("`mistake` is an empty list")),
        Names::Several(names) => Ok(names),
    }
}

/// Cases that a renderer is known to skip, as the file has them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenSkip {
    /// A glob of cases, or of an ancestor of theirs.
    id: String,
    /// Why it skips them.
    reason: String,
    /// The renderer's name; any without it.
    renderer: Option<String>,
    /// The renderer's versions, as `>=0.150, <0.170`; any without it.
    version: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    expected: Vec<Written>,
    #[serde(default)]
    skipped: Vec<WrittenSkip>,
}

/// Why a file of expectations is refused.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", .path.display())]
pub struct ExpectationError {
    path: PathBuf,
    message: String,
}

/// A file of known failures and skips.
#[derive(Clone, Debug, Default)]
pub struct Expectations {
    written: Vec<ReadFailure>,
    skipped: Vec<(WrittenSkip, Filter, Option<VersionReq>)>,
}

/// A known failure, read.
#[derive(Clone, Debug)]
struct ReadFailure {
    written: Written,
    filter: Filter,
    versions: Option<VersionReq>,
    made: Option<Arc<KnownMistakes>>,
}

impl ReadFailure {
    /// Whether it is of a renderer.
    fn concerns(&self, renderer: &str, version: Option<&Version>) -> bool {
        is_of((self.written.renderer.as_ref(), self.versions.as_ref()), renderer, version)
    }
}

/// The versions that are meant.
fn versions(text: Option<&str>, place: &str) -> Result<Option<VersionReq>, String> {
    let read = |text| {
        let expected = "expected such as \">=1.2, <2\"";
        VersionReq::parse(text).map_err(|error| format!("{place}.version `{text}`: {error}; {expected}"))
    };
    text.map(read).transpose()
}

/// Whether something is of a renderer.
fn is_of(written: (Option<&String>, Option<&VersionReq>), renderer: &str, version: Option<&Version>) -> bool {
    let (name, range) = written;
    let is_version = range.is_none_or(|range| version.is_some_and(|own| range.matches(own)));
    name.is_none_or(|name| name == renderer) && is_version
}

impl Expectations {
    /// Reads a file.
    ///
    /// # Errors
    /// Where it cannot be read, or says what nothing can be made of.
    pub fn read(path: &Path) -> Result<Self, ExpectationError> {
        let refused = |message: String| ExpectationError { path: path.into(), message };
        let text = lightmeter_files::read::text(path, MOST_TEXT)
            .map_err(|error| refused(format!("it cannot be read: {error}")))?;
        Self::parse(&text).map_err(refused)
    }

    fn parse(text: &str) -> Result<Self, String> {
        let file: File = toml::from_str(text).map_err(|error| error.to_string())?;
        let read = |(k, written): (usize, Written)| {
            let filter = Filter::new(std::slice::from_ref(&written.id)).map_err(|error| error.to_string())?;
            // A known failure fails, whatever it is of: what may pass besides leaves nothing to be judged.
            match refused(&filter, &written.reason) {
                Some(why) if written.may_pass && written.mistake.is_empty() || written.reason.trim().is_empty() => {
                    return Err(format!("expected[{k}] `{}` {why}", written.id));
                }
                _ => {}
            }
            if let Some(on) = written.on.as_ref().filter(|on| !places().any(|place| place == on.as_str())) {
                let places: Vec<&str> = places().collect();
                return Err(format!(
                    "expected[{k}].on `{on}` is no stage and no target; expected {}",
                    places.join(", ")
                ));
            }
            if written.crash && !written.mistake.is_empty() {
                return Err(format!(
                    "expected[{k}] `{}` has `crash` and `mistake`; a crash is no answer that a mistake gives: write two entries",
                    written.id
                ));
            }
            let versions = versions(written.version.as_deref(), &format!("expected[{k}]"))?;
            let made = (!written.mistake.is_empty()).then(|| KnownMistakes::by_names(&written.mistake)).transpose();
            let made = made.map_err(|error| format!("expected[{k}] `{}`: {error}", written.id))?.map(Arc::new);
            Ok(ReadFailure { written, filter, versions, made })
        };
        let written = file.expected.into_iter().enumerate().map(read).collect::<Result<Vec<_>, String>>()?;
        nothing_is_left(&written)?;
        let read = |(k, skip): (usize, WrittenSkip)| {
            let filter = Filter::new(std::slice::from_ref(&skip.id)).map_err(|error| error.to_string())?;
            if let Some(why) = refused(&filter, &skip.reason) {
                return Err(format!("skipped[{k}] `{}` {why}", skip.id));
            }
            let version = versions(skip.version.as_deref(), &format!("skipped[{k}]"))?;
            Ok((skip, filter, version))
        };
        let skipped = file.skipped.into_iter().enumerate().map(read).collect::<Result<_, String>>()?;
        Ok(Self { written, skipped })
    }

    /// The globs of cases.
    pub fn ids(&self) -> impl Iterator<Item = &str> {
        let failures = self.written.iter().map(|one| one.written.id.as_str());
        failures.chain(self.skipped.iter().map(|(skip, ..)| skip.id.as_str()))
    }

    /// Those of a renderer.
    #[must_use]
    pub fn of(&self, renderer: &str, version: &str) -> Vec<ExpectedFailure> {
        let version = lenient(version);
        let of = |ReadFailure { written, filter, made, .. }: &ReadFailure| ExpectedFailure {
            known: KnownFailure {
                id: written.id.clone(),
                reason: written.reason.clone(),
                on: written.on.clone(),
                mistake: written.mistake.clone(),
                failed: 0,
                passed: 0,
                crash: written.crash,
                may_pass: written.may_pass,
            },
            filter: filter.clone(),
            made: made.clone().map(|made| made as Arc<dyn Made>),
        };
        self.written.iter().filter(|one| one.concerns(renderer, version.as_ref())).map(of).collect()
    }

    /// A line on the entries that are of none of these renderers, each with its version; nothing where there are none.
    #[must_use]
    pub fn of_others(&self, renderers: &[(&str, &str)]) -> Option<String> {
        let versions: Vec<_> = renderers.iter().map(|(name, version)| (*name, lenient(version))).collect();
        let is_of_none = |concerns: &dyn Fn(&str, Option<&Version>) -> bool| {
            !versions.iter().any(|(name, version)| concerns(name, version.as_ref()))
        };
        let failures = self.written.iter().filter(|one| is_of_none(&|name, version| one.concerns(name, version)));
        let skips = self.skipped.iter().filter(|(skip, _, range)| {
            is_of_none(&|name, version| is_of((skip.renderer.as_ref(), range.as_ref()), name, version))
        });
        let ids = failures.map(|one| &one.written.id).chain(skips.map(|(skip, ..)| &skip.id));
        let ids: Vec<String> = ids.map(|id| format!("`{id}`")).collect();
        let are = if ids.len() == 1 { "1 expectation is".into() } else { format!("{} expectations are", ids.len()) };
        (!ids.is_empty()).then(|| format!("{are} of another renderer or version than this: {}", ids.join(", ")))
    }

    /// The cases that a renderer is known to skip.
    pub(super) fn skips_of(&self, renderer: &str, version: &str) -> Vec<Filter> {
        let version = lenient(version);
        let concerns = |(skip, _, range): &&(WrittenSkip, Filter, Option<VersionReq>)| {
            is_of((skip.renderer.as_ref(), range.as_ref()), renderer, version.as_ref())
        };
        self.skipped.iter().filter(concerns).map(|(_, filter, _)| filter.clone()).collect()
    }
}

/// Refuses entries that leave nothing to be judged together: those that may pass, of any renderer and of one by name.
fn nothing_is_left(written: &[ReadFailure]) -> Result<(), String> {
    let is_open = |one: &&ReadFailure| one.written.may_pass && one.written.mistake.is_empty();
    let may_pass: Vec<&ReadFailure> = written.iter().filter(is_open).collect();
    for one in may_pass.iter().map(|one| &one.written) {
        let concerns = |other: &Written| other.renderer.is_none() || other.renderer == one.renderer;
        let together = may_pass.iter().filter(|other| concerns(&other.written)).map(|other| &other.filter);
        if is_everything(&together.collect::<Vec<_>>()) {
            let whose = one.renderer.as_ref().map_or_else(String::new, |renderer| format!(" of `{renderer}`"));
            return Err(format!(
                "the entries{whose} with `may_pass` match everything together; then nothing could fail"
            ));
        }
    }
    Ok(())
}

/// The stages and targets that something can be known to fail on.
fn places() -> impl Iterator<Item = &'static str> {
    let targets = TargetFormat::ALL.map(TargetFormat::name).into_iter().chain(["image", "image-full"]);
    Stage::ALL.map(Stage::name).into_iter().chain(targets)
}

/// The first number of a version in any words: `Mesa 22.3.6` is 22.3.6, `r170` is 170.0.0.
fn lenient(text: &str) -> Option<Version> {
    let start = text.find(|c: char| c.is_ascii_digit())?;
    let rest = &text[start..];
    let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
    let mut parts = rest[..end].split('.').map(|part| part.parse().unwrap_or(0));
    let [major, minor, patch] = std::array::from_fn(|_| parts.next().unwrap_or(0));
    Some(Version::new(major, minor, patch))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expectations_are_of_a_renderer_and_its_versions() {
        let text = r#"
            [[expected]]
            id = "fog/linear"
            reason = "it has smoothstep"
            renderer = "three.js"
            version = ">=0.150, <0.170"
            [[expected]]
            id = "scene/**"
            reason = "for any"
        "#;
        let file = Expectations::parse(text).expect("it is valid");
        let ids = |renderer: &str, version: &str| -> Vec<String> {
            file.of(renderer, version).into_iter().map(|one| one.known.id).collect()
        };
        assert_eq!(ids("three.js", "0.160.1"), ["fog/linear", "scene/**"]);
        assert_eq!(ids("three.js", "three r0.170"), ["scene/**"]);
        assert_eq!(ids("other", "0.160.1"), ["scene/**"]);
        let known = &file.of("three.js", "0.160")[0];
        assert!(known.has("fog/linear/random/000001", &["answer"]));
        assert!(!known.has("fog/linear-radial/random/000001", &["answer"]));
        let text = "[[expected]]\nid = \"blend/**\"\nreason = \"r\"\non = \"rgba8unorm\"";
        let known = &Expectations::parse(text).expect("it is valid").of("any", "1")[0];
        assert!(
            known.has("blend/add/one/one/0001", &["answer", "rgba8unorm"])
                && !known.has("blend/add/one/one/0001", &["answer"])
        );
        for (text, said) in [
            ("[[expected]]\nid = \"fog\"", "missing field `reason`"),
            ("[[expected]]\nid = \"fog\"\nreason = \" \"", "no reason"),
            ("[[expected]]\nid = \"fog\"\nreason = \"r\"\nversion = \"new\"", "version `new`"),
            ("[[expected]]\nid = \"fog\"\nreason = \"r\"\non = \"rgba9\"", "expected compute, fragment"),
            ("[[expect]]\nid = \"fog\"\nreason = \"r\"", "unknown field `expect`"),
            ("[[expected]]\nid = \"[\"\nreason = \"r\"", "["),
            ("[[expected]]\nid = \"**\"\nreason = \"r\"\nmay_pass = true", "expected[0] `**` matches everything"),
            (
                "[[expected]]\nid = \"[a-f]*/**\"\nreason = \"r\"\nmay_pass = true\n\
                 [[expected]]\nid = \"[g-z]*\"\nreason = \"r\"\nrenderer = \"one\"\nmay_pass = true",
                "the entries of `one` with `may_pass` match everything together",
            ),
            (
                "[[expected]]\nid = \"fog\"\nreason = \"r\"\nmistake = \"fog-radail\"",
                "expected[0] `fog`: there is no mistake `fog-radail`; did you mean `fog-radial`",
            ),
            (
                "[[expected]]\nid = \"fog\"\nreason = \"r\"\nmistake = \"fog-radial\"\ncrash = true",
                "expected[0] `fog` has `crash` and `mistake`",
            ),
            ("[[expected]]\nid = \"fog\"\nreason = \"r\"\nmistake = []", "`mistake` is an empty list"),
            ("[[expected]]\nid = \"fog\"\nreason = \"r\"\nmistake = 5", "expected a mistake such as"),
            ("[[skipped]]\nid = \"*\"\nreason = \"r\"", "skipped[0] `*` matches everything"),
            ("[[skipped]]\nid = \"fog\"\nreason = \"\"", "skipped[0] `fog` has no reason"),
        ] {
            let error = Expectations::parse(text).expect_err(said);
            assert!(error.contains(said), "{error}");
        }
    }
}
