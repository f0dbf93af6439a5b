//! `lightmeter show`.

mod about;
mod document;
mod pixel;
mod special;
mod unit;

use super::mistakes::by_name;
use super::options::{Choice, Format};
use super::terminal::level;
use super::{Status, emit, say};
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::arithmetic::{Accept, Profile, Trace, trace};
use lightmeter::cases::blend::{Samples, separate_of, written_state};
use lightmeter::cases::{Kind, boundary_name};
use lightmeter::document::report::Examined;
use lightmeter::document::show::{Conditioning, FormStanding};
use lightmeter::document::show::{ShowDocument, ShownCase, ShownMistake};
use lightmeter::document::{Document as _, Number, error_told};
use lightmeter::evaluate::Evaluator;
use lightmeter::faults::{Fault, Variation, shown_mistake};
use lightmeter::filter::Filter;
use lightmeter::formula::intervals;
use lightmeter::judge::judge;
use lightmeter::nearest::did_you_mean;
use lightmeter::report::Level;
use lightmeter::report::table::{Align, TextTable};
use lightmeter::select::{CaseRef, Member, Shard, canonical_id, catalogue_of};
use lightmeter::stability;
use lightmeter::subject::Subject;
use std::fmt::Write as _;
use std::path::PathBuf;
use unit::{UnitAnswer, drawn, unit_text};

/// Show a case with each step, its interval and what the adapter gives; or what is known of any other name.
///
/// A case is as `fog/linear/hard/dmin-equals-dmax`, `lighting/phong/random/000017` or, of a scene, `scene/phong/120-96`. Any other name
/// may be a formula's (`lighting/blinn`), a family's (`fog`), a scene's (`scene/phong`), a mistake's (`fog-radial`), a deviation's
/// (`deviation/llvmpipe-exp`), a ruling's (`ruling/9`) or a source document's (`004`).
#[derive(Debug, Args)]
pub(crate) struct Show {
    /// The case, or another name
    #[arg(value_name = "NAME")]
    id: String,
    /// Print the WGSL instead: a formula's function, or the shaders that a scene's objects are drawn by
    #[arg(long)]
    wgsl: bool,
    #[command(flatten)]
    choice: Choice,
    /// Show what a renderer with this mistake gives, too; `lightmeter mistakes` lists them
    #[arg(long, value_name = "NAME", value_parser = by_name)]
    mistake: Option<&'static Fault>,
    /// How the case is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// A stage's answer on a subject.
struct Answer {
    adapter: String,
    stage: &'static str,
    values: Result<Vec<(u32, Accept)>, &'static str>,
}

/// What is known of the case without a renderer.
struct Known {
    inputs: Vec<f32>,
    outputs: Vec<Trace>,
    steps: Vec<trace::TraceStep>,
    condition: Vec<f64>,
    conditioning: Conditioning,
}

impl Show {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let as_json = self.format == Format::Json;
        let written = written_state(&self.id).transpose().map_err(anyhow::Error::msg)?;
        let named = separate_of(written.as_deref().unwrap_or(&self.id)).into_iter().collect();
        let catalogue = catalogue_of(&Samples { seed: self.choice.seed, named, ..Samples::default() });
        if self.is_shown_by_name(&catalogue)? {
            return Ok(Status::Success);
        }
        let others = special::find(&self.id)?.is_some() || pixel::find(&self.id, self.choice.size)?.is_some();
        if let (Some(fault), true) = (self.mistake, others) {
            bail!("`{}` is a mistake in formulas, and `{}` is no case of one", fault.name, self.id);
        }
        if let Some(probe) = special::find(&self.id)? {
            self.format.emit(&special::show(probe, &self.choice, &self.subjects()?, as_json)?, self.out.as_deref())?;
            return Ok(Status::Success);
        }
        if let Some(found) = pixel::find(&self.id, self.choice.size)? {
            let text = pixel::show(&self.id, &found, &self.choice, &self.subjects()?, as_json)?;
            self.format.emit(&text, self.out.as_deref())?;
            return Ok(Status::Success);
        }
        let (member, case) = find(&catalogue, &self.id)?;
        let mut inputs = vec![];
        member.inputs(case, self.choice.seed, &mut inputs);
        let mut outputs = vec![Trace { value: 0.0, interval: Accept::ANY }; member.spec.output_len()];
        let ((), steps) = trace::record(|| member.formula.trace(&inputs, self.choice.profile, &mut outputs));
        legal_outputs(member, &inputs, self.choice.profile, &mut outputs);
        let condition = member.formula.condition(&inputs);
        let legal: Vec<Accept> = outputs.iter().map(|output| output.interval).collect();
        let near: Vec<Vec<f32>> = match case {
            CaseRef::Hard(place) => (0..member.near()).map(|k| self.row(member, CaseRef::Near(place, k))).collect(),
            CaseRef::Near(..) | CaseRef::Boundary(_) | CaseRef::Random(_) => vec![],
        };
        let conditioning = stability::conditioning(member, &inputs, &legal, &near);
        let known = Known { inputs, outputs, steps, condition, conditioning };
        let (answers, unit) = self.answers(member, &known.inputs)?;
        let forms = self.forms(member, case)?;
        let mistake = self.mistake.map(|fault| self.mistaken(fault, member, &known.inputs)).transpose()?;
        let text = if as_json {
            let case = document::case(member, case, &known, &answers, &unit, forms);
            ShowDocument::Case(Box::new(ShownCase { mistake, ..case })).to_json()?
        } else {
            let mistake = mistake.map_or_else(String::new, |mistake| mistake_text(&mistake, &known.outputs));
            as_text(member, case, &known, &answers)? + &mistake + &unit_text(&unit)? + &forms_text(&forms)?
        };
        self.format.emit(&text, self.out.as_deref())?;
        Ok(Status::Success)
    }

