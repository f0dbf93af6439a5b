//! A scene as a renderer is asked for it: `lightmeter.frame/1`. Files are read, lights stand in eye space, matrices are multiplied, draws are in their
//! order. Numbers are f32, widened. The words are those of scene files.

use crate::{Document, ReadError, Word};
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.frame/1";

/// Everything that an image is made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameDocument {
    /// `lightmeter.frame/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The scene's id.
    pub id: String,
    /// What it is called.
    pub title: String,
    /// What is drawn to.
    pub target: FrameTarget,
    /// The colour where nothing is drawn.
    pub background: [f32; 4],
    /// The depth where nothing is drawn: 1, or 0 with reversed depth.
    pub clear_depth: f32,
    /// Eye space to clip space, whose depth is from 0 to 1; columns.
    pub projection: [[f32; 4]; 4],
    /// Light that is everywhere.
    pub ambient: [f32; 3],
    /// What it does to a material: `product` or `constant`.
    pub ambient_form: Word,
    /// What distance and cones do to the lights' own ambient terms: nothing (`documents`), or they weaken them (`opengl`).
    pub light_ambient: Word,
    /// The lights.
    pub lights: Vec<FrameLight>,
    /// The fog, if any.
    pub fog: Option<FrameFog>,
    /// The meshes that draws name by number.
    pub meshes: Vec<FrameMesh>,
    /// The textures that draws name by number.
    pub textures: Vec<FrameTexture>,
    /// What is drawn, in this order.
    pub draws: Vec<FrameDraw>,
    /// The effects that any draw calls for.
    pub effects: Vec<Word>,
}

/// What is drawn to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FrameTarget {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// How a pixel is stored: `rgba8unorm` and so on.
    pub format: Word,
}

/// A light in eye space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameLight {
    /// What it is called.
    pub name: String,
    /// LA.
    pub ambient: [f32; 3],
    /// LD.
    pub diffuse: [f32; 3],
    /// LS.
    pub specular: [f32; 3],
    /// Where it is.
    pub place: LightPlace,
}

/// Where a light is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum LightPlace {
    /// Infinitely far away.
    Directional {
        /// From the surface to the light.
        toward: [f32; 3],
        /// Whether that is taken as a unit vector and not normalised.
        unit: bool,
    },
    /// At a point.
    Point {
        /// In eye space.
        position: [f32; 3],
        /// kc, kl, kq.
        falloff: [f32; 3],
    },
    /// At a point, within a cone.
    Spot {
        /// In eye space.
        position: [f32; 3],
        /// kc, kl, kq.
        falloff: [f32; 3],
        /// The direction of the cone's middle, of any length but 0.
        axis: [f32; 3],
        /// The cosine of the cone's half angle.
        cutoff_cosine: f32,
        /// The power of the cosine from the axis that the light falls by; 0 for an evenly lit cone.
        exponent: f32,
    },
}

/// Fog.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameFog {
    /// Its colour.
    pub color: [f32; 3],
    /// Its factor.
    pub form: FrameFogForm,
    /// Of which distance: `planar` or `radial`.
    pub distance: Word,
}

/// The factor of a fog.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind")]
pub enum FrameFogForm {
    /// (dmax − distance)/(dmax − dmin)
    #[serde(rename = "linear")]
    Linear {
        /// Where it begins.
        dmin: f32,
        /// Where nothing else is seen.
        dmax: f32,
    },
    /// exp(−density·distance)
    #[serde(rename = "exp")]
    Exp {
        /// 1/unit.
        density: f32,
    },
    /// exp(−density·distance²)
    #[serde(rename = "exp2-document")]
    Exp2Document {
        /// 1/unit².
        density: f32,
    },
    /// exp(−(density·distance)²)
    #[serde(rename = "exp2-opengl")]
    Exp2OpenGl {
        /// 1/unit.
        density: f32,
    },
}

/// Triangles. Attributes that a mesh lacks are empty; the others have one entry a vertex.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameMesh {
    /// Object space.
    pub positions: Vec<[f32; 3]>,
    /// Object space, of any length.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, which run right and down from the image's upper left corner.
    pub uvs: Vec<[f32; 2]>,
    /// Texture coordinates of the lightmap.
    pub lightmap_uvs: Vec<[f32; 2]>,
    /// Colours with alpha.
    pub colors: Vec<[f32; 4]>,
    /// Three vertices each, counter-clockwise as seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// An image that is read by texture coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameTexture {
    /// Texels.
    pub width: u32,
    /// Texels.
    pub height: u32,
    /// Row after row from the top.
    pub texels: Vec<[f32; 4]>,
}

