//! Pipelines, shared by draws that differ in numbers alone.

use super::geometry::Input;
use super::{Effects, Gpu, GpuError, Intermediate, Recipe, ShaderForm};
use crate::blend_unit;
use crate::compose::{Composer, Composition, live};
use crate::depth_unit::depth_state;
use lightmeter_scene::blend::WriteMask;
use lightmeter_scene::blend::{Route, routes};
use lightmeter_scene::depth::{Compare, DepthTest};
use lightmeter_scene::frame::{Blend, Cull, Draw};
use std::collections::HashMap;
use std::rc::Rc;

/// No test is one that always passes and leaves nothing.
const PASSES: DepthTest = DepthTest { compare: Compare::Always, write: false };

/// What a draw's pipeline depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key {
    pub(super) effects: Effects,
    pub(super) blend: Option<wgpu::BlendState>,
    pub(super) depth: Option<DepthTest>,
    pub(super) cull: Cull,
    /// Lights whose vectors are interpolated.
    pub(super) toward: usize,
}

/// A shader with what it reads.
#[derive(Debug)]
pub(super) struct Program {
    module: wgpu::ShaderModule,
    /// The bindings' numbers and names.
    pub(super) bindings: Vec<(u32, String)>,
    pub(super) inputs: Vec<Input>,
    stage: Option<Intermediate>,
}

impl Program {
    /// The effects that it computes of those that a draw calls for.
    pub(super) fn effects(&self, called: Effects) -> Effects {
        live(called, self.stage)
    }
}

/// The shaders and pipelines that were needed so far.
pub(super) struct Pipelines<'a> {
    gpu: &'a Gpu,
    composer: Composer,
    recipe: Recipe,
    format: wgpu::TextureFormat,
    tests_depth: bool,
    /// By their text: different effects may have use for the same.
    programs: HashMap<String, Rc<Program>>,
    pipelines: HashMap<(Key, bool), (wgpu::RenderPipeline, Rc<Program>)>,
}

impl<'a> Pipelines<'a> {
    pub(super) fn new(
        gpu: &'a Gpu,
        composer: Composer,
        recipe: Recipe,
        format: wgpu::TextureFormat,
        tests_depth: bool,
    ) -> Self {
        let (programs, pipelines) = (HashMap::new(), HashMap::new());
        Self { gpu, composer, recipe, format, tests_depth, programs, pipelines }
    }

    pub(super) fn get(&mut self, mut key: Key) -> Result<(wgpu::RenderPipeline, Rc<Program>), GpuError> {
        // A stage without light still tells whether there are normals, which `live` leaves out.
        let has_normals = key.effects.has_normals();
        let called = key.effects;
        let Recipe { shader, stage, .. } = self.recipe;
        key.effects = if shader == ShaderForm::Full { Effects::NONE } else { live(called, stage) };
        if let Some(found) = self.pipelines.get(&(key, has_normals)) {
            return Ok(found.clone());
        }
        let composition = self.composer.compose(called, self.recipe, key.toward)?;
        let program = match self.programs.get(&composition.source) {
            Some(program) => program.clone(),
            None => {
                let program = Rc::new(self.program(&composition)?);
                self.programs.insert(composition.source, program.clone());
                program
            }
        };
        let pipeline = self.pipeline(&program, key);
        self.gpu.check_shader("scene.wgsl")?;
        self.pipelines.insert((key, has_normals), (pipeline.clone(), program.clone()));
        Ok((pipeline, program))
    }

    fn program(&self, composition: &Composition) -> Result<Program, GpuError> {
        let (module, _) = composition.validate()?;
        let bindings = module
            .global_variables
            .iter()
            .filter_map(|(_, global)| Some((global.binding?.binding, global.name.clone().unwrap_or_default())));
        let vertex = module.entry_points.iter().find(|entry| entry.name == Composition::VERTEX);
        let members = vertex.into_iter().flat_map(|entry| &entry.function.arguments).flat_map(|argument| match &module
            .types[argument.ty]
            .inner
        {
            naga::TypeInner::Struct { members, .. } => members.as_slice(),
            _ => &[],
        });
        let inputs = members.filter_map(|member| match member.binding {
            Some(naga::Binding::Location { location, .. }) => Input::at(location),
            _ => None,
        });
        let mut source = self.composer.lower(composition, self.recipe.rung)?;
        if self.gpu.is_gl {
            // GLSL cannot choose the provoking vertex, and naga refuses what asks for the first.
            source = source.replace("@interpolate(flat, first)", "@interpolate(flat, either)");
        }
        Ok(Program {
            module: self.gpu.module("scene.wgsl", source),
            bindings: bindings.collect(),
            inputs: inputs.collect(),
            stage: self.recipe.stage,
        })
    }

    fn pipeline(&self, program: &Program, key: Key) -> wgpu::RenderPipeline {
        let attributes: Vec<[wgpu::VertexAttribute; 1]> = program
            .inputs
            .iter()
            .map(|input| {
                [wgpu::VertexAttribute { format: input.format(), offset: 0, shader_location: input.location() }]
            })
            .collect();
        let buffers: Vec<_> = attributes
            .iter()
            .map(|attributes| {
                Some(wgpu::VertexBufferLayout {
                    array_stride: attributes[0].format.size(),
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes,
                })
            })
            .collect();
        self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("scene"),
            // A binding is there exactly when the shader reads it.
            layout: None,
            vertex: wgpu::VertexState {
                module: &program.module,
                entry_point: Some(Composition::VERTEX),
                compilation_options: Default::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                front_face: wgpu::FrontFace::Ccw,
                cull_mode: match key.cull {
                    Cull::None => None,
                    Cull::Back => Some(wgpu::Face::Back),
                    Cull::Front => Some(wgpu::Face::Front),
                },
                ..Default::default()
            },
            depth_stencil: self.tests_depth.then(|| depth_state(key.depth.unwrap_or(PASSES))),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &program.module,
                entry_point: Some(Composition::FRAGMENT),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.format,
                    blend: key.blend,
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A draw's blend state and constant with the unit's own factors.
///
/// # Errors
/// Where one factor reads the constant's colour and another its alpha: the unit has one constant for both.
pub(super) fn native(draw: &Draw, blend: Blend) -> Result<(wgpu::BlendState, wgpu::Color), GpuError> {
    let route = routes(blend.state)[0];
    if !matches!(route, Route::Native | Route::ConstantReplicated) {
        let message = format!(
            "its blend state {} reads the constant's colour by one factor and its alpha by the other, and the unit has \
             one constant for both; use factors of one kind",
            blend.state
        );
        return Err(GpuError::Draw { draw: draw.name.clone(), message });
    }
    let unit = blend_unit::UnitDraw {
        state: blend.state,
        mask: WriteMask([true; 4]),
        route,
        constant: blend.constant,
        points: 0..0,
    };
    Ok((blend_unit::lower(&unit).blend, blend_unit::blend_constant(&unit)))
}
