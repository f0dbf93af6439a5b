//! What is known of devices besides what they say of themselves: subpixel bits, and where a driver departs from the
//! accuracy that its interface promises.
//!
//! A deviation is scoped by driver and by version range. Within its range it is granted, and the run fails when its
//! witness shows that it is no longer needed; outside it is neither granted nor asked for.

use crate::blend_unit::model::BlendUnitModel;
use lightmeter_arithmetic::profile::Excess;
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_document::Word;
use lightmeter_document::adapters::{BlendDeviation, Builtin, Deviation};
use lightmeter_reference::Real;
use lightmeter_scene::target::TargetFormat;

/// A version of a driver: major, minor, patch.
pub type Version = [u32; 3];

/// The function of `probe.wgsl` that evaluates a built-in function alone.
#[must_use]
pub const fn probe(builtin: Builtin) -> &'static str {
    match builtin {
        Builtin::Exp => "probe_exp",
        Builtin::Exp2 => "probe_exp2",
    }
}

/// What a profile makes legal of a built-in function at x.
#[must_use]
pub fn interval(builtin: Builtin, x: f32, profile: &Profile) -> Accept {
    let x: Accept = Accept::input(x);
    profile.scope(|| match builtin {
        Builtin::Exp => x.exp(),
        Builtin::Exp2 => x.exp2(),
    })
}

/// The exact value of a built-in function at x, correctly rounded to f64.
#[must_use]
pub fn exact(builtin: Builtin, x: f32) -> f64 {
    match builtin {
        Builtin::Exp => core_math::exp(x.into()),
        Builtin::Exp2 => core_math::exp2(x.into()),
    }
}

/// Every known deviation.
pub static DEVIATIONS: &[Deviation] = &[
    Deviation {
        name: Word::Borrowed("llvmpipe-exp"),
        driver: Word::Borrowed("llvmpipe"),
        from: [22, 3, 0],
        until: [22, 4, 0],
        reason: Word::Borrowed(
            "exp is exp2(x · log2 e) by a polynomial: of all floats in [−4, −2⁻⁸] 9,775 lie outside 3 + 2|x| ULP, \
                 at most 1.130 times the bound, all between −0.0736 and −0.0280",
        ),
        builtin: Builtin::Exp,
        low: -0.0736,
        high: -0.028,
        factor: 1.131,
        witness: f32::from_bits(0xbd39_2a74),
    },
    Deviation {
        name: Word::Borrowed("llvmpipe-exp2"),
        driver: Word::Borrowed("llvmpipe"),
        from: [22, 3, 0],
        until: [22, 4, 0],
        reason: Word::Borrowed(
            "exp2 by a polynomial: of all floats in [−4, −2⁻⁸] 4,304 lie outside 3 + 2|x| ULP, at most 1.106 times \
                 the bound, all between −0.0993 and −0.0404",
        ),
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

/// Every known departure of a blend unit, of any version until it is no longer seen.
pub static BLEND_DEVIATIONS: &[BlendDeviation] = &[BlendDeviation {
    name: Word::Borrowed("swiftshader-half-overflow"),
    driver: Word::Borrowed("SwiftShader"),
    reason: Word::Borrowed(
        "a result beyond 65504 is stored as a NaN of binary16: 1e6 as 0x7fff, 60000 + 60000 as 0x7f53",
    ),
    target: TargetFormat::Rgba16Float,
    // The least that does not round to 65504.
    from: 65_520.0,
    becomes_nan: true,
    witness: Word::Borrowed("blend/add/hard/beyond-half"),
}];

/// Whether a result is one that a departure of a blend unit concerns.
#[must_use]
pub fn concerns_result(deviation: &BlendDeviation, target: TargetFormat, reference: f64) -> bool {
    target == deviation.target && reference.abs() >= deviation.from
}

/// Whether a departure of a blend unit makes a value legal.
#[must_use]
pub const fn grants(deviation: &BlendDeviation, value: f64) -> bool {
    deviation.becomes_nan && value.is_nan()
}

fn concerns(driver: &str, part: &str, from: Version, until: Version) -> bool {
    driver.contains(part) && version(driver).is_some_and(|version| from <= version && version < until)
}

/// A profile with a deviation granted.
#[must_use]
pub const fn grant(deviation: &Deviation, profile: Profile) -> Profile {
    let excess = Some(Excess { from: deviation.low, to: deviation.high, factor: deviation.factor });
    match deviation.builtin {
        Builtin::Exp => Profile { exp_excess: excess, ..profile },
        Builtin::Exp2 => Profile { exp2_excess: excess, ..profile },
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
        self.deviations.iter().fold(self.profile(profile), |granted, deviation| grant(deviation, granted))
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
        deviations: DEVIATIONS
            .iter()
            .filter(|known| concerns(&driver, &known.driver, known.from, known.until))
            .collect(),
        blend_deviations: BLEND_DEVIATIONS.iter().filter(|deviation| driver.contains(&*deviation.driver)).collect(),
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
