//! A row that is kept whole where it is judged: what was asked, what was answered, and what is right and legal of it.

use lightmeter_arithmetic::Accept;
use lightmeter_catalogue::select::CaseRef;

/// A case's inputs, the answer to it, and of each output the reference and what is legal.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptRow {
    /// The inputs.
    pub inputs: Vec<f32>,
    /// What was answered, bit for bit.
    pub values: Vec<f32>,
    /// The f64 reference.
    pub reference: Vec<f64>,
    /// What is legal.
    pub legal: Vec<Accept>,
}

impl KeptRow {
    /// It as the answer to a case.
    #[must_use]
    pub fn answers(&self, case: CaseRef, is_wrong: bool) -> Answered<'_> {
        let Self { inputs, values, reference, legal } = self;
        Answered { case, inputs, values, reference, legal, is_wrong }
    }

    /// Whether the values are the same, to the bit.
    #[must_use]
    pub fn has_values_of(&self, other: &Self) -> bool {
        self.values.iter().map(|x| x.to_bits()).eq(other.values.iter().map(|x| x.to_bits()))
    }
}

/// An answer to one case.
#[derive(Clone, Copy, Debug)]
pub struct Answered<'a> {
    /// Which case of the formula it is.
    pub case: CaseRef,
    /// The case's inputs.
    pub inputs: &'a [f32],
    /// What was answered.
    pub values: &'a [f32],
    /// The f64 reference of each output.
    pub reference: &'a [f64],
    /// What is legal of each output.
    pub legal: &'a [Accept],
    /// Whether a verdict on it failed.
    pub is_wrong: bool,
}

impl Answered<'_> {
    /// Whether the number of an output is legal.
    #[must_use]
    pub fn is_right(&self, output: usize) -> bool {
        self.legal[output].contains(self.values[output].into())
    }

    /// Whether its inputs were drawn, and are none that a formula is hard for.
    #[must_use]
    pub const fn is_random(&self) -> bool {
        matches!(self.case, CaseRef::Random(_))
    }
}
