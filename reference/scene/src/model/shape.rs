//! Meshes: triangles as they are written, read from a file, or generated.

use super::NormalsFrom;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Triangles, up to 1,000,000 of them and as many vertices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// What they make.
    pub shape: Shape,
    /// Where their normals are from.
    #[serde(default)]
    pub normals: NormalsFrom,
}

/// What the triangles of a mesh make. Generated shapes have normals and texture coordinates, and their fronts outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// What is written.
    Triangles {
        /// Where the vertices are.
        positions: Vec<[f64; 3]>,
        /// Normals of any length but 0; none, or one a vertex.
        #[serde(default)]
        normals: Vec<[f64; 3]>,
        /// Texture coordinates, right and down from the upper left; none, or one a vertex.
        #[serde(default)]
        uvs: Vec<[f64; 2]>,
        /// Texture coordinates of the lightmap; none, or one a vertex.
        #[serde(default)]
        lightmap_uvs: Vec<[f64; 2]>,
        /// Colours: red, green, blue, alpha; none, or one a vertex.
        #[serde(default)]
        colors: Vec<[f64; 4]>,
        /// Three vertices each, counter-clockwise as seen from the front.
        triangles: Vec<[u32; 3]>,
    },
    /// A Wavefront OBJ, its path relative to the scene. Its materials are those of its MTL, unless the object has one.
    Obj(String),
    /// A rectangle in the plane z = 0 about the origin, its front toward +z.
    Quad {
        /// Along x and y.
        #[serde(default = "two_by_two")]
        size: [f64; 2],
        /// Parts along x and y.
        #[serde(default = "one_by_one")]
        steps: [u32; 2],
        /// How often the texture repeats along x and y.
        #[serde(default = "once")]
        repeat: [f64; 2],
    },
    /// A rectangle in the plane y = 0 about the origin, its front toward +y.
    Plane {
        /// Along x and z.
        #[serde(default = "two_by_two")]
        size: [f64; 2],
        /// Parts along x and z.
        #[serde(default = "one_by_one")]
        steps: [u32; 2],
        /// How often the texture repeats along x and z.
        #[serde(default = "once")]
        repeat: [f64; 2],
    },
    /// A cube about the origin. Each corner's colour is that of the RGB cube: (0, 0, 0) at −x −y −z, (1, 1, 1) at +x +y
    /// +z.
    Cube {
        /// The length of an edge.
        #[serde(default = "two")]
        size: f64,
        /// Parts of an edge.
        #[serde(default = "one")]
        steps: u32,
    },
    /// A ball about the origin, its poles on the y axis.
    Sphere {
        /// Its radius.
        #[serde(default = "unit")]
        radius: f64,
        /// Parts from pole to pole.
        #[serde(default = "rings")]
        rings: u32,
        /// Parts around.
        #[serde(default = "segments")]
        segments: u32,
    },
    /// A disc in the plane z = 0 about the origin, its front toward +z.
    Disc {
        /// Its radius.
        #[serde(default = "unit")]
        radius: f64,
        /// Parts around.
        #[serde(default = "segments")]
        segments: u32,
    },
    /// A cylinder about the y axis, with its ends.
    Cylinder {
        /// Its radius.
        #[serde(default = "unit")]
        radius: f64,
        /// Its height, half of it below the origin.
        #[serde(default = "two")]
        height: f64,
        /// Parts around.
        #[serde(default = "segments")]
        segments: u32,
    },
    /// A ring about the y axis.
    Torus {
        /// From the middle of the ring to the middle of the tube.
        #[serde(default = "unit")]
        radius: f64,
        /// The tube's radius.
        #[serde(default = "tube")]
        tube: f64,
        /// Parts around the tube.
        #[serde(default = "rings")]
        rings: u32,
        /// Parts around the ring.
        #[serde(default = "segments")]
        segments: u32,
    },
    /// Martin Newell's teapot of 32 patches, 3.15 high on the plane y = 0, its spout toward +x.
    Teapot {
        /// Parts along each side of a patch.
        #[serde(default = "steps")]
        steps: u32,
    },
}

fn two_by_two() -> [f64; 2] {
    [2.0; 2]
}

fn one_by_one() -> [u32; 2] {
    [1; 2]
}

fn once() -> [f64; 2] {
    [1.0; 2]
}

fn one() -> u32 {
    1
}

fn unit() -> f64 {
    1.0
}

fn two() -> f64 {
    2.0
}

fn tube() -> f64 {
    0.4
}

fn rings() -> u32 {
    24
}

fn segments() -> u32 {
    48
}

fn steps() -> u32 {
    8
}
