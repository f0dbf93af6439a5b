//! The steps of a submission as wgpu's commands.

use super::clock::Span;
use super::objects::Scope;
use crate::work::{Command, RenderPass, Step};

/// Encodes the steps, of which the first and the last pass write the timestamps of a span.
pub(super) fn encode(encoder: &mut wgpu::CommandEncoder, scope: Scope<'_>, steps: &[Step], span: Span<'_>) {
    for (k, step) in steps.iter().enumerate() {
        let span = span.part(k == 0, k + 1 == steps.len());
        match step {
            Step::Copy { from, to, bytes } => {
                encoder.copy_buffer_to_buffer(scope.buffer(*from), 0, scope.buffer(*to), 0, *bytes as u64);
            }
            Step::Compute(step) => {
                let mut pass = encoder
                    .begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes: span.compute() });
                pass.set_pipeline(scope.compute_pipeline(step.pipeline));
                pass.set_bind_group(0, scope.group(step.group), &[]);
                let [x, y, z] = step.workgroups;
                pass.dispatch_workgroups(x, y, z);
            }
            Step::Render(pass) => render(encoder, scope, pass, span),
        }
    }
}

fn render(encoder: &mut wgpu::CommandEncoder, scope: Scope<'_>, pass: &RenderPass, span: Span<'_>) {
    let colors: Vec<_> = pass
        .colors
        .iter()
        .map(|color| {
            Some(wgpu::RenderPassColorAttachment {
                view: &scope.texture(color.texture).view,
                depth_slice: None,
                resolve_target: None,
                ops: color.operations,
            })
        })
        .collect();
    let depth = pass.depth.as_ref().map(|depth| wgpu::RenderPassDepthStencilAttachment {
        view: &scope.texture(depth.texture).view,
        depth_ops: Some(depth.operations),
        stencil_ops: None,
    });
    let mut encoded = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &colors,
        depth_stencil_attachment: depth,
        timestamp_writes: span.render(),
        ..Default::default()
    });
    for command in &pass.commands {
        encode_command(&mut encoded, scope, command);
    }
}

fn encode_command(pass: &mut wgpu::RenderPass<'_>, scope: Scope<'_>, command: &Command) {
    match command {
        Command::Pipeline(pipeline) => pass.set_pipeline(scope.render_pipeline(*pipeline)),
        Command::Group(group) => pass.set_bind_group(0, scope.group(*group), &[]),
        Command::Vertices { slot, buffer } => pass.set_vertex_buffer(*slot, scope.buffer(*buffer).slice(..)),
        Command::Indices { buffer, format } => pass.set_index_buffer(scope.buffer(*buffer).slice(..), *format),
        Command::BlendConstant(color) => pass.set_blend_constant(*color),
        Command::Scissor([x, y, width, height]) => pass.set_scissor_rect(*x, *y, *width, *height),
        Command::Draw { vertices, instances } => pass.draw(vertices.clone(), instances.clone()),
        Command::DrawIndexed { indices } => pass.draw_indexed(indices.clone(), 0, 0..1),
    }
}
