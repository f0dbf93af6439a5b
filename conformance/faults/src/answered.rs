//! A renderer's answers, as they are diagnosed.

/// A renderer's answer to one case.
#[derive(Clone, Copy, Debug)]
pub struct Answered<'a> {
    /// The case's inputs.
    pub inputs: &'a [f32],
    /// What the renderer answered.
    pub values: &'a [f32],
    /// Whether a verdict on it failed.
    pub is_wrong: bool,
}
