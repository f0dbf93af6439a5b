//! The JSON of `effects`.

use crate::Word;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema of [`EffectsDocument`].
pub const SCHEMA: &str = "lightmeter.effects/1";

/// The JSON of `effects`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct EffectsDocument {
    /// `lightmeter.effects/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The name of the scene.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// The draws, in their order.
    pub draws: Vec<DrawEffects>,
}

/// What a draw calls for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct DrawEffects {
    /// The name of the draw.
    pub draw: String,
    /// The effects that it calls for.
    pub effects: Vec<Word>,
    /// The lights that it calls for, by name.
    pub lights: Vec<String>,
    /// The reason for each effect and each light, called for or not.
    pub reasons: Vec<EffectReason>,
}

/// Why an effect or a light is called for, or is not. It names one of the two.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct EffectReason {
    /// The effect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effect: Option<Word>,
    /// The light, by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub light: Option<String>,
    /// Whether it is called for.
    pub called: bool,
    /// The reason.
    pub why: String,
}
