//! A formula's inputs taken off a row of numbers, and its outputs put on one.

use lightmeter_reference::{Mat3, Mat4, Real, Vector};

/// Takes inputs off a row, in order.
#[derive(Debug)]
pub struct Reader<'a, R> {
    row: &'a [R],
}

impl<'a, R: Real> Reader<'a, R> {
    /// Starts at the row's first number.
    #[must_use]
    pub const fn new(row: &'a [R]) -> Self {
        Self { row }
    }

    /// The next `N` numbers.
    ///
    /// # Panics
    /// Where the row has fewer: a formula reads what its description declares.
    pub fn array<const N: usize>(&mut self) -> [R; N] {
        let (head, rest) = self.row.split_first_chunk().expect("a row holds every input that the formula declares");
        self.row = rest;
        *head
    }

    /// The next number.
    pub fn scalar(&mut self) -> R {
        let [x] = self.array();
        x
    }

    /// The next vector or colour.
    pub fn vector<const N: usize>(&mut self) -> Vector<R, N> {
        Vector(self.array())
    }

    /// The next `M` vectors or colours.
    pub fn vectors<const N: usize, const M: usize>(&mut self) -> [Vector<R, N>; M] {
        std::array::from_fn(|_| self.vector())
    }

    /// The next 3 × 3 matrix.
    pub fn mat3(&mut self) -> Mat3<R> {
        Mat3(self.vectors())
    }

    /// The next 4 × 4 matrix.
    pub fn mat4(&mut self) -> Mat4<R> {
        Mat4(self.vectors())
    }
}

/// Puts outputs on a row, in order.
#[derive(Debug)]
pub struct Writer<'a, R> {
    row: &'a mut [R],
    filled: usize,
    /// The only number that is wanted, where not all are.
    only: Option<usize>,
}

impl<'a, R: Real> Writer<'a, R> {
    /// Starts at the row's first number.
    #[must_use]
    pub const fn new(row: &'a mut [R]) -> Self {
        Self { row, filled: 0, only: None }
    }

    /// The same where one number alone is wanted.
    #[must_use]
    pub const fn only(row: &'a mut [R], number: usize) -> Self {
        Self { row, filled: 0, only: Some(number) }
    }

    /// One number.
    pub fn scalar(&mut self, x: R) {
        self.row[self.filled] = x;
        self.filled += 1;
    }

    /// A vector or colour.
    pub fn vector<const N: usize>(&mut self, v: Vector<R, N>) {
        for x in v.0 {
            self.scalar(x);
        }
    }
    /// A vector or colour that is worked out only where one of its numbers is wanted.
    pub fn lazy_vector<const N: usize>(&mut self, v: impl FnOnce() -> Vector<R, N>) {
        if self.only.is_none_or(|number| (self.filled..self.filled + N).contains(&number)) {
            self.vector(v());
        } else {
            self.filled += N;
        }
    }
}
