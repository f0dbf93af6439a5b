//! Mutants judged on an adapter.

use super::generate::Mutant;
use crate::callers::callers;
use crate::frames::frame;
use crate::techniques::drawn_by;
use lightmeter::arithmetic::Accept;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::bench::techniques;
use lightmeter::cases::{Kind, Spec};
use lightmeter::device::{Code, DeviceError, Picture};
use lightmeter::devices::DEVIATIONS;
use lightmeter::document::event::{Event, Observer, Stop};
use lightmeter::document::report::Group;
use lightmeter::evaluate::Evaluator;
use lightmeter::filter::Filter;
use lightmeter::image::LegalPixel;
use lightmeter::image::drawn::{drawn, intermediate};
use lightmeter::image::expect::expect;
use lightmeter::options::Options;
use lightmeter::run::run_selection;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::{SIZE_AMONG_ALL, builtin, scene_id};
use lightmeter::select::{CaseRef, Member, catalogue};
use lightmeter::selection::Selection;
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::{code, device_error, shaders_of};
use lightmeter::witness;
use lightmeter_gpu::Shaders;
use lightmeter_gpu::compose::Technique;
use lightmeter_scene::effects::{effects, named};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

/// Random inputs that tell what survives: of each formula, or of all of them together where there are as many as blend states.
const INPUTS_OF_A_SURVIVOR: u64 = 1_000_000;
/// As many formulas are blend states.
const MANY: usize = 200;
/// Random cases of each blend state.
const CASES_OF_A_STATE: u64 = 1024;
/// Random cases of each formula of a fixed function: more than a million answers of the rasteriser, of the depth test and of the blend unit.
const CASES_OF_A_FIXED_FUNCTION: u64 = 65_536;
/// Random frames in which what survives in scenes is drawn: more than a million pixels.
const RANDOM_FRAMES: u64 = 600;
/// How many rows are evaluated at once.
const ROWS: usize = 1 << 16;

/// The tables of special values, which have no other inputs than their own.
const SPECIAL_VALUES: &str = "special";

/// Blend states that take each route to the unit: its own factors, and beside each other the constant's colour and its alpha, which
/// are folded into the source or come as a second source.
const BLEND_STATES: &[&str] = &[
    "blend/mode-*",
    "blend/min",
    "blend/add/*constant-color/*constant-alpha",
    "blend/add/*constant-alpha/*constant-color",
];

/// Pixels of the longer side of a scene's intermediate results.
const SIZE_OF_STAGES: u32 = 64;

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MutantClass {
    /// It is no valid WGSL.
    Invalid,
    /// A run fails.
    Killed,
    /// It gives the same bits.
    Equal,
    /// All that it gives is legal: other bits, or what is judged without comparing bits, as fixed functions are.
    Legal,
    /// It gives what is not legal, and no run of default cases shows it.
    Missed,
    /// No run judges the function that it is in.
    Unjudged,
}

impl MutantClass {
    /// All of them, in the order of tables.
    pub const ALL: [Self; 6] = [Self::Killed, Self::Equal, Self::Legal, Self::Missed, Self::Unjudged, Self::Invalid];

    /// Whether it is a mutant that no run fails.
    #[must_use]
    pub const fn survives(self) -> bool {
        !matches!(self, Self::Invalid | Self::Killed | Self::Unjudged)
    }
}

impl fmt::Display for MutantClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Invalid => "invalid",
            Self::Killed => "killed",
            Self::Equal => "equal",
            Self::Legal => "legal",
            Self::Missed => "missed",
            Self::Unjudged => "unjudged",
        })
    }
}

/// What is judged to tell a mutant of a file from what is right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The formulas, by their places in the catalogue, whose functions call the mutated one.
    Formulas(Vec<usize>),
    /// Whatever these globs select.
    Filter(Vec<String>),
    /// The witnesses of what drivers' built-in functions are known for, which a run asks by the built-in shaders.
    Witnesses,
}

