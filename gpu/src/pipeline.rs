//! Pipelines of generated entry points, and what is bound and attached to them.

use crate::device::Gpu;
use crate::device::readback::sentinel_color;

/// An entry point in the compute stage.
pub(crate) fn compute_pipeline(gpu: &Gpu, label: &str, source: String, entry: &str) -> wgpu::ComputePipeline {
    let module = gpu.module(label, source);
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(label),
        layout: None,
        module: &module,
        entry_point: Some(entry),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// `lightmeter_fragment` over a triangle that covers every pixel.
pub(crate) fn render_pipeline(
    gpu: &Gpu,
    label: &str,
    source: String,
    targets: &[wgpu::TextureFormat],
) -> wgpu::RenderPipeline {
    let module = gpu.module(label, source);
    let targets: Vec<_> = targets.iter().map(|&format| Some(wgpu::ColorTargetState::from(format))).collect();
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("lightmeter_vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("lightmeter_fragment"),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The buffers as bindings 0, 1, …
pub(crate) fn bind(gpu: &Gpu, layout: &wgpu::BindGroupLayout, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

/// An integer attachment filled with the sentinel first.
pub(crate) fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(sentinel_color()), store: wgpu::StoreOp::Store },
    }
}
