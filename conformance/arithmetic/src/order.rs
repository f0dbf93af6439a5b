//! The lesser and the greater of two ends of intervals, each by one comparison. Those of the standard library look for NaN besides.
//!
//! Of a NaN and a number either may come out: where an end is NaN the others are infinite, and nothing is promised. Of two zeros the first
//! comes out, whatever its sign.

/// The lesser.
#[inline]
pub(crate) fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The greater.
#[inline]
pub(crate) fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
