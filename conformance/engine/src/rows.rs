//! Rows of inputs, as a stage takes them.

use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_scene::depth::DepthTest;

/// Rows of inputs of one group, and whose they are.
pub struct Rows<'a> {
    /// The formulas of the group.
    pub members: &'a [&'a Member],
    /// For each case, its formula's place among the members.
    pub of: &'a [usize],
    /// The cases themselves, where they are of the catalogue.
    pub cases: &'a [CaseRef],
    /// The inputs, row after row.
    pub inputs: &'a [f32],
    /// The same with selectors before each row, for the shaders.
    pub selected: &'a [f32],
    /// Numbers of a row of outputs.
    pub outputs: usize,
}

impl Rows<'_> {
    /// The depth test of a formula, by its place among the members.
    ///
    /// # Panics
    /// Where the formula is no depth test.
    #[must_use]
    pub fn depth_test(&self, member: usize) -> DepthTest {
        let Kind::Depth(test) = self.members[member].spec.kind else {
            unreachable!("only depth tests reach the depth test")
        };
        test
    }

    /// Numbers of a row of inputs.
    #[must_use]
    pub fn stride(&self) -> usize {
        self.inputs.len() / self.of.len()
    }
}
