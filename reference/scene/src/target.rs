//! The formats of colour targets.

/// A format that colours are blended on and stored in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TargetFormat {
    /// Four binary32 components.
    Rgba32Float,
    /// Four binary16 components.
    Rgba16Float,
    /// Four components of 8 bits, 0 to 255 for 0 to 1.
    Rgba8Unorm,
    /// The same with red, green and blue encoded as IEC 61966-2-1 has it; alpha is linear.
    Rgba8UnormSrgb,
    /// Four components of 8 bits, stored blue first.
    Bgra8Unorm,
}

/// How a target holds a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// binary32.
    Float32,
    /// binary16.
    Float16,
    /// 8 bits, linear.
    Unorm8,
    /// 8 bits, red, green and blue encoded, alpha linear.
    Srgb8,
}

impl TargetFormat {
    /// All, in the order of reports.
    pub const ALL: [Self; 5] =
        [Self::Rgba32Float, Self::Rgba16Float, Self::Rgba8Unorm, Self::Rgba8UnormSrgb, Self::Bgra8Unorm];

    /// WebGPU's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rgba32Float => "rgba32float",
            Self::Rgba16Float => "rgba16float",
            Self::Rgba8Unorm => "rgba8unorm",
            Self::Rgba8UnormSrgb => "rgba8unorm-srgb",
            Self::Bgra8Unorm => "bgra8unorm",
        }
    }

    /// The format of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// How it holds a component.
    #[inline]
    #[must_use]
    pub const fn encoding(self) -> Encoding {
        match self {
            Self::Rgba32Float => Encoding::Float32,
            Self::Rgba16Float => Encoding::Float16,
            Self::Rgba8Unorm | Self::Bgra8Unorm => Encoding::Unorm8,
            Self::Rgba8UnormSrgb => Encoding::Srgb8,
        }
    }

    /// Whether it holds 0 to 1 alone: sources, constants and results are clamped on it.
    #[inline]
    #[must_use]
    pub const fn is_unorm(self) -> bool {
        matches!(self.encoding(), Encoding::Unorm8 | Encoding::Srgb8)
    }

    /// Whether blue stands before red in memory.
    #[inline]
    #[must_use]
    pub const fn is_blue_first(self) -> bool {
        matches!(self, Self::Bgra8Unorm)
    }

    /// Bytes of a component.
    #[inline]
    #[must_use]
    pub const fn component_bytes(self) -> usize {
        match self.encoding() {
            Encoding::Float32 => 4,
            Encoding::Float16 => 2,
            Encoding::Unorm8 | Encoding::Srgb8 => 1,
        }
    }
}

/// What outputs hold before anything is written: a NaN that no formula gives, so that "wrote 0" and "never wrote" differ.
pub const SENTINEL: u32 = 0x7fc5_e171;
