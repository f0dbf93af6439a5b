//! What is judged: an adapter, or the embedded implementation, and how each of its stages evaluates a group of formulas.

use crate::blend_unit::rules::Rules;
use crate::options::Options;
use lightmeter_catalogue::cases::{Kind, Spec, Stage};
use lightmeter_catalogue::select::Member;
use lightmeter_document::run::Identity;
use lightmeter_gpu::{
    Adapter, ArithmeticPipeline, BlendUnit, DepthUnit, Error, Gpu, Kernel, Pending, RasterPipeline, Shaders,
};
use lightmeter_judge::devices::{Known, known};
use lightmeter_judge::tally::Judging;
use lightmeter_scene::blend::Route;
use lightmeter_scene::depth::DepthTest;
use lightmeter_scene::target::TargetFormat;

/// An implementation under test.
pub struct Subject {
    /// How it is named.
    pub identity: Identity,
    /// What is known of it.
    pub known: Known,
    gpu: Option<Device>,
    /// What the embedded blend unit follows.
    rules: Rules,
}

struct Device {
    gpu: Gpu,
    /// The blend unit with its pipelines, kept from group to group.
    blend: Option<BlendUnit>,
    /// The depth test with its pipelines.
    depth: Option<DepthUnit>,
}

/// The stages of a subject, compiled for one group of formulas.
pub struct Compiled {
    /// Each stage, or why it is skipped.
    pub stages: Vec<(Stage, Result<Work, &'static str>)>,
}

/// How a stage evaluates.
pub enum Work {
    /// A shader over rows.
    Arithmetic(ArithmeticPipeline),
    /// The depth test, which the subject holds.
    Depth,
    /// The rasteriser.
    Raster(RasterPipeline),
    /// The formulas in f32, on this processor.
    Embedded,
}

/// Rows of inputs of one group, and whose they are.
pub struct Rows<'a> {
    /// The formulas of the group.
    pub members: &'a [&'a Member],
    /// For each case, its formula's place among the members.
    pub of: &'a [usize],
    /// The inputs, row after row.
    pub inputs: &'a [f32],
    /// The same with selectors before each row, for the shaders.
    pub selected: &'a [f32],
    /// Numbers of a row of outputs.
    pub outputs: usize,
}

impl Rows<'_> {
    fn depth_test(&self, member: usize) -> DepthTest {
        let Kind::Depth(test) = self.members[member].spec.kind else {
            unreachable!("only depth tests reach the depth test")
        };
        test
    }

    fn stride(&self) -> usize {
        self.inputs.len() / self.of.len()
    }
}

/// Work that a device may still be doing.
pub enum Job {
    /// A pending batch.
    Arithmetic(Pending),
    /// A pending batch of the depth test.
    Depth(Pending),
    /// Pending batches of the rasteriser, each with its number of cases.
    Raster(Vec<(usize, Pending)>),
    /// Done.
    Done(Vec<u32>),
}

impl Subject {
    /// A device on an adapter.
    ///
    /// # Errors
    /// Where the driver gives none.
    pub fn open(adapter: &Adapter) -> Result<Self, Error> {
        let identity = Identity {
            name: adapter.name.clone(),
            device: adapter.device.clone(),
            backend: adapter.backend.into(),
            driver: adapter.driver.clone(),
        };
        let gpu = Some(Device { gpu: adapter.open()?, blend: None, depth: None });
        Ok(Self { identity, known: known(&adapter.device, &adapter.driver), gpu, rules: Rules::RIGHT })
    }

    /// The formulas themselves in f32, which need no driver. They prove nothing about the reference, which they share.
    #[must_use]
    pub fn embedded() -> Self {
        let identity = Identity {
            name: "cpu".into(),
            device: "the reference's formulas in f32".into(),
            backend: "embedded".into(),
            driver: concat!("lightmeter ", env!("CARGO_PKG_VERSION")).into(),
        };
        Self { identity, known: Known::default(), gpu: None, rules: Rules::RIGHT }
    }

