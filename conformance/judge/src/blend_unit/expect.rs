//! What a blend unit should leave in a pixel, and what it may.
//!
//! *Float targets.* One ULP of the format for each conversion, factor, product and sum, in acceptance intervals of
//! [`Hardware`]. *Targets of 8 bits.* Source, constant and result are clamped to [0, 1]; what a unit that computes wide and
//! what one that computes narrow may give ([`lightmeter_arithmetic::fixed`]), rounded to either neighbour. *sRGB.* The
//! destination is decoded to half an encoded step, blended wide, and either neighbour stored; what passes through stays what it
//! was; alpha is linear.
//!
//! Layers chain: what may be left by one is what the next is blended over, so the bound grows as it must.

use super::pixel::{self, Units, step_above, step_below};
use super::policy::promises_nothing;
use super::rules::{Clamp, Rules};
use lightmeter_arithmetic::fixed::{Narrow, Unit, Wide};
use lightmeter_arithmetic::{Accept, F16, F32, Fixed, Format, Hardware, Profile};
use lightmeter_catalogue::cases::blend::{Program, UnitCase};
use lightmeter_reference::blend::{Operands, masked};
use lightmeter_reference::{Real, Rgba, Vector};
use lightmeter_scene::blend::{Separate, WriteMask};
use lightmeter_scene::target::{Encoding, TargetFormat};

/// The reference and the legal values of a pixel, in its target's units. From −∞ to ∞ anything is legal, NaN included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedPixel {
    /// What the formula gives, not rounded.
    pub reference: Units,
    /// The least legal value.
    pub low: Units,
    /// The greatest.
    pub high: Units,
}

/// Steps this near to a whole number are that number: f64 cannot tell 255·(k/255) from k.
const SNAP: f64 = 1e-9;
/// How far the decoding of a stored sRGB component may err, in encoded steps.
const DECODING: f64 = 0.5;

/// In the place of a constant that a state does not read.
const UNREAD: Rgba<f64> = Vector([0.0; 4]);

/// How far a binary32 unit may err in encoding, in steps: a power of relative error 2⁻²⁰ or so.
const ENCODING: f64 = 1.0 / 1024.0;

/// What a case should give on a target, by rules that may be faulty, and what a profile makes legal there.
#[must_use]
pub fn expect(
    program: Program,
    target: TargetFormat,
    case: &UnitCase,
    rules: &Rules,
    profile: &Profile,
) -> ExpectedPixel {
    let (case, target) = (&rules.case(case), rules.target(target));
    let encoding = target.encoding();
    let start = pixel::stored(encoding, case.dst);
    let reference = reference(program, target, case, rules, start);
    let (low, high) = match encoding {
        Encoding::Float32 => profile.scope(|| legal_on_floats::<F32>(program, case, rules, start)),
        Encoding::Float16 => profile.scope(|| legal_on_floats::<F16>(program, case, rules, start)),
        Encoding::Unorm8 | Encoding::Srgb8 => legal_in_steps(program, encoding, case, rules, start),
    };
    let mut expected = ExpectedPixel { reference, low, high };
    if program.is_special() {
        for k in (0..4).filter(|&k| promises_nothing(case, k)) {
            (expected.low[k], expected.high[k]) = (f64::NEG_INFINITY, f64::INFINITY);
        }
    }
    expected
}

fn reference(program: Program, target: TargetFormat, case: &UnitCase, rules: &Rules, start: Units) -> Units {
    let (encoding, clamps) = (target.encoding(), rules.clamps(target));
    let mut below = by_component(|k| pixel::linear(encoding, rules.stored_as(k), start[k]));
    let operand = |color: [f32; 4]| {
        by_component(|k| if clamps == Clamp::Operands { f64::from(color[k]).clamp(0.0, 1.0) } else { color[k].into() })
    };
    for number in 0..case.layers {
        let (state, mask) = program.layer(number);
        let state = rules.state(state);
        let constant = if rules.reads_constant(state) { operand(case.constant) } else { UNREAD };
        let of = Operands { src: operand(case.sources[number]), dst: below, constant };
        let blended = rules.blend(state, &of);
        let result = if clamps == Clamp::Nothing { blended } else { blended.map(|c| c.clamp(0.0, 1.0)) };
        below = masked(rules.mask(mask), result, below);
    }
    by_component(|k| pixel::units(encoding, rules.stored_as(k), below[k])).0
}

