//! The numbers that go into a formula and come out of it.

use lightmeter_catalogue::cases::Spec;

/// The inputs of a case, by their names. All numbers are f32; a matrix is a list of its columns.
#[derive(Clone, Copy, Debug)]
pub struct FormulaInputs<'a> {
    spec: &'a Spec,
    row: &'a [f32],
}

impl<'a> FormulaInputs<'a> {
    pub(crate) const fn new(spec: &'a Spec, row: &'a [f32]) -> Self {
        Self { spec, row }
    }

    /// The formula's id.
    #[must_use]
    pub fn formula(&self) -> &'a str {
        &self.spec.id
    }

    /// The numbers of an input, as they stand in a row.
    ///
    /// # Panics
    /// Where the formula has no input of the name.
    #[must_use]
    pub fn numbers(&self, name: &str) -> &'a [f32] {
        match self.spec.place(name) {
            Some(place) => &self.row[place],
            None => {
                let names: Vec<&str> = self.spec.inputs.iter().map(|input| input.name).collect();
                panic!("{} has no input `{name}`; its inputs are {}", self.spec.id, names.join(", "))
            }
        }
    }

    fn array<const N: usize>(&self, name: &str, kind: &str) -> [f32; N] {
        let numbers = self.numbers(name);
        numbers
            .try_into()
            .unwrap_or_else(|_| panic!("{}: `{name}` has {} numbers, and {kind} has {N}", self.spec.id, numbers.len()))
    }

    /// An input of one number.
    ///
    /// # Panics
    /// Where the formula has no input of the name, or one of several numbers.
    #[must_use]
    pub fn float(&self, name: &str) -> f32 {
        self.array::<1>(name, "a float")[0]
    }

    /// An input of two numbers.
    ///
    /// # Panics
    /// Where the formula has no input of the name, or one of another shape.
    #[must_use]
    pub fn vec2(&self, name: &str) -> [f32; 2] {
        self.array(name, "a vec2")
    }

    /// An input of three numbers: a point, a direction, a colour without alpha.
    ///
    /// # Panics
    /// Where the formula has no input of the name, or one of another shape.
    #[must_use]
    pub fn vec3(&self, name: &str) -> [f32; 3] {
        self.array(name, "a vec3")
    }

    /// An input of four numbers.
    ///
    /// # Panics
    /// Where the formula has no input of the name, or one of another shape.
    #[must_use]
    pub fn vec4(&self, name: &str) -> [f32; 4] {
        self.array(name, "a vec4")
    }

    /// The columns of a matrix of three by three.
    ///
    /// # Panics
    /// Where the formula has no input of the name, or one of another shape.
    #[must_use]
    pub fn mat3(&self, name: &str) -> [[f32; 3]; 3] {
        let all: [f32; 9] = self.array(name, "a mat3");
        [0, 1, 2].map(|column| [0, 1, 2].map(|row| all[3 * column + row]))
    }

    /// The columns of a matrix of four by four.
    ///
    /// # Panics
    /// Where the formula has no input of the name, or one of another shape.
    #[must_use]
    pub fn mat4(&self, name: &str) -> [[f32; 4]; 4] {
        let all: [f32; 16] = self.array(name, "a mat4");
        [0, 1, 2, 3].map(|column| [0, 1, 2, 3].map(|row| all[4 * column + row]))
    }
}

/// The outputs of a formula, in the order of its description: a number, an array, or several of these one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FormulaOutputs(pub(crate) Vec<f32>);

impl From<f32> for FormulaOutputs {
    fn from(x: f32) -> Self {
        Self(vec![x])
    }
}

impl<const N: usize> From<[f32; N]> for FormulaOutputs {
    fn from(x: [f32; N]) -> Self {
        Self(x.into())
    }
}

impl From<Vec<f32>> for FormulaOutputs {
    fn from(x: Vec<f32>) -> Self {
        Self(x)
    }
}

impl<A: Into<Self>, B: Into<Self>> From<(A, B)> for FormulaOutputs {
    fn from((a, b): (A, B)) -> Self {
        Self([a.into().0, b.into().0].concat())
    }
}

impl<A: Into<Self>, B: Into<Self>, C: Into<Self>> From<(A, B, C)> for FormulaOutputs {
    fn from((a, b, c): (A, B, C)) -> Self {
        Self([a.into().0, b.into().0, c.into().0].concat())
    }
}
