//! Rows that are drawn: compiled, drawn once, held against the reference, and timed in turns.

use super::{BenchRow, Gathered, On, Setting, TIMED};
use crate::ended::{BenchError, unless_stopped};
use crate::turns;
use crate::turns::{Effort, Entry};
use lightmeter_arithmetic::Profile;
use lightmeter_document::adapters::Deviation;
use lightmeter_document::bench::Errors;
use lightmeter_document::event::Stop;
use lightmeter_engine::image::verdict::excuse;
use lightmeter_gpu::compose::Recipe;
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_gpu::{Clock, Gpu, GpuError, Shaders};
use lightmeter_judge::blend_unit::pixel::linear;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_judge::image::judge::judge;
use lightmeter_judge::image::{LegalPixel, expect};
use lightmeter_reference::render::render;
use lightmeter_scene::effects::effects;
use lightmeter_scene::frame::Frame;
use std::time::Instant;

/// Frames of a measurement, at most: each is a pass of its own.
const MOST_FRAMES: u32 = 1024;

/// A frame with its f64 image and what is legal of it.
pub(super) struct Standard {
    pub(super) frame: Frame,
    /// In linear values, before any store.
    pub(super) exact: Vec<[f64; 4]>,
    /// The same in the target's units, not rounded.
    pub(super) reference: StoredImage,
    pub(super) expected: Vec<LegalPixel>,
}

impl Standard {
    pub(super) fn new(frame: Frame, profile: &Profile) -> Self {
        let expected = expect(&frame, None, None, profile);
        Self { expected, ..Self::unjudged(frame) }
    }

    /// Of a frame that is only timed.
    fn unjudged(frame: Frame) -> Self {
        let image = render::<f64>(&frame, None, None);
        let reference = StoredImage::unrounded(&image, frame.target.format);
        Self { exact: image.pixels, reference, expected: vec![], frame }
    }

    /// An image of the legal values that are farthest from the reference.
    pub(super) fn farthest(&self) -> StoredImage {
        let mut image = self.reference.clone();
        for (pixel, legal) in image.pixels.iter_mut().zip(&self.expected) {
            *pixel = std::array::from_fn(|k| {
                let (low, high) = (legal.low[k], legal.high[k]);
                if high - pixel[k] > pixel[k] - low { high } else { low }
            });
        }
        image
    }
}

/// A row that is to be drawn.
pub(super) struct Plan<'a> {
    pub(super) name: String,
    pub(super) what: String,
    pub(super) frame: &'a Frame,
    pub(super) recipe: Recipe,
    pub(super) claims_exact: bool,
    /// What the reference makes of this very frame, where it computes the same: pixels outside of what is legal there
    /// disqualify the row.
    pub(super) own: Option<&'a Standard>,
    pub(super) unavailable: Option<String>,
}

/// A row that was drawn.
pub(super) struct DrawnScene {
    pub(super) row: BenchRow,
    /// What it is timed by.
    pub(super) timed: Option<SceneRenderer>,
}

/// What rows are drawn by.
pub(super) struct Drawer<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) shaders: &'a Shaders,
    pub(super) clock: &'a Clock,
    pub(super) profile: Profile,
    deviations: &'a [&'static Deviation],
    /// Whether what is drawn is held against the reference, and not only timed.
    pub(super) judges: bool,
    pub(super) stop: &'a Stop,
}

impl<'a> Drawer<'a> {
    /// `None` of the embedded implementation, which draws on no device.
    pub(super) fn new(on: &On<'a>) -> Option<Self> {
        Some(Self {
            gpu: on.gpu?,
            shaders: on.shaders,
            clock: on.clock,
            profile: on.subject.known.profile(on.profile),
            deviations: &on.subject.known.deviations,
            judges: on.setting.judges,
            stop: on.stop,
        })
    }

    pub(super) fn standard(&self, frame: Frame) -> Standard {
        if self.judges { Standard::new(frame, &self.profile) } else { Standard::unjudged(frame) }
    }

