//! The formats of colour targets.

use crate::words::words;

words! {
    /// A format that colours are blended on and stored in.
    #[derive(Default)]
    pub enum TargetFormat {
        /// Four binary32 components.
        Rgba32Float = "rgba32float",
        /// Four binary16 components.
        Rgba16Float = "rgba16float",
        /// Four components of 8 bits, 0 to 255 for 0 to 1.
        #[default]
        Rgba8Unorm = "rgba8unorm",
        /// The same with red, green and blue encoded as IEC 61966-2-1 has it; alpha is linear.
        Rgba8UnormSrgb = "rgba8unorm-srgb",
        /// Four components of 8 bits, stored blue first.
        Bgra8Unorm = "bgra8unorm",
    }
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
