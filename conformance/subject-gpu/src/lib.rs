//! Adapters of wgpu as subjects: what the engine asks of a device, done by `lightmeter_gpu`.

pub mod adapters;
mod blend;
pub mod browser;
mod cost;
mod kernel;
#[cfg(test)]
#[path = "../../../tests/src/skip.rs"]
#[expect(unreachable_pub, reason = "the library of the tests has it as well")]
mod skip;
mod special;
mod stable_cost;
mod sweep;

pub use kernel::kernel;

use kernel::ShaderCode;

use lightmeter_catalogue::cases::{Kind, Stage};
use lightmeter_catalogue::select::Member;
use lightmeter_catalogue::special::Probe;
use lightmeter_document::report::{Cost, EffectsCost, Identity};
use lightmeter_engine::device::{Blocks, Code, Device, DeviceError, Own, Picture, Probed, ReadAhead, Stages};
use lightmeter_engine::piece::{Piece, Pixels};
use lightmeter_engine::rows::Rows;
use lightmeter_engine::subject::Subject;
use lightmeter_gpu::compose::{Recipe, ShaderForm};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_gpu::{
    Adapter, ArithmeticPipeline, BlendUnit, DepthUnit, Gpu, GpuError, Kernel, Pending, RasterPipeline, Shaders,
};
use lightmeter_judge::devices::{Known, known};
use lightmeter_scene::along::Along;
use lightmeter_scene::blend::Route;
use lightmeter_scene::depth::DepthTest;
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;
use std::any::Any;
use std::collections::BTreeMap;
use std::path::Path;

/// Shaders as the code under test.
#[must_use]
pub fn code(shaders: Shaders) -> Code {
    Code::of(ShaderCode::new(shaders))
}

/// The shaders of a code under test; `None` of any other code.
#[must_use]
pub fn shaders_of(code: &Code) -> Option<&Shaders> {
    code.get().map(|code: &ShaderCode| &code.shaders)
}

/// The shaders of a folder, or the built-in ones, as the code under test.
///
/// # Errors
/// Where the folder cannot be read, or holds no shader of the suite.
pub fn code_of(folder: Option<&Path>) -> Result<Code, GpuError> {
    folder.map_or_else(Shaders::built_in, Shaders::from_dir).map(code)
}

/// A subject on an adapter.
///
/// # Errors
/// Where the driver gives no device.
pub fn open_device(adapter: &Adapter) -> Result<Subject, DeviceError> {
    let (identity, known, device) = device_of(adapter)?;
    Ok(Subject::on_device(identity, known, Box::new(device)))
}

fn device_of(adapter: &Adapter) -> Result<(Identity, Known, GpuDevice), DeviceError> {
    let identity = Identity {
        name: adapter.name.clone(),
        device: adapter.device.clone(),
        backend: adapter.backend.into(),
        driver: adapter.driver.clone(),
    };
    let known = known(&adapter.device, &adapter.driver);
    let gpu = adapter.open().map_err(device_error)?;
    let device = GpuDevice { name: adapter.name.clone(), gpu, blend: None, depth: None };
    Ok((identity, known, device))
}

/// A subject on a device that is open already, such as a browser's.
#[must_use]
pub fn on_gpu(identity: Identity, known: Known, gpu: Gpu) -> Subject {
    let device = GpuDevice { name: identity.name.clone(), gpu, blend: None, depth: None };
    Subject::on_device(identity, known, Box::new(device))
}

/// The device of a subject on an adapter; `None` of any other.
#[must_use]
pub fn gpu(subject: &Subject) -> Option<&Gpu> {
    subject.device()?.as_any().downcast_ref().map(|device: &GpuDevice| &device.gpu)
}

/// An error as the engine tells kinds of them apart.
#[must_use]
pub fn device_error(error: GpuError) -> DeviceError {
    match error {
        GpuError::Device(_) => DeviceError::Failed(error.to_string()),
        GpuError::Timeout(_) => DeviceError::Hangs(error.to_string()),
        GpuError::Open { .. } => DeviceError::NoDevice(error.to_string()),
        error => DeviceError::Refused(Box::new(error)),
    }
}

/// The shaders under test.
fn shaders(code: &Code) -> Result<&Shaders, DeviceError> {
    shader_code(code).map(|code| &code.shaders)
}

fn shader_code(code: &Code) -> Result<&ShaderCode, DeviceError> {
    code.get().ok_or_else(|| DeviceError::Refused("an adapter's code is a set of shaders, and there are none".into()))
}

/// A device of wgpu, with what is compiled for it.
struct GpuDevice {
    name: String,
    gpu: Gpu,
    /// The blend unit with its pipelines, kept from group to group as long as its shaders are the same.
    blend: Option<(String, BlendUnit)>,
    /// The depth test with its pipelines, likewise.
    depth: Option<(String, DepthUnit)>,
}

