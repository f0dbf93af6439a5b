//! Images that renderers write: PNG of 8 or 16 bits, EXR, NPY.

#[cfg(feature = "scenes")]
pub(super) mod decode;

use lightmeter_judge::blend_unit::pixel;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_scene::frame::Frame;
use std::path::{Component, Path, PathBuf};
use std::time::SystemTime;

/// Bytes of a file, at most: 8192² pixels of binary32, and a header.
const MOST_BYTES: u64 = (1 << 30) + (1 << 20);

/// How far from a step of 8 bits a linear value of binary32 may be that is one.
const WHOLE: f64 = 1e-3;

/// A path within a folder, whatever the renderer wrote.
///
/// # Errors
/// Where it leaves the folder, by itself or by a link.
pub fn within(folder: &Path, file: &str) -> Result<PathBuf, String> {
    let given = Path::new(file);
    // A process may name a file by its whole path.
    let relative = given.strip_prefix(folder).unwrap_or(given);
    let is_inside = relative.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    let leaves = || format!("`{file}` leaves the folder of the answers; expected a name within it");
    if !is_inside {
        return Err(leaves());
    }
    let path = folder.join(relative);
    let real = |path: &Path| path.canonicalize().map_err(|error| format!("cannot read `{file}`: {error}"));
    if real(&path)?.starts_with(real(folder)?) { Ok(path) } else { Err(leaves()) }
}

/// Reads an image of a frame's size, in the units of its target. It is no older than `asked`.
///
/// # Errors
/// Where it lies elsewhere, is no image, is of another size, or was there before.
pub fn read(folder: &Path, file: &str, frame: &Frame, asked: Option<SystemTime>) -> Result<StoredImage, String> {
    let path = within(folder, file)?;
    let unread = |error: &dyn std::fmt::Display| format!("cannot read `{file}`: {error}");
    let metadata = path.metadata().map_err(|error| unread(&error))?;
    if !metadata.is_file() {
        return Err(format!("`{file}` is no file"));
    }
    if asked.zip(metadata.modified().ok()).is_some_and(|(asked, written)| written < asked) {
        return Err(format!("`{file}` was there before the scene was asked for, and was not written since"));
    }
    let bytes = metadata.len();
    if bytes > MOST_BYTES {
        return Err(format!("`{file}` has {bytes} bytes; an image has {MOST_BYTES} at most"));
    }
    let bytes = lightmeter_files::read::bytes(&path, MOST_BYTES).map_err(|error| unread(&error))?;
    let [width, height] = [frame.target.width, frame.target.height];
    let is_npy = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("npy"));
    // Nothing of another size is decoded.
    let fits = |[w, h]: [u64; 2]| {
        let fits = [w, h] == [u64::from(width), u64::from(height)];
        if fits { Ok(()) } else { Err(format!("`{file}` is {w} × {h}; the scene is {width} × {height}")) }
    };
    let values = values(&bytes, file, is_npy, &fits)?;
    Ok(StoredImage { width: width as usize, format: frame.target.format, pixels: values.units(frame) })
}

/// The pixels of a file.
#[cfg(feature = "scenes")]
fn values(bytes: &[u8], file: &str, is_npy: bool, fits: Fits<'_>) -> Result<Values, String> {
    if is_npy { decode::npy(bytes, file, fits) } else { decode::decoded(bytes, file, fits) }
}

/// No file can be read without the feature `scenes`.
#[cfg(not(feature = "scenes"))]
fn values(_bytes: &[u8], file: &str, _is_npy: bool, _fits: Fits<'_>) -> Result<Values, String> {
    Err(format!("cannot read `{file}`: the library was built without the feature `scenes`"))
}

/// Whether an image has the scene's size.
type Fits<'a> = &'a dyn Fn([u64; 2]) -> Result<(), String>;

/// Pixels as a file has them.
#[cfg_attr(not(feature = "scenes"), expect(dead_code, reason = "only files have them"))]
enum Values {
    /// What a screen is shown, from 0 to 1: in the target's encoding.
    Shown(Vec<[f64; 4]>),
    /// Linear values.
    Linear(Vec<[f64; 4]>),
}