/// A mesh with everything that its drawing needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameDraw {
    /// What it is called.
    pub name: String,
    /// Its place among the meshes.
    pub mesh: usize,
    /// Object space to eye space; columns.
    pub modelview: [[f32; 4]; 4],
    /// What its surface does with light.
    pub material: FrameMaterial,
    /// How it is lit; none for the material's diffuse colour as it is.
    pub shading: Option<FrameShading>,
    /// The alpha of its colour before texture and vertex colours.
    pub alpha: f32,
    /// Whether the colour is multiplied by the vertices' own.
    pub vertex_colors: bool,
    /// The texture.
    pub texture: Option<FrameTextured>,
    /// The lightmap, which multiplies, read at the lightmap's texture coordinates.
    pub lightmap: Option<FrameSampled>,
    /// Fragments whose alpha is below are not drawn.
    pub cutout: Option<f32>,
    /// How it is blended; none for not at all.
    pub blend: Option<FrameBlend>,
    /// The depth test; none for none.
    pub depth: Option<FrameDepth>,
    /// Which faces are not drawn: `none`, `back` or `front`.
    pub cull: Word,
}

/// What a surface does with light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameMaterial {
    /// CE.
    pub emissive: [f32; 3],
    /// MA.
    pub ambient: [f32; 3],
    /// MD.
    pub diffuse: [f32; 3],
    /// MS.
    pub specular: [f32; 3],
    /// The exponent of the highlight.
    pub shininess: f32,
}

/// How a surface is lit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FrameShading {
    /// Where: `flat`, `gouraud` or `phong`.
    pub frequency: Word,
    /// The vertex that gives a flat face its colour: `first` or `last`.
    pub provoking: Word,
    /// The highlight: `phong`, `blinn` or `blinn-unnormalised`.
    pub specular: Word,
    /// Whether a face that is turned away may have one (`documents`) or not (`opengl`).
    pub gate: Word,
    /// The viewer: `local` or `non-local`.
    pub viewer: Word,
    /// The normals: by the `inverse-transpose` of the modelview or by the `modelview` itself.
    pub normals: Word,
}

/// How a texture is read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FrameSampled {
    /// Its place among the textures.
    pub texture: usize,
    /// Between texels: `nearest` or `bilinear`.
    pub filter: Word,
    /// Beyond its edges: `repeat` or `clamp`.
    pub wrap: Word,
}

/// A texture in use.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FrameTextured {
    /// How it is read.
    #[serde(flatten)]
    pub sampled: FrameSampled,
    /// Whether it stands in place of the colour, rather than multiplying it.
    pub replaces: bool,
}

/// A blend state with its constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameBlend {
    /// Of red, green and blue.
    pub color: BlendWords,
    /// Of alpha.
    pub alpha: BlendWords,
    /// Cc, Ac.
    pub constant: [f32; 4],
}

/// An equation with its factors.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct BlendWords {
    /// `add`, `subtract`, `reverse-subtract`, `min` or `max`.
    pub equation: Word,
    /// The source's factor.
    pub src: Word,
    /// The destination's factor.
    pub dst: Word,
}

/// A depth test.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FrameDepth {
    /// When a fragment passes: `less`, `less-equal` and so on.
    pub compare: Word,
    /// Whether the depth of one that passes is kept.
    pub write: bool,
}

impl Document for FrameDocument {
    const SCHEMA: &'static str = SCHEMA;
    const WHAT: &'static str = "a scene as a renderer is asked for it";

    /// On one line, each f32 widened to the f64 that has its value: a reader that keeps f64 reads the number that was meant.
    fn to_json(&self) -> serde_json::Result<String> {
        Ok(format!("{}\n", serde_json::to_value(self)?))
    }

    fn read(json: &str) -> Result<Self, ReadError> {
        crate::read(json)
    }

    fn schema() -> Schema {
        crate::schema::<Self>()
    }
}
