//! The intervals' soundness: an f32 arithmetic that draws order, rounding, form, fusion and flush at random must always lie
//! inside. And that they are not idle.

use lightmeter::arithmetic::profile::{VULKAN, WGSL};
use lightmeter::arithmetic::random::{seed, share};
use lightmeter::arithmetic::{Accept, F32, Format as _, Hardware, Profile, RandomLegal};
use lightmeter::cases::{Formula, Kind, Reader, Spec, Visitor, Wanted, Writer, visit};
use lightmeter::select::{CaseRef, catalogue};
use lightmeter_reference::Real;
use std::collections::HashMap;

/// Draws every arithmetic formula many times over and counts what was seen.
struct Check {
    profile: &'static Profile,
    cases: u64,
    draws: usize,
    drawn: u64,
    /// The rows of the named hard cases by formula.
    hard: HashMap<String, Vec<Vec<f32>>>,
    /// Widths of intervals over the spread of what was drawn, for intervals that are neither points nor everything.
    ratios: Vec<f64>,
}

impl Visitor for Check {
    fn formula<F: Formula>(&mut self, formula: F) {
        let spec = formula.spec();
        if matches!(spec.kind, Kind::Raster(_)) {
            return;
        }
        let cases = if matches!(spec.kind, Kind::Blend(_)) { self.cases.div_ceil(16) } else { self.cases };
        let hard = self.hard.get(&spec.id).cloned().unwrap_or_default();
        for row in (0..cases).map(|k| random_row(&spec, k)).chain(hard) {
            self.row(&formula, &spec, &row);
        }
    }
}

fn random_row(spec: &Spec, k: u64) -> Vec<f32> {
    let mut row = vec![];
    lightmeter::cases::Drawing::new(spec, 11).inputs(k, &mut row);
    row
}

fn hard_rows() -> HashMap<String, Vec<Vec<f32>>> {
    let rows = catalogue().into_iter().map(|member| {
        let rows = (0..member.spec.hard.len()).map(|place| {
            let mut row = vec![];
            member.inputs(CaseRef::Hard(place), 0, &mut row);
            row
        });
        (member.spec.id.clone(), rows.collect())
    });
    rows.collect()
}

impl Check {
    fn row<F: Formula>(&mut self, formula: &F, spec: &Spec, row: &[f32]) {
        let outputs = spec.output_len();
        let mut legal = vec![Accept::<F32>::ANY; outputs];
        let inputs: Vec<Accept> = row.iter().map(|&x| Accept::input(x)).collect();
        self.profile.scope(|| formula.evaluate(&Reader::new(&inputs), &mut Writer::new(&mut legal, Wanted::ALL)));
        let mut seen = vec![(f64::INFINITY, f64::NEG_INFINITY); outputs];
        for _ in 0..self.draws {
            let inputs: Vec<RandomLegal> = row.iter().map(|&x| RandomLegal::input(x)).collect();
            let mut out = vec![RandomLegal::of(0.0); outputs];
            self.profile.scope(|| formula.evaluate(&Reader::new(&inputs), &mut Writer::new(&mut out, Wanted::ALL)));
            self.drawn += outputs as u64;
            for ((out, legal), seen) in out.iter().zip(&legal).zip(&mut seen) {
                assert!(legal.contains(out.value), "{}: {} outside {legal:?}, inputs {row:?}", spec.id, out.value);
                *seen = (seen.0.min(out.value), seen.1.max(out.value));
            }
        }
        for (legal, (low, high)) in legal.iter().zip(seen) {
            if !legal.is_any() && high > low {
                self.ratios.push(legal.width() / (high - low));
            }
        }
    }
}

fn check(profile: &'static Profile, cases: u64, draws: usize) -> Check {
    seed(2026);
    let mut check = Check { profile, cases, draws, drawn: 0, hard: hard_rows(), ratios: vec![] };
    visit(&mut check);
    check.ratios.sort_by(f64::total_cmp);
    check
}

#[test]
fn every_legal_evaluation_lies_inside_and_intervals_are_not_idle() {
    let check = check(&WGSL, 256, 64);
    assert!(check.drawn > 4_000_000, "only {} values were drawn", check.drawn);
    let at = |share: usize| check.ratios[check.ratios.len() * share / 100];
    eprintln!(
        "{} values drawn; interval width over the spread of 64 draws: median {:.2}, 90 % below {:.2}, 99 % below {:.2}",
        check.drawn,
        at(50),
        at(90),
        at(99)
    );
    // Legal evaluations reach a good part of what is called legal: a bound that grew loose would show here.
    assert!(at(50) < 4.0, "the median interval is {} times as wide as what was drawn", at(50));
}

#[test]
fn every_legal_evaluation_by_vulkans_rules_lies_inside() {
    assert!(check(&VULKAN, 64, 16).drawn > 100_000);
}

