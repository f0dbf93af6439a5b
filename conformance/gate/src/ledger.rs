//! What was asked, and what was answered: each answer judged as it comes.

use super::answer::{self, Hello, Line, clipped};
use super::error::ProcessError;
use super::expectations::{Expectations, ExpectedFailure};
use super::known::{CaseState, Register, Turn, digest};
use super::picture;
use super::plan::{CasePlace, GatePlan};
use super::problems::note;
use super::tally::AnswerTally;
use super::verdict::{self, Verdicts};
use lightmeter_arithmetic::Profile;
use lightmeter_document::Number;
use lightmeter_document::gate::{GateFailure, Problems};
use lightmeter_document::run::Totals;
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::Path;
use std::time::SystemTime;

/// Unstable cases that are kept.
const KEPT_UNSTABLE: usize = 1000;
/// Failing cases of each formula that are asked once more.
const MOST_AGAIN: usize = 1024;

/// The state of a gate. It grows with the number of cases by some bytes each, and not with their answers.
pub struct Ledger<'a> {
    plan: &'a GatePlan,
    profile: Profile,
    known: Register,
    /// Of each formula, and then of each scene.
    pub tallies: Vec<AnswerTally>,
    /// Answers that are none.
    pub problems: Problems,
    /// Cases whose second answer was another, by id: the first of them.
    pub unstable: Vec<String>,
    /// How many those are.
    pub unstable_count: u64,
    /// Register failures of any renderer.
    pub expected: Expectations,
    /// Those of this one.
    pub expectations: Vec<ExpectedFailure>,
    /// Whether the accuracy rules stay, whatever the renderer asks for.
    pub is_held_to: bool,
    /// What lines are of, where there is more than one file: it stands before their numbers.
    pub source: Option<String>,
    /// When a scene was asked for, by its place: an image that is older is no answer.
    pub(super) asked: HashMap<usize, SystemTime>,
}

/// What an answer comes to, before it is counted.
enum Judged {
    Problem(&'static str, String),
    Skip(CasePlace, String),
    Error(CasePlace, String),
    Case { formula: usize, case: usize, digest: u32, verdicts: Box<Verdicts>, values: Vec<f32>, inputs: Vec<f32> },
    Image(usize, String),
}

impl<'a> Ledger<'a> {
    /// Nothing is answered yet.
    #[must_use]
    pub fn new(plan: &'a GatePlan, profile: &Profile) -> Self {
        let outputs = |formula: usize| plan.member(formula).spec.output_len();
        Self {
            plan,
            profile: *profile,
            known: Register::new(plan),
            tallies: (0..plan.formulas.len())
                .map(outputs)
                .chain(plan.scenes.iter().map(|_| 0))
                .map(AnswerTally::new)
                .collect(),
            problems: Problems::default(),
            unstable: vec![],
            unstable_count: 0,
            expected: Expectations::default(),
            expectations: vec![],
            is_held_to: false,
            source: None,
            asked: HashMap::new(),
        }
    }

    /// The accuracy rules.
    #[must_use]
    pub const fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The plan.
    #[must_use]
    pub const fn plan(&self) -> &'a GatePlan {
        self.plan
    }

    /// What is known of each case.
    #[must_use]
    pub const fn known(&self) -> &Register {
        &self.known
    }

    /// Counts what was asked and never answered.
    pub fn close(&mut self) {
        for tally in &mut self.tallies {
            tally.missing = tally.asked.saturating_sub(tally.answered() + tally.skipped + tally.unjudged);
        }
    }

    fn tally(&mut self, place: CasePlace) -> &mut AnswerTally {
        let group = self.known.group(place);
        &mut self.tallies[group]
    }

    /// The cases that are to be asked of who says hello, formulas first. What it does not declare is counted as not asked.
    ///
    /// # Errors
    /// Where what it declares cannot be read.
    pub fn begin(&mut self, hello: &Hello) -> Result<Vec<CasePlace>, ProcessError> {
        self.expectations = self.expected.of(&hello.renderer, &hello.version);
        if let Some(name) = hello.profile.as_ref().filter(|_| !self.is_held_to) {
            let profile = Profile::by_name(name).ok_or_else(|| ProcessError::Profile(name.clone()))?;
            self.profile = *profile;
        }
        let [formulas, scenes] = hello.filters()?;
        let mut asked = vec![];
        for formula in 0..self.plan.formulas.len() {
            let id = &self.plan.member(formula).spec.id;
            if !formulas.as_ref().is_some_and(|filter| filter.selects(id)) {
                self.tallies[formula].undeclared = Some("not among the formulas that it declares".into());
                continue;
            }
            let count = self.plan.formulas[formula].count();
            self.tallies[formula].asked = count as u64;
            asked.extend((0..count).map(|case| CasePlace::Case { formula, case }));
        }
        for scene in 0..self.plan.scenes.len() {
            let place = CasePlace::Scene(scene);
            let (id, (_, frame)) = (self.plan.id(place), self.plan.frame(scene)?);
            let lacks = if scenes.as_ref().is_some_and(|filter| filter.selects(&id)) {
                hello.lacks(&frame)
            } else {
                Some("not among the scenes that it declares".into())
            };
            let tally = self.tally(place);
            if lacks.is_some() {
                tally.undeclared = lacks;
            } else {
                tally.asked = 1;
                asked.push(place);
            }
        }
        Ok(asked)
    }