    /// Draws each plan once: its errors against the ideal, what is wrong with it, and how long it took to compile.
    pub(super) fn draw(&self, plans: &[Plan<'_>], ideal: &Standard) -> Result<Vec<DrawnScene>, BenchError> {
        let one = |plan: &Plan<'_>| {
            unless_stopped(self.stop)?;
            Ok(self.one(plan, ideal)?)
        };
        plans.iter().map(one).collect()
    }

    fn one(&self, plan: &Plan<'_>, ideal: &Standard) -> Result<DrawnScene, GpuError> {
        let row = BenchRow {
            name: plan.name.clone(),
            what: plan.what.clone(),
            claims_exact: plan.claims_exact,
            unavailable: plan.unavailable.clone(),
            as_f32: false,
            disqualified: None,
            random: None,
            hard: None,
            rounding: None,
            time: None,
            compile_ms: None,
        };
        let lacking = SceneRenderer::lacks(self.gpu, plan.frame).map(str::to_owned);
        if let Some(reason) = row.unavailable.clone().or(lacking) {
            return Ok(DrawnScene { row: BenchRow { unavailable: Some(reason), ..row }, timed: None });
        }
        let start = Instant::now();
        let renderer = match self.renderer(plan.frame, plan.recipe) {
            Err(GpuError::Technique { reason, .. } | GpuError::Unavailable { reason, .. }) => {
                return Ok(DrawnScene { row: BenchRow { unavailable: Some(reason), ..row }, timed: None });
            }
            made => made?,
        };
        let bytes = SceneRenderer::pixels(self.gpu, renderer.submit(self.gpu))?;
        let compile_ms = Some(1e3 * start.elapsed().as_secs_f64());
        let image = StoredImage::read(plan.frame.target.width as usize, plan.frame.target.format, &bytes);
        let settled: Vec<&Standard> = std::iter::once(ideal).chain(plan.own).collect();
        if !self.judges {
            return Ok(DrawnScene { row: BenchRow { compile_ms, ..row }, timed: Some(self.larger(plan, renderer)?) });
        }
        let row = BenchRow {
            disqualified: plan.own.and_then(|own| self.outside(&image, own)),
            random: errors(&image, ideal, &settled),
            rounding: plan.own.filter(|own| own.exact != ideal.exact).and_then(|own| errors(&image, own, &settled)),
            compile_ms,
            ..row
        };
        Ok(DrawnScene { row, timed: Some(self.larger(plan, renderer)?) })
    }

    /// What is timed in the place of what has been drawn.
    fn larger(&self, plan: &Plan<'_>, drawn: SceneRenderer) -> Result<SceneRenderer, GpuError> {
        let Some(frame) = self.timed(plan.frame) else { return Ok(drawn) };
        let renderer = self.renderer(&frame, plan.recipe)?;
        SceneRenderer::pixels(self.gpu, renderer.submit(self.gpu))?;
        Ok(renderer)
    }

    pub(super) fn renderer(&self, frame: &Frame, recipe: Recipe) -> Result<SceneRenderer, GpuError> {
        SceneRenderer::new(self.gpu, self.shaders, frame, &effects(frame), recipe)
    }

    /// The larger frame that is timed in a frame's place.
    fn timed(&self, frame: &Frame) -> Option<Frame> {
        let longer = frame.target.width.max(frame.target.height);
        (!self.gpu.is_cpu() && longer < TIMED).then(|| sized(frame.clone(), TIMED))
    }

    /// The pixels of a frame over those of what is timed in its place.
    pub(super) fn share(&self, frame: &Frame) -> f64 {
        let pixels = |frame: &Frame| f64::from(frame.target.width) * f64::from(frame.target.height);
        self.timed(frame).map_or(1.0, |larger| pixels(frame) / pixels(&larger))
    }

    pub(super) fn entry<'b>(&'b self, renderer: &'b SceneRenderer) -> Entry<'b> {
        Entry::new(self.clock.kind().name(), 1.0, MOST_FRAMES, |frames| renderer.time(self.gpu, self.clock, frames))
    }

