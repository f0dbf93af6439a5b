//! Verdicts on the pixels of a state, the tiers that they fall in, and what they say together of how results are stored.

use super::embedded;
use super::expect::{ExpectedPixel, expect};
use super::pixel::{Units, nearest_step};
use super::rules::{FAULTS, Rules, Store, UnitFault};
use super::store::{NEAR, StoreCounts, Stores as _};
use crate::devices::{Known, concerns_result, grants};
use crate::tally::Tally;
use crate::{Outcome, Verdict, margin, simplicity};
use lightmeter_arithmetic::{F16, F32, Format as _, Profile};
use lightmeter_catalogue::cases::blend::{Program, UnitCase};
use lightmeter_document::adapters::BlendDeviation;
use lightmeter_document::report::{Counted, Diagnosis, Explanation, Standing, Tiers};
use lightmeter_scene::blend::Route;
use lightmeter_scene::blend::Separate;
use lightmeter_scene::target::{Encoding, TargetFormat};
use std::borrow::Borrow;

/// A state by one of its routes on a target, and the profile that its pixels are judged by.
#[derive(Clone, Copy, Debug)]
pub struct DrawnState {
    /// What is drawn.
    pub program: Program,
    /// How it reaches the unit.
    pub route: Route,
    /// On what.
    pub target: TargetFormat,
    /// By which accuracy rules.
    pub profile: &'static Profile,
}

impl ExpectedPixel {
    /// Judges a component.
    #[inline]
    #[must_use]
    pub fn judge(&self, target: TargetFormat, k: usize, value: f64) -> Verdict {
        let (reference, low, high) = (self.reference[k], self.low[k], self.high[k]);
        let error = match target.encoding() {
            _ if value.to_bits() == reference.to_bits() || (value.is_nan() && reference.is_nan()) => 0.0,
            Encoding::Float32 => distance(value, reference, F32::MAX) / F32::ulp(reference),
            Encoding::Float16 => distance(value, reference, F16::MAX) / F16::ulp(reference),
            Encoding::Unorm8 | Encoding::Srgb8 => (value - reference).abs(),
        };
        if low == f64::NEG_INFINITY && high == f64::INFINITY {
            return Verdict { outcome: Outcome::Indeterminate, error, margin: 0.0 };
        }
        // A NaN is in no interval.
        let is_legal = low <= value && value <= high && !reference.is_nan();
        let outcome = if is_legal { Outcome::Pass } else { Outcome::Fail };
        Verdict { outcome, error, margin: margin(value, reference, low, high) }
    }
}

fn deviates(known: &Known, target: TargetFormat, reference: f64) -> Option<&'static BlendDeviation> {
    known.blend_deviations.iter().copied().find(|deviation| concerns_result(deviation, target, reference))
}

/// Beyond the greatest finite number infinity is as near as that number.
fn distance(value: f64, reference: f64, most: f64) -> f64 {
    // Nearly all are neither infinite nor NaN.
    if value.abs() <= most && reference.abs() <= most {
        return (value - reference).abs();
    }
    let finite = |x: f64| x.clamp(-most, most);
    if value.is_nan() || reference.is_nan() { f64::INFINITY } else { (finite(value) - finite(reference)).abs() }
}

/// The pixels of a state, or of a group of them.
#[derive(Clone, Debug, Default)]
pub struct UnitTally {
    /// Verdicts on components, by the places of the pixels' cases. Of a pixel that fails, what was left and what is legal are kept.
    pub verdicts: Tally<usize, (Units, ExpectedPixel)>,
    /// On targets of 8 bits.
    pub tiers: Tiers,
    /// What the values of each component say of how they are stored.
    pub stores: [StoreCounts; 4],
    /// Values that a declared model predicts, and how many are another.
    pub model: (u64, u64),
    /// The first pixel that departs from the model.
    pub departure: Option<usize>,
    /// Pixels that fail, and how many of their components do.
    pub failing: Vec<(usize, u64)>,
    /// The greatest error of pixels that pass, and the sum and the number of those of pixels that err by no infinity.
    pub passing: (f64, f64, u64),
}

/// Whether a constant leaves the errors of a state's values to chance: a unit that holds its constant in 8 bits errs by it in
/// every value alike.
fn tells_stores(state: Separate, case: &UnitCase) -> bool {
    !state.reads_constant() || case.constant.iter().all(|c| !(0.0 < *c && *c < 1.0))
}

impl UnitTally {
    /// Judges pixels, each with its place and its case.
    pub fn pixels<C: Borrow<UnitCase>>(
        &mut self,
        drawn: DrawnState,
        known: &Known,
        pixels: impl IntoIterator<Item = (usize, C, Units)>,
    ) {
        // What is legal of each is computed inside of this scope, so that none has to enter one of its own.
        drawn.profile.scope(|| {
            for (place, case, pixel) in pixels {
                self.pixel(drawn, known, place, case.borrow(), pixel);
            }
        });
    }

