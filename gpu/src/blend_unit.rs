//! The fixed-function blend unit: any state on any target format, many states in a submission, one read-back.
//!
//! A batch is a row of draws over a packed target. A point covers one pixel, so a pixel is a case, and several points on
//! one pixel are layers that overlap in order. Destinations are uploaded and results read back in the target's own bits, so
//! that nothing but the unit itself converts them.

use crate::device::{Executor, Gpu, Pending, format, middle};
use crate::error::GpuError;
use crate::shaders::Shaders;
use crate::work::{
    Buffer, ColorAttachment, Command, Handle, Read, RenderPass, RenderPipeline, Resources, Step, Submission,
    TextureResource, VertexBuffer,
};
use lightmeter_scene::blend::{Equation, Factor, Route, Separate, State, WriteMask};
use lightmeter_scene::target::TargetFormat;
use std::collections::HashMap;
use std::ops::Range;
use wgpu_types::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, BufferUsages, Color, ColorTargetState, ColorWrites,
    PrimitiveState, PrimitiveTopology, TextureUsages, VertexAttribute, VertexFormat, VertexStepMode,
};

/// Pixels of a row of the target.
const WIDTH: u32 = 1024;
const FILE: &str = "blend_unit.wgsl";
const DUAL_FILE: &str = "blend_unit_dual.wgsl";

/// Points drawn with one state and one constant.
#[derive(Clone, Debug)]
pub struct UnitDraw {
    /// Factors and equations.
    pub state: Separate,
    /// The components that are written.
    pub mask: WriteMask,
    /// One of the state's [`routes`](lightmeter_scene::blend::routes).
    pub route: Route,
    /// The blend constant.
    pub constant: [f32; 4],
    /// Which of the batch's points.
    pub points: Range<u32>,
}

/// What one device draws on one target.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    /// The draws, in order.
    pub draws: Vec<UnitDraw>,
    /// The source colour of each point.
    pub sources: Vec<[f32; 4]>,
    /// The pixel of each point.
    pub pixels: Vec<u32>,
    /// The target before the first draw, pixel after pixel in its own bits.
    pub destinations: Vec<u8>,
}

/// The blend unit of an adapter: several devices, which compile side by side.
#[derive(Debug)]
pub struct BlendUnit {
    lanes: Vec<Lane>,
}

/// One device, with the pipelines that were needed on it so far.
#[derive(Debug)]
struct Lane {
    gpu: Gpu,
    executor: Executor,
    pipelines: UnitPipelines,
}

/// The shaders of the unit, and the pipelines that were needed so far.
#[derive(Debug)]
struct UnitPipelines {
    resources: Resources,
    shader: Handle,
    /// Where a fragment may have two source colours.
    dual: Option<Handle>,
    described: HashMap<(TargetFormat, Lowered), Handle>,
}

/// A state as the unit takes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Lowered {
    pub(crate) blend: BlendState,
    mask: WriteMask,
    entry: &'static str,
}

/// The vertex shader of each route.
const SOURCE: &str = "unit_source";
const FOLDED_SOURCE: &str = "unit_folded_source";
const DUAL_SOURCE: &str = "unit_dual_source";

/// What a shader is told of a draw: the constant, the code of the factor that it folds into the source, and whether the
/// target clamps.
const INSTANCE_BYTES: usize = 24;

impl BlendUnit {
    /// The shaders that it is made of.
    #[must_use]
    pub fn source(shaders: &Shaders) -> String {
        [FILE, DUAL_FILE].map(|file| shaders.source(file)).concat()
    }

    /// The unit, on as many devices as compile side by side.
    ///
    /// # Errors
    /// Where a shader is invalid, or the driver gives no device.
    pub fn new(gpu: &Gpu, shaders: &Shaders) -> Result<Self, GpuError> {
        let lanes = (0..gpu.lanes()).map(|_| Lane::new(gpu.sibling()?, shaders)).collect::<Result<_, GpuError>>()?;
        Ok(Self { lanes })
    }

    /// How many batches are worked on side by side.
    #[must_use]
    pub fn lanes(&self) -> usize {
        self.lanes.len()
    }

