//! A pixel of a target in the target's own units: values where it holds floats, steps from 0 to 255 where it holds 8 bits.

use half::f16;
use lightmeter_reference::color::{srgb_decode, srgb_encode};
use lightmeter_scene::target::{Encoding, TargetFormat};
use std::sync::LazyLock;

/// Red, green, blue and alpha in the target's units.
pub type Units = [f64; 4];

/// A colour as a target holds it from the start: the nearest that it can hold. A step of an sRGB target is the encoded one.
#[must_use]
pub fn stored(encoding: Encoding, color: [f32; 4]) -> Units {
    color.map(|c| match encoding {
        Encoding::Float32 => c.into(),
        Encoding::Float16 => f16::from_f32(c).into(),
        Encoding::Unorm8 | Encoding::Srgb8 => nearest_step(255.0 * f64::from(c.clamp(0.0, 1.0))),
    })
}

/// The nearest whole number, the even one of two, for a number of steps: where a sum's last place is 1, it rounds so by itself. The function
/// of the standard library is a call on processors that may lack an instruction for it.
pub(super) fn nearest_step(steps: f64) -> f64 {
    const LAST_PLACE_IS_1: f64 = 1.5 * 4_503_599_627_370_496.0;
    (steps + LAST_PLACE_IS_1) - LAST_PLACE_IS_1
}

/// The whole number below a number of steps, by the same way.
pub(super) fn step_below(steps: f64) -> f64 {
    let nearest = nearest_step(steps);
    if nearest > steps { nearest - 1.0 } else { nearest }
}

/// The whole number above a number of steps.
pub(super) fn step_above(steps: f64) -> f64 {
    let nearest = nearest_step(steps);
    if nearest < steps { nearest + 1.0 } else { nearest }
}

/// The value that a component is blended as, for steps that need not be whole.
#[must_use]
pub fn linear(encoding: Encoding, component: usize, units: f64) -> f64 {
    match encoding {
        Encoding::Float32 | Encoding::Float16 => units,
        Encoding::Srgb8 if component < 3 => decoded(units),
        Encoding::Unorm8 | Encoding::Srgb8 => units / 255.0,
    }
}

/// A step of an sRGB target, decoded. Most are whole steps and halves between them, which are decoded once.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what is no place of the table is none as a whole number"
)]
fn decoded(steps: f64) -> f64 {
    const HALVES: u16 = 2 * 255 + 1;
    static TABLE: LazyLock<Vec<f64>> =
        LazyLock::new(|| (0..HALVES).map(|half| srgb_decode(f64::from(half) * 0.5 / 255.0)).collect());
    let half = (2.0 * steps) as u16;
    let is_there = f64::from(half).to_bits() == (2.0 * steps).to_bits();
    match TABLE.get(usize::from(half)) {
        Some(&decoded) if is_there => decoded,
        _ => srgb_decode(steps / 255.0),
    }
}

/// The inverse of [`linear`]: a blended value in the target's units, not rounded.
#[must_use]
pub fn units(encoding: Encoding, component: usize, linear: f64) -> f64 {
    match encoding {
        Encoding::Float32 | Encoding::Float16 => linear,
        Encoding::Srgb8 if component < 3 => 255.0 * srgb_encode(linear),
        Encoding::Unorm8 | Encoding::Srgb8 => 255.0 * linear,
    }
}

/// Appends a stored pixel in the target's bits.
pub fn write(target: TargetFormat, pixel: Units, bytes: &mut Vec<u8>) {
    let [r, g, b, a] = pixel;
    for c in if target.is_blue_first() { [b, g, r, a] } else { [r, g, b, a] } {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a stored component fits its format"
        )]
        match target.encoding() {
            Encoding::Float32 => bytes.extend((c as f32).to_ne_bytes()),
            Encoding::Float16 => bytes.extend(f16::from_f64(c).to_ne_bytes()),
            Encoding::Unorm8 | Encoding::Srgb8 => bytes.push(c as u8),
        }
    }
}

/// The pixel of a number in a target's bits.
///
/// # Panics
/// Where there are fewer pixels.
#[must_use]
pub fn read(target: TargetFormat, bytes: &[u8], number: usize) -> Units {
    let size = target.component_bytes();
    let component = |k: usize| {
        let at = (4 * number + k) * size;
        match (target.encoding(), &bytes[at..at + size]) {
            (Encoding::Float32, &[a, b, c, d]) => f32::from_ne_bytes([a, b, c, d]).into(),
            (Encoding::Float16, &[a, b]) => f16::from_ne_bytes([a, b]).into(),
            (_, bytes) => f64::from(bytes[0]),
        }
    };
    let [first, g, third, a] = [component(0), component(1), component(2), component(3)];
    if target.is_blue_first() { [third, g, first, a] } else { [first, g, third, a] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_read_back_as_they_were_written() {
        for target in TargetFormat::ALL {
            let pixel = stored(target.encoding(), [0.25, 1.5, -0.5, 1.0]);
            let mut bytes = vec![];
            write(target, [0.0; 4], &mut bytes);
            write(target, pixel, &mut bytes);
            assert_eq!(bytes.len(), 8 * target.component_bytes());
            assert_eq!(read(target, &bytes, 1).map(f64::to_bits), pixel.map(f64::to_bits), "{}", target.name());
        }
        assert_eq!(
            stored(Encoding::Unorm8, [0.25, 1.5, -0.5, 1.0]).map(f64::to_bits),
            [64.0, 255.0, 0.0, 255.0].map(f64::to_bits)
        );
    }

    #[test]
    fn steps_are_those_of_the_standard_library() {
        for half in -2..=512 {
            let steps = f64::from(half) / 2.0;
            for steps in [steps, steps.next_down(), steps.next_up()] {
                assert!((nearest_step(steps) - steps.round_ties_even()).abs() <= 0.0, "{steps}");
                assert!((step_below(steps) - steps.floor()).abs() <= 0.0, "{steps}");
                assert!((step_above(steps) - steps.ceil()).abs() <= 0.0, "{steps}");
            }
        }
    }

    #[test]
    fn blue_stands_first_where_the_format_says_so() {
        let first = |target| {
            let mut bytes = vec![];
            write(target, [1.0, 2.0, 3.0, 4.0], &mut bytes);
            bytes
        };
        assert_eq!(first(TargetFormat::Rgba8Unorm), [1, 2, 3, 4]);
        assert_eq!(first(TargetFormat::Bgra8Unorm), [3, 2, 1, 4]);
    }

    #[test]
    fn units_undo_linear() {
        for target in TargetFormat::ALL {
            for step in 0..=255 {
                let (there, component) = (f64::from(step), usize::try_from(step % 4).expect("small"));
                let encoding = target.encoding();
                let back = units(encoding, component, linear(encoding, component, there));
                assert!((back - there).abs() < 1e-3, "{}: {there} {back}", target.name());
            }
        }
    }
}
