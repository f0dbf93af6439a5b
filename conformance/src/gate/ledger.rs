//! What was asked, what was answered, and what each answer is worth.

use super::answer::{self, Hello, Line};
use super::expectations::{Expectation, Expectations};
use super::plan::{Place, Plan};
use super::{pack, picture, process};
use crate::arithmetic::{Accept, Profile};
use crate::judge::{Outcome, Verdict, is_worse, judge, worse};
use crate::report::Number;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::Path;

/// Failures that are kept with their numbers, of each formula.
const KEPT: usize = 16;
/// Rows that are kept of each formula for the diagnosis: failing ones, and passing ones.
const KEPT_ROWS: [usize; 2] = [2048, 1024];
/// Problems of each kind that are kept.
const KEPT_PROBLEMS: usize = 32;

/// What became of the cases of a formula, or of a scene.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Cases that were asked for.
    pub asked: u64,
    /// Cases that were answered with values.
    pub answered: u64,
    /// Cases that the renderer does not do.
    pub skipped: u64,
    /// Cases that failed: a value outside, an answer of a wrong form, an error.
    pub failed: u64,
    /// Verdicts.
    pub verdicts: u64,
    /// Of them, those where anything is legal.
    pub indeterminate: u64,
    /// The largest error in ULP of binary32, of a scene in its target's.
    pub error_max: f64,
    /// The largest margin.
    pub margin_max: f64,
    /// The place of the case that it is of.
    pub worst: Option<Place>,
    /// The first failures.
    pub failures: Vec<Failure>,
    /// Why cases were skipped, each reason once.
    pub reasons: Vec<String>,
    /// Rows that fail and rows that do not, for the diagnosis.
    pub rows: [Vec<Row>; 2],
    /// Cases that were asked for and never answered.
    pub missing: u64,
    /// Failed cases whose answer could not be judged.
    pub unjudged: u64,
    /// Failed cases that are expected to.
    pub expected: u64,
    /// Verdicts on random cases, and of them those where anything is legal.
    pub random: [u64; 2],
    /// What explains the failures of a scene.
    pub diagnosis: Option<String>,
    /// Why nothing was asked of it.
    pub undeclared: Option<String>,
}

/// Inputs and the values that were answered.
#[derive(Clone, Debug)]
pub struct Row {
    /// The case's place.
    pub case: usize,
    /// What was answered.
    pub values: Vec<f32>,
}

/// A case that failed.
#[derive(Clone, Debug, Serialize)]
pub struct Failure {
    /// The case.
    pub id: String,
    /// Its inputs, row by row of the formula's description.
    pub inputs: Vec<Number>,
    /// What the reference has.
    pub reference: Vec<Number>,
    /// From where to where values are legal.
    pub interval: Vec<[Number; 2]>,
    /// What was answered.
    pub value: Vec<Number>,
    /// The largest error in ULP.
    pub error_ulp: Number,
    /// What is wrong, where it is not a value.
    pub problem: Option<String>,
}

/// Answers that are none.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Problems {
    /// How many of each kind.
    pub counts: BTreeMap<&'static str, u64>,
    /// The first of them, in words.
    pub first: Vec<String>,
}

impl Problems {
    /// Notes one.
    pub fn add(&mut self, kind: &'static str, what: impl FnOnce() -> String) {
        let count = self.counts.entry(kind).or_default();
        *count += 1;
        if *count <= KEPT_PROBLEMS as u64 {
            self.first.push(what());
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }
}

/// The state of a gate. It grows with the number of cases by some bytes each, and not with their answers.
pub struct Ledger<'a> {
    plan: &'a Plan,
    profile: Profile,
    /// Of each formula, and then of each scene.
    pub tallies: Vec<Tally>,
    /// Of each case of each formula: what was answered, hashed; 0 where nothing was.
    digests: Vec<Vec<u32>>,
    /// The same of scenes.
    scenes: Vec<u32>,
    /// Answers that are none.
    pub problems: Problems,
    /// Cases whose second answer was another, by id.
    pub unstable: Vec<String>,
    /// Known failures of any renderer.
    pub known: Expectations,
    /// Those of this one.
    pub expectations: Vec<Expectation>,
    /// Whether the accuracy rules stay, whatever the renderer asks for.
    pub is_held_to: bool,
}

