//! What a draw's shader is told, in the layouts of `scene_uniforms.wgsl` and of the effects' own bindings.

use super::{Called, Effects, Frame, GpuError, Intermediate};
use crate::work::Buffer;
use lightmeter_scene::frame::{Draw, Fog, FogForm, Light, MOST_LIGHTS, Material, Place, Sampled, Wrap};
use std::collections::HashMap;
use wgpu_types::BufferUsages;

/// Words from one uniform to the next, at least: 256 bytes are legal on every device.
const ALIGNMENT: usize = 64;

/// A draw and what its shader computes.
pub(super) struct Told<'a> {
    pub(super) frame: &'a Frame,
    pub(super) draw: &'a Draw,
    pub(super) called: &'a Called,
    pub(super) effects: Effects,
    pub(super) stage: Option<Intermediate>,
}

/// What a binding is given.
#[derive(Clone, Copy, Debug)]
pub(super) enum Resource {
    /// A part of the uniforms' buffer.
    Uniform { offset: u64, bytes: u64 },
    /// A texture by its place; any, where the shader reads none.
    Texture(Option<usize>),
}

/// All uniforms of a frame in one buffer, equal ones once.
#[derive(Default)]
pub(super) struct Packer {
    words: Vec<u32>,
    places: HashMap<Vec<u32>, Resource>,
}

impl Packer {
    fn put(&mut self, words: Vec<u32>) -> Resource {
        if let Some(place) = self.places.get(&words) {
            return *place;
        }
        self.words.resize(self.words.len().next_multiple_of(ALIGNMENT), 0);
        let place = Resource::Uniform { offset: 4 * self.words.len() as u64, bytes: 4 * words.len() as u64 };
        self.words.extend(&words);
        self.places.insert(words, place);
        place
    }

    pub(super) fn finish(self) -> Buffer {
        Buffer::of(&self.words, BufferUsages::UNIFORM | BufferUsages::STORAGE)
    }
}

/// What the binding of that name is given.
///
/// # Errors
/// As [`words`] has them.
pub(super) fn resource(told: &Told<'_>, name: &str, packer: &mut Packer) -> Result<Resource, GpuError> {
    Ok(match words(told, name)? {
        Some(words) => packer.put(words),
        None if name == "scene_texture" => {
            Resource::Texture(told.draw.texture.map(|textured| textured.sampled.texture))
        }
        None => Resource::Texture(told.draw.lightmap.map(|sampled| sampled.texture)),
    })
}

/// What the uniform of that name holds; `None` for textures.
///
/// # Errors
/// Where there is no such binding, which an edited shader may ask for, or more lights than a shader takes.
pub(super) fn words(told: &Told<'_>, name: &str) -> Result<Option<Vec<u32>>, GpuError> {
    let (frame, draw) = (told.frame, told.draw);
    Ok(Some(match name {
        "scene_texture" | "scene_lightmap" => return Ok(None),
        "scene_draw" => draw_words(told),
        "scene_material" => material_words(&draw.material),
        "scene_ambient" => floats(&[four(frame.ambient, 0.0)]),
        "scene_fog" => fog_words(frame.fog.as_ref()),
        "scene_switches" => switch_words(told.effects),
        "scene_texture_reading" => reading_words(draw.texture.map(|textured| textured.sampled)),
        "scene_lightmap_reading" => reading_words(draw.lightmap),
        "scene_cutout" => floats(&[four([draw.cutout.unwrap_or(0.0), 0.0, 0.0], 0.0)]),
        "scene_directional" => light_words(told, DIRECTIONAL, directional)?,
        "scene_directional_unit" => light_words(told, DIRECTIONAL, directional_unit)?,
        "scene_point" => light_words(told, POINT, point)?,
        "scene_spot" => light_words(told, SPOT, spot)?,
        _ => {
            let message = format!("its shader has a binding `{name}`, which nothing is known to be bound to");
            return Err(GpuError::Draw { draw: draw.name.clone(), message });
        }
    }))
}

const fn four([x, y, z]: [f32; 3], w: f32) -> [f32; 4] {
    [x, y, z, w]
}

fn floats(rows: &[[f32; 4]]) -> Vec<u32> {
    rows.iter().flatten().map(|x| x.to_bits()).collect()
}

