//! A frame as a file that any renderer can read: plain numbers, and the words of scene files.

use lightmeter_scene::blend::State;
use lightmeter_scene::effects::effects;
use lightmeter_scene::frame::{Blend, Draw, Fog, FogForm, Frame, Light, Place, Sampled, Shading, Textured};
use lightmeter_scene::model;
use lightmeter_scene::shading::Frequency;
use serde::Serialize;
use serde_json::{Value, json};

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.frame/1";

/// The frame with its meshes and textures.
#[must_use]
pub fn to_json(id: &str, title: &str, frame: &Frame) -> Value {
    let meshes = frame.meshes.iter().map(|mesh| {
        json!({
            "positions": mesh.positions,
            "normals": mesh.normals,
            "uvs": mesh.uvs,
            "lightmap_uvs": mesh.lightmap_uvs,
            "colors": mesh.colors,
            "triangles": mesh.triangles,
        })
    });
    let textures = frame
        .textures
        .iter()
        .map(|texture| json!({ "width": texture.width, "height": texture.height, "texels": texture.texels }));
    json!({
        "schema": SCHEMA,
        "id": id,
        "title": title,
        "target": {
            "width": frame.target.width,
            "height": frame.target.height,
            "format": frame.target.format.name(),
        },
        "background": frame.background,
        "clear_depth": frame.clear_depth,
        "projection": frame.projection,
        "ambient": frame.ambient,
        "ambient_form": word::<model::AmbientForm>(frame.ambient_form),
        "light_ambient": word::<model::LightAmbient>(frame.light_ambient),
        "lights": frame.lights.iter().map(light).collect::<Vec<_>>(),
        "fog": frame.fog.as_ref().map(fog),
        "meshes": meshes.collect::<Vec<_>>(),
        "textures": textures.collect::<Vec<_>>(),
        "draws": frame.draws.iter().map(draw).collect::<Vec<_>>(),
        "effects": called(frame),
    })
}

/// The names of the effects that any draw calls for, in their order.
pub(super) fn called(frame: &Frame) -> Vec<&'static str> {
    let draws = effects(frame);
    let is_called = |effect: &lightmeter_scene::effects::Effect| draws.iter().any(|called| called.effects.has(*effect));
    lightmeter_scene::effects::Effect::ALL.into_iter().filter(is_called).map(|effect| effect.name()).collect()
}

/// The word of a scene file that stands for a resolved value.
fn word<W: Serialize>(resolved: impl Into<W>) -> Value {
    json!(resolved.into())
}

fn light(light: &Light) -> Value {
    let place = match light.place {
        Place::Directional { toward, unit } => json!({ "kind": "directional", "toward": toward, "unit": unit }),
        Place::Point { position, falloff } => json!({ "kind": "point", "position": position, "falloff": falloff }),
        Place::Spot { position, falloff, axis, cutoff_cosine, exponent } => json!({
            "kind": "spot",
            "position": position,
            "falloff": falloff,
            "axis": axis,
            "cutoff_cosine": cutoff_cosine,
            "exponent": exponent,
        }),
    };
    json!({
        "name": light.name,
        "ambient": light.ambient,
        "diffuse": light.diffuse,
        "specular": light.specular,
        "place": place,
    })
}

fn fog(fog: &Fog) -> Value {
    let form = match fog.form {
        FogForm::Linear { dmin, dmax } => json!({ "kind": "linear", "dmin": dmin, "dmax": dmax }),
        FogForm::Exp { density } => json!({ "kind": "exp", "density": density }),
        FogForm::Exp2Document { density } => json!({ "kind": "exp2-document", "density": density }),
        FogForm::Exp2OpenGl { density } => json!({ "kind": "exp2-opengl", "density": density }),
    };
    json!({ "color": fog.color, "form": form, "distance": word::<model::FogDistance>(fog.distance) })
}

fn draw(draw: &Draw) -> Value {
    json!({
        "name": draw.name,
        "mesh": draw.mesh,
        "modelview": draw.modelview,
        "material": {
            "emissive": draw.material.emissive,
            "ambient": draw.material.ambient,
            "diffuse": draw.material.diffuse,
            "specular": draw.material.specular,
            "shininess": draw.material.shininess,
        },
        "shading": draw.shading.map(shading),
        "alpha": draw.alpha,
        "vertex_colors": draw.vertex_colors,
        "texture": draw.texture.map(textured),
        "lightmap": draw.lightmap.map(sampled),
        "cutout": draw.cutout,
        "blend": draw.blend.map(blend),
        "depth": draw.depth.map(|test| json!({ "compare": test.compare.name(), "write": test.write })),
        "cull": word::<model::Cull>(draw.cull),
    })
}

fn shading(shading: Shading) -> Value {
    let frequency = match shading.frequency {
        Frequency::Flat => model::Frequency::Flat,
        Frequency::Gouraud => model::Frequency::Gouraud,
        Frequency::Phong => model::Frequency::Phong,
    };
    json!({
        "frequency": frequency,
        "provoking": word::<model::TakenFrom>(shading.provoking),
        "specular": word::<model::Specular>(shading.specular),
        "gate": word::<model::Gate>(shading.gate),
        "viewer": word::<model::Viewer>(shading.viewer),
        "normals": word::<model::NormalForm>(shading.normals),
    })
}

fn sampled(sampled: Sampled) -> Value {
    json!({
        "texture": sampled.texture,
        "filter": word::<model::ReadFilter>(sampled.filter),
        "wrap": word::<model::ReadWrap>(sampled.wrap),
    })
}

fn textured(textured: Textured) -> Value {
    let mut value = sampled(textured.sampled);
    value["replaces"] = textured.replaces.into();
    value
}

fn blend(blend: Blend) -> Value {
    let state =
        |state: State| json!({ "equation": state.equation.name(), "src": state.src.name(), "dst": state.dst.name() });
    json!({ "color": state(blend.state.color), "alpha": state(blend.state.alpha), "constant": blend.constant })
}
