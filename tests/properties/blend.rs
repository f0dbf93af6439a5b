//! Laws of blending.

use crate::family;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::blend_unit::draw::draw;
use lightmeter::blend_unit::embedded;
use lightmeter::blend_unit::expect::expect;
use lightmeter::blend_unit::model::BlendUnitModel;
use lightmeter::blend_unit::pixel::{Units, stored};
use lightmeter::blend_unit::rules::{FAULTS, Rules, Store};
use lightmeter::blend_unit::store::{StoreCounts, Stores as _};
use lightmeter::blend_unit::tally::{DrawnState, UnitTally};
use lightmeter::cases::blend::Program;
use lightmeter::devices::Known;
use lightmeter::judge::Outcome;
use lightmeter::piece::Piece;
use lightmeter::subject_gpu::code_of;
use lightmeter_reference::blend::{Mode, Operands, Saturate, alpha_clamped, blend, factor, without_alpha};
use lightmeter_reference::{Rgba, Vector};
use lightmeter_scene::blend::routes;
use lightmeter_scene::blend::{Equation, Factor, Separate, State, WriteMask};
use lightmeter_scene::target::{Encoding, TargetFormat};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;

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

/// Rows for a blend unit: colours also beyond [0, 1], and in whole steps.
fn unit_row() -> impl Strategy<Value = Vec<f32>> {
    let component = prop_oneof![
        4 => -0.5_f32..=1.5,
        2 => (0..=255_u8).prop_map(|step| f32::from(step) / 255.0),
        1 => Just(0.0),
        1 => Just(1.0),
    ];
    proptest::collection::vec(component, 8)
}

fn any_state() -> impl Strategy<Value = State> {
    (0..State::all().count()).prop_map(|place| State::all().nth(place).expect("one of them").canonical())
}

/// Sixteen states, two of them mixed and the last with others for alpha, as a driver compiles each for tens of milliseconds.
fn states() -> Vec<Separate> {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut draw = || any_state().new_tree(&mut runner).expect("a state").current();
    let mixed = |src, dst| State { equation: Equation::Add, src, dst };
    let mut states: Vec<Separate> = (0..10).map(|_| draw().into()).collect();
    states.push(mixed(Factor::ConstantColor, Factor::OneMinusConstantAlpha).into());
    states.push(mixed(Factor::OneMinusConstantAlpha, Factor::ConstantColor).into());
    states.extend((0..4).map(|_| Separate { color: draw(), alpha: draw() }));
    states
}

#[test]
fn the_blend_unit_agrees_on_every_target() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let code = code_of(None).expect("the built-in shaders are valid");
    let mut subject = lightmeter_tests::device();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for target in TargetFormat::ALL {
        let rows = proptest::collection::vec(unit_row(), 256).new_tree(&mut runner).expect("rows").current();
        let mut pieces = vec![];
        for state in states() {
            for &route in routes(state) {
                if subject.lacks_route(&code, route).expect("a unit").is_none() {
                    let program = Program::Draw(state, WriteMask::ALL);
                    let constant = [1.25_f32, 0.25, -0.5, 0.75];
                    let inputs = rows.iter().flat_map(|row| row.iter().chain(&constant)).copied().collect();
                    pieces.push(Piece { program, route, inputs, stride: 12 });
                }
            }
        }
        let drawn = draw(&mut subject, &code, target, &pieces.iter().collect::<Vec<_>>(), false).expect("a drawing");
        for (piece, pixels) in pieces.iter().zip(&drawn.pieces) {
            for (place, pixel) in pixels.iter().enumerate() {
                let expected = expect(piece.program, target, &piece.case(place), &Rules::RIGHT, &WGSL);
                for k in 0..4 {
                    let verdict = expected.judge(target, k, pixel[k]);
                    assert_eq!(
                        verdict.outcome,
                        Outcome::Pass,
                        "{piece:?} {}: {place} {pixel:?} {expected:?}",
                        target.name()
                    );
                }
            }
        }
    }
}

/// A state with 24 rows, by the first of its routes.
fn pieces(rows: &[Vec<f32>]) -> impl Iterator<Item = Piece> + '_ {
    let constants = [[0.25_f32, 0.5, 0.75, 0.6], [1.25, -0.25, 0.5, 1.5]];
    State::all().map(move |state| {
        let inputs =
            rows.iter().enumerate().flat_map(|(k, row)| row.iter().chain(&constants[k % 2])).copied().collect();
        let program = Program::Draw(state.canonical().into(), WriteMask::ALL);
        Piece { program, route: routes(state.canonical().into())[0], inputs, stride: 12 }
    })
}