    /// Judges a pixel, the `place`-th.
    pub fn pixel(&mut self, drawn: DrawnState, known: &Known, place: usize, case: &UnitCase, pixel: Units) {
        let DrawnState { program, route, target, profile } = drawn;
        let expected = expect(program, target, case, &Rules::RIGHT, profile);
        self.verdicts.totals.cases += 1;
        let (state, mask) = program.layer(0);
        let tells = target.is_unorm() && tells_stores(state, case);
        let before = self.verdicts.totals.failed;
        let mut errors = (0.0, 0.0, 0);
        for (k, value) in pixel.into_iter().enumerate() {
            let verdict = expected.judge(target, k, value);
            let excused = match verdict.outcome {
                Outcome::Fail => deviates(known, target, expected.reference[k]).filter(|known| grants(known, value)),
                _ => None,
            };
            match excused {
                Some(deviation) => self.verdicts.count(verdict.outcome, Some(&*deviation.name), false),
                None => self.verdicts.count_many(verdict.outcome, 1, false),
            }
            if verdict.outcome == Outcome::Indeterminate || excused.is_some() {
                continue;
            }
            self.verdicts.see_error(verdict.error);
            // A NaN fails, and so is no error of a pixel that passes.
            if verdict.error > errors.0 {
                errors.0 = verdict.error;
            }
            errors.1 += verdict.error;
            errors.2 += 1;
            self.verdicts.see_margin(verdict.margin, place);
            if target.is_unorm() {
                count_tier(&mut self.tiers, expected.reference[k], value, verdict.outcome);
                if tells && mask.0[k] {
                    self.stores[k].count(expected.reference[k], value);
                }
            }
        }
        let failed = self.verdicts.totals.failed - before;
        if failed == 0 {
            if errors.0 > self.passing.0 {
                self.passing.0 = errors.0;
            }
            // An infinite error, where infinity is legal, says nothing of the mean.
            if errors.1.is_finite() {
                (self.passing.1, self.passing.2) = (self.passing.1 + errors.1, self.passing.2 + errors.2);
            }
        }
        if failed > 0 {
            self.failing.push((place, failed));
            let simple =
                case.sources[..case.layers].iter().chain([&case.dst, &case.constant]).map(|x| simplicity(x)).sum();
            self.verdicts.fail(place, simple, || (pixel, expected));
        }
        if let Some(model) = known.blend_model.filter(|_| target.encoding() == Encoding::Unorm8) {
            let predicted = model.predict(program, route, case, super::pixel::stored(target.encoding(), case.dst));
            let others = (0..4).filter(|&k| predicted[k].to_bits() != pixel[k].to_bits()).count() as u64;
            self.model.0 += 4;
            self.model.1 += others;
            if others > 0 && self.departure.is_none() {
                self.departure = Some(place);
            }
        }
    }
}

/// Counts a value on a target of 8 bits among those that come as near.
pub fn count_tier(tiers: &mut Tiers, reference: f64, value: f64, outcome: Outcome) {
    let error = (value - reference).abs();
    let is_step = (reference - nearest_step(reference)).abs() < NEAR;
    let tier = match outcome {
        Outcome::Fail => &mut tiers.outside,
        _ if is_step && error < NEAR => &mut tiers.exact,
        _ if error <= 0.5 + NEAR => &mut tiers.nearest,
        _ if error < 1.0 + NEAR => &mut tiers.neighbour,
        _ => &mut tiers.bound,
    };
    *tier += 1;
}

/// A failing pixel, kept so that faults can be tried as its explanation.
#[derive(Clone, Copy, Debug)]
pub struct FailingPixel {
    /// What was drawn.
    pub drawn: DrawnState,
    /// The case.
    pub case: UnitCase,
    /// What was left.
    pub pixel: Units,
}

impl FailingPixel {
    /// Whether a fault would have left what was left: a value that its rules allow, or the very step that a store gives.
    fn is_as_by(&self, fault: &UnitFault) -> bool {
        let DrawnState { program, target, profile, .. } = self.drawn;
        if fault.rules.store != Store::Nearest {
            let stored = embedded::blend(program, target, &self.case, &fault.rules);
            return (0..4).all(|k| stored[k].to_bits() == self.pixel[k].to_bits());
        }
        let expected = expect(program, target, &self.case, &fault.rules, profile);
        (0..4).all(|k| expected.judge(target, k, self.pixel[k]).outcome == Outcome::Pass)
    }
}

