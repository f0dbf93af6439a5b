//! The fixed-function blend unit: every state drawn by hardware over a packed target, one read-back for all.

use crate::arithmetic::read_target;
use crate::device::Gpu;
use crate::error::Error;
use crate::raster::{draw_screen, screen_pipeline, texture_group};
use crate::readback::Pending;
use crate::shaders::Shaders;
use lightmeter_scene::blend::{Equation, Factor, State};
use std::collections::HashMap;

/// Pixels of a row of the target.
const WIDTH: u32 = 256;
/// Numbers of a case: source, destination, constant.
const ROW: usize = 12;
const FILE: &str = "blend_unit.wgsl";
const NOTHING: wgpu::Color = wgpu::Color { r: f64::NAN, g: f64::NAN, b: f64::NAN, a: f64::NAN };

/// The format that is blended on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlendTarget {
    /// Four binary32 components.
    Rgba32Float,
    /// Four binary16 components, where the adapter cannot blend on binary32.
    Rgba16Float,
}

impl BlendTarget {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rgba32Float => "rgba32float",
            Self::Rgba16Float => "rgba16float",
        }
    }
}

/// How a state reaches the unit, which has no factor of the constant's alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// The unit's own factors.
    Native,
    /// The constant's alpha given as all four components of the constant.
    ConstantReplicated,
    /// The source multiplied by its constant factor in the shader, and ONE in the unit: both sides read the constant, one
    /// its colour and the other its alpha.
    FoldedIntoSource,
}

impl Route {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Native => "native",
            Self::ConstantReplicated => "constant-replicated",
            Self::FoldedIntoSource => "folded-into-source",
        }
    }
}

/// The route of a state.
#[must_use]
pub const fn route(state: State) -> Route {
    if state.equation.ignores_factors() {
        return Route::Native;
    }
    let (src, dst) = (state.src, state.dst);
    let alpha = src.reads_constant_alpha() || dst.reads_constant_alpha();
    let color = src.reads_constant_color() || dst.reads_constant_color();
    match (alpha, color) {
        (false, _) => Route::Native,
        (true, false) => Route::ConstantReplicated,
        (true, true) => Route::FoldedIntoSource,
    }
}

/// A state as the unit takes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Lowered {
    operation: wgpu::BlendOperation,
    src: wgpu::BlendFactor,
    dst: wgpu::BlendFactor,
    /// The shader's entry point, which may multiply the source by its constant factor.
    entry: &'static str,
    replicated: bool,
}

