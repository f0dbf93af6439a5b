//! Frames on a device: scenes at the rungs of the ladder, techniques against each other, and how time grows with work.
//!
//! Errors are of every component of every pixel whose coverage and winner are settled, against the f64 reference. A driver that
//! computes on the processor draws what is timed in the errors' size; any other, on which such a frame is over before it has
//! begun, in 1,024 pixels.

mod drawing;
mod frames;
mod scaling;
mod techniques;

pub use scaling::{SCALINGS, scalings};
pub use techniques::{technique_ids, techniques};

use super::Setting;
use super::ended::{BenchError, unless_stopped};
use super::errors::Gathered;
use super::turns::{self, Effort, Entry};
use drawing::{Drawer, Plan, Standard};
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::{builtin, scene_id};
use lightmeter_document::bench::{BenchGroup, BenchRow, GroupKind};
use lightmeter_document::event::{Event, Observer, Stop};
use lightmeter_engine::subject::Subject;
use lightmeter_gpu::compose::{Recipe, ShaderForm};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_gpu::{Clock, ClockReading, Gpu, Rung, Shaders};
use lightmeter_judge::image::file::StoredImage;
use lightmeter_reference::render::render;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;
use std::hint::black_box;
use std::time::Instant;

/// Pixels of the longer side of what a device other than the processor is timed by.
const TIMED: u32 = 1024;
/// Pixels of the longer side of what errors are of.
const SIZE: u32 = 128;
/// The same of a quick bench.
const SIZE_QUICK: u32 = 64;
/// Turns of the processor's rows, which are slow, at most.
const TURNS: usize = 2;

/// The scenes of a quick bench: lit at vertices and at fragments, in fog, by a spotlight, blended.
pub const QUICK: [&str; 5] = ["fog-exp2-opengl", "gouraud", "phong-blinn", "spotlight", "translucent-square"];

/// Every built-in scene.
#[must_use]
pub fn all() -> Vec<&'static str> {
    SCENES.map(|(name, _)| name).to_vec()
}

/// What is drawn on, by what rules, and how much.
pub struct On<'a> {
    /// The adapter; nothing is measured of the embedded implementation, which has no device.
    pub subject: &'a Subject,
    /// A device of the adapter.
    pub gpu: Option<&'a Gpu>,
    /// The shaders.
    pub shaders: &'a Shaders,
    /// How the device's time is told.
    pub clock: &'a Clock,
    /// The accuracy rules.
    pub profile: &'a Profile,
    /// How much.
    pub setting: Setting,
    /// Ends it before its time.
    pub stop: &'a Stop,
}

/// Scenes by their names, each drawn at the rungs of the ladder, put behind the groups that are there; the reason beside a rung says
/// why the device has it not.
///
/// # Errors
/// Where a shader is invalid, the device fails or somebody stops it.
///
/// # Panics
/// Where a name is of no built-in scene.
pub fn scenes(
    on: &On<'_>,
    ladder: &[(Rung, Option<String>)],
    names: &[&str],
    groups: &mut Vec<BenchGroup>,
    observer: &mut dyn Observer,
) -> Result<(), BenchError> {
    let size = if on.setting.quick { SIZE_QUICK } else { SIZE };
    for name in names {
        let place = SCENES.iter().position(|(own, _)| own == name).expect("the scene is built in");
        observer.see(&Event::Group(&scene_id(place)));
        let loaded = builtin(place, Some(size)).expect("built-in scenes are loaded by a test");
        groups.extend(scene(on, ladder, scene_id(place), loaded.title, loaded.frame)?);
        observer.see(&Event::Advanced(1));
    }
    Ok(())
}

/// The frame in binary32, where the device draws, and blends if that is asked for, on such a target; else as it is.
fn widened(gpu: &Gpu, mut frame: Frame) -> Frame {
    let own = std::mem::replace(&mut frame.target.format, TargetFormat::Rgba32Float);
    if SceneRenderer::lacks(gpu, &frame).is_some() {
        frame.target.format = own;
    }
    frame
}

/// A frame from anywhere, in its own size, at the rungs of the ladder.
///
/// # Errors
/// Where a shader is invalid, the device fails or somebody stops it.
pub fn scene(
    on: &On<'_>,
    ladder: &[(Rung, Option<String>)],
    id: String,
    title: String,
    frame: Frame,
) -> Result<Option<BenchGroup>, BenchError> {
    let Some(drawer) = Drawer::new(on) else { return Ok(None) };
    unless_stopped(on.stop)?;
    let frame = widened(drawer.gpu, frame);
    let standard = drawer.standard(frame);
    let mut plans = vec![];
    for (rung, unavailable) in ladder {
        plans.push(Plan {
            name: rung.name().into(),
            what: what(*rung).into(),
            frame: &standard.frame,
            recipe: Recipe { rung: *rung, ..Recipe::of(ShaderForm::Composed) },
            claims_exact: rung.is_exact(),
            own: rung.is_exact().then_some(&standard),
            unavailable: unavailable.clone(),
        });
    }
    let drawn = drawer.draw(&plans, &standard)?;
    let baseline = plans.iter().position(|plan| plan.name == Rung::F32.name());
    let mut rows = drawer.rows(&drawn, baseline, on.setting.effort)?;
    rows.extend(processor(&drawer, &standard, on.setting.effort)?);
    let format = standard.frame.target.format.name();
    Ok(Some(BenchGroup {
        id,
        kind: GroupKind::Scene,
        family: "scene".into(),
        title,
        ideal: format!("the f64 reference, drawn on {format}"),
        baseline: Rung::F32.name().into(),
        unit: "frame".into(),
        work: drawer.work(&standard, &[&standard]),
        rows,
        front: vec![],
    }))
}

