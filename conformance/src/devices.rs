//! What is known of devices besides what they say of themselves: subpixel bits, and where a driver departs from the
//! accuracy that its interface promises.
//!
//! A deviation is scoped by driver and by version range. Within its range it is granted, and the run fails when its
//! witness shows that it is no longer needed; outside it is neither granted nor asked for.

use crate::arithmetic::profile::Excess;
use crate::arithmetic::{Accept, Profile};
use lightmeter_gpu::Adapter;
use lightmeter_reference::Real;
use serde::Serialize;

/// A version of a driver: major, minor, patch.
pub type Version = [u32; 3];

/// The function that a deviation concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Builtin {
    /// exp.
    Exp,
    /// exp2, and so pow.
    Exp2,
}

impl Builtin {
    /// The function of `probe.wgsl` that evaluates it alone.
    #[must_use]
    pub const fn probe(self) -> &'static str {
        match self {
            Self::Exp => "probe_exp",
            Self::Exp2 => "probe_exp2",
        }
    }

    /// What is legal at x.
    #[must_use]
    pub fn interval(self, x: f32) -> Accept {
        let x: Accept = Accept::input(x);
        match self {
            Self::Exp => x.exp(),
            Self::Exp2 => x.exp2(),
        }
    }

    /// The exact value at x, correctly rounded to f64.
    #[must_use]
    pub fn exact(self, x: f32) -> f64 {
        match self {
            Self::Exp => core_math::exp(x.into()),
            Self::Exp2 => core_math::exp2(x.into()),
        }
    }
}

/// A known departure of a driver.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Deviation {
    /// Its name in reports.
    pub name: &'static str,
    /// What the driver's own description contains.
    pub driver: &'static str,
    /// The first version concerned.
    pub from: Version,
    /// The first version no longer concerned.
    pub until: Version,
    /// Why, with the evidence.
    pub reason: &'static str,
    /// The function concerned.
    pub builtin: Builtin,
    /// Arguments from here …
    pub low: f64,
    /// … to here …
    pub high: f64,
    /// … are granted this many times the promised bound.
    pub factor: f64,
    /// An argument at which the driver is seen outside the promised bound.
    pub witness: f32,
}

/// Every known deviation.
pub const DEVIATIONS: &[Deviation] = &[
    Deviation {
        name: "llvmpipe-exp",
        driver: "llvmpipe",
        from: [22, 3, 0],
        until: [22, 4, 0],
        reason: "exp is exp2(x · log2 e) by a polynomial: of all floats in [−4, −2⁻⁸] 9,775 lie outside 3 + 2|x| ULP, \
                 at most 1.130 times the bound, all between −0.0736 and −0.0280",
        builtin: Builtin::Exp,
        low: -0.0736,
        high: -0.028,
        factor: 1.131,
        witness: f32::from_bits(0xbd39_2a74),
    },
    Deviation {
        name: "llvmpipe-exp2",
        driver: "llvmpipe",
        from: [22, 3, 0],
        until: [22, 4, 0],
        reason: "exp2 by a polynomial: of all floats in [−4, −2⁻⁸] 4,304 lie outside 3 + 2|x| ULP, at most 1.106 times \
                 the bound, all between −0.0993 and −0.0404",
        builtin: Builtin::Exp2,
        low: -0.0993,
        high: -0.0404,
        factor: 1.107,
        witness: f32::from_bits(0xbd85_91a4),
    },
];

impl Deviation {
    fn concerns(&self, driver: &str) -> bool {
        driver.contains(self.driver)
            && version(driver).is_some_and(|version| self.from <= version && version < self.until)
    }

    /// The profile with the deviation granted.
    #[must_use]
    pub fn grant(&self, profile: Profile) -> Profile {
        let excess = Some(Excess { from: self.low, to: self.high, factor: self.factor });
        match self.builtin {
            Builtin::Exp => Profile { exp_excess: excess, ..profile },
            Builtin::Exp2 => Profile { exp2_excess: excess, ..profile },
        }
    }
}

/// What is known of one adapter.
#[derive(Clone, Debug)]
pub struct Known {
    /// Bits after the point to which its rasteriser snaps; `None` where only the profile's promise is known.
    pub subpixel_bits: Option<u32>,
    /// Its deviations.
    pub deviations: Vec<&'static Deviation>,
}

/// What is known of an adapter.
#[must_use]
pub fn known(adapter: &Adapter) -> Known {
    // Mesa's software rasteriser works in 1/256 pixel, by its Vulkan limit subPixelPrecisionBits and in its source.
    let subpixel_bits = adapter.device.starts_with("llvmpipe").then_some(8);
    let driver = format!("{} {}", adapter.device, adapter.driver);
    Known { subpixel_bits, deviations: DEVIATIONS.iter().filter(|deviation| deviation.concerns(&driver)).collect() }
}

/// The version behind the word `Mesa` in a driver's description.
fn version(driver: &str) -> Option<Version> {
    let words = driver.split("Mesa ").nth(1)?.split_whitespace().next()?;
    let mut numbers = words.split(['.', '-']).map(|part| part.parse().unwrap_or(0));
    Some(std::array::from_fn(|_| numbers.next().unwrap_or(0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_from_the_drivers_description() {
        assert_eq!(version("llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)"), Some([22, 3, 6]));
        assert_eq!(version("4.5 (Core Profile) Mesa 25.0.0-rc1"), Some([25, 0, 0]));
        assert_eq!(version("SwiftShader driver"), None);
    }

    #[test]
    fn every_deviation_names_a_witness_in_its_range() {
        for deviation in DEVIATIONS {
            assert!((deviation.low..=deviation.high).contains(&f64::from(deviation.witness)), "{}", deviation.name);
            assert!(deviation.from < deviation.until && deviation.factor > 1.0, "{}", deviation.name);
        }
    }
}
