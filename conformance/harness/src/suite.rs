//! Tests of an engine, one for each formula.

use crate::engine::Engine;
use crate::judging::{Criteria, HarnessError, Judged, UPDATE, annotate, complaint};
use libtest_mimic::{Arguments, Failed, Trial};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

/// What every test's name begins with.
const ROOT: &str = "lightmeter";
/// The exit code where a test failed, as of every Rust test.
const FAILED: u8 = 101;

/// The tests of an engine.
pub struct Suite<E> {
    engine: Arc<E>,
    judge: Criteria,
}

impl<E: Engine> Suite<E> {
    /// The tests of all formulas that an engine has: the hard cases of each, and 256 random ones.
    #[must_use]
    pub fn new(engine: E) -> Self {
        Self { engine: Arc::new(engine), judge: Criteria::default() }
    }

    /// With this number of random cases for each formula. A baseline is of the number that it was made with.
    #[must_use]
    pub fn cases(mut self, cases: u64) -> Self {
        self.judge.cases = cases;
        self
    }

    /// With random cases of another seed than 1.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.judge.seed = seed;
        self
    }

    /// With known failures and skips, a TOML file as `lightmeter gate --expect` reads it. A formula whose cases are all among `[[skipped]]`
    /// and for which [`Engine::evaluate`] gives a reason passes, unless no formula is judged at all.
    #[must_use]
    pub fn expectations(mut self, path: impl Into<PathBuf>) -> Self {
        self.judge.expectations = Some(path.into());
        self
    }

    /// With an earlier result, than which nothing may be worse. With the variable `LIGHTMETER_UPDATE_BASELINE` set the result is written
    /// to the file; without it, a file that is not there is an error.
    #[must_use]
    pub fn baseline(mut self, path: impl Into<PathBuf>) -> Self {
        self.judge.baseline = Some(path.into());
        self
    }

    /// Runs the tests that the command line asks for, as any test program does. It is all that the `main` of a test target with
    /// `harness = false` has to do.
    #[must_use]
    pub fn main(self) -> ExitCode {
        let mut arguments = Arguments::from_args();
        // Judging takes all cores by itself.
        arguments.test_threads = arguments.test_threads.or(Some(1));
        if std::env::var_os(UPDATE).is_some_and(|value| !value.is_empty()) && !arguments.list {
            return self.renew();
        }
        match self.judge.begin(self.engine) {
            Ok(judged) => run(&arguments, &Arc::new(judged)),
            Err(error) => {
                eprintln!("{ROOT}: {error}");
                ExitCode::from(FAILED)
            }
        }
    }

    fn renew(&self) -> ExitCode {
        match self.judge.renew(Arc::clone(&self.engine)) {
            Ok(path) => {
                eprintln!("{ROOT}: the baseline {} is this result now", path.display());
                ExitCode::SUCCESS
            }
            Err(error) => {
                eprintln!("{ROOT}: {error}");
                ExitCode::from(FAILED)
            }
        }
    }

    /// The tests, for a program that has others besides.
    ///
    /// # Errors
    /// Where the engine declares what there is not, or a file cannot be read.
    pub fn trials(self) -> Result<Vec<Trial>, HarnessError> {
        Ok(trials(&Arc::new(self.judge.begin(self.engine)?)))
    }
}

/// A test for each formula of an engine.
fn trials(judged: &Arc<Judged>) -> Vec<Trial> {
    let trial = |place: usize| {
        let judged_ = Arc::clone(judged);
        let name = format!("{ROOT}::{}", judged.parts[place].path.replace('/', "::"));
        Trial::test(name, move || {
            let report = judged_.of(&judged_.parts[place]).map_err(|error| Failed::from(error.to_string()))?;
            let Some(complaint) = complaint(&report) else { return Ok(()) };
            annotate(&report);
            Err(Failed::from(complaint))
        })
    };
    (0..judged.parts.len()).map(trial).collect()
}