    /// From here on every case may be answered once more, and must be answered the same.
    pub fn begin_again(&mut self) {
        self.known.begin_again();
    }

    /// What failed, to be asked once more: of each formula so many at most, evenly spread.
    #[must_use]
    pub fn failing(&self) -> Vec<CasePlace> {
        let of = |group: usize| {
            let failing: Vec<CasePlace> =
                self.known.of(group, |state| matches!(state, CaseState::Failed | CaseState::Unjudged)).collect();
            let stride = failing.len().div_ceil(MOST_AGAIN).max(1);
            failing.into_iter().step_by(stride)
        };
        (0..self.tallies.len()).flat_map(of).collect()
    }

    /// What an earlier run answered and this one did not has changed, but for formulas that were given up.
    pub fn end_again(&mut self, is_given_up: impl Fn(usize) -> bool) {
        let was_asked = |place: &CasePlace| !matches!(place, CasePlace::Case { formula, .. } if is_given_up(*formula));
        let left: Vec<CasePlace> = self.known.unanswered_again().filter(was_asked).collect();
        left.into_iter().for_each(|place| self.changed(place));
    }

    /// Notes that a case's answer has changed.
    pub(super) fn changed(&mut self, place: CasePlace) {
        self.unstable_count += 1;
        if self.unstable.len() < KEPT_UNSTABLE {
            self.unstable.push(self.plan.id(place));
        }
    }

