//! `lightmeter.toml`: what a project always says, so that nobody has to type it.
//!
//! Its settings stand for options of the same names. They are put behind the command's name before the command line is read, so that an
//! option that is given wins, and a wrong value is told like a wrong option.

use anyhow::{Context as _, bail};
use clap::{Arg, Command};
use lightmeter::arithmetic::Profile;
use lightmeter::arithmetic::profile::PROFILES;
use lightmeter::document::report::ConfigUse;
use lightmeter::files::read;
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The file's name.
const FILE: &str = "lightmeter.toml";
/// The settings, which are the names of options.
const NAMES: [&str; 6] = ["adapter", "profile", "baseline", "growth", "expect", "require"];
/// The option that leaves it out.
const LEFT_OUT: &str = "--no-config";

/// What a project says.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "settings")]
struct Config {
    /// The adapters that `run` and other commands take.
    #[serde(default, deserialize_with = "one_or_several")]
    adapter: Vec<String>,
    profile: Option<String>,
    baseline: Option<PathBuf>,
    growth: Option<f64>,
    expect: Option<PathBuf>,
    require: Option<f64>,
    /// The shaders that `check` reads.
    #[serde(default)]
    shader: Vec<Shaders>,
}

/// Shaders of a project that are read with the same.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "files, include, define and accept")]
pub(crate) struct Shaders {
    /// Files, folders and globs, beside the file.
    pub(crate) files: Vec<String>,
    /// Where included files are.
    #[serde(default)]
    pub(crate) include: Vec<PathBuf>,
    /// Macros of the host.
    #[serde(default)]
    pub(crate) define: BTreeMap<String, String>,
    /// Dialects and mistakes that are meant as they are.
    #[serde(default)]
    pub(crate) accept: Vec<String>,
}

/// What a project says of its shaders.
pub(crate) struct Project {
    /// The folder of the file, as it is called from here.
    pub(crate) folder: PathBuf,
    pub(crate) entries: Vec<Shaders>,
}

/// The shaders of the project's file; `None` where there is no file, or it is left out.
///
/// # Errors
/// Where it cannot be read.
pub(crate) fn shaders() -> anyhow::Result<Option<Project>> {
    if std::env::args_os().take_while(|word| word != "--").any(|word| word == LEFT_OUT) {
        return Ok(None);
    }
    let Some((path, file)) = found() else { return Ok(None) };
    let entries = parsed(&path, &file)?.shader;
    let folder = Path::new(&file).parent().unwrap_or(Path::new("")).to_owned();
    Ok(Some(Project { folder, entries }))
}

/// A name, or a list of names.
fn one_or_several<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<String>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a name such as \"lavapipe\", or a list of names")]
    enum Names {
        One(String),
        Several(Vec<String>),
    }
    Ok(match Names::deserialize(deserializer)? {
        Names::One(name) => vec![name],
        Names::Several(names) => names,
    })
}

static USED: OnceLock<ConfigUse> = OnceLock::new();

/// What was taken from a file, for reports; `None` where nothing was.
pub(crate) fn used() -> Option<ConfigUse> {
    USED.get().cloned()
}

/// The words of the command line, with those that the project's file says.
pub(crate) fn arguments(command: &Command) -> anyhow::Result<Vec<OsString>> {
    let given: Vec<OsString> = std::env::args_os().collect();
    let is_command = |word: &OsString| {
        word.to_str().and_then(|word| command.find_subcommand(word)).is_some_and(|found| !found.is_hide_set())
    };
    let Some(place) = given.iter().position(is_command).filter(|&place| place > 0) else { return Ok(given) };
    if given[..place].iter().any(|word| word == "help") {
        return Ok(given);
    }
    // What stands behind `--` is no option.
    let end = given.iter().position(|word| word == "--").unwrap_or(given.len());
    let options_given = &given[..end];
    let is_left_out = options_given.iter().any(|word| word == LEFT_OUT || word == "--help" || word == "-h");
    let named = given[place].to_str().and_then(|word| command.find_subcommand(word));
    let taken = |name: &str| named.and_then(|one| one.get_arguments().find(|arg| arg.get_long() == Some(name)));
    // The reference draws where no adapter is asked for, whatever a project's adapter is.
    let draws = named.is_some_and(|one| one.get_name() == "render");
    let judges_browsers = named.is_some_and(|one| one.get_name() == "serve");
    if is_left_out || draws || !NAMES.iter().any(|name| taken(name).is_some()) {
        return Ok(given);
    }
    let Some((path, file)) = found() else { return Ok(given) };
    let config = parsed(&path, &file)?;
    let (mut words, mut settings) = (vec![], serde_json::Map::new());
    for (name, values) in options(&config, path.parent().unwrap_or(Path::new("."))) {
        // Without a baseline nothing grows.
        let is_of_baseline = name == "growth" && config.baseline.is_none() && !is_given(options_given, "baseline");
        let has_no_use =
            is_of_baseline || judges_browsers && name == "adapter" || is_excluded(named, name, options_given);
        let Some(option) = taken(name).filter(|_| !is_given(options_given, name) && !has_no_use) else { continue };
        if values.len() > 1 && !matches!(option.get_action(), clap::ArgAction::Append) {
            bail!(
                "{file} sets {name} to a list of {} values, but this command takes only one; choose one with `--{name}`",
                values.len()
            );
        }
        for value in values {
            let text = value.to_string_lossy().into_owned();
            let settings = settings.entry(name).or_insert_with(|| serde_json::Value::String(String::new()));
            let before = settings.as_str().filter(|before| !before.is_empty()).map(|before| format!("{before}, "));
            *settings = (before.unwrap_or_default() + &text).into();
            let mut word = OsString::from(format!("--{name}="));
            word.push(value);
            words.push(word);
        }
    }
    if !words.is_empty() {
        let _ = USED.set(ConfigUse { file, settings });
    }
    let (before, after) = given.split_at(place + 1);
    Ok([before, &words, after].concat())
}