    /// The rows with their times beside that of the baseline.
    pub(super) fn rows(
        &self,
        drawn: &[DrawnScene],
        baseline: Option<usize>,
        effort: Effort,
    ) -> Result<Vec<BenchRow>, BenchError> {
        let places: Vec<usize> = (0..drawn.len()).filter(|&place| drawn[place].timed.is_some()).collect();
        let mut entries: Vec<Entry<'_>> =
            drawn.iter().filter_map(|drawn| drawn.timed.as_ref()).map(|renderer| self.entry(renderer)).collect();
        let laps = turns::measure(&mut entries, effort, self.stop)?;
        let of = |place: usize| places.iter().position(|&own| own == place).map(|k| &laps[k]);
        let base = baseline.and_then(of);
        let rows = drawn.iter().enumerate().map(|(place, drawn)| {
            let against = if Some(place) == baseline { None } else { base };
            let own = of(place);
            let time = own.filter(|_| base.is_some());
            let time = time.and_then(|own| turns::time(self.clock.kind().name(), own, against));
            let reason = own.filter(|_| time.is_none()).map(|own| turns::reason(own).to_owned());
            BenchRow { time, unavailable: drawn.row.unavailable.clone().or(reason), ..drawn.row.clone() }
        });
        Ok(rows.collect())
    }

    /// What of an image is outside of what is legal, named deviations apart; `None` where nothing is.
    pub(super) fn outside(&self, image: &StoredImage, own: &Standard) -> Option<String> {
        let all: Vec<usize> = (0..image.pixels.len()).collect();
        let mut judged = judge(image, &own.reference, &own.expected, &all);
        for deviation in self.deviations {
            if !judged.misses.is_empty() {
                excuse(&mut judged, image, &own.frame, deviation, &self.profile);
            }
        }
        let worst = judged.misses.iter().max_by(|a, b| a.margin.total_cmp(&b.margin))?;
        let (x, y) = (worst.pixel % image.width, worst.pixel / image.width);
        Some(format!(
            "{} of {} components are outside of what is legal, at pixel {x}-{y} {:.3} times its tolerance",
            judged.misses.len(),
            4 * all.len(),
            worst.margin
        ))
    }

    /// What errors and times are over.
    pub(super) fn work(&self, ideal: &Standard, all: &[&Standard]) -> String {
        let open = if self.judges { (0..ideal.exact.len()).filter(|&pixel| is_open(pixel, all)).count() } else { 0 };
        let size = |frame: &Frame| format!("{} × {}", frame.target.width, frame.target.height);
        let timed = self.timed(&ideal.frame);
        let timed = timed.map(|frame| format!("; timed at {}", size(&frame))).unwrap_or_default();
        format!(
            "{} pixels, {} components left out where coverage or the winner is open{timed}",
            size(&ideal.frame),
            4 * open
        )
    }
}

fn is_open(pixel: usize, all: &[&Standard]) -> bool {
    all.iter().any(|standard| standard.expected[pixel].is_marked)
}

/// The errors of an image where all have settled coverage and winners.
pub(super) fn errors(image: &StoredImage, ideal: &Standard, all: &[&Standard]) -> Option<Errors> {
    let mut gathered = Gathered::default();
    for (pixel, (units, exact)) in image.pixels.iter().zip(&ideal.exact).enumerate() {
        for k in 0..4 {
            if is_open(pixel, all) {
                gathered.skip();
            } else {
                gathered.add(linear(image.format.encoding(), k, units[k]), exact[k]);
            }
        }
    }
    gathered.errors()
}

/// The frame with `side` pixels on its longer side.
pub(super) fn sized(mut frame: Frame, side: u32) -> Frame {
    let target = &mut frame.target;
    let longer = target.width.max(target.height);
    let scaled =
        |own: u32| u32::try_from((u64::from(own) * u64::from(side)).div_ceil(u64::from(longer))).unwrap_or(side);
    (target.width, target.height) = (scaled(target.width), scaled(target.height));
    frame
}

