//! Classes of inputs, and how inputs of each are drawn.

use crate::graph::{Type, Value};

/// What an input of a step is, by which it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Class {
    /// A vector of length 1.
    Unit,
    Vector,
    Matrix,
    Color,
    /// A positive number: a distance, a coefficient.
    Positive,
    /// The cosine of an angle.
    Cosine,
    /// The exponent of a highlight or of a cone.
    Exponent,
    /// Between 0 and 1.
    Share,
    /// Any number.
    Any,
}

/// The names of templates' parameters.
const NAMES: [(&str, Class); 38] = [
    ("n", Class::Unit),
    ("l", Class::Unit),
    ("v", Class::Unit),
    ("a", Class::Unit),
    ("b", Class::Unit),
    ("axis", Class::Unit),
    ("offset", Class::Vector),
    ("normal", Class::Vector),
    ("m", Class::Matrix),
    ("color", Class::Color),
    ("other", Class::Color),
    ("f90", Class::Color),
    ("third", Class::Color),
    ("lit", Class::Color),
    ("f0", Class::Color),
    ("weights", Class::Color),
    ("d", Class::Positive),
    ("x", Class::Positive),
    ("start", Class::Positive),
    ("to", Class::Positive),
    ("width", Class::Positive),
    ("scale", Class::Positive),
    ("radius", Class::Positive),
    ("density", Class::Positive),
    ("kc", Class::Positive),
    ("kl", Class::Positive),
    ("kq", Class::Positive),
    ("k", Class::Positive),
    ("power", Class::Positive),
    ("cut", Class::Cosine),
    ("inner", Class::Cosine),
    ("outer", Class::Cosine),
    ("exponent", Class::Exponent),
    ("share", Class::Share),
    ("floor", Class::Share),
    ("c", Class::Share),
    ("alpha", Class::Share),
    ("amount", Class::Any),
];

impl Class {
    pub(crate) fn of_name(name: &str) -> Option<Self> {
        NAMES.iter().find(|(own, _)| *own == name).map(|(_, class)| *class)
    }

    /// A value of it.
    pub(super) fn sample(self, ty: Type, random: &mut Random) -> Value<f64> {
        let (low, high) = match self {
            Self::Unit => (-1.0, 1.0),
            Self::Vector | Self::Matrix => (-1.7, 1.7),
            Self::Positive => (0.004, 2.3),
            Self::Any => (-1.3, 2.1),
            Self::Cosine => (-0.95, 0.95),
            Self::Exponent => (1.5, 9.0),
            Self::Share => (0.03, 0.97),
            Self::Color => (0.0005, 0.95),
        };
        // Transfer functions have their thresholds near black, and coefficients have floors near 0.
        let place = |random: &mut Random| match self {
            Self::Positive => random.share().powi(2),
            Self::Color => random.share().powi(3),
            _ => random.share(),
        };
        let value: Value<f64> = (0..ty.length()).map(|_| low + (high - low) * place(random)).collect();
        if self != Self::Unit {
            return value;
        }
        let length = value.dot(&value).sqrt();
        value.map(|own| own / length)
    }
}

/// Numbers that are always the same: xorshift64*.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// From 0 to 1.
    #[expect(clippy::cast_precision_loss, reason = "the upper 53 bits alone")]
    pub(crate) fn share(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
