//! What a mistake does to numbers: those of an input, of a step, of what a step is given, or of an output.

use super::row::{Arithmetic, Narrowing};
use lightmeter_reference::Vector;
use lightmeter_reference::color::{srgb_decode, srgb_encode};

/// A change to a few numbers that belong together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    /// x → −x.
    Negate,
    /// x → |x|.
    Abs,
    /// x → x·factor.
    Scale(f64),
    /// x → x + offset.
    Offset(f64),
    /// x → this one.
    Set(f64),
    /// x → x².
    Square,
    /// x → √x.
    Root,
    /// x → 1/x.
    Reciprocal,
    /// x → 1 − x.
    OneMinus,
    /// x → 1 − (1 − x): what is small is lost in the rounding of 1.
    Complement,
    /// A cosine → the sine of its angle.
    Sine,
    /// A cosine → that of half its angle.
    HalfAngle,
    /// A cosine → that of twice its angle.
    DoubleAngle,
    /// x → max(x, bound).
    AtLeast(f64),
    /// x → min(x, bound).
    AtMost(f64),
    /// x → min(max(x, 0), 1).
    Clamp,
    /// x → ⌊x⌋.
    Floor,
    /// x → the nearest whole number.
    Round,
    /// x → 3x² − 2x³.
    Smoothstep,
    /// x → max(x, 0)^exponent.
    Power(f64),
    /// x → 2^x.
    Exp2,
    /// Encoded as sRGB, once limited to [0, 1].
    Encode,
    /// Decoded as sRGB, once limited to [0, 1].
    Decode,
    /// Cut to whole 255ths, once limited to [0, 1].
    Truncate,
    /// Cut to whole 255ths, however great.
    Cut,
    /// Rounded to whole 255ths, once limited to [0, 1].
    Bytes,
    /// In half precision: 11 bits, from 2⁻¹⁴ to 65504.
    Half,
    /// The same, the last bits cut off.
    HalfCut,
    /// In bfloat16: 8 bits.
    BFloat,
    /// The same, the last bits cut off.
    BFloatCut,
    /// v → v/|v|.
    Normalize,
    /// v by an inverse square root from the bits of v·v and one step of Newton's, right to 0.18 %.
    FastNormalize,
    /// v → v/|v|, of the zero vector too.
    NormalizeAny,
    /// v → v/|v| where |v| is at least so much, and 0 elsewhere.
    NormalizeFrom(f64),
    /// v → v/|v|, and of the zero vector the z axis.
    NormalizeOrZ,
    /// v → v/(|v| + epsilon).
    OverLengthPlus(f64),
    /// v → v/max(|v|, epsilon).
    OverLengthAtLeast(f64),
    /// v → v/Σ|vᵢ|.
    OverSum,
    /// v → v/max|vᵢ|.
    OverLargest,
    /// v → v/|v|².
    OverSquare,
    /// The last number first.
    Rotate,
    /// The first number for the third, and the reverse.
    RedBlue,
    /// Columns taken for rows.
    Transpose,
    /// A matrix that changes nothing.
    Identity,
    /// The last number for the one before, and the reverse.
    SwapLast,
    /// A 4 × 4 matrix without its translation.
    NoTranslation,
    /// Depth of a position in clip space from [−w, w] for [0, w].
    FromMinusOne,
    /// Red, green and blue times alpha.
    Premultiply,
    /// Alpha → 1.
    Opaque,
    /// Of the first three numbers.
    Rgb(&'static Op),
    /// Of one of the numbers.
    Component(usize, &'static Op),
}

impl Op {
    /// Whether `count` numbers can be changed in this way.
    pub(super) const fn fits(self, count: usize) -> bool {
        match self {
            Self::Rotate | Self::SwapLast => count > 1,
            Self::RedBlue => count == 3 || count == 4,
            Self::Normalize
            | Self::NormalizeAny
            | Self::FastNormalize
            | Self::NormalizeFrom(_)
            | Self::NormalizeOrZ
            | Self::OverLengthPlus(_)
            | Self::OverLengthAtLeast(_)
            | Self::OverSum
            | Self::OverLargest
            | Self::OverSquare => count == 3,
            Self::Transpose | Self::Identity => count == 9 || count == 16,
            Self::NoTranslation => count == 16,
            Self::Premultiply | Self::Opaque | Self::FromMinusOne => count == 4,
            Self::Component(place, _) => place < count,
            _ => count > 0,
        }
    }

    /// Makes the change.
    pub(super) fn apply<R: Arithmetic>(self, numbers: &mut [R]) {
        let one = R::literal(1.0);
        match self {
            Self::Rotate => numbers.rotate_right(1),
            Self::RedBlue => numbers.swap(0, 2),
            Self::SwapLast => numbers.swap(numbers.len() - 2, numbers.len() - 1),
            Self::Transpose => transpose(numbers),
            Self::Identity => {
                let side = if numbers.len() == 16 { 4 } else { 3 };
                let of = |place: usize| R::literal(if place.is_multiple_of(side + 1) { 1.0 } else { 0.0 });
                numbers.iter_mut().enumerate().for_each(|(place, x)| *x = of(place));
            }
            Self::NoTranslation => numbers.iter_mut().skip(12).take(3).for_each(|x| *x = R::literal(0.0)),
            Self::Premultiply => {
                if let [r, g, b, a] = *numbers {
                    numbers.copy_from_slice(&[r * a, g * a, b * a, a]);
                }
            }
            Self::FromMinusOne => {
                if let [_, _, z, w] = numbers {
                    *z = (*z + *w) * R::literal(0.5);
                }
            }
            Self::Opaque => {
                if let [_, _, _, alpha] = numbers {
                    *alpha = one;
                }
            }
            Self::Normalize
            | Self::FastNormalize
            | Self::NormalizeFrom(_)
            | Self::NormalizeOrZ
            | Self::OverLengthPlus(_)
            | Self::OverLengthAtLeast(_)
            | Self::OverSum
            | Self::OverLargest
            | Self::OverSquare => divide(self, numbers),
            Self::NormalizeAny => {
                if let [x, y, z] = *numbers {
                    numbers.copy_from_slice(&R::normalize([x, y, z]));
                }
            }
            Self::Rgb(op) => {
                let count = numbers.len().min(3);
                op.apply(&mut numbers[..count]);
            }
            Self::Component(place, op) => {
                if let Some(number) = numbers.get_mut(place) {
                    op.apply(std::slice::from_mut(number));
                }
            }
            _ => numbers.iter_mut().for_each(|x| *x = self.of(*x)),
        }
    }

    /// The change to a number alone.
    fn of<R: Arithmetic>(self, x: R) -> R {
        let (zero, one) = (R::literal(0.0), R::literal(1.0));
        let unit = |x: R| x.clamp(zero, one);
        let byte = R::literal(255.0);
        match self {
            Self::Negate => -x,
            Self::Abs => x.abs(),
            Self::Scale(factor) => x * R::literal(factor),
            Self::Offset(offset) => x + R::literal(offset),
            Self::Set(value) => R::literal(value),
            Self::Square => x * x,
            Self::Root => root(x.max(zero)),
            Self::Reciprocal => one / x,
            Self::OneMinus => one - x,
            Self::Complement => one - (one - x),
            Self::Sine => root((one - x * x).max(zero)),
            Self::HalfAngle => root(((one + x) * R::literal(0.5)).max(zero)),
            Self::DoubleAngle => R::product([R::literal(2.0), x, x]) - one,
            Self::AtLeast(bound) => x.max(R::literal(bound)),
            Self::AtMost(bound) => x.min(R::literal(bound)),
            Self::Clamp => unit(x),
            Self::Floor => x.floor_then(R::literal),
            Self::Round => x.round(),
            Self::Smoothstep => R::product([x, x, R::literal(3.0) - R::literal(2.0) * x]),
            Self::Power(exponent) => x.lobe(R::literal(exponent)),
            Self::Exp2 => x.exp2(),
            Self::Encode => srgb_encode(unit(x)),
            Self::Decode => srgb_decode(unit(x)),
            Self::Truncate => (byte * unit(x)).floor_then(|n| R::literal(n) / byte),
            Self::Cut => (byte * x).floor_then(|n| R::literal(n) / byte),
            Self::Bytes => (byte * unit(x)).round() / byte,
            Self::Half => x.in_half(Narrowing::Rounded),
            Self::HalfCut => x.in_half(Narrowing::Cut),
            Self::BFloat => x.in_bfloat(Narrowing::Rounded),
            Self::BFloatCut => x.in_bfloat(Narrowing::Cut),
            _ => x,
        }
    }
}

/// √x, and 0 of 0: the arithmetic's own root has no value there.
pub(super) fn root<R: Arithmetic>(x: R) -> R {
    let zero = R::literal(0.0);
    R::if_ge(zero, x, || zero, || x.sqrt())
}

/// A vector over its length, or over what is taken for it; 0 of the zero vector.
fn divide<R: Arithmetic>(op: Op, numbers: &mut [R]) {
    let zero = R::literal(0.0);
    let [x, y, z] = *numbers else { return };
    let square = R::sum([x * x, y * y, z * z]);
    let length = || R::if_ge(zero, square, || zero, || square.sqrt());
    let by = match op {
        Op::OverLengthPlus(epsilon) => length() + R::literal(epsilon),
        Op::OverLengthAtLeast(epsilon) => length().max(R::literal(epsilon)),
        Op::OverSum => R::sum([x.abs(), y.abs(), z.abs()]),
        Op::OverLargest => x.abs().max(y.abs()).max(z.abs()),
        _ => square,
    };
    let divided = || {
        Vector(match op {
            Op::Normalize | Op::NormalizeOrZ => R::normalize([x, y, z]),
            Op::NormalizeFrom(least) => {
                R::if_ge(square, R::literal(least * least), || Vector(R::normalize([x, y, z])), || Vector([zero; 3])).0
            }
            Op::FastNormalize => {
                let inverse = square.fast_inverse_sqrt();
                [x, y, z].map(|c| c * inverse)
            }
            _ => [x, y, z].map(|c| c / by),
        })
    };
    let of_zero = if op == Op::NormalizeOrZ { R::literal(1.0) } else { zero };
    let divided = R::if_ge(zero, by, || Vector([zero, zero, of_zero]), divided);
    numbers.copy_from_slice(&divided.0);
}

fn transpose<R: Copy>(m: &mut [R]) {
    let side = if m.len() == 16 { 4 } else { 3 };
    for (column, line) in (0..side).flat_map(|column| (0..column).map(move |line| (column, line))) {
        m.swap(column * side + line, line * side + column);
    }
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

    #[test]
    fn numbers_change_as_they_are_said_to() {
        let changed = |op: Op, numbers: &[f64]| {
            let mut numbers = numbers.to_vec();
            op.apply(&mut numbers);
            numbers
        };
        assert_eq!(changed(Op::Rgb(&Op::Negate), &[1.0, 2.0, 3.0, 4.0]), [-1.0, -2.0, -3.0, 4.0]);
        assert_eq!(changed(Op::Component(1, &Op::Square), &[2.0, 3.0]), [2.0, 9.0]);
        assert_eq!(changed(Op::OverSum, &[1.0, -2.0, 1.0]), [0.25, -0.5, 0.25]);
        assert_eq!(changed(Op::Normalize, &[0.0; 3]), [0.0; 3]);
        assert_eq!(changed(Op::NormalizeOrZ, &[0.0; 3]), [0.0, 0.0, 1.0]);
        assert_eq!(changed(Op::NormalizeOrZ, &[0.0, -2.0, 0.0]), [0.0, -1.0, 0.0]);
        assert_eq!(changed(Op::Half, &[1.0 + 1.0 / 4096.0, 70000.0, 1e-9]), [1.0, f64::INFINITY, 0.0]);
        assert_eq!(changed(Op::HalfCut, &[2.0 - 1.0 / 4096.0, 70000.0]), [2.0 - 1.0 / 1024.0, f64::INFINITY]);
        assert_eq!(changed(Op::BFloat, &[1.0 + 1.0 / 512.0]), [1.0]);
        assert_eq!(changed(Op::BFloatCut, &[-2.0 + 1.0 / 512.0]), [-2.0 + 1.0 / 128.0]);
    }
}
