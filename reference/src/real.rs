//! The arithmetic that formulas are written over, and its two plain instances, `f64` and `f32`.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// An arithmetic.
///
/// The plain instances compute; others enclose, differentiate or record. Operations that a shading language may carry
/// out in several legal ways (the order of a chain, `mix`, `normalize`, Horner's scheme) are methods with a default, so
/// that an enclosing arithmetic can return the union of them.
pub trait Real:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// An input of a formula.
    fn input(x: f32) -> Self;

    /// A constant of a formula, which a shader has as the nearest f32.
    fn literal(x: f64) -> Self;

    /// max(self, other); exact. Of two zeros it is the other.
    fn max(self, other: Self) -> Self;

    /// min(self, other); exact. Of two zeros it is the other.
    fn min(self, other: Self) -> Self;

    /// |self|; exact.
    fn abs(self) -> Self;

    /// The nearest whole number; at a tie the even one.
    fn round(self) -> Self;

    /// √self, for self ≥ 0.
    fn sqrt(self) -> Self;

    /// 1/√self, for self > 0.
    fn inverse_sqrt(self) -> Self;

    /// e^self.
    fn exp(self) -> Self;

    /// 2^self.
    fn exp2(self) -> Self;

    /// log₂ self, for self > 0.
    fn log2(self) -> Self;

    /// self^exponent, for self > 0.
    fn pow(self, exponent: Self) -> Self;

    /// `then` where a ≥ b, `otherwise` elsewhere; the hull of both where that is undecided.
    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T;

    /// x₀ + x₁ + … in any order.
    #[must_use]
    fn sum<const N: usize>(terms: [Self; N]) -> Self {
        terms.into_iter().reduce(Add::add).unwrap_or_else(|| Self::literal(0.0))
    }

    /// The same of as many terms as there are.
    #[must_use]
    fn sum_over(terms: impl Iterator<Item = Self>) -> Self {
        terms.reduce(Add::add).unwrap_or_else(|| Self::literal(0.0))
    }

    /// x₀ · x₁ · … in any order.
    #[must_use]
    fn product<const N: usize>(factors: [Self; N]) -> Self {
        factors.into_iter().reduce(Mul::mul).unwrap_or_else(|| Self::literal(1.0))
    }

    /// min(max(self, low), high), for low ≤ high; exact.
    #[must_use]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }

    /// a(1 − t) + b·t. The other legal form is a + t(b − a).
    #[must_use]
    fn mix(a: Self, b: Self, t: Self) -> Self {
        a * (Self::literal(1.0) - t) + b * t
    }

    /// The mix of two differences from one number: `to_a` is from − a, and `to_b` from − b. The other legal form is from − mix(a, b, t).
    #[must_use]
    fn mix_of_differences([to_a, to_b]: [Self; 2], _from: Self, [_a, _b]: [Self; 2], t: Self) -> Self {
        Self::mix(to_a, to_b, t)
    }

    /// v / |v|. The other legal form is v · 1/√(v·v). The vector must not be zero.
    #[must_use]
    fn normalize<const N: usize>(v: [Self; N]) -> [Self; N] {
        let length = Self::sum(v.map(|x| x * x)).sqrt();
        v.map(|x| x / length)
    }

    /// c₀ + c₁x + c₂x². The other legal form is c₀ + x(c₁ + x·c₂).
    #[must_use]
    fn quadratic([c0, c1, c2]: [Self; 3], x: Self) -> Self {
        Self::sum([c0, c1 * x, Self::product([c2, x, x])])
    }

    /// ln(1 + self), for self > −1, with a small relative error however small self is. Shading languages have no such
    /// function; shaders evaluate a short series.
    #[must_use]
    fn ln_1p(self) -> Self {
        (Self::literal(1.0) + self).log2() * Self::literal(std::f64::consts::LN_2)
    }

    /// e^self − 1, likewise.
    #[must_use]
    fn exp_m1(self) -> Self {
        self.exp() - Self::literal(1.0)
    }

    /// a·b − c·d, with a small relative error however nearly the products cancel. (f64 by Kahan's form with a fused
    /// multiply-add, Jeannerod, Louvet & Muller 2013; shaders by that of Cornea, Harrison & Tang.)
    #[must_use]
    fn difference_of_products([a, b]: [Self; 2], [c, d]: [Self; 2]) -> Self {
        a * b - c * d
    }

    /// max(self, 0)^exponent, the power of a cosine, for exponent ≥ 0.
    ///
    /// At self ≤ 0 it is 0 for exponent > 0. With exponent 0 it is 1 for self > 0; at self ≤ 0 both 0 and 1 are legal, and
    /// the plain instances give 0.
    #[must_use]
    fn lobe(self, exponent: Self) -> Self {
        let zero = Self::literal(0.0);
        Self::if_ge(zero, self, || zero, || self.pow(exponent))
    }

    /// A highlight of a normal, a vector to the light and one to the viewer, or a cone about an axis. Where one of them has length 0, 0 is legal too: shading
    /// languages leave open what `normalize` gives for such a vector, and most shaders come to NaN, of which `max(x, 0)` makes 0.
    #[must_use]
    fn or_dark(self, _vectors: [[Self; 3]; 3]) -> Self {
        self
    }

    /// `then` of the greatest whole number that is ≤ self; the hull of several where an interval holds more than one.
    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T;

    /// Whether self ≤ bound without doubt, so that what is 0 there need not be computed.
    #[must_use]
    fn is_at_most(self, _bound: f64) -> bool {
        false
    }

    /// Names an intermediate value for an arithmetic that records them; the value is unchanged.
    #[must_use]
    fn named(self, _name: &'static str) -> Self {
        self
    }

    /// A step of a formula: what `compute` makes of `from`, for an arithmetic that records steps, or makes mistakes in them.
    #[inline(always)]
    #[must_use]
    fn step<A: Parts<Self>, T: Parts<Self>>(step: &'static NamedStep, from: A, compute: impl Fn(A) -> T) -> T {
        let result = compute(from);
        if step.is_quiet { result } else { result.each(|x| x.named(step.name)) }
    }
}

