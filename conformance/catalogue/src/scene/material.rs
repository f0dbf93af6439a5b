//! Materials: 003's scalars and their highlights turned into colours.

use super::field::{At, SceneError};
use lightmeter_scene::frame::{self, Sampled, Textured};
#[cfg(feature = "scenes")]
use lightmeter_scene::frame::{TextureFilter, Wrap};
use lightmeter_scene::model::{Highlight, Material, Named, Reading, TextureImage, TextureMode};

/// A material with the images that it reads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    pub(super) material: frame::Material,
    pub(super) opacity: f32,
    pub(super) texture: Option<Textured>,
    pub(super) lightmap: Option<Sampled>,
}

impl Surface {
    /// Of a draw that names no material.
    pub(super) const WHITE: Self = Self {
        material: frame::Material {
            emissive: [0.0; 3],
            ambient: [1.0; 3],
            diffuse: [1.0; 3],
            specular: [0.0; 3],
            shininess: 32.0,
        },
        opacity: 1.0,
        texture: None,
        lightmap: None,
    };
}

/// How an image that a file names is read.
#[cfg(feature = "scenes")]
pub(super) const fn of_file(texture: usize) -> Textured {
    Textured { sampled: Sampled { texture, filter: TextureFilter::Bilinear, wrap: Wrap::Repeat }, replaces: false }
}

/// What the material is, with its images by their places among the textures.
pub(super) fn surface(at: &At<'_>, material: &Material, textures: &Named<TextureImage>) -> Result<Surface, SceneError> {
    at.field("color").numbers(material.color)?;
    let scaled = |name: &str, k: Option<f64>| -> Result<[f64; 3], SceneError> {
        let k = k.unwrap_or(1.0);
        at.field(name).number(k)?;
        Ok(material.color.map(|c| k * c))
    };
    let either = |name: &str, scalar: &str, own: Option<[f64; 3]>, k: Option<f64>, of: [f64; 3]| match (own, k) {
        (Some(_), Some(_)) => Err(at.field(name).refuse(format_args!("stands beside `{scalar}`"), "one of the two")),
        (Some(own), None) => at.field(name).numbers(own),
        (None, _) => at.field(scalar).numbers(of),
    };
    if material.specular.is_some() && material.highlight.is_some() {
        let holds = "stands beside `specular`, which is the highlight's colour";
        return Err(at.field("highlight").refuse(holds, "one of the two"));
    }
    let ks = material.ks.unwrap_or(0.0);
    let highlight = match material.highlight.unwrap_or_default() {
        Highlight::Plastic => [ks; 3],
        Highlight::Metal => scaled("ks", Some(ks))?,
    };
    let ambient = scaled("ka", material.ka)?;
    let diffuse = scaled("kd", material.kd)?;
    Ok(Surface {
        material: frame::Material {
            emissive: at.field("emissive").numbers(material.emissive)?,
            ambient: either("ambient", "ka", material.ambient, material.ka, ambient)?,
            diffuse: either("diffuse", "kd", material.diffuse, material.kd, diffuse)?,
            specular: either("specular", "ks", material.specular, material.ks, highlight)?,
            shininess: at.field("shininess").not_negative(material.shininess)?,
        },
        opacity: at.field("opacity").share(material.opacity)?,
        texture: material
            .texture
            .as_ref()
            .map(|reading| {
                let sampled = sampled(&at.field("texture"), reading, textures)?;
                Ok(Textured { sampled, replaces: reading.mode == TextureMode::Replace })
            })
            .transpose()?,
        lightmap: material
            .lightmap
            .as_ref()
            .map(|reading| {
                let at = at.field("lightmap");
                let multiplies = reading.mode == TextureMode::Modulate;
                at.field("mode").require(multiplies, "replace", "modulate: a lightmap multiplies")?;
                sampled(&at, reading, textures)
            })
            .transpose()?,
    })
}

fn sampled(at: &At<'_>, reading: &Reading, textures: &Named<TextureImage>) -> Result<Sampled, SceneError> {
    let found = textures.find(&reading.image).map(|(place, _)| place);
    let texture = at.field("image").named(found, &reading.image, &textures.names())?;
    Ok(Sampled { texture, filter: reading.filter, wrap: reading.wrap })
}
