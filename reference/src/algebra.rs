//! Vectors, colours and matrices over any arithmetic. glam stands at the boundaries and is converted from here.

use crate::real::{Components, Parts, Real};
use std::ops::{Add, Index, Mul, Neg, Sub};

/// A vector of `N` components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<R, const N: usize>(pub [R; N]);

/// Two components.
pub type Vec2<R> = Vector<R, 2>;
/// Three components: a direction or a position in eye space.
pub type Vec3<R> = Vector<R, 3>;
/// Four components: a homogeneous position.
pub type Vec4<R> = Vector<R, 4>;
/// A colour without alpha.
pub type Rgb<R> = Vector<R, 3>;
/// A colour with straight alpha.
pub type Rgba<R> = Vector<R, 4>;

impl<R: Copy, const N: usize> Vector<R, N> {
    /// The first component.
    #[must_use]
    pub const fn x(self) -> R {
        self.0[0]
    }

    /// The second component.
    #[must_use]
    pub const fn y(self) -> R {
        self.0[1]
    }

    /// The third component.
    #[must_use]
    pub const fn z(self) -> R {
        self.0[2]
    }

    /// The fourth component.
    #[must_use]
    pub const fn w(self) -> R {
        self.0[3]
    }
}

impl<R: Copy, const N: usize> Vector<R, N> {
    /// Brings each component to another arithmetic.
    #[must_use]
    pub fn map_to<S>(self, f: impl FnMut(R) -> S) -> Vector<S, N> {
        Vector(self.0.map(f))
    }
}

impl<R: Copy> Vector<R, 4> {
    /// The first three components.
    #[must_use]
    pub const fn xyz(self) -> Vec3<R> {
        Vector([self.0[0], self.0[1], self.0[2]])
    }
}

impl<R: Copy> Vector<R, 3> {
    /// With a fourth component.
    #[must_use]
    pub const fn extend(self, w: R) -> Vec4<R> {
        Vector([self.0[0], self.0[1], self.0[2], w])
    }
}

impl<R: Real, const N: usize> Vector<R, N> {
    /// All components equal.
    #[must_use]
    pub const fn splat(x: R) -> Self {
        Self([x; N])
    }

    /// Applies `f` to each component.
    #[must_use]
    pub fn map(self, mut f: impl FnMut(R) -> R) -> Self {
        Self(std::array::from_fn(|k| f(self.0[k])))
    }

    /// a·b = Σ aᵢbᵢ.
    #[must_use]
    pub fn dot(self, other: Self) -> R {
        R::sum((self * other).0)
    }

    /// |v| = √(v·v).
    #[must_use]
    pub fn length(self) -> R {
        self.dot(self).sqrt()
    }

    /// ⟨v⟩ = v / |v|, and 0 for the zero vector.
    #[must_use]
    pub fn normalize(self) -> Self {
        let zero = R::literal(0.0);
        R::if_ge(zero, self.dot(self), || Self::splat(zero), || Self(R::normalize(self.0)))
    }

    /// The largest |component|.
    #[must_use]
    pub fn largest(self) -> R {
        self.0.into_iter().map(R::abs).reduce(R::max).unwrap_or_else(|| R::literal(0.0))
    }

    /// ⟨v⟩ with v brought near 1 by a power of two first, so that v·v neither overflows nor underflows in binary32; 0 for
    /// the zero vector.
    #[must_use]
    pub fn normalize_scaled(self) -> Self {
        let (zero, largest) = (R::literal(0.0), self.largest());
        let normalized = || Self(R::normalize(self.scale(binary_scale(largest).0).0));
        R::if_ge(zero, largest, || Self::splat(zero), normalized)
    }

    /// |v| by the same scaling, undone afterwards.
    #[must_use]
    pub fn length_scaled(self) -> R {
        let (zero, largest) = (R::literal(0.0), self.largest());
        let length = || {
            let Vector([scale, inverse]) = scales(largest);
            self.scale(scale).length() * inverse
        };
        R::if_ge(zero, largest, || zero, length)
    }