/// How a stage evaluates.
enum Work {
    /// A shader over rows.
    Arithmetic(ArithmeticPipeline),
    /// The depth test, which the device holds.
    Depth,
    /// The rasteriser.
    Raster(RasterPipeline),
}

/// Work that a device may still be doing.
enum Job {
    /// A pending batch.
    Arithmetic(Pending),
    /// A pending batch of the depth test.
    Depth(Pending),
    /// Pending batches of the rasteriser, each with its number of cases.
    Raster(Vec<(usize, Pending)>),
}

/// What a device itself has made.
fn own<T: Any>(own: &Own) -> &T {
    own.downcast_ref().expect("a device is handed back what it made")
}

/// The same, taken.
fn taken<T: Any>(own: Own) -> T {
    *own.downcast().expect("a device is handed back what it made")
}

impl GpuDevice {
    fn blend_unit(&mut self, shaders: &Shaders) -> Result<&mut BlendUnit, GpuError> {
        let source = BlendUnit::source(shaders);
        if self.blend.as_ref().is_none_or(|(made_of, _)| *made_of != source) {
            self.blend = Some((source, BlendUnit::new(&self.gpu, shaders)?));
        }
        Ok(self.blend.as_mut().map(|(_, unit)| unit).expect("it was just made"))
    }

    fn work(
        &mut self,
        shaders: &Shaders,
        kind: Kind,
        kernel: Option<&Kernel>,
        stage: Stage,
    ) -> Result<Result<Work, &'static str>, GpuError> {
        let programmable = match stage {
            Stage::Compute => lightmeter_gpu::Programmable::Compute,
            Stage::Fragment => lightmeter_gpu::Programmable::Fragment,
            Stage::FixedFunction => {
                let source = DepthUnit::source(shaders);
                if self.depth.as_ref().is_none_or(|(made_of, _)| *made_of != source) {
                    self.depth = Some((source, DepthUnit::new(&self.gpu, shaders)?));
                }
                return Ok(Ok(Work::Depth));
            }
            Stage::Answer => return Ok(Err("an adapter has stages, and is not asked case by case")),
            Stage::Raster => {
                let Kind::Raster(raster) = kind else { return Ok(Err("not a formula of the rasteriser")) };
                return Ok(RasterPipeline::new(&self.gpu, shaders, raster)?.map(Work::Raster));
            }
        };
        let Some(kernel) = kernel else { return Ok(Err("no shader function evaluates this formula")) };
        Ok(ArithmeticPipeline::new(&self.gpu, kernel, programmable)?.map(Work::Arithmetic))
    }

    fn submitted(&mut self, work: &Work, rows: &Rows<'_>) -> Result<Job, GpuError> {
        match work {
            Work::Arithmetic(pipeline) => Ok(Job::Arithmetic(pipeline.submit(&self.gpu, rows.selected))),
            Work::Depth => {
                let (_, unit) = self.depth.as_mut().expect("the depth test is made before its work");
                let tests: Vec<DepthTest> = rows.of.iter().map(|&member| rows.depth_test(member)).collect();
                Ok(Job::Depth(unit.submit(&self.gpu, &tests, rows.inputs)?))
            }
            Work::Raster(pipeline) => {
                let (mut jobs, mut rest) = (vec![], rows.inputs);
                while !rest.is_empty() {
                    let (count, pending) = pipeline.submit(&self.gpu, rest);
                    rest = &rest[count * rows.stride()..];
                    jobs.push((count, pending));
                }
                Ok(Job::Raster(jobs))
            }
        }
    }

    fn finished(&self, work: &Work, job: Job, rows: &Rows<'_>) -> Result<Vec<u32>, GpuError> {
        let gpu = &self.gpu;
        match (work, job) {
            (Work::Arithmetic(pipeline), Job::Arithmetic(pending)) => {
                Ok(pipeline.outputs(pending.wait(gpu)?, rows.of.len()))
            }
            (Work::Depth, Job::Depth(pending)) => Ok(DepthUnit::outputs(&pending.wait(gpu)?, rows.of.len())),
            (Work::Raster(pipeline), Job::Raster(jobs)) => {
                let (mut words, mut rest) = (vec![], rows.inputs);
                for (count, pending) in jobs {
                    words.extend(pipeline.outputs(&pending.wait(gpu)?, rest, count));
                    rest = &rest[count * rows.stride()..];
                }
                Ok(words)
            }
            _ => unreachable!("a job is finished by the work that submitted it"),
        }
    }

    fn probed(&self, shaders: &Shaders, function: &str, x: f32) -> Result<Option<u32>, GpuError> {
        let kernel = Kernel::new(shaders, "probe.wgsl", function)?;
        let Ok(pipeline) = ArithmeticPipeline::new(&self.gpu, &kernel, lightmeter_gpu::Programmable::Compute)? else {
            return Ok(None);
        };
        Ok(pipeline.submit(&self.gpu, &[x]).wait(&self.gpu)?.first().copied())
    }
}

