//! Techniques of drawing against each other: where light and fog are computed, composed shaders against switches, targets.

use super::drawing::{Drawer, Plan, Standard, side, sized};
use super::{On, Setting, frames};
use crate::ended::BenchError;
use lightmeter_document::bench::{BenchGroup, GroupKind};
use lightmeter_document::event::{Event, Observer};
use lightmeter_gpu::Rung;
use lightmeter_gpu::compose::{Recipe, ShaderForm, Technique};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;

/// Pixels of a frame's side.
const SIDE: u32 = 256;
/// The same of a quick bench.
const SIDE_QUICK: u32 = 96;
/// Rings of the ball that is lit at different frequencies, and of the finer one.
const RINGS: [u32; 2] = [16, 64];

/// The ids of the groups.
#[must_use]
pub fn technique_ids() -> Vec<&'static str> {
    comparisons().into_iter().map(|comparison| comparison.id).collect()
}

/// The groups of these ids, each way to draw at the rungs of the ladder: put behind those that are there.
///
/// # Errors
/// Where a shader is invalid, the device fails or somebody stops it.
pub fn techniques(
    on: &On<'_>,
    ladder: &[(Rung, Option<String>)],
    ids: &[&str],
    groups: &mut Vec<BenchGroup>,
    observer: &mut dyn Observer,
) -> Result<(), BenchError> {
    let Some(drawer) = Drawer::new(on) else { return Ok(()) };
    for comparison in comparisons().into_iter().filter(|comparison| ids.contains(&comparison.id)) {
        observer.see(&Event::Group(comparison.id));
        groups.push(comparison.measure(&drawer, ladder, &on.setting)?);
        observer.see(&Event::Advanced(1));
    }
    Ok(())
}

/// Ways to draw the same.
struct Comparison {
    id: &'static str,
    title: &'static str,
    ideal: &'static str,
    baseline: &'static str,
    /// What errors are against.
    exact: Frame,
    ways: Vec<Way>,
}

/// A way to draw.
struct Way {
    name: String,
    what: String,
    frame: Frame,
    recipe: Recipe,
    /// Whether it computes what the ideal does, so that its pixels must be legal.
    claims_exact: bool,
    /// Whether the reference draws the frame this way.
    has_reference: bool,
}

impl Way {
    /// As the frame has it, which the reference draws the same way.
    fn plain(name: &str, what: impl Into<String>, frame: Frame) -> Self {
        let recipe = Recipe::of(ShaderForm::Composed);
        Self { name: name.into(), what: what.into(), frame, recipe, claims_exact: false, has_reference: true }
    }

    fn exact(self) -> Self {
        Self { claims_exact: true, ..self }
    }

    fn by(self, technique: Technique) -> Self {
        Self { recipe: Recipe { technique, ..self.recipe }, has_reference: false, ..self }
    }
}

impl Comparison {
    fn measure(
        &self,
        drawer: &Drawer<'_>,
        ladder: &[(Rung, Option<String>)],
        setting: &Setting,
    ) -> Result<BenchGroup, BenchError> {
        let standards = self.standards(drawer, side(setting, SIDE, SIDE_QUICK));
        let plans = self.plans(&standards, ladder);
        let drawn = drawer.draw(&plans, &standards[0])?;
        let baseline = plans.iter().position(|plan| plan.name == self.baseline);
        let rows = drawer.rows(&drawn, baseline, setting.effort)?;
        Ok(BenchGroup {
            id: self.id.into(),
            kind: GroupKind::Technique,
            family: "technique".into(),
            title: self.title.into(),
            ideal: self.ideal.into(),
            baseline: self.baseline.into(),
            unit: "frame".into(),
            work: drawer.work(&standards[0], &[&standards[0]]),
            rows,
            front: vec![],
        })
    }

    /// The frames of a size with their references, that of the ideal first.
    fn standards(&self, drawer: &Drawer<'_>, side: u32) -> Vec<Standard> {
        let mut standards: Vec<Standard> = vec![];
        for frame in std::iter::once(&self.exact).chain(self.ways.iter().map(|way| &way.frame)) {
            let frame = sized(frame.clone(), side);
            if !standards.iter().any(|known| known.frame == frame) {
                standards.push(drawer.standard(frame));
            }
        }
        standards
    }