    /// Shows what is known of a name that is no case, or its code where that is asked for; whether it is such a name.
    fn is_shown_by_name(&self, catalogue: &[Member]) -> anyhow::Result<bool> {
        if self.wgsl {
            emit(&about::wgsl(&self.id, catalogue)?, self.out.as_deref())?;
            return Ok(true);
        }
        let found = match about::about(&self.id, catalogue)? {
            None if !self.id.contains('/') => about::containing(&self.id, catalogue)?,
            found => found,
        };
        if let Some(text) = found {
            if let Some(fault) = self.mistake {
                bail!(
                    "`{}` is not a case, so there is nothing to compute with the mistake `{}`; name a case, such as `fog/exp/random/000017`",
                    self.id,
                    fault.name
                );
            }
            if self.format == Format::Json {
                bail!(
                    "`{}` is no case: `list --formulas --format json` describes formulas, and `mistakes NAME --format json` mistakes",
                    self.id
                );
            }
            self.format.emit(&text, self.out.as_deref())?;
            return Ok(true);
        }
        Ok(false)
    }

    /// What a renderer with a mistake gives.
    fn mistaken(&self, fault: &'static Fault, member: &Member, inputs: &[f32]) -> anyhow::Result<ShownMistake> {
        let variation = Variation::new(member, &[fault]);
        let variation = variation.with_context(|| format!("`{}` does not concern {}", fault.name, member.spec.id))?;
        Ok(shown_mistake(&variation, member, inputs, self.choice.profile))
    }

    fn row(&self, member: &Member, case: CaseRef) -> Vec<f32> {
        let mut row = vec![];
        member.inputs(case, self.choice.seed, &mut row);
        row
    }

    /// A hard case, and those near it, by its stable and its naive form.
    fn forms(&self, member: &Member, case: CaseRef) -> anyhow::Result<Vec<Examined>> {
        let (CaseRef::Hard(place) | CaseRef::Near(place, _)) = case else { return Ok(vec![]) };
        let mut subjects = self.subjects()?;
        let options = self.choice.options(Filter::default(), 1, Shard::WHOLE)?;
        let mut report = options.report(&subjects);
        stability::examine(member, &[place], &mut subjects, &options, &mut report)?;
        Ok(report.stability)
    }

    fn subjects(&self) -> anyhow::Result<Vec<Subject>> {
        match self.choice.subjects() {
            Err(error) if self.choice.adapter.is_empty() => {
                say(&format!("note: {error:#}"));
                Ok(vec![])
            }
            subjects => subjects,
        }
    }

    /// Without an adapter that was asked for, a machine without a driver still shows the case.
    fn answers(&self, member: &Member, inputs: &[f32]) -> anyhow::Result<(Vec<Answer>, Vec<UnitAnswer>)> {
        let (code, subjects) = (self.choice.code(&Filter::new(&[&member.spec.id])?, false)?, self.subjects()?);
        let (mut answers, mut unit, members) = (vec![], vec![], [member]);
        for mut subject in subjects {
            if let Kind::Blend(program) = member.spec.kind {
                unit.extend(drawn(
                    &self.choice.targets(),
                    &mut subject,
                    &code,
                    member,
                    program,
                    inputs,
                    self.choice.profile,
                )?);
            }
            if member.spec.row_stages().is_empty() {
                continue;
            }
            let evaluator = Evaluator::new(&mut subject, &members, &code)?;
            for (stage, words) in evaluator.run(&mut subject, &[0], inputs)? {
                let mut legal = vec![Accept::ANY; member.spec.output_len()];
                let profile = self.choice.profile;
                intervals(member, inputs, stage, &subject.known, profile, &mut legal);
                let values = words.map(|words| words.into_iter().zip(legal).collect());
                answers.push(Answer { adapter: subject.identity.name.clone(), stage: stage.name(), values });
            }
        }
        Ok((answers, unit))
    }
}

