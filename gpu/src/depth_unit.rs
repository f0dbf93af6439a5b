//! The fixed-function depth test: every case a pixel, two fragments on it, one read-back for all.

use crate::device::readback::{Pending, read_target};
use crate::device::{Gpu, middle};
use crate::error::GpuError;
use crate::screen::{BITS, draw_screen, screen_pipeline};
use crate::shaders::Shaders;
use lightmeter_scene::depth::{Compare, DepthTest};
use std::collections::HashMap;
use std::ops::Range;

const FILE: &str = "depth_unit.wgsl";
/// Pixels of a row of the target.
const WIDTH: u32 = 256;
const NUMBERS: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Numbers that come out: the fragment that is seen, 1 or 2, and the depth that is left.
pub const DEPTH_OUTPUTS: usize = 2;

/// The depth test of an adapter, with the pipelines that were needed so far.
#[derive(Debug)]
pub struct DepthUnit {
    module: wgpu::ShaderModule,
    first: wgpu::RenderPipeline,
    seconds: HashMap<DepthTest, wgpu::RenderPipeline>,
    reader: wgpu::RenderPipeline,
}

impl DepthUnit {
    /// Compiles what every test needs.
    ///
    /// # Errors
    /// Where a shader is invalid or the device refuses a pipeline.
    pub fn new(gpu: &Gpu, shaders: &Shaders) -> Result<Self, GpuError> {
        let module = gpu.module(FILE, shaders.source(FILE));
        let always = DepthTest { compare: Compare::Always, write: true };
        let first = pipeline(gpu, &module, ("unit_old", "unit_first"), always);
        let reader = screen_pipeline(gpu, &module, "unit_screen", "unit_left");
        gpu.check_shader(FILE)?;
        Ok(Self { module, first, seconds: HashMap::new(), reader })
    }

    /// Draws every case: `tests[i]` on row i of `rows`, the new depth and the old.
    ///
    /// # Errors
    /// Where the device refuses a pipeline.
    pub fn submit(&mut self, gpu: &Gpu, tests: &[DepthTest], rows: &[f32]) -> Result<Pending, GpuError> {
        for test in tests {
            let module = &self.module;
            self.seconds.entry(*test).or_insert_with(|| pipeline(gpu, module, ("unit_new", "unit_second"), *test));
        }
        gpu.check_shader(FILE)?;
        let count = u32::try_from(tests.len()).unwrap_or(u32::MAX);
        // A power of two, so that the middle of every pixel is exact in clip coordinates.
        let height = count.div_ceil(WIDTH).next_power_of_two();
        let vertex = wgpu::BufferUsages::VERTEX;
        let places: Vec<[f32; 2]> = (0..count).map(|case| middle(case, WIDTH, height)).collect();
        let places = gpu.buffer(bytemuck::cast_slice(&places), vertex);
        let depths = gpu.buffer(bytemuck::cast_slice(rows), vertex);
        let (numbers, depth) = (gpu.target(WIDTH, height, NUMBERS), gpu.target(WIDTH, height, DEPTH));
        let [numbers, depth] = [&numbers, &depth].map(|texture| texture.create_view(&Default::default()));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &numbers,
                    depth_slice: None,
                    resolve_target: None,
                    // No fragment's number.
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &depth,
                    // A depth that no case writes exactly.
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(0.314_159_3),
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_vertex_buffer(0, places.slice(..));
            pass.set_vertex_buffer(1, depths.slice(..));
            pass.set_pipeline(&self.first);
            pass.draw(0..count, 0..1);
            for (test, cases) in draws(tests) {
                pass.set_pipeline(&self.seconds[&test]);
                pass.draw(cases, 0..1);
            }
        }
        let bits = gpu.target(WIDTH, height, BITS);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.reader.get_bind_group_layout(0),
            entries: &[(0, &numbers), (1, &depth)].map(|(binding, view)| wgpu::BindGroupEntry {
                binding,
                resource: wgpu::BindingResource::TextureView(view),
            }),
        });
        draw_screen(&mut encoder, &self.reader, &group, &bits);
        Ok(read_target(gpu, encoder, &bits))
    }

    /// The outputs of each of `count` cases, from the words of the pending result.
    #[must_use]
    pub fn outputs(words: &[u32], count: usize) -> Vec<u32> {
        words.chunks_exact(4).take(count).flat_map(|pixel| pixel[..DEPTH_OUTPUTS].iter().copied()).collect()
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

pub(crate) const fn compare_function(compare: Compare) -> wgpu::CompareFunction {
    match compare {
        Compare::Never => wgpu::CompareFunction::Never,
        Compare::Less => wgpu::CompareFunction::Less,
        Compare::Equal => wgpu::CompareFunction::Equal,
        Compare::LessEqual => wgpu::CompareFunction::LessEqual,
        Compare::Greater => wgpu::CompareFunction::Greater,
        Compare::NotEqual => wgpu::CompareFunction::NotEqual,
        Compare::GreaterEqual => wgpu::CompareFunction::GreaterEqual,
        Compare::Always => wgpu::CompareFunction::Always,
    }
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    (vertex, fragment): (&str, &str),
    test: DepthTest,
) -> wgpu::RenderPipeline {
    let place = wgpu::vertex_attr_array![0 => Float32x2];
    let depths = wgpu::vertex_attr_array![1 => Float32x2];
    let buffer = |attributes| {
        Some(wgpu::VertexBufferLayout { array_stride: 8, step_mode: wgpu::VertexStepMode::Vertex, attributes })
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[buffer(&place), buffer(&depths)],
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::PointList, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(test.write),
            depth_compare: Some(compare_function(test.compare)),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(NUMBERS.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
