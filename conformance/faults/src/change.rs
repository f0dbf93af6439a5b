//! What a mistake does to a formula's inputs before it, and to its outputs after it. Both are addressed by name.

use super::op::Op;
use super::row::Arithmetic;
use lightmeter_catalogue::cases::Spec;
use lightmeter_scene::raster::TARGET_SIZE;
use std::ops::Range;

/// A change to the inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Before {
    /// One of them changes.
    On(&'static str, Op),
    /// Each number of them changes.
    All(Op),
    /// Two of a size exchanged.
    Swap(&'static str, &'static str),
    /// The second gets the first's numbers.
    Copy(&'static str, &'static str),
    /// The first times the second, number by number.
    Times(&'static str, &'static str),
    /// The first and the second added, number by number.
    Plus(&'static str, &'static str),
}

impl Before {
    /// Whether a formula has the inputs that it needs.
    pub(super) fn fits(self, spec: &Spec) -> bool {
        let size = |name: &str| spec.place(name).map(|range| range.len());
        match self {
            Self::On(name, op) => size(name).is_some_and(|count| op.fits(count)),
            Self::All(_) => true,
            Self::Swap(a, b) | Self::Copy(a, b) | Self::Times(a, b) | Self::Plus(a, b) => {
                size(a).is_some() && size(a) == size(b)
            }
        }
    }

    /// Makes the change. Nothing happens where the inputs are not there.
    pub(super) fn apply<R: Arithmetic>(self, spec: &Spec, row: &mut [R]) {
        let place = |name: &str| spec.place(name).unwrap_or_default();
        match self {
            Self::On(name, op) => op.apply(row.get_mut(place(name)).unwrap_or_default()),
            Self::All(op) => op.apply(row),
            Self::Swap(a, b) => place(a).zip(place(b)).for_each(|(a, b)| row.swap(a, b)),
            Self::Copy(from, to) => row.copy_within(place(from), place(to).start),
            Self::Times(a, b) => place(a).zip(place(b)).for_each(|(a, b)| row[a] = row[a] * row[b]),
            Self::Plus(a, b) => place(a).zip(place(b)).for_each(|(a, b)| row[a] = row[a] + row[b]),
        }
    }
}

/// A change to the outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum After {
    /// One of them changes.
    On(&'static str, Op),
    /// Each colour changes.
    Colors(Op),
    /// Every output changes, colours and others.
    All(Op),
    /// The second gets the first's numbers.
    Copy(&'static str, &'static str),
    /// Its last number is that of an input.
    Take(&'static str, &'static str),
    /// The red, green and blue of each colour times an input of one number, or of as many.
    ColorsTimes(&'static str),
    /// A pixel's y counted from below.
    FromBelow,
}

impl After {
    /// Whether a formula has the outputs that it needs.
    pub(super) fn fits(self, spec: &Spec) -> bool {
        let size = |name: &str| outputs(spec).find(|(output, _)| *output == name).map(|(_, range)| range.len());
        let is_color = |fits: &dyn Fn(usize) -> bool| {
            let mut colors = spec.outputs.iter().filter(|output| output.unit == "color" && output.name != "opacity");
            colors.any(|output| fits(output.shape.components()))
        };
        match self {
            Self::On(name, op) => size(name).is_some_and(|count| op.fits(count)),
            Self::Colors(op) => is_color(&|count| op.fits(count)),
            Self::All(Op::Bytes) => is_color(&|_| true) && spec.outputs.iter().any(|output| output.unit != "color"),
            Self::All(_) => true,
            Self::Copy(a, b) => size(a).is_some() && size(a) == size(b),
            Self::Take(output, input) => {
                size(output) == Some(4) && spec.place(input).is_some_and(|range| range.len() == 4)
            }
            Self::ColorsTimes(input) => {
                let numbers = spec.place(input).map_or(0, |range| range.len());
                is_color(&|count| count >= 3) && (numbers == 1 || numbers >= 3)
            }
            Self::FromBelow => spec.id == "interpolation/raster-position",
        }
    }

    /// Makes the change. Nothing happens where the outputs are not there.
    pub(super) fn apply<R: Arithmetic>(self, spec: &Spec, row: &[R], out: &mut [R]) {
        let place = |name: &str| outputs(spec).find(|(output, _)| *output == name).map(|(_, range)| range);
        match self {
            Self::On(name, op) => op.apply(place(name).and_then(|range| out.get_mut(range)).unwrap_or_default()),
            Self::Colors(op) => {
                for (output, (_, range)) in spec.outputs.iter().zip(outputs(spec)) {
                    if let Some(color) = out.get_mut(range)
                        && output.unit == "color"
                        && op.fits(color.len())
                    {
                        op.apply(color);
                    }
                }
            }
            Self::All(op) => op.apply(out),
            Self::Copy(from, to) => {
                if let (Some(from), Some(to)) = (place(from), place(to)) {
                    out.copy_within(from, to.start);
                }
            }
            Self::Take(output, input) => {
                let taken = spec.place(input).and_then(|range| row.get(range)?.last());
                if let (Some(&x), Some(last)) = (taken, place(output).and_then(|range| out.get_mut(range)?.last_mut()))
                {
                    *last = x;
                }
            }
            Self::ColorsTimes(input) => {
                let factors = spec.place(input).and_then(|range| row.get(range)).unwrap_or_default();
                for (output, (_, range)) in spec.outputs.iter().zip(outputs(spec)) {
                    if output.unit == "color" && range.len() >= 3 && !factors.is_empty() {
                        let colors = out.get_mut(range).unwrap_or_default();
                        colors.iter_mut().take(3).zip(factors.iter().cycle()).for_each(|(x, &by)| *x = *x * by);
                    }
                }
            }
            Self::FromBelow => {
                if let [_, y, ..] = out {
                    *y = R::literal(f64::from(TARGET_SIZE)) - *y;
                }
            }
        }
    }
}

/// Each output's name and place.
fn outputs(spec: &Spec) -> impl Iterator<Item = (&'static str, Range<usize>)> {
    spec.outputs.iter().scan(0, |start, output| {
        let from = *start;
        *start += output.shape.components();
        Some((output.name, from..*start))
    })
}
