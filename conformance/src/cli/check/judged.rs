//! Steps that are judged as formulas: the review says which a step is, the engine whether its values are legal.
//!
//! What a shader computes between the values that a step is of and the step's own is a function in WGSL; what else the step's formula is of
//! stands around it, right. An adapter computes that, or the suite's own evaluation of shaders in f32.

use super::super::visit::opened;
use anyhow::anyhow;
use lightmeter::arithmetic::Profile;
use lightmeter::cases::Spec;
use lightmeter::device::Code;
use lightmeter::document::event::Silent;
use lightmeter::document::report::{
    FailingStep, Failure, Group, JudgedStep, Report, ShaderReview, ShaderStep, StepVerdict,
};
use lightmeter::document::{Number, thousands};
use lightmeter::faults::Mistakes;
use lightmeter::filter::Filter;
use lightmeter::gate::hello::Hello;
use lightmeter::gate::renderer::{InProcess, Renderer};
use lightmeter::options::{Adapted, Constant, Options};
use lightmeter::run::run;
use lightmeter::select::{Member, catalogue};
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::code;
use lightmeter_adapt::bind::{AskedBinding, bind};
use lightmeter_adapt::step::{FUNCTION, StepFormula, formula_of_form, step_formula};
use lightmeter_adapt::{Part, ShaderProgram, replaced};
use lightmeter_gpu::Shaders;
use lightmeter_shaders::EvaluatedFunction;
use lightmeter_shaders::read::{Language, ShaderSource};
use std::collections::HashMap;
use std::path::Path;

/// Fewer random cases than that show of no mistake that it is none.
const FEW: u64 = 100;
/// The name of a step that was taken for right, and that its formula contradicts.
const CONTRADICTED: &str = "contradicted";

/// Who computes steps, and how they are judged.
pub(super) struct Judge {
    /// The adapter; none for the suite's own evaluation in f32.
    subjects: Option<(String, Vec<Subject>, Shaders)>,
    profile: &'static Profile,
    cases: u64,
    catalogue: Vec<Member>,
    known: HashMap<StepFormula, JudgedStep>,
}

/// A step that is computed here.
struct Evaluated {
    function: EvaluatedFunction,
    formula: String,
}

impl Renderer for Evaluated {
    fn hello(&self) -> Hello {
        let (renderer, version) = ("f32".into(), env!("CARGO_PKG_VERSION").into());
        Hello { renderer, version, formulas: vec![self.formula.clone()], ..Hello::default() }
    }

    fn evaluate(&mut self, _: &Spec, inputs: &[f32]) -> Result<Vec<f32>, String> {
        self.function.rows(std::iter::once(inputs)).pop().ok_or_else(|| "it has no value".into())
    }
}

impl Judge {
    /// Opens an adapter, unless there is to be none.
    pub(super) fn new(adapter: Option<&str>, profile: &'static Profile, cases: u64) -> anyhow::Result<Self> {
        let open = |name: &str| anyhow::Ok((name.to_owned(), opened(&[name.to_owned()])?, Shaders::built_in()?));
        let subjects = adapter.map(open).transpose()?;
        Ok(Self { subjects, profile, cases, catalogue: catalogue(), known: HashMap::new() })
    }

    /// Judges the steps of a shader, and says of each what that changes.
    pub(super) fn judge(&mut self, shader: &mut ShaderReview) -> anyhow::Result<()> {
        for step in &mut shader.steps {
            if let Some(own) = self.formula(step) {
                let judged = match self.known.get(&own) {
                    Some(known) => known.clone(),
                    None => self.judged(&own)?,
                };
                self.known.insert(own, judged.clone());
                confirm(step, judged);
            }
        }
        Ok(())
    }

    fn formula(&self, step: &ShaderStep) -> Option<StepFormula> {
        let function = step.function.as_ref()?;
        let id = formula_of_form(&function.form)?;
        let member = self.catalogue.iter().find(|member| member.spec.id == id)?;
        step_formula(function, &member.spec)
    }

    /// What becomes of a step. Only what ends the whole command is an error.
    fn judged(&mut self, own: &StepFormula) -> anyhow::Result<JudgedStep> {
        let by = self.subjects.as_ref().map_or("f32", |(name, ..)| name).to_owned();
        let judged = JudgedStep { formula: own.id.into(), by, ..JudgedStep::default() };
        match self.reported(own) {
            Ok(report) => Ok(counted(&report, self.cases, judged)),
            Err(error) => {
                // A device that is lost costs this step.
                if let Some((name, subjects, _)) = &mut self.subjects {
                    *subjects = opened(std::slice::from_ref(name))?;
                }
                Ok(JudgedStep { problem: Some(format!("{error:#}")), ..judged })
            }
        }
    }