/// Runs the tests that were asked for. Where formulas pass only because all of them are skipped, that is no success.
fn run(arguments: &Arguments, judged: &Arc<Judged>) -> ExitCode {
    let conclusion = libtest_mimic::run(arguments, trials(judged));
    if conclusion.num_passed > 0 && !arguments.list && !judged.has_judged() {
        eprintln!("{ROOT}: nothing was judged: the engine skips all cases of these tests");
        return ExitCode::from(FAILED);
    }
    conclusion.exit_code()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Formulas;
    use crate::values::FormulaInputs;
    use crate::values::FormulaOutputs;

    fn fog(inputs: &FormulaInputs<'_>, base: f32) -> (f32, [f32; 3]) {
        let f = base.powf(-inputs.float("density") * inputs.vec3("p")[2].abs()).clamp(0.0, 1.0);
        let ([r, g, b], [x, y, z]) = (inputs.vec3("shaded"), inputs.vec3("fog"));
        (f, [(r, x), (g, y), (b, z)].map(|(shaded, fog)| shaded * f + fog * (1.0 - f)))
    }

    #[test]
    fn an_engine_has_a_test_for_each_formula_and_a_baseline() {
        let folder = std::env::temp_dir().join(format!("lightmeter-harness-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder can be made");
        let file = folder.join("baseline.json");
        let suite = |base: f32, cases: u64| {
            let engine = Formulas::new("engine", "1.0").with("fog/exp", move |inputs| fog(inputs, base)).with(
                "color/modulate",
                |inputs| {
                    let (texel, color) = (inputs.vec4("texel"), inputs.vec4("color"));
                    [0, 1, 2, 3].map(|k| texel[k] * color[k])
                },
            );
            Suite::new(engine).cases(cases).baseline(&file)
        };
        let right = suite(std::f32::consts::E, 64);
        right.judge.renew(Arc::clone(&right.engine)).expect("the baseline is written");
        let outcomes = |suite: Suite<Formulas>| {
            let trials = suite.trials().expect("the engine can be judged");
            let names: Vec<String> = trials.iter().map(|trial| trial.name().to_owned()).collect();
            let arguments = Arguments { quiet: true, test_threads: Some(1), ..Arguments::default() };
            (names, libtest_mimic::run(&arguments, trials))
        };
        let (names, conclusion) = outcomes(right);
        assert_eq!(names, ["lightmeter::color::modulate", "lightmeter::fog::exp"]);
        assert_eq!((conclusion.num_passed, conclusion.num_failed), (2, 0));
        assert_eq!(outcomes(suite(2.0, 64)).1.num_failed, 1);
        // A baseline of other cases is told, by every test that is compared with it.
        assert_eq!(outcomes(suite(std::f32::consts::E, 65)).1.num_failed, 2);
        let missing = suite(std::f32::consts::E, 64).baseline(folder.join("basline.json")).trials();
        let error = missing.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("there is no baseline") && error.contains("basline.json"), "{error}");
        let _ = std::fs::remove_dir_all(&folder);
    }

    /// An engine that skips a formula, and has another one.
    struct Skipping;

    impl Engine for Skipping {
        fn name(&self) -> String {
            "skipping".into()
        }

        fn version(&self) -> String {
            "1.2".into()
        }

        fn formulas(&self) -> Vec<String> {
            vec!["fog/exp".into(), "color/modulate".into()]
        }

        fn evaluate(&self, formula: &str, inputs: &FormulaInputs<'_>) -> Result<FormulaOutputs, String> {
            if formula == "fog/exp" {
                return Err("it has no fog".into());
            }
            let (texel, color) = (inputs.vec4("texel"), inputs.vec4("color"));
            Ok([0, 1, 2, 3].map(|k| texel[k] * color[k]).into())
        }
    }

    #[test]
    fn skips_that_the_file_of_expectations_names_are_honoured_and_no_others() {
        let folder = std::env::temp_dir().join(format!("lightmeter-harness-skips-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder can be made");
        let file = folder.join("expected.toml");
        let ran = |of: &str, filter: &str| {
            let text = format!("[[skipped]]\nid = \"fog/exp\"\nreason = \"not built\"\n{of}");
            std::fs::write(&file, text).expect("it can be written");
            let judge = Suite::new(Skipping).cases(16).expectations(&file).judge;
            let judged = Arc::new(judge.begin(Arc::new(Skipping)).expect("the engine can be judged"));
            let filter = (!filter.is_empty()).then(|| filter.to_owned());
            let arguments = Arguments { quiet: true, test_threads: Some(1), filter, ..Arguments::default() };
            run(&arguments, &judged)
        };
        let codes =
            [ran("version = \">=1, <2\"\n", ""), ran("", "modulate"), ran("version = \">=2\"\n", ""), ran("", "fog")];
        // The last one judges nothing.
        let failed = ExitCode::from(FAILED);
        let expected = [ExitCode::SUCCESS, ExitCode::SUCCESS, failed, failed];
        assert_eq!(format!("{codes:?}"), format!("{expected:?}"));
        let _ = std::fs::remove_dir_all(&folder);
    }
}
