//! Undecided floors and conditions, followed one way after the other.

use crate::profile::WGSL;
use crate::{Accept, paths};
use lightmeter_reference::Real;

/// The ends of each outcome, in order.
fn outcomes(mut evaluate: impl FnMut() -> Accept) -> Vec<(f64, f64)> {
    let mut found = vec![];
    WGSL.scope(|| paths::each(&mut evaluate, |x| found.push((x.low(), x.high()))));
    found
}

fn floor_of(low: f64, high: f64) -> Accept {
    Accept::<crate::F32>::from_bounds(low, high).floor_then(Accept::exactly)
}

#[test]
fn up_to_four_floors_are_followed_apart() {
    let points = |values: &[f64]| values.iter().map(|&x| (x, x)).collect::<Vec<_>>();
    // Name, range, the outcomes.
    let rows = [
        ("one floor", (2.25, 2.75), points(&[2.0])),
        ("two floors", (2.25, 3.75), points(&[2.0, 3.0])),
        ("negative floors", (-2.5, -0.5), points(&[-3.0, -2.0, -1.0])),
        ("four floors", (1.5, 4.5), points(&[1.0, 2.0, 3.0, 4.0])),
        ("five floors are one hull", (1.5, 5.5), vec![(1.0, 5.0)]),
    ];
    for (name, (low, high), expected) in rows {
        assert_eq!(outcomes(|| floor_of(low, high)), expected, "{name}");
    }
}

#[test]
fn what_is_decided_leaves_room_for_what_is_not() {
    let [zero, one] = [0.0, 1.0].map(Accept::exactly);
    let open = Accept::from_bounds(-1.0, 1.0);
    let decided = || {
        let floors = (0..8).fold(zero, |_, _| floor_of(0.25, 0.75));
        Accept::if_ge(one, floors, || one, || zero)
    };
    let evaluate = || Accept::if_ge(open, zero, decided, || zero);
    assert_eq!(outcomes(evaluate), [(1.0, 1.0), (0.0, 0.0)]);
    // Decided floors first, then an open condition.
    let evaluate = || {
        let last = (0..8).fold(zero, |_, _| floor_of(0.25, 0.75));
        Accept::if_ge(open, last, || one, || zero)
    };
    assert_eq!(outcomes(evaluate), [(1.0, 1.0), (0.0, 0.0)]);
}

#[test]
fn conditions_of_different_numbers_of_sides_combine() {
    let open = Accept::from_bounds(-1.0, 1.0);
    let zero = Accept::exactly(0.0);
    let evaluate = || {
        let floor = floor_of(0.5, 2.5);
        let side = Accept::if_ge(open, zero, || Accept::exactly(10.0), || Accept::exactly(20.0));
        floor + side
    };
    let found: Vec<f64> = outcomes(evaluate).into_iter().map(|(low, _)| low).collect();
    assert_eq!(found, [10.0, 20.0, 11.0, 21.0, 12.0, 22.0]);
}
