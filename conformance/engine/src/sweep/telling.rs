//! The row along which a sweep tells something: where the output depends on what is swept, so that a shader that reads it wrong is seen.

use super::span::input;
use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::profile::PROFILES;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_judge::{Outcome, judge};
use lightmeter_scene::along::{Along, key_of};

/// Places of a range at which a row is tried.
const PLACES: usize = 64;
/// Rows that are drawn and tried.
const ROWS: u64 = 256;
/// Of them, those by which an input is found to be one that no output depends on.
const FIRST_ROWS: u64 = 32;
/// By how much roundings of f64 may change an output that does not depend on an input.
const ROUNDING: f64 = 1e-12;
/// What rows are drawn from.
const SEED: u64 = 1;

/// What is swept of a formula, but for the row.
pub(super) struct Swept<'a> {
    pub(super) member: &'a Member,
    pub(super) free: usize,
    pub(super) from: f32,
    pub(super) to: f32,
    /// Outputs that may be chosen, the first of them rather than another.
    pub(super) outputs: Vec<usize>,
    /// Whether the given row is a ready-made sweep's, which tells something as it is.
    pub(super) is_ready: bool,
}

/// A row, and the output that tells the most along it.
pub(super) struct Chosen {
    pub(super) row: Vec<f32>,
    pub(super) output: usize,
    /// Whether it was drawn, and is none of what was given and middles of domains.
    pub(super) is_drawn: bool,
}

impl Swept<'_> {
    /// The row `given`, which holds what was asked for and middles of domains, or a drawn one with what `ask` puts in it, where the output
    /// hardly depends on the free number along the first.
    pub(super) fn choose(&self, given: Vec<f32>, ask: impl Fn(&mut [f32])) -> Result<Chosen, String> {
        let places = self.places();
        let of = |row: Vec<f32>, is_drawn| {
            let told = |output: usize| self.told(&row, output, &places);
            // Of equal ones the first.
            let (told, output) =
                self.outputs.iter().map(|&output| (told(output), output)).rev().max_by_key(|(told, _)| *told)?;
            Some((told, Chosen { row, output, is_drawn }))
        };
        let first = of(given, false).ok_or_else(|| "the formula has no output".to_owned())?;
        let least = if self.is_ready { 1 } else { PLACES / 4 };
        // One input alone is swept again of a longer sweep, along its row.
        if first.0 >= least || key_of(self.to) == key_of(self.from) {
            return Ok(first.1);
        }
        let drawn = |k: u64| {
            let mut row = vec![];
            self.member.inputs(CaseRef::Random(k), SEED, &mut row);
            ask(&mut row);
            row[self.free] = self.from;
            row
        };
        if !(0..FIRST_ROWS).any(|k| self.changes(&drawn(k), &places)) && !self.changes(&first.1.row, &places) {
            return Err(self.refusal(["does not depend", "depends"], ""));
        }
        let mut best = first;
        for row in (0..ROWS).map(drawn) {
            if let Some(other) = of(row, true).filter(|other| other.0 > best.0) {
                best = other;
            }
            if best.0 >= PLACES / 2 {
                break;
            }
        }
        if best.0 == 0 {
            Err(self.refusal(["hardly depends", "depends enough"], ", so that twice the input would be legal too"))
        } else {
            Ok(best.1)
        }
    }

    /// Numbers of the range: half of them evenly among its floats, half evenly among its values.
    fn places(&self) -> Vec<f32> {
        let floats = u64::from(key_of(self.to) - key_of(self.from));
        let half = PLACES as u64 / 2;
        let by_float = (0..half).map(|k| input(self.from, floats * k / (half - 1)));
        #[expect(clippy::cast_precision_loss, reason = "a few places")]
        let share = |k: u64| (k as f32 + 0.5) / half as f32;
        let by_value = (0..half).map(|k| self.from + (self.to - self.from) * share(k));
        by_float.chain(by_value).collect()
    }

    /// At how many places an implementation that reads the free number doubled is seen. The row is the same by whatever rules a sweep is judged, so
    /// these are the first.
    fn told(&self, row: &[f32], output: usize, places: &[f32]) -> usize {
        let along = Along { row, free: self.free, output };
        let formula = &self.member.formula;
        let mut references = vec![0.0; places.len()];
        formula.reference_along(&along, places, &mut references);
        let mut legal = vec![Accept::ANY; places.len()];
        formula.interval_along(&along, places, PROFILES[0], &mut legal);
        let mut values = vec![0.0_f32; places.len()];
        formula.embedded_along(&along, &places.iter().map(|x| 2.0 * x).collect::<Vec<_>>(), &mut values);
        let is_seen = |((value, reference), legal): ((&f32, &f64), &Accept)| {
            judge(value.to_bits(), *reference, legal).outcome == Outcome::Fail
        };
        values.iter().zip(&references).zip(&legal).filter(|&one| is_seen(one)).count()
    }

    /// Whether any output that may be chosen changes along a row.
    fn changes(&self, row: &[f32], places: &[f32]) -> bool {
        self.outputs.iter().any(|&output| changes(self.member, &Along { row, free: self.free, output }, places))
    }

    /// Why there is nothing to sweep: that one output, or none of several, depends on the free number.
    fn refusal(&self, [one, several]: [&str; 2], because: &str) -> String {
        let spec = &self.member.spec;
        let which = match self.outputs[..] {
            [output] => format!("output {} of {} {one}", spec.output_name(output), spec.id),
            _ => format!("no output of {} {several}", spec.id),
        };
        let (over, from, to) = (spec.input_name(self.free), self.from, self.to);
        format!(
            "{which} on {over} from {from} to {to} with these inputs{because}; choose another range by --from and --to, another number by \
             --over, or other inputs by --set"
        )
    }
}