/// What a pixel of the target may hold after a draw, in the target's units: from the source's and from what was there.
///
/// `None` for no blending: the source is stored, which is a conversion alone. Floats are blended by the profile in force: call
/// this inside [`Profile::scope`].
#[must_use]
pub fn over(
    target: TargetFormat,
    state: Option<Separate>,
    source: Between,
    constant: [f32; 4],
    (low, high): (Units, Units),
) -> (Units, Units) {
    let constant = constant.map(|c| (c.into(), c.into()));
    match target.encoding() {
        Encoding::Float32 => on_floats::<F32>(state, source, constant, (low, high)),
        Encoding::Float16 => on_floats::<F16>(state, source, constant, (low, high)),
        Encoding::Unorm8 | Encoding::Srgb8 => {
            let mut pixel = (low, high);
            match state {
                Some(state) => {
                    layer_in_steps(
                        target.encoding(),
                        &Rules::RIGHT,
                        (state, WriteMask::ALL),
                        source,
                        constant,
                        &mut pixel,
                    );
                }
                None => {
                    for (k, (low, high)) in source.into_iter().enumerate() {
                        (pixel.0[k], pixel.1[k]) =
                            steps(target.encoding(), k, low.clamp(0.0, 1.0), high.clamp(0.0, 1.0));
                    }
                }
            }
            pixel
        }
    }
}

/// A colour that is known to lie between two.
pub type Between = [(f64, f64); 4];

fn on_floats<F: Format>(
    state: Option<Separate>,
    source: Between,
    constant: Between,
    (low, high): (Units, Units),
) -> (Units, Units) {
    let number = |(low, high): (f64, f64)| Accept::<Hardware<F>>::from_bounds(low, high);
    let src = Vector(source.map(number));
    let left = match state {
        Some(state) => {
            let dst = by_component(|k| number((low[k], high[k])));
            Rules::RIGHT
                .blend(Rules::RIGHT.state(state), &Operands { src, dst, constant: Vector(constant.map(number)) })
        }
        None => src,
    };
    (left.0.map(|c| c.low()), left.0.map(|c| c.high()))
}

fn legal_on_floats<F: Format>(program: Program, case: &UnitCase, rules: &Rules, start: Units) -> (Units, Units) {
    let input = |color: [f32; 4]| Vector(color.map(Accept::<Hardware<F>>::input));
    let mut below = Vector(start.map(|c| if c.is_nan() { Accept::ANY } else { Accept::exactly(c) }));
    for number in 0..case.layers {
        let (state, mask) = program.layer(number);
        let state = rules.state(state);
        let constant =
            if rules.reads_constant(state) { input(case.constant) } else { Vector([Accept::exactly(0.0); 4]) };
        let of = Operands { src: input(case.sources[number]), dst: below, constant };
        let mut blended = rules.blend(state, &of);
        if rules.clamp == Clamp::Result {
            blended = blended.map(|c| c.clamp(Accept::exactly(0.0), Accept::exactly(1.0)));
        }
        below = masked(rules.mask(mask), blended, below);
    }
    (below.0.map(|c| c.low()), below.0.map(|c| c.high()))
}

fn legal_in_steps(
    program: Program,
    encoding: Encoding,
    case: &UnitCase,
    rules: &Rules,
    start: Units,
) -> (Units, Units) {
    let mut pixel = (start, start);
    let exactly = |color: [f32; 4]| color.map(|c| (c.into(), c.into()));
    for number in 0..case.layers {
        let (source, constant) = (exactly(case.sources[number]), exactly(case.constant));
        layer_in_steps(encoding, rules, program.layer(number), source, constant, &mut pixel);
    }
    pixel
}

/// One layer on a target of 8 bits.
fn layer_in_steps(
    encoding: Encoding,
    rules: &Rules,
    (state, mask): (Separate, WriteMask),
    source: Between,
    constant: Between,
    (low, high): &mut (Units, Units),
) {
    let encoded = |k: usize| is_encoded(encoding, rules.stored_as(k));
    // What is stored is read exactly, but for the decoding of sRGB.
    let before = by_component(|k| {
        let slack = if encoded(k) { DECODING } else { 0.0 };
        let at = |steps: f64| pixel::linear(encoding, rules.stored_as(k), steps.clamp(0.0, 255.0));
        let (least, most) = (low[k] - slack, high[k] + slack);
        let from = at(least);
        (from, if most > least { at(most) } else { from })
    });
    let state = rules.state(state);
    let operand = |color: Between| match rules.clamp {
        Clamp::Operands => color.map(|(low, high)| (low.clamp(0.0, 1.0), high.clamp(0.0, 1.0))),
        Clamp::Nothing | Clamp::Result => color,
    };
    let source = operand(source);
    let constant = rules.reads_constant(state).then(|| operand(constant));
    let wide = blended::<Wide>(rules, state, source, constant, before);
    let narrow = blended::<Narrow>(rules, state, source, constant, before);
    for k in (0..4).filter(|&k| rules.mask(mask).0[k]) {
        // What passes through, times 1 or taken by MIN or MAX, is what it was.
        if encoded(k) && (wide[k].low(), wide[k].high()).eq(&before[k]) {
            continue;
        }
        (low[k], high[k]) = steps(encoding, rules.stored_as(k), wide[k].low(), wide[k].high());
        if !encoded(k) {
            let at = |linear: f64| pixel::units(encoding, rules.stored_as(k), linear);
            let (least, most) = (step_above(at(narrow[k].low()) - SNAP), step_below(at(narrow[k].high()) + SNAP));
            if least <= most {
                low[k] = low[k].min(least);
                high[k] = high[k].max(most);
            }
        }
    }
}