/// The file of this folder, or of the nearest one above that has one, and how it is called from here. Beyond the root of a repository nothing
/// belongs to the project.
fn found() -> Option<(PathBuf, String)> {
    let folder = std::env::current_dir().ok()?;
    for (above, folder) in folder.ancestors().enumerate() {
        let path = folder.join(FILE);
        // A link that leads nowhere is there as well, and is told.
        if path.symlink_metadata().is_ok() {
            return Some((path, "../".repeat(above) + FILE));
        }
        if folder.join(".git").exists() {
            return None;
        }
    }
    None
}

fn parsed(path: &Path, file: &str) -> anyhow::Result<Config> {
    let of = || format!("cannot read {file}");
    let text = read::text(path, read::MOST_TEXT).with_context(of)?;
    let config: Config = toml::from_str(&text).map_err(|error| {
        let line = error.span().map_or(1, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
        let says = error.message().lines().next().unwrap_or_default().to_owned();
        let expected = "expected settings such as adapter = [\"cpu\"]; a command to start is no setting";
        anyhow::anyhow!("{file}, line {line}: {says}; {expected}")
    })?;
    if let Some(profile) = config.profile.as_ref().filter(|name| Profile::by_name(name).is_none()) {
        let known = PROFILES.map(|profile| profile.name).join(", ");
        bail!("{file}: profile is `{profile}`; expected one of {known}");
    }
    let beside = path.parent().unwrap_or(Path::new("."));
    if let Some(expect) = config.expect.as_ref().filter(|expect| !beside.join(expect).exists()) {
        bail!("{file}: expect is `{}`, and there is no such file beside it", expect.display());
    }
    if let Some(require) = config.require.filter(|share| !(0.0..=1.0).contains(share)) {
        bail!("{file}: `require` is {require}; expected a fraction from 0 to 1, such as 0.25");
    }
    Ok(config)
}

/// The options that it says, by their names. Files lie beside it.
fn options(config: &Config, folder: &Path) -> Vec<(&'static str, Vec<OsString>)> {
    let beside = |path: &Option<PathBuf>| path.iter().map(|path| folder.join(path).into_os_string()).collect();
    let number = |number: &Option<f64>| number.iter().map(|number| number.to_string().into()).collect();
    let all: [(&'static str, Vec<OsString>); 6] = [
        ("adapter", config.adapter.iter().map(OsString::from).collect()),
        ("profile", config.profile.iter().map(OsString::from).collect()),
        ("baseline", beside(&config.baseline)),
        ("growth", number(&config.growth)),
        ("expect", beside(&config.expect)),
        ("require", number(&config.require)),
    ];
    all.into_iter().filter(|(_, values)| !values.is_empty()).collect()
}

/// Whether one of the options that are given cannot be used with another one.
fn is_excluded(command: Option<&Command>, name: &str, given: &[OsString]) -> bool {
    let Some(command) = command else { return false };
    let excludes = |arg: &&Arg| command.get_arg_conflicts_with(arg).iter().any(|other| other.get_long() == Some(name));
    command
        .get_arguments()
        .filter(|arg| arg.get_long().is_some_and(|long| is_given(given, long)))
        .any(|arg| excludes(&arg))
}

/// Whether an option is among the words.
fn is_given(words: &[OsString], name: &str) -> bool {
    let option = format!("--{name}");
    let is_it = |word: &OsStr| {
        let word = word.to_string_lossy();
        word == option || word.starts_with(&format!("{option}="))
    };
    words.iter().any(|word| is_it(word))
}
