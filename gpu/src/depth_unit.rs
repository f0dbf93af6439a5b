//! The fixed-function depth test: every case a pixel, two fragments on it, one read-back for all.

use crate::device::{Executor, Gpu, Pending, middle};
use crate::error::GpuError;
use crate::shaders::Shaders;
use crate::work::{
    BindGroup, Buffer, ColorAttachment, Command, DepthAttachment, Handle, Read, RenderPass, RenderPipeline, Resources,
    Step, Submission, TextureResource, VertexBuffer,
};
use lightmeter_scene::depth::{Compare, DepthTest};
use std::collections::HashMap;
use std::ops::Range;
use wgpu_types::{
    BufferUsages, Color, CompareFunction, DepthStencilState, PrimitiveState, PrimitiveTopology, TextureFormat,
    TextureUsages, VertexAttribute, VertexFormat, VertexStepMode,
};

const FILE: &str = "depth_unit.wgsl";
/// Pixels of a row of the target.
const WIDTH: u32 = 256;
const NUMBERS: TextureFormat = TextureFormat::R32Uint;
const BITS: TextureFormat = TextureFormat::Rgba32Uint;
/// The format of every depth that is tested.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// The shader module of the unit's [`Resources`].
const SHADER: Handle = Handle::Kept(0);

/// Numbers that come out: the fragment that is seen, 1 or 2, and the depth that is left.
pub const DEPTH_OUTPUTS: usize = 2;

/// The depth test of an adapter, with the pipelines that were needed so far.
#[derive(Debug)]
pub struct DepthUnit {
    executor: Executor,
    pipelines: DepthPipelines,
}

#[derive(Debug)]
struct DepthPipelines {
    resources: Resources,
    /// Draws what is there before.
    first: Handle,
    /// Draws what is tested.
    seconds: HashMap<DepthTest, Handle>,
    /// Turns what was drawn into bits.
    reader: Handle,
}

impl DepthUnit {
    /// The shaders that it is made of.
    #[must_use]
    pub fn source(shaders: &Shaders) -> String {
        shaders.source(FILE)
    }

    /// Compiles what every test needs.
    ///
    /// # Errors
    /// Where a shader is invalid or the device refuses a pipeline.
    pub fn new(gpu: &Gpu, shaders: &Shaders) -> Result<Self, GpuError> {
        let (mut executor, pipelines) = (Executor::default(), DepthPipelines::new(shaders));
        executor.make(gpu, &pipelines.resources, FILE)?;
        Ok(Self { executor, pipelines })
    }

    /// Draws every case: `tests[i]` on row i of `rows`, the new depth and the old.
    ///
    /// # Errors
    /// Where the device refuses a pipeline.
    pub fn submit(&mut self, gpu: &Gpu, tests: &[DepthTest], rows: &[f32]) -> Result<Pending, GpuError> {
        self.pipelines.add(tests);
        self.executor.make(gpu, &self.pipelines.resources, FILE)?;
        Ok(self.executor.submit(gpu, &self.pipelines.submission(tests, rows)))
    }

    /// The outputs of each of `count` cases, from the words of the pending result.
    #[must_use]
    pub fn outputs(words: &[u32], count: usize) -> Vec<u32> {
        words.chunks_exact(4).take(count).flat_map(|pixel| pixel[..DEPTH_OUTPUTS].iter().copied()).collect()
    }
}

impl DepthPipelines {
    fn new(shaders: &Shaders) -> Self {
        let mut resources = Resources::default();
        resources.shader(FILE, shaders.source(FILE));
        let always = DepthTest { compare: Compare::Always, write: true };
        let first = resources.pipeline(pipeline(("unit_old", "unit_first"), always));
        let reader = ("unit_screen", "unit_left");
        let reader = resources.pipeline(RenderPipeline::new(reader.1, SHADER, reader, [BITS.into()]));
        Self { resources, first, seconds: HashMap::new(), reader }
    }

    /// Describes the pipelines that are not there yet.
    fn add(&mut self, tests: &[DepthTest]) {
        for test in tests {
            let describe = || self.resources.pipeline(pipeline(("unit_new", "unit_second"), *test));
            self.seconds.entry(*test).or_insert_with(describe);
        }
    }

