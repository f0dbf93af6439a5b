//! Pipelines, shared by draws that differ in numbers alone.

use super::geometry::Input;
use super::{Effects, FILE, GpuError, Intermediate, Recipe, ShaderForm};
use crate::blend_unit;
use crate::compose::{Composer, Composition, live};
use crate::depth_unit::depth_state;
use crate::work::{Handle, RenderPipeline, Resources, VertexBuffer};
use lightmeter_scene::blend::WriteMask;
use lightmeter_scene::blend::{Route, routes};
use lightmeter_scene::depth::{Compare, DepthTest};
use lightmeter_scene::frame::{Blend, Cull, Draw};
use std::collections::HashMap;
use std::rc::Rc;
use wgpu_types::{
    BlendState, Color, ColorTargetState, ColorWrites, Face, FrontFace, PrimitiveState, TextureFormat, VertexAttribute,
    VertexStepMode,
};

/// No test is one that always passes and leaves nothing.
const PASSES: DepthTest = DepthTest { compare: Compare::Always, write: false };

/// What a draw's pipeline depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key {
    pub(super) effects: Effects,
    pub(super) blend: Option<BlendState>,
    pub(super) depth: Option<DepthTest>,
    pub(super) cull: Cull,
    /// Lights whose vectors are interpolated.
    pub(super) toward: usize,
}

/// A shader with what it reads.
#[derive(Debug)]
pub(super) struct Program {
    shader: Handle,
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
pub(super) struct Pipelines {
    composer: Composer,
    recipe: Recipe,
    format: TextureFormat,
    tests_depth: bool,
    is_gl: bool,
    /// By their text: different effects may have use for the same.
    programs: HashMap<String, Rc<Program>>,
    pipelines: HashMap<(Key, bool), (Handle, Rc<Program>)>,
}

impl Pipelines {
    pub(super) fn new(
        composer: Composer,
        recipe: Recipe,
        format: TextureFormat,
        tests_depth: bool,
        is_gl: bool,
    ) -> Self {
        let (programs, pipelines) = (HashMap::new(), HashMap::new());
        Self { composer, recipe, format, tests_depth, is_gl, programs, pipelines }
    }

    pub(super) fn get(&mut self, resources: &mut Resources, mut key: Key) -> Result<(Handle, Rc<Program>), GpuError> {
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
                let program = Rc::new(self.program(resources, &composition)?);
                self.programs.insert(composition.source, program.clone());
                program
            }
        };
        let pipeline = resources.pipeline(self.pipeline(&program, key));
        self.pipelines.insert((key, has_normals), (pipeline, program.clone()));
        Ok((pipeline, program))
    }

    fn program(&self, resources: &mut Resources, composition: &Composition) -> Result<Program, GpuError> {
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
        if self.is_gl {
            // GLSL cannot choose the provoking vertex, and naga refuses what asks for the first.
            source = source.replace("@interpolate(flat, first)", "@interpolate(flat, either)");
        }
        Ok(Program {
            shader: resources.shader(FILE, source),
            bindings: bindings.collect(),
            inputs: inputs.collect(),
            stage: self.recipe.stage,
        })
    }

    fn pipeline(&self, program: &Program, key: Key) -> RenderPipeline {
        let buffer = |input: &Input| VertexBuffer {
            stride: input.format().size(),
            step: VertexStepMode::Vertex,
            attributes: vec![VertexAttribute { format: input.format(), offset: 0, shader_location: input.location() }],
        };
        let target = ColorTargetState { format: self.format, blend: key.blend, write_mask: ColorWrites::ALL };
        let entries = (Composition::VERTEX, Composition::FRAGMENT);
        RenderPipeline {
            buffers: program.inputs.iter().map(buffer).collect(),
            primitive: PrimitiveState {
                front_face: FrontFace::Ccw,
                cull_mode: match key.cull {
                    Cull::None => None,
                    Cull::Back => Some(Face::Back),
                    Cull::Front => Some(Face::Front),
                },
                ..Default::default()
            },
            depth: self.tests_depth.then(|| depth_state(key.depth.unwrap_or(PASSES))),
            // A binding is there exactly when the shader reads it.
            layout: None,
            ..RenderPipeline::new("scene", program.shader, entries, [target])
        }
    }
}

/// A draw's blend state and constant with the unit's own factors.
///
/// # Errors
/// Where one factor reads the constant's colour and another its alpha: the unit has one constant for both.
pub(super) fn native(draw: &Draw, blend: Blend) -> Result<(BlendState, Color), GpuError> {
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