impl Device for GpuDevice {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn built_in(&self) -> Result<Code, DeviceError> {
        Shaders::built_in().map(code).map_err(device_error)
    }

    fn source(&self, code: &Code, file: &str) -> String {
        shaders_of(code).map(|shaders| shaders.source(file)).unwrap_or_default()
    }

    fn read_ahead(&self, code: &Code) -> Option<ReadAhead> {
        let code = code.clone();
        shader_code(&code).is_ok().then(|| -> ReadAhead {
            Box::new(move |member| {
                // What it finds wrong is told where the formula is compiled.
                let _ = shader_code(&code).map(|code| code.kernel(member));
            })
        })
    }

    fn compile(&mut self, code: &Code, member: &Member) -> Result<Stages<Own>, DeviceError> {
        let code = shader_code(code)?;
        let (shaders, kernel) = (&code.shaders, code.kernel(member).map_err(device_error)?);
        let mut stages: Stages<Own> = vec![];
        for &stage in member.spec.row_stages() {
            let work = self.work(shaders, member.spec.kind, kernel.as_ref(), stage).map_err(device_error)?;
            stages.push((stage, work.map(|work| Box::new(work) as Own)));
        }
        Ok(stages)
    }

    fn submit(&mut self, work: &Own, rows: &Rows<'_>) -> Result<Own, DeviceError> {
        self.submitted(own(work), rows).map(|job| Box::new(job) as Own).map_err(device_error)
    }

    fn finish(&self, work: &Own, job: Own, rows: &Rows<'_>) -> Result<Vec<u32>, DeviceError> {
        self.finished(own(work), taken(job), rows).map_err(device_error)
    }

    fn probe(&self, code: &Code, function: &str, x: f32) -> Result<Option<u32>, DeviceError> {
        self.probed(shaders(code)?, function, x).map_err(device_error)
    }

    fn special(&self, code: &Code, probes: &[&'static Probe]) -> Result<Probed, DeviceError> {
        special::special(&self.gpu, shaders(code)?, probes).map_err(device_error)
    }

    fn lacks_blending(&self, target: TargetFormat) -> Option<&'static str> {
        self.gpu.lacks_blending(target)
    }

    fn lacks_route(&mut self, code: &Code, route: Route) -> Result<Option<&'static str>, DeviceError> {
        Ok(self.blend_unit(shaders(code)?).map_err(device_error)?.lacks_route(route))
    }

    fn blend(
        &mut self,
        code: &Code,
        target: TargetFormat,
        pieces: &[&Piece],
        again: bool,
    ) -> Result<Pixels, DeviceError> {
        let unit = self.blend_unit(shaders(code)?).map_err(device_error)?;
        blend::blend(unit, target, pieces, again).map_err(device_error)
    }

    fn forget_pipelines(&mut self) {
        if let Some((_, unit)) = &mut self.blend {
            unit.forget_pipelines();
        }
    }

    fn renew_blend_unit(&mut self) {
        if let Some((_, unit)) = self.blend.take() {
            // Closing a device that hangs would hang as well.
            std::mem::forget(unit);
        }
    }

    fn lacks_target(&self, target: TargetFormat) -> Option<&'static str> {
        self.gpu.lacks_target(target)
    }

    fn lacks_frame(&self, frame: &Frame) -> Option<&'static str> {
        SceneRenderer::lacks(&self.gpu, frame)
    }

    fn draw(&self, code: &Code, frame: &Frame, sets: &[Called], picture: Picture) -> Result<Own, DeviceError> {
        let recipe = match picture {
            Picture::Composed => Recipe::of(ShaderForm::Composed),
            Picture::Full => Recipe::of(ShaderForm::Full),
            Picture::Intermediate(stage) => Recipe::stage(stage),
        };
        let renderer = SceneRenderer::new(&self.gpu, shaders(code)?, frame, sets, recipe).map_err(device_error)?;
        Ok(Box::new(renderer.submit(&self.gpu)))
    }

    fn pixels(&self, job: Own) -> Result<Vec<u8>, DeviceError> {
        SceneRenderer::pixels(&self.gpu, taken(job)).map_err(device_error)
    }

    fn effects_cost(&self, code: &Code, frame: &Frame, called: &[Called]) -> Result<EffectsCost, DeviceError> {
        cost::effects_cost(&self.gpu, shaders(code)?, frame, called).map_err(device_error)
    }

    fn stable_costs(
        &self,
        code: &Code,
        member: &Member,
        rivals: &BTreeMap<&'static str, Member>,
        seed: u64,
    ) -> Result<Vec<Cost>, DeviceError> {
        stable_cost::stable_costs(member, rivals, (&self.gpu, &self.name), shaders(code)?, seed).map_err(device_error)
    }

    fn sweep<'a>(
        &'a self,
        code: &Code,
        member: &Member,
        stage: Stage,
        along: Along<'_>,
        capacity: usize,
    ) -> Result<Result<Box<dyn Blocks + 'a>, &'static str>, DeviceError> {
        sweep::sweep(&self.gpu, shaders(code)?, member, stage, along, capacity).map_err(device_error)
    }
}