    /// Why a route is not open on this adapter; `None` where it is.
    #[must_use]
    pub fn lacks_route(&self, route: Route) -> Option<&'static str> {
        (route == Route::DualSource && self.lanes[0].pipelines.dual.is_none())
            .then_some("the adapter lacks the feature DUAL_SOURCE_BLENDING")
    }

    /// Draws a batch on each of the first devices, at most [`BlendUnit::lanes`] of them.
    ///
    /// # Errors
    /// Where a device refuses a pipeline.
    ///
    /// # Panics
    /// Where there are more batches than devices, or a route is not open.
    pub fn submit(&mut self, target: TargetFormat, batches: &[Batch]) -> Result<Vec<Pending>, GpuError> {
        assert!(batches.len() <= self.lanes.len(), "{} batches for {} devices", batches.len(), self.lanes.len());
        self.lanes.iter_mut().zip(batches).map(|(lane, batch)| lane.submit(target, batch)).collect()
    }

    /// All pixels of each batch's target in its own bits: those of the batch first.
    ///
    /// # Errors
    /// Where a device failed or was lost.
    pub fn wait(&self, pending: Vec<Pending>) -> Result<Vec<Vec<u8>>, GpuError> {
        let bytes = |words: &[u32]| bytemuck::cast_slice(words).to_vec();
        self.lanes.iter().zip(pending).map(|(lane, pending)| pending.map(&lane.gpu, |words| bytes(&words))).collect()
    }

    /// Lets go of the pipelines, of which a software driver keeps some hundred kilobytes each.
    pub fn forget_pipelines(&mut self) {
        for lane in &mut self.lanes {
            lane.pipelines.forget();
            lane.executor.forget_pipelines();
        }
    }

    /// What destroys its devices, as if they were lost: for tests of what then happens.
    pub fn breaker(&self) -> impl Fn() + use<> {
        let breakers: Vec<_> = self.lanes.iter().map(|lane| lane.gpu.breaker()).collect();
        move || breakers.iter().for_each(|destroy| destroy())
    }
}

impl Lane {
    fn new(gpu: Gpu, shaders: &Shaders) -> Result<Self, GpuError> {
        let (mut executor, pipelines) = (Executor::default(), UnitPipelines::new(shaders, gpu.has_dual_source()));
        executor.make(&gpu, &pipelines.resources, FILE)?;
        Ok(Self { gpu, executor, pipelines })
    }

    fn submit(&mut self, target: TargetFormat, batch: &Batch) -> Result<Pending, GpuError> {
        let states: Vec<Lowered> = batch.draws.iter().map(lower).collect();
        self.pipelines.add(target, &states);
        self.executor.make(&self.gpu, &self.pipelines.resources, FILE)?;
        Ok(self.executor.submit(&self.gpu, &self.pipelines.submission(target, batch, &states)))
    }
}

impl UnitPipelines {
    fn new(shaders: &Shaders, has_dual_source: bool) -> Self {
        let mut resources = Resources::default();
        let shader = resources.shader(FILE, shaders.source(FILE));
        let dual = has_dual_source.then(|| resources.shader(DUAL_FILE, shaders.source(DUAL_FILE)));
        Self { resources, shader, dual, described: HashMap::new() }
    }

    /// Describes the pipelines that are not there yet.
    fn add(&mut self, target: TargetFormat, states: &[Lowered]) {
        for lowered in states {
            let shader = match lowered.entry {
                DUAL_SOURCE => self.dual.expect("the route is open"),
                _ => self.shader,
            };
            let describe = || self.resources.pipeline(pipeline(shader, target, *lowered));
            self.described.entry((target, *lowered)).or_insert_with(describe);
        }
    }

    fn forget(&mut self) {
        self.described.clear();
        self.resources.pipelines.clear();
    }

    /// Draws a batch over its destinations, its states as they were lowered.
    fn submission(&self, target: TargetFormat, batch: &Batch, states: &[Lowered]) -> Submission {
        let count = batch.destinations.len() / (4 * target.component_bytes());
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        // A power of two, so that the middle of every pixel is exact in clip coordinates.
        let height = count.div_ceil(WIDTH).next_power_of_two();
        let places: Vec<[f32; 2]> = batch.pixels.iter().map(|&pixel| middle(pixel, WIDTH, height)).collect();
        let instances: Vec<u8> = batch.draws.iter().flat_map(|draw| instance(target, draw)).collect();
        let mut work = Submission::default();
        let vertex = BufferUsages::VERTEX;
        let buffers = [
            work.buffer(Buffer::of(&batch.sources, vertex)),
            work.buffer(Buffer::of(&places, vertex)),
            work.buffer(Buffer::of(&instances, vertex)),
        ];
        let drawn = work.texture(TextureResource {
            contents: batch.destinations.as_slice().into(),
            ..TextureResource::target(
                [WIDTH, height],
                format(target),
                TextureUsages::COPY_SRC | TextureUsages::COPY_DST,
            )
        });
        let mut commands: Vec<Command> =
            (0..).zip(buffers).map(|(slot, buffer)| Command::Vertices { slot, buffer }).collect();
        for (number, (draw, lowered)) in (0..).zip(batch.draws.iter().zip(states)) {
            commands.extend([
                Command::Pipeline(self.described[&(target, *lowered)]),
                Command::BlendConstant(blend_constant(draw)),
                Command::Draw { vertices: draw.points.clone(), instances: number..number + 1 },
            ]);
        }
        work.steps.push(Step::Render(RenderPass {
            colors: vec![ColorAttachment::loaded(drawn)],
            depth: None,
            commands,
        }));
        work.reads.push(Read::Texture(drawn));
        work
    }
}

