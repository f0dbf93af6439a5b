//! What is known of devices besides what they say of themselves: subpixel bits, and where a driver departs from the
//! accuracy that its interface promises.
//!
//! A deviation is scoped by driver and by version range. Within its range it is granted, and the run fails when its
//! witness shows that it is no longer needed; outside it is neither granted nor asked for.

use crate::blend_unit::model::BlendUnitModel;
use lightmeter_arithmetic::profile::Excess;
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_reference::Real;
use lightmeter_scene::target::TargetFormat;
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

    /// What a profile makes legal at x.
    #[must_use]
    pub fn interval(self, x: f32, profile: &Profile) -> Accept {
        let x: Accept = Accept::input(x);
        profile.scope(|| match self {
            Self::Exp => x.exp(),
            Self::Exp2 => x.exp2(),
        })
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

/// A blend unit that is known bit for bit.
#[derive(Clone, Copy, Debug)]
pub struct BlendModel {
    /// What the driver's own description contains.
    pub driver: &'static str,
    /// The first version concerned.
    pub from: Version,
    /// The first version no longer concerned.
    pub until: Version,
    /// What it computes.
    pub model: BlendUnitModel,
}

/// Every known blend unit.
pub const BLEND_MODELS: &[BlendModel] =
    &[BlendModel { driver: "llvmpipe", from: [22, 3, 0], until: [22, 4, 0], model: BlendUnitModel::Llvmpipe }];

impl BlendModel {
    fn concerns(&self, driver: &str) -> bool {
        concerns(driver, self.driver, self.from, self.until)
    }
}

/// A known departure of a blend unit, of any version until it is no longer seen.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BlendDeviation {
    /// Its name in reports.
    pub name: &'static str,
    /// What the driver's own description contains.
    pub driver: &'static str,
    /// Why, with the evidence.
    pub reason: &'static str,
    /// On which target.
    #[serde(skip)]
    pub target: TargetFormat,
    /// Results of at least this magnitude …
    pub from: f64,
    /// … are granted a NaN.
    pub becomes_nan: bool,
    /// A case in which the driver is seen to do so.
    #[serde(skip)]
    pub witness: &'static str,
}

/// Every known departure of a blend unit.
pub const BLEND_DEVIATIONS: &[BlendDeviation] = &[BlendDeviation {
    name: "swiftshader-half-overflow",
    driver: "SwiftShader",
    reason: "a result beyond 65504 is stored as a NaN of binary16: 1e6 as 0x7fff, 60000 + 60000 as 0x7f53",
    target: TargetFormat::Rgba16Float,
    // The least that does not round to 65504.
    from: 65_520.0,
    becomes_nan: true,
    witness: "blend/add/hard/beyond-half",
}];

impl BlendDeviation {
    /// Whether a result is one that it concerns.
    #[must_use]
    pub fn concerns(&self, target: TargetFormat, reference: f64) -> bool {
        target == self.target && reference.abs() >= self.from
    }

    /// Whether it makes a value legal.
    #[must_use]
    pub fn grants(&self, value: f64) -> bool {
        self.becomes_nan && value.is_nan()
    }
}

fn concerns(driver: &str, part: &str, from: Version, until: Version) -> bool {
    driver.contains(part) && version(driver).is_some_and(|version| from <= version && version < until)
}

impl Deviation {
    fn concerns(&self, driver: &str) -> bool {
        concerns(driver, self.driver, self.from, self.until)
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
#[derive(Clone, Debug, Default)]
pub struct Known {
    /// Bits after the point to which its rasteriser snaps; `None` where only the profile's promise is known.
    pub subpixel_bits: Option<u32>,
    /// The integer model that its blend unit is known to follow on 8 bits, bit for bit.
    pub blend_model: Option<BlendUnitModel>,
    /// Its deviations.
    pub deviations: Vec<&'static Deviation>,
    /// Under which name its treatment of NaN and infinity is on record, and whether for this very version: if so, another
    /// treatment fails the run.
    pub special_record: Option<(&'static str, bool)>,
    /// Those of its blend unit.
    pub blend_deviations: Vec<&'static BlendDeviation>,
}

impl Known {
    /// The profile with the subpixel bits that the rasteriser is known to have. The embedded implementation snaps nothing, but has
    /// to keep no less than the promise.
    #[must_use]
    pub fn profile(&self, profile: &Profile) -> Profile {
        Profile { subpixel_bits: self.subpixel_bits.unwrap_or(profile.subpixel_bits), ..*profile }
    }

    /// The same with all that its deviations are known for: what a mistake gives on it is within that.
    #[must_use]
    pub fn granted(&self, profile: &Profile) -> Profile {
        self.deviations.iter().fold(self.profile(profile), |granted, deviation| deviation.grant(granted))
    }
}

/// What is known of an adapter, by the names that its driver gives to its device and to itself.
#[must_use]
pub fn known(device: &str, driver: &str) -> Known {
    // Mesa's software rasteriser works in 1/256 pixel, by its Vulkan limit subPixelPrecisionBits and in its source.
    let subpixel_bits = device.starts_with("llvmpipe").then_some(8);
    let driver = format!("{device} {driver}");
    let llvmpipe = concerns(&driver, "llvmpipe", [22, 3, 0], [22, 4, 0]).then_some(("llvmpipe", true));
    Known {
        subpixel_bits,
        // SwiftShader does not tell its version.
        special_record: llvmpipe.or(driver.contains("SwiftShader").then_some(("SwiftShader", false))),
        blend_model: BLEND_MODELS.iter().find(|known| known.concerns(&driver)).map(|known| known.model),
        deviations: DEVIATIONS.iter().filter(|deviation| deviation.concerns(&driver)).collect(),
        blend_deviations: BLEND_DEVIATIONS.iter().filter(|deviation| driver.contains(deviation.driver)).collect(),
    }
}

/// The version behind the word `Mesa` in a driver's description.
pub fn version(driver: &str) -> Option<Version> {
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
