//! How a surface is shaded: where it is lit, which highlight it has, and which dialect of the documents is meant.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where a surface is lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Frequency {
    /// Once a face: the colour lit at the provoking vertex.
    Flat,
    /// At the vertices; the colour is interpolated.
    Gouraud,
    /// At every fragment, with position and normal interpolated and the normal normalised again.
    Phong,
}

/// Which cosine the highlight is a power of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Specular {
    /// r·v.
    Phong,
    /// n·h.
    Blinn,
    /// n·(v + l), the halfway vector left unnormalised: a dialect of document 000.
    BlinnUnnormalised,
}

/// Whether a surface that faces away from the light can have a highlight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpecularGate {
    /// It can: what the documents write.
    Documents,
    /// It cannot: the highlight is 0 where n·l ≤ 0, as OpenGL's fixed function has it.
    OpenGl,
}

/// Where the viewer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Viewer {
    /// At the eye: v = ⟨−p⟩.
    Local,
    /// Infinitely far away: v = (0, 0, 1).
    NonLocal,
}

/// How a normal is brought to eye space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Normals {
    /// By the inverse transpose of the modelview.
    InverseTranspose,
    /// By the modelview itself, right for rigid motion and uniform scale alone: a dialect of documents 000 and 003.
    Modelview,
}

/// How ambient light and material go together. Ruling 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ambient {
    /// CA = LA * MA.
    Product,
    /// CA is a constant that nothing multiplies.
    Constant,
}

/// Whether attenuation and a spotlight's cone weaken a light's ambient term too. Ruling 11.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightAmbient {
    /// They do not.
    Documents,
    /// They do.
    OpenGl,
}

/// Which length the fog's factor is taken of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Distance {
    /// |z|: the depth of the point. The document's.
    Planar,
    /// |p|: the distance from the eye. A dialect.
    Radial,
}