pub(crate) fn lower(draw: &UnitDraw) -> Lowered {
    let (color, alpha) = (draw.state.color, draw.state.alpha);
    let folded = draw.route == Route::FoldedIntoSource;
    let dual = draw.route == Route::DualSource;
    let of_color = |factor: Factor| match factor {
        Factor::ConstantAlpha if dual => BlendFactor::Src1Alpha,
        Factor::OneMinusConstantAlpha if dual => BlendFactor::OneMinusSrc1Alpha,
        other => unit_factor(other),
    };
    let component = |state: State, src: BlendFactor, dst: BlendFactor| {
        let one = BlendFactor::One;
        let ignored = state.equation.ignores_factors();
        BlendComponent {
            src_factor: if ignored { one } else { src },
            dst_factor: if ignored { one } else { dst },
            operation: operation(state.equation),
        }
    };
    let src = if folded { BlendFactor::One } else { of_color(color.src) };
    Lowered {
        blend: BlendState {
            color: component(color, src, of_color(color.dst)),
            alpha: component(alpha, unit_factor(alpha.src), unit_factor(alpha.dst)),
        },
        mask: draw.mask,
        entry: match draw.route {
            Route::FoldedIntoSource => FOLDED_SOURCE,
            Route::DualSource => DUAL_SOURCE,
            Route::Native | Route::ConstantReplicated => SOURCE,
        },
    }
}

/// The constant that the unit is given.
pub(crate) fn blend_constant(draw: &UnitDraw) -> Color {
    let [r, g, b, a] = draw.constant;
    let replicated = match draw.route {
        Route::ConstantReplicated => true,
        Route::FoldedIntoSource => draw.state.color.dst.reads_constant_alpha(),
        Route::Native | Route::DualSource => false,
    };
    let [r, g, b, a] = if replicated { [a; 4] } else { [r, g, b, a] }.map(f64::from);
    let read = draw.state.reads_constant();
    if read { Color { r, g, b, a } } else { Color::TRANSPARENT }
}

fn instance(target: TargetFormat, draw: &UnitDraw) -> [u8; INSTANCE_BYTES] {
    let [r, g, b, a] = draw.constant.map(f32::to_bits);
    let words = [r, g, b, a, draw.state.color.src.code(), u32::from(target.is_unorm())];
    bytemuck::cast(words)
}

const fn operation(equation: Equation) -> BlendOperation {
    match equation {
        Equation::Add => BlendOperation::Add,
        Equation::Subtract => BlendOperation::Subtract,
        Equation::ReverseSubtract => BlendOperation::ReverseSubtract,
        Equation::Min => BlendOperation::Min,
        Equation::Max => BlendOperation::Max,
    }
}

const fn unit_factor(factor: Factor) -> BlendFactor {
    use BlendFactor as B;
    match factor {
        Factor::Zero => B::Zero,
        Factor::One => B::One,
        Factor::SrcColor => B::Src,
        Factor::OneMinusSrcColor => B::OneMinusSrc,
        Factor::DstColor => B::Dst,
        Factor::OneMinusDstColor => B::OneMinusDst,
        Factor::SrcAlpha => B::SrcAlpha,
        Factor::OneMinusSrcAlpha => B::OneMinusSrcAlpha,
        Factor::DstAlpha => B::DstAlpha,
        Factor::OneMinusDstAlpha => B::OneMinusDstAlpha,
        Factor::ConstantColor | Factor::ConstantAlpha => B::Constant,
        Factor::OneMinusConstantColor | Factor::OneMinusConstantAlpha => B::OneMinusConstant,
        Factor::SrcAlphaSaturate => B::SrcAlphaSaturated,
    }
}

