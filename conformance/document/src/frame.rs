//! A scene as a renderer is asked for it: `lightmeter.frame/1`.

use crate::{Document, ReadError, Word};
use lightmeter_scene::frame::Frame;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.frame/1";

/// A frame with its name, and the effects that it calls for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrameDocument {
    /// `lightmeter.frame/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The scene's id.
    pub id: String,
    /// What it is called.
    pub title: String,
    /// Everything that the image is made from.
    #[serde(flatten)]
    pub frame: Frame,
    /// The effects that any draw calls for.
    pub effects: Vec<Word>,
}

impl Document for FrameDocument {
    const SCHEMA: &'static str = SCHEMA;
    const WHAT: &'static str = "a scene as a renderer is asked for it";

    /// On one line, each f32 widened to the f64 of its value, so that who reads f64 reads the number that is meant.
    fn to_json(&self) -> serde_json::Result<String> {
        Ok(format!("{}\n", serde_json::to_value(self)?))
    }

    fn read(json: &str) -> Result<Self, ReadError> {
        crate::read(json)
    }

    fn schema() -> Schema {
        crate::schema::<Self>()
    }
}

#[cfg(test)]
mod tests {
    use lightmeter_scene::blend::{Equation, Factor};
    use serde_json::to_value;

    #[test]
    fn factors_and_equations_are_written_by_their_names() {
        for factor in Factor::ALL {
            assert_eq!(to_value(factor).expect("a word"), factor.name());
        }
        for equation in Equation::ALL {
            assert_eq!(to_value(equation).expect("a word"), equation.name());
        }
    }
}
