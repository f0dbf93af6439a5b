//! A formula of whose outputs only some are given: of the others nothing is promised.

use super::formula::AnyFormula;
use super::rows::Wanted;
use super::spec::Spec;
use lightmeter_arithmetic::mistaken::Mistaken;
use lightmeter_arithmetic::{Accept, Dual, RandomLegal, Trace};

/// A formula whose other outputs may be anything.
pub struct Partial {
    /// The whole formula.
    pub formula: Box<dyn AnyFormula>,
    /// Whether each number of its outputs is given.
    pub given: Vec<bool>,
}

impl Partial {
    fn free<'a, T>(&'a self, out: &'a mut [T]) -> impl Iterator<Item = &'a mut T> {
        out.iter_mut().zip(&self.given).filter(|(_, is_given)| !**is_given).map(|(out, _)| out)
    }
}

impl AnyFormula for Partial {
    fn spec(&self) -> Spec {
        self.formula.spec()
    }

    fn on_f64(&self, inputs: &[f64], wanted: Wanted, out: &mut [f64]) {
        self.formula.on_f64(inputs, wanted, out);
    }

    fn on_f32(&self, inputs: &[f32], wanted: Wanted, out: &mut [f32]) {
        self.formula.on_f32(inputs, wanted, out);
    }

    fn on_accept(&self, inputs: &[Accept], wanted: Wanted, out: &mut [Accept]) {
        self.formula.on_accept(inputs, wanted, out);
        self.free(out).for_each(|out| *out = Accept::ANY);
    }

    fn on_draw(&self, inputs: &[RandomLegal], out: &mut [RandomLegal]) {
        self.formula.on_draw(inputs, out);
    }

    fn on_trace(&self, inputs: &[Trace], out: &mut [Trace]) {
        self.formula.on_trace(inputs, out);
    }

    fn on_dual(&self, inputs: &[Dual], out: &mut [Dual]) {
        self.formula.on_dual(inputs, out);
    }

    fn on_mistaken_f64(&self, inputs: &[Mistaken<f64>], out: &mut [Mistaken<f64>]) {
        self.formula.on_mistaken_f64(inputs, out);
    }

    fn on_mistaken_f32(&self, inputs: &[Mistaken<f32>], out: &mut [Mistaken<f32>]) {
        self.formula.on_mistaken_f32(inputs, out);
    }

    fn on_mistaken_accept(&self, inputs: &[Mistaken<Accept>], out: &mut [Mistaken<Accept>]) {
        self.formula.on_mistaken_accept(inputs, out);
        self.free(out).for_each(|out| *out = Mistaken(Accept::ANY));
    }
}
