//! One output of a formula along one of its inputs, and the order of all floats.

/// A float's place in the order of all floats: that of −∞ is the least of any number, −0 comes right before 0.
#[inline]
#[must_use]
pub const fn key_of(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The float at a place: the inverse of [`key_of`].
#[inline]
#[must_use]
pub const fn float_of(key: u32) -> f32 {
    f32::from_bits(if key >> 31 == 1 { key & !(1 << 31) } else { !key })
}

/// What is evaluated: a row of inputs, which of them is free, and which output is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Along<'a> {
    /// The row that the function takes, selectors as their bits; the free number is not read.
    pub row: &'a [f32],
    /// The free number's place in the row.
    pub free: usize,
    /// The output's place among the numbers that the function gives.
    pub output: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_in_the_order_of_floats_and_read_back() {
        let floats = [f32::NEG_INFINITY, -1.0, -f32::MIN_POSITIVE, -1e-45, -0.0, 0.0, 1e-45, 0.5, 1.0, f32::INFINITY];
        for pair in floats.windows(2) {
            assert!(key_of(pair[0]) < key_of(pair[1]), "{pair:?}");
        }
        assert_eq!(key_of(-0.0) + 1, key_of(0.0));
        assert_eq!(key_of(1.0) + 1, key_of(1.0_f32.next_up()));
        for x in floats {
            assert_eq!(float_of(key_of(x)).to_bits(), x.to_bits());
        }
    }
}
