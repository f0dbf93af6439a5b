//! Primitive topologies, the vertex that a flat attribute is taken from, and the cases of the rasteriser.

use crate::depth::Compare;
use crate::words::words;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

words! {
    /// How a stream of vertices is read as primitives.
    pub enum Topology {
        /// Every vertex a point.
        Points = "points",
        /// Every two vertices a line.
        LineList = "line-list",
        /// Every vertex after the first a line from the one before it.
        LineStrip = "line-strip",
        /// Every three vertices a triangle.
        TriangleList = "triangle-list",
        /// Every vertex after the second a triangle with the two before it.
        TriangleStrip = "triangle-strip",
    }
}

impl Topology {
    /// Vertices in a primitive.
    #[must_use]
    pub const fn corners(self) -> u32 {
        match self {
            Self::Points => 1,
            Self::LineList | Self::LineStrip => 2,
            Self::TriangleList | Self::TriangleStrip => 3,
        }
    }
}

words! {
    /// The vertex of a primitive whose value a flat attribute takes.
    #[derive(Default)]
    pub enum Provoking {
        /// The first vertex: WebGPU's and Vulkan's convention.
        First = "first",
        /// The last vertex: OpenGL's default.
        #[default]
        Last = "last",
    }
}

/// Width and height in pixels of the target that cases of the rasteriser are drawn on; the viewport is all of it.
pub const TARGET_SIZE: u32 = 256;

/// What a case of the rasteriser draws and looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Raster {
    /// A triangle's attribute, perspective-correct and linear.
    TriangleAttributes,
    /// A triangle's fragment position: x, y, z, 1/w.
    TrianglePosition,
    /// A line's attribute, perspective-correct and linear.
    LineAttributes,
    /// How many of two triangles that share an edge cover the pixel.
    Quad,
    /// The depth that a fragment writes for itself, as it is stored.
    OwnDepth,
    /// Whether the triangle is seen from its front.
    Facing,
    /// Whether the triangle covers the pixel once it is clipped.
    Clipped,
    /// Whether the triangle covers the pixel with this face culled, counter-clockwise triangles or the others being front.
    Culled {
        /// Back faces, or front faces.
        back: bool,
        /// Whether counter-clockwise triangles are front faces.
        front_is_ccw: bool,
    },
    /// Which of two fragments is seen, 1 or 2, where the same triangle is drawn twice, the second time by a depth test.
    SameDepth(Compare),
    /// A flat attribute.
    Flat {
        /// The topology that is drawn.
        topology: Topology,
        /// The vertex that it is taken from.
        provoking: Provoking,
    },
}

impl Raster {
    /// Numbers in a row, the pixel's x and y last.
    #[must_use]
    pub const fn inputs(self) -> usize {
        match self {
            Self::TriangleAttributes
            | Self::TrianglePosition
            | Self::Facing
            | Self::Clipped
            | Self::Culled { .. }
            | Self::SameDepth(_) => 17,
            Self::LineAttributes => 12,
            Self::Quad => 10,
            Self::OwnDepth => 3,
            Self::Flat { .. } => 9,
        }
    }

    /// Numbers that come out.
    #[must_use]
    pub const fn outputs(self) -> usize {
        match self {
            Self::TrianglePosition => 4,
            Self::TriangleAttributes | Self::LineAttributes => 2,
            _ => 1,
        }
    }
}