/// A fixed number of `R`s, such as a scalar, a vector or a colour.
pub trait Components<R>: Sized {
    /// Combines two of a kind component by component.
    #[must_use]
    fn zip(self, other: Self, f: impl FnMut(R, R) -> R) -> Self;
}

impl<R: Real> Components<R> for R {
    fn zip(self, other: Self, mut f: impl FnMut(R, R) -> R) -> Self {
        f(self, other)
    }
}

/// A named step of a formula, with the names of what it is computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedStep {
    /// Its name, mostly the symbol of what it gives.
    pub name: &'static str,
    /// The names of what it is given, in order.
    pub of: &'static [&'static str],
    /// Whether it only hands something on, so that whoever reads a formula's steps is spared it.
    pub is_quiet: bool,
}

/// What consists of a fixed number of numbers.
pub trait Parts<R>: Copy {
    /// How many.
    const COUNT: usize;
    /// How many in each part of a tuple.
    const SIZES: &'static [usize] = &[Self::COUNT];

    /// Changes each number.
    #[must_use]
    fn each(self, f: impl FnMut(R) -> R) -> Self;

    /// Gives each number in order.
    fn put(self, to: &mut impl FnMut(R));

    /// Takes as many numbers as it has.
    fn take(from: &mut impl FnMut() -> R) -> Self;
}

impl<R: Real> Parts<R> for R {
    const COUNT: usize = 1;

    #[inline]
    fn each(self, mut f: impl FnMut(R) -> R) -> Self {
        f(self)
    }

    fn put(self, to: &mut impl FnMut(R)) {
        to(self);
    }

    fn take(from: &mut impl FnMut() -> R) -> Self {
        from()
    }
}

macro_rules! plain_real {
    ($float:ident, from $literal:expr, $exp:ident, $exp2:ident, $log2:ident, $pow:ident, $ln_1p:ident, $exp_m1:ident) => {
        impl Real for $float {
            fn input(x: f32) -> Self {
                Self::from(x)
            }
            fn literal(x: f64) -> Self {
                $literal(x)
            }
            fn max(self, other: Self) -> Self {
                // That of the standard library leaves the sign of a zero to the compiler.
                if self > other || other.is_nan() { self } else { other }
            }
            fn min(self, other: Self) -> Self {
                if self < other || other.is_nan() { self } else { other }
            }
            fn abs(self) -> Self {
                $float::abs(self)
            }
            fn round(self) -> Self {
                self.round_ties_even()
            }
            fn sqrt(self) -> Self {
                $float::sqrt(self)
            }
            fn inverse_sqrt(self) -> Self {
                1.0 / $float::sqrt(self)
            }
            fn exp(self) -> Self {
                core_math::$exp(self)
            }
            fn exp2(self) -> Self {
                core_math::$exp2(self)
            }
            fn log2(self) -> Self {
                core_math::$log2(self)
            }
            fn pow(self, exponent: Self) -> Self {
                core_math::$pow(self, exponent)
            }
            fn ln_1p(self) -> Self {
                core_math::$ln_1p(self)
            }
            fn exp_m1(self) -> Self {
                core_math::$exp_m1(self)
            }
            fn difference_of_products([a, b]: [Self; 2], [c, d]: [Self; 2]) -> Self {
                let cd = c * d;
                a.mul_add(b, -cd) + c.mul_add(-d, cd)
            }
            fn if_ge<T: Components<Self>>(
                a: Self,
                b: Self,
                then: impl FnOnce() -> T,
                otherwise: impl FnOnce() -> T,
            ) -> T {
                if a >= b { then() } else { otherwise() }
            }
            fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
                then(self.floor().into())
            }
            fn is_at_most(self, bound: f64) -> bool {
                f64::from(self) <= bound
            }
        }
    };
}

plain_real!(f64, from std::convert::identity, exp, exp2, log2, pow, log1p, expm1);
plain_real!(f32, from narrow, expf, exp2f, log2f, powf, log1pf, expm1f);

#[expect(clippy::cast_possible_truncation, reason = "a literal in a shader is the nearest f32")]
const fn narrow(x: f64) -> f32 {
    x as f32
}
