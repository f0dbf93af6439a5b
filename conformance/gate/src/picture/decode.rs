//! Files of images, read: PNG and EXR by the library for images, and NumPy's arrays.

use super::{Fits, MOST_BYTES, Values};
use image::{DynamicImage, ImageReader};
use std::io::Cursor;

pub(super) fn decoded(bytes: &[u8], file: &str, fits: Fits<'_>) -> Result<Values, String> {
    let unread = |error: &dyn std::fmt::Display| format!("cannot read `{file}`: {error}");
    let opened = || ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| unread(&error));
    let (width, height) = opened()?.into_dimensions().map_err(|error| unread(&error))?;
    fits([width.into(), height.into()])?;
    let mut reader = opened()?;
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(2 * MOST_BYTES);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| unread(&error))?;
    let is_float = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let is_deep = matches!(
        image,
        DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)
            | DynamicImage::ImageRgb16(_)
            | DynamicImage::ImageRgba16(_)
    );
    let values = if is_float {
        Values::Linear(image.to_rgba32f().pixels().map(|pixel| pixel.0.map(f64::from)).collect())
    } else if is_deep {
        Values::Shown(image.to_rgba16().pixels().map(|pixel| pixel.0.map(|c| f64::from(c) / 65535.0)).collect())
    } else {
        Values::Shown(image.to_rgba8().pixels().map(|pixel| pixel.0.map(|c| f64::from(c) / 255.0)).collect())
    };
    Ok(values)
}

/// Levels of brackets in the header of an array of numbers: a dictionary with a tuple.
const MOST_NESTED: i32 = 2;
/// Bytes before the header of an NPY file: of version 1, and of later versions. The last two of them, or the last four, are the header's
/// length.
const PROLOGUES: [usize; 2] = [10, 12];

/// Whether the header of an array nests more than an array of numbers needs. What parses it takes a time that doubles with each further
/// level.
pub(in super::super) fn is_nested(bytes: &[u8]) -> bool {
    let start = PROLOGUES[usize::from(bytes.get(6).is_some_and(|&version| version > 1))];
    let length =
        bytes.get(8..start).unwrap_or_default().iter().rev().fold(0, |sum, &byte| sum << 8 | usize::from(byte));
    let header = bytes.iter().skip(start).take(length);
    let mut depth = 0_i32;
    let mut deepest = 0;
    for byte in header {
        depth += match byte {
            b'{' | b'(' | b'[' => 1,
            b'}' | b')' | b']' => -1,
            _ => 0,
        };
        deepest = deepest.max(depth);
    }
    deepest > MOST_NESTED
}

/// NumPy's format: an array (height, width, 3 or 4) of u8, f32 or f64, in C's order.
pub(super) fn npy(bytes: &[u8], name: &str, fits: Fits<'_>) -> Result<Values, String> {
    if is_nested(bytes) {
        return Err(format!("cannot read `{name}`: its header nests brackets; expected that of an array of numbers"));
    }
    let file = npyz::NpyFile::new(bytes).map_err(|error| format!("cannot read `{name}`: {error}"))?;
    let shape = file.shape().to_vec();
    let [height, width, components @ (3 | 4)] = shape[..] else {
        return Err(format!("an array of shape {shape:?}; expected (height, width, 3 or 4)"));
    };
    if file.order() != npyz::Order::C {
        return Err("an array in Fortran's order; expected C's".into());
    }
    fits([width, height])?;
    let count = usize::try_from(components).unwrap_or(4);
    let pixels = |values: Vec<f64>| -> Vec<[f64; 4]> {
        let pixel = |of: &[f64]| std::array::from_fn(|k| of.get(k).copied().unwrap_or(1.0));
        values.chunks_exact(count).map(pixel).collect()
    };
    let message = |error: &dyn std::fmt::Display| format!("cannot read `{name}`: {error}");
    let npyz::DType::Plain(kind) = file.dtype() else { return Err("an array of records".into()) };
    let values = match kind.to_string().trim_start_matches(['<', '|', '=']) {
        "u1" => {
            let values = file.into_vec::<u8>().map_err(|error| message(&error))?;
            Values::Shown(pixels(values.into_iter().map(|c| f64::from(c) / 255.0).collect()))
        }
        "f4" => {
            let values = file.into_vec::<f32>().map_err(|error| message(&error))?;
            Values::Linear(pixels(values.into_iter().map(f64::from).collect()))
        }
        "f8" => Values::Linear(pixels(file.into_vec::<f64>().map_err(|error| message(&error))?)),
        other => return Err(format!("an array of `{other}`; expected u1, f4 or f8, little-endian")),
    };
    Ok(values)
}
