//! Images as files: PNG of 8 bits, or EXR of binary32.

use crate::blend_unit::pixel::{self, Units};
#[cfg(feature = "scenes")]
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
#[cfg(feature = "scenes")]
use image::{DynamicImage, ImageBuffer, ImageFormat, Rgba};
use lightmeter_reference::render::Image;
#[cfg(feature = "scenes")]
use lightmeter_scene::target::Encoding;
use lightmeter_scene::target::TargetFormat;
#[cfg(feature = "scenes")]
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Why an image was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImageFileError {
    /// The name does not end as a known format does.
    #[error("{}: an image is written as .png or .exr", .0.display())]
    Format(PathBuf),
    /// The pixels could not be encoded.
    #[error("cannot encode {}: {message}", .path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// The file could not be written.
    #[error("cannot write {}: {message}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

/// How an image is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFileFormat {
    /// What a screen is to show, in 8 bits.
    Png,
    /// Linear values in binary32.
    Exr,
}

/// An image in the units of a target.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredImage {
    /// Pixels.
    pub width: usize,
    /// What the units are of.
    pub format: TargetFormat,
    /// Row after row from the top.
    pub pixels: Vec<Units>,
}

impl StoredImage {
    /// The reference's image, each component in its target's units, rounded to it.
    #[must_use]
    pub fn of(image: &Image, format: TargetFormat) -> Self {
        let mut stored = Self::unrounded(image, format);
        if format.is_unorm() {
            for c in stored.pixels.iter_mut().flatten() {
                *c = c.round_ties_even();
            }
        }
        stored
    }

    /// The same, not rounded.
    #[must_use]
    pub fn unrounded(image: &Image, format: TargetFormat) -> Self {
        let units = |pixel: &[f64; 4]| std::array::from_fn(|k| pixel::units(format.encoding(), k, pixel[k]));
        Self { width: image.width, format, pixels: image.pixels.iter().map(units).collect() }
    }

    /// The image that a target holds.
    #[must_use]
    pub fn read(width: usize, format: TargetFormat, bytes: &[u8]) -> Self {
        let count = bytes.len() / (4 * format.component_bytes());
        Self { width, format, pixels: (0..count).map(|number| pixel::read(format, bytes, number)).collect() }
    }

    /// Writes it whole or not at all: as PNG with what a screen is to show, or as EXR with linear values.
    ///
    /// # Errors
    /// Where the name ends otherwise, or the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), ImageFileError> {
        let bytes = self.encode(path)?;
        whole(path, &bytes)
    }

    /// Whether a file of this name can be written at all.
    ///
    /// # Errors
    /// Where it ends otherwise than in .png or .exr.
    pub fn check_name(path: &Path) -> Result<ImageFileFormat, ImageFileError> {
        let ends = |end: &str| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(end));
        match () {
            () if ends("png") => Ok(ImageFileFormat::Png),
            () if ends("exr") => Ok(ImageFileFormat::Exr),
            () => Err(ImageFileError::Format(path.into())),
        }
    }

    /// The bytes of the file that the name asks for.
    ///
    /// # Errors
    /// Where the format cannot hold the image, or the library was built without the feature `scenes`.
    ///
    /// # Panics
    /// Where a side of the image does not fit 32 bits.
    #[cfg(not(feature = "scenes"))]
    pub fn encode(&self, path: &Path) -> Result<Vec<u8>, ImageFileError> {
        Self::check_name(path)?;
        let message = "the library was built without the feature `scenes`".into();
        Err(ImageFileError::Encode { path: path.into(), message })
    }

    /// The bytes of the file that the name asks for.
    ///
    /// # Errors
    /// Where the format cannot hold the image.
    ///
    /// # Panics
    /// Where a side of the image does not fit 32 bits.
    #[cfg(feature = "scenes")]
    pub fn encode(&self, path: &Path) -> Result<Vec<u8>, ImageFileError> {
        let format = Self::check_name(path)?;
        let failed = |message: String| ImageFileError::Encode { path: path.into(), message };
        let [width, height] = [self.width, self.pixels.len() / self.width]
            .map(|pixels| u32::try_from(pixels).expect("a target's size fits 32 bits"));
        let drawn = match format {
            ImageFileFormat::Png => {
                ImageBuffer::<Rgba<u8>, _>::from_vec(width, height, self.bytes()).map(DynamicImage::from)
            }
            ImageFileFormat::Exr => {
                ImageBuffer::<Rgba<f32>, _>::from_vec(width, height, self.values()).map(DynamicImage::from)
            }
        };
        let drawn = drawn.ok_or_else(|| failed("its pixels do not fill it".into()))?;
        let mut bytes = Cursor::new(vec![]);
        match format {
            ImageFileFormat::Png => {
                // Reports embed them: the smallest file is worth the time.
                let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
                drawn.write_with_encoder(encoder)
            }
            ImageFileFormat::Exr => drawn.write_to(&mut bytes, ImageFormat::OpenExr),
        }
        .map_err(|error| failed(error.to_string()))?;
        Ok(bytes.into_inner())
    }

    /// Steps from 0 to 255: those of the target, or of its values clamped.
    #[cfg(feature = "scenes")]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 8 bits")]
    fn bytes(&self) -> Vec<u8> {
        let scale = if self.format.is_unorm() { 1.0 } else { 255.0 };
        self.pixels.iter().flatten().map(|c| (c * scale).clamp(0.0, 255.0).round_ties_even() as u8).collect()
    }

    #[cfg(feature = "scenes")]
    #[expect(clippy::cast_possible_truncation, reason = "the file holds binary32")]
    fn values(&self) -> Vec<f32> {
        let linear = |pixel: &Units| -> [f32; 4] {
            std::array::from_fn(|k| match self.format.encoding() {
                Encoding::Float32 | Encoding::Float16 => pixel[k] as f32,
                _ => pixel::linear(self.format.encoding(), k, pixel[k]) as f32,
            })
        };
        self.pixels.iter().flat_map(linear).collect()
    }
}

/// Writes a file beside its place and moves it there.
///
/// # Errors
/// Where either fails.
pub fn whole(path: &Path, bytes: &[u8]) -> Result<(), ImageFileError> {
    lightmeter_files::whole(path, bytes)
        .map_err(|error| ImageFileError::Write { path: path.into(), message: error.to_string() })
}
