//! Cases that only a rasteriser can answer: each draws its primitive and looks at one pixel of a target.

use crate::depth_unit::compare_function;
use crate::device::Gpu;
use crate::device::readback::{Pending, read_target};
use crate::error::GpuError;
use crate::pipeline::{bind, cleared};
use crate::screen::{BITS, draw_screen, screen_pipeline};
use crate::shaders::Shaders;
use lightmeter_scene::depth::Compare;
use lightmeter_scene::raster::{Provoking, Raster, TARGET_SIZE, Topology};

const COUNTS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const FILE: &str = "raster.wgsl";

/// A raster case compiled for a device.
#[derive(Debug)]
pub struct RasterPipeline {
    kind: Raster,
    pipeline: wgpu::RenderPipeline,
    /// Draws every case once more.
    again: Option<wgpu::RenderPipeline>,
    /// Turns what was drawn into bits, where it was not drawn as bits.
    reader: Option<wgpu::RenderPipeline>,
    vertices: u32,
    selector: u32,
}

impl RasterPipeline {
    /// Compiles it. `Ok(Err(reason))` where the adapter lacks what it takes.
    ///
    /// # Errors
    /// Where a shader is invalid or the device refuses the pipeline.
    pub fn new(gpu: &Gpu, shaders: &Shaders, kind: Raster) -> Result<Result<Self, &'static str>, GpuError> {
        if let Some(reason) = gpu.lacks_storage(true) {
            return Ok(Err(reason));
        }
        let (mut entries, mut source) = (entries(kind), shaders.source(FILE));
        if gpu.is_gl {
            // GLSL cannot choose the provoking vertex; OpenGL's own is the last.
            match kind {
                Raster::Flat { provoking: Provoking::First, .. } => {
                    return Ok(Err(
                        "OpenGL takes flat attributes from the last vertex and wgpu offers no choice there",
                    ));
                }
                Raster::Flat { provoking: Provoking::Last, .. } => entries.0 = "raster_flat_first_vertex",
                _ => {}
            }
            source = source.replace("@interpolate(flat, first)", "@interpolate(flat, either)");
        }
        let module = gpu.module(FILE, source);
        let (topology, vertices) = drawn(kind, gpu.is_gl);
        let once = pipeline(gpu, &module, kind, entries, topology, Compare::Always);
        let again = match kind {
            Raster::SameDepth(compare) => {
                Some(pipeline(gpu, &module, kind, (entries.0, "raster_covered_again"), topology, compare))
            }
            _ => None,
        };
        let reader = matches!(kind, Raster::OwnDepth | Raster::Quad)
            .then(|| screen_pipeline(gpu, &module, "raster_screen", "raster_result"));
        gpu.check_shader(FILE)?;
        let selector = if let Raster::Flat { topology, .. } = kind { topology.code() } else { 0 };
        Ok(Ok(Self { kind, pipeline: once, again, reader, vertices, selector }))
    }

    /// Draws every case that can share a target: as many of the rows, from the first on, as look at pixels of their own.
    /// Returns how many those are. The words of the pending result go to [`RasterPipeline::outputs`].
    #[must_use]
    pub fn submit(&self, gpu: &Gpu, rows: &[f32]) -> (usize, Pending) {
        let inputs = self.kind.inputs();
        let count = distinct_pixels(rows, inputs);
        let rows = &rows[..count * inputs];
        let buffer = gpu.buffer(bytemuck::cast_slice(rows), wgpu::BufferUsages::STORAGE);
        let stride = [u32::try_from(inputs).unwrap_or(u32::MAX), self.selector, 0, 0];
        let stride = gpu.buffer(bytemuck::cast_slice(&stride), wgpu::BufferUsages::UNIFORM);
        let drawn = gpu.target(TARGET_SIZE, TARGET_SIZE, self.format());
        let view = drawn.create_view(&Default::default());
        let is_depth = self.kind == Raster::OwnDepth;
        let tested =
            self.again.as_ref().map(|_| gpu.target(TARGET_SIZE, TARGET_SIZE, DEPTH).create_view(&Default::default()));
        let depth = if is_depth { Some(&view) } else { tested.as_ref() };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &if is_depth { vec![] } else { vec![Some(self.attachment(&view))] },
                depth_stencil_attachment: depth.map(clear_depth),
                ..Default::default()
            });
            for pipeline in [Some(&self.pipeline), self.again.as_ref()].into_iter().flatten() {
                pass.set_pipeline(pipeline);
                let layout = pipeline.get_bind_group_layout(0);
                pass.set_bind_group(0, &bind(gpu, &layout, &[&buffer, &stride]), &[]);
                for (case, row) in (0..).zip(rows.chunks_exact(inputs)) {
                    let [x, y] = pixel(row);
                    pass.set_scissor_rect(x, y, 1, 1);
                    pass.draw(0..self.vertices, case..case + 1);
                }
            }
        }
        let pending = match &self.reader {
            None => read_target(gpu, encoder, &drawn),
            Some(reader) => {
                let bits = gpu.target(TARGET_SIZE, TARGET_SIZE, BITS);
                let group = texture_group(gpu, &reader.get_bind_group_layout(0), 2, &view);
                draw_screen(&mut encoder, reader, &group, &bits);
                read_target(gpu, encoder, &bits)
            }
        };
        (count, pending)
    }

    /// The outputs of each of the rows that were drawn, in order.
    #[must_use]
    pub fn outputs(&self, words: &[u32], rows: &[f32], count: usize) -> Vec<u32> {
        let rows = rows.chunks_exact(self.kind.inputs()).take(count);
        rows.flat_map(|row| {
            let [x, y] = pixel(row);
            let first = 4 * (y * TARGET_SIZE + x) as usize;
            words[first..first + self.kind.outputs()].iter().copied()
        })
        .collect()
    }

    fn format(&self) -> wgpu::TextureFormat {
        match self.kind {
            Raster::Quad => COUNTS,
            Raster::OwnDepth => DEPTH,
            _ => BITS,
        }
    }

    fn attachment<'a>(&self, view: &'a wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'a> {
        let mut attachment = cleared(view);
        if counts_uncovered(self.kind) {
            attachment.ops.load = wgpu::LoadOp::Clear(wgpu::Color { r: 0.0, g: 0.0, b: 0.0, a: 0.0 });
        }
        attachment
    }
}

