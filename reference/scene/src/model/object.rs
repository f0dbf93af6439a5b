//! What is drawn, and how.

use super::{Alpha, Frequency};
use crate::depth::Compare;
use crate::frame::Cull;
use crate::raster::Provoking;
use crate::shading::{Normals, Specular, SpecularGate, Viewer};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A mesh that is drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// What it is called; its mesh's name if left out. Lights may be attached to it.
    #[serde(default)]
    pub name: Option<String>,
    /// The name of a mesh.
    pub mesh: String,
    /// The name of a material; without it the mesh's own, or a white one.
    #[serde(default)]
    pub material: Option<String>,
    /// Object → world: steps that are applied one after the other, the first first.
    #[serde(default)]
    pub transform: Vec<TransformStep>,
    /// Draws the object once for each, which is applied after `transform`.
    #[serde(default)]
    pub instances: Option<Vec<Vec<TransformStep>>>,
    /// How it is shaded; what is left out is the scene's.
    #[serde(default)]
    pub shading: Shading,
    /// Whether the mesh's colours multiply the colour.
    #[serde(default)]
    pub vertex_colors: bool,
    /// Fragments whose alpha is below are not drawn, 0 to 1.
    #[serde(default)]
    pub cutout: Option<f64>,
    /// How it is blended; not at all if left out.
    #[serde(default)]
    pub blend: Option<Blend>,
    /// The depth test. If left out, `less` with writing; blended objects `less-equal` without. With reversed depth
    /// `greater` and `greater-equal`.
    #[serde(default)]
    pub depth: Option<Depth>,
    /// Which faces are not drawn.
    #[serde(default)]
    pub cull: Cull,
}

/// A step of a transform.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum TransformStep {
    /// By this much.
    Translate([f64; 3]),
    /// Counter-clockwise about an axis through the origin that points at whoever looks.
    Rotate {
        /// The angle in degrees.
        deg: f64,
        /// The axis, of any length but 0.
        axis: [f64; 3],
    },
    /// Along x, y and z.
    Scale([f64; 3]),
    /// A matrix of four columns, the last row (0, 0, 0, 1).
    Matrix([[f64; 4]; 4]),
}

/// How a surface is shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Shading {
    /// Where it is lit; `phong` if left out.
    pub frequency: Option<Frequency>,
    /// The vertex that gives a face its colour; `last` if left out.
    pub provoking: Option<Provoking>,
    /// The highlight; `phong` if left out.
    pub specular: Option<Specular>,
    /// Whether a surface that faces away from a light can have its highlight; `documents`, it can, if left out.
    pub gate: Option<SpecularGate>,
    /// The viewer of highlights; `local` if left out.
    pub viewer: Option<Viewer>,
    /// How normals are brought to eye space; `inverse-transpose` if left out.
    pub normals: Option<Normals>,
    /// The alpha of the colour; the material's if left out.
    pub alpha: Option<Alpha>,
}

/// How an object is blended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Blend {
    /// Of red, green and blue: `solid`, `alpha`, `mul` or `add` (002), `min`, `max`, or equation, source and
    /// destination factor, as `add/src-alpha/one-minus-src-alpha`.
    pub color: String,
    /// Of alpha; as the colour's if left out.
    #[serde(default)]
    pub alpha: Option<String>,
    /// The blend constant: red, green, blue, alpha.
    #[serde(default)]
    pub constant: [f64; 4],
}

/// A depth test, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Depth {
    /// What is drawn last is seen, and leaves no depth.
    None,
    /// Against the depth that is stored.
    Test(DepthTest),
}

/// A depth test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DepthTest {
    /// When a fragment passes.
    pub compare: Compare,
    /// Whether a fragment that passes leaves its depth.
    pub write: bool,
}
