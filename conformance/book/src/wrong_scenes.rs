//! Mistakes in scenes, each beside what it should be.

use crate::formula::sentence;
use crate::scenes::{drawn, picture};
use crate::{BookError, contents::Place};
use lightmeter_catalogue::scene::load::Loaded;
use lightmeter_faults::scene::{SCENE_FAULTS, SceneFault, draw};
use lightmeter_judge::image::file::StoredImage;
use maud::{Markup, html};
use rayon::prelude::*;
use std::path::Path;

/// The mean difference, as a share of full scale, from which on a mistake is seen well.
const SEEN: f64 = 0.01;

/// A mistake in the scene in which it is seen.
pub(crate) struct WrongScene<'a> {
    fault: &'static SceneFault,
    scene: &'a Loaded,
    image: StoredImage,
}

impl WrongScene<'_> {
    fn file(&self) -> String {
        format!("pictures/mistake-{}.png", self.fault.name)
    }

    /// Writes its picture.
    pub(crate) fn write(&self, out: &Path) -> Result<(), BookError> {
        let path = out.join(self.file());
        self.image.write(&path).map_err(|error| BookError::Write { path, message: error.to_string() })
    }
}

/// Each mistake in the first scene in which it is seen well, or else in the one in which it is seen best.
pub(crate) fn wrong_scenes(scenes: &[Loaded]) -> Vec<WrongScene<'_>> {
    let right: Vec<StoredImage> = scenes.par_iter().map(drawn).collect();
    let one = |fault: &'static SceneFault| {
        let mut best: Option<(f64, WrongScene<'_>)> = None;
        for (scene, right) in scenes.iter().zip(&right) {
            let image = draw::<f64>(&scene.frame, &[fault]);
            let apart = difference(&image, right);
            if apart > 0.0 && best.as_ref().is_none_or(|(most, _)| apart > *most) {
                best = Some((apart, WrongScene { fault, scene, image }));
            }
            if apart >= SEEN {
                break;
            }
        }
        best.map(|(_, found)| found)
    };
    SCENE_FAULTS.par_iter().filter_map(one).collect()
}

/// The mean difference of two images' colours, as a share of full scale.
fn difference(image: &StoredImage, right: &StoredImage) -> f64 {
    let scale = if image.format.is_unorm() { 255.0 } else { 1.0 };
    let of_pixel =
        |(a, b): (&[f64; 4], &[f64; 4])| (0..3).map(|k| ((a[k] - b[k]) / scale).abs().min(1.0)).sum::<f64>() / 3.0;
    #[expect(clippy::cast_precision_loss, reason = "a count of pixels")]
    let count = image.pixels.len() as f64;
    image.pixels.iter().zip(&right.pixels).map(of_pixel).filter(|x| x.is_finite()).sum::<f64>() / count
}

/// The page.
pub(crate) fn page(wrong: &[WrongScene<'_>], place: &Place<'_>) -> Markup {
    html! {
        h1 { "Mistakes in scenes" }
        p { "On the left the scene as the reference draws it, on the right as a renderer with the mistake does. Where a renderer’s image fails, the suite compares it with images such as these and names the mistake that explains it." }
        @for one in wrong {
            section.mistake id=(one.fault.name) {
                h2 { code { (one.fault.name) } }
                p { (sentence(one.fault.says)) @if let Some(seen) = one.fault.seen_in { span.quiet { " Seen in: " (seen) "." } } }
                div.pair {
                    figure { img src=(place.to(&picture(one.scene))) alt=(one.scene.title) loading="lazy"; figcaption { code { "scene/" (one.scene.name) } " as it should be" } }
                    figure { img src=(place.to(&one.file())) alt={ "the same if " (one.fault.says) } loading="lazy"; figcaption { "with the mistake" } }
                }
            }
        }
    }
}