/// The size of a technique's frame.
pub(super) const fn side(setting: &Setting, full: u32, quick: u32) -> u32 {
    if setting.quick { quick } else { full }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::scene::library::SCENES;
    use lightmeter_catalogue::scene::select::builtin;
    use lightmeter_gpu::adapters;
    use lightmeter_gpu::compose::ShaderForm;

    /// Checks on the first adapter.
    pub(in super::super) fn on_a_device(check: impl Fn(&Drawer<'_>)) {
        let adapter = adapters().into_iter().next().expect("there is an adapter");
        let subject = lightmeter_subject_gpu::open_device(&adapter).unwrap_or_else(|error| panic!("{error}"));
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        let gpu = lightmeter_subject_gpu::gpu(&subject).expect("an adapter has a device");
        let clock = Clock::new(gpu).unwrap_or_else(|error| panic!("{error}"));
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
        check(&Drawer::new(&on).expect("it has a device"));
    }

    /// The frame with surfaces that are a tenth redder.
    pub(in super::super) fn brighter(frame: &Frame) -> Frame {
        let mut frame = frame.clone();
        frame.draws.iter_mut().for_each(|draw| draw.material.diffuse[0] *= 1.1);
        frame
    }

    fn plan<'a>(frame: &'a Frame, own: &'a Standard, unavailable: Option<&str>) -> Plan<'a> {
        Plan {
            name: "f32".into(),
            what: String::new(),
            frame,
            recipe: Recipe::of(ShaderForm::Composed),
            claims_exact: true,
            own: Some(own),
            unavailable: unavailable.map(str::to_owned),
        }
    }

    #[test]
    fn a_scene_that_is_drawn_wrong_is_disqualified_and_one_that_is_not_has_its_reason() {
        if crate::lacks_driver() {
            return;
        }
        on_a_device(|drawer| {
            for name in super::super::QUICK {
                let place = SCENES.iter().position(|(own, _)| *own == name).expect("it is built in");
                let frame = builtin(place, Some(48)).unwrap_or_else(|error| panic!("{error}")).frame;
                let standard = Standard::new(super::super::widened(drawer.gpu, frame), &drawer.profile);
                let wrong = brighter(&standard.frame);
                let plans = [
                    plan(&standard.frame, &standard, None),
                    plan(&wrong, &standard, None),
                    plan(&standard.frame, &standard, Some("a reason")),
                ];
                let drawn = drawer.draw(&plans, &standard).unwrap_or_else(|error| panic!("{error}"));
                assert_eq!(drawn[0].row.disqualified, None, "{name}");
                let said = drawn[1].row.disqualified.as_deref().unwrap_or_default();
                assert!(said.contains("outside of what is legal"), "{name}: {said:?}");
                let max = |row: &BenchRow| row.random.as_ref().map_or(f64::NAN, |errors| errors.absolute.max.0);
                assert!(max(&drawn[0].row) < 1e-3 && max(&drawn[1].row) > 1e-2, "{name}");
                let absent = &drawn[2];
                assert_eq!(absent.row.unavailable.as_deref(), Some("a reason"));
                assert!(absent.timed.is_none() && absent.row.random.is_none());
                let effort = Effort { turns: 3, readings: 1, seconds: 1e-4 };
                let rows = drawer.rows(&drawn, Some(0), effort).unwrap_or_else(|error| panic!("{error}"));
                let timed: Vec<bool> = rows.iter().map(|row| row.time.is_some()).collect();
                assert_eq!(timed, [true, true, false], "{name}");
            }
        });
    }

    #[test]
    fn a_value_that_is_lost_is_no_small_error() {
        if crate::lacks_driver() {
            return;
        }
        on_a_device(|drawer| {
            let standard = Standard::new(builtin(0, Some(16)).expect("it is built in").frame, &drawer.profile);
            let settled = (0..standard.exact.len()).find(|&pixel| !is_open(pixel, &[&standard])).expect("most are");
            let mut image = standard.reference.clone();
            image.format = lightmeter_scene::target::TargetFormat::Rgba32Float;
            image.pixels.clone_from(&standard.exact);
            image.pixels[settled][1] = f64::NAN;
            let errors = errors(&image, &standard, &[&standard]).expect("pixels are compared");
            assert!(errors.lost == 1 && errors.absolute.max.0 == f64::INFINITY && errors.absolute.mean.0 == 0.0);
        });
    }
}