/// What units of different kinds give lies within what is legal: one in f32 that stores the nearest step or the one below,
/// and one of 8 bits throughout.
#[test]
fn every_legal_unit_lies_inside() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let rows = proptest::collection::vec(unit_row(), 24).new_tree(&mut runner).expect("rows").current();
    let truncate = FAULTS.iter().find(|fault| fault.name == "truncate").expect("a fault").rules;
    let (mut truncated, mut lost) = (0_u32, 0_u32);
    for piece in pieces(&rows) {
        for place in 0..piece.count() {
            let case = piece.case(place);
            for target in TargetFormat::ALL {
                let expected = expect(piece.program, target, &case, &Rules::RIGHT, &WGSL);
                let inside =
                    |pixel: Units| (0..4).all(|k| expected.judge(target, k, pixel[k]).outcome == Outcome::Pass);
                let wide = embedded::blend(piece.program, target, &case, &Rules::RIGHT);
                assert!(inside(wide), "{} {piece:?} {place}: {wide:?} {expected:?}", target.name());
                if target.is_unorm() {
                    let pixel = embedded::blend(piece.program, target, &case, &truncate);
                    for k in 0..4 {
                        let passes_through = expected.low[k] == expected.high[k];
                        let is_inside = expected.judge(target, k, pixel[k]).outcome == Outcome::Pass;
                        // Decoded and encoded in f32 a stored step may fall just short of itself.
                        let is_lost =
                            target.encoding() == Encoding::Srgb8 && passes_through && pixel[k] == expected.low[k] - 1.0;
                        assert!(is_inside || is_lost, "{} {piece:?} {place}: {pixel:?} {expected:?}", target.name());
                        truncated += u32::from(is_inside);
                        lost += u32::from(is_lost);
                    }
                }
                if target.encoding() == Encoding::Unorm8 {
                    let narrow = BlendUnitModel::Llvmpipe.predict(
                        piece.program,
                        piece.route,
                        &case,
                        stored(target.encoding(), case.dst),
                    );
                    assert!(inside(narrow), "{} {piece:?} {place}: {narrow:?} {expected:?}", target.name());
                }
            }
        }
    }
    // Truncation is legal value by value, which is why values are judged together.
    assert!(lost > 0 && lost * 20 < truncated, "{lost} lost, {truncated} inside");
}

/// The controls: what lies just outside fails, and a NaN wherever it stands.
#[test]
fn wrong_pixels_fail() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let rows = proptest::collection::vec(unit_row(), 4).new_tree(&mut runner).expect("rows").current();
    for piece in pieces(&rows) {
        for target in TargetFormat::ALL {
            let expected = expect(piece.program, target, &piece.case(3), &Rules::RIGHT, &WGSL);
            for k in 0..4 {
                let outcome = |value: f64| expected.judge(target, k, value).outcome;
                let step = if target.is_unorm() { 1.0 } else { 1e-3 };
                let (low, high) = (expected.low[k], expected.high[k]);
                assert_eq!((outcome(low), outcome(high)), (Outcome::Pass, Outcome::Pass));
                assert_eq!((outcome(low - step), outcome(high + step)), (Outcome::Fail, Outcome::Fail));
                assert_eq!(outcome(f64::NAN), Outcome::Fail);
            }
        }
    }
}

/// A tally of every state drawn by the embedded unit under some rules, as if by a known driver.
fn tally(rules: &Rules, known: &Known, target: TargetFormat) -> UnitTally {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let rows = proptest::collection::vec(unit_row(), 24).new_tree(&mut runner).expect("rows").current();
    let mut tally = UnitTally::default();
    for piece in pieces(&rows) {
        let drawn = DrawnState { program: piece.program, route: piece.route, target, profile: &WGSL };
        for place in 0..piece.count() {
            let case = piece.case(place);
            tally.pixel(drawn, known, place, &case, embedded::blend(piece.program, target, &case, rules));
        }
    }
    tally
}

#[test]
fn a_store_is_identified_and_a_declared_model_holds_to_the_bit() {
    let known = Known { blend_model: Some(BlendUnitModel::Llvmpipe), ..Known::default() };
    for (store, name) in Store::ALL.into_iter().zip(["", "truncate", "times-256", "round-up", "step-up", "step-down"]) {
        let rules = FAULTS.iter().find(|fault| fault.name == name).map_or(Rules::RIGHT, |fault| fault.rules);
        assert_eq!(rules.stores_as(), store, "{name}");
        for target in TargetFormat::ALL.into_iter().filter(|target| target.is_unorm()) {
            let tally = tally(&rules, &known, target);
            for counts in &tally.stores {
                let (likeliest, share) = counts.likeliest();
                assert!(
                    counts.of > 1_000 && likeliest == store && share > 0.99,
                    "{name} {}: {counts:?}",
                    target.name()
                );
                let problem = counts.problem(State::all().count());
                assert_eq!(problem.is_some(), store != Store::Nearest, "{problem:?}");
                assert!(problem.is_none_or(|problem| problem.contains(store.name())));
            }
            // Even the best of units is not the declared one, which rounds every product.
            let (of, others) = tally.model;
            assert!(if target.encoding() == Encoding::Unorm8 { others > 0 } else { of == 0 }, "{others} of {of}");
        }
    }
}

