//! How a frame's time grows with lights, with vertices and with pixels.

use super::drawing::{Drawer, sized};
use super::{On, Setting, frames};
use crate::ended::{BenchError, unless_stopped};
use crate::fit::fit;
use crate::turns;
use crate::turns::{Effort, Entry, Laps};
use lightmeter_document::bench::{Scaling, ScalingPoint};
use lightmeter_document::event::{Event, Observer};
use lightmeter_gpu::Clock;
use lightmeter_gpu::compose::{Recipe, ShaderForm};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_scene::frame::{Frame, MOST_LIGHTS};
use std::time::Instant;

/// Frames of a measurement, at most.
const MOST_FRAMES: u32 = 1024;
/// Frames that take this number of seconds are drawn few times.
const SLOW: f64 = 0.1;
/// How often such a frame is drawn.
const FEW: usize = 3;
/// The largest target, and that of a quick bench.
const MOST_PIXELS: [u32; 2] = [4096, 512];
/// The root of the most vertices, and of those of a quick bench.
const MOST_VERTICES: [u32; 2] = [1024, 256];

/// The names of the scalings; ids in a filter are these behind `scaling/`.
pub const SCALINGS: [&str; 3] = ["lights", "vertices", "pixels"];

/// By lights, by vertices and by pixels, those of these names: put behind those that are there.
///
/// # Errors
/// Where a shader is invalid, the device fails or somebody stops it.
pub fn scalings(
    on: &On<'_>,
    names: &[&str],
    scalings: &mut Vec<Scaling>,
    observer: &mut dyn Observer,
) -> Result<(), BenchError> {
    let Some(drawer) = Drawer::new(on) else { return Ok(()) };
    let (gpu, setting) = (drawer.gpu, &on.setting);
    let most = usize::from(setting.quick);
    let powers =
        |first: u32, most: u32| std::iter::successors(Some(first), |k| Some(2 * k)).take_while(move |k| *k <= most);
    let side = match (gpu.is_cpu(), setting.quick) {
        (false, _) => 2048,
        // Mesa 22.3's llvmpipe writes out a loop over few lights and compiles it anew at each draw, some milliseconds that are
        // to be a small part.
        (true, false) => 768,
        (true, true) => 256,
    };
    let step = if setting.quick { 4 } else { 2 };
    let most_lights = u32::try_from(MOST_LIGHTS).unwrap_or(u32::MAX);
    let lights = std::iter::successors(Some(1), |k| Some(step * k)).take_while(|k| *k <= most_lights);
    let kinds: [Kind<'_>; 3] = [
        Kind {
            id: SCALINGS[0],
            what: format!("a ball under point lights, lit at its fragments, on {side} × {side} pixels"),
            unit: "lights",
            steps: lights.map(|count| (u64::from(count), count)).collect(),
            frame: &|count| sized(frames::lights(count), side),
        },
        Kind {
            id: SCALINGS[1],
            what: "a square of a grid on 32 × 32 pixels, lit at its vertices by a point light".into(),
            unit: "vertices",
            steps: powers(32, MOST_VERTICES[most]).map(|side| (u64::from(side) * u64::from(side), side)).collect(),
            frame: &|side| sized(frames::grid(side), 32),
        },
        Kind {
            id: SCALINGS[2],
            what: "a square that fills the target, lit at its fragments by a point light".into(),
            unit: "pixels",
            steps: powers(64, MOST_PIXELS[most]).map(|side| (u64::from(side) * u64::from(side), side)).collect(),
            frame: &|side| sized(frames::sheet("phong"), side),
        },
    ];
    for kind in kinds.into_iter().filter(|kind| names.contains(&kind.id)) {
        observer.see(&Event::Group(&format!("scaling/{}", kind.id)));
        scalings.push(kind.measure(&drawer, setting)?);
        observer.see(&Event::Advanced(1));
    }
    Ok(())
}

/// What grows.
struct Kind<'a> {
    id: &'static str,
    what: String,
    unit: &'static str,
    /// The work of each step, and what its frame is made by.
    steps: Vec<(u64, u32)>,
    frame: &'a dyn Fn(u32) -> Frame,
}

/// A step that can be drawn.
struct Step {
    work: u64,
    renderer: SceneRenderer,
    is_slow: bool,
}

