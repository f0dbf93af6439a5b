//! A shader as somebody wrote it, in the JSON of `run`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A shader that was judged in the place of the suite's own.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShaderUse {
    /// Its file.
    pub file: String,
    /// The function that was judged; of a whole shader none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub function: Option<String>,
    /// The formulas that it was judged by.
    pub formulas: Vec<JudgedAs>,
}

impl ShaderUse {
    /// The lines in which the mistakes of a formula are made.
    pub fn places(&self, id: &str) -> impl Iterator<Item = &MistakePlace> {
        self.formulas.iter().filter(move |formula| formula.id == id).flat_map(|formula| &formula.mistakes)
    }

    /// The same before anything was judged.
    #[must_use]
    pub fn without_mistakes(&self) -> Self {
        let formulas = self.formulas.iter().map(|formula| JudgedAs { mistakes: vec![], ..formula.clone() }).collect();
        Self { formulas, ..self.clone() }
    }
}

/// A formula that a shader was judged by.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JudgedAs {
    /// The formula.
    pub id: String,
    /// The shader's variables.
    pub variables: Vec<BoundVariable>,
    /// The formula's outputs that it does not give, of which nothing was judged.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_given: Vec<String>,
    /// The formula's inputs that no variable stands for, unless a constant does.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unbound: Vec<String>,
    /// Inputs that are constants there, or the same as another input.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held: Vec<HeldInput>,
    /// Where the mistakes that explain its failures are made.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistakes: Vec<MistakePlace>,
}

/// An input of a formula that a shader does not take.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeldInput {
    /// Its name.
    pub name: String,
    /// The bits of the numbers that it is in every case; none where it is another input.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bits: Vec<u32>,
    /// The input that it is the same as.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub same_as: Option<String>,
}

/// What a variable of a shader was set to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoundVariable {
    /// The variable.
    pub name: String,
    /// The expression over the formula's inputs, in WGSL.
    pub is: String,
    /// How it was found.
    pub found: FoundBy,
}

/// How it was found what a variable of a shader means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FoundBy {
    /// It was said, by `--bind`.
    Asked,
    /// The formula has an input of that name.
    SameName,
    /// Its name is a common one for what it means.
    Synonym,
    /// The pipeline gives it, or the shader does not use it.
    Fixed,
}

/// A line of a shader in which a mistake is made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MistakePlace {
    /// The mistake's name.
    pub mistake: String,
    /// The line's number, from 1.
    pub line: usize,
    /// What stands there.
    pub code: String,
}
