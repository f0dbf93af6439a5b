//! The conformance suite as tests: a trial for each formula, group of blend states, depth test, table of special values, scene
//! and named deviation, judged as `lightmeter run` judges them.
//!
//! The trials are the parts of a run of everything, named by the tree of cases: `conformance::fog::linear`,
//! `conformance::blend::add::src-alpha`, `conformance::scene::teapot`. They follow from the catalogue and the variables alone. With
//! several adapters the adapter's name is the last part: `conformance::fog::linear::lavapipe`.

mod device;
mod settings;

pub use settings::{Settings, Variables};

use crate::needs::has_no_driver;
use crate::skip::{DRIVER, skip};
use device::Device;
use libtest_mimic::{Arguments, Completion, Failed, FormatSetting, Trial};
use lightmeter::device::Code;
use lightmeter::document::report::{Report, Totals};
use lightmeter::document::thousands;
use lightmeter::options::{DEFAULT_CASES, Options};
use lightmeter::report::text;
use lightmeter::selection::{Selection, SelectionPart};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// What every trial's name begins with.
const ROOT: &str = "conformance";
/// The exit code where a test failed, as of every Rust test.
const FAILED: u8 = 101;

/// Runs the trials that the command line asks for, as the environment says. `images` is where the images of scenes that fail
/// are written.
#[must_use]
pub fn main(images: Option<PathBuf>) -> ExitCode {
    let mut arguments = Arguments::from_args();
    // One device judges, on all cores: trials side by side would wait for each other.
    arguments.test_threads = arguments.test_threads.or(Some(1));
    let variables = Variables::of(std::env::vars_os());
    let is_plain = !arguments.list && arguments.format != Some(FormatSetting::Json);
    #[expect(clippy::print_stdout, reason = "what a test prints")]
    if is_plain {
        println!("{ROOT}: {}", variables.line());
    }
    let settings = variables.settings().map(|settings| with_images(settings, images));
    if let Err(message) = &settings
        && arguments.list
    {
        eprintln!("{ROOT}: every trial will fail: {message}");
    }
    let suite = AdapterSuite::new(settings);
    let trials = suite.trials();
    if !arguments.list
        && let Some(message) = suite.selects_nothing(&arguments, &trials)
    {
        eprintln!("{ROOT}: {message}");
        return ExitCode::from(FAILED);
    }
    let conclusion = libtest_mimic::run(&arguments, trials);
    if is_plain {
        suite.print_totals(!conclusion.has_failed());
    }
    conclusion.exit_code()
}

fn with_images(settings: Settings, images: Option<PathBuf>) -> Settings {
    Settings { options: Options { images, ..settings.options }, ..settings }
}

/// The trials, and what they have come to.
pub struct AdapterSuite {
    settings: Result<Settings, String>,
    parts: Vec<Arc<SelectionPart>>,
    totals: Arc<Mutex<Totals>>,
    started: Instant,
}

impl AdapterSuite {
    /// The suite as settings have it. Where these are bad every trial fails and says why.
    ///
    /// # Panics
    /// Where a shader that is built in is invalid, which a test rules out.
    #[must_use]
    pub fn new(settings: Result<Settings, String>) -> Self {
        let parts = match &settings {
            Ok(settings) => Selection::of(&settings.options).parts(),
            Err(_) => Selection::of(&Options::new(Code::default())).parts(),
        };
        let parts = parts.into_iter().map(Arc::new).collect();
        Self { settings, parts, totals: Arc::default(), started: Instant::now() }
    }

    /// The trials, in the order of reports.
    #[must_use]
    pub fn trials(&self) -> Vec<Trial> {
        let settings = match &self.settings {
            Ok(settings) => settings,
            Err(message) => {
                let failing = |part: &Arc<SelectionPart>| {
                    let message = message.clone();
                    Trial::test(name(part), move || Err(Failed::from(message)))
                };
                return self.parts.iter().map(failing).collect();
            }
        };
        let adapters: Vec<Option<String>> = match settings.adapters.as_slice() {
            [] => vec![None],
            names => names.iter().cloned().map(Some).collect(),
        };
        let devices: Vec<Arc<Device>> = adapters.into_iter().map(|name| Arc::new(Device::new(name))).collect();
        let trial = |part: &Arc<SelectionPart>, device: &Arc<Device>| {
            let suffix =
                device.adapter.as_ref().filter(|_| settings.adapter_in_names).map(|adapter| format!("::{adapter}"));
            let name = name(part) + &suffix.unwrap_or_default();
            let (part, device, options) = (Arc::clone(part), Arc::clone(device), settings.options.clone());
            let totals = Arc::clone(&self.totals);
            let (trial, is_any) = (name.clone(), settings.adapters.is_empty());
            Trial::ignorable_test(name, move || {
                if is_any && has_no_driver() {
                    skip(&trial, DRIVER)?;
                    return Ok(Completion::ignored_with(DRIVER.1));
                }
                let report = device.judge(&part.selection, &options)?;
                totals.lock().unwrap_or_else(PoisonError::into_inner).add(&report.totals);
                verdict(&part, &report, &options)
            })
        };
        devices.iter().flat_map(|device| self.parts.iter().map(move |part| trial(part, device))).collect()
    }

