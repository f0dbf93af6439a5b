//! What computes a formula or draws it: the function of the shaders, the blend state, the depth test, what a rasteriser draws.

use crate::Word;
use lightmeter_scene::blend::State;
use lightmeter_scene::depth::DepthTest;
use lightmeter_scene::raster::Raster;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What computes a formula or draws it, beside its inputs and outputs.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct MadeBy {
    /// The WGSL file that an adapter runs, of `gpu/src/shaders`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The function in that file; none where fixed hardware alone draws it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub function: Option<String>,
    /// How the numbers of matrices follow each other: `columns`, where there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub matrices: Option<Word>,
    /// The blend states, one for each layer in turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blend: Option<Vec<LayerRequest>>,
    /// The depth test.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<DepthTest>,
    /// What a rasteriser draws.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raster: Option<Raster>,
}

/// How a layer is drawn.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct LayerRequest {
    /// Of red, green and blue.
    pub color: State,
    /// Of alpha.
    pub alpha: State,
    /// The components that are written: letters of `rgba`.
    pub mask: String,
}
