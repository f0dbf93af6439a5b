//! Cases that only a rasteriser can answer: each draws its primitive and looks at one pixel of a target.

use crate::depth_unit::{DEPTH, depth_state};
use crate::device::{Executor, Gpu, Pending};
use crate::error::GpuError;
use crate::shaders::Shaders;
use crate::work::{
    BindGroup, Buffer, ColorAttachment, Command, DepthAttachment, Handle, Read, RenderPass, RenderPipeline, Resources,
    Step, Submission, TextureResource,
};
use lightmeter_scene::depth::{Compare, DepthTest};
use lightmeter_scene::raster::{Provoking, Raster, TARGET_SIZE, Topology};
use wgpu_types::{
    BindGroupLayoutEntry, BindingType, BlendComponent, BlendFactor, BlendOperation, BlendState, BufferBindingType,
    BufferUsages, Color, ColorTargetState, ColorWrites, Face, FrontFace, PrimitiveState, PrimitiveTopology,
    ShaderStages, TextureFormat, TextureUsages,
};

const BITS: TextureFormat = TextureFormat::Rgba32Uint;
const COUNTS: TextureFormat = TextureFormat::Rgba16Float;
const FILE: &str = "raster.wgsl";
const SIZE: [u32; 2] = [TARGET_SIZE; 2];

/// A raster case compiled for a device.
#[derive(Debug)]
pub struct RasterPipeline {
    executor: Executor,
    kind: Raster,
    pipelines: RasterPipelines,
    vertices: u32,
    selector: u32,
}

/// The pipelines of a case's [`Resources`].
#[derive(Clone, Copy, Debug)]
struct RasterPipelines {
    once: Handle,
    /// Draws every case once more.
    again: Option<Handle>,
    /// Turns what was drawn into bits, where it was not drawn as bits.
    reader: Option<Handle>,
}

impl RasterPipeline {
    /// The shaders that it is made of.
    #[must_use]
    pub fn source(shaders: &Shaders) -> String {
        shaders.source(FILE)
    }

