//! Laws of colours and their storage.

use crate::family;
use lightmeter_reference::Vector;
use lightmeter_reference::color::{
    from_unorm8, modulate, per_vertex, replace, srgb_decode, srgb_encode, sum, to_unorm8, uniform,
};
use proptest::prelude::*;

family!("color", 4096);

proptest! {
    #[test]
    fn a_byte_survives_the_round_trip(byte in 0..=255_u8) {
        prop_assert_eq!(to_unorm8(from_unorm8(f64::from(byte))), f64::from(byte));
    }

    #[test]
    fn conversion_errs_by_half_a_step_at_most_and_rises(c in -1.0..2.0_f64, more in 0.0..1.0_f64) {
        let byte = to_unorm8(c);
        prop_assert!((byte - 255.0 * c.clamp(0.0, 1.0)).abs() <= 0.5 && byte.fract() == 0.0);
        prop_assert!(to_unorm8(c + more) >= byte);
    }

    #[test]
    fn srgb_is_undone_by_its_inverse_and_rises(c in 0.0..=1.0_f64, more in 0.0..1.0_f64) {
        // The published constants leave a step of 3e-8 where the pieces meet.
        prop_assert!((srgb_decode(srgb_encode(c)) - c).abs() < 1e-7);
        prop_assert!(srgb_encode(c + more) >= srgb_encode(c) - 1e-7);
        prop_assert!(srgb_encode(c) >= c - 1e-15);
    }

    #[test]
    fn modulation_commutes_with_white_as_its_unit(a in 0.0..1.0_f64, b in 0.0..1.0_f64) {
        let (a, b, white) = (Vector([a; 4]), Vector([b; 4]), Vector([1.0; 4]));
        prop_assert_eq!(modulate(a, b), modulate(b, a));
        prop_assert_eq!(modulate(a, white), a);
        prop_assert_eq!(replace(a, b), a);
    }

    #[test]
    fn sums_commute_and_stay_in_the_cube(a in 0.0..1.0_f64, b in 0.0..1.0_f64) {
        let (a, b) = (Vector([a, b, 1.0]), Vector([b, a, 0.5]));
        prop_assert_eq!(sum(a, b), sum(b, a));
        prop_assert!(sum(a, b).0.iter().all(|c| (0.0..=1.0).contains(c)));
    }

    #[test]
    fn equal_corners_give_their_own_colour(c in 0.0..1.0_f64, alpha in 0.0..1.0_f64, beta in 0.0..1.0_f64) {
        let (alpha, beta) = (alpha / 2.0, beta / 2.0);
        let corner = Vector([c; 3]);
        let mixed = per_vertex([alpha, beta, 1.0 - alpha - beta], [corner; 3]);
        prop_assert!((mixed.x() - c).abs() < 1e-15 && mixed.w() == 1.0);
        prop_assert_eq!(uniform(corner).xyz(), corner);
    }
}
