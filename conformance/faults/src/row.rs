//! A row of inputs by name, in any arithmetic.

use lightmeter_arithmetic::{Accept, RandomLegal};
use lightmeter_catalogue::cases::{AnyFormula, Spec, Wanted};
use lightmeter_reference::{Mat3, Mat4, Real, Vector};

/// An arithmetic that the formulas of the catalogue can be evaluated in once their types are forgotten.
pub trait Arithmetic: Real {
    /// The formula's outputs for a row of inputs.
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Self], out: &mut [Self]);
}

impl Arithmetic for f64 {
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Self], out: &mut [Self]) {
        formula.on_f64(inputs, Wanted::ALL, out);
    }
}

impl Arithmetic for f32 {
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Self], out: &mut [Self]) {
        formula.on_f32(inputs, Wanted::ALL, out);
    }
}

impl Arithmetic for Accept {
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Self], out: &mut [Self]) {
        formula.on_accept(inputs, Wanted::ALL, out);
    }
}

impl Arithmetic for RandomLegal {
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Self], out: &mut [Self]) {
        formula.on_draw(inputs, out);
    }
}

/// A formula's inputs by name.
#[derive(Clone, Copy, Debug)]
pub(super) struct InputRow<'a, R> {
    spec: &'a Spec,
    numbers: &'a [R],
}

impl<'a, R: Real> InputRow<'a, R> {
    pub(super) const fn new(spec: &'a Spec, numbers: &'a [R]) -> Self {
        Self { spec, numbers }
    }

    /// An input of `N` numbers; `None` where the formula has none of that name and size.
    pub(super) fn array<const N: usize>(&self, name: &str) -> Option<[R; N]> {
        self.numbers.get(self.spec.place(name)?)?.try_into().ok()
    }

    /// Whether the formula says that it normalises what it gives.
    pub(super) fn is_normalised(&self) -> bool {
        self.spec.is_normalised
    }

    pub(super) fn scalar(&self, name: &str) -> Option<R> {
        self.array(name).map(|[x]| x)
    }

    pub(super) fn vector<const N: usize>(&self, name: &str) -> Option<Vector<R, N>> {
        self.array(name).map(Vector)
    }

    pub(super) fn mat3(&self, name: &str) -> Option<Mat3<R>> {
        let m = self.array::<9>(name)?;
        Some(Mat3([0, 3, 6].map(|k| Vector([m[k], m[k + 1], m[k + 2]]))))
    }

    pub(super) fn mat4(&self, name: &str) -> Option<Mat4<R>> {
        let m = self.array::<16>(name)?;
        Some(Mat4([0, 4, 8, 12].map(|k| Vector([m[k], m[k + 1], m[k + 2], m[k + 3]]))))
    }
}

/// Puts a vector on a row of outputs, as far as that goes.
pub(super) fn put<R: Copy, const N: usize>(out: &mut [R], at: usize, v: Vector<R, N>) {
    for (to, x) in out.iter_mut().skip(at).zip(v.0) {
        *to = x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::formulas;

    #[test]
    fn inputs_are_found_by_name_and_size() {
        let member = formulas().iter().find(|member| member.spec.id == "fog/linear").expect("fog/linear");
        let numbers: Vec<f64> = (0..11).map(f64::from).collect();
        let row = InputRow::new(&member.spec, &numbers);
        assert_eq!((row.scalar("dmin"), row.scalar("p"), row.scalar("density")), (Some(3.0), None, None));
        assert_eq!(row.vector::<3>("shaded"), Some(Vector([8.0, 9.0, 10.0])));
    }
}