    /// What is wrong where the arguments select no trial although they ask for some: a filter that begins with the root names
    /// trials of this target, and where the variables are bad, the names that they would have given are not known.
    fn selects_nothing(&self, arguments: &Arguments, trials: &[Trial]) -> Option<String> {
        if trials.iter().any(|trial| !arguments.is_filtered_out(trial)) {
            return None;
        }
        if let Err(message) = &self.settings {
            return Some(message.clone());
        }
        let filter = arguments.filter.as_deref()?;
        let asks = filter == ROOT || filter.starts_with(&format!("{ROOT}::"));
        let skips = if arguments.skip.is_empty() { "" } else { " and is not skipped" };
        asks.then(|| format!("no trial's name has `{filter}` in it{skips}; `--list` prints their names"))
    }

    /// What the trials judged so far, added up.
    #[must_use]
    pub fn totals(&self) -> Totals {
        *self.totals.lock().unwrap_or_else(PoisonError::into_inner)
    }

    #[expect(clippy::print_stdout, reason = "what a test prints")]
    fn print_totals(&self, is_success: bool) {
        let totals = self.totals();
        if totals.cases > 0 {
            let mut line = String::new();
            // Writing to a string does not fail.
            let _ = text::totals(&totals, is_success, self.started.elapsed().as_secs_f64(), &mut line);
            println!("{ROOT}: {line}");
        }
    }
}

/// The trial's name, but for an adapter.
fn name(part: &SelectionPart) -> String {
    format!("{ROOT}::{}", part.path.replace('/', "::"))
}

/// A trial fails where a run of its part would. It is ignored where there was nothing to judge.
fn verdict(part: &SelectionPart, report: &Report, options: &Options) -> Result<Completion, Failed> {
    if !report.is_success() {
        return Err(Failed::from(message(part, report, options)));
    }
    if !part.selection.deviations.is_empty() && report.deviations.is_empty() {
        return Ok(Completion::ignored_with("it does not concern this driver"));
    }
    let Totals { passed, expected_failures, skipped, indeterminate, .. } = report.totals;
    if passed + expected_failures > 0 || !report.deviations.is_empty() {
        return Ok(Completion::Completed);
    }
    let reason = report.groups.iter().find_map(|group| group.skip_reason.clone());
    Ok(Completion::ignored_with(match reason {
        Some(reason) if indeterminate == 0 => format!("{} cases skipped: {reason}", thousands(skipped)),
        _ => format!("{} verdicts, all indeterminate: nothing is promised of them", thousands(indeterminate)),
    }))
}

/// What `run` prints of the part: counts, the simplest failing case, and the commands that run the case and the part alone.
fn message(part: &SelectionPart, report: &Report, options: &Options) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = text::failing(report, text::Style::default(), &mut text);
    for deviation in report.deviations.iter().filter(|deviation| !deviation.still_needed) {
        let _ = text.write_str("\n✗ unexpected pass: ").and_then(|()| text::deviation(deviation, &mut text));
    }
    if let Some(interrupted) = &report.interrupted {
        let _ = write!(text, "\n✗ {} was under way: {}", interrupted.under_way, interrupted.message);
    }
    for adapter in &report.adapters {
        let adapter = &adapter.name;
        let cases = if options.cases == DEFAULT_CASES { String::new() } else { format!(" --cases {}", options.cases) };
        let _ = write!(text, "\nall of this test again: {}{cases}{}\n", part.command(adapter), options.rerun);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter::document::report::DeviationUse;
    use lightmeter::subject::Subject;

    fn part(path: &str) -> (SelectionPart, Options) {
        let options = Options::new(Code::default());
        let parts = Selection::of(&options).parts();
        (parts.into_iter().find(|part| part.path == path).expect("there is such a part"), options)
    }

    #[test]
    fn a_deviation_that_is_no_longer_seen_fails_its_trial() {
        let (part, options) = part("deviation/llvmpipe-exp");
        let mut report = options.report(&[Subject::embedded()]);
        let mut seen = DeviationUse {
            name: "llvmpipe-exp".into(),
            adapter: "lavapipe".into(),
            reason: "why".into(),
            still_needed: true,
            excused: 0,
        };
        report.deviations.push(seen.clone());
        assert!(matches!(verdict(&part, &report, &options), Ok(Completion::Completed)));
        seen.still_needed = false;
        report.deviations = vec![seen];
        report.totals.unexpected_passes = 1;
        let failed = verdict(&part, &report, &options).err().expect("an unexpected pass fails");
        let message = failed.message().expect("a message");
        assert!(
            message.contains("unexpected pass: known deviation llvmpipe-exp of lavapipe: no longer seen"),
            "{message}"
        );
    }

    #[test]
    fn nothing_judged_is_ignored_and_never_passes() {
        let (part, options) = part("fog/linear");
        let mut report = options.report(&[Subject::embedded()]);
        assert!(matches!(verdict(&part, &report, &options), Ok(Completion::Ignored { .. })));
        report.totals.indeterminate = 5;
        assert!(matches!(verdict(&part, &report, &options), Ok(Completion::Ignored { .. })));
        report.totals.passed = 1;
        assert!(matches!(verdict(&part, &report, &options), Ok(Completion::Completed)));
    }

    #[test]
    fn the_command_of_a_part_selects_the_part() {
        let (_, options) = part("fog/linear");
        let work = |selection: &Selection| {
            let formulas: u64 = selection.formulas.iter().map(|chosen| chosen.count()).sum();
            (formulas, selection.tables.len(), selection.scenes.len())
        };
        for part in &Selection::of(&options).parts() {
            let filter = lightmeter::filter::Filter::new(&part.filters).expect("a glob");
            let selected = Selection::of(&Options { filter, ..options.clone() });
            assert_eq!(work(&selected), work(&part.selection), "{}", part.path);
            let command = part.command("lavapipe");
            assert!(part.filters.iter().all(|filter| command.contains(&format!(" '{filter}' "))), "{command}");
        }
    }
}
