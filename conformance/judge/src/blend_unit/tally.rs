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
use std::collections::HashSet;

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
    /// What a fault would have left: of each component the least and the greatest value that its rules allow, or the very step that a store
    /// gives.
    fn by(&self, fault: &UnitFault) -> [[f64; 2]; 4] {
        let DrawnState { program, target, profile, .. } = self.drawn;
        if fault.rules.store != Store::Nearest {
            return embedded::blend(program, target, &self.case, &fault.rules).map(|stored| [stored; 2]);
        }
        let expected = expect(program, target, &self.case, &fault.rules, profile);
        std::array::from_fn(|k| [expected.low[k], expected.high[k]])
    }

    /// Whether a component is one of these values. A NaN is so where it is the only one.
    fn is_within(&self, k: usize, [low, high]: [f64; 2]) -> bool {
        let value = self.pixel[k];
        (low <= value && value <= high) || (value.is_nan() && low.to_bits() == value.to_bits())
    }
}

/// An interval that is wider than this part of the range of right values tells nothing of its component.
const WIDE: f64 = 1.0 / 16.0;
/// The most bits that a component tells; one that is like another tells 1.
const BITS: f64 = 8.0;
/// The bits of evidence that an explanation needs beyond the logarithm of the number of those that are tried.
const LEAST_EVIDENCE: f64 = 64.0;

/// Failing pixels, with what is right of each.
struct Failing<'a> {
    pixels: &'a [FailingPixel],
    right: Vec<ExpectedPixel>,
    /// The range of right values of each component.
    ranges: [f64; 4],
}

impl<'a> Failing<'a> {
    fn new(pixels: &'a [FailingPixel]) -> Self {
        let expected = |one: &FailingPixel| {
            let DrawnState { program, target, profile, .. } = one.drawn;
            expect(program, target, &one.case, &Rules::RIGHT, profile)
        };
        let right: Vec<ExpectedPixel> = pixels.iter().map(expected).collect();
        let range = |k: usize| {
            let all = right.iter().map(|right| right.reference[k]).filter(|x| x.is_finite());
            let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
            (high - low).max(0.0)
        };
        let ranges = std::array::from_fn(range);
        Self { pixels, right, ranges }
    }

    /// How many pixels a fault explains, and the bits by which it beats chance. Only wrong components tell anything, each the more, the narrower
    /// what the fault would have left, and one like another a single bit.
    fn by(&self, fault: &UnitFault) -> (usize, f64) {
        let (mut explained, mut evidence, mut told) = (0, 0.0, HashSet::new());
        for (pixel, right) in self.pixels.iter().zip(&self.right) {
            let left = pixel.by(fault);
            if !(0..4).all(|k| pixel.is_within(k, left[k])) {
                continue;
            }
            let mut tells = false;
            for (k, [low, high]) in left.into_iter().enumerate() {
                let value = pixel.pixel[k];
                let is_right = right.low[k] <= value && value <= right.high[k];
                let (width, range) = (high - low, self.ranges[k].max(value.abs()));
                // Of 8 bits a wrong value is any step.
                let (step, among) = match pixel.drawn.target.encoding() {
                    Encoding::Unorm8 | Encoding::Srgb8 => (1.0, 256.0),
                    Encoding::Float16 => (F16::ulp(value), range),
                    Encoding::Float32 => (F32::ulp(value), range),
                };
                if is_right || width > WIDE * among {
                    continue;
                }
                tells = true;
                let is_new = told.insert((k, value.to_bits(), low.to_bits(), high.to_bits()));
                let bits = (among / (width + step)).log2();
                evidence += if bits.is_nan() { 0.0 } else { bits.clamp(0.0, if is_new { BITS } else { 1.0 }) };
            }
            explained += usize::from(tells);
        }
        (explained, evidence)
    }
}

/// The faults that explain the most of the failing pixels, if nine in ten are explained by more than chance. In some states two faults come to the
/// same. `None` where nothing fails.
#[must_use]
pub fn diagnose(samples: &[FailingPixel]) -> Option<Diagnosis> {
    let target = samples.first()?.drawn.target;
    let failing = Failing::new(samples);
    let tried: Vec<(&UnitFault, usize, f64)> = FAULTS
        .iter()
        .filter(|fault| fault.concerns(target))
        .map(|fault| {
            let (explained, evidence) = failing.by(fault);
            (fault, explained, evidence)
        })
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "a few faults")]
    let least = (tried.len() as f64).log2() + LEAST_EVIDENCE;
    let is_told = |&&(_, explained, evidence): &&(&UnitFault, usize, f64)| {
        10 * explained >= 9 * samples.len() && evidence >= least
    };
    let most = tried.iter().filter(is_told).map(|(_, explained, _)| *explained).max();
    let alike = tried.iter().filter(is_told).filter(|(_, explained, _)| Some(*explained) == most).enumerate();
    let explanations = alike.map(|(place, (fault, explained, _))| Explanation {
        says: format!("as if {}", fault.says),
        mistakes: vec![],
        parameter: None,
        explained: *explained as u64,
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
