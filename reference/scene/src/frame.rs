//! One frame to be drawn: a scene with everything resolved, which is what renderers take.
//!
//! Files are read, lights stand in eye space, matrices are multiplied, draws are in their order. Every number is an f32 that
//! both sides of a comparison see alike. Matrices are columns. Eye space is right-handed, looking down −z; clip space is
//! WebGPU's, with depth from 0 to 1; texture coordinates run right and down from the image's upper left corner.

use crate::blend::Separate;
use crate::depth::DepthTest;
use crate::raster::Provoking;
use crate::shading::{Ambient, Distance, Frequency, LightAmbient, Normals, Specular, SpecularGate, Viewer};
use crate::target::TargetFormat;
use crate::words::words;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A 4 × 4 matrix of columns.
pub type Matrix = [[f32; 4]; 4];

/// Lights of one frame, at most.
pub const MOST_LIGHTS: usize = 64;

/// Everything that an image is made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Frame {
    /// What is drawn to.
    pub target: Target,
    /// The colour where nothing is drawn.
    pub background: [f32; 4],
    /// The depth where nothing is drawn: 1, or 0 with reversed depth.
    pub clear_depth: f32,
    /// Eye → clip.
    pub projection: Matrix,
    /// Light that is everywhere.
    pub ambient: [f32; 3],
    /// What it does to a material.
    pub ambient_form: Ambient,
    /// What attenuation does to the lights' own ambient terms.
    pub light_ambient: LightAmbient,
    /// The lights.
    pub lights: Vec<Light>,
    /// The fog, if any.
    pub fog: Option<Fog>,
    /// The meshes that draws name by number.
    pub meshes: Vec<Mesh>,
    /// The textures that draws name by number.
    pub textures: Vec<Texture>,
    /// What is drawn, in this order.
    pub draws: Vec<Draw>,
    /// What is drawn otherwise than any scene asks for.
    #[serde(skip)]
    pub departures: Departures,
}

/// What some renderers draw that no scene asks for: mistakes, to be tried as explanations of an image. A scene has none, and the
/// GPU's shaders know none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Departures {
    /// The highlight is Blinn's normalised lobe with Schlick's Fresnel term, times n·l.
    pub fresnel_highlight: bool,
    /// Linear fog follows smoothstep.
    pub smoothstep_fog: bool,
    /// Normals keep the length that the modelview leaves them, until a fragment normalises them.
    pub normals_at_length: bool,
    /// Interpolated normals are not normalised again.
    pub fragment_normals_at_length: bool,
    /// Normals are turned towards the eye.
    pub two_sided: bool,
    /// The diffuse term is half-Lambert: `(0.5 n·l + 0.5)²`, of Valve's Half-Life.
    pub half_lambert: bool,
    /// Textures and lightmaps multiply what is diffuse, and the highlight is added afterwards.
    pub highlight_over_texture: bool,
    /// What is lit at the vertices is limited to 1 there, before it is interpolated.
    pub clamped_vertices: bool,
    /// What is lit is held above 0, before it is interpolated or a texture multiplies it.
    pub lit_at_least_0: bool,
    /// A spotlight's axis keeps its length.
    pub axis_at_length: bool,
    /// Fog mixes alpha with 1, as it mixes colours with the fog's.
    pub fogged_alpha: bool,
    /// A nearest texel is found by truncation: below 0 it is the next one.
    pub truncated_texels: bool,
    /// What a cutout is to keep is cut out, and the reverse.
    pub cutout_turned: bool,
    /// Texture coordinates count by their magnitude.
    pub texture_magnitudes: bool,
}

/// An image's size and format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Target {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// How a pixel is stored.
    pub format: TargetFormat,
}

/// A light in eye space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Light {
    /// What it is called.
    pub name: String,
    /// LA.
    pub ambient: [f32; 3],
    /// LD.
    pub diffuse: [f32; 3],
    /// LS.
    pub specular: [f32; 3],
    /// Where it is.
    pub place: Place,
}

