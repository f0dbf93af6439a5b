//! Laws of the depth test.

use crate::family;
use lightmeter_reference::depth::{passes, stored, stored_reversed, test};
use lightmeter_scene::depth::{Compare, DepthTest};
use proptest::prelude::*;

family!("depth", 4096);

fn depth() -> impl Strategy<Value = f64> {
    prop_oneof![3 => -0.25..1.25_f64, 1 => Just(0.0), 1 => Just(1.0), 1 => Just(0.5)]
}

fn seen(compare: Compare, new: f64, old: f64) -> f64 {
    test(DepthTest { compare, write: true }, new, old).seen
}

/// What passes where another does not.
const OPPOSITES: [(Compare, Compare); 4] = [
    (Compare::Never, Compare::Always),
    (Compare::Less, Compare::GreaterEqual),
    (Compare::Equal, Compare::NotEqual),
    (Compare::Greater, Compare::LessEqual),
];

/// What passes when the two change places.
const MIRRORED: [(Compare, Compare); 4] = [
    (Compare::Less, Compare::Greater),
    (Compare::LessEqual, Compare::GreaterEqual),
    (Compare::Equal, Compare::Equal),
    (Compare::NotEqual, Compare::NotEqual),
];

proptest! {
    #[test]
    fn one_of_two_opposites_passes(new in depth(), old in depth()) {
        for (a, b) in OPPOSITES {
            prop_assert_eq!(passes(a, new, old) + passes(b, new, old), 1.0);
        }
    }

    #[test]
    fn new_and_old_may_change_places(new in depth(), old in depth()) {
        for (a, b) in MIRRORED {
            prop_assert_eq!(passes(a, new, old), passes(b, old, new));
        }
    }

    #[test]
    fn of_less_equal_and_greater_exactly_one_passes(new in depth(), old in depth()) {
        let each = [Compare::Less, Compare::Equal, Compare::Greater].map(|compare| passes(compare, new, old));
        prop_assert_eq!(each.into_iter().sum::<f64>(), 1.0);
    }

    #[test]
    fn the_nearest_is_seen_in_any_order(a in depth(), b in depth()) {
        prop_assume!(a.clamp(0.0, 1.0) != b.clamp(0.0, 1.0));
        let by = DepthTest { compare: Compare::Less, write: true };
        let (over, under) = (test(by, a, b), test(by, b, a));
        prop_assert_eq!(over.depth, under.depth);
        // The same fragment, called new in one order and old in the other.
        prop_assert!((over.seen == 2.0) == (under.seen == 1.0));
    }

    #[test]
    fn what_does_not_pass_leaves_everything(new in depth(), old in depth(), place in 0..16_usize) {
        let by = DepthTest::all().nth(place).expect("one of 16");
        let left = test(by, new, old);
        prop_assert!((0.0..=1.0).contains(&left.depth));
        if left.seen == 1.0 || !by.write {
            prop_assert_eq!(left.depth, old.clamp(0.0, 1.0));
        } else {
            prop_assert_eq!(left.depth, new.clamp(0.0, 1.0));
        }
    }

    #[test]
    fn without_a_test_the_last_is_seen(new in depth(), old in depth()) {
        let left = test(DepthTest { compare: Compare::Always, write: false }, new, old);
        prop_assert_eq!((left.seen, left.depth), (2.0, old.clamp(0.0, 1.0)));
    }

    #[test]
    fn beyond_the_range_all_are_equal(a in 1.0..9.0_f64, b in 1.0..9.0_f64) {
        prop_assert_eq!(seen(Compare::Equal, a, b), 2.0);
        prop_assert_eq!(seen(Compare::Less, -a, -b), 1.0);
    }

    #[test]
    fn stored_depth_and_reversed_depth_are_one_together(near in 0.01..1.0_f64, far in 2.0..1e4_f64, t in 0.0..=1.0_f64) {
        let z = near + (far - near) * t;
        let (depth, reversed) = (stored(near, far, z), stored_reversed(near, far, z));
        prop_assert!((depth + reversed - 1.0).abs() < 1e-12);
        prop_assert!((0.0..=1.0 + 1e-12).contains(&depth));
        prop_assert_eq!((stored(near, far, near), stored_reversed(near, far, far)), (0.0, 0.0));
    }
}
