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
mod rearranged;
mod vector;

use super::blend::Twist as Blended;
use super::fault::{Fault, Step};
use super::fog::Twist as Fogged;
use super::lighting::Twist as Lit;
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_scene::blend::{Factor, WriteMask};

/// All of them, in the order of tables.
pub(super) fn all() -> impl Iterator<Item = &'static Fault> {
    [
        naive::FAULTS,
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
    ]
    .into_iter()
    .flatten()
}

type Ways = &'static [&'static [Step]];

const fn fault(name: &'static str, says: &'static str, ways: Ways) -> Fault {
    Fault { name, says, seen_in: None, ways, only: everywhere }
}

impl Fault {
    const fn seen_in(self, seen_in: &'static str) -> Self {
        Self { seen_in: Some(seen_in), ..self }
    }

    const fn only(self, only: fn(&Spec) -> bool) -> Self {
        Self { only, ..self }
    }
}

const fn lit(twist: Lit) -> Step {
    Step::Lighting(twist)
}

const fn fogged(twist: Fogged) -> Step {
    Step::Fog(twist)
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
