//! The catalogue of mistakes, by family.

mod attenuation;
mod blend;
mod color;
mod depth;
mod fog;
mod interpolation;
mod lighting;
mod naive;
mod output;
mod precision;
mod rearranged;
mod vector;

use super::alteration::{At, Do, Form};
use super::blend::Twist as Blended;
use super::change::{After, Before};
use super::fault::{Fault, Step};
use super::op::Op;
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_scene::blend::{Factor, WriteMask};

/// All of them, in the order of tables.
pub(super) fn all() -> impl Iterator<Item = &'static Fault> {
    [
        lighting::FAULTS,
        attenuation::FAULTS,
        fog::FAULTS,
        output::FAULTS,
        rearranged::FAULTS,
        vector::FAULTS,
        interpolation::FAULTS,
        color::FAULTS,
        depth::FAULTS,
        blend::FAULTS,
        precision::FAULTS,
        naive::FAULTS,
    ]
    .into_iter()
    .flatten()
}

type Ways = &'static [&'static [Step]];

const fn fault(name: &'static str, says: &'static str, ways: Ways) -> Fault {
    Fault { name, says, seen_in: None, is_rounding: false, is_generated: false, ways, only: everywhere }
}

impl Fault {
    const fn seen_in(self, seen_in: &'static str) -> Self {
        Self { seen_in: Some(seen_in), ..self }
    }

    const fn rounding(self) -> Self {
        Self { is_rounding: true, ..self }
    }

    const fn only(self, only: fn(&Spec) -> bool) -> Self {
        Self { only, ..self }
    }
}

const fn input(name: &'static str, op: Op) -> Step {
    Step::Before(Before::On(name, op))
}

const fn output(name: &'static str, op: Op) -> Step {
    Step::After(After::On(name, op))
}

const fn colors(op: Op) -> Step {
    Step::After(After::Colors(op))
}

const fn at(step: &'static str, what: Do) -> Step {
    Step::At(At { step, what })
}

const fn result(step: &'static str, op: Op) -> Step {
    at(step, Do::Result(op))
}

const fn given(step: &'static str, name: &'static str, op: Op) -> Step {
    at(step, Do::Given(name, op))
}

const fn pass(step: &'static str, name: &'static str) -> Step {
    at(step, Do::Pass(name))
}

const fn pass_as(step: &'static str, name: &'static str, op: Op) -> Step {
    at(step, Do::PassAs(name, op))
}

const fn swap(step: &'static str, a: &'static str, b: &'static str) -> Step {
    at(step, Do::Swap(a, b))
}

const fn copy(step: &'static str, from: &'static str, to: &'static str) -> Step {
    at(step, Do::Copy(from, to))
}

const fn sum(step: &'static str, a: &'static str, b: &'static str) -> Step {
    at(step, Do::Sum(a, b))
}

const fn plus(step: &'static str, name: &'static str) -> Step {
    at(step, Do::Plus(name))
}

const fn times(step: &'static str, name: &'static str) -> Step {
    at(step, Do::Times(name))
}

const fn form(step: &'static str, form: Form) -> Step {
    at(step, Do::Form(form))
}

const fn blended(twist: Blended) -> Step {
    Step::Blend(twist)
}

const fn everywhere(_: &Spec) -> bool {
    true
}

fn in_lighting(spec: &Spec) -> bool {
    spec.family() == "lighting"
}

/// A fault of the output shows where a colour comes out that is not 0 throughout, nor kept from being written.
fn where_colors_are_drawn(spec: &Spec) -> bool {
    match spec.kind {
        Kind::Blend(Program::Draw(state, mask)) => {
            let is_zero = |s: lightmeter_scene::blend::State| {
                !s.equation.ignores_factors() && s.src == Factor::Zero && s.dst == Factor::Zero
            };
            mask == WriteMask::ALL && !is_zero(state.color)
        }
        Kind::Blend(Program::WithoutAlpha(_) | Program::Layers(_)) => true,
        _ => !is_encoded(spec),
    }
}

/// Formulas whose output is a code, or whose own fault it would be.
fn is_encoded(spec: &Spec) -> bool {
    ["color/srgb", "color/gamma", "color/from-unorm8", "blend/subtract"].iter().any(|id| spec.id.starts_with(id))
}