fn draw_words(told: &Told<'_>) -> Vec<u32> {
    let draw = told.draw;
    // What is not lit has its colour; its highlight is 0.
    let is_base = draw.shading.is_none() && told.stage != Some(Intermediate::Specular);
    let base = if is_base { draw.material.diffuse } else { [0.0; 3] };
    let mut rows = [told.frame.projection, draw.modelview].concat();
    rows.push(four(base, draw.alpha));
    floats(&rows)
}

fn material_words(material: &Material) -> Vec<u32> {
    floats(&[
        four(material.emissive, 0.0),
        four(material.ambient, 0.0),
        four(material.diffuse, 0.0),
        four(material.specular, material.shininess),
    ])
}

fn fog_words(fog: Option<&Fog>) -> Vec<u32> {
    let (density, [dmin, dmax]) = match fog.map(|fog| fog.form) {
        Some(FogForm::Linear { dmin, dmax }) => (0.0, [dmin, dmax]),
        Some(FogForm::Exp { density } | FogForm::Exp2Document { density } | FogForm::Exp2OpenGl { density }) => {
            (density, [0.0; 2])
        }
        None => (0.0, [0.0; 2]),
    };
    floats(&[four(fog.map_or([0.0; 3], |fog| fog.color), density), [dmin, dmax, 0.0, 0.0]])
}

fn switch_words(effects: Effects) -> Vec<u32> {
    let bits = effects.bits();
    #[expect(clippy::cast_possible_truncation, reason = "the two halves")]
    let halves = [bits as u32, (bits >> 32) as u32];
    vec![halves[0], halves[1], 0, 0]
}

fn reading_words(sampled: Option<Sampled>) -> Vec<u32> {
    let clamps = sampled.is_some_and(|sampled| sampled.wrap == Wrap::Clamp);
    vec![u32::from(clamps), 0, 0, 0]
}

/// Rows of four words that a light of a kind takes.
const DIRECTIONAL: usize = 4;
const POINT: usize = 5;
const SPOT: usize = 6;

/// The lights of a kind that shine on the draw, how many of them first.
fn light_words(
    told: &Told<'_>,
    rows: usize,
    of_kind: fn(&Light) -> Option<Vec<[f32; 4]>>,
) -> Result<Vec<u32>, GpuError> {
    let lights: Vec<_> = told.called.lights.iter().filter_map(|&light| of_kind(&told.frame.lights[light])).collect();
    if lights.len() > MOST_LIGHTS {
        let message = format!("{} lights of a kind shine on it, and a shader takes {MOST_LIGHTS}", lights.len());
        return Err(GpuError::Draw { draw: told.draw.name.clone(), message });
    }
    let mut words = vec![u32::try_from(lights.len()).unwrap_or(u32::MAX), 0, 0, 0];
    words.extend(floats(&lights.concat()));
    words.resize(4 * (1 + rows * MOST_LIGHTS), 0);
    Ok(words)
}

fn colors(light: &Light) -> [[f32; 4]; 3] {
    [light.ambient, light.diffuse, light.specular].map(|color| four(color, 0.0))
}

fn directional(light: &Light) -> Option<Vec<[f32; 4]>> {
    let Place::Directional { toward, unit: false } = light.place else { return None };
    Some([&colors(light)[..], &[four(toward, 0.0)]].concat())
}

fn directional_unit(light: &Light) -> Option<Vec<[f32; 4]>> {
    let Place::Directional { toward, unit: true } = light.place else { return None };
    Some([&colors(light)[..], &[four(toward, 0.0)]].concat())
}

fn point(light: &Light) -> Option<Vec<[f32; 4]>> {
    let Place::Point { position, falloff } = light.place else { return None };
    Some([&colors(light)[..], &[four(position, 0.0), four(falloff, 0.0)]].concat())
}

fn spot(light: &Light) -> Option<Vec<[f32; 4]>> {
    let Place::Spot { position, falloff, axis, cutoff_cosine, exponent } = light.place else { return None };
    let rows = [four(position, 0.0), four(falloff, exponent), four(axis, cutoff_cosine)];
    Some([&colors(light)[..], &rows].concat())
}
