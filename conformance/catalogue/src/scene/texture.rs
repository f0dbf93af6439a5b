//! Textures: read from PNG, written out, or generated.

use super::field::{At, SceneError};
use super::files::Files;
#[cfg(feature = "scenes")]
use image::{ImageFormat, ImageReader, Limits};
use lightmeter_scene::frame::Texture;
use lightmeter_scene::model::TextureImage;
#[cfg(feature = "scenes")]
use std::io::Cursor;

/// Texels along each side, at most.
const MOST_TEXELS: u32 = 2048;
const SIZES: &str = "1 to 2048 texels";

/// The texels of an image.
pub(super) fn texture(at: &At<'_>, image: &TextureImage, files: &Files<'_>) -> Result<Texture, SceneError> {
    match image {
        TextureImage::File(path) => from_file(&at.field("file"), path, files),
        TextureImage::Texels(rows) => written(&at.field("texels"), rows),
        TextureImage::Checker { size, colors } => {
            let at = at.field("checker");
            let colors =
                [at.field("colors").item(0).numbers(colors[0])?, at.field("colors").item(1).numbers(colors[1])?];
            generated(&at, *size, |x, y| colors[usize::from((x + y) % 2 == 1)].map(f64::from))
        }
        TextureImage::Gradient { size, corners } => {
            let at = at.field("gradient");
            for (place, corner) in corners.iter().enumerate() {
                at.field("corners").item(place).numbers(*corner)?;
            }
            let share = |i: u32, of: u32| f64::from(i) / f64::from(of.max(2) - 1);
            generated(&at, *size, |x, y| {
                let (s, t) = (share(x, size[0]), share(y, size[1]));
                mix(mix(corners[0], corners[1], s), mix(corners[2], corners[3], s), t)
            })
        }
        TextureImage::Radial { size, inner, outer } => {
            let at = at.field("radial");
            at.field("inner").numbers(*inner)?;
            at.field("outer").numbers(*outer)?;
            let from_middle = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(*size) - 1.0;
            generated(&at, [*size; 2], |x, y| mix(*inner, *outer, from_middle(x).hypot(from_middle(y)).min(1.0)))
        }
    }
}

fn mix(a: [f64; 4], b: [f64; 4], t: f64) -> [f64; 4] {
    std::array::from_fn(|k| a[k] * (1.0 - t) + b[k] * t)
}

fn generated(at: &At<'_>, size: [u32; 2], texel: impl Fn(u32, u32) -> [f64; 4]) -> Result<Texture, SceneError> {
    let [width, height] = size;
    for texels in size {
        at.field("size").require((1..=MOST_TEXELS).contains(&texels), texels, SIZES)?;
    }
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at.numbers(texel(x, y)));
    Ok(Texture { width, height, texels: texels.collect::<Result<_, _>>()? })
}

fn written(at: &At<'_>, rows: &[Vec<[f64; 4]>]) -> Result<Texture, SceneError> {
    let side = |at: &At<'_>, texels: usize| {
        let right = u32::try_from(texels).ok().filter(|texels| (1..=MOST_TEXELS).contains(texels));
        right.ok_or_else(|| at.refuse(format_args!("has {texels} entries"), SIZES))
    };
    let height = side(at, rows.len())?;
    let width = side(&at.item(0), rows[0].len())?;
    let mut texels = Vec::new();
    for (y, row) in rows.iter().enumerate() {
        let at = at.item(y);
        if row.len() != rows[0].len() {
            return Err(
                at.refuse(format_args!("has {} texels", row.len()), format_args!("{width}, as in the first row"))
            );
        }
        for (x, texel) in row.iter().enumerate() {
            texels.push(at.item(x).numbers(*texel)?);
        }
    }
    Ok(Texture { width, height, texels })
}

/// A PNG cannot be read without the feature `scenes`.
#[cfg(not(feature = "scenes"))]
pub(super) fn from_file(at: &At<'_>, path: &str, _files: &Files<'_>) -> Result<Texture, SceneError> {
    Err(at.refuse(format_args!("is `{path}`"), "no file, since the library was built without the feature `scenes`"))
}

/// A PNG: a byte b stands for b/255.
#[cfg(feature = "scenes")]
pub(super) fn from_file(at: &At<'_>, path: &str, files: &Files<'_>) -> Result<Texture, SceneError> {
    let bytes =
        files(path).map_err(|error| at.refuse(format_args!("is `{path}`, which cannot be read: {error}"), "a PNG"))?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST_TEXELS), Some(MOST_TEXELS));
    reader.limits(limits);
    let decoded = reader.decode().map_err(|error| {
        let allowed = format_args!("a PNG of {SIZES} on each side");
        at.refuse(format_args!("is `{path}`: {error}"), allowed)
    })?;
    let rgba = decoded.into_rgba8();
    let texels = rgba.pixels().map(|pixel| at.numbers(pixel.0.map(|byte| f64::from(byte) / 255.0)));
    Ok(Texture { width: rgba.width(), height: rgba.height(), texels: texels.collect::<Result<_, _>>()? })
}
