//! Which of the (15 × 15 × 5)² states with another one for alpha are judged: a covering array, and samples.

use lightmeter_scene::blend::{Equation, Factor, Separate, State};

/// Which states with another one for alpha are judged, besides the covering array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Samples {
    /// The seed that they are drawn by.
    pub seed: u64,
    /// How many of the (15 × 15 × 5)².
    pub count: u64,
    /// Some by name.
    pub named: Vec<Separate>,
}

impl Default for Samples {
    fn default() -> Self {
        Self { seed: 1, count: 256, named: vec![] }
    }
}

/// The states that an id below `blend/separate` names.
#[must_use]
pub fn separate_of(id: &str) -> Option<Separate> {
    let mut segments = id.strip_prefix("blend/separate/")?.split('/');
    let color = State::from_segment(segments.next()?)?;
    let alpha = State::from_segment(segments.next()?)?;
    Some(Separate { color, alpha })
}

/// States of which every pair of values of two of the six parameters (two factors and an equation for the colour, the same
/// for the alpha) stands in some row *where neither is ignored*.
///
/// 225 rows hold the factors as an orthogonal array of strength 2: over i, j in ℤ/15 the columns i, j, i + j and i + 2j, of
/// which any two determine i and j, so that every pair of factors stands in exactly one row. Their equations read the
/// factors. 60 rows put MIN and MAX on one side and every factor on the other, 4 on both sides.
#[must_use]
pub fn covering_array() -> Vec<Separate> {
    let factor = |n: usize| Factor::ALL[n % 15];
    let (reading, ignoring) =
        ([Equation::Add, Equation::Subtract, Equation::ReverseSubtract], [Equation::Min, Equation::Max]);
    let state = |equation, src, dst| State { equation, src, dst };
    let mut rows = vec![];
    for (i, j) in (0..15).flat_map(|i| (0..15).map(move |j| (i, j))) {
        rows.push(Separate {
            color: state(reading[(i + j / 3) % 3], factor(i), factor(j)),
            alpha: state(reading[(i / 3 + j) % 3], factor(i + j), factor(i + 2 * j)),
        });
    }
    for equation in ignoring {
        let ignores = state(equation, Factor::One, Factor::One);
        for i in 0..15 {
            let reads = state(reading[i % 3], factor(i), factor(i + 1));
            rows.push(Separate { color: ignores, alpha: reads });
            rows.push(Separate { color: reads, alpha: ignores });
        }
        rows.extend(ignoring.map(|other| Separate { color: ignores, alpha: state(other, Factor::One, Factor::One) }));
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// The six parameters, and which of them are ignored.
    fn parameters(state: Separate) -> [(u32, bool); 6] {
        let of = |state: State| {
            let ignored = state.equation.ignores_factors();
            [(state.equation.code(), false), (state.src.code(), ignored), (state.dst.code(), ignored)]
        };
        let ([a, b, c], [d, e, f]) = (of(state.color), of(state.alpha));
        [a, b, c, d, e, f]
    }

    #[test]
    fn every_pair_of_parameters_takes_effect_in_some_row() {
        let rows: Vec<_> = covering_array().into_iter().map(parameters).collect();
        assert_eq!(rows.len(), 225 + 60 + 4);
        let levels = [5, 15, 15, 5, 15, 15];
        for (p, q) in (0..6).flat_map(|p| (p + 1..6).map(move |q| (p, q))) {
            let mut seen = BTreeSet::new();
            for row in &rows {
                if !row[p].1 && !row[q].1 {
                    seen.insert((row[p].0, row[q].0));
                }
            }
            // A factor beside its own side's MIN or MAX is ignored, so those pairs have no effect to cover.
            let same_side = p / 3 == q / 3 && p % 3 == 0;
            let wanted = if same_side { 3 * 15 } else { levels[p] * levels[q] };
            assert_eq!(seen.len(), wanted, "parameters {p} and {q}");
        }
    }
}