    fn submission(&self, tests: &[DepthTest], rows: &[f32]) -> Submission {
        let count = u32::try_from(tests.len()).unwrap_or(u32::MAX);
        // A power of two, so that the middle of every pixel is exact in clip coordinates.
        let height = count.div_ceil(WIDTH).next_power_of_two();
        let places: Vec<[f32; 2]> = (0..count).map(|case| middle(case, WIDTH, height)).collect();
        let mut work = Submission::default();
        let places = work.buffer(Buffer::of(&places, BufferUsages::VERTEX));
        let depths = work.buffer(Buffer::of(rows, BufferUsages::VERTEX));
        let mut target = |format, also| work.texture(TextureResource::target([WIDTH, height], format, also));
        let numbers = target(NUMBERS, TextureUsages::TEXTURE_BINDING);
        let depth = target(DEPTH, TextureUsages::TEXTURE_BINDING);
        let bits = target(BITS, TextureUsages::COPY_SRC);
        let mut commands = vec![
            Command::Vertices { slot: 0, buffer: places },
            Command::Vertices { slot: 1, buffer: depths },
            Command::Pipeline(self.first),
            Command::Draw { vertices: 0..count, instances: 0..1 },
        ];
        for (test, vertices) in draws(tests) {
            commands.extend([Command::Pipeline(self.seconds[&test]), Command::Draw { vertices, instances: 0..1 }]);
        }
        work.steps.push(Step::Render(RenderPass {
            // No fragment's number.
            colors: vec![ColorAttachment::cleared(numbers, Color::BLACK)],
            depth: Some(DepthAttachment::unwritten(depth)),
            commands,
        }));
        let group = work.group(BindGroup::of_textures(self.reader, &[(0, numbers), (1, depth)]));
        work.steps.push(Step::Render(RenderPass::screen(self.reader, group, &[bits])));
        work.reads.push(Read::Texture(bits));
        work
    }
}

/// Neighbouring cases of one test become one draw.
fn draws(tests: &[DepthTest]) -> Vec<(DepthTest, Range<u32>)> {
    let mut draws: Vec<(DepthTest, Range<u32>)> = vec![];
    for (case, test) in (0u32..).zip(tests) {
        match draws.last_mut() {
            Some((last, cases)) if last == test => cases.end += 1,
            _ => draws.push((*test, case..case + 1)),
        }
    }
    draws
}

/// The state of a depth test.
pub(crate) fn depth_state(test: DepthTest) -> DepthStencilState {
    DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(test.write),
        depth_compare: Some(compare_function(test.compare)),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

const fn compare_function(compare: Compare) -> CompareFunction {
    match compare {
        Compare::Never => CompareFunction::Never,
        Compare::Less => CompareFunction::Less,
        Compare::Equal => CompareFunction::Equal,
        Compare::LessEqual => CompareFunction::LessEqual,
        Compare::Greater => CompareFunction::Greater,
        Compare::NotEqual => CompareFunction::NotEqual,
        Compare::GreaterEqual => CompareFunction::GreaterEqual,
        Compare::Always => CompareFunction::Always,
    }
}

fn pipeline(entries: (&str, &str), test: DepthTest) -> RenderPipeline {
    let buffer = |shader_location| VertexBuffer {
        stride: 8,
        step: VertexStepMode::Vertex,
        attributes: vec![VertexAttribute { format: VertexFormat::Float32x2, offset: 0, shader_location }],
    };
    RenderPipeline {
        buffers: vec![buffer(0), buffer(1)],
        primitive: PrimitiveState { topology: PrimitiveTopology::PointList, ..Default::default() },
        depth: Some(depth_state(test)),
        ..RenderPipeline::new(entries.1, SHADER, entries, [NUMBERS.into()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::tests::{device, words_by_json};

    #[test]
    fn depths_are_tested_alike_by_way_of_json() {
        if crate::lacks_driver() {
            return;
        }
        let gpu = device();
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        let tests: Vec<DepthTest> = [Compare::Less, Compare::Less, Compare::GreaterEqual, Compare::NotEqual]
            .into_iter()
            .flat_map(|compare| [true, false].map(|write| DepthTest { compare, write }))
            .collect();
        let rows: Vec<f32> = (0..2 * tests.len()).map(|k| [0.25, 0.5, 0.5, 0.5, 0.75][k % 5]).collect();
        let mut pipelines = DepthPipelines::new(&shaders);
        pipelines.add(&tests);
        let words = words_by_json(&gpu, &pipelines.resources, &pipelines.submission(&tests, &rows));
        let mut unit = DepthUnit::new(&gpu, &shaders).unwrap_or_else(|error| panic!("{error}"));
        let pending = unit.submit(&gpu, &tests, &rows).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(words, pending.wait(&gpu).unwrap_or_else(|error| panic!("{error}")));
    }
}
