//! How a mistake looks in scenes: in which of them it shows, and on which side.

use super::{SceneFault, draw};
use lightmeter_arithmetic::profile::WGSL;
use lightmeter_catalogue::scene::SceneError;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::{builtin, scene_id};
use lightmeter_document::Word;
use lightmeter_document::mistakes::MistakeLook;
use lightmeter_judge::image::expect;
use rayon::prelude::*;

/// Pixels of the longer side of the scenes that are drawn.
const SIZE: u32 = 40;

/// How each of some mistakes looks in each of the scenes that are selected by their ids, where it shows there.
///
/// # Errors
/// Where a scene is refused, which a test rules out.
pub fn looks(
    faults: &[&'static SceneFault],
    is_selected: impl Fn(&str) -> bool,
) -> Result<Vec<Vec<MistakeLook>>, SceneError> {
    let mut found = vec![vec![]; faults.len()];
    for place in (0..SCENES.len()).filter(|&place| is_selected(&scene_id(place))) {
        let frame = builtin(place, Some(SIZE))?.frame;
        let expected = expect(&frame, None, None, &WGSL);
        let of_scene: Vec<Option<MistakeLook>> = faults
            .par_iter()
            .map(|fault| {
                let image = draw::<f32>(&frame, &[fault]);
                let mut look =
                    MistakeLook { formula: scene_id(place), cases: expected.len(), ..MistakeLook::default() };
                let mut wrong = [false; 4];
                for (value, legal) in image.pixels.iter().zip(&expected) {
                    let mut fails = false;
                    for k in 0..4 {
                        let (is_great, is_small) = (value[k] > legal.high[k], value[k] < legal.low[k]);
                        look.too_great += usize::from(is_great);
                        look.too_small += usize::from(is_small);
                        wrong[k] |= is_great || is_small;
                        fails |= is_great || is_small;
                    }
                    look.failing += usize::from(fails);
                }
                let components = super::diagnose::NAMES.iter().zip(wrong).filter(|(_, wrong)| *wrong);
                look.outputs = components.map(|(name, _)| Word::from(*name)).collect();
                (look.failing > 0).then_some(look)
            })
            .collect();
        for (looks, look) in found.iter_mut().zip(of_scene) {
            looks.extend(look);
        }
    }
    Ok(found)
}