    /// The embedded implementation with a blend unit that follows other rules than the right ones.
    #[must_use]
    pub fn faulty(rules: Rules) -> Self {
        Self { rules, ..Self::embedded() }
    }

    /// Whose answers are judged, and by what.
    #[must_use]
    pub fn judging<'a>(&'a self, options: &'a Options) -> Judging<'a> {
        Judging { adapter: &self.identity.name, known: &self.known, profile: options.profile, rerun: &options.rerun }
    }

    /// The device; `None` of the embedded implementation.
    #[must_use]
    pub fn gpu(&self) -> Option<&Gpu> {
        self.gpu.as_ref().map(|device| &device.gpu)
    }

    /// What the embedded blend unit follows.
    #[must_use]
    pub const fn rules(&self) -> &Rules {
        &self.rules
    }

    /// Whether it is the embedded implementation, which has no fixed hardware.
    #[must_use]
    pub const fn is_embedded(&self) -> bool {
        self.gpu.is_none()
    }

    /// The blend unit; `None` where it is the embedded one.
    ///
    /// # Errors
    /// Where a shader is invalid, or the driver gives no device.
    pub fn blend_unit(&mut self, shaders: &Shaders) -> Result<Option<&mut BlendUnit>, Error> {
        let Some(device) = &mut self.gpu else { return Ok(None) };
        if device.blend.is_none() {
            device.blend = Some(BlendUnit::new(&device.gpu, shaders)?);
        }
        Ok(device.blend.as_mut())
    }

    /// Gives up the blend unit, whose devices may be lost: the next one has fresh ones.
    pub fn drop_blend_unit(&mut self) {
        if let Some(device) = &mut self.gpu
            && let Some(unit) = device.blend.take()
        {
            // Closing a device that hangs would hang as well.
            std::mem::forget(unit);
        }
    }

