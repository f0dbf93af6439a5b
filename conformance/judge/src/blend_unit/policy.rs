//! NaN and infinity on float targets: what is promised, and what each driver was seen to do.
//!
//! Nothing is promised. A shading language may assume that there is neither, so a blend unit that is given one may leave
//! anything. What drivers do is recorded as data all the same: a renderer that depends on it should know when it changes.

use super::pixel::Units;
use lightmeter_catalogue::cases::blend::UnitCase;
use lightmeter_scene::target::TargetFormat;

/// What an interface promises.
#[derive(Clone, Copy, Debug)]
pub struct InterfacePromise {
    /// Which.
    pub interface: &'static str,
    /// What it says.
    pub says: &'static str,
    /// Whether a value follows from it where there is NaN or infinity.
    pub promises_a_value: bool,
}

/// What the interfaces promise of NaN and infinity in blending.
pub const PROMISES: &[InterfacePromise] = &[
    InterfacePromise {
        interface: "WGSL",
        says: "an implementation may assume that there is neither NaN nor infinity in a shader",
        promises_a_value: false,
    },
    InterfacePromise {
        interface: "Vulkan",
        says: "blending has at least the precision and the range of the target's components; of NaN it says nothing",
        promises_a_value: false,
    },
    InterfacePromise {
        interface: "WebGPU and OpenGL",
        says: "blending is as the formulas say; of NaN they say nothing",
        promises_a_value: false,
    },
];

/// What a driver was seen to leave of a colour.
#[derive(Clone, Copy, Debug)]
pub struct ObservedColor {
    /// The named case.
    pub case: &'static str,
    /// The driver.
    pub driver: &'static str,
    /// On rgba32float.
    pub float32: &'static str,
    /// On rgba16float.
    pub float16: &'static str,
}

/// Whether a component was given NaN or infinity, so that anything may be left.
#[must_use]
pub fn promises_nothing(case: &UnitCase, component: usize) -> bool {
    let is_special = !case.sources[0][component].is_finite() || !case.dst[component].is_finite();
    is_special && PROMISES.iter().all(|promise| !promise.promises_a_value)
}

/// What a pixel's colour holds, in a word where its components are alike: `NaN`, `Inf`, `-Inf` or a number.
#[must_use]
pub fn observed([r, g, b, _]: Units) -> String {
    let words = [r, g, b].map(|c| lightmeter_document::Number(c).to_string());
    let [first, rest @ ..] = &words;
    if rest.iter().all(|word| word == first) { first.clone() } else { words.join(" ") }
}

/// What is recorded of a driver in a case on a target.
#[must_use]
pub fn recorded(driver: &str, case: &str, target: TargetFormat) -> Option<&'static str> {
    let seen = SEEN.iter().find(|seen| seen.case == case && driver == seen.driver)?;
    Some(if target == TargetFormat::Rgba32Float { seen.float32 } else { seen.float16 })
}

/// Mesa 22.3.6's llvmpipe, under Vulkan and OpenGL alike, and the SwiftShader of Chromium.
pub const SEEN: &[ObservedColor] = &[
    seen("nan-source-times-zero", "llvmpipe", "0.25", "0.25"),
    seen("nan-source-times-zero", "SwiftShader", "0.25", "0.25"),
    seen("infinite-source-times-zero", "llvmpipe", "0.25", "0.25"),
    seen("infinite-source-times-zero", "SwiftShader", "0.25", "0.25"),
    seen("nan-destination-times-zero", "llvmpipe", "0.25", "0.25"),
    seen("nan-destination-times-zero", "SwiftShader", "0.25", "0.25"),
    seen("infinite-destination-times-zero", "llvmpipe", "0.25", "0.25"),
    seen("infinite-destination-times-zero", "SwiftShader", "0.25", "0.25"),
    seen("nan-source", "llvmpipe", "NaN", "NaN"),
    seen("nan-source", "SwiftShader", "NaN", "NaN"),
    seen("infinite-source", "llvmpipe", "Inf", "Inf"),
    seen("infinite-source", "SwiftShader", "Inf", "NaN"),
    seen("negative-infinite-source", "llvmpipe", "-Inf", "-Inf"),
    seen("negative-infinite-source", "SwiftShader", "-Inf", "NaN"),
    seen("infinities-of-both-signs", "llvmpipe", "NaN", "NaN"),
    seen("infinities-of-both-signs", "SwiftShader", "NaN", "NaN"),
    seen("nan-plus-number", "llvmpipe", "NaN", "NaN"),
    seen("nan-plus-number", "SwiftShader", "NaN", "NaN"),
    seen("infinity-minus-infinity", "llvmpipe", "NaN", "NaN"),
    seen("infinity-minus-infinity", "SwiftShader", "NaN", "NaN"),
    seen("opaque-over-infinity", "llvmpipe", "NaN", "NaN"),
    seen("opaque-over-infinity", "SwiftShader", "NaN", "0.25"),
    seen("transparent-nan", "llvmpipe", "NaN", "NaN"),
    seen("transparent-nan", "SwiftShader", "NaN", "NaN"),
    seen("min-of-nan-source", "llvmpipe", "0.25", "0.25"),
    seen("min-of-nan-source", "SwiftShader", "0.25", "0.25"),
    seen("min-of-nan-destination", "llvmpipe", "NaN", "NaN"),
    seen("min-of-nan-destination", "SwiftShader", "NaN", "0.25"),
    seen("min-of-infinity", "llvmpipe", "0.25", "0.25"),
    seen("min-of-infinity", "SwiftShader", "0.25", "0.25"),
    seen("max-of-nan-source", "llvmpipe", "0.25", "0.25"),
    seen("max-of-nan-source", "SwiftShader", "0.25", "0.25"),
    seen("max-of-nan-destination", "llvmpipe", "NaN", "NaN"),
    seen("max-of-nan-destination", "SwiftShader", "NaN", "NaN"),
    seen("max-of-infinity", "llvmpipe", "Inf", "Inf"),
    seen("max-of-infinity", "SwiftShader", "Inf", "NaN"),
];

const fn seen(case: &'static str, driver: &'static str, float32: &'static str, float16: &'static str) -> ObservedColor {
    ObservedColor { case, driver, float32, float16 }
}
