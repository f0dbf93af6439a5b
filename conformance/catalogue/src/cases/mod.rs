//! What is judged: the formulas by family, their inputs and outputs, and the cases drawn from them.
//!
//! A family has a file here, and files of the same stem in `reference/src`, `gpu/src/shaders` and `tests/properties`.

pub mod attenuation;
pub mod blend;
pub mod color;
pub mod depth;
pub mod fog;
pub mod interpolation;
pub mod lighting;
pub mod vector;

mod boundary;
mod common;
mod draw;
mod fit;
pub mod formula;
mod meaning;
mod partial;
mod pattern;
mod program;
mod rasteriser;
mod rows;
mod rule;
mod spec;

pub use boundary::{Boundaries, DRAWN, boundary_cases, boundary_name, boundary_names};
pub use common::{CommonCases, Lacking, Side, Surface, and_common, beyond, colors, given_beyond, given_placed, placed};
pub use draw::{Drawing, GENERATOR_VERSION, mix, move_by_ulps};
pub use formula::{AnyFormula, Formula, Visitor};
pub use partial::Partial;
pub use rows::{FromNumbers, Reader, Slot, Wanted, Writer, slot};
pub use spec::{Domain, Hard, Input, Kind, Naive, Output, Size, Spec, Stable, Stage, ValueShape, Values};

/// The families, in the order of reports.
pub const FAMILIES: [&str; 8] =
    ["interpolation", "color", "vector", "lighting", "attenuation", "fog", "depth", "blend"];

/// Shows every formula of every family to a visitor, which may then evaluate it in an arithmetic of its own.
pub fn visit(visitor: &mut impl Visitor) {
    interpolation::visit(visitor);
    color::visit(visitor);
    vector::visit(visitor);
    lighting::visit(visitor);
    attenuation::visit(visitor);
    fog::visit(visitor);
    depth::visit(visitor);
    blend::visit(visitor);
}

/// Shows every formula to a visitor, with some of the many states that are separate for alpha.
pub fn visit_all(samples: &blend::Samples, visitor: &mut impl Visitor) {
    visit(visitor);
    blend::visit_separate(samples, visitor);
}

/// Every formula, evaluable in the arithmetics of the suite, with some of the many states that are separate for alpha.
#[must_use]
pub fn all(samples: &blend::Samples) -> Vec<Box<dyn AnyFormula>> {
    struct Collect(Vec<Box<dyn AnyFormula>>);
    impl Visitor for Collect {
        fn formula<F: Formula>(&mut self, formula: F) {
            self.0.push(Box::new(formula));
        }
    }
    let mut collect = Collect(vec![]);
    visit_all(samples, &mut collect);
    collect.0
}
