//! Vectors, colours and matrices over any arithmetic. glam stands at the boundaries and is converted from here.

use crate::real::{Components, Real};
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
    pub fn map(self, f: impl FnMut(R) -> R) -> Self {
        Self(self.0.map(f))
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
        Self(std::array::from_fn(|k| R::sum(terms.map(|term| term.0[k]))))
    }

    /// Π of the vectors, component by component and in any order.
    #[must_use]
    pub fn product<const M: usize>(factors: [Self; M]) -> Self {
        Self(std::array::from_fn(|k| R::product(factors.map(|factor| factor.0[k]))))
    }

    /// Names each component for an arithmetic that records them.
    #[must_use]
    pub fn named(self, name: &'static str) -> Self {
        self.map(|x| x.named(name))
    }
}

impl<R: Real> Vec3<R> {
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
        self.zip(other, Add::add)
    }
}

impl<R: Real, const N: usize> Sub for Vector<R, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, Sub::sub)
    }
}

impl<R: Real, const N: usize> Mul for Vector<R, N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.zip(other, Mul::mul)
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
        Vector::sum([self.0[0].scale(v[0]), self.0[1].scale(v[1]), self.0[2].scale(v[2])])
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
        Vector::sum([self.0[0].scale(v[0]), self.0[1].scale(v[1]), self.0[2].scale(v[2]), self.0[3].scale(v[3])])
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