    fn plans<'a>(&self, standards: &'a [Standard], ladder: &[(Rung, Option<String>)]) -> Vec<Plan<'a>> {
        let side = standards[0].frame.target.width.max(standards[0].frame.target.height);
        let plan = |way: &Way, rung: Rung, unavailable: &Option<String>| {
            let frame = sized(way.frame.clone(), side);
            let own = standards.iter().find(|known| known.frame == frame).expect("each way has its standard");
            let (name, what) = match rung {
                Rung::F32 => (way.name.clone(), way.what.clone()),
                _ => (format!("{} {}", way.name, rung.name()), format!("{}; {}", way.what, super::what(rung))),
            };
            Plan {
                name,
                what,
                frame: &own.frame,
                recipe: Recipe { rung, ..way.recipe },
                claims_exact: way.claims_exact && rung.is_exact(),
                own: (way.has_reference && rung.is_exact()).then_some(own),
                unavailable: unavailable.clone(),
            }
        };
        let ways = self.ways.iter();
        ways.flat_map(|way| ladder.iter().map(move |(rung, unavailable)| (way, *rung, unavailable)))
            .map(|(way, rung, unavailable)| plan(way, rung, unavailable))
            .collect()
    }
}

fn comparisons() -> Vec<Comparison> {
    let [coarse, fine] = RINGS;
    vec![
        shading("technique/shading", "a ball of 16 rings lit once a face, at its vertices, at its fragments", coarse),
        shading(
            "technique/shading-fine",
            "a ball of 64 rings lit once a face, at its vertices, at its fragments",
            fine,
        ),
        fog_place(),
        vectors(),
        switches(),
        targets("technique/targets", "what a target holds of a frame, format by format", frames::builtin("phong")),
        targets(
            "technique/blended-targets",
            "what a target holds of a square behind four translucent ones, format by format",
            frames::layers(),
        ),
    ]
}

fn shading(id: &'static str, title: &'static str, rings: u32) -> Comparison {
    let way = |name: &str, what: &str| Way::plain(name, what, frames::ball(name, rings));
    Comparison {
        id,
        title,
        ideal: "lit at every fragment, in f64",
        baseline: "phong",
        exact: frames::ball("phong", rings),
        ways: vec![
            way("flat", "lit once a face, at its provoking vertex"),
            way("gouraud", "lit at the vertices, the colour interpolated"),
            way("phong", "lit at every fragment").exact(),
        ],
    }
}

fn fog_place() -> Comparison {
    let frame = frames::fog();
    Comparison {
        id: "technique/fog-place",
        title: "the fog's factor at the vertices of large triangles, and at their fragments",
        ideal: "the factor at every fragment, in f64",
        baseline: "fragment",
        exact: frame.clone(),
        ways: vec![
            Way::plain("vertex", "the factor at the vertices, interpolated", frame.clone()).by(Technique::FogAtVertex),
            Way::plain("fragment", "the factor at every fragment", frame).exact(),
        ],
    }
}

fn vectors() -> Comparison {
    let mut frame = frames::builtin("phong");
    frame.target.format = TargetFormat::Rgba32Float;
    Comparison {
        id: "technique/vectors",
        title: "003's Phong program: N, L and V interpolated, and computed at the fragments",
        ideal: "L and V at every fragment from the interpolated position, in f64",
        baseline: "computed",
        exact: frame.clone(),
        ways: vec![
            Way::plain("interpolated", "N, L and V from the vertices, normalised at the fragment", frame.clone())
                .by(Technique::VectorsInterpolated),
            Way::plain("unit", "the same, L and V normalised at the vertices already", frame.clone())
                .by(Technique::UnitVectorsInterpolated),
            Way::plain("computed", "L and V at the fragment, from the interpolated position", frame).exact(),
        ],
    }
}

fn switches() -> Comparison {
    let mut frame = frames::builtin("phong");
    frame.target.format = TargetFormat::Rgba32Float;
    let full = Recipe::of(ShaderForm::Full);
    let composed = "the effects that each object calls for, and no others";
    Comparison {
        id: "technique/switches",
        title: "a shader composed of the effects that are called for, and one with all of them behind switches",
        ideal: "the f64 reference",
        baseline: "composed",
        exact: frame.clone(),
        ways: vec![
            Way::plain("composed", composed, frame.clone()).exact(),
            Way { recipe: full, ..Way::plain("full", "all effects, each behind a uniform switch", frame).exact() },
        ],
    }
}