/// What a rasteriser may give is not what its formula in f32 may: where no device is known, by the profile's promise.
fn legal_outputs(member: &Member, inputs: &[f32], profile: &Profile, outputs: &mut [Trace]) {
    let mut legal = vec![Accept::ANY; outputs.len()];
    member.formula.promised_interval(member.spec.kind, inputs, profile, &mut legal);
    for (output, legal) in outputs.iter_mut().zip(legal) {
        output.interval = legal;
    }
}

/// The case of an id, which may name an alias.
fn find<'a>(catalogue: &'a [Member], id: &str) -> anyhow::Result<(&'a Member, CaseRef)> {
    let canonical = canonical_id(id);
    let id = canonical.as_str();
    if let Some(found) = catalogue
        .iter()
        .find_map(|member| member.case(id).filter(|&case| member.case_id(case) == id).map(|case| (member, case)))
    {
        return Ok(found);
    }
    match catalogue.iter().find(|member| id == member.spec.id || id.starts_with(&format!("{}/", member.spec.group()))) {
        Some(member) => {
            let group = member.spec.group();
            let cases: Vec<String> =
                (0..member.spec.hard.len()).map(|place| member.case_id(CaseRef::Hard(place))).collect();
            let meant = did_you_mean(id, cases.iter().map(String::as_str));
            let such = member.case_id(CaseRef::Random(0));
            bail!("no case `{id}`{meant} `{group}` has cases such as `{such}`: see `lightmeter list '{group}'`")
        }
        None => {
            let names = about::names(catalogue);
            let meant = did_you_mean(id, names.iter().map(String::as_str));
            bail!(
                "there is no `{id}`{meant} `lightmeter list` lists formulas and cases, `lightmeter mistakes` mistakes"
            )
        }
    }
}

/// What a renderer with a mistake gives, and whether it would fail.
fn mistake_text(mistake: &ShownMistake, outputs: &[Trace]) -> String {
    let mut text = format!("\nas if {}\n", mistake.says);
    let left = Align::Left;
    if !mistake.steps.is_empty() {
        let mut table = TextTable::new(&[("steps at which it shows", left), ("right", left), ("mistaken", left)]);
        for step in &mistake.steps {
            table.row([step.name.to_string(), step.right.narrow().to_string(), step.made.narrow().to_string()]);
        }
        text += &table.text("  ");
        text.push('\n');
    }
    let headings = ["", "outputs", "value", "such a renderer gives from", "to"].map(|heading| (heading, left));
    let mut table = TextTable::new(&headings);
    for (made, right) in mistake.outputs.iter().zip(outputs) {
        let mark = if right.interval.contains(made.value.0) { "" } else { "✗" };
        let [value, low, high] = [&made.value, &made.interval[0], &made.interval[1]].map(|x| x.narrow().to_string());
        table.row([mark.to_owned(), made.name.to_string(), value, low, high]);
    }
    text + &table.text("")
}

fn outcome(bits: u32, reference: f64, legal: &Accept) -> (&'static str, f64) {
    let verdict = judge(bits, reference, legal);
    (verdict.outcome.name(), verdict.error)
}