const fn is_encoded(encoding: Encoding, stored_as: usize) -> bool {
    matches!(encoding, Encoding::Srgb8) && stored_as < 3
}

/// Either neighbour among the steps, of every value between two.
fn steps(encoding: Encoding, stored_as: usize, low: f64, high: f64) -> (f64, f64) {
    let at = |linear: f64| pixel::units(encoding, stored_as, linear);
    // A step that is met but for f64's own rounding is that step; in sRGB's powers a device errs by more.
    let near = if is_encoded(encoding, stored_as) { -ENCODING } else { SNAP };
    (whole_step_below(at(low) + near), whole_step_above(at(high) - near))
}

/// The greatest of the steps from 0 to 255 that is no greater; 0 where there is none.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a conversion stays within the steps")]
fn whole_step_below(steps: f64) -> f64 {
    f64::from(steps as u8)
}

/// The least of the steps from 0 to 255 that is no less; 255 where there is none.
fn whole_step_above(steps: f64) -> f64 {
    let below = whole_step_below(steps);
    if below < steps && below < 255.0 { below + 1.0 } else { below }
}

fn blended<U: Unit>(
    rules: &Rules,
    state: Separate,
    source: Between,
    constant: Option<Between>,
    before: Rgba<(f64, f64)>,
) -> Rgba<Fixed<U>> {
    let operand = |(low, high): (f64, f64)| match rules.clamp {
        Clamp::Operands => Fixed::operand_between(low, high),
        Clamp::Nothing | Clamp::Result => Fixed::between(low, high),
    };
    let of = Operands {
        src: by_component(|k| operand(source[k])),
        dst: by_component(|k| Fixed::between(before[k].0, before[k].1)),
        constant: constant.map_or(Vector([Fixed::between(0.0, 0.0); 4]), |constant| Vector(constant.map(operand))),
    };
    rules.blend(state, &of).map(Fixed::within_unit)
}

fn by_component<T>(f: impl Fn(usize) -> T) -> Rgba<T> {
    Vector(std::array::from_fn(f))
}

#[cfg(test)]
mod tests {
    use super::super::embedded;
    use super::super::rules::FAULTS;
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::cases::blend::{MOST_LAYERS, Program};
    use lightmeter_scene::blend::{Equation, Factor, State};

    #[test]
    fn a_constant_is_read_wherever_the_rules_read_it() {
        let color = [0.5, 0.25, 0.75, 1.0];
        let case = UnitCase { sources: [color; MOST_LAYERS], layers: 1, dst: [0.75; 4], constant: [0.5; 4] };
        let rules = std::iter::once(&Rules::RIGHT).chain(FAULTS.iter().map(|fault| &fault.rules));
        for rules in rules.filter(|rules| rules.stores_as() == super::super::rules::Store::Nearest) {
            for equation in Equation::ALL {
                for src in [Factor::One, Factor::ConstantColor, Factor::OneMinusConstantAlpha] {
                    let state = State { equation, src, dst: Factor::ConstantAlpha };
                    let program = Program::Draw(state.into(), WriteMask::ALL);
                    let expected = expect(program, TargetFormat::Rgba32Float, &case, rules, &WGSL);
                    let drawn = embedded::blend(program, TargetFormat::Rgba32Float, &case, rules);
                    for (k, drawn) in drawn.into_iter().enumerate() {
                        assert!((drawn - expected.reference[k]).abs() < 1e-6, "{state}: {drawn}, {expected:?}");
                        assert!(
                            (expected.low[k]..=expected.high[k]).contains(&drawn),
                            "{state}: {drawn}, {expected:?}"
                        );
                    }
                }
            }
        }
    }
}
