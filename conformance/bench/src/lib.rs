//! What accuracy costs in time: techniques and rungs of the ladder, each with its error against the f64 reference and with the
//! time that it takes.

mod claims;
mod contest;
pub mod ended;
pub mod errors;
pub mod fit;
mod formulas;
mod growth;
pub mod scenes;
mod sittings;
#[cfg(test)]
#[path = "../../../tests/src/skip.rs"]
#[expect(unreachable_pub, reason = "the library of the tests has it as well")]
mod skip;
pub mod techniques;
pub mod turns;

use ended::BenchError;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::scene::Loaded;
use lightmeter_catalogue::select::{Member, catalogue};
use lightmeter_document::bench::{BenchDocument, BenchGroup, ClockUse, Family, GroupKind, Measured, SCHEMA, Scaling};
use lightmeter_document::bench::{ladder, pareto};
use lightmeter_document::event::{Event, Observer, Stop};
use lightmeter_engine::options::Adapted;
use lightmeter_engine::subject::Subject;
use lightmeter_gpu::{Clock, ClockKind, Gpu, GpuError, Rung, Shaders};
use std::time::Instant;
use turns::Effort;

/// What is measured, and how.
pub struct BenchOptions {
    /// Which groups, by their ids.
    pub filter: Filter,
    /// Scenes from files, by a name of their own; where there are some and no filter, nothing else is measured.
    pub scenes: Vec<(String, Loaded)>,
    /// Less of all, within a minute.
    pub quick: bool,
    /// What inputs are drawn from.
    pub seed: u64,
    /// The clock that is asked for; `None` for the device's where it has one.
    pub clock: Option<ClockKind>,
    /// The accuracy rules.
    pub profile: &'static Profile,
    /// The shaders.
    pub shaders: Shaders,
    /// A shader as somebody wrote it, which is measured beside them.
    pub own: Option<OwnShader>,
    /// The command that asks for it.
    pub command: String,
    /// Ends it before its time.
    pub stop: Stop,
}

/// A shader as somebody wrote it, made the function of formulas.
pub struct OwnShader {
    /// What it is called in tables.
    pub name: String,
    /// The WGSL.
    pub shaders: Shaders,
    /// The formulas that it is, and how they are judged of it.
    pub adapted: Vec<Adapted>,
}

impl OwnShader {
    /// A formula as it is judged of the shader, which all contenders then are.
    fn applied(&self, member: Member) -> Member {
        match self.adapted.iter().find(|adapted| adapted.id == member.spec.id) {
            Some(adapted) => adapted.applied(member),
            None => member,
        }
    }
}

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Sittings: each on devices of its own, with everything compiled anew.
    pub sittings: usize,
    /// Turns of a sitting, and their length.
    pub effort: Effort,
    /// Whether errors are told, too, as in the first sitting.
    pub judges: bool,
    /// Random cases of a group.
    pub cases: u64,
    /// What they are drawn from.
    pub seed: u64,
    /// Whether it is to be done within a minute.
    pub quick: bool,
}

impl Setting {
    /// As the options ask.
    #[must_use]
    pub const fn new(quick: bool, seed: u64) -> Self {
        let (sittings, effort, cases) = if quick {
            (2, Effort { turns: 2, readings: 2, seconds: 5e-4 }, 512)
        } else {
            (3, Effort { turns: 3, readings: 2, seconds: 1e-3 }, 2048)
        };
        Self { sittings, effort, judges: true, cases, seed, quick }
    }
}

/// What measures on an adapter.
struct Bench<'a> {
    gpu: Option<&'a Gpu>,
    clock: Clock,
    shaders: &'a Shaders,
    own: Option<&'a OwnShader>,
    catalogue: &'a [Member],
    /// The rungs, each with the reason why the adapter has it not.
    ladder: &'a [(Rung, Option<String>)],
    /// The rules that values are held to, the driver's known deviations granted.
    profile: Profile,
    setting: Setting,
    stop: &'a Stop,
}