impl Values {
    fn units(self, frame: &Frame) -> Vec<[f64; 4]> {
        let format = frame.target.format;
        match self {
            Self::Shown(pixels) => {
                let scale = if format.is_unorm() { 255.0 } else { 1.0 };
                pixels.into_iter().map(|pixel| pixel.map(|c| c * scale)).collect()
            }
            Self::Linear(pixels) => {
                let units = |pixel: [f64; 4]| {
                    std::array::from_fn(|k| {
                        let units = pixel::units(format.encoding(), k, pixel[k]);
                        // A whole step that was written as binary32 is that step.
                        let step = units.round();
                        if format.is_unorm() && (units - step).abs() < WHOLE { step } else { units }
                    })
                };
                pixels.into_iter().map(units).collect()
            }
        }
    }
}

#[cfg(all(test, feature = "scenes"))]
mod tests {
    use super::*;
    use image::codecs::png::{CompressionType, FilterType, PngEncoder};
    use image::{ExtendedColorType, ImageEncoder as _};
    use lightmeter_catalogue::scene::load;

    /// The first built-in scene's frame, of 4 × 3 pixels, and a folder with some files.
    fn given(test: &str, files: &[(&str, Vec<u8>)]) -> (PathBuf, Frame) {
        let folder = std::env::temp_dir().join(format!("lightmeter-picture-{}-{test}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder can be made");
        for (name, bytes) in files {
            std::fs::write(folder.join(name), bytes).expect("a file can be written");
        }
        let mut frame = load::scene("scene/flat").expect("it is built in").frame;
        (frame.target.width, frame.target.height) = (4, 3);
        (folder, frame)
    }

    fn png(width: u32, height: u32, compression: CompressionType) -> Vec<u8> {
        let pixels: Vec<u8> = (0..width * height * 3).map(|k| u8::try_from(k % 251).unwrap_or(0)).collect();
        let mut bytes = vec![];
        let encoder = PngEncoder::new_with_quality(&mut bytes, compression, FilterType::NoFilter);
        encoder.write_image(&pixels, width, height, ExtendedColorType::Rgb8).expect("it can be encoded");
        bytes
    }

    /// The header of NumPy's format, and no data.
    fn npy(shape: &str) -> Vec<u8> {
        let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
        header += &" ".repeat(63 - (10 + header.len()) % 64);
        header.push('\n');
        let length = u16::try_from(header.len()).expect("it is short").to_le_bytes();
        [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes()].concat()
    }

    #[test]
    fn what_is_of_another_size_is_not_decoded() {
        // A header of 2 GiB of pixels; a shape of 10¹² numbers, none of which is there.
        let mut huge = png(4, 3, CompressionType::Fast);
        huge[16..24].copy_from_slice(&[0, 0, 0x60, 0, 0, 0, 0x60, 0]);
        let crc = crc32fast::hash(&huge[12..29]).to_be_bytes();
        huge[29..33].copy_from_slice(&crc);
        let files = [
            ("huge.png", huge),
            ("other.png", png(3, 4, CompressionType::Fast)),
            ("huge.npy", npy("(1000000, 1000000, 4)")),
            ("flat.npy", npy("(3, 4)")),
            ("short.npy", npy("(3, 4, 4)")),
            ("none.png", vec![]),
        ];
        let (folder, frame) = given("sizes", &files);
        for (name, said) in [
            ("huge.png", "24576 × 24576; the scene is 4 × 3"),
            ("other.png", "3 × 4; the scene is 4 × 3"),
            ("huge.npy", "1000000 × 1000000; the scene is 4 × 3"),
            ("flat.npy", "expected (height, width, 3 or 4)"),
            ("short.npy", "cannot read `short.npy`"),
            ("none.png", "cannot read `none.png`"),
            ("absent.png", "cannot read `absent.png`"),
        ] {
            let error = read(&folder, name, &frame, None).expect_err(name);
            assert!(error.contains(said), "{error}");
        }
        let _ = std::fs::remove_dir_all(folder);
    }

    #[test]
    fn the_same_pixels_are_the_same_answer_however_they_are_packed() {
        let files = [("a.png", png(4, 3, CompressionType::Fast)), ("b.png", png(4, 3, CompressionType::Best))];
        assert_ne!(files[0].1, files[1].1);
        let (folder, frame) = given("digest", &files);
        let pixels = |name: &str| read(&folder, name, &frame, None).expect("it can be read").pixels;
        assert_eq!(pixels("a.png"), pixels("b.png"));
        let later = SystemTime::now() + std::time::Duration::from_secs(1);
        let error = read(&folder, "a.png", &frame, Some(later)).expect_err("it is older");
        assert!(error.contains("was there before"), "{error}");
        let _ = std::fs::remove_dir_all(folder);
    }
}
