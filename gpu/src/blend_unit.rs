//! The fixed-function blend unit: any state on any target format, many states in a submission, one read-back.
//!
//! A batch is a row of draws over a packed target. A point covers one pixel, so a pixel is a case, and several points on
//! one pixel are layers that overlap in order. Destinations are uploaded and results read back in the target's own bits, so
//! that nothing but the unit itself converts them.

use crate::device::readback::{Pending, staging};
use crate::device::{Gpu, format, middle};
use crate::error::GpuError;
use crate::shaders::Shaders;
use lightmeter_scene::blend::{Equation, Factor, Route, Separate, State, WriteMask};
use lightmeter_scene::target::TargetFormat;
use std::collections::HashMap;
use std::ops::Range;

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
    module: wgpu::ShaderModule,
    dual: Option<wgpu::ShaderModule>,
    pipelines: HashMap<(TargetFormat, Lowered), wgpu::RenderPipeline>,
}

/// A state as the unit takes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Lowered {
    pub(crate) blend: wgpu::BlendState,
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
        (route == Route::DualSource && self.lanes[0].dual.is_none())
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
        self.lanes.iter().zip(pending).map(|(lane, pending)| pending.wait_bytes(&lane.gpu)).collect()
    }

    /// Lets go of the pipelines, of which a software driver keeps some hundred kilobytes each.
    pub fn forget_pipelines(&mut self) {
        for lane in &mut self.lanes {
            lane.pipelines.clear();
        }
    }

    /// What destroys its devices, as if they were lost: for tests of what then happens.
    pub fn breaker(&self) -> impl Fn() + use<> {
        let devices: Vec<wgpu::Device> = self.lanes.iter().map(|lane| lane.gpu.device.clone()).collect();
        move || devices.iter().for_each(wgpu::Device::destroy)
    }
}

impl Lane {
    fn new(gpu: Gpu, shaders: &Shaders) -> Result<Self, GpuError> {
        let module = gpu.module(FILE, shaders.source(FILE));
        let dual = gpu.has_dual_source().then(|| gpu.module(DUAL_FILE, shaders.source(DUAL_FILE)));
        gpu.check_shader(FILE)?;
        Ok(Self { gpu, module, dual, pipelines: HashMap::new() })
    }

    fn submit(&mut self, target: TargetFormat, batch: &Batch) -> Result<Pending, GpuError> {
        let lowered: Vec<Lowered> = batch.draws.iter().map(lower).collect();
        self.compile(target, &lowered)?;
        let gpu = &self.gpu;
        let pixel_bytes = 4 * target.component_bytes();
        let count = batch.destinations.len() / pixel_bytes;
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        // A power of two, so that the middle of every pixel is exact in clip coordinates.
        let height = count.div_ceil(WIDTH).next_power_of_two();
        let drawn = gpu.blend_target(WIDTH, height, format(target));
        gpu.upload(&drawn, &batch.destinations, pixel_bytes);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.draw(&mut encoder, target, batch, &lowered, &drawn);
        let row_bytes = pixel_bytes * WIDTH as usize;
        let staging = staging(gpu, row_bytes * height as usize / 4);
        encoder.copy_texture_to_buffer(
            drawn.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: u32::try_from(row_bytes).ok(),
                    rows_per_image: None,
                },
            },
            drawn.size(),
        );
        Ok(Pending::submit(gpu, encoder, staging, (row_bytes / 4, row_bytes / 4)))
    }

    /// Makes the pipelines that are not there yet.
    fn compile(&mut self, target: TargetFormat, states: &[Lowered]) -> Result<(), GpuError> {
        let gpu = &self.gpu;
        for lowered in states {
            let module = match lowered.entry {
                DUAL_SOURCE => self.dual.as_ref().expect("the route is open"),
                _ => &self.module,
            };
            self.pipelines.entry((target, *lowered)).or_insert_with(|| pipeline(gpu, module, format(target), *lowered));
        }
        gpu.check_shader(FILE)
    }

    /// Draws a batch over its destinations.
    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: TargetFormat,
        batch: &Batch,
        states: &[Lowered],
        drawn: &wgpu::Texture,
    ) {
        let gpu = &self.gpu;
        let vertex = wgpu::BufferUsages::VERTEX;
        let sources = gpu.buffer(bytemuck::cast_slice(&batch.sources), vertex);
        let places: Vec<[f32; 2]> =
            batch.pixels.iter().map(|&pixel| middle(pixel, drawn.width(), drawn.height())).collect();
        let places = gpu.buffer(bytemuck::cast_slice(&places), vertex);
        let instances: Vec<u8> = batch.draws.iter().flat_map(|draw| instance(target, draw)).collect();
        let instances = gpu.buffer(&instances, vertex);
        let view = drawn.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        for (slot, buffer) in (0..).zip([&sources, &places, &instances]) {
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        for (number, (draw, lowered)) in (0..).zip(batch.draws.iter().zip(states)) {
            pass.set_pipeline(&self.pipelines[&(target, *lowered)]);
            pass.set_blend_constant(blend_constant(draw));
            pass.draw(draw.points.clone(), number..number + 1);
        }
    }
}