/// Notes what is under way, for a bench that is stopped.
struct Noted<'a> {
    observer: &'a mut dyn Observer,
    under_way: String,
}

impl Observer for Noted<'_> {
    fn see(&mut self, event: &Event<'_>) {
        if let Event::Group(id) = event {
            (*id).clone_into(&mut self.under_way);
        }
        self.observer.see(event);
    }
}

/// What a quick bench measures of the formulas: one or two of each family.
const QUICK: [&str; 12] = [
    "interpolation/perspective",
    "interpolation/triangle",
    "color/srgb-encode",
    "vector/normalize",
    "vector/reflect",
    "lighting/phong",
    "lighting/blinn",
    "attenuation/polynomial",
    "fog/exp",
    "fog/exp2-opengl",
    "depth/recovered",
    "blend/state",
];

/// Measures everything that is asked for, until somebody stops it. A group that is under way then is left out.
///
/// # Errors
/// Where a shader is invalid or a device fails.
pub fn bench(
    subjects: &[Subject],
    options: &BenchOptions,
    observer: &mut dyn Observer,
) -> Result<BenchDocument, GpuError> {
    let start = Instant::now();
    let setting = Setting::new(options.quick, options.seed);
    let mut observer = Noted { observer, under_way: "the first group".into() };
    let mut adapters = vec![];
    for subject in subjects.iter().take_while(|_| !options.stop.is_set()) {
        adapters.extend(measured(subject, options, setting, &mut observer)?);
    }
    Ok(BenchDocument {
        schema: SCHEMA.into(),
        command: options.command.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        made_at: None,
        quick: options.quick,
        seed: options.seed,
        seconds: start.elapsed().as_secs_f64(),
        cores: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        adapters,
        interrupted: options.stop.interrupted("the bench", &observer.under_way),
    })
}

/// What was measured on an adapter; `None` where it was stopped before anything was.
fn measured(
    subject: &Subject,
    options: &BenchOptions,
    setting: Setting,
    observer: &mut dyn Observer,
) -> Result<Option<Measured>, GpuError> {
    let mut catalogue = catalogue();
    if let Some(own) = &options.own {
        catalogue.retain(|member| own.adapted.iter().any(|adapted| adapted.id == member.spec.id));
        catalogue = catalogue.into_iter().map(|member| own.applied(member)).collect();
    }
    let asked = Asked::new(options, &catalogue, ladder_of(subject)?);
    observer.see(&Event::Begun(setting.sittings as u64 * asked.count(subject)));
    let mut all = vec![];
    let mut use_wall = false;
    while all.len() < setting.sittings && !options.stop.is_set() {
        let setting = Setting { judges: all.is_empty(), ..setting };
        let sitting = sitting(subject, options, setting, &asked, use_wall, observer)?;
        if all.is_empty() && !use_wall && options.clock.is_none() && sitting.clock.tells_nothing() {
            use_wall = true;
        } else {
            all.push(sitting);
        }
    }
    if all.is_empty() {
        return Ok(None);
    }
    let Sitting { mut groups, scalings, clock } = sittings::together(all);
    if options.stop.is_set() && groups.is_empty() && scalings.is_empty() {
        return Ok(None);
    }
    for group in &mut groups {
        for row in &mut group.rows {
            row.as_f32 = row.unavailable.as_deref().is_some_and(Rung::is_as_f32);
        }
        group.front = pareto::front_of(group);
    }
    let identity = subject.identity.clone();
    Ok(Some(Measured {
        adapter: identity.name,
        device: identity.device,
        backend: identity.backend.into(),
        driver: identity.driver,
        is_cpu: lightmeter_subject_gpu::gpu(subject).is_none_or(Gpu::is_cpu),
        clock,
        rungs: formulas::rungs(&asked.ladder),
        families: families(&groups),
        claims: claims::claims(&groups),
        groups,
        scalings,
    }))
}

