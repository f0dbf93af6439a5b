//! A frame as a file that any renderer can read.

use lightmeter_document::Word;
use lightmeter_document::frame::{FrameDocument, SCHEMA};
use lightmeter_scene::effects::{Effect, effects};
use lightmeter_scene::frame::Frame;

/// The frame with its meshes and textures.
#[must_use]
pub fn document(id: &str, title: &str, frame: &Frame) -> FrameDocument {
    FrameDocument {
        schema: SCHEMA.into(),
        id: id.to_owned(),
        title: title.to_owned(),
        frame: frame.clone(),
        effects: called(frame).into_iter().map(Word::from).collect(),
    }
}

/// The names of the effects that any draw calls for, in their order.
pub(super) fn called(frame: &Frame) -> Vec<&'static str> {
    let draws = effects(frame);
    let is_called = |effect: &Effect| draws.iter().any(|called| called.effects.has(*effect));
    Effect::ALL.into_iter().filter(is_called).map(Effect::name).collect()
}