fn as_text(member: &Member, case: CaseRef, known: &Known, answers: &[Answer]) -> anyhow::Result<String> {
    let mut text = String::new();
    let spec = &member.spec;
    writeln!(text, "{}\n  {}  ({})", member.case_id(case), spec.text, spec.source)?;
    if let CaseRef::Hard(place) = case {
        writeln!(text, "  pins: {}", spec.hard[place].pins)?;
    }
    if let CaseRef::Near(place, _) = case {
        writeln!(text, "  near: {} ({})", spec.hard[place].name, spec.hard[place].pins)?;
    }
    if let CaseRef::Boundary(k) = case
        && let Some(near) = boundary_name(spec, k)
    {
        writeln!(text, "  boundary: {near}")?;
    }
    for rule in spec.rules() {
        writeln!(text, "  rule: {rule}")?;
    }
    text += &inputs_text(member, known)?;
    writeln!(text, "\nsteps                f64                    legal")?;
    for (step, name) in known.steps.iter().zip(step_names(&known.steps)) {
        writeln!(text, "  {name:<18} {:<22} {}", Number(step.result.value).narrow(), range(&step.result.interval))?;
    }
    writeln!(text, "\noutputs              reference              legal")?;
    for (k, output) in known.outputs.iter().enumerate() {
        let condition = three_digits(known.condition[k]);
        writeln!(
            text,
            "  {:<18} {:<22} {}  condition {condition}",
            spec.output_name(k),
            Number(output.value).narrow(),
            range(&output.interval)
        )?;
    }
    for output in spec.outputs {
        writeln!(text, "  {}: {}", output.name, spec.output_means(output))?;
    }
    writeln!(text, "\nconditioning\n  {}", stability::text(&known.conditioning))?;
    let is_promised_less =
        matches!(known.conditioning.standing, FormStanding::Unstable | FormStanding::NothingPromised);
    if let Some(stable) = spec.stable.filter(|_| is_promised_less) {
        writeln!(
            text,
            "  with its operations as they are written the form claims {} roundings at its hard cases",
            stable.bound
        )?;
    }
    for answer in answers {
        text += &answer_text(member, known, answer)?;
    }
    Ok(text)
}

fn inputs_text(member: &Member, known: &Known) -> anyhow::Result<String> {
    let mut text = String::new();
    writeln!(text, "\ninputs")?;
    let mut rest = known.inputs.as_slice();
    for input in member.spec.inputs {
        let (these, others) = rest.split_at(input.shape.components());
        rest = others;
        let decimal: Vec<String> = these.iter().map(|&x| Number(x.into()).narrow()).collect();
        let is_nan = these.iter().any(|x| x.is_nan());
        let hex = |x: &f32| format!(" 0x{:08x}", x.to_bits());
        let hex: String =
            if is_nan || level() == Level::Verbose { these.iter().map(hex).collect() } else { String::new() };
        let means = member.spec.input_means(input);
        writeln!(text, "  {:<18} {}{hex}  {}: {means}", input.name, decimal.join(" "), input.unit)?;
    }
    Ok(text)
}

fn answer_text(member: &Member, known: &Known, answer: &Answer) -> anyhow::Result<String> {
    let mut text = String::new();
    writeln!(text, "\n{}, {}", answer.adapter, answer.stage)?;
    match &answer.values {
        Err(reason) => writeln!(text, "  skipped: {reason}")?,
        Ok(values) => {
            for (k, (bits, legal)) in values.iter().enumerate() {
                let value = Number(f32::from_bits(*bits).into()).narrow();
                let (outcome, error) = outcome(*bits, known.outputs[k].value, legal);
                let name = member.spec.output_name(k);
                writeln!(
                    text,
                    "  {name:<18} {value:<14} 0x{bits:08x}  {outcome}, {}; legal {}",
                    error_told(Number(error), "ULP"),
                    range(legal)
                )?;
            }
        }
    }
    Ok(text)
}

fn forms_text(forms: &[Examined]) -> anyhow::Result<String> {
    let mut text = String::new();
    for one in forms {
        let near = |roundings: Number| format!("{} roundings", Number((roundings.0 * 100.0).round() / 100.0));
        writeln!(
            text,
            "\nforms on {}, {}, here and within a few ULP\n  stable  {} at most, bound {}{}\n  naive   {}: {} ({})",
            one.adapter,
            one.stage,
            near(one.stable),
            one.bound,
            if one.is_stable() { "" } else { ": broken" },
            one.naive_formula,
            if one.naive.0.is_finite() { near(one.naive) } else { "no number".into() },
            one.fails
        )?;
    }
    Ok(text)
}

/// The steps' names; what is named several times in a row, as a vector's components are, is numbered.
fn step_names(steps: &[trace::TraceStep]) -> Vec<String> {
    let mut names = vec![];
    for run in steps.chunk_by(|a, b| a.name == b.name) {
        match run {
            [step] => names.push(step.name.to_owned()),
            _ => names.extend((1..).zip(run).map(|(number, step)| format!("{} {number}", step.name))),
        }
    }
    names
}

/// A number to three digits.
fn three_digits(x: f64) -> String {
    match x.abs() {
        size if size == 0.0 || (0.01..1e4).contains(&size) => {
            let text = format!("{x:.2}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ if x.is_finite() => format!("{x:.2e}"),
        _ => Number(x).to_string(),
    }
}

fn range(interval: &Accept) -> String {
    if interval.is_any() {
        "anything".into()
    } else {
        // The sign of a zero may be lost, so that none is told.
        let end = |x: f64| Number(x + 0.0).narrow();
        format!("{} to {}", end(interval.low()), end(interval.high()))
    }
}