/// What is to be measured.
struct Asked<'a> {
    catalogue: &'a [Member],
    /// The rungs, each with the reason why the adapter has it not.
    ladder: Vec<(Rung, Option<String>)>,
    formulas: Vec<(String, Vec<&'a Member>)>,
    techniques: Vec<techniques::Techniques>,
    stable: Vec<&'a Member>,
    drawn: Vec<&'static str>,
    scenes: Vec<&'static str>,
    scalings: Vec<&'static str>,
    by_cases: bool,
    /// Scenes from files.
    files: &'a [(String, Loaded)],
}

impl<'a> Asked<'a> {
    fn new(options: &'a BenchOptions, catalogue: &'a [Member], ladder: Vec<(Rung, Option<String>)>) -> Self {
        // What is asked for by name is measured in a quick bench, too.
        let quick = options.quick && options.filter.is_empty() && options.scenes.is_empty();
        let all = options.scenes.is_empty() || !options.filter.is_empty();
        let wanted = |id: &str, is_quick: bool| all && options.filter.selects(id) && (!quick || is_quick);
        let is_stable = |member: &&Member| {
            let id = &member.spec.id;
            member.spec.stable.is_some() && wanted(&format!("stable/{id}"), QUICK_STABLE.contains(&id.as_str()))
        };
        let mut formulas = formulas::groups(catalogue);
        formulas.retain(|(id, _)| wanted(id, QUICK.contains(&id.as_str())));
        let mut drawn = scenes::technique_ids();
        drawn.retain(|id| wanted(id, true));
        let mut named = scenes::all();
        named.retain(|name| wanted(&format!("scene/{name}"), scenes::QUICK.contains(name)));
        let mut scalings = scenes::SCALINGS.to_vec();
        scalings.retain(|name| wanted(&format!("scaling/{name}"), true));
        Self {
            catalogue,
            ladder,
            formulas,
            techniques: techniques::all().into_iter().filter(|group| wanted(group.id, true)).collect(),
            stable: catalogue.iter().filter(is_stable).collect(),
            drawn,
            scenes: named,
            scalings,
            by_cases: wanted("scaling/cases", true),
            files: &options.scenes,
        }
    }

    /// Groups and scalings of a sitting; only formulas are measured without a device.
    fn count(&self, subject: &Subject) -> u64 {
        let drawn = self.drawn.len() + self.scenes.len() + self.files.len() + self.scalings.len();
        let on_device = self.techniques.len() + self.stable.len() + drawn + usize::from(self.by_cases);
        (self.formulas.len() + if lightmeter_subject_gpu::gpu(subject).is_some() { on_device } else { 0 }) as u64
    }
}

/// What is measured at one time, on devices of its own; one that was stopped lacks the groups at the end.
struct Sitting {
    groups: Vec<BenchGroup>,
    scalings: Vec<Scaling>,
    clock: ClockUse,
}

fn sitting(
    subject: &Subject,
    options: &BenchOptions,
    setting: Setting,
    asked: &Asked<'_>,
    use_wall: bool,
    observer: &mut dyn Observer,
) -> Result<Sitting, GpuError> {
    let profile = subject
        .known
        .deviations
        .iter()
        .fold(*options.profile, |profile, known| lightmeter_judge::devices::grant(known, profile));
    // What computes and what draws have devices of their own: Mesa 22.3's llvmpipe loses the time of a dispatch once it has drawn.
    let [computes, draws] = [(); 2].map(|()| lightmeter_subject_gpu::gpu(subject).map(Gpu::sibling).transpose());
    let (computes, draws) = (computes?, draws?);
    let bench = Bench {
        gpu: computes.as_ref(),
        clock: clock(computes.as_ref(), options.clock, use_wall)?,
        shaders: &options.shaders,
        own: options.own.as_ref(),
        catalogue: asked.catalogue,
        ladder: &asked.ladder,
        profile,
        setting,
        stop: &options.stop,
    };
    let drawing = clock(draws.as_ref(), options.clock, use_wall)?;
    let on = scenes::On {
        subject,
        gpu: draws.as_ref(),
        shaders: &options.shaders,
        clock: &drawing,
        profile: options.profile,
        setting,
        stop: &options.stop,
    };
    let (mut groups, mut scalings) = (vec![], vec![]);
    match gather(&bench, &on, asked, &mut groups, &mut scalings, observer) {
        Ok(()) | Err(BenchError::Stopped) => {}
        Err(BenchError::Gpu(error)) => return Err(error),
    }
    let (readings, rejected) = bench.clock.readings();
    let of_drawing = drawing.readings();
    let clock = ClockUse {
        kind: bench.clock.kind().name().into(),
        note: bench.clock.note().map(str::to_owned),
        readings: readings + of_drawing.0,
        rejected: rejected + of_drawing.1,
        grain_ns: [bench.clock.grain_ns(), drawing.grain_ns()].into_iter().flatten().min(),
    };
    Ok(Sitting { groups, scalings, clock })
}