/// The pixel that a row ends with.
fn pixel(row: &[f32]) -> [u32; 2] {
    let whole = |x: f32| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the target's pixels")]
        let x = x.clamp(0.0, 255.0) as u32;
        x
    };
    [whole(row[row.len() - 2]), whole(row[row.len() - 1])]
}

/// How many rows, from the first on, look at pixels that none before them looks at.
fn distinct_pixels(rows: &[f32], inputs: usize) -> usize {
    let mut seen = vec![false; (TARGET_SIZE * TARGET_SIZE) as usize];
    let taken = rows.chunks_exact(inputs).take_while(|row| {
        let [x, y] = pixel(row);
        !std::mem::replace(&mut seen[(y * TARGET_SIZE + x) as usize], true)
    });
    taken.count()
}

/// Depths that no case writes exactly tell an unwritten pixel.
fn clear_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.314_159_3), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    kind: Raster,
    (vertex, fragment): (&str, &str),
    topology: wgpu::PrimitiveTopology,
    compare: Compare,
) -> wgpu::RenderPipeline {
    let is_depth = kind == Raster::OwnDepth;
    let tests_depth = is_depth || matches!(kind, Raster::SameDepth(_));
    let target = (!is_depth).then(|| color_target(kind));
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(&vertex_bindings(gpu))],
        ..Default::default()
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: primitive(kind, topology),
        depth_stencil: tests_depth.then(|| wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(compare_function(compare)),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: if is_depth { &[] } else { std::slice::from_ref(&target) },
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// What a kind is drawn to: quads are counted by adding.
fn color_target(kind: Raster) -> wgpu::ColorTargetState {
    if kind != Raster::Quad {
        return BITS.into();
    }
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::ColorTargetState {
        format: COUNTS,
        blend: Some(wgpu::BlendState { color: add, alpha: add }),
        write_mask: wgpu::ColorWrites::ALL,
    }
}

/// The topology with the faces that are culled.
fn primitive(kind: Raster, topology: wgpu::PrimitiveTopology) -> wgpu::PrimitiveState {
    let mut primitive = wgpu::PrimitiveState { topology, ..Default::default() };
    if let Raster::Culled { back, front_is_ccw } = kind {
        primitive.cull_mode = Some(if back { wgpu::Face::Back } else { wgpu::Face::Front });
        primitive.front_face = if front_is_ccw { wgpu::FrontFace::Ccw } else { wgpu::FrontFace::Cw };
    }
    if matches!(kind, Raster::Flat { topology: Topology::TriangleStrip, .. }) {
        // Every triangle of the strip faces front, unless the winding was lost on the way to the last vertex.
        primitive.cull_mode = Some(wgpu::Face::Back);
    }
    primitive
}

/// The bindings of the vertex stage: rows, and their stride.
fn vertex_bindings(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries: Vec<wgpu::BindGroupLayoutEntry> =
        [(0, wgpu::BufferBindingType::Storage { read_only: true }), (1, wgpu::BufferBindingType::Uniform)]
            .into_iter()
            .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
                count: None,
            })
            .collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