/// What a rung's shaders compute in.
const fn what(rung: Rung) -> &'static str {
    match rung {
        Rung::F16 => "drawn by the device, its shaders in binary16",
        Rung::Cheap => "drawn by the device, its shaders in binary32 with cheap approximations",
        Rung::F32 => "drawn by the device, its shaders in binary32",
        Rung::Stable => "drawn by the device, its shaders in binary32 in stable forms",
        Rung::DoubleFloat => "drawn by the device, its shaders in sums of two binary32",
        Rung::F64 => "drawn by the device, its shaders in binary64",
    }
}

/// What a row of the processor draws.
type Draw = Box<dyn Fn(&Frame) + Send + Sync>;

/// The rows of the processor: a name, what it is, and what it draws.
fn kinds(profile: Profile) -> [(&'static str, &'static str, Draw); 3] {
    [
        (
            "cpu-f32",
            "the reference renderer in f32, on one core",
            Box::new(|frame| drop(black_box(render::<f32>(frame, None, None)))),
        ),
        (
            "cpu-f64",
            "the reference renderer in f64, on one core",
            Box::new(|frame| drop(black_box(render::<f64>(frame, None, None)))),
        ),
        (
            "cpu-accept",
            "the legal values of every pixel by the accuracy rules, on one core; its error is how far they reach",
            Box::new(move |frame| drop(black_box(lightmeter_judge::image::expect(frame, None, None, &profile)))),
        ),
    ]
}

/// The reference renderer on one core, in turns of its own.
fn processor(drawer: &Drawer<'_>, standard: &Standard, effort: Effort) -> Result<Vec<BenchRow>, BenchError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    let frame = &standard.frame;
    let kinds = kinds(drawer.profile);
    // A larger frame than the errors' is the device's alone: the processor's time is brought to it.
    let share = drawer.share(frame);
    let mut entries: Vec<Entry<'_>> = vec![];
    for (_, _, draw) in &kinds {
        let pool = &pool;
        entries.push(Entry::new("processor", share, 64, move |amount| {
            Ok(pool.install(|| {
                let start = Instant::now();
                (0..amount).for_each(|_| draw(frame));
                ClockReading::Seconds(start.elapsed().as_secs_f64())
            }))
        }));
    }
    let laps = turns::measure(&mut entries, Effort { turns: effort.turns.min(TURNS), ..effort }, drawer.stop)?;
    let rows = kinds.iter().enumerate().map(|(k, (name, what, _))| {
        let image = match *name {
            _ if !drawer.judges => None,
            "cpu-f32" => Some(StoredImage::unrounded(&render::<f32>(frame, None, None), frame.target.format)),
            "cpu-f64" => Some(standard.reference.clone()),
            _ => None,
        };
        let reach = (image.is_none() && drawer.judges).then(|| standard.farthest());
        let mut time = turns::time("processor", &laps[k], (k > 0).then(|| &laps[0]));
        if let Some(time) = time.as_mut().filter(|_| share < 1.0) {
            time.note = Some("of a smaller frame, and as many times that as there are more pixels".into());
        }
        BenchRow {
            name: (*name).into(),
            what: (*what).into(),
            claims_exact: *name != "cpu-accept",
            unavailable: None,
            as_f32: false,
            disqualified: image.as_ref().and_then(|image| drawer.outside(image, standard)),
            random: image.as_ref().or(reach.as_ref()).and_then(|image| drawing::errors(image, standard, &[standard])),
            hard: None,
            rounding: None,
            time,
            compile_ms: None,
        }
    });
    Ok(rows.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_document::bench::Rank;
    use lightmeter_document::event::Silent;
    use lightmeter_gpu::adapters;

    #[test]
    fn a_scene_has_a_row_for_each_rung_and_for_the_processor() {
        if crate::lacks_driver() {
            return;
        }
        let adapter = adapters().into_iter().next().expect("there is an adapter");
        let subject = lightmeter_subject_gpu::open_device(&adapter).unwrap_or_else(|error| panic!("{error}"));
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        let clock = Clock::wall(None);
        let (setting, stop) = (Setting::new(true, 1), Stop::default());
        let on = On {
            subject: &subject,
            gpu: lightmeter_subject_gpu::gpu(&subject),
            shaders: &shaders,
            clock: &clock,
            profile: &WGSL,
            setting,
            stop: &stop,
        };
        let ladder = [(Rung::F32, None), (Rung::F64, Some("a reason".to_owned()))];
        let mut made = vec![];
        scenes(&on, &ladder, &["gouraud"], &mut made, &mut Silent).unwrap_or_else(|error| panic!("{error}"));
        let [group] = made.as_slice() else { panic!("{} groups", made.len()) };
        assert_eq!((group.id.as_str(), group.baseline.as_str()), ("scene/gouraud", "f32"));
        let names: Vec<&str> = group.rows.iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names, ["f32", "f64", "cpu-f32", "cpu-f64", "cpu-accept"]);
        let [f32, f64, cpu32, cpu64, accept] = group.rows.as_slice() else { panic!("five rows") };
        assert_eq!(f32.time.as_ref().map(|time| time.verdict), Some(Rank::Baseline));
        assert_eq!((f64.unavailable.as_deref(), f64.time.is_none()), (Some("a reason"), true));
        let max = |row: &BenchRow| row.random.as_ref().map(|errors| errors.absolute.max.0);
        assert!(max(cpu64) == Some(0.0) && max(cpu32) > Some(0.0) && max(accept) > max(cpu32));
        for row in [f32, cpu32, cpu64, accept] {
            assert_eq!((&row.disqualified, row.time.is_some()), (&None, true), "{}", row.name);
        }
        assert!(accept.time.as_ref().map(|time| time.ns) > cpu64.time.as_ref().map(|time| time.ns));
    }
}
