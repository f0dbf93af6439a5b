//! Lights and fog.

use super::LightKind;
use crate::shading::{Ambient, Distance};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Light that is everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct AmbientLight {
    /// Its colour.
    pub color: [f64; 3],
    /// What it does to a material.
    pub form: Ambient,
}

/// A light. Which fields it needs follows from its kind: `travel` or `toward` for a directional light, `position` for
/// the others, `axis` and `cutoff_deg` for a spotlight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// What it is called; `light 0` and so on if left out.
    #[serde(default)]
    pub name: Option<String>,
    /// Where it is.
    pub kind: LightKind,
    /// The colour of its diffuse and specular light, where these do not stand by themselves.
    #[serde(default = "white")]
    pub color: [f64; 3],
    /// LA, its ambient light.
    #[serde(default)]
    pub ambient: [f64; 3],
    /// LD, its diffuse light.
    #[serde(default)]
    pub diffuse: Option<[f64; 3]>,
    /// LS, its specular light.
    #[serde(default)]
    pub specular: Option<[f64; 3]>,
    /// A directional light's direction as the way that light travels (ruling 13, document 000).
    #[serde(default)]
    pub travel: Option<[f64; 3]>,
    /// A directional light's direction as the way from the surface to the light (ruling 13, document 004).
    #[serde(default)]
    pub toward: Option<[f64; 3]>,
    /// Whether a directional light's direction is taken as a unit vector and not normalised.
    #[serde(default)]
    pub unit: bool,
    /// Where a point light or a spotlight is.
    #[serde(default)]
    pub position: Option<[f64; 3]>,
    /// kc, kl, kq of a point light or a spotlight: its light is divided by kc + kl·d + kq·d². (1, 0, 0) if left out.
    #[serde(default)]
    pub falloff: Option<[f64; 3]>,
    /// The direction of the middle of a spotlight's cone.
    #[serde(default)]
    pub axis: Option<[f64; 3]>,
    /// Half the angle of a spotlight's cone in degrees, above 0 and up to 90.
    #[serde(default)]
    pub cutoff_deg: Option<f64>,
    /// How a spotlight's brightness falls from the middle: the power of a cosine. 0, evenly lit, if left out.
    #[serde(default)]
    pub exponent: Option<f64>,
    /// What it moves with: `world`, `camera`, or an object's name. Position and direction are in that space.
    #[serde(default = "world")]
    pub attached: String,
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

fn world() -> String {
    "world".into()
}

/// Fog.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fog {
    /// Its colour.
    pub color: [f64; 3],
    /// Its factor: 1 for no fog, 0 for nothing else, clamped in between.
    pub factor: FogFactor,
    /// Which distance it is of.
    #[serde(default)]
    pub distance: Distance,
}

/// The factor of a fog.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum FogFactor {
    /// (dmax − distance)/(dmax − dmin)
    #[serde(rename = "linear")]
    Linear {
        /// Where it begins.
        dmin: f64,
        /// Where nothing else is seen.
        dmax: f64,
    },
    /// exp(−density·distance)
    #[serde(rename = "exp")]
    Exp {
        /// 1/unit, 0 or above.
        density: f64,
    },
    /// exp(−density·distance²), document 000's form.
    #[serde(rename = "exp2-document")]
    Exp2Document {
        /// 1/unit², 0 or above.
        density: f64,
    },
    /// exp(−(density·distance)²), OpenGL's form.
    #[serde(rename = "exp2-opengl")]
    Exp2OpenGl {
        /// 1/unit, 0 or above.
        density: f64,
    },
}
