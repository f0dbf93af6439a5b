//! The camera and the image.

use crate::target::TargetFormat;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The image's size and format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Target {
    /// Pixels, 1 to 8192.
    pub width: u32,
    /// Pixels, 1 to 8192.
    pub height: u32,
    /// How a pixel is stored.
    pub format: TargetFormat,
}

impl Default for Target {
    fn default() -> Self {
        Self { width: 512, height: 512, format: TargetFormat::default() }
    }
}

/// Where the scene is seen from. The world is right-handed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Where the eye is.
    pub eye: [f64; 3],
    /// What it looks at.
    #[serde(default)]
    pub center: [f64; 3],
    /// Which way is up in the image.
    #[serde(default = "y")]
    pub up: [f64; 3],
    /// How eye space becomes an image.
    pub projection: Projection,
    /// Whether depth runs from 1 at the near plane to 0 at the far one, rather than from 0 to 1.
    #[serde(default)]
    pub reversed_depth: bool,
}

fn y() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

/// How eye space becomes an image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Projection {
    /// What is farther away is smaller.
    Perspective {
        /// The vertical field of view in degrees, above 0 and below 180.
        fov_y_deg: f64,
        /// The distance of the near plane, above 0.
        near: f64,
        /// The distance of the far plane, above `near`.
        far: f64,
    },
    /// What is farther away has the same size.
    Orthographic {
        /// The height of what is seen, in units.
        height: f64,
        /// The distance of the near plane, above 0.
        near: f64,
        /// The distance of the far plane, above `near`.
        far: f64,
    },
}