fn pipeline(shader: Handle, target: TargetFormat, lowered: Lowered) -> RenderPipeline {
    let attribute = |shader_location, offset, format| VertexAttribute { format, offset, shader_location };
    let buffer = |stride, step, attributes| VertexBuffer { stride, step, attributes };
    let source = vec![attribute(0, 0, VertexFormat::Float32x4)];
    let place = vec![attribute(1, 0, VertexFormat::Float32x2)];
    let draw = vec![
        attribute(2, 0, VertexFormat::Float32x4),
        attribute(3, 16, VertexFormat::Uint32),
        attribute(4, 20, VertexFormat::Uint32),
    ];
    let (vertex, instance) = (VertexStepMode::Vertex, VertexStepMode::Instance);
    let mut buffers = vec![buffer(16, vertex, source), buffer(8, vertex, place)];
    // What a shader does not read is not fetched.
    if lowered.entry != SOURCE {
        buffers.push(buffer(INSTANCE_BYTES as u64, instance, draw));
    }
    let components = [ColorWrites::RED, ColorWrites::GREEN, ColorWrites::BLUE, ColorWrites::ALPHA];
    let written = components.into_iter().zip(lowered.mask.0).filter(|(_, on)| *on).map(|(component, _)| component);
    let target = ColorTargetState { format: format(target), blend: Some(lowered.blend), write_mask: written.collect() };
    RenderPipeline {
        buffers,
        primitive: PrimitiveState { topology: PrimitiveTopology::PointList, ..Default::default() },
        ..RenderPipeline::new("unit_color", shader, (lowered.entry, "unit_color"), [target])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::tests::{device, words_by_json};
    use lightmeter_scene::blend::routes;
    use std::collections::BTreeSet;

    #[test]
    fn every_state_has_a_route_and_509_are_native() {
        let distinct: BTreeSet<State> = State::all().map(State::canonical).collect();
        let count = |wanted| distinct.iter().filter(|state| routes((**state).into()).contains(&wanted)).count();
        assert_eq!(count(Route::Native), 13 * 13 * 3 + 2);
        assert_eq!(count(Route::ConstantReplicated), 48 * 3);
        assert_eq!(count(Route::FoldedIntoSource), 8 * 3);
        assert_eq!(count(Route::DualSource), 8 * 3);
    }

    #[test]
    fn a_folded_source_is_read_by_no_factor() {
        for state in State::all() {
            if routes(state.into()).contains(&Route::FoldedIntoSource) {
                for factor in [state.src, state.dst] {
                    assert!(factor.reads_constant_color() || factor.reads_constant_alpha(), "{state}");
                }
            }
        }
    }

    #[test]
    fn batches_are_drawn_alike_by_way_of_json() {
        if crate::lacks_driver() {
            return;
        }
        let gpu = device();
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        let mut pipelines = UnitPipelines::new(&shaders, gpu.has_dual_source());
        let factors = (Factor::ConstantColor, Factor::OneMinusSrcAlpha);
        let state = State { equation: Equation::Add, src: factors.0, dst: factors.1 };
        let draw = |points, mask| UnitDraw {
            state: state.into(),
            mask: WriteMask(mask),
            route: Route::Native,
            constant: [0.1, 0.7, 0.3, 0.9],
            points,
        };
        let batch = Batch {
            draws: vec![draw(0..2, [true; 4]), draw(2..3, [true, false, true, false])],
            sources: vec![[0.9, 0.5, 0.25, 0.5], [0.1, 0.2, 0.3, 0.4], [1.0, 0.5, 1.0, 0.75]],
            pixels: vec![0, 2, 1],
            destinations: (0..12).map(|k| 20 * k).collect(),
        };
        let states: Vec<Lowered> = batch.draws.iter().map(lower).collect();
        let target = TargetFormat::Rgba8Unorm;
        pipelines.add(target, &states);
        let words = words_by_json(&gpu, &pipelines.resources, &pipelines.submission(target, &batch, &states));
        let mut unit = BlendUnit::new(&gpu, &shaders).unwrap_or_else(|error| panic!("{error}"));
        let pending = unit.submit(target, &[batch]).unwrap_or_else(|error| panic!("{error}"));
        let bytes = unit.wait(pending).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(bytes, [bytemuck::cast_slice::<u32, u8>(&words)]);
    }
}
