//! A formula's inputs taken off a row of numbers by their names, and its outputs put on one in order.

use super::spec::Input;
use lightmeter_reference::{Mat3, Mat4, Real, Vector};

/// Where an input stands in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    start: usize,
    len: usize,
}

impl Slot {
    /// From this input to a later one, both included.
    #[must_use]
    pub const fn through(self, last: Self) -> Self {
        Self { start: self.start, len: last.start + last.len - self.start }
    }
}

/// The slot of an input, by its name. It is asked for in `const { … }`, so that an evaluation looks nothing up.
///
/// # Panics
/// Where no input has the name: in `const { … }` an error of compilation.
#[must_use]
pub const fn slot(inputs: &[Input], name: &str) -> Slot {
    let (mut start, mut k) = (0, 0);
    while k < inputs.len() {
        let len = inputs[k].shape.components();
        if is_same(inputs[k].name.as_bytes(), name.as_bytes()) {
            return Slot { start, len };
        }
        start += len;
        k += 1;
    }
    panic!("the formula declares no input of this name");
}

/// `==`, which a constant cannot call.
const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut k = 0;
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    k == a.len() && k == b.len()
}

/// Inputs as formulas take them, from as many numbers.
pub trait FromNumbers<R> {
    /// Takes the numbers, matrices column by column.
    ///
    /// # Panics
    /// Where there are more or fewer than it has components.
    fn from_numbers(numbers: &[R]) -> Self;
}

impl<R: Real, const N: usize> FromNumbers<R> for [R; N] {
    fn from_numbers(numbers: &[R]) -> Self {
        numbers.try_into().expect("an input is taken as what it was declared")
    }
}

impl<R: Real> FromNumbers<R> for R {
    fn from_numbers(numbers: &[R]) -> Self {
        let [x] = FromNumbers::from_numbers(numbers);
        x
    }
}

impl<R: Real, const N: usize> FromNumbers<R> for Vector<R, N> {
    fn from_numbers(numbers: &[R]) -> Self {
        Self(FromNumbers::from_numbers(numbers))
    }
}

/// Vectors one after the other, as the columns of a matrix are.
impl<R: Real, const N: usize, const M: usize> FromNumbers<R> for [Vector<R, N>; M] {
    fn from_numbers(numbers: &[R]) -> Self {
        assert_eq!(numbers.len(), N * M, "an input is taken as what it was declared");
        std::array::from_fn(|m| Vector::from_numbers(&numbers[m * N..(m + 1) * N]))
    }
}

impl<R: Real> FromNumbers<R> for Mat3<R> {
    fn from_numbers(numbers: &[R]) -> Self {
        Self(FromNumbers::from_numbers(numbers))
    }
}

impl<R: Real> FromNumbers<R> for Mat4<R> {
    fn from_numbers(numbers: &[R]) -> Self {
        Self(FromNumbers::from_numbers(numbers))
    }
}

/// A formula's inputs, on a row of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Reader<'a, R> {
    row: &'a [R],
}

impl<'a, R: Real> Reader<'a, R> {
    /// Of a row that begins with the first input.
    #[must_use]
    pub const fn new(row: &'a [R]) -> Self {
        Self { row }
    }

    /// The input, or the inputs, in a slot.
    ///
    /// # Panics
    /// Where that is beyond the row, or of another shape than is asked for.
    #[must_use]
    pub fn at<T: FromNumbers<R>>(&self, slot: Slot) -> T {
        T::from_numbers(&self.row[slot.start..slot.start + slot.len])
    }
}

/// The numbers of an output row that are wanted: all, or one alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted(usize);

impl Wanted {
    /// All of them.
    pub const ALL: Self = Self(usize::MAX);

    /// One, by its place in the row.
    #[must_use]
    pub const fn only(number: usize) -> Self {
        Self(number)
    }

    fn is_among(self, first: usize, count: usize) -> bool {
        self == Self::ALL || (first..first + count).contains(&self.0)
    }
}

/// Puts outputs on a row, in order.
#[derive(Debug)]
pub struct Writer<'a, R> {
    row: &'a mut [R],
    filled: usize,
    wanted: Wanted,
}

impl<'a, R: Real> Writer<'a, R> {
    /// Starts at the row's first number.
    #[must_use]
    pub const fn new(row: &'a mut [R], wanted: Wanted) -> Self {
        Self { row, filled: 0, wanted }
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
        if self.wanted.is_among(self.filled, N) {
            self.vector(v());
        } else {
            self.filled += N;
        }
    }
}