/// A bind group of one texture.
fn texture_group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroup {
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &[wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) }],
    })
}

/// The entry points of a vertex and of a fragment.
const fn entries(kind: Raster) -> (&'static str, &'static str) {
    match kind {
        Raster::TriangleAttributes => ("raster_triangle_vertex", "raster_attributes"),
        Raster::TrianglePosition => ("raster_triangle_vertex", "raster_position"),
        Raster::LineAttributes => ("raster_line_vertex", "raster_attributes"),
        Raster::Quad => ("raster_quad_vertex", "raster_count"),
        Raster::OwnDepth => ("raster_depth_vertex", "raster_own_depth"),
        Raster::Facing => ("raster_triangle_vertex", "raster_facing"),
        Raster::Clipped | Raster::Culled { .. } | Raster::SameDepth(_) => ("raster_triangle_vertex", "raster_covered"),
        Raster::Flat { provoking: Provoking::First, .. } => ("raster_flat_first_vertex", "raster_flat_fragment"),
        Raster::Flat { provoking: Provoking::Last, .. } => ("raster_flat_last_vertex", "raster_flat_fragment"),
    }
}

/// The topology given to the hardware, and the vertices of a case.
fn drawn(kind: Raster, native_last: bool) -> (wgpu::PrimitiveTopology, u32) {
    use wgpu::PrimitiveTopology as P;
    match kind {
        Raster::LineAttributes => (P::LineList, 2),
        Raster::Quad => (P::TriangleList, 6),
        Raster::Flat { topology, provoking } => {
            let as_given = provoking == Provoking::First || native_last;
            match (topology, as_given) {
                (Topology::Points, _) => (P::PointList, 6),
                (Topology::LineList, _) => (P::LineList, 6),
                (Topology::TriangleList, _) => (P::TriangleList, 6),
                (Topology::LineStrip, true) => (P::LineStrip, 6),
                (Topology::LineStrip, false) => (P::LineList, 10),
                (Topology::TriangleStrip, true) => (P::TriangleStrip, 6),
                (Topology::TriangleStrip, false) => (P::TriangleList, 12),
            }
        }
        _ => (P::TriangleList, 3),
    }
}

/// Whether an uncovered pixel is an answer, 0, rather than a failure to write.
const fn counts_uncovered(kind: Raster) -> bool {
    matches!(kind, Raster::Quad | Raster::Clipped | Raster::Culled { .. })
}
