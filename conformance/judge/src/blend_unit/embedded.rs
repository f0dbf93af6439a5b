//! A blend unit in f32 on this processor: judged like any other, needs no driver, and takes the faults.
//!
//! It shares the formulas with the reference, so it proves nothing about them.

use super::pixel::{self, Units};
use super::rules::{Clamp, Rules, Store};
use half::f16;
use lightmeter_catalogue::cases::blend::{Program, UnitCase};
use lightmeter_reference::blend::{Operands, masked};
use lightmeter_reference::color::{srgb_decode, srgb_encode};
use lightmeter_reference::{Rgba, Vector};
use lightmeter_scene::target::{Encoding, TargetFormat};

/// What a case leaves on a target.
#[must_use]
pub fn blend(program: Program, target: TargetFormat, case: &UnitCase, rules: &Rules) -> Units {
    let (case, target) = (&rules.case(case), rules.target(target));
    let clamps = rules.clamps(target);
    let operand =
        |color: [f32; 4]| Vector(color.map(|c| if clamps == Clamp::Operands { c.clamp(0.0, 1.0) } else { c }));
    let encoding = target.encoding();
    let mut below = pixel::stored(encoding, case.dst);
    for number in 0..case.layers {
        let (state, mask) = program.layer(number);
        let dst: Rgba<f32> = Vector(std::array::from_fn(|k| decoded(encoding, rules.stored_as(k), below[k])));
        let of = Operands { src: operand(case.sources[number]), dst, constant: operand(case.constant) };
        let blended = rules.blend(rules.state(state), &of);
        let result = if clamps == Clamp::Nothing { blended } else { blended.map(|c| c.clamp(0.0, 1.0)) };
        let written: Units =
            std::array::from_fn(|k| store(encoding, rules.stored_as(k), result[k], rules.store_in(state, k)));
        below = masked(rules.mask(mask), Vector(written), Vector(below)).0;
    }
    below
}

#[expect(clippy::cast_possible_truncation, reason = "this unit computes in f32")]
fn decoded(encoding: Encoding, component: usize, units: f64) -> f32 {
    match encoding {
        Encoding::Float32 | Encoding::Float16 => units as f32,
        Encoding::Srgb8 if component < 3 => srgb_decode(units as f32 / 255.0),
        Encoding::Unorm8 | Encoding::Srgb8 => units as f32 / 255.0,
    }
}

fn store(encoding: Encoding, component: usize, c: f32, store: Store) -> f64 {
    match encoding {
        Encoding::Float32 => c.into(),
        Encoding::Float16 => f16::from_f32(c).into(),
        Encoding::Srgb8 if component < 3 => store.step((255.0 * srgb_encode(c)).into()),
        Encoding::Unorm8 | Encoding::Srgb8 => store.step((255.0 * c).into()),
    }
}