impl Kind<'_> {
    fn measure(self, drawer: &Drawer<'_>, setting: &Setting) -> Result<Scaling, BenchError> {
        let (mut steps, mut unavailable) = (vec![], vec![]);
        for (work, size) in self.steps {
            unless_stopped(drawer.stop)?;
            let frame = (self.frame)(size);
            let most = drawer.gpu.most_pixels();
            if frame.target.width.max(frame.target.height) > most {
                unavailable.push((work, format!("the adapter's targets have {most} pixels of a side at most")));
                continue;
            }
            if let Some(reason) = SceneRenderer::lacks(drawer.gpu, &frame) {
                unavailable.push((work, reason.to_owned()));
                continue;
            }
            let renderer = drawer.renderer(&frame, Recipe::of(ShaderForm::Composed))?;
            // The first one compiles.
            renderer.time(drawer.gpu, &Clock::wall(None), 1)?;
            let start = Instant::now();
            renderer.time(drawer.gpu, &Clock::wall(None), 1)?;
            steps.push(Step { work, renderer, is_slow: start.elapsed().as_secs_f64() > SLOW });
        }
        let laps = laps(drawer, &steps, setting.effort)?;
        let mut points = vec![];
        for (step, laps) in steps.iter().zip(&laps) {
            match turns::time(drawer.clock.kind().name(), laps, None) {
                Some(time) => {
                    points.push(ScalingPoint { work: step.work, ns: time.ns, quartiles_ns: time.quartiles_ns })
                }
                None => unavailable.push((step.work, "every reading of the clock was one that cannot be true".into())),
            }
        }
        Ok(Scaling {
            id: self.id.into(),
            what: self.what,
            unit: self.unit.into(),
            clock: drawer.clock.kind().name().into(),
            fit: fit(&points),
            points,
            unavailable,
        })
    }
}

/// The laps of each step in turns, the slow ones in few of their own.
fn laps(drawer: &Drawer<'_>, steps: &[Step], effort: Effort) -> Result<Vec<Laps>, BenchError> {
    let mut laps: Vec<Laps> = vec![vec![]; steps.len()];
    for is_slow in [false, true] {
        let places: Vec<usize> = (0..steps.len()).filter(|&place| steps[place].is_slow == is_slow).collect();
        if is_slow {
            for _ in 0..FEW.min(effort.turns) {
                for &place in &places {
                    unless_stopped(drawer.stop)?;
                    let reading = steps[place].renderer.time(drawer.gpu, drawer.clock, 1)?;
                    laps[place].push(reading.seconds());
                }
            }
            continue;
        }
        let mut entries: Vec<Entry<'_>> = places
            .iter()
            .map(|&place| {
                let renderer = &steps[place].renderer;
                Entry::new(drawer.clock.kind().name(), 1.0, MOST_FRAMES, |frames| {
                    renderer.time(drawer.gpu, drawer.clock, frames)
                })
            })
            .collect();
        for (place, own) in places.iter().zip(turns::measure(&mut entries, effort, drawer.stop)?) {
            laps[*place] = own;
        }
    }
    Ok(laps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::drawing::tests::on_a_device;

    #[test]
    fn what_is_too_large_for_the_adapter_has_its_reason_and_the_rest_its_times() {
        if crate::lacks_driver() {
            return;
        }
        on_a_device(|drawer| {
            let too_many = drawer.gpu.most_pixels() + 1;
            let kind = Kind {
                id: "pixels",
                what: String::new(),
                unit: "pixels",
                steps: [16, 64, 256, too_many].map(|side| (u64::from(side) * u64::from(side), side)).into(),
                frame: &|side| sized(frames::sheet("phong"), side),
            };
            let setting = Setting::new(true, 1);
            let scaling = kind.measure(drawer, &setting).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(scaling.points.iter().map(|point| point.work).collect::<Vec<_>>(), [256, 4_096, 65_536]);
            assert!(
                scaling.points.iter().all(|point| point.ns > 0.0 && point.quartiles_ns[0] <= point.quartiles_ns[1])
            );
            assert_eq!(scaling.unavailable.len(), 1);
            assert!(scaling.unavailable[0].1.contains("at most"), "{:?}", scaling.unavailable);
        });
    }

    #[test]
    fn frames_hold_the_work_that_is_counted() {
        for count in [1, 7, 64] {
            assert_eq!(frames::lights(count).lights.len(), count as usize);
        }
        for side in [2, 32] {
            let frame = frames::grid(side);
            assert_eq!(frame.meshes[0].positions.len(), (side * side) as usize);
            assert_eq!(frame.meshes[0].triangles.len(), 2 * ((side - 1) * (side - 1)) as usize);
        }
    }
}
