//! The contact sheet of the page on scenes, and what that page tells of each scene.

use lightmeter::blend_unit::pixel::Units;
use lightmeter::image::file::StoredImage;
use lightmeter::report::page::scenes::{COLUMNS, ToldScene};
use lightmeter::scene::SceneError;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::load;
use lightmeter::scene::load::Loaded;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::{Effects, effects};
use lightmeter_scene::target::TargetFormat;

/// Pixels of a picture's side.
const SIDE: usize = 160;
/// Pixels between pictures.
const GAP: usize = 4;

/// The built-in scenes, in their order. An error would mean that one is refused, which a test rules out.
pub(crate) fn scenes() -> Result<Vec<Loaded>, SceneError> {
    SCENES.iter().map(|(name, _)| load::builtin(name)).collect()
}

/// What the page tells of a scene.
pub(crate) fn told(loaded: &Loaded) -> ToldScene {
    let frame_effects = effects(&loaded.frame);
    let called = frame_effects.iter().flat_map(|called| called.effects.iter());
    ToldScene {
        name: loaded.name.clone(),
        shows: loaded.shows.clone(),
        effects: called.fold(Effects::NONE, Effects::with),
    }
}

/// Every scene by the reference, side by side and row after row, each shrunk by averaging.
pub(crate) fn draw(scenes: &[Loaded]) -> StoredImage {
    let rows = scenes.len().div_ceil(COLUMNS);
    let [width, height] = [COLUMNS, rows].map(|count| count * (SIDE + GAP) + GAP);
    let mut sheet = StoredImage {
        width,
        format: TargetFormat::Rgba8Unorm,
        pixels: vec![[24.0, 24.0, 26.0, 255.0]; width * height],
    };
    for (number, loaded) in scenes.iter().enumerate() {
        let image = StoredImage::of(&render::<f64>(&loaded.frame, None, None), loaded.frame.target.format);
        let [left, top] = [number % COLUMNS, number / COLUMNS].map(|place| place * (SIDE + GAP) + GAP);
        for y in 0..SIDE {
            for x in 0..SIDE {
                sheet.pixels[(top + y) * width + left + x] = average(&image, [x, y]);
            }
        }
    }
    sheet
}

/// The mean of the pixels that a pixel of the sheet stands for, in steps from 0 to 255.
fn average(image: &StoredImage, at: [usize; 2]) -> Units {
    let size = [image.width, image.pixels.len() / image.width];
    let span = |axis: usize| {
        at[axis] * size[axis] / SIDE..((at[axis] + 1) * size[axis] / SIDE).max(at[axis] * size[axis] / SIDE + 1)
    };
    let scale = if image.format.is_unorm() { 1.0 } else { 255.0 };
    let (mut sum, mut count) = ([0.0; 4], 0.0);
    for y in span(1) {
        for x in span(0) {
            count += 1.0;
            for (sum, c) in sum.iter_mut().zip(image.pixels[y * image.width + x]) {
                *sum += (c * scale).clamp(0.0, 255.0);
            }
        }
    }
    [sum[0] / count, sum[1] / count, sum[2] / count, 255.0]
}
