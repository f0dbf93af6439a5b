//! `lightmeter identify`.

use super::options::{Choice, Format};
use super::progress::Bar;
use super::shader::{OwnShader, constant, written};
use super::signals::stopped_by_signals;
use super::visit::opened;
use super::{Status, quoted, writable};
use clap::Args;
use lightmeter::arithmetic::Profile;
use lightmeter::document::Document as _;
use lightmeter::document::identify::{FormulaCandidate, IdentifyDocument, SCHEMA};
use lightmeter::document::report::Report;
use lightmeter::document::thousands;
use lightmeter::faults::Mistakes;
use lightmeter::files::lines;
use lightmeter::filter::Filter;
use lightmeter::options::{Adapted, Constant, Options};
use lightmeter::run::run;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Random cases of each formula: mistakes show in as many.
pub(super) const CASES: u64 = 256;
/// How many times more of a formula than of the best one may be wrong, so that it can still be the one that is meant.
const FAR: f64 = 8.0;
/// Formulas that are told besides the ones that it is, or the nearest one.
const MOST_TOLD: usize = 3;

/// Tell which formula a shader computes, or the nearest one with the mistake that leads to it
///
/// Its variables are bound to the inputs of every formula that they can be bound to, and it is judged by each. The exit code is 0 where it
/// is one of them, and 1 where every one of them is computed otherwise.
#[derive(Debug, Args)]
pub(crate) struct Identify {
    /// The shader's file: .frag, .vert, .glsl, .wgsl or .spv
    #[arg(required_unless_present = "names")]
    file: Option<PathBuf>,
    /// List the names of variables that are understood, and what they are taken to mean
    #[arg(long)]
    names: bool,
    /// A function of it; without it: the shader as a whole
    #[arg(long, value_name = "NAME")]
    function: Option<String>,
    /// What a variable of the shader means: WGSL over the formula's inputs; again for several
    #[arg(long, value_name = "NAME=EXPRESSION", allow_hyphen_values = true)]
    bind: Vec<String>,
    /// An input of the formula that the shader has as a constant, as `shininess=32`, or in common with another one, as `ma=md`; again for several
    #[arg(long, value_name = "NAME=VALUE", value_parser = constant, allow_hyphen_values = true)]
    constant: Vec<(String, Constant)>,
    /// Adapter to run on, as for `run`; without it: lavapipe, or the first there is
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Accuracy rules: wgsl, vulkan or opengl
    #[arg(long, value_name = "NAME", default_value = "wgsl", value_parser = Choice::profile)]
    profile: &'static Profile,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write the result to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Identify {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        writable(self.out.as_deref())?;
        let Some(file) = self.file.clone() else {
            self.format.emit(&names(), self.out.as_deref())?;
            return Ok(Status::Success);
        };
        let stop = stopped_by_signals()?;
        let own = OwnShader::new(file.clone(), self.function.as_deref(), self.bind.clone(), self.constant.clone());
        let adapters: Vec<String> = self.adapter.iter().cloned().collect();
        let accepted = own.adapted_to(&[], &adapters)?;
        let ids: Vec<&str> = accepted.adapted.iter().map(|adapted| adapted.id.as_str()).collect();
        let mut options = Options::by(accepted.code()?, None, 1, self.profile);
        options.filter = Filter::new(&ids)?;
        options.cases = CASES;
        options.diagnose = Some(&Mistakes);
        options.adapted.clone_from(&accepted.adapted);
        options.stop = stop;
        let mut subjects = opened(&adapters)?;
        let mut bar = Bar::new(None, "cases");
        let report = run(&mut subjects, &options, &mut bar);
        bar.bar.finish_and_clear();
        let document = self.document(&file, &report?, &accepted.adapted);
        let text = match self.format {
            Format::Text => lines(&told(&document, &self.run_again())?).into_owned(),
            Format::Json => document.to_json()?,
        };
        self.format.emit(&text, self.out.as_deref())?;
        Ok(if document.is.is_empty() { Status::Failed } else { Status::Success })
    }

    /// The words by which `run` takes the shader.
    fn run_again(&self) -> String {
        let file = self.file.as_deref().unwrap_or(Path::new("")).to_string_lossy();
        let mut words = match &self.function {
            Some(name) => format!(" --function {}", quoted(&format!("{name}@{file}"))),
            None => format!(" --shader {}", quoted(&file)),
        };
        for bind in &self.bind {
            words += &format!(" --bind {}", quoted(bind));
        }
        for (name, value) in &self.constant {
            words += &format!(" --constant {}", quoted(&format!("{name}={}", written(value))));
        }
        words
    }

    fn document(&self, file: &Path, report: &Report, adapted: &[Adapted]) -> IdentifyDocument {
        let candidates = candidates(report, adapted);
        IdentifyDocument {
            schema: SCHEMA.into(),
            file: file.to_string_lossy().into_owned(),
            function: self.function.clone(),
            adapter: report.adapters.first().map(|adapter| adapter.name.clone()).unwrap_or_default(),
            is: candidates.iter().filter(|one| is_formula(one)).map(|candidate| candidate.formula.clone()).collect(),
            candidates,
        }
    }
}

/// Whether a shader is judged to be this formula.
fn is_formula(candidate: &FormulaCandidate) -> bool {
    candidate.failed == 0 && candidate.problem.is_none() && candidate.verdicts > 0
}

