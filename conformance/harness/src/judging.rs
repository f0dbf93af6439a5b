//! How an engine is judged: by which cases, and against what.

use crate::engine::{AskedEngine, Engine};
use lightmeter_catalogue::cases::GENERATOR_VERSION;
use lightmeter_catalogue::filter::Filter;
use lightmeter_document::by_case::{ComparedBy, Coverage};
use lightmeter_document::event::Silent;
use lightmeter_document::pack::Choice;
use lightmeter_document::report::Report;
use lightmeter_engine::device::Code;
use lightmeter_engine::options::{ASKED_CASES, Options};
use lightmeter_engine::run::run_selection;
use lightmeter_engine::selection::{Selection, SelectionPart};
use lightmeter_engine::subject::Subject;
use lightmeter_faults::{Mistakes, explain};
#[cfg(feature = "suite")]
use lightmeter_gate::baseline;
use lightmeter_gate::baseline::{Baseline, BaselineError, Standard};
use lightmeter_gate::expectations::{ExpectationError, Expectations};
use lightmeter_gate::plan::unmatched;
use lightmeter_gate::renderer::InProcess;
use lightmeter_report::github;
use lightmeter_report::text::{Style, write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// By how much an error may grow against a baseline, as of `lightmeter gate`.
const GROWTH: f64 = 2.0;

/// The variable that renews the baseline instead of comparing with it.
pub(crate) const UPDATE: &str = "LIGHTMETER_UPDATE_BASELINE";

/// Why an engine cannot be judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HarnessError {
    /// It declares what there is not, or nothing at all.
    #[error("{0}")]
    Engine(String),
    /// A file of known failures.
    #[error(transparent)]
    Expectations(#[from] ExpectationError),
    /// A baseline.
    #[error(transparent)]
    Baseline(#[from] BaselineError),
    /// There is no baseline where one is to be.
    #[error(
        "there is no baseline {}; expected an earlier result, which a run with {UPDATE}=1 writes there",
        .0.display()
    )]
    NoBaseline(PathBuf),
    /// The suite itself.
    #[error("{0}")]
    Suite(String),
}

/// What cases an engine is judged by, and against what.
#[derive(Clone, Debug)]
pub(crate) struct Criteria {
    pub(crate) cases: u64,
    pub(crate) seed: u64,
    pub(crate) expectations: Option<PathBuf>,
    pub(crate) baseline: Option<PathBuf>,
}

impl Default for Criteria {
    fn default() -> Self {
        Self { cases: ASKED_CASES, seed: 1, expectations: None, baseline: None }
    }
}

/// An engine that is being judged.
pub(crate) struct Judged {
    subject: Mutex<Subject>,
    options: Options,
    choice: Choice,
    baseline: Option<(PathBuf, Baseline)>,
    pub(crate) parts: Vec<SelectionPart>,
    /// Whether a case of any part was judged.
    has_judged: AtomicBool,
}

impl Criteria {
    /// Reads what there is to read, and asks the engine what it has.
    pub(crate) fn begin<E: Engine>(&self, engine: Arc<E>) -> Result<Judged, HarnessError> {
        let formulas = engine.formulas();
        let engine_error = |error: &dyn std::fmt::Display| HarnessError::Engine(error.to_string());
        if formulas.is_empty() {
            return Err(HarnessError::Engine(format!(
                "{} has no formula; `lightmeter list --formulas` lists those that there are",
                engine.name()
            )));
        }
        let (name, version) = (engine.name(), engine.version());
        let mut renderer = InProcess::new(AskedEngine(engine), PathBuf::new()).map_err(|error| engine_error(&error))?;
        let identity = renderer.identity();
        let expectations = self.expectations.as_deref().map(Expectations::read).transpose()?.unwrap_or_default();
        renderer.expect(&expectations);
        if let Some(id) = unmatched(expectations.ids()) {
            return Err(HarnessError::Engine(format!(
                "the expectation `{id}` matches no case of any formula: see `lightmeter list`"
            )));
        }
        let options = Options {
            filter: Filter::new(&formulas).map_err(|error| engine_error(&error))?,
            cases: self.cases,
            seed: self.seed,
            targets: vec![],
            diagnose: Some(&Mistakes),
            expected: expectations.of(&name, &version),
            counts_cases: true,
            ..Options::new(Code::default())
        };
        let mut selection = Selection::of_renderer(&options);
        (selection.scenes, selection.blended) = (vec![], vec![]);
        let parts = selection.parts();
        let earlier = |path: &PathBuf| match path.exists() {
            true => Ok((path.clone(), Baseline::read(path, true)?)),
            false => Err(HarnessError::NoBaseline(path.clone())),
        };
        let baseline = self.baseline.as_ref().map(earlier).transpose()?;
        Ok(Judged {
            subject: Mutex::new(Subject::renderer(identity, Box::new(renderer))),
            choice: Choice { filter: formulas, cases: self.cases, seed: self.seed, ..Choice::default() },
            options,
            baseline,
            has_judged: AtomicBool::new(false),
            parts,
        })
    }