fn lower(state: State) -> Lowered {
    let route = route(state);
    let folded = route == Route::FoldedIntoSource;
    let entry = match state.src {
        _ if !folded => "unit_source",
        Factor::ConstantColor => "unit_source_constant_color",
        Factor::OneMinusConstantColor => "unit_source_one_minus_constant_color",
        Factor::ConstantAlpha => "unit_source_constant_alpha",
        Factor::OneMinusConstantAlpha => "unit_source_one_minus_constant_alpha",
        _ => unreachable!("a folded source has a constant factor"),
    };
    let ignored = state.equation.ignores_factors();
    Lowered {
        operation: operation(state.equation),
        src: if folded || ignored { wgpu::BlendFactor::One } else { unit_factor(state.src) },
        dst: if ignored { wgpu::BlendFactor::One } else { unit_factor(state.dst) },
        entry,
        replicated: route == Route::ConstantReplicated || (folded && state.dst.reads_constant_alpha()),
    }
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

/// The blend unit of an adapter: cases are shared out among devices that compile side by side.
#[derive(Debug)]
pub struct BlendUnit {
    lanes: Vec<Lane>,
}

/// One device, with the pipelines that were needed on it so far.
#[derive(Debug)]
struct Lane {
    gpu: Gpu,
    target: BlendTarget,
    module: wgpu::ShaderModule,
    destination: wgpu::RenderPipeline,
    reader: wgpu::RenderPipeline,
    sources: HashMap<Lowered, wgpu::RenderPipeline>,
}

/// Results of a [`BlendUnit`] that its devices are still working on: how many cases, and their words.
#[derive(Debug)]
pub struct BlendPending {
    parts: Vec<(usize, Pending)>,
}

/// A run of cases with one state and one constant.
struct Draw {
    lowered: Lowered,
    constant: wgpu::Color,
    cases: std::ops::Range<u32>,
}

impl BlendUnit {
    /// The unit on the widest float target that the adapter can blend on.
    ///
    /// # Errors
    /// Where a shader is invalid, or the driver gives no device or refuses a pipeline.
    pub fn new(gpu: &Gpu, shaders: &Shaders) -> Result<Self, Error> {
        let lanes = (0..gpu.lanes()).map(|_| Lane::new(gpu.sibling()?, shaders)).collect::<Result<_, Error>>()?;
        Ok(Self { lanes })
    }

    /// The format that is blended on.
    #[must_use]
    pub fn target(&self) -> BlendTarget {
        self.lanes[0].target
    }

    /// Blends every case: `states[i]` on row i of `rows`, of 12 numbers each: source, destination, constant.
    ///
    /// # Errors
    /// Where a device refuses a pipeline.
    pub fn submit(&mut self, states: &[State], rows: &[f32]) -> Result<BlendPending, Error> {
        let share = states.len().div_ceil(self.lanes.len()).max(1);
        let shares = states.chunks(share).zip(rows.chunks(share * ROW));
        let parts = self
            .lanes
            .iter_mut()
            .zip(shares)
            .map(|(lane, (states, rows))| Ok((states.len(), lane.submit(states, rows)?)))
            .collect::<Result<_, Error>>()?;
        Ok(BlendPending { parts })
    }

    /// The words of the results, four a case.
    ///
    /// # Errors
    /// Where a device failed or was lost.
    pub fn wait(&self, pending: BlendPending) -> Result<Vec<u32>, Error> {
        let mut words = vec![];
        for (lane, (cases, pending)) in self.lanes.iter().zip(pending.parts) {
            // The target's last row may have pixels of no case.
            words.extend_from_slice(&pending.wait(&lane.gpu)?[..4 * cases]);
        }
        Ok(words)
    }
}

impl Lane {
    fn new(gpu: Gpu, shaders: &Shaders) -> Result<Self, Error> {
        let target = if gpu.blends_f32() { BlendTarget::Rgba32Float } else { BlendTarget::Rgba16Float };
        let module = gpu.module(FILE, shaders.source(FILE));
        let destination = source_pipeline(&gpu, &module, target, None);
        let reader = screen_pipeline(&gpu, &module, "unit_vertex", "unit_result");
        gpu.check_shader(FILE)?;
        Ok(Self { gpu, target, module, destination, reader, sources: HashMap::new() })
    }

    fn submit(&mut self, states: &[State], rows: &[f32]) -> Result<Pending, Error> {
        let gpu = &self.gpu;
        let draws = draws(states, rows);
        for draw in &draws {
            self.sources
                .entry(draw.lowered)
                .or_insert_with(|| source_pipeline(gpu, &self.module, self.target, Some(draw.lowered)));
        }
        gpu.check_shader(FILE)?;
        let count = u32::try_from(states.len()).unwrap_or(u32::MAX);
        // A power of two, so that the middle of every pixel is exact in clip coordinates.
        let height = count.div_ceil(WIDTH).next_power_of_two();
        let colors = gpu.buffer(bytemuck::cast_slice(rows), wgpu::BufferUsages::VERTEX);
        let places = gpu.buffer(bytemuck::cast_slice(&places(count, height)), wgpu::BufferUsages::VERTEX);
        let blended = gpu.target(WIDTH, height, format(self.target));
        let view = blended.create_view(&Default::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    // NaN: what is never written stays it, whatever it is blended with.
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(NOTHING), store: wgpu::StoreOp::Store },
                })],
                ..Default::default()
            });
            pass.set_vertex_buffer(0, places.slice(..));
            pass.set_vertex_buffer(1, colors.slice(..));
            pass.set_pipeline(&self.destination);
            pass.draw(0..count, 0..1);
            for draw in &draws {
                pass.set_pipeline(&self.sources[&draw.lowered]);
                pass.set_blend_constant(draw.constant);
                pass.draw(draw.cases.clone(), 0..1);
            }
        }
        let bits = gpu.target(WIDTH, height, wgpu::TextureFormat::Rgba32Uint);
        let group = texture_group(gpu, &self.reader.get_bind_group_layout(0), 1, &view);
        draw_screen(&mut encoder, &self.reader, &group, &bits);
        Ok(read_target(gpu, encoder, &bits))
    }
}