/// The formulas that a shader was judged by, the nearest one first.
pub(super) fn candidates(report: &Report, adapted: &[Adapted]) -> Vec<FormulaCandidate> {
    let mut candidates: Vec<FormulaCandidate> = vec![];
    for Adapted { id, missing, .. } in adapted {
        let mut candidate =
            FormulaCandidate { formula: id.clone(), missing: missing.clone(), ..FormulaCandidate::default() };
        for group in report.groups.iter().filter(|group| group.id == *id) {
            candidate.verdicts += group.totals.verdicts - group.totals.indeterminate;
            candidate.failed += group.totals.failed;
            candidate.problem = candidate.problem.or_else(|| group.problem());
            candidate.explanation = candidate.explanation.or_else(|| group.diagnosis.as_ref().map(ToString::to_string));
            if candidate.mistakes.is_empty() {
                candidate.mistakes = group.mistakes().iter().map(ToString::to_string).collect();
            }
        }
        candidates.push(candidate);
    }
    #[expect(clippy::cast_precision_loss, reason = "counts of verdicts")]
    let failed = |one: &FormulaCandidate| if one.verdicts == 0 { 1.0 } else { one.failed as f64 / one.verdicts as f64 };
    // A formula of which far more is wrong than of another one is not meant, whatever explains it: mistakes enough turn any formula into any other.
    let least = candidates.iter().filter(|one| !is_formula(one)).map(failed).fold(1.0, f64::min);
    let is_far = |one: &FormulaCandidate| !is_formula(one) && failed(one) > FAR * least;
    // What has a name is nearer than what has none, and one mistake nearer than two. Shares of what fails are compared in quarters: they
    // depend on which hard cases a formula has, and where they are alike the formula that is listed first is the more common one.
    let steps = |candidate: &FormulaCandidate| match candidate.mistakes.len() {
        _ if is_formula(candidate) => 0,
        0 => usize::MAX,
        mistakes => mistakes,
    };
    let share = |one: &FormulaCandidate| (4.0 * failed(one)).round();
    candidates.sort_by(|a, b| {
        is_far(a)
            .cmp(&is_far(b))
            .then(steps(a).cmp(&steps(b)))
            .then(a.missing.len().cmp(&b.missing.len()))
            .then(share(a).total_cmp(&share(b)))
    });
    candidates
}

/// The names of variables that are understood, as a table.
fn names() -> String {
    let row = |(what, names): &(&str, &[&str])| format!("| {what} | {} |\n", names.join(", "));
    let rows: String = lightmeter_adapt::synonyms().iter().map(row).collect();
    format!(
        "| what a variable is | names, without capitals, underscores, digits and prefixes such as `u_` |\n|---|---|\n{rows}"
    )
}

/// The result in words.
fn told(document: &IdentifyDocument, again: &str) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let what = match &document.function {
        Some(name) => format!("`{name}` of {}", document.file),
        None => document.file.clone(),
    };
    let others = |skipped: usize| document.candidates.iter().skip(skipped).take(MOST_TOLD);
    let tried = document.candidates.len();
    if document.is.is_empty() {
        let Some(nearest) = document.candidates.first() else { return Ok(text) };
        let none = match tried {
            1 => "does not compute the one formula".to_owned(),
            _ => format!("computes none of the {tried} formulas"),
        };
        writeln!(text, "{what} {none} that its variables can be bound to.")?;
        write!(text, "The nearest is {}, of which ", nearest.formula)?;
        match &nearest.problem {
            Some(problem) if nearest.failed == 0 => write!(text, "each value is legal, but: {problem}")?,
            _ if nearest.verdicts == 0 => write!(text, "no value could be judged")?,
            _ => {
                write!(text, "{} of {} values are wrong", thousands(nearest.failed), thousands(nearest.verdicts))?;
            }
        }
        match &nearest.explanation {
            Some(explanation) => writeln!(text, ":\n  {explanation}")?,
            None => writeln!(text, ".")?,
        }
        for other in others(1).filter(|other| !other.mistakes.is_empty()) {
            let why = other.explanation.as_deref().unwrap_or_default();
            writeln!(text, "Or it is {}: {why}", other.formula)?;
        }
        if nearest.mistakes.is_empty() {
            writeln!(
                text,
                "A variable may mean something else than its name says: the next command prints what each was taken for."
            )?;
        }
        writeln!(text, "`lightmeter run {}{again}` tells each case.", nearest.formula)?;
        return Ok(text);
    }
    writeln!(text, "{what} computes {}.", document.is.join(", or "))?;
    let passing = document.candidates.iter().filter(|candidate| document.is.contains(&candidate.formula));
    for missing in passing.map(|candidate| &candidate.missing).filter(|missing| !missing.is_empty()).take(1) {
        writeln!(text, "  It does not give {}, which was not judged.", missing.join(", "))?;
    }
    for other in others(document.is.len()).filter(|other| !other.mistakes.is_empty()) {
        let why = other.explanation.as_deref().unwrap_or_default();
        writeln!(text, "It is not {}: {why}", other.formula)?;
    }
    writeln!(text, "On {}, by {CASES} random cases and the hard ones of {tried} formulas.", document.adapter)?;
    Ok(text)
}
