//! A mistake that no plot shows, by numbers: the case at which it is farthest from what is right.

use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_faults::Variation;
use maud::{Markup, html};

/// Cases near a hard one that are tried.
const NEAR: u64 = 8;
/// Random cases that are tried.
const RANDOM: u64 = 500;

/// Pixels of a plot upwards.
const PIXELS: f64 = 90.0;

/// The case at which a mistake shows best in binary32.
pub(crate) struct Apart {
    case: String,
    output: String,
    right: f32,
    mistaken: f32,
}

/// The case at which a mistake is farthest from what is right, as a share of that; `None` where no case shows it.
pub(crate) fn apart(member: &Member, variation: &Variation<'_>) -> Option<Apart> {
    let outputs = member.spec.output_len();
    let (mut right, mut mistaken) = (vec![0.0_f32; outputs], vec![0.0_f32; outputs]);
    let near = if member.spec.hard.is_empty() { 0 } else { NEAR };
    let hard = (0..member.spec.hard.len())
        .flat_map(|place| std::iter::once(CaseRef::Hard(place)).chain((0..near).map(move |k| CaseRef::Near(place, k))));
    let mut best: Option<(f64, Apart)> = None;
    let usual = hard.chain((0..RANDOM).map(CaseRef::Random)).map(|case| (case, true));
    for (case, is_usual) in usual.chain((0..member.boundary()).map(|k| (CaseRef::Boundary(k), false))) {
        if !is_usual && best.is_some() {
            break;
        }
        let mut row = vec![];
        member.inputs(case, 1, &mut row);
        member.formula.embedded(&row, &mut right);
        variation.evaluate(&row, &mut mistaken);
        for (place, (&a, &b)) in right.iter().zip(&mistaken).enumerate() {
            let far = share(a, b);
            if far > best.as_ref().map_or(0.0, |(most, _)| *most) {
                let (case, output) = (member.case_id(case), member.spec.output_name(place));
                best = Some((far, Apart { case, output, right: a, mistaken: b }));
            }
        }
    }
    best.map(|(_, apart)| apart)
}

/// How far a number is from what is right, as a share of that.
fn share(right: f32, mistaken: f32) -> f64 {
    if right.is_nan() || right.to_bits() == mistaken.to_bits() {
        return 0.0;
    }
    let away = (f64::from(right) - f64::from(mistaken)).abs();
    if away.is_finite() { away / f64::from(right.abs().max(f32::MIN_POSITIVE)) } else { f64::MAX }
}

impl Apart {
    /// Whether the two numbers would be one in a plot that goes from 0 to the greater of them.
    fn is_below_a_pixel(&self) -> bool {
        let [right, mistaken] = [self.right, self.mistaken].map(f64::from);
        (right - mistaken).abs() < right.abs().max(mistaken.abs()) / PIXELS
    }

    /// In words.
    pub(crate) fn html(&self) -> Markup {
        html! {
            p.hint {
                @if self.is_below_a_pixel() { "The difference is too small for a plot. " }
                "At " code { (self.case) } ", " code { (self.output) } " is "
                code { (self.right) } " in binary32, and " code { (self.mistaken) } " with the mistake."
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Apart, share};

    #[test]
    fn a_plot_is_too_coarse_for_what_is_less_than_a_pixel_apart() {
        let apart = |right, mistaken| Apart { case: "a".into(), output: "f".into(), right, mistaken };
        let says = |right, mistaken| apart(right, mistaken).html().0.contains("too small for a plot");
        assert!(says(1.0, 1.001) && says(-0.5, -0.5001));
        assert!(!says(1.0, 0.5) && !says(0.0, 1e-30) && !says(0.0, f32::NAN) && !says(1.0, f32::INFINITY));
    }

    #[test]
    fn what_is_no_number_is_farthest_and_what_is_the_same_is_not_apart() {
        assert!(share(1.0, 1.5) > share(1.0, 1.25));
        assert!(share(1.0, f32::NAN) > share(1.0, 1e30));
        let same = [share(0.0, -0.0), share(2.0, 2.0), share(f32::NAN, 1.0)];
        assert!(same.iter().all(|far| far.to_bits() == 0), "{same:?}");
    }
}
