//! Laws of fog.

use crate::{family, wide};
use lightmeter_reference::Vector;
use lightmeter_reference::fog::{Distance, apply, distance, exp, exp2_document, exp2_opengl, linear};
use lightmeter_tests::direction;
use proptest::prelude::*;

family!("fog", 4096);

type Factor = fn(f64, f64) -> f64;
const EXPONENTIALS: [Factor; 3] = [exp, exp2_document, exp2_opengl];

proptest! {
    #[test]
    fn the_factor_lies_in_0_to_1_and_falls(d in 0.0..200.0_f64, more in 0.0..200.0_f64, density in 0.0..2.0_f64, dmin in 0.0..50.0_f64, width in 0.0..50.0_f64) {
        for f in EXPONENTIALS {
            let (near, far) = (f(d, density), f(d + more, density));
            prop_assert!((0.0..=1.0).contains(&near) && far <= near);
        }
        let (near, far) = (linear(d, dmin, dmin + width), linear(d + more, dmin, dmin + width));
        prop_assert!((0.0..=1.0).contains(&near) && far <= near);
    }

    #[test]
    fn turned_round_it_rises(d in 0.0..200.0_f64, more in 0.0..200.0_f64, dmax in 0.0..50.0_f64, width in 0.1..50.0_f64) {
        prop_assert!(linear(d + more, dmax + width, dmax) >= linear(d, dmax + width, dmax));
    }

    #[test]
    fn no_density_is_no_fog(d in 0.0..1e6_f64) {
        for f in EXPONENTIALS {
            prop_assert_eq!(f(d, 0.0), 1.0);
        }
    }

    #[test]
    fn distances_add_up_in_the_exponent(d in 0.0..50.0_f64, more in 0.0..50.0_f64, density in 0.0..0.5_f64) {
        let (whole, parts) = (exp(d + more, density), exp(d, density) * exp(more, density));
        prop_assert!((whole - parts).abs() <= 1e-13 * whole);
    }

    #[test]
    fn the_two_squared_forms_agree_where_density_is_1(d in 0.0..20.0_f64) {
        prop_assert!((exp2_document(d, 1.0) - exp2_opengl(d, 1.0)).abs() < 1e-15);
    }

    #[test]
    fn linear_fog_is_exact_at_its_ends(dmin in 0.0..50.0_f64, width in 1e-6..50.0_f64) {
        let dmax = dmin + width;
        prop_assert_eq!((linear(dmin, dmin, dmax), linear(dmax, dmin, dmax)), (1.0, 0.0));
    }

    #[test]
    fn equal_ends_are_a_step(at in 0.1..100.0_f64, off in 1e-9..1.0_f64) {
        prop_assert_eq!((linear(at - off, at, at), linear(at, at, at), linear(at + off, at, at)), (1.0, 0.0, 0.0));
    }

    #[test]
    fn radial_is_never_nearer_than_planar(v in direction(), length in 0.0..100.0_f64) {
        let p = wide(v).scale(length);
        prop_assert!(distance(p, Distance::Radial) >= distance(p, Distance::Planar) - 1e-12);
        prop_assert_eq!(distance(p, Distance::Planar), distance(-p, Distance::Planar));
    }

    #[test]
    fn the_mix_lies_between_its_colours(a in 0.0..1.0_f64, b in 0.0..1.0_f64, f in 0.0..=1.0_f64) {
        let mixed = apply(Vector([a; 3]), Vector([b; 3]), f).x();
        prop_assert!(mixed >= a.min(b) - 1e-15 && mixed <= a.max(b) + 1e-15);
        prop_assert_eq!(apply(Vector([a; 3]), Vector([b; 3]), 0.0).x(), a);
        prop_assert_eq!(apply(Vector([a; 3]), Vector([b; 3]), 1.0).x(), b);
    }
}
