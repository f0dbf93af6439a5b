//! Images and materials.

use super::{Highlight, TextureMode};
use crate::frame::{TextureFilter, Wrap};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An image of up to 2048 × 2048 texels. Texture coordinates run right and down from its upper left corner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum TextureImage {
    /// A PNG, its path relative to the scene. A byte b stands for b/255, whatever the file says of colour spaces.
    File(String),
    /// Texels, row after row from the top: red, green, blue, alpha.
    Texels(Vec<Vec<[f64; 4]>>),
    /// Squares of two colours in turn, one texel each.
    Checker {
        /// Texels across and down.
        size: [u32; 2],
        /// The colour in the upper left corner, and the other.
        colors: [[f64; 4]; 2],
    },
    /// A mixture of four colours.
    Gradient {
        /// Texels across and down.
        size: [u32; 2],
        /// The colours of the upper left, upper right, lower left and lower right texel.
        corners: [[f64; 4]; 4],
    },
    /// A colour in the middle that fades to another at the edge.
    Radial {
        /// Texels across and down.
        size: u32,
        /// In the middle.
        inner: [f64; 4],
        /// From the middle of each edge outward.
        outer: [f64; 4],
    },
}

/// How an image is read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reading {
    /// The name of one of the textures.
    pub image: String,
    /// Between texels.
    #[serde(default)]
    pub filter: TextureFilter,
    /// Beyond its edges.
    #[serde(default)]
    pub wrap: Wrap,
    /// What it does to the colour; a lightmap always multiplies.
    #[serde(default)]
    pub mode: TextureMode,
}

/// What a surface does with light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// The surface's colour: of what `ka`, `kd` and a metal's `ks` multiply.
    pub color: [f64; 3],
    /// Document 003's scalar: MA = ka times the colour. 1 if left out.
    pub ka: Option<f64>,
    /// Document 003's scalar: MD = kd times the colour. 1 if left out.
    pub kd: Option<f64>,
    /// Document 003's scalar: MS = ks, or ks times the colour for a metal. 0 if left out.
    pub ks: Option<f64>,
    /// What colours the highlight of `ks`.
    pub highlight: Option<Highlight>,
    /// CE, light that the surface gives by itself.
    pub emissive: [f64; 3],
    /// MA, in place of `ka`.
    pub ambient: Option<[f64; 3]>,
    /// MD, in place of `kd`.
    pub diffuse: Option<[f64; 3]>,
    /// MS, in place of `ks`.
    pub specular: Option<[f64; 3]>,
    /// The exponent of the highlight, 0 or above.
    pub shininess: f64,
    /// Alpha, 0 to 1.
    pub opacity: f64,
    /// An image that multiplies the colour or takes its place.
    pub texture: Option<Reading>,
    /// An image that multiplies what the texture gives, read at coordinates of its own where the mesh has them (002).
    pub lightmap: Option<Reading>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            color: [1.0; 3],
            ka: None,
            kd: None,
            ks: None,
            highlight: None,
            emissive: [0.0; 3],
            ambient: None,
            diffuse: None,
            specular: None,
            shininess: 32.0,
            opacity: 1.0,
            texture: None,
            lightmap: None,
        }
    }
}
