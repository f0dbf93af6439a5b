//! Undecided conditions, followed one way after the other.
//!
//! Where an interval leaves a condition open, the hull of both sides is legal, yet no value between them need be. Within
//! [`each`] such conditions are followed instead: the evaluation is repeated for each way through it, so that its distinct
//! outcomes come out apart. Beyond four conditions in a row the hull is taken after all.

use std::cell::Cell;

/// Conditions that are followed in one evaluation.
const MOST: u32 = 4;

/// A way through an evaluation: for each condition met so far, the side that is taken.
#[derive(Clone, Copy, Debug, Default)]
struct Way {
    sides: [u8; MOST as usize],
    met: u32,
    /// Conditions whose side is laid down from before.
    given: u32,
    /// Sides that each condition has.
    of: [u8; MOST as usize],
}

thread_local! {
    static WAY: Cell<Option<Way>> = const { Cell::new(None) };
}

/// The outcome of each way through `evaluate`, at least one.
pub fn each<T>(mut evaluate: impl FnMut() -> T, mut take: impl FnMut(T)) {
    let mut way = Way::default();
    loop {
        WAY.set(Some(Way { met: 0, ..way }));
        let outcome = evaluate();
        way = WAY.take().unwrap_or_default();
        take(outcome);
        // The next way: the last condition that has a side left takes it, and those after it start afresh.
        let mut last = way.met;
        while last > 0 && way.sides[last as usize - 1] + 1 == way.of[last as usize - 1] {
            last -= 1;
        }
        if last == 0 {
            return;
        }
        way.sides[last as usize - 1] += 1;
        way.given = last;
    }
}

/// The side to take of `of` sides; `None` where the hull is to be taken.
fn side(of: u8) -> Option<u8> {
    let mut way = WAY.get()?;
    if way.met == MOST {
        return None;
    }
    let at = way.met as usize;
    if way.met >= way.given {
        way.sides[at] = 0;
        way.of[at] = of;
    }
    way.met += 1;
    WAY.set(Some(way));
    Some(way.sides[at])
}

/// One side or the other of a condition, or the hull.
#[cold]
pub(super) fn choose<T>(then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T, hull: impl FnOnce(T, T) -> T) -> T {
    match side(2) {
        Some(0) => then(),
        Some(_) => otherwise(),
        None => hull(then(), otherwise()),
    }
}

/// One of the whole numbers from first to last, or the hull over all.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number of whole numbers")]
pub(super) fn whole<T>(first: f64, last: f64, then: impl Fn(f64) -> T, hull: impl Fn(T, T) -> T) -> T {
    let count = (last - first) as u8;
    if count > 0
        && count < 4
        && let Some(side) = side(count + 1)
    {
        return then(first + f64::from(side));
    }
    (1..=count).fold(then(first), |all, k| hull(all, then(first + f64::from(k))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Accept;
    use crate::profile::WGSL;
    use lightmeter_reference::Real;

    fn outcomes(mut evaluate: impl FnMut() -> Accept) -> Vec<(f64, f64)> {
        let mut found = vec![];
        WGSL.scope(|| each(&mut evaluate, |x| found.push((x.low(), x.high()))));
        found
    }

    #[test]
    fn each_way_is_followed_once() {
        let open: Accept = Accept::from_bounds(-1.0, 1.0);
        let zero = Accept::exactly(0.0);
        let step = |a: f64, b: f64| Accept::if_ge(open, zero, || Accept::exactly(a), || Accept::exactly(b));
        assert_eq!(outcomes(|| step(1.0, 0.0)), [(1.0, 1.0), (0.0, 0.0)]);
        assert_eq!(outcomes(|| step(1.0, 0.0) + step(4.0, 2.0)), [(5.0, 5.0), (3.0, 3.0), (4.0, 4.0), (2.0, 2.0)]);
        // A condition that only one side meets.
        let nested = || Accept::if_ge(open, zero, || step(8.0, 4.0), || zero);
        assert_eq!(outcomes(nested), [(8.0, 8.0), (4.0, 4.0), (0.0, 0.0)]);
        assert_eq!(outcomes(|| Accept::from_bounds(0.5, 2.5).floor_then(Accept::exactly)).len(), 3);
        assert_eq!(outcomes(|| zero), [(0.0, 0.0)]);
    }

    #[test]
    fn the_hull_is_taken_outside_and_beyond_the_most() {
        let open: Accept = Accept::from_bounds(-1.0, 1.0);
        let step = || Accept::if_ge(open, Accept::exactly(0.0), || Accept::exactly(1.0), || Accept::exactly(0.0));
        assert_eq!((step().low(), step().high()), (0.0, 1.0));
        let five = outcomes(|| (0..=MOST).fold(Accept::exactly(0.0), |sum, _| sum + step()));
        assert_eq!(five.len(), 16);
        assert!(five.iter().all(|(low, high)| (high - low - 1.0).abs() < 1e-6), "{five:?}");
        assert_eq!((step().low(), step().high()), (0.0, 1.0));
    }
}
