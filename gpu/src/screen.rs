//! What turns a drawn target into bits: a draw over the whole of a target of integers, which reads the first.

use crate::device::Gpu;
use crate::pipeline::cleared;

/// The format of a target of bits.
pub(crate) const BITS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// A pipeline that draws over a whole target of bits.
pub(crate) fn screen_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    vertex: &str,
    fragment: &str,
) -> wgpu::RenderPipeline {
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(BITS.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws over the whole of an integer target.
pub(crate) fn draw_screen(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::RenderPipeline,
    group: &wgpu::BindGroup,
    target: &wgpu::Texture,
) {
    let view = target.create_view(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(cleared(&view))],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..3, 0..1);
}
