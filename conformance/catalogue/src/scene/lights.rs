//! Lights in eye space, and fog.

use super::field::{At, SceneError, one_of};
use glam::{DMat4, DVec3};
use lightmeter_scene::frame::{Fog, FogForm, Light, MOST_LIGHTS, Place};
use lightmeter_scene::model::{self, FogFactor, LightKind};

/// The lights. `space` gives the matrix to eye space of what a light is attached to.
pub(super) fn lights(
    lights: &[model::Light],
    space: &dyn Fn(&At<'_>, &str) -> Result<DMat4, SceneError>,
) -> Result<Vec<Light>, SceneError> {
    let at = At::Scene.field("lights");
    let most = format!("{MOST_LIGHTS} lights at most");
    at.require(lights.len() <= MOST_LIGHTS, format_args!("a list of {}", lights.len()), &most)?;
    lights.iter().enumerate().map(|(place, light)| one(&at.item(place), place, light, space)).collect()
}

fn one(
    at: &At<'_>,
    place: usize,
    light: &model::Light,
    space: &dyn Fn(&At<'_>, &str) -> Result<DMat4, SceneError>,
) -> Result<Light, SceneError> {
    let color = at.field("color").numbers(light.color)?;
    let or_color = |name, own: Option<[f64; 3]>| own.map_or(Ok(color), |own| at.field(name).numbers(own));
    only_its_own(at, light)?;
    let to_eye = space(&at.field("attached"), &light.attached)?;
    Ok(Light {
        name: light.name.clone().unwrap_or_else(|| format!("light {place}")),
        ambient: at.field("ambient").numbers(light.ambient)?,
        diffuse: or_color("diffuse", light.diffuse)?,
        specular: or_color("specular", light.specular)?,
        place: match light.kind {
            LightKind::Directional => directional(at, light, to_eye)?,
            LightKind::Point => {
                Place::Point { position: position(at, light, to_eye)?, falloff: falloff(at, light.falloff)? }
            }
            LightKind::Spot => spot(at, light, to_eye)?,
        },
    })
}

/// A field that a kind of light has no use for is a mistake.
fn only_its_own(at: &At<'_>, light: &model::Light) -> Result<(), SceneError> {
    let (directional, spot) = (light.kind == LightKind::Directional, light.kind == LightKind::Spot);
    let fields = [
        ("travel", light.travel.is_some(), directional),
        ("toward", light.toward.is_some(), directional),
        ("unit", light.unit, directional),
        ("position", light.position.is_some(), !directional),
        ("falloff", light.falloff.is_some(), !directional),
        ("axis", light.axis.is_some(), spot),
        ("cutoff_deg", light.cutoff_deg.is_some(), spot),
        ("exponent", light.exponent.is_some(), spot),
    ];
    let own: Vec<&str> = fields.iter().filter(|(_, _, own)| *own).map(|(name, ..)| *name).collect();
    match fields.into_iter().find(|(_, given, own)| *given && !*own) {
        Some((name, ..)) => Err(at.field(name).refuse("is not of this kind of light", one_of(&own))),
        None => Ok(()),
    }
}

fn directional(at: &At<'_>, light: &model::Light, to_eye: DMat4) -> Result<Place, SceneError> {
    let toward = match (light.travel, light.toward) {
        (Some(travel), None) => -in_eye_space(&at.field("travel"), travel, to_eye)?,
        (None, Some(toward)) => in_eye_space(&at.field("toward"), toward, to_eye)?,
        (None, None) => return Err(at.field("toward").refuse("is missing", "`toward` or `travel`, a direction")),
        (Some(_), Some(_)) => return Err(at.field("travel").refuse("stands beside `toward`", "one of the two")),
    };
    let toward = at.direction(toward.into())?;
    Ok(Place::Directional { toward, unit: light.unit })
}

fn spot(at: &At<'_>, light: &model::Light, to_eye: DMat4) -> Result<Place, SceneError> {
    let axis = in_eye_space(&at.field("axis"), needed(at, "axis", light.axis)?, to_eye)?;
    let cutoff_deg = needed(at, "cutoff_deg", light.cutoff_deg)?;
    let is_angle = cutoff_deg > 0.0 && cutoff_deg <= 90.0;
    at.field("cutoff_deg").require(is_angle, cutoff_deg, "an angle above 0 and up to 90 degrees")?;
    Ok(Place::Spot {
        position: position(at, light, to_eye)?,
        falloff: falloff(at, light.falloff)?,
        axis: at.field("axis").direction(axis.into())?,
        cutoff_cosine: at.number(cutoff_deg.to_radians().cos())?,
        exponent: at.field("exponent").not_negative(light.exponent.unwrap_or(0.0))?,
    })
}

fn in_eye_space(at: &At<'_>, direction: [f64; 3], to_eye: DMat4) -> Result<DVec3, SceneError> {
    at.direction(direction)?;
    Ok(to_eye.transform_vector3(direction.into()))
}

fn position(at: &At<'_>, light: &model::Light, to_eye: DMat4) -> Result<[f32; 3], SceneError> {
    let position = needed(at, "position", light.position)?;
    let at = at.field("position");
    at.numbers(position)?;
    at.numbers(to_eye.transform_point3(position.into()).into())
}

fn falloff(at: &At<'_>, falloff: Option<[f64; 3]>) -> Result<[f32; 3], SceneError> {
    let at = at.field("falloff");
    let mut nearest = [0.0; 3];
    for (place, k) in falloff.unwrap_or([1.0, 0.0, 0.0]).into_iter().enumerate() {
        nearest[place] = at.item(place).not_negative(k)?;
    }
    at.require(nearest.iter().any(|&k| k > 0.0), "[0, 0, 0]", "kc, kl and kq, not all 0")?;
    Ok(nearest)
}

fn needed<T>(at: &At<'_>, name: &str, given: Option<T>) -> Result<T, SceneError> {
    given.ok_or_else(|| at.field(name).refuse("is missing", "it, for this kind of light"))
}

/// The fog.
pub(super) fn fog(fog: &model::Fog) -> Result<Fog, SceneError> {
    let at = At::Scene.field("fog");
    let factor = at.field("factor");
    let density = |form: &str, density| factor.field(form).field("density").not_negative(density);
    Ok(Fog {
        color: at.field("color").numbers(fog.color)?,
        form: match fog.factor {
            FogFactor::Linear { dmin, dmax } => {
                let at = factor.field("linear");
                FogForm::Linear { dmin: at.field("dmin").number(dmin)?, dmax: at.field("dmax").number(dmax)? }
            }
            FogFactor::Exp { density: of } => FogForm::Exp { density: density("exp", of)? },
            FogFactor::Exp2Document { density: of } => FogForm::Exp2Document { density: density("exp2-document", of)? },
            FogFactor::Exp2OpenGl { density: of } => FogForm::Exp2OpenGl { density: density("exp2-opengl", of)? },
        },
        distance: fog.distance,
    })
}