    fn reported(&mut self, own: &StepFormula) -> anyhow::Result<Report> {
        let spec =
            &self.catalogue.iter().find(|member| member.spec.id == own.id).ok_or_else(|| anyhow!("no formula"))?.spec;
        let code = match &self.subjects {
            Some((.., shaders)) => code(with_step(shaders, own, spec)?),
            None => Code::default(),
        };
        let mut options = Options::by(code, None, 1, self.profile);
        options.filter = Filter::new(&[own.id])?;
        options.cases = self.cases;
        options.diagnose = Some(&Mistakes);
        options.counts_cases = true;
        let numbers = |bits: &[u32]| Constant::Numbers(bits.iter().map(|own| f32::from_bits(*own)).collect());
        let held = own.numbers.iter().map(|(name, bits)| ((*name).to_owned(), numbers(bits)));
        let same = own.same.iter().map(|(name, other)| ((*name).to_owned(), Constant::SameAs((*other).to_owned())));
        let constants = held.chain(same).collect();
        options.adapted = vec![Adapted { id: own.id.into(), constants, ..Adapted::default() }];
        if let Some((_, subjects, _)) = &mut self.subjects {
            return Ok(run(subjects, &options, &mut Silent)?);
        }
        let function = EvaluatedFunction::new(&own.wgsl, FUNCTION).map_err(|error| anyhow!(error))?;
        let renderer = InProcess::new(Evaluated { function, formula: own.id.into() }, std::env::temp_dir())?;
        Ok(run(&mut [Subject::renderer(renderer.identity(), Box::new(renderer))], &options, &mut Silent)?)
    }
}

/// The suite's shaders, in which a formula's function is of a step.
fn with_step(shaders: &Shaders, own: &StepFormula, spec: &Spec) -> anyhow::Result<Shaders> {
    let path = Path::new("step.wgsl");
    let source = ShaderSource::of_text(path, &own.wgsl, Language::Wgsl)?;
    let program = ShaderProgram::new(path, &source, &Part::Function(FUNCTION.into()))?;
    let itself =
        |input: &lightmeter::cases::Input| AskedBinding { name: input.name.into(), expression: input.name.into() };
    let asked: Vec<AskedBinding> = spec.inputs.iter().map(itself).collect();
    let binding = bind(&program, spec, &asked)?;
    let mut shaders = shaders.clone();
    for (name, text) in replaced(&shaders, &program, &[(spec, binding)])? {
        shaders = shaders.with(&name, text)?;
    }
    Ok(shaders)
}

/// The numbers of a list such as `random/000003..000017`.
fn number_of(entry: &str) -> u64 {
    let ends = entry.rsplit('/').next().and_then(|own| own.split_once(".."));
    let count = ends.and_then(|(from, to)| Some(to.parse::<u64>().ok()?.saturating_sub(from.parse().ok()?) + 1));
    count.unwrap_or(1)
}

fn counted(report: &Report, random: u64, mut judged: JudgedStep) -> JudgedStep {
    for group in &report.groups {
        count(group, &mut judged);
    }
    let stages =
        report.groups.iter().filter(|group| group.by_case.as_ref().is_some_and(|own| own.totals.asked > 0)).count();
    judged.random = random.saturating_mul(stages as u64).min(judged.hard);
    judged.hard -= judged.random;
    let random = report.failures.iter().find(|failure| failure.id.contains("/random/"));
    judged.failing =
        random.or_else(|| report.failures.first()).map(|Failure { id, output, value, interval, .. }| {
            let [low, high] = interval;
            let [value, low, high] = [value, low, high].map(|own| short(own.0));
            let legal = if low == high { format!("only {low}") } else { format!("{low} to {high}") };
            FailingStep { id: id.clone(), says: format!("{output} is {value}, where {legal} is legal") }
        });
    judged
}

/// A number with as many digits as f32 has.
fn short(number: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "a message has as many digits as f32")]
    let own = number as f32;
    Number(own.to_string().parse().unwrap_or(number)).to_string()
}

fn count(group: &Group, judged: &mut JudgedStep) {
    let Some(cases) = &group.by_case else { return };
    let failed = cases.not_passed.get("failed").map_or(&[][..], Vec::as_slice);
    let random: u64 = failed.iter().filter(|own| own.starts_with("random/")).map(|own| number_of(own)).sum();
    judged.random_wrong += random;
    judged.hard_wrong += cases.totals.failed.saturating_sub(random);
    judged.explanation = judged.explanation.take().or_else(|| group.cause());
    judged.hard += cases.totals.asked;
}