    /// Compiles it. `Ok(Err(reason))` where the adapter lacks what it takes.
    ///
    /// # Errors
    /// Where a shader is invalid or the device refuses the pipeline.
    pub fn new(gpu: &Gpu, shaders: &Shaders, kind: Raster) -> Result<Result<Self, &'static str>, GpuError> {
        if let Some(reason) = gpu.lacks_storage(true) {
            return Ok(Err(reason));
        }
        // GLSL cannot choose the provoking vertex; OpenGL's own is the last.
        if gpu.is_gl && matches!(kind, Raster::Flat { provoking: Provoking::First, .. }) {
            return Ok(Err("OpenGL takes flat attributes from the last vertex and wgpu offers no choice there"));
        }
        let (resources, pipelines) = resources(shaders, kind, gpu.is_gl);
        let mut executor = Executor::default();
        executor.make(gpu, &resources, FILE)?;
        let (_, vertices) = drawn(kind, gpu.is_gl);
        let selector = if let Raster::Flat { topology, .. } = kind { topology.code() } else { 0 };
        Ok(Ok(Self { executor, kind, pipelines, vertices, selector }))
    }

    /// Draws every case that can share a target: as many of the rows, from the first on, as look at pixels of their own.
    /// Returns how many those are. The words of the pending result go to [`RasterPipeline::outputs`].
    #[must_use]
    pub fn submit(&self, gpu: &Gpu, rows: &[f32]) -> (usize, Pending) {
        let (count, work) = self.submission(rows);
        (count, self.executor.submit(gpu, &work))
    }

    /// What draws every case that can share a target, and how many those are.
    fn submission(&self, rows: &[f32]) -> (usize, Submission) {
        let inputs = self.kind.inputs();
        let count = distinct_pixels(rows, inputs);
        let rows = &rows[..count * inputs];
        let mut work = Submission::default();
        let stride = [u32::try_from(inputs).unwrap_or(u32::MAX), self.selector, 0, 0];
        let buffers = [
            work.buffer(Buffer::of(rows, BufferUsages::STORAGE)),
            work.buffer(Buffer::of(&stride, BufferUsages::UNIFORM)),
        ];
        let format = drawn_format(self.kind);
        let also = if format == BITS { TextureUsages::COPY_SRC } else { TextureUsages::TEXTURE_BINDING };
        let drawn = work.texture(TextureResource::target(SIZE, format, also));
        let mut pass = self.pass(&mut work, drawn);
        let RasterPipelines { once, again, reader } = self.pipelines;
        for pipeline in [Some(once), again].into_iter().flatten() {
            let group = work.group(BindGroup::of_buffers(pipeline, &buffers));
            pass.commands.extend([Command::Pipeline(pipeline), Command::Group(group)]);
            for (case, row) in (0..).zip(rows.chunks_exact(inputs)) {
                let [x, y] = pixel(row);
                let (vertices, instances) = (0..self.vertices, case..case + 1);
                pass.commands.extend([Command::Scissor([x, y, 1, 1]), Command::Draw { vertices, instances }]);
            }
        }
        work.steps.push(Step::Render(pass));
        let bits = reader.map(|reader| {
            let bits = work.texture(TextureResource::target(SIZE, BITS, TextureUsages::COPY_SRC));
            let group = work.group(BindGroup::of_textures(reader, &[(2, drawn)]));
            work.steps.push(Step::Render(RenderPass::screen(reader, group, &[bits])));
            bits
        });
        work.reads.push(Read::Texture(bits.unwrap_or(drawn)));
        (count, work)
    }

    /// A pass on the target that is drawn to, and on a depth where one is tested.
    fn pass(&self, work: &mut Submission, drawn: Handle) -> RenderPass {
        if self.kind == Raster::OwnDepth {
            return RenderPass { colors: vec![], depth: Some(DepthAttachment::unwritten(drawn)), commands: vec![] };
        }
        let color = if counts_uncovered(self.kind) {
            ColorAttachment::cleared(drawn, Color::TRANSPARENT)
        } else {
            ColorAttachment::sentinel(drawn)
        };
        let depth = self.pipelines.again.map(|_| {
            let tested = work.texture(TextureResource::target(SIZE, DEPTH, TextureUsages::TEXTURE_BINDING));
            DepthAttachment::unwritten(tested)
        });
        RenderPass { colors: vec![color], depth, commands: vec![] }
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
}

/// The shaders and pipelines of a case.
fn resources(shaders: &Shaders, kind: Raster, is_gl: bool) -> (Resources, RasterPipelines) {
    let (mut entries, mut source) = (entries(kind), shaders.source(FILE));
    if is_gl {
        if matches!(kind, Raster::Flat { provoking: Provoking::Last, .. }) {
            entries.0 = "raster_flat_first_vertex";
        }
        source = source.replace("@interpolate(flat, first)", "@interpolate(flat, either)");
    }
    let mut resources = Resources::default();
    let shader = resources.shader(FILE, source);
    let (topology, _) = drawn(kind, is_gl);
    let once = resources.pipeline(pipeline(shader, kind, entries, topology, Compare::Always));
    let again = match kind {
        Raster::SameDepth(compare) => {
            let entries = (entries.0, "raster_covered_again");
            Some(resources.pipeline(pipeline(shader, kind, entries, topology, compare)))
        }
        _ => None,
    };
    let reader = matches!(kind, Raster::OwnDepth | Raster::Quad).then(|| {
        let entries = ("raster_screen", "raster_result");
        resources.pipeline(RenderPipeline::new(entries.1, shader, entries, [BITS.into()]))
    });
    (resources, RasterPipelines { once, again, reader })
}

