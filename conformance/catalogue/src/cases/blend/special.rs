//! NaN and infinity in blending, of which nothing is promised: named cases by state.

use crate::cases::Hard;
use lightmeter_scene::blend::{Equation, Factor, State};

const INF: f32 = f32::INFINITY;
const NAN: f32 = f32::NAN;

macro_rules! special {
    ($name:literal, $pins:literal, $src:expr, $dst:expr) => {
        Hard::new($name, $pins, &[("src", &$src), ("dst", &$dst)])
    };
}

/// NaN and infinity by state. Red, green and blue are alike where nothing else is said.
pub(super) const SPECIAL: &[(State, &[Hard])] = &[
    (
        State { equation: Equation::Add, src: Factor::Zero, dst: Factor::One },
        &[
            special!("nan-source-times-zero", "0·NaN", [NAN, NAN, NAN, 0.5], [0.25; 4]),
            special!("infinite-source-times-zero", "0·∞", [INF, INF, INF, 0.5], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Add, src: Factor::One, dst: Factor::Zero },
        &[
            special!("nan-destination-times-zero", "NaN·0", [0.25; 4], [NAN, NAN, NAN, 0.5]),
            special!("infinite-destination-times-zero", "∞·0", [0.25; 4], [INF, INF, INF, 0.5]),
            special!("nan-source", "NaN is stored", [NAN, NAN, NAN, 0.5], [0.25; 4]),
            special!("infinite-source", "∞ is stored", [INF, INF, INF, 0.5], [0.25; 4]),
            special!("negative-infinite-source", "−∞ is stored", [-INF, -INF, -INF, 0.5], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Add, src: Factor::One, dst: Factor::One },
        &[
            special!("infinities-of-both-signs", "∞ + −∞", [INF, INF, INF, 0.5], [-INF, -INF, -INF, 0.5]),
            special!("nan-plus-number", "NaN + 0.25", [NAN, NAN, NAN, 0.5], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Subtract, src: Factor::One, dst: Factor::One },
        &[special!("infinity-minus-infinity", "∞ − ∞", [INF, INF, INF, 0.5], [INF, INF, INF, 0.5])],
    ),
    (
        State { equation: Equation::Add, src: Factor::SrcAlpha, dst: Factor::OneMinusSrcAlpha },
        &[
            special!("opaque-over-infinity", "∞·(1 − 1)", [0.25, 0.25, 0.25, 1.0], [INF, INF, INF, 0.5]),
            special!("transparent-nan", "NaN·0 by a factor that is not constant", [NAN, NAN, NAN, 0.0], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Min, src: Factor::One, dst: Factor::One },
        &[
            special!("min-of-nan-source", "min(NaN, 0.25)", [NAN, NAN, NAN, 0.5], [0.25; 4]),
            special!("min-of-nan-destination", "min(0.25, NaN)", [0.25; 4], [NAN, NAN, NAN, 0.5]),
            special!("min-of-infinity", "min(∞, 0.25)", [INF, INF, INF, 0.5], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Max, src: Factor::One, dst: Factor::One },
        &[
            special!("max-of-nan-source", "max(NaN, 0.25)", [NAN, NAN, NAN, 0.5], [0.25; 4]),
            special!("max-of-nan-destination", "max(0.25, NaN)", [0.25; 4], [NAN, NAN, NAN, 0.5]),
            special!("max-of-infinity", "max(∞, 0.25)", [INF, INF, INF, 0.5], [0.25; 4]),
        ],
    ),
];