/// What an answer comes to, before it is counted.
enum Judged {
    Hello,
    Problem(&'static str, String),
    Skip(Place, String),
    Error(Place, String),
    Case {
        formula: usize,
        case: usize,
        digest: u32,
        verdicts: Verdicts,
        values: Vec<f32>,
        failure: Option<Box<Failure>>,
    },
    Image(usize, String),
}

/// The verdicts of a case together.
#[derive(Clone, Copy, Default)]
struct Verdicts {
    all: u64,
    failed: u64,
    indeterminate: u64,
    error: f64,
    margin: f64,
}

impl<'a> Ledger<'a> {
    /// Nothing is answered yet.
    #[must_use]
    pub fn new(plan: &'a Plan, profile: &Profile) -> Self {
        let digests: Vec<Vec<u32>> = plan.formulas.iter().map(|formula| vec![0; formula.count()]).collect();
        Self {
            plan,
            profile: *profile,
            tallies: vec![Tally::default(); plan.formulas.len() + plan.scenes.len()],
            digests,
            scenes: vec![0; plan.scenes.len()],
            problems: Problems::default(),
            unstable: vec![],
            known: Expectations::default(),
            expectations: vec![],
            is_held_to: false,
        }
    }

    /// The accuracy rules.
    #[must_use]
    pub const fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The plan.
    #[must_use]
    pub const fn plan(&self) -> &'a Plan {
        self.plan
    }

    /// Counts what was asked and never answered.
    pub fn close(&mut self) {
        for tally in &mut self.tallies {
            tally.missing = tally.asked.saturating_sub(tally.answered + tally.skipped + tally.unjudged);
        }
    }

    /// Whether a case has been answered, skipped or given up.
    #[must_use]
    pub fn is_done(&self, place: Place) -> bool {
        match place {
            Place::Case { formula, case } => self.digests[formula][case] != 0,
            Place::Scene(scene) => self.scenes[scene] != 0,
        }
    }

    fn digest(&mut self, place: Place) -> &mut u32 {
        match place {
            Place::Case { formula, case } => &mut self.digests[formula][case],
            Place::Scene(scene) => &mut self.scenes[scene],
        }
    }

    const fn place_of(&self, place: Place) -> usize {
        match place {
            Place::Case { formula, .. } => formula,
            Place::Scene(scene) => self.digests.len() + scene,
        }
    }

    fn tally(&mut self, place: Place) -> &mut Tally {
        let k = self.place_of(place);
        &mut self.tallies[k]
    }