    /// a(1 − t) + b·t, component by component.
    #[must_use]
    pub fn mix(self, other: Self, t: R) -> Self {
        self.zip(other, |a, b| R::mix(a, b, t))
    }

    /// v·s.
    #[must_use]
    pub fn scale(self, s: R) -> Self {
        self.map(|x| x * s)
    }

    /// Σ of the vectors, component by component and in any order.
    #[must_use]
    pub fn sum<const M: usize>(terms: [Self; M]) -> Self {
        Self(std::array::from_fn(|k| R::sum::<M>(std::array::from_fn(|term| terms[term].0[k]))))
    }

    /// Π of the vectors, component by component and in any order.
    #[must_use]
    pub fn product<const M: usize>(factors: [Self; M]) -> Self {
        Self(std::array::from_fn(|k| R::product::<M>(std::array::from_fn(|factor| factors[factor].0[k]))))
    }

    /// Names each component for an arithmetic that records them.
    #[must_use]
    pub fn named(self, name: &'static str) -> Self {
        self.map(|x| x.named(name))
    }
}

/// A power of two that brings a magnitude of [2⁻¹²⁶, 2¹²⁸) into [2⁻²⁰, 2²⁰), and its inverse.
pub fn binary_scale<R: Real>(magnitude: R) -> (R, R) {
    let Vector([scale, inverse]) = scales(magnitude);
    (scale, inverse)
}

fn scales<R: Real>(magnitude: R) -> Vec2<R> {
    // Steps of 2⁴⁰: from 2⁻²⁰ on nothing is scaled, below 2⁻²⁰ by 2⁴⁰, and so on.
    const STEP: f64 = 1_099_511_627_776.0;
    const FIRST: f64 = 1_048_576.0;
    let of = |scale: f64| move || Vector([R::literal(scale), R::literal(1.0 / scale)]);
    let at_least =
        |bound: f64, then: Vec2<R>, otherwise: Vec2<R>| R::if_ge(magnitude, R::literal(bound), || then, || otherwise);
    let small = [(STEP * STEP * STEP, STEP * STEP), (STEP * STEP, STEP), (STEP, 1.0)];
    let start = of(STEP * STEP * STEP)();
    let up = small.into_iter().fold(start, |found, (below, scale)| at_least(1.0 / (below / FIRST), of(scale)(), found));
    let great = [1.0, STEP, STEP * STEP];
    great.into_iter().fold(up, |found, scale| at_least(FIRST * scale, of(1.0 / (scale * STEP))(), found))
}

impl<R: Real> Vec3<R> {
    /// a × b, each component a difference of products that keeps its relative error small.
    #[must_use]
    pub fn cross_compensated(self, other: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, other.0);
        Self([
            R::difference_of_products([ay, bz], [az, by]),
            R::difference_of_products([az, bx], [ax, bz]),
            R::difference_of_products([ax, by], [ay, bx]),
        ])
    }

    /// a × b.
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, other.0);
        Self([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
    }
}

impl<R: Real, const N: usize> Components<R> for Vector<R, N> {
    fn zip(self, other: Self, mut f: impl FnMut(R, R) -> R) -> Self {
        Self(std::array::from_fn(|k| f(self.0[k], other.0[k])))
    }
}

impl<R: Real, const N: usize> Add for Vector<R, N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<R: Real, const N: usize> Sub for Vector<R, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl<R: Real, const N: usize> Mul for Vector<R, N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] * other.0[k]))
    }
}

impl<R: Real, const N: usize> Neg for Vector<R, N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(Neg::neg)
    }
}

impl<R, const N: usize> Index<usize> for Vector<R, N> {
    type Output = R;
    fn index(&self, index: usize) -> &R {
        &self.0[index]
    }
}

/// A 3 × 3 matrix of columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat3<R>(pub [Vec3<R>; 3]);

impl<R: Real> Mat3<R> {
    /// M·v.
    #[must_use]
    pub fn transform(&self, v: Vec3<R>) -> Vec3<R> {
        let [a, b, c] = &self.0;
        Vector(std::array::from_fn(|k| R::sum([a[k] * v[0], b[k] * v[1], c[k] * v[2]])))
    }