    /// Judges all of an engine, and writes the result to the baseline's file.
    #[cfg(feature = "suite")]
    pub(crate) fn renew<E: Engine>(&self, engine: Arc<E>) -> Result<PathBuf, HarnessError> {
        let path = self.baseline.clone().ok_or_else(|| HarnessError::Engine("there is no baseline to renew".into()))?;
        let judged = Self { baseline: None, ..self.clone() }.begin(engine)?;
        let mut whole = judged.parts.first().map(|part| part.selection.clone());
        if let Some(whole) = &mut whole {
            whole.formulas = judged.parts.iter().flat_map(|part| part.selection.formulas.clone()).collect();
            baseline::update(&judged.report(whole, &judged.choice)?, &path)?;
        }
        Ok(path)
    }
}

impl Judged {
    /// What the engine is worth in a part, against the baseline as well.
    pub(crate) fn of(&self, part: &SelectionPart) -> Result<Report, HarnessError> {
        let choice = Choice { filter: part.filters.clone(), ..self.choice.clone() };
        let mut report = self.report(&part.selection, &choice)?;
        self.has_judged.fetch_or(report.has_judged(), Ordering::Relaxed);
        if let Some((path, baseline)) = &self.baseline {
            report.regressions = baseline.compare(&Standard::from(&report), GROWTH, (false, false), path)?;
        }
        Ok(report)
    }

    /// Whether a case of any part was judged so far.
    #[cfg(feature = "suite")]
    pub(crate) fn has_judged(&self) -> bool {
        self.has_judged.load(Ordering::Relaxed)
    }

    fn report(&self, selection: &Selection, choice: &Choice) -> Result<Report, HarnessError> {
        let mut subject = self.subject.lock().unwrap_or_else(PoisonError::into_inner);
        let report = run_selection(selection, std::slice::from_mut(&mut *subject), &self.options, &mut Silent)
            .map_err(|error| HarnessError::Suite(error.to_string()))?;
        let compared_by =
            Some(ComparedBy { choice: choice.clone(), generator: GENERATOR_VERSION, ..ComparedBy::default() });
        let explained = explain(&report, self.options.profile);
        Ok(Report { compared_by, explained, ..report })
    }
}

/// Prints, where the tests run in GitHub Actions, the lines that it shows as annotations: at the line which names the formula.
pub(crate) fn annotate(report: &Report) {
    if std::env::var("GITHUB_ACTIONS").is_ok_and(|value| value == "true") {
        eprint!("{}", annotations(report));
    }
}

/// A line for each group that fails.
fn annotations(report: &Report) -> String {
    github::annotations(report)
        .lines()
        .filter(|line| line.starts_with("::error"))
        .fold(String::new(), |all, line| all + line + "\n")
}

/// What `lightmeter gate` prints of a result, where it is none that passes. A formula that is skipped passes where a file of expectations
/// says that it is; whether anything was judged at all is seen to by whoever judges several.
pub(crate) fn complaint(report: &Report) -> Option<String> {
    let Coverage { chosen, judged, .. } = report.coverage();
    let is_covered = report.has_judged() && report.coverage().is_enough(Coverage::REQUIRED);
    let skipped = report.cases().skipped;
    let is_skipped = skipped > 0 && judged + skipped == chosen;
    if !report.is_failed() && !report.is_broken() && (is_covered || is_skipped) {
        return None;
    }
    let mut told = String::new();
    // Writing to a string does not fail.
    let _ = write(report, Style::default(), &mut told);
    Some(told)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Formulas;

    #[test]
    fn github_is_told_the_line_that_names_a_formula_which_fails() {
        let annotated = |factor: f32| {
            let engine = Formulas::new("engine", "1.0").with("color/modulate", move |x| {
                let (texel, color) = (x.vec4("texel"), x.vec4("color"));
                [0, 1, 2, 3].map(|k| factor * texel[k] * color[k])
            });
            let judged = Criteria::default().begin(Arc::new(engine)).expect("the engine can be judged");
            annotations(&judged.of(&judged.parts[0]).expect("it is judged"))
        };
        assert_eq!(annotated(1.0), "");
        let told = annotated(0.5);
        let place = format!("::error file={},line=", file!());
        assert!(told.starts_with(&place) && told.contains(",title=color/modulate"), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
}