#[test]
fn layers_blend_in_order_and_masks_hold() {
    let modes: &[Mode] = &[Mode::Alpha, Mode::Mul, Mode::Add];
    let program = Program::Layers(modes);
    let mut row = vec![0.5_f32, 0.25, 0.75, 1.0, 3.0];
    row.extend([0.9, 0.1, 0.4, 0.5, 0.2, 0.6, 0.9, 0.7, 0.3, 0.3, 0.1, 0.4].iter().chain([0.5; 52].iter()));
    let case = program.case(&row);
    assert_eq!(case.layers, 3);
    let mut reversed = case;
    reversed.sources[..3].reverse();
    for target in TargetFormat::ALL {
        let expected = expect(program, target, &case, &Rules::RIGHT, &WGSL);
        let passes = |pixel: Units| (0..4).all(|k| expected.judge(target, k, pixel[k]).outcome == Outcome::Pass);
        assert!(passes(embedded::blend(program, target, &case, &Rules::RIGHT)), "{}", target.name());
        assert!(
            !passes(embedded::blend(program, target, &reversed, &Rules::RIGHT)),
            "{}: the order matters",
            target.name()
        );
        let masked = Program::Draw(Mode::Alpha.state().into(), WriteMask([true, false, true, false]));
        let expected = expect(masked, target, &case, &Rules::RIGHT, &WGSL);
        let kept = stored(target.encoding(), case.dst);
        assert_eq!((expected.low[1], expected.high[3]), (kept[1], kept[3]), "{}", target.name());
        let unmasked =
            embedded::blend(Program::Draw(Mode::Alpha.state().into(), WriteMask::ALL), target, &case, &Rules::RIGHT);
        assert_eq!(
            expected.judge(target, 1, unmasked[1]).outcome,
            Outcome::Fail,
            "{}: the mask was lost",
            target.name()
        );
    }
}

#[test]
fn half_overflow_has_two_outcomes() {
    let add =
        Program::Draw(State { equation: Equation::Add, src: Factor::One, dst: Factor::One }.into(), WriteMask::ALL);
    let case = add.case(&[60000.0, -60000.0, 1.0, 1.0, 60000.0, -60000.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    let expected = expect(add, TargetFormat::Rgba16Float, &case, &Rules::RIGHT, &WGSL);
    let outcome = |k: usize, value: f64| expected.judge(TargetFormat::Rgba16Float, k, value).outcome;
    for legal in [65504.0, f64::INFINITY] {
        assert_eq!((outcome(0, legal), outcome(1, -legal)), (Outcome::Pass, Outcome::Pass));
    }
    for wrong in [65472.0, 0.0, f64::NEG_INFINITY, f64::NAN] {
        assert_eq!(outcome(0, wrong), Outcome::Fail, "{wrong}");
    }
    let single = expect(add, TargetFormat::Rgba32Float, &case, &Rules::RIGHT, &WGSL);
    assert_eq!(single.judge(TargetFormat::Rgba32Float, 0, f64::INFINITY).outcome, Outcome::Fail);
}

/// On 8 linear bits the bound is a neighbour, or what a unit of 8 bits comes to: 1½ steps of the source's term and 1 of the
/// destination's, each product up to 1/510 worse.
#[test]
fn the_bound_on_8_bits_is_no_wider_than_it_must() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let rows = proptest::collection::vec(unit_row(), 24).new_tree(&mut runner).expect("rows").current();
    let (mut widest, mut values, mut wider) = (0.0_f64, 0_u32, 0_u32);
    for piece in pieces(&rows) {
        for place in 0..piece.count() {
            let expected = expect(piece.program, TargetFormat::Rgba8Unorm, &piece.case(place), &Rules::RIGHT, &WGSL);
            for k in 0..4 {
                let most = (expected.high[k] - expected.reference[k]).max(expected.reference[k] - expected.low[k]);
                assert!(most <= 2.5 + 2.0 / 510.0 + 1e-6, "{piece:?} {place}: {expected:?}");
                widest = widest.max(most);
                values += 1;
                wider += u32::from(expected.high[k] - expected.low[k] > 1.5);
            }
        }
    }
    assert!(widest > 2.0 && wider * 2 < values, "{widest}, {wider} of {values} wider than a neighbour to each side");
}

/// A store of a fault that is no store of the catalogue: it is told, though by no name.
#[test]
fn an_unknown_store_is_told_by_its_mean_error() {
    let mut counts = StoreCounts::default();
    let mut right = StoreCounts::default();
    for k in 0..4000_u32 {
        let reference = f64::from(k) * 0.0637 + 0.01;
        counts.count(reference, (reference + 0.35).floor());
        right.count(reference, reference.round());
    }
    // Most are the nearest: the mean distance alone tells.
    assert_eq!(counts.likeliest().0, Store::Nearest);
    let problem = counts.problem(225).expect("a seventh of a step is told");
    assert!(problem.contains("no known way") && problem.contains("-0.15"), "{problem}");
    assert_eq!(right.problem(225), None);
    // In a single state legal units err as much.
    assert_eq!(counts.problem(1), None);
}