fn targets(id: &'static str, title: &'static str, mut frame: Frame) -> Comparison {
    let mut on = |format: TargetFormat| {
        frame.target.format = format;
        frame.clone()
    };
    let formats = [
        TargetFormat::Rgba8Unorm,
        TargetFormat::Rgba8UnormSrgb,
        TargetFormat::Bgra8Unorm,
        TargetFormat::Rgba16Float,
        TargetFormat::Rgba32Float,
    ];
    let ways = formats.map(|format| {
        Way::plain(format.name(), format!("drawn to and blended on {}", format.name()), on(format)).exact()
    });
    Comparison {
        id,
        title,
        ideal: "the f64 reference before any store; what is stored is decoded to linear values",
        baseline: TargetFormat::Rgba8Unorm.name(),
        exact: on(TargetFormat::Rgba32Float),
        ways: ways.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::drawing::tests::{brighter, on_a_device};
    use lightmeter_document::bench::BenchRow;

    #[test]
    fn a_row_that_draws_something_else_is_seen_in_every_group() {
        if crate::lacks_driver() {
            return;
        }
        on_a_device(|drawer| {
            for comparison in comparisons() {
                let standards = comparison.standards(drawer, 48);
                let mut plans = comparison.plans(&standards, &[(Rung::F32, None)]);
                let rows = |plans: &[Plan<'_>]| -> Vec<BenchRow> {
                    let drawn = drawer.draw(plans, &standards[0]).unwrap_or_else(|error| panic!("{error}"));
                    drawn.into_iter().map(|drawn| drawn.row).collect()
                };
                let right = rows(&plans);
                let frames: Vec<Frame> = plans.iter().map(|plan| brighter(plan.frame)).collect();
                plans.iter_mut().zip(&frames).for_each(|(plan, frame)| plan.frame = frame);
                for (way, (right, wrong)) in comparison.ways.iter().zip(right.iter().zip(rows(&plans))) {
                    let what = format!("{} of {}", way.name, comparison.id);
                    if right.unavailable.is_some() {
                        continue;
                    }
                    assert_eq!(right.disqualified, None, "{what}");
                    assert_eq!(wrong.disqualified.is_some(), way.has_reference, "{what}");
                    let mean = |row: &BenchRow| row.random.as_ref().map_or(f64::NAN, |errors| errors.absolute.mean.0);
                    assert!((mean(right) - mean(&wrong)).abs() > 1e-4, "{what}: {} {}", mean(right), mean(&wrong));
                }
            }
        });
    }

    #[test]
    fn techniques_are_told_apart_by_their_errors() {
        if crate::lacks_driver() {
            return;
        }
        on_a_device(|drawer| {
            let errors = |id: &str| -> Vec<(String, f64, bool)> {
                let comparison = comparisons().into_iter().find(|comparison| comparison.id == id).expect("it is there");
                let standards = comparison.standards(drawer, 48);
                let drawn = drawer.draw(&comparison.plans(&standards, &[(Rung::F32, None)]), &standards[0]);
                let rows = drawn.unwrap_or_else(|error| panic!("{error}")).into_iter().map(|drawn| drawn.row);
                let of = |row: BenchRow| {
                    let max = row.random.map_or(f64::NAN, |errors| errors.absolute.max.0);
                    (row.name, max, row.rounding.is_some())
                };
                rows.map(of).collect()
            };
            let of = |rows: &[(String, f64, bool)], name: &str| rows.iter().find(|row| row.0 == name).expect("a row").1;
            let shading = errors("technique/shading");
            assert!(of(&shading, "flat") > of(&shading, "gouraud") && of(&shading, "gouraud") > 0.1, "{shading:?}");
            assert!(of(&shading, "phong") < 1e-4, "{shading:?}");
            assert_eq!(shading.iter().map(|row| row.2).collect::<Vec<_>>(), [true, true, false], "{shading:?}");
            let fine = errors("technique/shading-fine");
            assert!(of(&fine, "gouraud") < 0.5 * of(&shading, "gouraud"), "{fine:?}");
            let fog = errors("technique/fog-place");
            assert!(of(&fog, "vertex") > 0.05 && of(&fog, "fragment") < 1e-5, "{fog:?}");
            let vectors = errors("technique/vectors");
            assert!(of(&vectors, "interpolated") < 1e-4 && of(&vectors, "unit") > 1e-3, "{vectors:?}");
        });
    }
}
