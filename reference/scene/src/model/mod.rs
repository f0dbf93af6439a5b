//! The authored scene: what a person writes as JSON, before anything is resolved.
//!
//! Names refer to textures, materials, meshes and objects of the same scene; what is left out has a default. The schema
//! that `lightmeter schema scene` prints is derived from these types, and their comments are its descriptions. Loading
//! turns a scene into a [`Frame`](crate::frame::Frame).

mod camera;
mod choice;
mod light;
mod named;
mod object;
mod shape;
mod surface;

pub use camera::{Camera, Projection, Target};
pub use choice::{Alpha, Frequency, Highlight, LightKind, NormalsFrom, Order, TextureMode};
pub use light::{AmbientLight, Fog, FogFactor, Light};
pub use named::Named;
pub use object::{Blend, Depth, DepthTest, Object, Shading, TransformStep};
pub use shape::{Mesh, Shape};
pub use surface::{Material, Reading, TextureImage};

use crate::shading::LightAmbient;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scene of lightmeter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// A short title.
    pub title: String,
    /// What is to be seen, in one sentence, and the document that it comes from.
    pub shows: String,
    /// The image's size and format.
    #[serde(default)]
    pub target: Target,
    /// The colour where nothing is drawn: red, green, blue, alpha.
    #[serde(default = "opaque_black")]
    pub background: [f64; 4],
    /// Where the scene is seen from.
    pub camera: Camera,
    /// Light that is everywhere.
    #[serde(default)]
    pub ambient: AmbientLight,
    /// Whether attenuation and a spotlight's cone weaken a light's ambient term too (ruling 11).
    #[serde(default)]
    pub light_ambient: LightAmbient,
    /// The lights, 64 at most.
    #[serde(default)]
    pub lights: Vec<Light>,
    /// The fog, if any.
    #[serde(default)]
    pub fog: Option<Fog>,
    /// Images that materials read, by name.
    #[serde(default)]
    pub textures: Named<TextureImage>,
    /// What surfaces do with light, by name.
    #[serde(default)]
    pub materials: Named<Material>,
    /// Triangles, by name.
    #[serde(default)]
    pub meshes: Named<Mesh>,
    /// How objects are shaded that do not say otherwise.
    #[serde(default)]
    pub shading: Shading,
    /// What is drawn.
    pub objects: Vec<Object>,
    /// In which order objects are drawn.
    #[serde(default)]
    pub order: Order,
}

fn opaque_black() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}
