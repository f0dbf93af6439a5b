//! Laws of attenuation and spotlights.

use crate::{family, wide};
use lightmeter_reference::attenuation::{constant, linear, point, polynomial, spot_cutoff, spot_exponent, square};
use lightmeter_tests::direction;
use proptest::prelude::*;

family!("attenuation", 4096);

proptest! {
    #[test]
    fn it_falls_with_distance(kc in 0.01..2.0_f64, kl in 0.0..2.0_f64, kq in 0.0..2.0_f64, d in 0.0..1e3_f64, more in 0.0..1e3_f64) {
        prop_assert!(polynomial(kc, kl, kq, d + more) <= polynomial(kc, kl, kq, d));
    }

    #[test]
    fn it_lies_between_0_and_1_over_kc(kc in 0.01..2.0_f64, kl in 0.0..2.0_f64, kq in 0.0..2.0_f64, d in 0.0..1e3_f64) {
        let atten = polynomial(kc, kl, kq, d);
        prop_assert!(atten > 0.0 && atten <= (1.0 / kc) * (1.0 + 1e-15));
    }

    #[test]
    fn the_named_falloffs_are_powers_of_the_distance(d in 1e-3..1e3_f64) {
        prop_assert!((constant(d) - 1.0).abs() < 1e-15);
        prop_assert!((linear(d) * d - 1.0).abs() < 1e-14);
        prop_assert!((square(d) * d * d - 1.0).abs() < 1e-14);
    }

    #[test]
    fn only_the_distance_counts(l in direction(), p in direction(), by in direction()) {
        let (l, p, by) = (wide(l), wide(p), wide(by));
        let (here, there) = (point(1.0, 0.5, 0.25, l, p), point(1.0, 0.5, 0.25, l + by, p + by));
        prop_assert!((here - there).abs() < 1e-13);
        prop_assert!((here - point(1.0, 0.5, 0.25, p, l)).abs() < 1e-15);
    }

    #[test]
    fn a_spotlight_lights_its_cone_alone(l in direction(), axis in direction(), cutoff in 0.0..0.99_f64, e in 0.1..128.0_f64) {
        let (l, axis) = (wide(l), wide(axis));
        let inside = -l.dot(axis) >= cutoff;
        prop_assert_eq!(spot_cutoff(l, axis, cutoff), if inside { 1.0 } else { 0.0 });
        let spot = spot_exponent(l, axis, cutoff, e);
        let most = if inside { 1.0 + 1e-4 } else { 0.0 };
        prop_assert!((0.0..=most).contains(&spot));
        prop_assert!(spot_exponent(l, axis, cutoff, e + 1.0) <= spot * (1.0 + 1e-6));
    }
}