const fn format(target: BlendTarget) -> wgpu::TextureFormat {
    match target {
        BlendTarget::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        BlendTarget::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
    }
}

/// The middle of each case's pixel in clip coordinates.
fn places(count: u32, height: u32) -> Vec<[f32; 2]> {
    let middle = |pixel: u32, size: u32| f64::from(2 * pixel + 1) / f64::from(size);
    #[expect(clippy::cast_possible_truncation, reason = "exact: sizes are powers of two")]
    let place = |case: u32| [(middle(case % WIDTH, WIDTH) - 1.0) as f32, (1.0 - middle(case / WIDTH, height)) as f32];
    (0..count).map(place).collect()
}

/// Neighbouring cases of one state and one constant become one draw.
fn draws(states: &[State], rows: &[f32]) -> Vec<Draw> {
    let mut draws: Vec<Draw> = vec![];
    for ((case, state), row) in (0u32..).zip(states).zip(rows.chunks_exact(ROW)) {
        let lowered = lower(*state);
        let constant = if lowered.replicated { [row[11]; 4] } else { [row[8], row[9], row[10], row[11]] };
        let constant = if state.reads_constant() { constant.map(f64::from) } else { [0.0; 4] };
        let constant = wgpu::Color { r: constant[0], g: constant[1], b: constant[2], a: constant[3] };
        match draws.last_mut() {
            Some(last) if last.lowered == lowered && last.constant == constant => last.cases.end += 1,
            _ => draws.push(Draw { lowered, constant, cases: case..case + 1 }),
        }
    }
    draws
}

fn source_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    target: BlendTarget,
    lowered: Option<Lowered>,
) -> wgpu::RenderPipeline {
    let entry = lowered.map_or("unit_destination", |lowered| lowered.entry);
    let blend = lowered.map(|lowered| {
        let component =
            wgpu::BlendComponent { src_factor: lowered.src, dst_factor: lowered.dst, operation: lowered.operation };
        wgpu::BlendState { color: component, alpha: component }
    });
    const COLOR: u64 = 16;
    let place = wgpu::vertex_attr_array![0 => Float32x2];
    let colors = wgpu::vertex_attr_array![1 => Float32x4, 2 => Float32x4, 3 => Float32x4];
    let buffer = |array_stride, attributes| {
        Some(wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Vertex, attributes })
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            buffers: &[buffer(8, &place), buffer(3 * COLOR, &colors)],
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::PointList, ..Default::default() },
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("unit_color"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: format(target),
                blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_state_has_a_route_and_509_are_native() {
        let distinct: BTreeSet<State> = State::all().map(State::canonical).collect();
        let count = |wanted| distinct.iter().filter(|state| route(**state) == wanted).count();
        assert_eq!(count(Route::Native), 13 * 13 * 3 + 2);
        assert_eq!(count(Route::ConstantReplicated), 48 * 3);
        assert_eq!(count(Route::FoldedIntoSource), 8 * 3);
    }
}