/// What a judgement makes of a step: what contradicts the review is open.
fn confirm(step: &mut ShaderStep, judged: JudgedStep) {
    let is_judged = judged.problem.is_none() && judged.random > 0;
    // Many cases are needed to see that something is not there.
    let is_seen = judged.is_wrong() || judged.hard_wrong > 0 || judged.random < FEW;
    let told = match step.verdict {
        StepVerdict::Mistake if is_judged && !is_seen => {
            let (wrong, random) = (thousands(judged.random_wrong), thousands(judged.random));
            let wrong = if judged.random_wrong == 0 { "none".to_owned() } else { format!("only {wrong}") };
            Some(format!("yet by {} {wrong} of {random} random cases shows it", judged.formula))
        }
        StepVerdict::Right | StepVerdict::Dialect if judged.is_wrong() => {
            step.name = CONTRADICTED.into();
            let why = judged.explanation.as_ref().map_or_else(String::new, |why| format!(": {why}"));
            judged.says().map(|said| said + &why)
        }
        _ => None,
    };
    if let Some(told) = told {
        step.verdict = StepVerdict::Perhaps;
        step.sentence = format!("{}; {told}", step.sentence);
    }
    step.judged = Some(judged);
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter::arithmetic::profile::WGSL;
    use lightmeter_adapt::step::judged_forms;
    use lightmeter_shaders::forms;

    #[test]
    fn each_form_is_what_its_formula_says_or_the_engine_sees_that_it_is_not() {
        let (mut judge, forms) =
            (Judge::new(None, &WGSL, 256).expect("f32 needs nothing"), forms().expect("forms are built in"));
        for (form, formula) in judged_forms() {
            let (verdict, function) = forms.iter().find(|(_, own)| own.form == form).expect(form);
            let member = judge.catalogue.iter().find(|member| member.spec.id == formula).expect(formula);
            let own = step_formula(function, &member.spec).expect(form);
            let judged = judge.judged(&own).expect("nothing ends");
            assert_eq!(judged.problem, None, "{form}");
            assert!(judged.random > 0, "{form}");
            match verdict {
                StepVerdict::Mistake => assert!(judged.is_wrong(), "{form}: {judged:?}"),
                _ => assert_eq!(judged.random_wrong, 0, "{form}: {judged:?}"),
            }
        }
    }

    #[test]
    fn what_contradicts_the_review_is_open() {
        let step = |verdict| ShaderStep {
            line: 1,
            also: vec![],
            kind: "lambert".into(),
            verdict,
            name: String::new(),
            sentence: "Lambert's cosine".into(),
            accepted: false,
            code: String::new(),
            function: None,
            judged: None,
        };
        let by = |verdict, random: u64, random_wrong, hard_wrong| {
            let mut own = step(verdict);
            let formula = "lighting/diffuse-toward".into();
            let judged = JudgedStep { formula, random, random_wrong, hard: 9, hard_wrong, ..JudgedStep::default() };
            confirm(&mut own, judged);
            (own.verdict, own.sentence.split("; ").nth(1).map(str::to_owned))
        };
        let of = |verdict, random_wrong| by(verdict, 256, random_wrong, 0);
        let wrong = "by lighting/diffuse-toward, 3 of 256 random cases are wrong";
        assert_eq!(of(StepVerdict::Right, 0), (StepVerdict::Right, None));
        assert_eq!(of(StepVerdict::Right, 2), (StepVerdict::Right, None));
        assert_eq!(of(StepVerdict::Right, 3), (StepVerdict::Perhaps, Some(wrong.into())));
        let unseen = "yet by lighting/diffuse-toward only 2 of 256 random cases shows it";
        assert_eq!(of(StepVerdict::Mistake, 2), (StepVerdict::Perhaps, Some(unseen.into())));
        let none = "yet by lighting/diffuse-toward none of 256 random cases shows it";
        assert_eq!(of(StepVerdict::Mistake, 0), (StepVerdict::Perhaps, Some(none.into())));
        assert_eq!(of(StepVerdict::Mistake, 200), (StepVerdict::Mistake, None));
        // A hard case shows a mistake too, and few random ones do not show that there is none.
        assert_eq!(by(StepVerdict::Mistake, 256, 0, 1), (StepVerdict::Mistake, None));
        assert_eq!(by(StepVerdict::Mistake, 2, 0, 0), (StepVerdict::Mistake, None));
        assert_eq!(by(StepVerdict::Right, 256, 0, 9), (StepVerdict::Right, None));
    }
}
