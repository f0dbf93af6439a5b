//! Which scenes and pixels a run is made of, by their ids, and how large they are drawn.

use crate::filter::Filter;
use crate::scene::library::SCENES;
use crate::scene::load::{self, Loaded};
use crate::select::Shard;
use lightmeter_scene::frame::Frame;

/// A scene that is selected, by its place among the built-in ones, and its pixels; `None` for all.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// Its place.
    pub place: usize,
    /// Some of its pixels.
    pub pixels: Option<Vec<usize>>,
}

impl Chosen {
    /// About how many pixels that are.
    #[must_use]
    pub fn work(&self) -> u64 {
        self.pixels.as_ref().map_or(1 << 18, |pixels| pixels.len() as u64)
    }
}

/// The id of a scene.
#[must_use]
pub fn scene_id(place: usize) -> String {
    format!("scene/{}", SCENES[place].0)
}

/// The id of a pixel.
#[must_use]
pub fn pixel_id(scene: &str, width: usize, pixel: usize) -> String {
    format!("{scene}/{}-{}", pixel % width, pixel / width)
}

/// The pixel of an id such as `scene/teapot/12-340`, if the scene has it.
#[must_use]
pub fn pixel_of(id: &str, scene: &str, frame: &Frame) -> Option<usize> {
    let (x, y) = id.strip_prefix(scene)?.strip_prefix('/')?.split_once('-')?;
    let (x, y): (usize, usize) = (x.parse().ok()?, y.parse().ok()?);
    let (width, height) = (frame.target.width as usize, frame.target.height as usize);
    (x < width && y < height).then_some(y * width + x)
}

/// A built-in scene, drawn with `size` pixels on its longer side rather than its own number.
///
/// # Errors
/// Where it is refused, which a test rules out.
pub fn builtin(place: usize, size: Option<u32>) -> Result<Loaded, crate::scene::SceneError> {
    let mut loaded = load::builtin(SCENES[place].0)?;
    if let Some(size) = size {
        resize(&mut loaded.frame, size);
    }
    Ok(loaded)
}

/// Gives a frame `size` pixels on its longer side, and as many on the other as keep its shape.
pub fn resize(frame: &mut Frame, size: u32) {
    let target = &mut frame.target;
    let longer = target.width.max(target.height);
    let scaled = |side: u32| (u64::from(side) * u64::from(size)).div_ceil(u64::from(longer));
    let [width, height] = [target.width, target.height].map(|side| u32::try_from(scaled(side)).unwrap_or(side));
    (target.width, target.height) = (width, height);
}

/// Pixels of the longer side of every scene in a run of everything, which is to end within a minute. Scenes that are asked
/// for have their own size.
pub const SIZE_AMONG_ALL: u32 = 256;

/// The longer side that scenes are drawn with; `None` for their own.
#[must_use]
pub fn size(filter: &Filter, asked: Option<u32>) -> Option<u32> {
    asked.or(filter.is_empty().then_some(SIZE_AMONG_ALL))
}

/// The scenes that a filter and a shard select, or the pixels of them that it names.
#[must_use]
pub fn select(filter: &Filter, shard: Shard, size: Option<u32>) -> Vec<Chosen> {
    let mut chosen = vec![];
    for place in (0..SCENES.len()).filter(|&place| shard.has(place as u64)) {
        let id = scene_id(place);
        if filter.selects(&id) {
            chosen.push(Chosen { place, pixels: None });
            continue;
        }
        let below = format!("{id}/");
        if !filter.is_as_deep_as(3) {
            continue;
        }
        if !filter.reaches_below(&id) && !filter.literals().any(|literal| literal.starts_with(&below)) {
            continue;
        }
        let Ok(loaded) = builtin(place, size) else { continue };
        let (width, height) = (loaded.frame.target.width as usize, loaded.frame.target.height as usize);
        let pixels: Vec<usize> =
            (0..width * height).filter(|&pixel| filter.selects(&pixel_id(&id, width, pixel))).collect();
        if !pixels.is_empty() {
            chosen.push(Chosen { place, pixels: Some(pixels) });
        }
    }
    chosen
}