/// Everything that is asked for, group by group: those that are there when it is stopped stay.
fn gather(
    bench: &Bench<'_>,
    on: &scenes::On<'_>,
    asked: &Asked<'_>,
    groups: &mut Vec<BenchGroup>,
    scalings: &mut Vec<Scaling>,
    observer: &mut dyn Observer,
) -> Result<(), BenchError> {
    for (id, members) in &asked.formulas {
        observer.see(&Event::Group(id));
        groups.push(formulas::formula(bench, id, members)?);
        observer.see(&Event::Advanced(1));
    }
    if bench.gpu.is_some() {
        on_device(bench, on, asked, groups, observer)?;
        growths(bench, on, asked, scalings, observer)?;
    }
    Ok(())
}

/// What needs a device: techniques, stable forms and scenes.
fn on_device(
    bench: &Bench<'_>,
    on: &scenes::On<'_>,
    asked: &Asked<'_>,
    groups: &mut Vec<BenchGroup>,
    observer: &mut dyn Observer,
) -> Result<(), BenchError> {
    for group in &asked.techniques {
        observer.see(&Event::Group(group.id));
        groups.push(techniques::techniques(bench, group)?);
        observer.see(&Event::Advanced(1));
    }
    scenes::techniques(on, &asked.ladder, &asked.drawn, groups, observer)?;
    for member in &asked.stable {
        observer.see(&Event::Group(&member.spec.id));
        groups.extend(techniques::stable(bench, member)?);
        observer.see(&Event::Advanced(1));
    }
    scenes::scenes(on, &asked.ladder, &asked.scenes, groups, observer)?;
    for (name, loaded) in asked.files {
        observer.see(&Event::Group(name));
        let (title, frame) = (loaded.title.clone(), loaded.frame.clone());
        groups.extend(scenes::scene(on, &asked.ladder, format!("scene/{name}"), title, frame)?);
        observer.see(&Event::Advanced(1));
    }
    Ok(())
}

/// How time grows with work on a device.
fn growths(
    bench: &Bench<'_>,
    on: &scenes::On<'_>,
    asked: &Asked<'_>,
    scalings: &mut Vec<Scaling>,
    observer: &mut dyn Observer,
) -> Result<(), BenchError> {
    scenes::scalings(on, &asked.scalings, scalings, observer)?;
    if asked.by_cases {
        observer.see(&Event::Group("scaling/cases"));
        scalings.extend(growth::cases(bench)?);
        observer.see(&Event::Advanced(1));
    }
    Ok(())
}

/// Of the stable forms, those of a quick bench.
const QUICK_STABLE: [&str; 2] = ["vector/normalize-scaled", "lighting/cosine-power-by-chord"];

/// The clock of a device, or the one that is asked for.
fn clock(gpu: Option<&Gpu>, asked: Option<ClockKind>, use_wall: bool) -> Result<Clock, GpuError> {
    match (gpu, asked) {
        _ if use_wall => Ok(Clock::wall(Some("every one of its timestamps was one that cannot be true".into()))),
        (None, _) => Ok(Clock::wall(Some("the embedded implementation has no device".into()))),
        (_, Some(ClockKind::Wall)) => Ok(Clock::wall(Some("it was asked for".into()))),
        (Some(gpu), _) => Clock::new(gpu),
    }
}

