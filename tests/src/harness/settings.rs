//! What the environment asks of the conformance tests: variables of the names of `run`'s options.

use lightmeter::adapters;
use lightmeter::arithmetic::Profile;
use lightmeter::arithmetic::profile::PROFILES;
use lightmeter::nearest::nearest;
use lightmeter::options::{DEFAULT_CASES, MOST_CASES, Options};
use lightmeter::subject_gpu::code_of;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// What every variable begins with.
const PREFIX: &str = "LIGHTMETER_";
/// The variables, each with the option of `run` that it stands for.
const KNOWN: [(&str, &str); 5] = [
    ("LIGHTMETER_ADAPTER", "--adapter; several are separated by commas"),
    ("LIGHTMETER_CASES", "--cases"),
    ("LIGHTMETER_PROFILE", "--profile"),
    ("LIGHTMETER_SEED", "--seed"),
    ("LIGHTMETER_SHADERS", "--shaders"),
];

/// The variables in force: those that are known and not empty, and those that look like a misspelt one of them.
#[derive(Clone, Debug, Default)]
pub struct Variables(BTreeMap<String, OsString>);

/// What the variables ask for.
pub struct Settings {
    /// The adapters by name; none for the one that `run` takes.
    pub adapters: Vec<String>,
    /// Whether the adapter is a part of the names: several were asked for, or all there are.
    pub adapter_in_names: bool,
    /// The options of the run that the trials are parts of.
    pub options: Options,
}

/// Whether a variable is one of these, or is misspelt. Others that begin so are not for these tests.
fn is_meant(name: &str) -> bool {
    let known = KNOWN.iter().filter_map(|(name, _)| name.strip_prefix(PREFIX));
    name.strip_prefix(PREFIX)
        .is_some_and(|own| known.clone().any(|known| known == own) || !nearest(own, known).is_empty())
}

/// A path as it is meant where cargo was called: cargo starts tests in their package's folder, and leaves `PWD` as it was.
fn from_where_called(path: &Path) -> PathBuf {
    let meant = std::env::var_os("PWD").map(|folder| Path::new(&folder).join(path));
    meant.filter(|meant| meant.exists()).unwrap_or_else(|| path.to_owned())
}

/// The names of a list.
fn names(text: &str) -> impl Iterator<Item = &str> {
    text.split(',').map(str::trim)
}

impl Variables {
    /// Those of an environment.
    pub fn of(environment: impl Iterator<Item = (OsString, OsString)>) -> Self {
        let ours = environment.filter_map(|(name, value)| {
            let name = name.into_string().ok()?;
            (is_meant(&name) && !value.is_empty()).then_some((name, value))
        });
        Self(ours.collect())
    }

    /// Each with its value on a line, for the first line of the output.
    #[must_use]
    pub fn line(&self) -> String {
        if self.0.is_empty() {
            return format!("no {PREFIX}… variable is set: what `lightmeter run` judges without options");
        }
        let each = self.0.iter().map(|(name, value)| format!("{name}={}", value.to_string_lossy()));
        each.collect::<Vec<_>>().join(" ")
    }

    /// What they ask for.
    ///
    /// # Errors
    /// Where one is unknown, or its value is not one that it may have: says what would be right.
    pub fn settings(&self) -> Result<Settings, String> {
        if let Some(name) = self.0.keys().find(|name| KNOWN.iter().all(|(known, _)| known != name)) {
            let known: Vec<String> = KNOWN.iter().map(|(name, option)| format!("{name} ({option})")).collect();
            return Err(format!("{name} is no variable of the conformance tests; there are {}", known.join(", ")));
        }
        let seed = self.number("LIGHTMETER_SEED", 0, u64::MAX)?.unwrap_or(1);
        let cases = self.number("LIGHTMETER_CASES", 1, MOST_CASES)?.unwrap_or(DEFAULT_CASES);
        let profile = match self.text("LIGHTMETER_PROFILE")? {
            Some(name) => Profile::named(name).map_err(|message| format!("LIGHTMETER_PROFILE=`{name}`: {message}"))?,
            None => PROFILES[0],
        };
        let shaders = self.0.get("LIGHTMETER_SHADERS").map(|folder| from_where_called(Path::new(folder)));
        let code = code_of(shaders.as_deref()).map_err(|error| format!("LIGHTMETER_SHADERS: {error}"))?;
        let options = Options::by(code, shaders.as_deref(), seed, profile);
        let adapters = self.adapters()?;
        let asks_for_all =
            self.text("LIGHTMETER_ADAPTER")?.is_some_and(|text| names(text).any(|name| name == adapters::ALL));
        let adapter_in_names = asks_for_all || adapters.len() > 1;
        Ok(Settings { adapters, adapter_in_names, options: Options { cases, ..options } })
    }

    fn text(&self, name: &str) -> Result<Option<&str>, String> {
        let text = |value: &'_ OsString| format!("{name}: {} is not UTF-8", value.to_string_lossy());
        self.0.get(name).map(|value| value.to_str().ok_or_else(|| text(value))).transpose()
    }

    fn number(&self, name: &str, least: u64, most: u64) -> Result<Option<u64>, String> {
        let Some(text) = self.text(name)? else { return Ok(None) };
        let number = text.parse().ok().filter(|number| (least..=most).contains(number));
        number.map(Some).ok_or_else(|| format!("{name}: `{text}` is not a whole number from {least} to {most}"))
    }

    /// The adapters asked for, each once. `all` is spelled out by their names, which needs a driver and no device.
    fn adapters(&self) -> Result<Vec<String>, String> {
        let Some(text) = self.text("LIGHTMETER_ADAPTER")? else { return Ok(vec![]) };
        let mut found: Vec<String> = vec![];
        for name in names(text) {
            if name.is_empty() {
                return Err(format!("LIGHTMETER_ADAPTER: `{text}` is no list of names, such as lavapipe,swiftshader"));
            }
            let meant = if name == adapters::ALL {
                adapters::names().map_err(|error| format!("LIGHTMETER_ADAPTER=`{text}`: {error}"))?
            } else {
                vec![name.to_owned()]
            };
            found.extend(meant);
        }
        let mut seen = std::collections::BTreeSet::new();
        found.retain(|name| seen.insert(name.clone()));
        Ok(found)
    }
}