    /// The cases that are to be asked of who says hello, formulas first. What it does not declare is counted as not asked.
    ///
    /// # Errors
    /// Where what it declares cannot be read.
    pub fn begin(&mut self, hello: &Hello) -> Result<Vec<Place>, process::Error> {
        self.expectations = self.known.of(&hello.renderer, &hello.version);
        if let Some(name) = hello.profile.as_ref().filter(|_| !self.is_held_to) {
            let profile = Profile::by_name(name).ok_or_else(|| process::Error::Profile(name.clone()))?;
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
            asked.extend((0..count).map(|case| Place::Case { formula, case }));
        }
        for scene in 0..self.plan.scenes.len() {
            let place = Place::Scene(scene);
            let (id, (_, frame)) = (self.plan.id(place), self.plan.frame(scene)?);
            let lacks = if scenes.as_ref().is_some_and(|filter| filter.selects(&id)) {
                pack::lacks(hello, &frame)
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

    /// The cases that failed and whose failure is kept, to be asked once more.
    #[must_use]
    pub fn failing(&self) -> Vec<Place> {
        let scenes = self.plan.formulas.len();
        let of = |(k, tally): (usize, &Tally)| -> Vec<Place> {
            if k >= scenes {
                let is_failed = tally.failed > 0 && self.scenes[k - scenes] != FAILED;
                return is_failed.then_some(Place::Scene(k - scenes)).into_iter().collect();
            }
            tally.rows[0].iter().take(KEPT).map(|row| Place::Case { formula: k, case: row.case }).collect()
        };
        self.tallies.iter().enumerate().flat_map(of).collect()
    }

    /// Judges lines that were read already.
    pub(super) fn read(&mut self, lines: Vec<(u64, Line<'_>)>, folder: &Path, again: bool) {
        let judged: Vec<Judged> =
            self.profile.scope(|| lines.into_iter().map(|(number, line)| self.judge_line(number, line)).collect());
        for judged in judged {
            self.count(judged, folder, again);
        }
    }

    /// Judges lines, each with its number; images lie in the folder. A second answer to a case is a problem, unless
    /// `again` says that it was asked for once more: then it must be the first.
    pub fn lines(&mut self, lines: &[(u64, Vec<u8>)], folder: &Path, again: bool) {
        let judged: Vec<Judged> = lines
            .par_chunks(256)
            .flat_map_iter(|lines| {
                self.profile.scope(|| lines.iter().map(|(number, line)| self.judge(*number, line)).collect::<Vec<_>>())
            })
            .collect();
        for judged in judged {
            self.count(judged, folder, again);
        }
    }

    fn judge(&self, number: u64, line: &[u8]) -> Judged {
        match answer::read(line) {
            Ok(line) => self.judge_line(number, line),
            Err(message) => Judged::Problem("malformed", format!("line {number}: {message}")),
        }
    }

    fn judge_line(&self, number: u64, line: Line<'_>) -> Judged {
        let id = match &line {
            Line::Hello(_) => return Judged::Hello,
            Line::Value(id, _) | Line::Image(id, _) | Line::Skip(id, _) | Line::Error(id, _) => id,
        };
        let Some(place) = self.plan.find(id) else {
            return Judged::Problem("unknown", format!("line {number}: no case `{id}` was asked for"));
        };
        if self.tallies[self.place_of(place)].undeclared.is_some() {
            return Judged::Problem(
                "unknown",
                format!("line {number}: `{id}` is not among what the renderer declares"),
            );
        }
        match (line, place) {
            (Line::Skip(_, reason), _) => Judged::Skip(place, reason.into_owned()),
            (Line::Error(_, reason), _) => Judged::Error(place, reason.into_owned()),
            (Line::Image(_, file), Place::Scene(scene)) => Judged::Image(scene, file.into_owned()),
            (Line::Value(_, values), Place::Case { formula, case }) => self.values(formula, case, values),
            (Line::Value(..), Place::Scene(_)) => Judged::Error(place, "a scene is answered by `image`".into()),
            _ => Judged::Error(place, "a formula is answered by `value`".into()),
        }
    }

    fn values(&self, formula: usize, case: usize, values: Vec<f32>) -> Judged {
        let member = self.plan.member(formula);
        let outputs = member.spec.output_len();
        if values.len() != outputs {
            let names = member.spec.outputs.iter().map(|output| output.name).collect::<Vec<_>>().join(", ");
            let message = format!("{} numbers; expected {outputs}: {names}", values.len());
            return Judged::Error(Place::Case { formula, case }, message);
        }
        let inputs = self.plan.inputs(formula, case);
        let (mut reference, mut legal) = (vec![0.0; outputs], vec![Accept::ANY; outputs]);
        member.formula.reference(&inputs, &mut reference);
        member.formula.promised_interval(member.spec.kind, &inputs, &self.profile, &mut legal);
        let mut all = Verdicts::default();
        let mut hasher = DefaultHasher::new();
        for (k, value) in values.iter().enumerate() {
            value.to_bits().hash(&mut hasher);
            let Verdict { outcome, error_ulp, margin } = judge(value.to_bits(), reference[k], &legal[k]);
            all.all += 1;
            match outcome {
                Outcome::Indeterminate => all.indeterminate += 1,
                Outcome::Fail => all.failed += 1,
                Outcome::Pass => {}
            }
            if outcome != Outcome::Indeterminate {
                all.error = worse(all.error, error_ulp);
                all.margin = worse(all.margin, margin);
            }
        }
        let failure = (all.failed > 0).then(|| {
            Box::new(Failure {
                id: self.plan.id(Place::Case { formula, case }),
                inputs: inputs.iter().map(|&x| Number(x.into())).collect(),
                reference: reference.iter().map(|&x| Number(x)).collect(),
                interval: legal.iter().map(|legal| [Number(legal.low()), Number(legal.high())]).collect(),
                value: values.iter().map(|&x| Number(x.into())).collect(),
                error_ulp: Number(all.error),
                problem: None,
            })
        });
        // 0 stands for nothing.
        #[expect(clippy::cast_possible_truncation, reason = "a part of a hash")]
        let digest = (hasher.finish() as u32).max(1);
        Judged::Case { formula, case, digest, verdicts: all, values, failure }
    }

    fn count(&mut self, judged: Judged, folder: &Path, again: bool) {
        match judged {
            Judged::Hello => {}
            Judged::Problem(kind, what) => self.problems.add(kind, || what),
            Judged::Skip(place, reason) => {
                if self.is_first(place, SKIPPED, again) {
                    let tally = self.tally(place);
                    tally.skipped += 1;
                    if !tally.reasons.contains(&reason) && tally.reasons.len() < KEPT {
                        tally.reasons.push(reason);
                    }
                }
            }
            Judged::Error(place, message) => {
                if self.is_first(place, FAILED, again) {
                    self.fail(place, message);
                }
            }
            Judged::Case { formula, case, digest, verdicts, values, failure } => {
                let place = Place::Case { formula, case };
                if !self.is_first(place, digest, again) {
                    return;
                }
                let is_expected = self.expect(place, verdicts.failed > 0);
                let is_random = self.plan.formulas[formula].is_random(case);
                let tally = self.tally(place);
                tally.answered += 1;
                tally.verdicts += verdicts.all;
                tally.indeterminate += verdicts.indeterminate;
                if is_random {
                    tally.random = [tally.random[0] + verdicts.all, tally.random[1] + verdicts.indeterminate];
                }
                tally.failed += u64::from(verdicts.failed > 0);
                tally.expected += u64::from(is_expected);
                tally.error_max = worse(tally.error_max, verdicts.error);
                if tally.worst.is_none() || is_worse(verdicts.margin, tally.margin_max) {
                    (tally.margin_max, tally.worst) = (verdicts.margin, Some(place));
                }
                let kind = usize::from(verdicts.failed == 0);
                if tally.rows[kind].len() < KEPT_ROWS[kind] {
                    tally.rows[kind].push(Row { case, values });
                }
                if let Some(failure) = failure.filter(|_| tally.failures.len() < KEPT) {
                    tally.failures.push(*failure);
                }
            }
            Judged::Image(scene, file) => self.image(scene, &file, folder, again),
        }
    }

    /// Notes at the expectations whether a case failed; whether that was expected.
    fn expect(&mut self, place: Place, fails: bool) -> bool {
        if self.expectations.is_empty() {
            return false;
        }
        let id = self.plan.id(place);
        let mut of_case = self.expectations.iter_mut().filter(|expected| expected.has(&id));
        let Some(expected) = of_case.next() else { return false };
        let count = if fails { &mut expected.failed } else { &mut expected.passed };
        *count += 1;
        fails
    }

    /// Notes what was answered; whether it is the first answer.
    fn is_first(&mut self, place: Place, digest: u32, again: bool) -> bool {
        let known = self.digest(place);
        let before = *known;
        if before == 0 {
            *known = digest;
            return true;
        }
        if !again {
            let id = self.plan.id(place);
            self.problems.add("duplicate", || format!("{id} is answered more than once"));
        } else if before != digest {
            self.unstable.push(self.plan.id(place));
        }
        false
    }

    /// Notes that a case could not be judged.
    pub fn fail(&mut self, place: Place, message: String) {
        let id = self.plan.id(place);
        *self.digest(place) = FAILED;
        let is_expected = self.expect(place, true);
        let tally = self.tally(place);
        tally.failed += 1;
        tally.unjudged += 1;
        tally.expected += u64::from(is_expected);
        if tally.failures.len() < KEPT {
            tally.failures.push(Failure {
                id,
                inputs: vec![],
                reference: vec![],
                interval: vec![],
                value: vec![],
                error_ulp: Number(f64::INFINITY),
                problem: Some(message),
            });
        }
    }

    fn image(&mut self, scene: usize, file: &str, folder: &Path, again: bool) {
        let place = Place::Scene(scene);
        let frame = match self.plan.frame(scene) {
            Ok((_, frame)) => frame,
            Err(error) => return self.fail(place, error.to_string()),
        };
        match picture::read(folder, file, &frame) {
            Err(message) => {
                if self.is_first(place, FAILED, again) {
                    self.fail(place, message);
                }
            }
            Ok((image, digest)) => {
                if self.is_first(place, digest, again) {
                    let found = picture::judge(&image, &frame, &self.profile);
                    let id = self.plan.id(place);
                    let is_expected = self.expect(place, found.failed > 0);
                    let tally = self.tally(place);
                    tally.answered += 1;
                    tally.expected += u64::from(is_expected);
                    tally.verdicts += found.verdicts;
                    tally.indeterminate += found.indeterminate;
                    (tally.error_max, tally.margin_max) = (found.error_max, found.margin_max);
                    tally.worst = Some(place);
                    tally.diagnosis.clone_from(&found.diagnosis);
                    if found.failed > 0 {
                        tally.failed += 1;
                        tally.failures.push(Failure {
                            id: format!("{id}/{}", found.worst),
                            inputs: vec![],
                            reference: found.reference.map(Number).to_vec(),
                            interval: found.interval.map(|ends| ends.map(Number)).to_vec(),
                            value: found.value.map(Number).to_vec(),
                            error_ulp: Number(found.error_max),
                            problem: Some(format!(
                                "{} of {} components of pixels are outside of what is legal",
                                found.failed, found.verdicts
                            )),
                        });
                    }
                }
            }
        }
    }
}

/// In the place of what was answered: the renderer does not do it.
const SKIPPED: u32 = u32::MAX;
/// It was answered by something that cannot be judged, or not at all.
const FAILED: u32 = u32::MAX - 1;