/// Where a light is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Place {
    /// Infinitely far away.
    Directional {
        /// Surface → light.
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
        /// How brightness falls from the middle: the power of a cosine; 0 for an evenly lit cone.
        exponent: f32,
    },
}

/// Fog.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Fog {
    /// Its colour.
    pub color: [f32; 3],
    /// Its factor.
    pub form: FogForm,
    /// Of which distance.
    pub distance: Distance,
}

/// The factor of a fog.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum FogForm {
    /// (dmax − distance)/(dmax − dmin)
    Linear {
        /// Where it begins.
        dmin: f32,
        /// Where nothing else is seen.
        dmax: f32,
    },
    /// exp(−density·distance)
    Exp {
        /// 1/unit.
        density: f32,
    },
    /// exp(−density·distance²)
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
pub struct Mesh {
    /// Object space.
    pub positions: Vec<[f32; 3]>,
    /// Object space, of any length.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates.
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
pub struct Texture {
    /// Texels.
    pub width: u32,
    /// Texels.
    pub height: u32,
    /// Row after row from the top.
    pub texels: Vec<[f32; 4]>,
}

/// A mesh with everything that its drawing needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Draw {
    /// What it is called.
    pub name: String,
    /// Its place among the meshes.
    pub mesh: usize,
    /// Object → eye.
    pub modelview: Matrix,
    /// What its surface does with light.
    pub material: Material,
    /// How it is lit; `None` for the material's diffuse colour as it is.
    pub shading: Option<Shading>,
    /// The alpha of its colour before texture and vertex colours.
    pub alpha: f32,
    /// Whether the colour is multiplied by the vertices' own.
    pub vertex_colors: bool,
    /// The texture, read at the texture coordinates.
    pub texture: Option<Textured>,
    /// The lightmap, which multiplies, read at the lightmap's texture coordinates.
    pub lightmap: Option<Sampled>,
    /// Fragments whose alpha is below are not drawn.
    pub cutout: Option<f32>,
    /// How it is blended; `None` for not at all.
    pub blend: Option<Blend>,
    /// The depth test; `None` for none.
    pub depth: Option<DepthTest>,
    /// Which faces are not drawn.
    pub cull: Cull,
}

/// What a surface does with light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Material {
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Shading {
    /// Where.
    pub frequency: Frequency,
    /// The vertex that gives a face its colour, with [`Frequency::Flat`].
    pub provoking: Provoking,
    /// The highlight.
    pub specular: Specular,
    /// Whether a face that is turned away may have one.
    pub gate: SpecularGate,
    /// The viewer.
    pub viewer: Viewer,
    /// The normals.
    pub normals: Normals,
}

/// A texture in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Textured {
    /// How it is read.
    #[serde(flatten)]
    pub sampled: Sampled,
    /// Whether it stands in place of the colour, rather than multiplying it.
    pub replaces: bool,
}

/// How a texture is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Sampled {
    /// Its place among the textures.
    pub texture: usize,
    /// Between texels.
    pub filter: TextureFilter,
    /// Beyond its edges.
    pub wrap: Wrap,
}

words! {
    /// What is read between the middles of texels.
    #[derive(Default)]
    pub enum TextureFilter {
        /// The texel that the coordinates lie in.
        Nearest = "nearest",
        /// The four around, mixed by their distances.
        #[default]
        Bilinear = "bilinear",
    }
}

words! {
    /// What is read beyond a texture's edges.
    #[derive(Default)]
    pub enum Wrap {
        /// The texture again.
        #[default]
        Repeat = "repeat",
        /// The texel at the edge.
        Clamp = "clamp",
    }
}

/// A blend state with its constant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Blend {
    /// Factors and equations.
    #[serde(flatten)]
    pub state: Separate,
    /// Cc, Ac.
    pub constant: [f32; 4],
}

words! {
    /// Which faces are not drawn. The front is counter-clockwise as seen.
    #[derive(Default)]
    pub enum Cull {
        /// All are drawn.
        #[default]
        None = "none",
        /// Back faces.
        Back = "back",
        /// Front faces.
        Front = "front",
    }
}