/// Judges mutants of the built-in shaders.
pub struct Campaign {
    shaders: Shaders,
    right: Code,
    /// The formulas of the catalogue, and the techniques of `bench`.
    catalogue: Arc<[Member]>,
    subject: Subject,
    /// Scopes in which the right shaders were seen to pass.
    passed: Vec<Scope>,
    /// The pixels of random frames by the right shaders, as far as they were drawn.
    right_frames: Vec<Vec<[f64; 4]>>,
}

/// Ends a run at its first failure.
struct UntilOneFails {
    stop: Stop,
    has_failed: bool,
}

impl Observer for UntilOneFails {
    fn see(&mut self, event: &Event<'_>) {
        if let Event::Judged { group: Group { totals, .. }, .. } = event
            && (totals.failed > 0 || totals.failed_groups > 0)
        {
            self.has_failed = true;
            // The number of a signal; none was sent.
            self.stop.flag().store(1, std::sync::atomic::Ordering::Relaxed);
        }
    }
}

impl Campaign {
    /// On this adapter.
    ///
    /// # Errors
    /// Where the built-in shaders are invalid, which a test rules out.
    pub fn new(subject: Subject) -> Result<Self, lightmeter_gpu::GpuError> {
        let shaders = Shaders::built_in()?;
        let catalogue = catalogue().into_iter().chain(techniques::formulas()).collect();
        Ok(Self { right: code(shaders.clone()), shaders, catalogue, subject, passed: vec![], right_frames: vec![] })
    }

    /// The shaders that are mutated.
    #[must_use]
    pub const fn shaders(&self) -> &Shaders {
        &self.shaders
    }

    /// What judges a mutant; `None` where nothing does.
    #[must_use]
    pub fn scope(&self, mutant: &Mutant) -> Option<Scope> {
        let globs = |globs: &[&str]| Some(Scope::Filter(globs.iter().map(|&glob| glob.to_owned()).collect()));
        let file = mutant.file.as_str();
        match file {
            "special.wgsl" => globs(&[SPECIAL_VALUES]),
            "raster.wgsl" => {
                let is_raster = |spec: &Spec| matches!(spec.kind, Kind::Raster(_));
                let ids = self.catalogue.iter().map(|member| &member.spec).filter(|spec| is_raster(spec));
                Some(Scope::Filter(ids.map(|spec| spec.id.clone()).collect()))
            }
            "depth_unit.wgsl" => globs(&["depth"]),
            "blend_unit.wgsl" | "blend_unit_dual.wgsl" => globs(BLEND_STATES),
            "probe.wgsl" => Some(Scope::Witnesses),
            _ if file.starts_with("effects/") => {
                let effect = file.trim_start_matches("effects/").trim_end_matches(".wgsl");
                let scenes = self.scenes_with(effect);
                (!scenes.is_empty()).then_some(Scope::Filter(scenes))
            }
            _ if file.starts_with("scene") || file == "texture.wgsl" => globs(&["scene"]),
            _ if file.starts_with("rung/") => None,
            _ => {
                let callers = callers(&self.shaders, [&*mutant.function]);
                let is_judged = |&place: &usize| {
                    let spec = &self.catalogue[place].spec;
                    callers.contains(spec.function) && !spec.row_stages().is_empty()
                };
                let places: Vec<usize> = (0..self.catalogue.len()).filter(is_judged).collect();
                (!places.is_empty()).then_some(Scope::Formulas(places))
            }
        }
    }

    /// The scenes of which some draw calls for an effect.
    fn scenes_with(&self, effect: &str) -> Vec<String> {
        let calls = |place: &usize| {
            let loaded = builtin(*place, Some(SIZE_AMONG_ALL)).ok();
            loaded.is_some_and(|loaded| {
                effects(&loaded.frame).iter().any(|called| called.effects.iter().any(|one| one.name() == effect))
            })
        };
        (0..SCENES.len()).filter(calls).map(scene_id).collect()
    }