/// The rungs of a subject, each with the reason why it is not there.
fn ladder_of(subject: &Subject) -> Result<Vec<(Rung, Option<String>)>, GpuError> {
    let of = |rung: Rung| match lightmeter_subject_gpu::gpu(subject) {
        None => Ok((rung, Some("the embedded implementation has no shaders".into()))),
        Some(gpu) => Ok((rung, rung.unavailable(gpu)?)),
    };
    Rung::ALL.into_iter().map(of).collect()
}

/// The families whose formulas, or scenes, were measured beside f32.
fn families(groups: &[BenchGroup]) -> Vec<Family> {
    let mut families: Vec<Family> = vec![];
    let is_of_ladder = |group: &&BenchGroup| group.kind != GroupKind::Technique && group.baseline == Rung::F32.name();
    for group in groups.iter().filter(is_of_ladder) {
        if families.iter().all(|family| family.id != group.family) {
            let of = groups.iter().filter(is_of_ladder).filter(|other| other.family == group.family);
            families.push(ladder::family(&group.family, of));
        }
    }
    families
}

/// Whether this thread's test is skipped for want of a driver.
#[cfg(test)]
fn lacks_driver() -> bool {
    skip::lacks(lightmeter_gpu::native_adapters().is_empty(), skip::DRIVER)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use std::sync::atomic::Ordering;

    /// Stops a bench when `groups` groups are done.
    struct StopsAfter {
        stop: Stop,
        groups: usize,
    }

    impl Observer for StopsAfter {
        fn see(&mut self, event: &Event<'_>) {
            if let Event::Advanced(_) = event {
                self.groups -= 1;
                if self.groups == 0 {
                    self.stop.flag().store(2, Ordering::Relaxed);
                }
            }
        }
    }

    /// The groups of a quick bench of three formulas in two sittings, and what was under way when it was stopped.
    fn stopped_after(groups: usize) -> (Vec<(String, usize)>, Option<String>) {
        let globs = ["fog/exp", "fog/exp2-opengl", "fog/linear"].map(String::from);
        let options = BenchOptions {
            filter: Filter::new(&globs).expect("they are globs"),
            scenes: vec![],
            quick: true,
            seed: 1,
            clock: None,
            profile: &WGSL,
            shaders: Shaders::built_in().unwrap_or_else(|error| panic!("{error}")),
            own: None,
            command: String::new(),
            stop: Stop::default(),
        };
        let mut observer = StopsAfter { stop: options.stop.clone(), groups };
        let subjects = [Subject::embedded(), Subject::embedded()];
        let document = bench(&subjects, &options, &mut observer).unwrap_or_else(|error| panic!("{error}"));
        let turns = |group: &BenchGroup| {
            let row = group.rows.iter().find(|row| row.name == "cpu-f32").expect("it is everywhere");
            row.time.as_ref().map_or(0, |time| time.turns)
        };
        let groups = document.adapters.iter().flat_map(|measured| &measured.groups);
        let groups = groups.map(|group| (group.id.clone(), turns(group))).collect();
        (groups, document.interrupted.map(|interrupted| interrupted.under_way))
    }

    #[test]
    fn what_was_measured_before_a_bench_was_stopped_is_left() {
        let group = |id: &str, turns| (id.to_owned(), turns);
        let (all, under_way) = stopped_after(100);
        let ids: Vec<&str> = all.iter().map(|(id, _)| id.as_str()).collect();
        assert!(ids.len() == 6 && ids[..3] == ids[3..] && under_way.is_none(), "{all:?}");
        // In the first sitting, in the second, and on the second adapter: 2 turns a sitting.
        assert_eq!(stopped_after(2).0, [group(ids[0], 2), group(ids[1], 2)]);
        let (second, under_way) = stopped_after(4);
        assert_eq!(second, [group(ids[0], 4), group(ids[1], 2), group(ids[2], 2)]);
        assert_eq!(under_way.as_deref(), Some(ids[1]));
        assert_eq!(stopped_after(7).0.len(), 4);
    }
}