    /// Why a target cannot be blended on; `None` where it can.
    #[must_use]
    pub fn lacks_blending(&self, target: TargetFormat) -> Option<&'static str> {
        self.gpu.as_ref()?.gpu.lacks_blending(target)
    }

    /// Why a route is not open; `None` where it is. The embedded unit has every factor of its own.
    ///
    /// # Errors
    /// Where a shader is invalid, or the driver gives no device.
    pub fn lacks_route(&mut self, shaders: &Shaders, route: Route) -> Result<Option<&'static str>, Error> {
        if self.gpu.is_none() {
            let missing = "the embedded implementation has every factor of its own";
            return Ok((route == Route::DualSource).then_some(missing));
        }
        Ok(self.blend_unit(shaders)?.and_then(|unit| unit.lacks_route(route)))
    }

    /// Compiles what the group's formulas need.
    ///
    /// # Errors
    /// Where a shader is invalid or the device refuses it.
    pub fn compile(&mut self, shaders: &Shaders, spec: &Spec, kernel: Option<&Kernel>) -> Result<Compiled, Error> {
        let Some(device) = &mut self.gpu else {
            return Ok(Compiled { stages: vec![(spec.row_stages()[0], Ok(Work::Embedded))] });
        };
        let stages =
            spec.row_stages().iter().map(|&stage| Ok((stage, device.work(shaders, spec.kind, kernel, stage)?)));
        Ok(Compiled { stages: stages.collect::<Result<_, Error>>()? })
    }

    /// Starts the evaluation of rows by a stage.
    ///
    /// # Errors
    /// Where the device refuses it.
    ///
    /// # Panics
    /// Where the work was not compiled by this subject.
    pub fn submit(&mut self, work: &Work, rows: &Rows<'_>) -> Result<Job, Error> {
        if let Work::Embedded = work {
            return Ok(Job::Done(embedded(rows)));
        }
        let device = self.gpu.as_mut().expect("only a device compiles work for a device");
        match work {
            Work::Arithmetic(pipeline) => Ok(Job::Arithmetic(pipeline.submit(&device.gpu, rows.selected))),
            Work::Depth => {
                let unit = device.depth.as_mut().expect("the depth test is made before its work");
                let tests: Vec<DepthTest> = rows.of.iter().map(|&member| rows.depth_test(member)).collect();
                Ok(Job::Depth(unit.submit(&device.gpu, &tests, rows.inputs)?))
            }
            Work::Raster(pipeline) => {
                let (mut jobs, mut rest) = (vec![], rows.inputs);
                while !rest.is_empty() {
                    let (count, pending) = pipeline.submit(&device.gpu, rest);
                    rest = &rest[count * rows.stride()..];
                    jobs.push((count, pending));
                }
                Ok(Job::Raster(jobs))
            }
            Work::Embedded => unreachable!("handled above"),
        }
    }

    /// The outputs of rows, bit for bit, once they are there.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    ///
    /// # Panics
    /// Where the job is not of this work.
    pub fn finish(&self, work: &Work, job: Job, rows: &Rows<'_>) -> Result<Vec<u32>, Error> {
        let gpu = || &self.gpu.as_ref().expect("only a device has pending work").gpu;
        match (work, job) {
            (_, Job::Done(words)) => Ok(words),
            (Work::Arithmetic(pipeline), Job::Arithmetic(pending)) => {
                Ok(pipeline.outputs(pending.wait(gpu())?, rows.of.len()))
            }
            (Work::Depth, Job::Depth(pending)) => Ok(DepthUnit::outputs(&pending.wait(gpu())?, rows.of.len())),
            (Work::Raster(pipeline), Job::Raster(jobs)) => {
                let (mut words, mut rest) = (vec![], rows.inputs);
                for (count, pending) in jobs {
                    words.extend(pipeline.outputs(&pending.wait(gpu())?, rest, count));
                    rest = &rest[count * rows.stride()..];
                }
                Ok(words)
            }
            _ => unreachable!("a job is finished by the work that submitted it"),
        }
    }

    /// A function of `probe.wgsl` at one argument, in the compute stage; `None` where the subject has no such stage.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn probe(&self, shaders: &Shaders, function: &str, x: f32) -> Result<Option<u32>, Error> {
        let Some(Device { gpu, .. }) = &self.gpu else { return Ok(None) };
        let kernel = Kernel::new(shaders, "probe.wgsl", function)?;
        let Ok(pipeline) = ArithmeticPipeline::new(gpu, &kernel, lightmeter_gpu::Stage::Compute)? else {
            return Ok(None);
        };
        Ok(pipeline.submit(gpu, &[x]).wait(gpu)?.first().copied())
    }
}

impl Device {
    fn work(
        &mut self,
        shaders: &Shaders,
        kind: Kind,
        kernel: Option<&Kernel>,
        stage: Stage,
    ) -> Result<Result<Work, &'static str>, Error> {
        let programmable = match stage {
            Stage::Compute => lightmeter_gpu::Stage::Compute,
            Stage::Fragment => lightmeter_gpu::Stage::Fragment,
            Stage::FixedFunction => {
                if self.depth.is_none() {
                    self.depth = Some(DepthUnit::new(&self.gpu, shaders)?);
                }
                return Ok(Ok(Work::Depth));
            }
            Stage::Raster => {
                let Kind::Raster(raster) = kind else { return Ok(Err("not a formula of the rasteriser")) };
                return Ok(RasterPipeline::new(&self.gpu, shaders, raster)?.map(Work::Raster));
            }
        };
        let Some(kernel) = kernel else { return Ok(Err("no shader function evaluates this formula")) };
        Ok(ArithmeticPipeline::new(&self.gpu, kernel, programmable)?.map(Work::Arithmetic))
    }
}

fn embedded(rows: &Rows<'_>) -> Vec<u32> {
    use rayon::prelude::*;
    let mut words = vec![0; rows.of.len() * rows.outputs];
    words.par_chunks_mut(rows.outputs).zip(rows.inputs.par_chunks(rows.stride())).zip(rows.of).for_each(
        |((words, inputs), &member)| {
            let mut out = vec![0.0; words.len()];
            rows.members[member].formula.embedded(inputs, &mut out);
            for (word, value) in words.iter_mut().zip(out) {
                *word = value.to_bits();
            }
        },
    );
    words
}