    /// Judges a mutant, and where it survives tells by bits what it is.
    ///
    /// # Errors
    /// Where the device fails, which a mutant must not make it do.
    pub fn judge(&mut self, mutant: &Mutant) -> Result<MutantClass, DeviceError> {
        let Some(scope) = self.scope(mutant) else { return Ok(MutantClass::Unjudged) };
        let Some(mutated) = self.code_of(mutant) else { return Ok(MutantClass::Invalid) };
        match self.is_failed(&scope, &mutated) {
            // A signature that no longer fits, or a constant that no pipeline can be made of.
            Err(error) if !error.is_of_device() => return Ok(MutantClass::Invalid),
            Err(error) => return Err(error),
            Ok(true) => return Ok(MutantClass::Killed),
            Ok(false) => {}
        }
        let found = match scope {
            Scope::Formulas(places) => self.survivor(&places, &mutated),
            Scope::Filter(globs) if globs[0].starts_with("scene") => self.scenes(&globs, &mutated),
            Scope::Filter(ref globs) if *globs != [SPECIAL_VALUES] => self.fixed_function(&scope, &mutated),
            // A run asks all that there is to ask of these.
            Scope::Filter(_) | Scope::Witnesses => Ok(MutantClass::Legal),
        };
        // What no run composes may be invalid where a technique does.
        found.or_else(|error| if error.is_of_device() { Err(error) } else { Ok(MutantClass::Invalid) })
    }