pub(crate) fn lower(draw: &UnitDraw) -> Lowered {
    let (color, alpha) = (draw.state.color, draw.state.alpha);
    let folded = draw.route == Route::FoldedIntoSource;
    let dual = draw.route == Route::DualSource;
    let of_color = |factor: Factor| match factor {
        Factor::ConstantAlpha if dual => wgpu::BlendFactor::Src1Alpha,
        Factor::OneMinusConstantAlpha if dual => wgpu::BlendFactor::OneMinusSrc1Alpha,
        other => unit_factor(other),
    };
    let component = |state: State, src: wgpu::BlendFactor, dst: wgpu::BlendFactor| {
        let one = wgpu::BlendFactor::One;
        let ignored = state.equation.ignores_factors();
        wgpu::BlendComponent {
            src_factor: if ignored { one } else { src },
            dst_factor: if ignored { one } else { dst },
            operation: operation(state.equation),
        }
    };
    let src = if folded { wgpu::BlendFactor::One } else { of_color(color.src) };
    Lowered {
        blend: wgpu::BlendState {
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
pub(crate) fn blend_constant(draw: &UnitDraw) -> wgpu::Color {
    let [r, g, b, a] = draw.constant;
    let replicated = match draw.route {
        Route::ConstantReplicated => true,
        Route::FoldedIntoSource => draw.state.color.dst.reads_constant_alpha(),
        Route::Native | Route::DualSource => false,
    };
    let [r, g, b, a] = if replicated { [a; 4] } else { [r, g, b, a] }.map(f64::from);
    let read = draw.state.reads_constant();
    if read { wgpu::Color { r, g, b, a } } else { wgpu::Color::TRANSPARENT }
}

fn instance(target: TargetFormat, draw: &UnitDraw) -> [u8; INSTANCE_BYTES] {
    let [r, g, b, a] = draw.constant.map(f32::to_bits);
    let words = [r, g, b, a, draw.state.color.src.code(), u32::from(target.is_unorm())];
    bytemuck::cast(words)
}

const fn operation(equation: Equation) -> wgpu::BlendOperation {
    match equation {
        Equation::Add => wgpu::BlendOperation::Add,
        Equation::Subtract => wgpu::BlendOperation::Subtract,
        Equation::ReverseSubtract => wgpu::BlendOperation::ReverseSubtract,
        Equation::Min => wgpu::BlendOperation::Min,
        Equation::Max => wgpu::BlendOperation::Max,
    }
}

const fn unit_factor(factor: Factor) -> wgpu::BlendFactor {
    use wgpu::BlendFactor as B;
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

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    format: wgpu::TextureFormat,
    lowered: Lowered,
) -> wgpu::RenderPipeline {
    let source = wgpu::vertex_attr_array![0 => Float32x4];
    let place = wgpu::vertex_attr_array![1 => Float32x2];
    let draw = wgpu::vertex_attr_array![2 => Float32x4, 3 => Uint32, 4 => Uint32];
    let buffer =
        |array_stride, step_mode, attributes| Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes });
    let (vertex, instance) = (wgpu::VertexStepMode::Vertex, wgpu::VertexStepMode::Instance);
    let buffers =
        [buffer(16, vertex, &source), buffer(8, vertex, &place), buffer(INSTANCE_BYTES as u64, instance, &draw)];
    // What a shader does not read is not fetched.
    let buffers = if lowered.entry == SOURCE { &buffers[..2] } else { &buffers };
    let mut write_mask = wgpu::ColorWrites::empty();
    let components =
        [wgpu::ColorWrites::RED, wgpu::ColorWrites::GREEN, wgpu::ColorWrites::BLUE, wgpu::ColorWrites::ALPHA];
    for (component, _) in components.into_iter().zip(lowered.mask.0).filter(|(_, on)| *on) {
        write_mask |= component;
    }
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(lowered.entry),
            compilation_options: Default::default(),
            buffers,
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::PointList, ..Default::default() },
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("unit_color"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState { format, blend: Some(lowered.blend), write_mask })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
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
}
