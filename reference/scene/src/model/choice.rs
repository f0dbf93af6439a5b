//! What is chosen by a word, each with the resolved value that it stands for.

use crate::frame;
use crate::raster::Provoking;
use crate::shading;
use crate::target::TargetFormat;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

macro_rules! choice {
    (
        $(#[doc = $doc:literal])* $name:ident default $default:ident
        $($(#[doc = $says:literal])* $variant:ident $word:literal)*
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
        pub enum $name {
            $($(#[doc = $says])* #[serde(rename = $word)] $variant,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self::$default
            }
        }
    };
    (
        $(#[doc = $doc:literal])* $name:ident default $default:ident is ($resolved:ty)
        $($(#[doc = $says:literal])* $variant:ident $word:literal)*
    ) => {
        choice! { $(#[doc = $doc])* $name default $default $($(#[doc = $says])* $variant $word)* }

        impl From<$name> for $resolved {
            fn from(chosen: $name) -> Self {
                match chosen {
                    $($name::$variant => Self::$variant,)*
                }
            }
        }

        impl From<$resolved> for $name {
            fn from(resolved: $resolved) -> Self {
                match resolved {
                    $(<$resolved>::$variant => Self::$variant,)*
                }
            }
        }

        /// By the word that stands for it.
        impl Serialize for $resolved {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                $name::from(*self).serialize(serializer)
            }
        }

        impl<'de> Deserialize<'de> for $resolved {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $name::deserialize(deserializer).map(Self::from)
            }
        }

        impl JsonSchema for $resolved {
            fn schema_name() -> Cow<'static, str> {
                $name::schema_name()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                $name::json_schema(generator)
            }
        }
    };
}

choice! {
    /// How a pixel is stored.
    Format default Rgba8Unorm is (TargetFormat)
    /// Four binary32 components.
    Rgba32Float "rgba32float"
    /// Four binary16 components.
    Rgba16Float "rgba16float"
    /// Four components of 8 bits.
    Rgba8Unorm "rgba8unorm"
    /// Four components of 8 bits; red, green and blue are stored encoded as sRGB has it.
    Rgba8UnormSrgb "rgba8unorm-srgb"
    /// Four components of 8 bits, blue first.
    Bgra8Unorm "bgra8unorm"
}

choice! {
    /// How ambient light and material go together (ruling 8).
    AmbientForm default Product is (shading::Ambient)
    /// Multiplied: document 000.
    Product "product"
    /// The light alone, a constant: document 004.
    Constant "constant"
}

choice! {
    /// Whether attenuation and a spotlight's cone weaken a light's ambient term too (ruling 11).
    LightAmbient default Documents is (shading::LightAmbient)
    /// They do not.
    Documents "documents"
    /// They do.
    OpenGl "opengl"
}

choice! {
    /// Where a light is.
    LightKind default Directional
    /// Infinitely far away.
    Directional "directional"
    /// At a point.
    Point "point"
    /// At a point, within a cone.
    Spot "spot"
}

choice! {
    /// Which distance a fog is of.
    FogDistance default Planar is (shading::Distance)
    /// The depth |z|.
    Planar "planar"
    /// The distance from the eye.
    Radial "radial"
}

choice! {
    /// Where a surface is lit.
    Frequency default Phong
    /// Nowhere: it has the material's diffuse colour.
    Unlit "unlit"
    /// Once a face, at its provoking vertex.
    Flat "flat"
    /// At the vertices; the colour is interpolated.
    Gouraud "gouraud"
    /// At every fragment.
    Phong "phong"
}

choice! {
    /// The vertex that gives a face its colour (ruling 7).
    TakenFrom default Last is (Provoking)
    /// The first.
    First "first"
    /// The last, OpenGL's default.
    Last "last"
}

choice! {
    /// Which cosine a highlight is a power of (ruling 3).
    Specular default Phong is (shading::Specular)
    /// r·v.
    Phong "phong"
    /// n·h.
    Blinn "blinn"
    /// n·(v + l), not normalised.
    BlinnUnnormalised "blinn-unnormalised"
}

choice! {
    /// Whether a surface that faces away from a light can have its highlight (ruling 9).
    Gate default Documents is (shading::SpecularGate)
    /// It can.
    Documents "documents"
    /// It cannot.
    OpenGl "opengl"
}

choice! {
    /// Where the viewer of highlights is.
    Viewer default Local is (shading::Viewer)
    /// At the eye.
    Local "local"
    /// Infinitely far away.
    NonLocal "non-local"
}

choice! {
    /// How normals are brought to eye space (ruling 6).
    NormalForm default InverseTranspose is (shading::Normals)
    /// By the inverse transpose of the modelview.
    InverseTranspose "inverse-transpose"
    /// By the modelview: wrong under non-uniform scale.
    Modelview "modelview"
}

choice! {
    /// The alpha of a lit colour (ruling 14).
    Alpha default Material
    /// 1.
    One "one"
    /// The material's opacity.
    Material "material"
}

choice! {
    /// What the highlight of a material without `specular` is coloured by (004).
    Highlight default Plastic
    /// By the light alone: MS = ks.
    Plastic "plastic"
    /// By the surface too: MS = ks times its colour.
    Metal "metal"
}

choice! {
    /// What a texture does to the colour.
    TextureMode default Modulate
    /// Multiplies it.
    Modulate "modulate"
    /// Takes its place.
    Replace "replace"
}

choice! {
    /// What is read between the middles of texels.
    ReadFilter default Bilinear is (frame::TextureFilter)
    /// The texel that the coordinates lie in.
    Nearest "nearest"
    /// The four around, mixed.
    Bilinear "bilinear"
}

choice! {
    /// What is read beyond the edges.
    ReadWrap default Repeat is (frame::Wrap)
    /// The image again.
    Repeat "repeat"
    /// The texel at the edge.
    Clamp "clamp"
}

choice! {
    /// Where a mesh has its normals from.
    NormalsFrom default Given
    /// From its description.
    Given "given"
    /// One a face; vertices are split.
    Face "face"
    /// The unit normals of the faces around a vertex, averaged (004).
    Averaged "averaged"
}

choice! {
    /// Which faces are not drawn; the front is counter-clockwise as seen.
    Cull default None is (frame::Cull)
    /// All are drawn.
    None "none"
    /// Back faces.
    Back "back"
    /// Front faces.
    Front "front"
}

choice! {
    /// When a fragment's depth passes against the one stored.
    Compare default Less is (crate::depth::Compare)
    /// Never.
    Never "never"
    /// New < old.
    Less "less"
    /// New = old.
    Equal "equal"
    /// New ≤ old.
    LessEqual "less-equal"
    /// New > old.
    Greater "greater"
    /// New ≠ old.
    NotEqual "not-equal"
    /// New ≥ old.
    GreaterEqual "greater-equal"
    /// Always.
    Always "always"
}

choice! {
    /// In which order objects are drawn.
    Order default Given
    /// As they are written.
    Given "given"
    /// Opaque ones as they are written, then those with a cutout, then blended ones, the farthest from the eye first
    /// (002).
    Sorted "sorted"
}
