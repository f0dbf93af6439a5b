//! What accuracy costs in time: techniques and rungs of the ladder, each with its error against the f64 reference and with the
//! time that it takes.

mod claims;
mod contest;
pub mod document;
pub mod errors;
mod figures;
pub mod fit;
mod formulas;
mod growth;
pub mod ladder;
pub mod page;
pub mod pareto;
pub mod plot;
pub mod recommend;
pub mod scenes;
#[cfg(test)]
mod synthetic;
mod techniques;
pub mod text;
pub mod turns;

use crate::arithmetic::Profile;
use crate::filter::Filter;
use crate::run::Progress;
use crate::scene::Loaded;
use crate::select::{Member, catalogue};
use crate::subject::Subject;
use document::{ClockUse, Document, Family, Group, GroupKind, Measured, SCHEMA, Scaling};
use lightmeter_gpu::{Clock, ClockKind, Error, Gpu, Rung, Shaders};
use std::time::Instant;
use turns::Effort;

/// What is measured, and how.
pub struct Options {
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
            Self { effort: Effort { turns: 11, readings: 4, seconds: 1.5e-3 }, cases: 2048, seed, quick }
        }
    }
}

/// What measures on an adapter.
struct Bench<'a> {
    gpu: Option<&'a Gpu>,
    clock: Clock,
    shaders: &'a Shaders,
    catalogue: &'a [Member],
    /// The rungs, each with the reason why the adapter has it not.
    ladder: Vec<(Rung, Option<String>)>,
    /// The rules that values are held to, the driver's known deviations granted.
    profile: Profile,
    setting: Setting,
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
    // What computes and what draws have devices of their own: Mesa 22.3's llvmpipe loses the time of a dispatch once it has drawn.
    let own = subject.gpu().map(Gpu::sibling).transpose()?;
    let catalogue = catalogue();
    let bench = Bench {
        gpu: own.as_ref(),
        clock: clock(own.as_ref(), options.clock)?,
        shaders: &options.shaders,
        catalogue: &catalogue,
        ladder: ladder_of(subject)?,
        profile,
        setting,
    };
    let asked = |id: &str| options.filter.selects(id);
    // What is asked for by name is measured in a quick bench, too.
    let quick = options.quick && options.filter.is_empty() && options.scenes.is_empty();
    let all = options.scenes.is_empty() || !options.filter.is_empty();
    let wanted = |id: &str, is_quick: &dyn Fn() -> bool| all && asked(id) && (!quick || is_quick());

    let formulas: Vec<_> = formulas::groups(&catalogue)
        .into_iter()
        .filter(|(id, _)| wanted(id, &|| QUICK.contains(&id.as_str())))
        .collect();
    let techniques: Vec<_> = techniques::all().into_iter().filter(|group| wanted(group.id, &|| true)).collect();
    let stable: Vec<&Member> = catalogue
        .iter()
        .filter(|member| member.spec.stable.is_some())
        .filter(|member| {
            wanted(&format!("stable/{}", member.spec.id), &|| QUICK_STABLE.contains(&member.spec.id.as_str()))
        })
        .collect();
    let mut drawn = scenes::technique_ids();
    drawn.retain(|id| wanted(id, &|| true));
    let mut named = scenes::all();
    named.retain(|name| wanted(&format!("scene/{name}"), &|| scenes::QUICK.contains(name)));
    let mut growing = scenes::SCALINGS.to_vec();
    growing.retain(|name| wanted(&format!("scaling/{name}"), &|| true));
    let by_cases = wanted("scaling/cases", &|| true);

    let drawing = clock(subject.gpu(), options.clock)?;
    let on = scenes::On { subject, shaders: &options.shaders, clock: &drawing, profile: options.profile, setting };
    let on_device = techniques.len() + stable.len() + drawn.len() + named.len() + growing.len() + usize::from(by_cases);
    let on_device = if bench.gpu.is_some() { on_device + options.scenes.len() } else { 0 };
    progress.start((formulas.len() + on_device) as u64);
    let (mut groups, mut scalings): (Vec<Group>, Vec<Scaling>) = (vec![], vec![]);
    for (id, members) in &formulas {
        progress.group(id);
        groups.push(formulas::formula(&bench, id, members)?);
        progress.advance(1);
    }
    if bench.gpu.is_some() {
        for group in &techniques {
            progress.group(group.id);
            groups.push(techniques::techniques(&bench, group)?);
            progress.advance(1);
        }
        groups.extend(scenes::techniques(&on, &drawn, progress)?);
        for member in stable {
            progress.group(&member.spec.id);
            groups.extend(techniques::stable(&bench, member)?);
            progress.advance(1);
        }
        groups.extend(scenes::scenes(&on, &bench.ladder, &named, progress)?);
        for (name, loaded) in &options.scenes {
            progress.group(name);
            let (title, frame) = (loaded.title.clone(), loaded.frame.clone());
            groups.extend(scenes::scene(&on, &bench.ladder, format!("scene/{name}"), title, frame)?);
            progress.advance(1);
        }
        scalings.extend(scenes::scalings(&on, &growing, progress)?);
        if by_cases {
            progress.group("scaling/cases");
            scalings.extend(growth::cases(&bench)?);
            progress.advance(1);
        }
    }
    for group in &mut groups {
        group.front = pareto::front_of(group);
    }
    let (readings, rejected) = bench.clock.readings();
    let of_drawing = drawing.readings();
    let identity = subject.identity.clone();
    Ok(Measured {
        adapter: identity.name,
        device: identity.device,
        backend: identity.backend.into(),
        driver: identity.driver,
        is_cpu: subject.gpu().is_none_or(Gpu::is_cpu),
        clock: ClockUse {
            kind: bench.clock.kind().name().into(),
            note: bench.clock.note().map(str::to_owned),
            readings: readings + of_drawing.0,
            rejected: rejected + of_drawing.1,
        },
        rungs: formulas::rungs(&bench.ladder),
        families: families(&groups),
        claims: claims::claims(&groups),
        groups,
        scalings,
    })
}

/// Of the stable forms, those of a quick bench.
const QUICK_STABLE: [&str; 2] = ["vector/normalize-scaled", "lighting/cosine-power-by-chord"];

/// The clock of a device, or the one that is asked for.
fn clock(gpu: Option<&Gpu>, asked: Option<ClockKind>) -> Result<Clock, Error> {
    match (gpu, asked) {
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