/// The faults that explain the most of the failing pixels, if nine in ten are explained. In some states two faults come to the same. `None` where
/// nothing fails.
#[must_use]
pub fn diagnose(samples: &[FailingPixel]) -> Option<Diagnosis> {
    let target = samples.first()?.drawn.target;
    let tried = FAULTS.iter().filter(|fault| fault.concerns(target));
    let explained: Vec<(&UnitFault, usize)> =
        tried.map(|fault| (fault, samples.iter().filter(|sample| sample.is_as_by(fault)).count())).collect();
    let most = explained.iter().map(|(_, count)| *count).max()?;
    let is_enough = 10 * most >= 9 * samples.len();
    let alike = explained.iter().filter(|(_, count)| is_enough && *count == most).enumerate();
    let explanations = alike.map(|(place, (fault, _))| Explanation {
        says: format!("as if {}", fault.says),
        mistakes: vec![],
        parameter: None,
        explained: most as u64,
        open: 0,
        standing: if place == 0 { Standing::Best } else { Standing::Equal },
    });
    let looked_at = samples.len() as u64;
    Some(Diagnosis {
        counts: Counted::Pixels,
        failing: looked_at,
        looked_at,
        explanations: explanations.collect(),
        ..Diagnosis::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::cases::blend::MOST_LAYERS;
    use lightmeter_scene::blend::{Equation, Factor, State, WriteMask};

    const PIXELS: usize = 1000;

    fn one_plus_one() -> Program {
        let state = State { equation: Equation::Add, src: Factor::One, dst: Factor::One };
        Program::Draw(state.into(), WriteMask::ALL)
    }

    fn case(src: f32, dst: f32) -> UnitCase {
        UnitCase { sources: [[src; 4]; MOST_LAYERS], layers: 1, dst: [dst; 4], constant: [0.0; 4] }
    }

    fn tally(target: TargetFormat, case: &UnitCase, pixels: &[Units]) -> Tally<usize, (Units, ExpectedPixel)> {
        let drawn = DrawnState {
            program: one_plus_one(),
            route: Route::Native,
            target,
            profile: &lightmeter_arithmetic::profile::WGSL,
        };
        let mut tally = UnitTally::default();
        for (place, pixel) in pixels.iter().enumerate() {
            tally.pixel(drawn, &Known::default(), place, case, *pixel);
        }
        tally.verdicts
    }

    #[test]
    fn a_nan_fails_wherever_it_stands() {
        for target in [TargetFormat::Rgba32Float, TargetFormat::Rgba16Float] {
            let case = case(0.25, 0.5);
            let right = [embedded::blend(one_plus_one(), target, &case, &Rules::RIGHT); PIXELS];
            assert_eq!(tally(target, &case, &right).totals.failed, 0);
            for place in [0, PIXELS / 2, PIXELS - 1] {
                for k in [0, 2, 3] {
                    for bits in [0x7fc0_0000, 0xffc0_0000, 0x7fa0_0001, 0x7fc1_2345] {
                        let mut wrong = right;
                        wrong[place][k] = f32::from_bits(bits).into();
                        let tally = tally(target, &case, &wrong);
                        assert_eq!((tally.totals.failed, tally.totals.passed), (1, 4 * PIXELS as u64 - 1));
                        assert_eq!(tally.worst, Some((f64::INFINITY, place)));
                        assert!(tally.failures.into_keys().eq([place]));
                        assert!(tally.error_max == f64::INFINITY);
                    }
                }
            }
        }
    }

    #[test]
    fn a_nan_is_indeterminate_where_a_nan_was_given_and_never_a_pass() {
        for (src, dst) in [(f32::NAN, 0.5), (0.5, f32::NEG_INFINITY)] {
            let target = TargetFormat::Rgba32Float;
            let program = Program::Special(State { equation: Equation::Add, src: Factor::One, dst: Factor::One });
            let drawn =
                DrawnState { program, route: Route::Native, target, profile: &lightmeter_arithmetic::profile::WGSL };
            let mut tally = UnitTally::default();
            tally.pixel(drawn, &Known::default(), 0, &case(src, dst), [f64::NAN; 4]);
            let totals = tally.verdicts.totals;
            assert_eq!((totals.passed, totals.failed, totals.indeterminate), (0, 0, 4));
        }
    }

    /// An infinite result, where that is legal, must not stand in the way of the margins after it.
    #[test]
    fn what_overflows_hides_no_later_failure() {
        let (target, case) = (TargetFormat::Rgba16Float, case(60_000.0, 60_000.0));
        let infinite = [f64::INFINITY; 4];
        let tally = tally(target, &case, &[infinite, [f64::INFINITY, 1.0, f64::INFINITY, f64::NAN], infinite]);
        assert_eq!((tally.totals.failed, tally.totals.passed), (2, 10));
        assert_eq!(tally.worst.map(|(_, place)| place), Some(1));
        assert!(tally.worst.is_some_and(|(margin, _)| margin > 1.0));
    }
}
