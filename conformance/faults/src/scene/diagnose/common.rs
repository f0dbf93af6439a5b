//! What failing components have in common where nothing explains them.

use super::{NAMES, PixelPart, Trial, real};

/// What failing components have in common is told where so large a part of them has it.
const COMMON: f64 = 0.95;

impl Trial<'_> {
    /// The colour of an image whose pixels are all the same in these components, in the target's units; `None` for any other image. Such an
    /// image shows nothing about which mistake was made.
    pub(super) fn flat(&self) -> Option<[f64; 4]> {
        let (first, rest) = self.image.pixels.split_first()?;
        let is_same = |pixel: &[f64; 4]| self.part.components().all(|k| pixel[k].to_bits() == first[k].to_bits());
        (!rest.is_empty() && rest.iter().all(is_same)).then_some(*first)
    }

    /// What failing components have in common where nothing explains them.
    pub(super) fn in_common(&self) -> Vec<String> {
        if let Some([r, g, b, a]) = self.flat() {
            return vec![match self.part {
                PixelPart::Whole => format!("the whole image is {r} {g} {b} {a}"),
                PixelPart::Color => format!("the whole image is {r} {g} {b}"),
                PixelPart::Alpha => format!("alpha is {a} in the whole image"),
            }];
        }
        [self.component(), self.sign(), self.region()].into_iter().flatten().collect()
    }

    /// The one component that nearly all failing ones are of.
    fn component(&self) -> Option<String> {
        let components = if self.part == PixelPart::Alpha { 0..0 } else { 0..4 };
        components.into_iter().find_map(|k| {
            let how_many = self.share(|number| number % 4 == k)?;
            Some(format!("{how_many} are {}", NAMES[k]))
        })
    }

    /// Whether nearly all are too great, or too small.
    fn sign(&self) -> Option<String> {
        let (value, legal) =
            (|number: usize| self.image.pixels[number / 4][number % 4], |number| &self.expected[number / 4]);
        let great = self.share(|number| value(number) > legal(number).high[number % 4]);
        let small = self.share(|number| value(number) < legal(number).low[number % 4]);
        let no_number = self.share(|number| value(number).is_nan());
        let told = [(great, "too great"), (small, "too small"), (no_number, "not a number")];
        told.into_iter().find_map(|(how_many, what)| Some(format!("{} are {what}", how_many?)))
    }

    /// The rectangle that holds all of them, where it is less than half of the image.
    fn region(&self) -> Option<String> {
        let width = self.image.width;
        let (mut columns, mut rows) = ([usize::MAX, 0], [usize::MAX, 0]);
        for number in &self.failing {
            let (x, y) = (number / 4 % width, number / 4 / width);
            columns = [columns[0].min(x), columns[1].max(x)];
            rows = [rows[0].min(y), rows[1].max(y)];
        }
        let area = (columns[1] - columns[0] + 1) * (rows[1] - rows[0] + 1);
        let [[left, right], [top, bottom]] = [columns, rows];
        (2 * area < self.image.pixels.len())
            .then(|| format!("all are in columns {left} to {right} and rows {top} to {bottom}"))
    }

    /// How many of the failing components have something: `all`, `nearly all`, or else nothing to be told.
    fn share(&self, has: impl Fn(usize) -> bool) -> Option<&'static str> {
        let count = self.failing.iter().filter(|&&number| has(number)).count();
        match count {
            all if all == self.failing.len() => Some("all"),
            count if real(count) >= COMMON * real(self.failing.len()) => Some("nearly all"),
            _ => None,
        }
    }
}
