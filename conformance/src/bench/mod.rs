//! What accuracy costs in time: techniques and rungs of the ladder, each with its error against the f64 reference and with the
//! time that it takes.

mod claims;
mod contest;
pub mod document;
pub mod errors;
mod figures;
mod formulas;
mod growth;
pub mod ladder;
pub mod page;
pub mod pareto;
pub mod plot;
pub mod recommend;
#[cfg(test)]
mod synthetic;
mod techniques;
pub mod text;
pub mod turns;

use crate::arithmetic::Profile;
use crate::filter::Filter;
use crate::run::Progress;
use crate::select::catalogue;
use crate::subject::Subject;
use document::{ClockUse, Document, Family, Group, GroupKind, Measured, SCHEMA};
use lightmeter_gpu::{Clock, ClockKind, Error, Gpu, Rung, Shaders};
use std::time::Instant;
use turns::Effort;

/// What is measured, and how.
pub struct Options {
    /// Which groups, by their ids.
    pub filter: Filter,
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
    /// The command that asks for it.
    pub command: String,
}

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Turns and their length.
    pub effort: Effort,
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
        if quick {
            Self { effort: Effort { turns: 5, readings: 2, seconds: 5e-4 }, cases: 512, seed, quick }
        } else {
            Self { effort: Effort { turns: 11, readings: 3, seconds: 1e-3 }, cases: 2048, seed, quick }
        }
    }
}

/// Readings of a clock.
#[derive(Clone, Copy, Debug, Default)]
struct Counted {
    readings: u64,
    rejected: u64,
}

/// What measures on an adapter.
struct Bench<'a> {
    gpu: Option<&'a Gpu>,
    clock: Clock,
    shaders: &'a Shaders,
    /// The rungs, each with the reason why the adapter has it not.
    ladder: Vec<(Rung, Option<String>)>,
    /// The rules that values are held to, the driver's known deviations granted.
    profile: Profile,
    setting: Setting,
    counted: Counted,
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

/// Measures everything that is asked for.
///
/// # Errors
/// Where a shader is invalid or a device fails.
pub fn bench(subjects: &mut [Subject], options: &Options, progress: &mut impl Progress) -> Result<Document, Error> {
    let start = Instant::now();
    let setting = Setting::new(options.quick, options.seed);
    let adapters = subjects
        .iter_mut()
        .map(|subject| measured(subject, options, setting, progress))
        .collect::<Result<_, Error>>()?;
    Ok(Document {
        schema: SCHEMA.into(),
        command: options.command.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        quick: options.quick,
        seed: options.seed,
        seconds: start.elapsed().as_secs_f64(),
        cores: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        adapters,
    })
}

fn measured(
    subject: &mut Subject,
    options: &Options,
    setting: Setting,
    progress: &mut impl Progress,
) -> Result<Measured, Error> {
    let profile = subject.known.deviations.iter().fold(*options.profile, |profile, known| known.grant(profile));
    let mut bench = Bench {
        gpu: subject.gpu(),
        clock: clock(subject, options.clock)?,
        shaders: &options.shaders,
        ladder: ladder_of(subject)?,
        profile,
        setting,
        counted: Counted::default(),
    };
    let catalogue = catalogue();
    let formulas: Vec<_> = formulas::groups(&catalogue)
        .into_iter()
        .filter(|(id, _)| options.filter.selects(id))
        .filter(|(id, _)| !options.quick || !options.filter.is_empty() || QUICK.contains(&id.as_str()))
        .collect();
    let techniques: Vec<_> = techniques::all().into_iter().filter(|group| options.filter.selects(group.id)).collect();
    let stable: Vec<_> = catalogue
        .iter()
        .filter(|member| member.spec.stable.is_some())
        .filter(|member| options.filter.selects(&format!("stable/{}", member.spec.id)))
        .filter(|member| {
            !options.quick || !options.filter.is_empty() || QUICK_STABLE.contains(&member.spec.id.as_str())
        })
        .collect();
    progress.start((formulas.len() + techniques.len() + stable.len()) as u64);
    let mut groups: Vec<Group> = vec![];
    if bench.gpu.is_some() {
        for group in &techniques {
            progress.group(group.id);
            groups.push(techniques::techniques(&mut bench, group)?);
            progress.advance(1);
        }
        for member in stable {
            progress.group(&member.spec.id);
            groups.extend(techniques::stable(&mut bench, member, &catalogue)?);
            progress.advance(1);
        }
    }
    for (id, members) in &formulas {
        progress.group(id);
        groups.push(formulas::formula(&mut bench, id, members)?);
        progress.advance(1);
    }
    let scalings = if options.filter.selects("scaling/cases") { growth::cases(&mut bench)? } else { vec![] };
    let Bench { clock, ladder, counted, .. } = bench;
    let identity = subject.identity.clone();
    let mut measured = Measured {
        adapter: identity.name,
        device: identity.device,
        backend: identity.backend.into(),
        driver: identity.driver,
        is_cpu: subject.gpu().is_none_or(Gpu::is_cpu),
        clock: ClockUse {
            kind: clock.kind().name().into(),
            note: clock.note().map(str::to_owned),
            readings: counted.readings,
            rejected: counted.rejected,
        },
        rungs: formulas::rungs(&ladder),
        groups,
        families: vec![],
        scalings,
        claims: vec![],
    };
    for group in &mut measured.groups {
        group.front = pareto::front_of(group);
    }
    measured.families = families(&measured.groups);
    measured.claims = claims::claims(&measured.groups);
    Ok(measured)
}

/// Of the stable forms, those of a quick bench.
const QUICK_STABLE: [&str; 2] = ["vector/normalize-scaled", "lighting/cosine-power-by-chord"];

/// The clock of a subject, or the one that is asked for.
fn clock(subject: &Subject, asked: Option<ClockKind>) -> Result<Clock, Error> {
    match (subject.gpu(), asked) {
        (None, _) => Ok(Clock::wall(Some("the embedded implementation has no device".into()))),
        (_, Some(ClockKind::Wall)) => Ok(Clock::wall(Some("it was asked for".into()))),
        (Some(gpu), _) => Clock::new(gpu),
    }
}

/// The rungs of a subject, each with the reason why it is not there.
fn ladder_of(subject: &Subject) -> Result<Vec<(Rung, Option<String>)>, Error> {
    let of = |rung: Rung| match subject.gpu() {
        None => Ok((rung, Some("the embedded implementation has no shaders".into()))),
        Some(gpu) => Ok((rung, rung.unavailable(gpu)?)),
    };
    Rung::ALL.into_iter().map(of).collect()
}

/// The families whose formulas, or scenes, were measured beside f32.
fn families(groups: &[Group]) -> Vec<Family> {
    let mut families: Vec<Family> = vec![];
    let is_of_ladder = |group: &&Group| group.kind != GroupKind::Technique && group.baseline == Rung::F32.name();
    for group in groups.iter().filter(is_of_ladder) {
        if families.iter().all(|family| family.id != group.family) {
            let of = groups.iter().filter(is_of_ladder).filter(|other| other.family == group.family);
            families.push(ladder::family(&group.family, of));
        }
    }
    families
}