    /// Judges lines that were read already.
    pub(super) fn read(&mut self, lines: Vec<(u64, Line<'_>)>, folder: &Path) {
        let judged: Vec<Judged> = lines.into_iter().map(|(number, line)| self.judge_line(number, line)).collect();
        for judged in judged {
            self.count(judged, folder);
        }
    }

    /// Judges lines, each with its number; images lie in the folder. A second answer to a case is a problem, unless it is
    /// asked for once more: then it must be the first.
    pub fn lines(&mut self, lines: &[(u64, Vec<u8>)], folder: &Path) {
        let judged: Vec<Judged> = lines
            .par_chunks(256)
            .flat_map_iter(|lines| lines.iter().map(|(number, line)| self.judge(*number, line)).collect::<Vec<_>>())
            .collect();
        for judged in judged {
            self.count(judged, folder);
        }
    }

    /// A line's number, as it is told.
    pub(super) fn line(&self, number: u64) -> String {
        self.source.as_ref().map_or_else(|| format!("line {number}"), |source| format!("{source}, line {number}"))
    }

    fn judge(&self, number: u64, line: &[u8]) -> Judged {
        match answer::read(line) {
            Ok(line) => self.judge_line(number, line),
            Err(message) => Judged::Problem("malformed", format!("{}: {message}", self.line(number))),
        }
    }

    fn judge_line(&self, number: u64, line: Line<'_>) -> Judged {
        let id = match &line {
            Line::Hello(_) => {
                let message = format!("{}: a hello, which is said once and first", self.line(number));
                return Judged::Problem("malformed", message);
            }
            Line::Value(id, _) | Line::Image(id, _) | Line::Skip(id, _) | Line::Error(id, _) => id,
        };
        let unknown = |what: String| Judged::Problem("unknown", format!("{}: {what}", self.line(number)));
        let Some(place) = self.plan.find(id) else {
            return unknown(format!("no case `{}` was asked for", clipped(id)));
        };
        if self.tallies[self.known.group(place)].undeclared.is_some() {
            return unknown(format!("`{id}` is not among what the renderer declares"));
        }
        match (line, place) {
            (Line::Skip(_, reason), _) => Judged::Skip(place, clipped(&reason)),
            (Line::Error(_, reason), _) => Judged::Error(place, reason.into_owned()),
            (Line::Image(_, file), CasePlace::Scene(scene)) => Judged::Image(scene, file.into_owned()),
            (Line::Value(_, values), CasePlace::Case { formula, case }) => self.values(formula, case, values),
            (Line::Value(..), CasePlace::Scene(_)) => Judged::Error(place, "a scene is answered by `image`".into()),
            _ => Judged::Error(place, "a formula is answered by `value`".into()),
        }
    }

    fn values(&self, formula: usize, case: usize, values: Vec<f32>) -> Judged {
        let spec = &self.plan.member(formula).spec;
        let outputs = spec.output_len();
        if values.len() != outputs {
            let names = spec.outputs.iter().map(|output| output.name).collect::<Vec<_>>().join(", ");
            let message = format!("{} numbers; expected {outputs}: {names}", values.len());
            return Judged::Error(CasePlace::Case { formula, case }, message);
        }
        let (verdicts, inputs) = verdict::values(self.plan, formula, case, &values, &self.profile);
        let digest = digest(values.iter().map(|value| u64::from(value.to_bits())));
        Judged::Case { formula, case, digest, verdicts: Box::new(verdicts), values, inputs }
    }

    fn count(&mut self, judged: Judged, folder: &Path) {
        match judged {
            Judged::Problem(kind, what) => note(&mut self.problems, kind, || what),
            Judged::Skip(place, reason) => {
                if self.is_first(place, CaseState::Skipped, 0) {
                    self.tally(place).skip(reason);
                }
            }
            Judged::Error(place, message) => self.fail(place, CaseState::Unjudged, &message),
            Judged::Case { formula, case, digest, verdicts, values, inputs } => {
                let place = CasePlace::Case { formula, case };
                let has_failed = verdicts.tally.totals.failed > 0;
                let state = if has_failed { CaseState::Failed } else { CaseState::Passed };
                if !self.is_first(place, state, digest) {
                    return;
                }
                let is_expected = self.expect(place, has_failed);
                let (plan, profile) = (self.plan, self.profile);
                let is_random = plan.formulas[formula].is_random(case);
                let tally = self.tally(place);
                tally.values(*verdicts);
                tally.expected += u64::from(is_expected);
                if has_failed {
                    tally.verdicts.fail_in_turn(place, || verdict::failure(plan, formula, case, &values, &profile));
                }
                tally.keep(case, &values, &inputs, [is_random, has_failed]);
            }
            Judged::Image(scene, file) => self.image(scene, &file, folder),
        }
    }

    /// Notes at the expectations whether a case failed; whether that was expected.
    fn expect(&mut self, place: CasePlace, fails: bool) -> bool {
        if self.expectations.is_empty() {
            return false;
        }
        let id = self.plan.id(place);
        let mut is_expected = false;
        for expected in self.expectations.iter_mut().filter(|expected| expected.has(&id)) {
            is_expected = true;
            let count = if fails { &mut expected.known.failed } else { &mut expected.known.passed };
            *count += 1;
        }
        is_expected && fails
    }

    /// Whether the renderer is expected to end or to hang at a case.
    #[must_use]
    pub fn expects_crash(&self, place: CasePlace) -> bool {
        let id = self.plan.id(place);
        self.expectations.iter().any(|expected| expected.known.crash && expected.has(&id))
    }

    /// Notes what was answered; whether it is the first answer.
    fn is_first(&mut self, place: CasePlace, state: CaseState, digest: u32) -> bool {
        match self.known.answer(place, state, digest) {
            Turn::First => return true,
            Turn::Same => {}
            Turn::Changed => self.changed(place),
            Turn::Twice => {
                let id = self.plan.id(place);
                let source = self.source.as_ref().map_or(String::new(), |source| format!("{source}: "));
                note(&mut self.problems, "duplicate", || format!("{source}{id} is answered more than once"));
            }
        }
        false
    }

    /// Notes that a case could not be judged, or that the renderer ended at it.
    pub fn fail(&mut self, place: CasePlace, state: CaseState, message: &str) {
        if !self.is_first(place, state, 0) {
            return;
        }
        let id = self.plan.id(place);
        let is_expected = self.expect(place, true);
        let tally = self.tally(place);
        tally.failed += 1;
        tally.unjudged += 1;
        tally.broken += u64::from(state == CaseState::Broken);
        tally.expected += u64::from(is_expected);
        tally.verdicts.fail_in_turn(place, || verdict::unjudged(id, clipped(message)));
    }

    fn image(&mut self, scene: usize, file: &str, folder: &Path) {
        let place = CasePlace::Scene(scene);
        let frame = match self.plan.frame(scene) {
            Ok((_, frame)) => frame,
            Err(error) => return self.fail(place, CaseState::Unjudged, &error.to_string()),
        };
        let (image, digest) = match picture::read(folder, file, &frame, self.asked.get(&scene).copied()) {
            Err(message) => return self.fail(place, CaseState::Unjudged, &message),
            Ok(read) => read,
        };
        if self.known.is_again {
            // The same pixels have the same verdict.
            let state = self.known.state(place);
            self.is_first(place, state, digest);
            return;
        }
        let found = picture::judge(&image, &frame, &self.profile);
        let state = if found.totals.failed > 0 { CaseState::Failed } else { CaseState::Passed };
        if !self.is_first(place, state, digest) {
            return;
        }
        let id = self.plan.id(place);
        let is_expected = self.expect(place, found.totals.failed > 0);
        let tally = self.tally(place);
        tally.image(place, &found);
        tally.expected += u64::from(is_expected);
        if found.totals.failed == 0 {
            return;
        }
        let Totals { failed, verdicts, .. } = found.totals;
        let problem = format!("{failed} of {verdicts} components of pixels are outside of what is legal");
        tally.verdicts.fail_in_turn(place, || GateFailure {
            reference: found.reference.map(Number).to_vec(),
            interval: found.interval.map(|ends| ends.map(Number)).to_vec(),
            value: found.value.map(Number).to_vec(),
            outputs: ["r", "g", "b", "a"].map(String::from).to_vec(),
            error_ulp: Number(found.error_max),
            ..verdict::unjudged(format!("{id}/{}", found.worst), problem)
        });
    }
}
