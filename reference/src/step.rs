//! Named steps of formulas, and the tuples of what they are computed from.

use crate::real::{Parts, Real};

impl<R: Real, T: Parts<R>, const N: usize> Parts<R> for [T; N] {
    const COUNT: usize = N * T::COUNT;

    #[inline]
    fn each(self, mut f: impl FnMut(R) -> R) -> Self {
        self.map(|x| x.each(&mut f))
    }

    fn put(self, to: &mut impl FnMut(R)) {
        self.into_iter().for_each(|x| x.put(to));
    }

    fn take(from: &mut impl FnMut() -> R) -> Self {
        std::array::from_fn(|_| T::take(from))
    }
}

macro_rules! tuples {
    ($(($($part:ident $place:tt),+)),+ $(,)?) => {$(
        impl<R: Real, $($part: Parts<R>),+> Parts<R> for ($($part,)+) {
            const COUNT: usize = 0 $(+ $part::COUNT)+;
            const SIZES: &'static [usize] = &[$($part::COUNT),+];

            #[inline]
            fn each(self, mut f: impl FnMut(R) -> R) -> Self {
                ($(self.$place.each(&mut f),)+)
            }

            fn put(self, to: &mut impl FnMut(R)) {
                $(self.$place.put(to);)+
            }

            fn take(from: &mut impl FnMut() -> R) -> Self {
                ($($part::take(from),)+)
            }
        }
    )+};
}

tuples!(
    (A 0),
    (A 0, B 1),
    (A 0, B 1, C 2),
    (A 0, B 1, C 2, D 3),
    (A 0, B 1, C 2, D 3, E 4),
    (A 0, B 1, C 2, D 3, E 4, F 5),
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6),
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7),
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7, I 8),
);

/// A named step of a formula over `R`: `step!("CA", |light, material| light * material)`. What stands between the bars are names
/// in scope, which the step is computed from and known by. A `quiet` step only hands something on.
macro_rules! step {
    ($name:expr, |$($of:ident),+| $compute:expr) => {
        $crate::step::step!(@ $name, false, |$($of),+| $compute)
    };
    (quiet $name:expr, |$($of:ident),+| $compute:expr) => {
        $crate::step::step!(@ $name, true, |$($of),+| $compute)
    };
    (@ $name:expr, $is_quiet:expr, |$($of:ident),+| $compute:expr) => {
        R::step(
            const { &$crate::NamedStep { name: $name, of: &[$(stringify!($of)),+], is_quiet: $is_quiet } },
            ($($of,)+),
            |($($of,)+)| {
                let _ = ($(&$of,)+);
                $compute
            },
        )
    };
}
pub(crate) use step;