/// The format that a kind is drawn in.
const fn drawn_format(kind: Raster) -> TextureFormat {
    match kind {
        Raster::Quad => COUNTS,
        Raster::OwnDepth => DEPTH,
        _ => BITS,
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

fn pipeline(
    shader: Handle,
    kind: Raster,
    entries: (&str, &str),
    topology: PrimitiveTopology,
    compare: Compare,
) -> RenderPipeline {
    let is_depth = kind == Raster::OwnDepth;
    let tests_depth = is_depth || matches!(kind, Raster::SameDepth(_));
    let target = (!is_depth).then(|| color_target(kind));
    RenderPipeline {
        layout: Some(vertex_bindings()),
        primitive: primitive(kind, topology),
        depth: tests_depth.then(|| depth_state(DepthTest { compare, write: true })),
        ..RenderPipeline::new(entries.1, shader, entries, target)
    }
}

/// What a kind is drawn to: quads are counted by adding.
fn color_target(kind: Raster) -> ColorTargetState {
    if kind != Raster::Quad {
        return BITS.into();
    }
    let add =
        BlendComponent { src_factor: BlendFactor::One, dst_factor: BlendFactor::One, operation: BlendOperation::Add };
    ColorTargetState {
        format: COUNTS,
        blend: Some(BlendState { color: add, alpha: add }),
        write_mask: ColorWrites::ALL,
    }
}

/// The topology with the faces that are culled.
fn primitive(kind: Raster, topology: PrimitiveTopology) -> PrimitiveState {
    let mut primitive = PrimitiveState { topology, ..Default::default() };
    if let Raster::Culled { back, front_is_ccw } = kind {
        primitive.cull_mode = Some(if back { Face::Back } else { Face::Front });
        primitive.front_face = if front_is_ccw { FrontFace::Ccw } else { FrontFace::Cw };
    }
    if matches!(kind, Raster::Flat { topology: Topology::TriangleStrip, .. }) {
        // Every triangle of the strip faces front, unless the winding was lost on the way to the last vertex.
        primitive.cull_mode = Some(Face::Back);
    }
    primitive
}

/// The bindings of the vertex stage: rows, and their stride.
fn vertex_bindings() -> Vec<BindGroupLayoutEntry> {
    [(0, BufferBindingType::Storage { read_only: true }), (1, BufferBindingType::Uniform)]
        .into_iter()
        .map(|(binding, ty)| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::VERTEX,
            ty: BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        })
        .collect()
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
fn drawn(kind: Raster, native_last: bool) -> (PrimitiveTopology, u32) {
    use PrimitiveTopology as P;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::tests::{device, words_by_json};

    #[test]
    fn primitives_are_drawn_alike_by_way_of_json() {
        if crate::lacks_driver() {
            return;
        }
        let gpu = device();
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        let corners = [-1.0, -1.0, 0.5, 1.0, 3.0, -1.0, 0.25, 1.0, -1.0, 3.0, 0.75, 1.0];
        let triangle = [&corners[..], &[1.0, 2.0, 4.0]].concat();
        let quad = [0.0, 0.0, 0.0, 256.0, 256.0, 256.0, 256.0, 0.0];
        for (kind, drawn) in [
            (Raster::TriangleAttributes, &triangle[..]),
            (Raster::SameDepth(Compare::LessEqual), &triangle),
            (Raster::Quad, &quad),
            (Raster::OwnDepth, &[0.75]),
        ] {
            let made = RasterPipeline::new(&gpu, &shaders, kind).unwrap_or_else(|error| panic!("{error}"));
            let pipeline = made.unwrap_or_else(|reason| panic!("{reason}"));
            let rows: Vec<f32> = [10.0, 200.0].iter().flat_map(|x| [drawn, &[*x, 7.0]].concat()).collect();
            let (resources, _) = resources(&shaders, kind, gpu.is_gl);
            let (count, work) = pipeline.submission(&rows);
            let words = words_by_json(&gpu, &resources, &work);
            assert_eq!((count, words.len()), (2, 4 * 256 * 256), "{kind:?}");
        }
    }
}
