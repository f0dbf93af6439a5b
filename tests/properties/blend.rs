//! Laws of blending.

use crate::family;
use lightmeter_reference::blend::{Mode, Operands, Saturate, alpha_clamped, blend, factor, without_alpha};
use lightmeter_reference::{Rgba, Vector};
use lightmeter_scene::blend::{Equation, Factor, State};
use proptest::prelude::*;

family!("blend", 4096);

const COMPLEMENTS: [(Factor, Factor); 7] = [
    (Factor::Zero, Factor::One),
    (Factor::SrcColor, Factor::OneMinusSrcColor),
    (Factor::DstColor, Factor::OneMinusDstColor),
    (Factor::SrcAlpha, Factor::OneMinusSrcAlpha),
    (Factor::DstAlpha, Factor::OneMinusDstAlpha),
    (Factor::ConstantColor, Factor::OneMinusConstantColor),
    (Factor::ConstantAlpha, Factor::OneMinusConstantAlpha),
];

fn color() -> impl Strategy<Value = Rgba<f64>> {
    [0.0..=1.0_f64, 0.0..=1.0_f64, 0.0..=1.0_f64, 0.0..=1.0_f64].prop_map(Vector)
}

fn operands() -> impl Strategy<Value = Operands<f64>> {
    (color(), color(), color()).prop_map(|(src, dst, constant)| Operands { src, dst, constant })
}

fn any_factor() -> impl Strategy<Value = Factor> {
    proptest::sample::select(Factor::ALL.to_vec())
}

/// The factor that reads the other side: what a factor becomes when source and destination change places.
fn mirrored(factor: Factor) -> Option<Factor> {
    Some(match factor {
        Factor::SrcColor => Factor::DstColor,
        Factor::DstColor => Factor::SrcColor,
        Factor::OneMinusSrcColor => Factor::OneMinusDstColor,
        Factor::OneMinusDstColor => Factor::OneMinusSrcColor,
        Factor::SrcAlpha => Factor::DstAlpha,
        Factor::DstAlpha => Factor::SrcAlpha,
        Factor::OneMinusSrcAlpha => Factor::OneMinusDstAlpha,
        Factor::OneMinusDstAlpha => Factor::OneMinusSrcAlpha,
        Factor::SrcAlphaSaturate => return None,
        other => other,
    })
}

fn run(equation: Equation, src: Factor, dst: Factor, of: &Operands<f64>) -> Rgba<f64> {
    blend(State { equation, src, dst }, of, Saturate::SourceAndDestination)
}

proptest! {
    #[test]
    fn complementary_factors_sum_to_1(of in operands()) {
        for (a, b) in COMPLEMENTS {
            let sum = factor(a, &of, Saturate::SourceAndDestination) + factor(b, &of, Saturate::SourceAndDestination);
            prop_assert!(approx::abs_diff_eq!(sum, Vector([1.0; 4]), epsilon = 1e-15));
        }
    }

    #[test]
    fn complementary_factors_stay_between_the_colours(of in operands()) {
        for (a, b) in COMPLEMENTS {
            let mixed = run(Equation::Add, a, b, &of);
            for k in 0..4 {
                prop_assert!(mixed[k] >= of.src[k].min(of.dst[k]) - 1e-15 && mixed[k] <= of.src[k].max(of.dst[k]) + 1e-15);
            }
        }
    }

    #[test]
    fn add_commutes_with_swapped_sides(of in operands(), src in any_factor(), dst in any_factor()) {
        let (Some(new_dst), Some(new_src)) = (mirrored(src), mirrored(dst)) else { return Ok(()) };
        let swapped = Operands { src: of.dst, dst: of.src, constant: of.constant };
        prop_assert_eq!(run(Equation::Add, src, dst, &of), run(Equation::Add, new_src, new_dst, &swapped));
        prop_assert_eq!(run(Equation::Subtract, src, dst, &of), run(Equation::ReverseSubtract, new_src, new_dst, &swapped));
    }

    #[test]
    fn the_two_subtractions_are_negatives(of in operands(), src in any_factor(), dst in any_factor()) {
        prop_assert_eq!(run(Equation::Subtract, src, dst, &of), -run(Equation::ReverseSubtract, src, dst, &of));
    }

    #[test]
    fn min_is_at_most_max_and_both_ignore_factors(of in operands(), src in any_factor(), dst in any_factor()) {
        let (min, max) = (run(Equation::Min, src, dst, &of), run(Equation::Max, src, dst, &of));
        prop_assert!((0..4).all(|k| min[k] <= max[k]));
        prop_assert_eq!(min + max, of.src + of.dst);
        prop_assert_eq!(min, run(Equation::Min, Factor::Zero, Factor::Zero, &of));
    }

    #[test]
    fn one_and_zero_keep_one_side(of in operands()) {
        prop_assert_eq!(run(Equation::Add, Factor::One, Factor::Zero, &of), of.src);
        prop_assert_eq!(run(Equation::Add, Factor::Zero, Factor::One, &of), of.dst);
    }

    #[test]
    fn saturate_never_fills_beyond_1(of in operands()) {
        let s = factor(Factor::SrcAlphaSaturate, &of, Saturate::SourceAndDestination);
        prop_assert!(s.x() <= of.src.w() && s.x() + of.dst.w() <= 1.0 + 1e-15 && s.w() == 1.0);
    }

    #[test]
    fn the_documents_saturate_is_another(alpha in 0.6..1.0_f64) {
        let of = Operands { src: Vector([1.0, 1.0, 1.0, alpha]), dst: Vector([0.0; 4]), constant: Vector([0.0; 4]) };
        let (ruled, document) = (factor(Factor::SrcAlphaSaturate, &of, Saturate::SourceAndDestination), factor(Factor::SrcAlphaSaturate, &of, Saturate::SourceOnly));
        prop_assert!(ruled.x() > document.x());
    }

    #[test]
    fn named_modes_are_their_words(src in color(), dst in color()) {
        let mode = |mode| without_alpha(mode, src, dst.xyz());
        prop_assert_eq!(mode(Mode::Solid), src.xyz());
        prop_assert_eq!(mode(Mode::Mul), src.xyz() * dst.xyz());
        prop_assert_eq!(mode(Mode::Add), src.xyz().scale(src.w()) + dst.xyz());
        prop_assert_eq!(mode(Mode::Alpha), src.xyz().scale(src.w()) + dst.xyz().scale(1.0 - src.w()));
    }

    #[test]
    fn clamping_changes_nothing_inside_and_keeps_within(src in color(), dst in color(), scale in 0.5..3.0_f64) {
        let of = Operands { src, dst, constant: Vector([0.0; 4]) };
        prop_assert!(approx::abs_diff_eq!(alpha_clamped(src, dst), blend(Mode::Alpha.state(), &of, Saturate::SourceAndDestination), epsilon = 1e-15));
        prop_assert!(alpha_clamped(src.scale(scale), dst.scale(-scale)).0.iter().all(|c| (0.0..=1.0).contains(c)));
    }
}
