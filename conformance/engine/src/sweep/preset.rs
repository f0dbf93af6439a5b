//! Sweeps that are ready-made: a formula, what is free, its range, and the other inputs, as data.

/// A ready-made sweep.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// The formula's id.
    pub formula: &'static str,
    /// What it is, on a line.
    pub what: &'static str,
    /// What is free.
    pub free: Free,
}

/// What is free in a ready-made sweep.
#[derive(Clone, Copy, Debug)]
pub enum Free {
    /// One number, over every float of a range.
    Number {
        /// The free number's name.
        over: &'static str,
        /// The least …
        from: f32,
        /// … and the greatest.
        to: f32,
        /// Inputs that are given; the others stand in the middle of their domain.
        set: &'static [(&'static str, &'static [f32])],
        /// The output's name.
        output: &'static str,
    },
    /// The blend unit on 8 bits: a component of source and destination, and the source's alpha, 256 × 256 × 256.
    Bytes,
}

const COLOR: &[f32] = &[1.0, 1.0, 1.0];
/// The components that are not swept cost nothing.
const BLACK: &[f32] = &[0.0, 0.0, 0.0, 1.0];
const BLACK_C: &[(&str, &[f32])] = &[("c", BLACK)];
const BLACK_E: &[(&str, &[f32])] = &[("e", BLACK)];

/// All, in the order of lists.
pub const PRESETS: &[Preset] = &[
    Preset {
        formula: "fog/linear",
        what: "linear fog from 10 to 1000 against distance",
        free: Free::Number {
            over: "p.z",
            from: 0.0,
            to: 1e6,
            set: &[("dmin", &[10.0]), ("dmax", &[1000.0])],
            output: "f",
        },
    },
    Preset {
        formula: "fog/exp",
        what: "exponential fog of density 0.01 against distance",
        free: Free::Number { over: "p.z", from: 0.0, to: 1e6, set: &[("density", &[0.01])], output: "f" },
    },
    Preset {
        formula: "fog/exp2-document",
        what: "the document's squared exponential fog of density 0.0001 against distance",
        free: Free::Number { over: "p.z", from: 0.0, to: 1e6, set: &[("density", &[0.0001])], output: "f" },
    },
    Preset {
        formula: "fog/exp2-opengl",
        what: "OpenGL's squared exponential fog of density 0.01 against distance",
        free: Free::Number { over: "p.z", from: 0.0, to: 1e6, set: &[("density", &[0.01])], output: "f" },
    },
    Preset {
        formula: "attenuation/polynomial",
        what: "attenuation by (1, 0.1, 0.01) against distance",
        free: Free::Number {
            over: "d",
            from: 0.0,
            to: 1e6,
            set: &[("kc", &[1.0]), ("kl", &[0.1]), ("kq", &[0.01])],
            output: "atten",
        },
    },
    Preset {
        formula: "lighting/specular-nonlocal",
        what: "the power of a highlight of shininess 32 against the cosine",
        free: Free::Number {
            over: "r.z",
            from: 0.0,
            to: 1.0,
            set: &[("ls", COLOR), ("ms", COLOR), ("shininess", &[32.0])],
            output: "color.r",
        },
    },
    Preset {
        formula: "color/to-unorm8",
        what: "conversion to 8 bits against colour",
        free: Free::Number { over: "c", from: 0.0, to: 1.0, set: &[], output: "byte" },
    },
    Preset {
        formula: "color/srgb-encode",
        what: "sRGB encoding against linear colour",
        free: Free::Number { over: "c.r", from: 0.0, to: 1.0, set: BLACK_C, output: "color.r" },
    },
    Preset {
        formula: "color/srgb-decode",
        what: "sRGB decoding against encoded colour",
        free: Free::Number { over: "e.r", from: 0.0, to: 1.0, set: BLACK_E, output: "color.r" },
    },
    Preset { formula: "blend/mode-solid", what: "mode SOLID by the blend unit on 8 bits", free: Free::Bytes },
    Preset { formula: "blend/mode-alpha", what: "mode ALPHA by the blend unit on 8 bits", free: Free::Bytes },
    Preset { formula: "blend/mode-mul", what: "mode MUL by the blend unit on 8 bits", free: Free::Bytes },
    Preset { formula: "blend/mode-add", what: "mode ADD by the blend unit on 8 bits", free: Free::Bytes },
];

impl Preset {
    /// The one of a formula.
    #[must_use]
    pub fn of(formula: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.formula == formula)
    }
}