    /// The cofactors: det(M)·M⁻ᵀ.
    #[must_use]
    pub fn cofactors(&self) -> Self {
        let [a, b, c] = self.0;
        Self([b.cross(c), c.cross(a), a.cross(b)])
    }
}

/// A 4 × 4 matrix of columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat4<R>(pub [Vec4<R>; 4]);

impl<R: Real> Mat4<R> {
    /// M·v.
    #[must_use]
    pub fn transform(&self, v: Vec4<R>) -> Vec4<R> {
        let [a, b, c, d] = &self.0;
        Vector(std::array::from_fn(|k| R::sum([a[k] * v[0], b[k] * v[1], c[k] * v[2], d[k] * v[3]])))
    }

    /// The upper left 3 × 3 part, which is what acts on directions.
    #[must_use]
    pub fn upper3(&self) -> Mat3<R> {
        Mat3([self.0[0].xyz(), self.0[1].xyz(), self.0[2].xyz()])
    }
}

impl<R: Real> From<glam::Mat4> for Mat4<R> {
    fn from(m: glam::Mat4) -> Self {
        Self(m.to_cols_array_2d().map(|column| Vector(column.map(R::input))))
    }
}

impl<R: Real> From<glam::Mat3> for Mat3<R> {
    fn from(m: glam::Mat3) -> Self {
        Self(m.to_cols_array_2d().map(|column| Vector(column.map(R::input))))
    }
}

impl<R: Real> From<glam::Vec3> for Vec3<R> {
    fn from(v: glam::Vec3) -> Self {
        Self(v.to_array().map(R::input))
    }
}

impl<R: Real> From<glam::Vec4> for Vec4<R> {
    fn from(v: glam::Vec4) -> Self {
        Self(v.to_array().map(R::input))
    }
}

impl<R: approx::AbsDiffEq<Epsilon: Copy>, const N: usize> approx::AbsDiffEq for Vector<R, N> {
    type Epsilon = R::Epsilon;
    fn default_epsilon() -> R::Epsilon {
        R::default_epsilon()
    }
    fn abs_diff_eq(&self, other: &Self, epsilon: R::Epsilon) -> bool {
        self.0.iter().zip(&other.0).all(|(a, b)| a.abs_diff_eq(b, epsilon))
    }
}

impl<R: approx::RelativeEq<Epsilon: Copy>, const N: usize> approx::RelativeEq for Vector<R, N> {
    fn default_max_relative() -> R::Epsilon {
        R::default_max_relative()
    }
    fn relative_eq(&self, other: &Self, epsilon: R::Epsilon, max_relative: R::Epsilon) -> bool {
        self.0.iter().zip(&other.0).all(|(a, b)| a.relative_eq(b, epsilon, max_relative))
    }
}

impl<R: approx::UlpsEq<Epsilon: Copy>, const N: usize> approx::UlpsEq for Vector<R, N> {
    fn default_max_ulps() -> u32 {
        R::default_max_ulps()
    }
    fn ulps_eq(&self, other: &Self, epsilon: R::Epsilon, max_ulps: u32) -> bool {
        self.0.iter().zip(&other.0).all(|(a, b)| a.ulps_eq(b, epsilon, max_ulps))
    }
}

/// What holds its numbers in a single field.
macro_rules! wrapped {
    ($($name:ident<$r:ident $(, $n:ident)?>: $count:expr),+ $(,)?) => {$(
        impl<$r: Real $(, const $n: usize)?> Parts<$r> for $name<$r $(, $n)?> {
            const COUNT: usize = $count;

            #[inline]
            fn each(self, f: impl FnMut($r) -> $r) -> Self {
                Self(self.0.each(f))
            }

            fn put(self, to: &mut impl FnMut($r)) {
                self.0.put(to);
            }

            fn take(from: &mut impl FnMut() -> $r) -> Self {
                Self(Parts::take(from))
            }
        }
    )+};
}

wrapped!(Vector<R, N>: N, Mat3<R>: 9, Mat4<R>: 16);