    /// Whether a default run fails; `None` where the mutant is invalid, or nothing judges it.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn is_noticed(&mut self, mutant: &Mutant) -> Result<Option<bool>, DeviceError> {
        let (Some(scope), Some(mutated)) = (self.scope(mutant), self.code_of(mutant)) else { return Ok(None) };
        match self.is_failed(&scope, &mutated) {
            Err(error) if !error.is_of_device() => Ok(None),
            other => other.map(Some),
        }
    }

    /// Whether a few formulas judge a mutant, which takes less than a second: not scenes, fixed functions or all blend states.
    #[must_use]
    pub fn is_of_formulas(&self, mutant: &Mutant) -> bool {
        matches!(self.scope(mutant), Some(Scope::Formulas(places)) if places.len() <= MANY)
    }

    /// The shaders with the mutant in them; `None` where they are invalid.
    fn code_of(&self, mutant: &Mutant) -> Option<Code> {
        let (_, text) = self.shaders.texts().find(|(file, _)| *file == mutant.file)?;
        Some(code(self.shaders.with(&mutant.file, mutant.apply(text)).ok()?))
    }

    /// Whether a default run of the scope fails with the mutant, and passes without it.
    fn is_failed(&mut self, scope: &Scope, mutated: &Code) -> Result<bool, DeviceError> {
        if !self.fails(scope, mutated, None)? {
            return Ok(false);
        }
        if !self.passed.contains(scope) {
            if self.fails(scope, &self.right.clone(), None)? {
                return Err(DeviceError::Failed(format!("the right shaders fail too, in {scope:?}")));
            }
            self.passed.push(scope.clone());
        }
        Ok(true)
    }

    /// Whether a run of the scope fails, of the default cases or of as many.
    fn fails(&mut self, scope: &Scope, mutated: &Code, cases: Option<u64>) -> Result<bool, DeviceError> {
        let globs = match scope {
            Scope::Formulas(places) => {
                let groups: BTreeSet<&str> = places.iter().map(|&place| self.catalogue[place].spec.group()).collect();
                groups.into_iter().map(str::to_owned).collect()
            }
            Scope::Filter(globs) => globs.clone(),
            Scope::Witnesses => return self.is_witness_lost(mutated),
        };
        let filter = Filter::new(&globs).map_err(|error| DeviceError::Refused(Box::new(error)))?;
        let stop = Stop::default();
        let size = Some(SIZE_AMONG_ALL);
        let mut options = Options { filter, size, stop: stop.clone(), ..Options::new(mutated.clone()) };
        if matches!(scope, Scope::Formulas(places) if places.len() > MANY) {
            options.cases = CASES_OF_A_STATE;
        }
        options.cases = cases.unwrap_or(options.cases);
        let selection = match scope {
            Scope::Formulas(places) => {
                let mut selection = Selection::of_formulas(self.catalogue.clone(), &options);
                selection.formulas.retain(|chosen| places.contains(&chosen.member));
                selection
            }
            Scope::Filter(_) | Scope::Witnesses => {
                let mut selection = Selection::of(&options);
                selection.deviations.clear();
                selection
            }
        };
        let mut observer = UntilOneFails { stop, has_failed: false };
        let report = run_selection(&selection, std::slice::from_mut(&mut self.subject), &options, &mut observer)?;
        match &report.interrupted {
            Some(interrupted) if interrupted.signal.is_none() => Err(DeviceError::Failed(interrupted.message.clone())),
            _ => Ok(observer.has_failed || !report.is_success()),
        }
    }

    /// Whether some witness no longer shows the deviation that it is for.
    fn is_witness_lost(&self, mutated: &Code) -> Result<bool, DeviceError> {
        for deviation in DEVIATIONS {
            if witness::accuracy(deviation, &self.subject, mutated, &WGSL)? == Some(false) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// What a mutant is that no run fails.
    fn survivor(&mut self, places: &[usize], mutated: &Code) -> Result<MutantClass, DeviceError> {
        let mut worst = MutantClass::Equal;
        let each = if places.len() > MANY { INPUTS_OF_A_SURVIVOR / places.len() as u64 } else { INPUTS_OF_A_SURVIVOR };
        for &place in places {
            worst = worst.max(self.compared(place, each, mutated)?);
            if worst == MutantClass::Missed {
                break;
            }
        }
        Ok(worst)
    }

    /// What a mutant of a fixed function's shaders is that no default run fails.
    fn fixed_function(&mut self, scope: &Scope, mutated: &Code) -> Result<MutantClass, DeviceError> {
        if !self.fails(scope, mutated, Some(CASES_OF_A_FIXED_FUNCTION))? {
            return Ok(MutantClass::Legal);
        }
        if self.fails(scope, &self.right.clone(), Some(CASES_OF_A_FIXED_FUNCTION))? {
            return Err(DeviceError::Failed(format!("the right shaders fail too, in more cases of {scope:?}")));
        }
        Ok(MutantClass::Missed)
    }

    /// What a mutant is that no run of scenes fails: an intermediate result or a technique of drawing may show it, and random frames may.
    fn scenes(&mut self, globs: &[String], mutated: &Code) -> Result<MutantClass, DeviceError> {
        let filter = Filter::new(globs).map_err(|error| DeviceError::Refused(Box::new(error)))?;
        let mut found = MutantClass::Equal;
        for place in (0..SCENES.len()).filter(|&place| filter.selects(&scene_id(place))) {
            let load = |size| builtin(place, Some(size)).map_err(|error| DeviceError::Refused(Box::new(error)));
            let frame = load(SIZE_AMONG_ALL)?.frame;
            for (picture, sets) in [(Picture::Composed, effects(&frame)), (Picture::Full, named(&frame))] {
                let image = |code| drawn(&self.subject, code, &frame, &sets, picture);
                if let (Ok(right), Ok(other)) = (image(&self.right)?, image(mutated)?)
                    && right.pixels != other.pixels
                {
                    found = MutantClass::Legal;
                }
            }
            if self.is_wrong_within(&load(SIZE_OF_STAGES)?.frame, mutated)? {
                return Ok(MutantClass::Killed);
            }
        }
        let shaders = shaders_of(mutated).expect("the code is shaders");
        for technique in Technique::ALL {
            if drawn_by(technique, &self.subject, shaders).map_err(device_error)?.departure.is_some() {
                return Ok(MutantClass::Killed);
            }
        }
        Ok(found.max(self.random_frames(mutated)?))
    }

    /// What a mutant is to random frames, drawn on floats and not blended.
    fn random_frames(&mut self, mutated: &Code) -> Result<MutantClass, DeviceError> {
        let mut found = MutantClass::Equal;
        for seed in 0..RANDOM_FRAMES {
            let mut frame = frame(seed);
            frame.target.format = TargetFormat::Rgba32Float;
            frame.draws.iter_mut().for_each(|draw| draw.blend = None);
            let sets = effects(&frame);
            let image = |code| drawn(&self.subject, code, &frame, &sets, Picture::Composed);
            let place = usize::try_from(seed).expect("there are few");
            if self.right_frames.len() == place {
                self.right_frames.push(image(&self.right)?.map_or_else(|_| vec![], |image| image.pixels));
            }
            let Ok(other) = image(mutated)? else { continue };
            let right = &self.right_frames[place];
            if other.pixels == *right {
                continue;
            }
            found = MutantClass::Legal;
            let legal = expect(&frame, None, None, &self.subject.known.profile(&WGSL));
            if !right.iter().zip(&legal).all(|(value, legal)| is_legal(value, legal)) {
                return Err(DeviceError::Failed(format!("the right shaders are wrong in the random frame {seed}")));
            }
            if !other.pixels.iter().zip(&legal).all(|(value, legal)| is_legal(value, legal)) {
                return Ok(MutantClass::Missed);
            }
        }
        Ok(found)
    }

    /// Whether an intermediate result of a frame is not legal.
    fn is_wrong_within(&self, frame: &Frame, mutated: &Code) -> Result<bool, DeviceError> {
        let (sets, profile) = (named(frame), self.subject.known.profile(&WGSL));
        let drawn_for_certain = expect(frame, None, Some(Intermediate::Depth), &profile);
        for stage in Intermediate::ALL {
            let image = |code| intermediate(&self.subject, code, frame, &sets, stage);
            let (Ok(right), Ok(other)) = (image(&self.right)?, image(mutated)?) else { continue };
            if right.pixels == other.pixels {
                continue;
            }
            let legal = expect(frame, None, Some(stage), &profile);
            let mut pixels = (0..legal.len()).filter(|&pixel| drawn_for_certain[pixel].low[3] > 0.0);
            if !pixels.all(|pixel| is_legal(&other.pixels[pixel], &legal[pixel])) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// What a mutant is to one formula.
    fn compared(&mut self, place: usize, random: u64, mutated: &Code) -> Result<MutantClass, DeviceError> {
        let member = &self.catalogue[place];
        let members = [member];
        let right = Evaluator::new(&mut self.subject, &members, &self.right)?;
        let other = Evaluator::new(&mut self.subject, &members, mutated)?;
        let mut cases = member.fixed().chain((0..random).map(CaseRef::Random));
        let (mut worst, outputs) = (MutantClass::Equal, member.spec.output_len());
        let options = Options::new(mutated.clone());
        loop {
            let mut inputs = vec![];
            let count = cases.by_ref().take(ROWS).map(|case| member.inputs(case, options.seed, &mut inputs)).count();
            if count == 0 {
                return Ok(worst);
            }
            let of = vec![0; count];
            let expected = right.run(&mut self.subject, &of, &inputs)?;
            let found = other.run(&mut self.subject, &of, &inputs)?;
            for ((_, expected), (_, found)) in expected.iter().zip(&found) {
                let (expected, found) = match (expected, found) {
                    (Ok(expected), Ok(found)) => (expected, found),
                    (Err(_), Err(_)) => continue,
                    _ => return Ok(MutantClass::Missed),
                };
                let rows = inputs.chunks_exact(member.spec.input_len());
                let words = expected.chunks_exact(outputs).zip(found.chunks_exact(outputs));
                for (inputs, (_, found)) in rows.zip(words).filter(|(_, (expected, found))| expected != found) {
                    worst = MutantClass::Legal;
                    let mut legal = vec![Accept::ANY; outputs];
                    member.formula.promised_interval(member.spec.kind, inputs, options.profile, &mut legal);
                    let is_legal = |(word, legal): (&u32, &Accept)| {
                        legal.is_any() || legal.contains(f64::from(f32::from_bits(*word)))
                    };
                    if !found.iter().zip(&legal).all(is_legal) {
                        return Ok(MutantClass::Missed);
                    }
                }
            }
        }
    }
}

fn is_legal(value: &[f64; 4], legal: &LegalPixel) -> bool {
    (0..4).all(|k| legal.low[k] <= value[k] && value[k] <= legal.high[k])
}
