//! Properties: laws of the formulas, agreement of the GPU with the reference, controls, and the intervals' soundness.

#![expect(clippy::float_cmp, reason = "what must hold exactly is compared exactly")]

mod attenuation;
mod blend;
mod color;
mod condition;
mod depth;
mod fog;
mod interpolation;
mod ladder;
mod lighting;
mod scene;
mod shards;
mod soundness;
mod stability;
mod technique;
mod vector;

use lightmeter_reference::Vec3;

/// A vector of f32 numbers widened exactly.
fn wide(v: [f32; 3]) -> Vec3<f64> {
    lightmeter_reference::Vector(v.map(f64::from))
}

/// The two tests that every family has besides its laws.
macro_rules! family {
    ($name:literal, $rows:literal) => {
        #[test]
        #[ignore = "long: ./x campaign long"]
        fn the_gpu_agrees() {
            if lightmeter_tests::needs::lacks_driver() {
                return;
            }
            for group in lightmeter_tests::groups($name) {
                lightmeter_tests::agree(&group, $rows);
            }
        }

        #[test]
        fn wrong_values_fail() {
            lightmeter_tests::control($name);
        }
    };
}
pub(crate) use family;