/// Whether an output changes along a row: from place to place, or where the free number is doubled.
fn changes(member: &Member, along: &Along<'_>, places: &[f32]) -> bool {
    let all: Vec<f32> = places.iter().copied().chain(places.iter().map(|x| 2.0 * x)).collect();
    let mut references = vec![0.0; all.len()];
    member.formula.reference_along(along, &all, &mut references);
    let first = references[0];
    // What the roundings of f64 leave is no change.
    let is_same = |x: &f64| (x - first).abs() <= ROUNDING * x.abs().max(first.abs()) || x.is_nan() && first.is_nan();
    references.iter().any(|x| !is_same(x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::judge::Judge;
    use crate::sweep::{Asked, Over, PRESETS, Refused, SweepPlan};
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::cases::{Kind, Stage};
    use lightmeter_catalogue::select::catalogue;
    use lightmeter_scene::along::float_of;

    /// Floats that are tried from each place of a range on: 4,096 in all.
    const PIECE: u32 = 64;

    /// How many of these floats a shader fails at that reads the free number doubled.
    fn failing(plan: &SweepPlan<'_>) -> u64 {
        let Over::Number { free, row, from, to, output, .. } = &plan.over else { return 0 };
        let along = Along { row, free: *free, output: *output };
        let (first, last) = (key_of(*from), key_of(*to));
        let formula = &*plan.member.formula;
        let judge =
            Judge { formula, along, profile: &WGSL, deviations: &[], whole: (first, u64::from(last - first) + 1) };
        let swept = Swept { member: plan.member, free: *free, from: *from, to: *to, outputs: vec![], is_ready: false };
        let failing = |place: f32| {
            let first = key_of(place);
            let doubled: Vec<f32> = (first..(first + PIECE).min(last + 1)).map(|key| 2.0 * float_of(key)).collect();
            let mut out = vec![0.0; doubled.len()];
            formula.embedded_along(&along, &doubled, &mut out);
            let words: Vec<u32> = out.iter().map(|x| x.to_bits()).collect();
            judge.block(first, &words).failed
        };
        swept.places().into_iter().map(failing).sum()
    }

    /// Whether doubling a number changes an output of a case.
    fn matters(member: &Member, free: usize) -> bool {
        (0..64).any(|k| {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), 7, &mut row);
            let [mut right, mut doubled] = [0; 2].map(|_| vec![0.0; member.spec.output_len()]);
            member.formula.reference(&row, &mut right);
            row[free] *= 2.0;
            member.formula.reference(&row, &mut doubled);
            right.iter().zip(&doubled).any(|(x, y)| (x - y).abs() > 1e-9 * x.abs().max(y.abs()))
        })
    }

    #[test]
    fn a_sweep_over_any_input_fails_where_that_input_is_doubled() {
        let catalogue = catalogue();
        let is_swept = |member: &&Member| match member.spec.kind {
            Kind::Arithmetic => true,
            Kind::Blend(_) => !member.spec.function.is_empty(),
            Kind::Raster(_) | Kind::Depth(_) => false,
        };
        let (mut pairs, mut refused) = (0, 0);
        for member in catalogue.iter().filter(is_swept) {
            for free in 0..member.spec.input_len() {
                let name = || format!("{} over {}", member.spec.id, member.spec.input_name(free));
                let over = Some(member.spec.input_name(free));
                let asked = Asked { over, stage: Some(Stage::Compute), ..Asked::default() };
                pairs += 1;
                match SweepPlan::new(&catalogue, &member.spec.id, &asked) {
                    Ok(plan) => assert!(failing(&plan) > 0, "{}: nothing is seen", name()),
                    Err(why) => {
                        refused += 1;
                        let is_right = matches!(why, Refused::Independent(_)) && !matters(member, free);
                        assert!(is_right, "{}: {why}", name());
                    }
                }
            }
        }
        // Blend states have many: a factor of zero, and constants that are not read.
        assert!(pairs > 9000 && 4 * refused < pairs, "{refused} of {pairs}");
    }

    #[test]
    fn a_ready_made_sweep_is_along_the_row_that_it_says() {
        let catalogue = catalogue();
        for preset in PRESETS {
            let plan = SweepPlan::new(&catalogue, preset.formula, &Asked::default()).expect("a plan");
            assert!(matches!(plan.over, Over::Bytes | Over::Number { is_drawn: false, .. }), "{}", preset.formula);
        }
    }
}