/// Whether this thread's test is skipped for want of a driver.
#[cfg(test)]
fn lacks_driver() -> bool {
    skip::lacks(lightmeter_gpu::native_adapters().is_empty(), skip::DRIVER)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::filter::Filter;
    use lightmeter_document::event::{Event, Observer};
    use lightmeter_document::report::Report;
    use lightmeter_engine::options::Options;
    use lightmeter_engine::run::run;
    use lightmeter_gpu::native_adapters;
    use lightmeter_scene::target::TargetFormat;

    struct LoseAt<F>(&'static str, F);

    impl<F: Fn()> Observer for LoseAt<F> {
        fn see(&mut self, event: &Event<'_>) {
            if matches!(event, Event::Group(id) if *id == self.0) {
                (self.1)();
            }
        }
    }

    /// Loses the devices of the blend unit when a group begins.
    fn lose_at(group: &'static str, filter: &str) -> Report {
        let adapters = native_adapters();
        let adapter = adapters.first().expect("no Vulkan driver is here: `./x test` installs lavapipe");
        let (identity, known, mut device) = device_of(adapter).expect("the adapter gives a device");
        let shaders = Shaders::built_in().expect("the built-in shaders are valid");
        let lose = device.blend_unit(&shaders).expect("a blend unit").breaker();
        let mut subject = Subject::on_device(identity, known, Box::new(device));
        let options = Options {
            filter: Filter::new(&[filter]).expect("the glob is valid"),
            cases: 64,
            targets: vec![TargetFormat::Rgba8Unorm],
            ..Options::new(code(shaders))
        };
        run(std::slice::from_mut(&mut subject), &options, &mut LoseAt(group, lose)).expect("there is a report")
    }

    #[test]
    fn a_lost_device_ends_the_run_and_keeps_what_was_judged() {
        if crate::lacks_driver() {
            return;
        }
        let report = lose_at("blend/max", "blend/{min,max,write-mask}");
        let interrupted = report.interrupted.as_ref().expect("the run was interrupted");
        assert!(interrupted.under_way.contains("blend/max") && interrupted.under_way.contains("rgba8unorm"));
        assert!(interrupted.message.contains("the device failed"), "{interrupted:?}");
        let judged: Vec<&str> = report.groups.iter().map(|group| group.id.as_str()).collect();
        assert!(judged.contains(&"blend/min") && !judged.contains(&"blend/write-mask"), "{judged:?}");
    }

    #[test]
    fn code_that_cannot_be_compiled_is_told_though_the_run_is_stopped() {
        if crate::lacks_driver() {
            return;
        }
        let adapters = native_adapters();
        let adapter = adapters.first().expect("no Vulkan driver is here: `./x test` installs lavapipe");
        let mut subject = open_device(adapter).expect("the adapter gives a device");
        let filter = Filter::new(&["fog/exp"]).expect("the glob is valid");
        // Of formulas no code is there, while the deviations' witnesses run by the device's own.
        let options = Options { filter, cases: 64, ..Options::new(Code::default()) };
        options.stop.at_first_failure();
        let told = run(std::slice::from_mut(&mut subject), &options, &mut lightmeter_document::event::Silent);
        let error = told.expect_err("there is no code").to_string();
        assert!(error.contains("an adapter's code is a set of shaders"), "{error}");
    }

    #[test]
    fn states_that_were_drawn_together_are_tried_alone() {
        if crate::lacks_driver() {
            return;
        }
        let report = lose_at("blend/subtract", "blend/{add,subtract}/dst-alpha");
        let under_way = &report.interrupted.as_ref().expect("the run was interrupted").under_way;
        assert!(under_way.contains("15 states from blend/subtract/dst-alpha/zero to"), "{under_way}");
        assert!(under_way.contains("none fails alone"), "{under_way}");
        assert!(report.blend_states.iter().all(|state| state.id.starts_with("blend/add/dst-alpha")));
        assert_eq!(report.blend_states.len(), 15);
    }
}
