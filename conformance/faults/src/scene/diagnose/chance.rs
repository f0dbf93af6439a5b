//! Whether an explanation says more than chance would.

use super::{Trial, slack, stored};
use crate::evidence::{Foretold, MOST_FORETOLD, WIDE};
use std::collections::HashSet;

/// The most bits that a component can contribute: where its value lies between the ends of what can be stored (a store in 8 bits never has
/// more than 8), and where it is the darkest or the brightest value, which only tells the direction of the error.
const BITS: [f64; 2] = [16.0, 1.0];

impl Trial<'_> {
    /// How unlikely it is that chance would explain as much, in bits. A component that is explained tells the more, the narrower what is
    /// legal of it, and one like another tells nothing more. That a mistake changes what fails and leaves what passes tells something, too.
    pub(super) fn bits(&self, legal: &[[[f64; 2]; 4]], drawn: &[[f64; 4]]) -> f64 {
        let format = self.image.format;
        let is_unorm = format.is_unorm();
        let ends = |k: usize| {
            let values = self.image.pixels.iter().map(|pixel| pixel[k]).filter(|value| value.is_finite());
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        let ranges: [[f64; 2]; 4] = std::array::from_fn(|k| if is_unorm { [0.0, 255.0] } else { ends(k) });
        // A component of which a mistake leaves so much open tells nothing, be it legal or not; of a store in steps, one tells.
        let right: Vec<[f64; 4]> = self.right.iter().map(|&color| stored(format, color)).collect();
        let widest: [f64; 4] = std::array::from_fn(|k| {
            let all = right.iter().map(|pixel| pixel[k]).filter(|value| value.is_finite());
            let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
            (WIDE * (high - low)).max(0.0)
        });
        let mut told = HashSet::new();
        let mut bits = 0.0;
        for &(place, k) in &self.failing_there {
            let ([low, high], value) = (legal[place][k], self.image.pixels[self.looked_at[place]][k]);
            let is_legal = low <= value && value <= high && value.is_finite();
            if !is_legal || !told.insert((k, value.to_bits(), low.to_bits(), high.to_bits())) {
                continue;
            }
            let [darkest, brightest] = ranges[k];
            let is_at_an_end = is_unorm && (value <= darkest || value >= brightest);
            let step = if is_unorm { 1.0 } else { slack(format, value) };
            if high - low > widest[k].max(step) {
                continue;
            }
            // What comes near to the value that the mistake draws tells as much as narrow bounds do.
            let apart = 2.0 * (value - drawn[place][k]).abs() + step;
            let specific = ((brightest - darkest).max(step) / ((high - low).min(apart) + step)).log2();
            bits += specific.clamp(0.0, BITS[usize::from(is_at_an_end)]);
        }
        // Where a mistake changes what fails and leaves what passes, that tells something, too.
        let is_changed = |place: usize| {
            let right = right[place];
            self.part.components().any(|k| (right[k] - drawn[place][k]).abs() > slack(format, right[k]))
        };
        let wrong: HashSet<usize> = self.failing_there.iter().map(|&(place, _)| place).collect();
        let mut foretold = Foretold::default();
        (0..self.looked_at.len()).for_each(|place| foretold.take(wrong.contains(&place), is_changed(place)));
        bits + foretold.bits().min(MOST_FORETOLD)
    }
}