#[test]
fn an_arithmetic_that_errs_more_is_caught() {
    // The control: a division off by twice its bound.
    seed(1);
    let legal: Accept = WGSL.scope(|| Accept::literal(1.0) / Accept::literal(3.0));
    let third = || Profile { divide_ulp: 5.0, ..WGSL }.scope(|| RandomLegal::of(1.0) / RandomLegal::of(3.0));
    let outside = (0..1000).filter(|_| !legal.contains(third().value)).count();
    assert!(outside > 100, "{outside} of 1000");
}

#[test]
fn a_blend_unit_may_take_out_a_shared_factor() {
    // What lavapipe does where both factors are one: (s + d)·f for s·f + d·f. Legal in hardware, not always in a shader.
    seed(7);
    let mut outside_a_shaders_rules = 0;
    for _ in 0..100_000 {
        let [s, d, f] = [0; 3].map(|_| RandomLegal::of(share().abs()));
        let factored = WGSL.scope(|| (s + d) * f).value;
        let legal = hardware([s.value, d.value, f.value]);
        assert!(legal.contains(factored), "{factored} outside {legal:?}: {s:?} {d:?} {f:?}");
        let [s, d, f] = [s, d, f].map(|x| Accept::<F32>::exactly(x.value));
        outside_a_shaders_rules += u32::from(!WGSL.scope(|| s * f + d * f).contains(factored));
    }
    assert!(outside_a_shaders_rules > 100, "only {outside_a_shaders_rules}");
}

fn hardware([s, d, f]: [f64; 3]) -> Accept<Hardware<F32>> {
    let [s, d, f] = [s, d, f].map(Accept::exactly);
    WGSL.scope(|| Accept::sum([s * f, d * f]))
}

#[test]
fn chains_reach_their_bounds_and_not_beyond() {
    WGSL.scope(chains_reach_their_bounds);
}

fn chains_reach_their_bounds() {
    let ulp = f64::from(f32::EPSILON);
    // Rounded up at each step, 1 and ever so little comes to a ULP more for each term.
    let dust: Accept = Accept::exactly(2.0_f64.powi(-60));
    let one: Accept = Accept::exactly(1.0);
    let sums = [
        Accept::sum([one, dust, dust]),
        Accept::sum([one, dust, dust, dust]),
        Accept::sum([one, dust, dust, dust, dust]),
    ];
    for (terms, sum) in (3..).zip(sums) {
        let most = 1.0 + f64::from(terms - 1) * ulp;
        assert!(sum.contains(most), "{terms} terms: {most} in {sum:?}");
        assert!(!sum.contains(most + ulp), "{terms} terms: {sum:?}");
    }
    // The same of products: each factor is the one of many that is rounded up the furthest.
    seed(3);
    let factor = || F32::round_up(1.0 + 0.03 * share().abs());
    let mut nearest = 0.0_f64;
    for _ in 0..2_000 {
        let mut factors = [factor(); 4];
        let mut up = factors[0];
        for next in &mut factors[1..] {
            let lost = |x: &f64| F32::round_up(up * x) - up * x;
            let candidates: [f64; 100] = std::array::from_fn(|_| factor());
            *next = candidates.into_iter().max_by(|a, b| lost(a).total_cmp(&lost(b))).expect("a hundred");
            up = F32::round_up(up * *next);
        }
        let exact: f64 = factors.iter().product();
        let legal: Accept = Accept::product(factors.map(Accept::exactly));
        assert!(legal.contains(up), "{up} outside {legal:?}: {factors:?}");
        nearest = nearest.max((up - exact) / (legal.high() - exact));
    }
    // Three roundings of the four ULP that the bound comes to once it is on the grid.
    assert!(nearest > 0.74, "rounding up comes no nearer to the bound than {nearest}");
}

#[test]
fn single_operations_are_sharp() {
    WGSL.scope(sharp_operations);
}

fn sharp_operations() {
    let number = |x: f32| -> Accept { Accept::input(x) };
    let third = number(1.0) + number(2.0_f32.powi(-25));
    assert_eq!((third.low(), third.high()), (1.0, f64::from(1.0_f32.next_up())));
    assert_eq!(number(0.1) * number(0.0), number(0.0));
    assert_eq!(number(0.25) + number(0.5), number(0.75));
    assert_eq!(number(3.0) * number(0.5), number(1.5));
    assert!(!(number(1.0) / number(3.0)).contains(1.0 / 3.0 + 3.0 * F32::ulp(1.0 / 3.0)));
    assert!(
        (number(1.0) / number(0.0)).is_any() && number(-1.0).sqrt().is_any() && (number(3e38) * number(10.0)).is_any()
    );
    // Just above 1 a ULP is twice what it is just below, though f64 cannot tell exp(1e-20) from 1.
    assert!(number(1e-20).exp().contains(1.0 + 3.0 * f64::from(f32::EPSILON)));
    let flushed = number(1e-30) * number(1e-10);
    assert!(flushed.contains(0.0) && flushed.contains(f64::from(1e-40_f32)));
}
