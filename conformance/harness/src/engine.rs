//! Whose formulas are judged.

use crate::values::{FormulaInputs, FormulaOutputs};
use lightmeter_catalogue::cases::Spec;
use lightmeter_document::by_case::SourcePlace;
use lightmeter_gate::hello::{DeclaredSource, Hello};
use lightmeter_gate::renderer::Renderer;
use std::panic::Location;
use std::sync::Arc;

/// An engine that evaluates formulas.
pub trait Engine: Send + Sync + 'static {
    /// Its name, which reports, baselines and known failures call it by.
    fn name(&self) -> String;

    /// Its version.
    fn version(&self) -> String {
        String::new()
    }

    /// The ids of the formulas that it evaluates, or globs of them: `fog/exp`, `vector/*`.
    fn formulas(&self) -> Vec<String>;

    /// Where its code of a formula stands, which reports show; `None` where that is not told.
    fn source(&self, formula: &str) -> Option<SourcePlace> {
        let _ = formula;
        None
    }

    /// The outputs of a formula. Where it panics, the case fails and is told with its inputs.
    ///
    /// # Errors
    /// Why it does not evaluate this one, which fails the formula's test unless a file of expectations has it among `[[skipped]]`.
    fn evaluate(&self, formula: &str, inputs: &FormulaInputs<'_>) -> Result<FormulaOutputs, String>;
}

type Function = Box<dyn Fn(&FormulaInputs<'_>) -> FormulaOutputs + Send + Sync>;

/// An engine of functions, one for each formula.
pub struct Formulas {
    name: String,
    version: String,
    functions: Vec<(String, Function, SourcePlace)>,
}

impl Formulas {
    /// An engine that has no formula yet.
    #[must_use]
    pub fn new(name: &str, version: &str) -> Self {
        Self { name: name.into(), version: version.into(), functions: vec![] }
    }

    /// The same with the function of one more formula. Reports show the line that calls this.
    #[must_use]
    #[track_caller]
    pub fn with<O: Into<FormulaOutputs>>(
        mut self,
        formula: &str,
        function: impl Fn(&FormulaInputs<'_>) -> O + Send + Sync + 'static,
    ) -> Self {
        let caller = Location::caller();
        let source = SourcePlace { file: caller.file().into(), line: Some(caller.line().into()) };
        self.functions.push((formula.into(), Box::new(move |inputs| function(inputs).into()), source));
        self
    }
}

impl Engine for Formulas {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn version(&self) -> String {
        self.version.clone()
    }

    fn formulas(&self) -> Vec<String> {
        self.functions.iter().map(|(formula, ..)| formula.clone()).collect()
    }

    fn source(&self, formula: &str) -> Option<SourcePlace> {
        self.functions.iter().find(|(own, ..)| own == formula).map(|(.., source)| source.clone())
    }

    fn evaluate(&self, formula: &str, inputs: &FormulaInputs<'_>) -> Result<FormulaOutputs, String> {
        match self.functions.iter().find(|(own, ..)| own == formula) {
            Some((_, function, _)) => Ok(function(inputs)),
            None => Err(format!("{} has no {formula}", self.name)),
        }
    }
}

/// An engine as the gate asks it.
pub(crate) struct AskedEngine<E>(pub(crate) Arc<E>);

impl<E: Engine> Renderer for AskedEngine<E> {
    fn hello(&self) -> Hello {
        let Self(engine) = self;
        let source = |id: &String| {
            let SourcePlace { file, line } = engine.source(id)?;
            Some(DeclaredSource { id: id.clone(), file, line })
        };
        let formulas = engine.formulas();
        let sources = formulas.iter().filter_map(source).collect();
        Hello { renderer: engine.name(), version: engine.version(), formulas, sources, ..Hello::default() }
    }

    fn evaluate(&mut self, spec: &Spec, inputs: &[f32]) -> Result<Vec<f32>, String> {
        self.0.evaluate(&spec.id, &FormulaInputs::new(spec, inputs)).map(|outputs| outputs.0)
    }
}
