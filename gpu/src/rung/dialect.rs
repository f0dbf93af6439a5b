//! How the numbers of a rung are written in WGSL: types, literals, what takes them from f32 and back.

use super::Rung;
use std::collections::BTreeSet;

/// A rung's way of writing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dialect {
    /// f32 itself.
    Single,
    /// f16.
    Half,
    /// f64.
    Double,
    /// Structs of two f32.
    Pair,
}

/// The floats of a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// One.
    Scalar,
    /// A vector, by the number of its components.
    Vector(u8),
    /// A matrix, by the numbers of its columns and rows.
    Matrix(u8, u8),
}

impl Shape {
    /// Components of a vector, 1 of a number.
    pub(crate) const fn width(self) -> u8 {
        match self {
            Self::Scalar => 1,
            Self::Vector(size) => size,
            Self::Matrix(_, rows) => rows,
        }
    }
}

/// The f32 vector of `size` components.
pub(crate) fn plain_vector(size: u8) -> String {
    if size == 1 { "f32".into() } else { format!("vec{size}f") }
}

/// What a struct is called in the rung.
pub(crate) fn rung_struct(rung: Rung, name: &str) -> String {
    if Dialect::of(rung) == Dialect::Single { name.into() } else { format!("Rung{name}") }
}

impl Dialect {
    pub(crate) const fn of(rung: Rung) -> Self {
        match rung {
            Rung::Cheap | Rung::F32 | Rung::Stable => Self::Single,
            Rung::F16 => Self::Half,
            Rung::F64 => Self::Double,
            Rung::DoubleFloat => Self::Pair,
        }
    }

    /// What a value of these floats is.
    pub(crate) fn type_of(self, shape: Shape) -> String {
        let scalar = match self {
            Self::Single => "f32",
            Self::Half => "f16",
            Self::Double => "f64",
            Self::Pair => {
                return match shape {
                    Shape::Matrix(columns, rows) => format!("array<DF{rows}, {columns}>"),
                    _ => format!("DF{}", shape.width()),
                };
            }
        };
        match shape {
            Shape::Scalar => scalar.into(),
            Shape::Vector(size) => format!("vec{size}<{scalar}>"),
            Shape::Matrix(columns, rows) => format!("mat{columns}x{rows}<{scalar}>"),
        }
    }

    /// A value of f32 taken into the dialect; a matrix's text is repeated.
    pub(crate) fn up(self, shape: Shape, value: &str) -> String {
        if self == Self::Single {
            return value.into();
        }
        match shape {
            Shape::Matrix(columns, rows) => {
                let columns: Vec<String> =
                    (0..columns).map(|k| self.up(Shape::Vector(rows), &format!("{value}[{k}]"))).collect();
                format!("{}({})", self.type_of(shape), columns.join(", "))
            }
            _ if self == Self::Pair => format!("DF{0}({value}, {1}())", shape.width(), plain_vector(shape.width())),
            _ => format!("{}({value})", self.type_of(shape)),
        }
    }

    /// A value of the dialect rounded to f32; a matrix's text is repeated.
    pub(crate) fn down(self, shape: Shape, value: &str) -> String {
        if self == Self::Single {
            return value.into();
        }
        match shape {
            Shape::Matrix(columns, rows) => {
                let columns: Vec<String> =
                    (0..columns).map(|k| self.down(Shape::Vector(rows), &format!("{value}[{k}]"))).collect();
                format!("{}({})", Self::Single.type_of(shape), columns.join(", "))
            }
            _ if self == Self::Pair => format!("{value}.hi"),
            _ => format!("{}({value})", Self::Single.type_of(shape)),
        }
    }

    /// A component of a vector.
    pub(crate) fn component(self, vector: &str, index: &str) -> String {
        if self == Self::Pair {
            format!("DF1({vector}.hi[{index}], {vector}.lo[{index}])")
        } else {
            format!("{vector}[{index}]")
        }
    }

    /// A vector of the same number again and again.
    pub(crate) fn splat(self, size: u8, one: &str) -> String {
        match self {
            Self::Pair => format!("DF{size}(vec{size}f({one}.hi), vec{size}f({one}.lo))"),
            _ => format!("{}({one})", self.type_of(Shape::Vector(size))),
        }
    }

    /// A number as a literal. What binary16 cannot hold becomes the nearest that it can, but nothing becomes 0 or infinite, so
    /// that a bound stays one.
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is wanted")]
    pub(crate) fn literal(self, x: f64) -> String {
        match self {
            Self::Single => format!("{:?}f", x as f32),
            Self::Double => format!("{x:?}lf"),
            Self::Pair => {
                let hi = x as f32;
                format!("DF1({hi:?}f, {:?}f)", (x - f64::from(hi)) as f32)
            }
            Self::Half => {
                let (least, tiny) = (2.0_f64.powi(-24), 2.0_f64.powi(-14));
                let held = if x != 0.0 && x.abs() < least { tiny.copysign(x) } else { x.clamp(-65504.0, 65504.0) };
                format!("{held:?}h")
            }
        }
    }
}

/// The functions and types that a rung's text begins with.
#[derive(Clone, Debug)]
pub(crate) struct Prelude {
    /// WGSL.
    pub(crate) text: String,
    functions: BTreeSet<String>,
}

const F16: &str = include_str!("../shaders/rung/f16.wgsl");
const CHEAP: &str = include_str!("../shaders/rung/cheap.wgsl");
const DOUBLE_FLOAT: &str = include_str!("../shaders/rung/double_float.wgsl");
const DOUBLE_FLOAT_VECTOR: &str = include_str!("../shaders/rung/double_float_vector.wgsl");
const F64: &str = include_str!("../shaders/rung/f64.wgsl");

impl Prelude {
    pub(crate) fn of(rung: Rung) -> Self {
        let text = match rung {
            Rung::F32 | Rung::Stable => String::new(),
            Rung::F16 => F16.into(),
            Rung::Cheap => CHEAP.into(),
            Rung::DoubleFloat => {
                let vectors = [1, 2, 4].map(of_width);
                format!("{DOUBLE_FLOAT}\n{DOUBLE_FLOAT_VECTOR}\n{}", vectors.join("\n"))
            }
            Rung::F64 => F64.into(),
        };
        Self::new(text)
    }

    pub(crate) fn new(text: String) -> Self {
        let names = text.lines().filter_map(|line| Some(line.strip_prefix("fn ")?.split_once('(')?.0.to_owned()));
        let functions = names.collect();
        Self { text, functions }
    }

    /// Whether it defines a function.
    pub(crate) fn has(&self, function: &str) -> bool {
        self.functions.contains(function)
    }
}

/// The component-wise operations, written for three components, for another width.
fn of_width(width: u8) -> String {
    let vector = |of: &str| if width == 1 { of.to_owned() } else { format!("vec{width}<{of}>") };
    DOUBLE_FLOAT_VECTOR
        .replace("vec3<bool>", &vector("bool"))
        .replace("vec3f", &vector("f32"))
        .replace("vec3u", &vector("u32"))
        .replace("vec3i", &vector("i32"))
        .replace("DF3", &format!("DF{width}"))
        .replace("_3(", &format!("_{width}("))
}
