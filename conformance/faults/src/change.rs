//! What a mistake does to a formula's inputs before it, and to its outputs after it.

use lightmeter_catalogue::cases::{Spec, ValueShape};
use lightmeter_reference::Real;
use lightmeter_reference::color::{srgb_decode, srgb_encode};
use lightmeter_scene::raster::TARGET_SIZE;
use std::ops::Range;

/// A change to the inputs, which are addressed by name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Before {
    /// x → −x.
    Negate(&'static str),
    /// Two inputs of a size exchanged.
    Swap(&'static str, &'static str),
    /// x → x·factor.
    Scale(&'static str, f64),
    /// x → x + offset.
    Offset(&'static str, f64),
    /// Every number of it → this one.
    Set(&'static str, f64),
    /// The second gets the first's numbers.
    Copy(&'static str, &'static str),
    /// The first times the second, number by number.
    Times(&'static str, &'static str),
    /// x → x².
    Square(&'static str),
    /// x → 1/x.
    Reciprocal(&'static str),
    /// A cosine → the sine of its angle.
    Sine(&'static str),
    /// A cosine → that of half its angle.
    HalfAngle(&'static str),
    /// A cosine → that of twice its angle.
    DoubleAngle(&'static str),
    /// x → max(x, bound).
    AtLeast(&'static str, f64),
    /// The last number first.
    Rotate(&'static str),
    /// Columns taken for rows.
    Transpose(&'static str),
    /// A matrix without its translation.
    NoTranslation(&'static str),
    /// A colour decoded as if it were sRGB.
    Decode(&'static str),
    /// RGB times alpha.
    Premultiply(&'static str),
}

impl Before {
    /// Whether a formula has the inputs that it needs.
    pub(super) fn fits(self, spec: &Spec) -> bool {
        let shape = |name: &str| spec.inputs.iter().find(|input| input.name == name).map(|input| input.shape);
        match self {
            Self::Swap(a, b) | Self::Copy(a, b) | Self::Times(a, b) => shape(a).is_some() && shape(a) == shape(b),
            Self::Rotate(x) => shape(x).is_some_and(|shape| shape != ValueShape::Scalar),
            Self::Decode(x) => matches!(shape(x), Some(ValueShape::Vec3 | ValueShape::Vec4)),
            Self::Premultiply(x) => shape(x) == Some(ValueShape::Vec4),
            Self::Transpose(x) => matches!(shape(x), Some(ValueShape::Mat3 | ValueShape::Mat4)),
            Self::NoTranslation(x) => shape(x) == Some(ValueShape::Mat4),
            Self::Negate(x)
            | Self::Scale(x, _)
            | Self::Offset(x, _)
            | Self::AtLeast(x, _)
            | Self::Set(x, _)
            | Self::Square(x)
            | Self::Reciprocal(x)
            | Self::Sine(x)
            | Self::HalfAngle(x)
            | Self::DoubleAngle(x) => shape(x).is_some(),
        }
    }

    /// Makes the change. Nothing happens where the inputs are not there.
    pub(super) fn apply<R: Real>(self, spec: &Spec, row: &mut [R]) {
        let (zero, one) = (R::literal(0.0), R::literal(1.0));
        let mut each = |name: &str, f: &dyn Fn(R) -> R| {
            for x in spec.place(name).and_then(|range| row.get_mut(range)).into_iter().flatten() {
                *x = f(*x);
            }
        };
        match self {
            Self::Negate(name) => each(name, &|x| -x),
            Self::Scale(name, factor) => each(name, &|x| x * R::literal(factor)),
            Self::Offset(name, offset) => each(name, &|x| x + R::literal(offset)),
            Self::AtLeast(name, bound) => each(name, &|x| x.max(R::literal(bound))),
            Self::Set(name, value) => each(name, &|_| R::literal(value)),
            Self::Square(name) => each(name, &|x| x * x),
            Self::Reciprocal(name) => each(name, &|x| one / x),
            Self::Sine(name) => each(name, &|c| root((one - c * c).max(zero))),
            Self::HalfAngle(name) => each(name, &|c| root(((one + c) * R::literal(0.5)).max(zero))),
            Self::DoubleAngle(name) => each(name, &|c| R::product([R::literal(2.0), c, c]) - one),
            Self::Swap(a, b) => {
                if let (Some(a), Some(b)) = (spec.place(a), spec.place(b)) {
                    a.zip(b).for_each(|(a, b)| row.swap(a, b));
                }
            }
            Self::Times(a, b) => {
                if let (Some(a), Some(b)) = (spec.place(a), spec.place(b)) {
                    a.zip(b).for_each(|(a, b)| row[a] = row[a] * row[b]);
                }
            }
            Self::Copy(from, to) => {
                if let (Some(from), Some(to)) = (spec.place(from), spec.place(to)) {
                    row.copy_within(from, to.start);
                }
            }
            Self::Rotate(name) => part(spec, name, row).rotate_right(1),
            Self::Transpose(name) => transpose(part(spec, name, row)),
            Self::NoTranslation(name) => {
                part(spec, name, row).iter_mut().skip(12).take(3).for_each(|x| *x = zero);
            }
            Self::Decode(name) => {
                part(spec, name, row).iter_mut().take(3).for_each(|e| *e = srgb_decode(e.clamp(zero, one)));
            }
            Self::Premultiply(name) => {
                let color = part(spec, name, row);
                if let [r, g, b, a] = *color {
                    color.copy_from_slice(&[r * a, g * a, b * a, a]);
                }
            }
        }
    }
}

/// √x, and 0 of 0: the arithmetic's own root has no value there.
fn root<R: Real>(x: R) -> R {
    let zero = R::literal(0.0);
    R::if_ge(zero, x, || zero, || x.sqrt())
}

/// An input's numbers; none where it is not there.
fn part<'a, R>(spec: &Spec, name: &str, row: &'a mut [R]) -> &'a mut [R] {
    let range: Range<usize> = spec.place(name).unwrap_or_default();
    row.get_mut(range).unwrap_or_default()
}

fn transpose<R: Copy>(m: &mut [R]) {
    let side = if m.len() == 16 { 4 } else { 3 };
    for (column, line) in (0..side).flat_map(|column| (0..column).map(move |line| (column, line))) {
        m.swap(column * side + line, line * side + column);
    }
}

/// A change to the outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum After {
    /// Colours → c^(1/2.2), alpha as it is.
    Gamma,
    /// Colours encoded as sRGB.
    Srgb,
    /// Colours decoded as sRGB.
    Decode,
    /// Colours limited to [0, 1].
    Clamp,
    /// Red and blue exchanged.
    RedBlue,
    /// Colours cut to whole 255ths.
    Truncate,
    /// Colours rounded to whole 255ths.
    Round,
    /// A pixel's y counted from below.
    FromBelow,
    /// Every output limited to [0, 1] and rounded to whole 255ths.
    RoundAll,
    /// Red, green and blue times alpha.
    Premultiply,
    /// Alpha made 1.
    Opaque,
    /// An output made to this one.
    Set(&'static str, f64),
    /// An output x → 1 − x.
    OneMinus(&'static str),
    /// An output x → −x.
    Negate(&'static str),
    /// An output times a factor.
    Scale(&'static str, f64),
    /// An output → 1/x.
    Reciprocal(&'static str),
    /// The second gets the first's numbers.
    Copy(&'static str, &'static str),
    /// An output limited to at most 1.
    AtMostOne(&'static str),
}

impl After {
    /// Whether a formula has the outputs that it needs.
    pub(super) fn fits(self, spec: &Spec) -> bool {
        let shape = |name: &str| spec.outputs.iter().find(|output| output.name == name).map(|output| output.shape);
        let color = |fits: fn(ValueShape) -> bool| {
            spec.outputs.iter().any(|output| output.unit == "color" && output.name != "opacity" && fits(output.shape))
        };
        match self {
            Self::Gamma | Self::Srgb | Self::Decode | Self::Clamp | Self::Truncate | Self::Round => color(|_| true),
            Self::FromBelow => spec.id == "interpolation/raster-position",
            Self::RoundAll => color(|_| true) && spec.outputs.iter().any(|output| output.unit != "color"),
            Self::RedBlue => color(|shape| shape != ValueShape::Scalar),
            Self::Premultiply | Self::Opaque => color(|shape| shape == ValueShape::Vec4),
            Self::Copy(a, b) => shape(a).is_some() && shape(a) == shape(b),
            Self::Set(name, _)
            | Self::OneMinus(name)
            | Self::Negate(name)
            | Self::Scale(name, _)
            | Self::Reciprocal(name)
            | Self::AtMostOne(name) => shape(name).is_some(),
        }
    }

    /// Makes the change. Nothing happens where the outputs are not there.
    pub(super) fn apply<R: Real>(self, spec: &Spec, out: &mut [R]) {
        let (zero, one) = (R::literal(0.0), R::literal(1.0));
        let unit = |x: R| x.clamp(zero, one);
        let byte = R::literal(255.0);
        let mut named = |name: &str, f: &dyn Fn(R) -> R| {
            if let Some((_, range)) = places(spec).find(|(output, _)| *output == name) {
                out.get_mut(range).into_iter().flatten().for_each(|x| *x = f(*x));
            }
        };
        match self {
            Self::Set(name, value) => named(name, &|_| R::literal(value)),
            Self::OneMinus(name) => named(name, &|x| one - x),
            Self::Negate(name) => named(name, &|x| -x),
            Self::Scale(name, factor) => named(name, &|x| x * R::literal(factor)),
            Self::Reciprocal(name) => named(name, &|x| one / x),
            Self::AtMostOne(name) => named(name, &|x| x.min(one)),
            Self::Gamma => colors(spec, out, 3, |c| c.lobe(R::literal(1.0 / 2.2))),
            Self::Srgb => colors(spec, out, 3, |c| srgb_encode(unit(c))),
            Self::Decode => colors(spec, out, 3, |e| srgb_decode(unit(e))),
            Self::Clamp => colors(spec, out, 4, unit),
            Self::Truncate => colors(spec, out, 4, |c| (byte * unit(c)).floor_then(|n| R::literal(n) / byte)),
            Self::Round => colors(spec, out, 4, |c| (byte * unit(c)).round() / byte),
            Self::FromBelow => {
                if let [_, y, ..] = out {
                    *y = R::literal(f64::from(TARGET_SIZE)) - *y;
                }
            }
            Self::RoundAll => out.iter_mut().for_each(|x| *x = (byte * unit(*x)).round() / byte),
            Self::RedBlue => each_color(spec, out, |color| {
                if color.len() > 2 {
                    color.swap(0, 2);
                }
            }),
            Self::Premultiply => each_color(spec, out, |color| {
                if let [r, g, b, a] = *color {
                    color.copy_from_slice(&[r * a, g * a, b * a, a]);
                }
            }),
            Self::Opaque => each_color(spec, out, |color| {
                if let [_, _, _, a] = color {
                    *a = one;
                }
            }),
            Self::Copy(from, to) => {
                let place = |name: &str| places(spec).find(|(output, _)| *output == name).map(|(_, range)| range);
                if let (Some(from), Some(to)) = (place(from), place(to)) {
                    out.copy_within(from, to.start);
                }
            }
        }
    }
}

/// Each output's name and place.
fn places(spec: &Spec) -> impl Iterator<Item = (&'static str, Range<usize>)> {
    spec.outputs.iter().scan(0, |start, output| {
        let from = *start;
        *start += output.shape.components();
        Some((output.name, from..*start))
    })
}

/// Each colour among the outputs.
fn each_color<R>(spec: &Spec, out: &mut [R], f: impl Fn(&mut [R])) {
    for (output, (_, range)) in spec.outputs.iter().zip(places(spec)) {
        if let Some(part) = out.get_mut(range)
            && output.unit == "color"
        {
            f(part);
        }
    }
}

/// The first numbers of each colour.
fn colors<R: Copy>(spec: &Spec, out: &mut [R], count: usize, f: impl Fn(R) -> R) {
    each_color(spec, out, |color| color.iter_mut().take(count).for_each(|x| *x = f(*x)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transposed_matrix_has_columns_for_rows() {
        let mut m: Vec<f64> = (0..9).map(f64::from).collect();
        transpose(&mut m);
        assert_eq!(m, [0.0, 3.0, 6.0, 1.0, 4.0, 7.0, 2.0, 5.0, 8.0]);
        let mut m: Vec<f64> = (0..16).map(f64::from).collect();
        let before = m.clone();
        transpose(&mut m);
        assert_eq!((m[1], m[4], m[11], m[14]), (4.0, 1.0, 14.0, 11.0));
        transpose(&mut m);
        assert_eq!(m, before);
    }
}
