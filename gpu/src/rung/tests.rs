//! Texts in every rung's arithmetic: that they are valid, and what they compute.

use super::dialect::Prelude;
use super::lower::{Asked, NOTHING_STABLE, READS_BITS, lower};
use super::probe::probe_with;
use super::*;
use crate::adapters;
use crate::compose::tests::sets;
use crate::compose::{Composer, Shader};
use crate::shaders::{Shaders, validate_lowered};
use lightmeter_scene::effects::Effects;

const FAMILIES: [&str; 9] =
    ["attenuation", "blend", "color", "depth", "elementary", "fog", "interpolation", "lighting", "vector"];

fn built_in() -> Shaders {
    Shaders::built_in().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn preludes_are_valid() {
    for rung in Rung::ALL {
        let enable = if rung == Rung::F16 { "enable f16;\n" } else { "" };
        let text = format!("{enable}{}", Prelude::of(rung).text);
        if let Err(error) = validate_lowered(rung.name(), &text) {
            panic!("{error}");
        }
    }
}

#[test]
fn every_function_of_the_families_is_valid_at_every_rung_or_says_why_not() {
    let shaders = built_in();
    let (mut unavailable, mut count) = (vec![], 0);
    for family in FAMILIES {
        let file = format!("{family}.wgsl");
        let module = shaders.parse(&file).unwrap_or_else(|error| panic!("{error}"));
        let source = shaders.source(&file);
        let own = shaders.text(&file);
        for (_, function) in module.functions.iter() {
            let name = function.name.clone().unwrap_or_default();
            if !own.contains(&format!("fn {name}(")) {
                continue;
            }
            for rung in Rung::ALL {
                match lower(&source, rung, &shaders.stable_forms(), Asked::Function(&name)) {
                    Ok(lowered) => {
                        if let Err(error) = validate_lowered(&name, &lowered.source) {
                            panic!("{name} in {}: {error}", rung.name());
                        }
                        count += 1;
                    }
                    Err(reason) if reason == NOTHING_STABLE && rung == Rung::Stable => {}
                    Err(reason) => unavailable.push(format!("{name} {}: {reason}", rung.name())),
                }
            }
        }
    }
    let mut expected = vec![];
    for function in ["elementary_upper", "elementary_product_error"] {
        for rung in [Rung::F16, Rung::DoubleFloat, Rung::F64] {
            expected.push(format!("{function} {}: {READS_BITS}", rung.name()));
        }
    }
    assert_eq!(unavailable, expected, "{count} are available");
}

/// Mesa's and SwiftShader's software drivers, by what they had when this was written.
#[test]
fn what_is_unavailable_on_an_adapter_is_known() {
    for adapter in adapters().into_iter().filter(|adapter| adapter.is_cpu) {
        let gpu = adapter.open().unwrap_or_else(|error| panic!("{error}"));
        for rung in Rung::ALL {
            let reason =
                rung.unavailable(&gpu).unwrap_or_else(|error| panic!("{} {}: {error}", adapter.name, rung.name()));
            let expected = match rung {
                Rung::F16 if adapter.name != "lavapipe" => Some("the adapter lacks the feature SHADER_F16"),
                Rung::F64 if adapter.name != "lavapipe" => Some("the adapter lacks the feature SHADER_F64"),
                _ => None,
            };
            assert_eq!(reason.as_deref(), expected, "{} {}", adapter.name, rung.name());
        }
    }
}

#[test]
fn transforms_that_a_compiler_sees_through_are_found_out() {
    let text = Prelude::of(Rung::DoubleFloat).text;
    let opaque = "bitcast<f32>(reverseBits(reverseBits(bitcast<u32>(x))))";
    assert!(text.contains(opaque));
    // Mesa's compiler does; SwiftShader's does not.
    for adapter in adapters().into_iter().filter(|adapter| adapter.name.contains("pipe")) {
        let gpu = adapter.open().unwrap_or_else(|error| panic!("{error}"));
        let reason = probe_with(Rung::DoubleFloat, &text.replace(opaque, "x"), &gpu);
        let reason = reason.unwrap_or_else(|error| panic!("{error}"));
        let expected = "the compiler takes error-free transforms apart";
        assert!(reason.is_some_and(|reason| reason.starts_with(expected)), "{}", adapter.name);
    }
}

#[test]
fn functions_that_are_wrong_are_found_out() {
    let spoil = |rung: Rung, good: &str, bad: &str| {
        let text = Prelude::of(rung).text;
        assert!(text.contains(good), "{good}");
        text.replace(good, bad)
    };
    let exp = spoil(Rung::F64, "(1.0lf + rung_exp_m1_series(r)) * rung_power(i32(k))", "1.0lf + x");
    let log = spoil(Rung::F64, "let z = s * s;", "let z = s * s * 1.001lf;");
    for (wrong, expected) in [(exp, "exp of f64 is off"), (log, "log of f64 is off")] {
        for adapter in adapters().into_iter().filter(|adapter| adapter.name == "lavapipe") {
            let gpu = adapter.open().unwrap_or_else(|error| panic!("{error}"));
            let reason = probe_with(Rung::F64, &wrong, &gpu).unwrap_or_else(|error| panic!("{error}"));
            assert!(reason.is_some_and(|reason| reason.starts_with(expected)), "{expected}");
        }
    }
}

#[test]
fn shaders_of_scenes_are_valid_at_every_rung() {
    let composer = Composer::new(&built_in()).unwrap_or_else(|error| panic!("{error}"));
    let sets = sets();
    let sample = sets.iter().step_by(sets.len() / 300).map(|&effects| (effects, Shader::Composed));
    let mut nothing_stable = 0;
    for (effects, shader) in sample.chain([(Effects::NONE, Shader::Full)]) {
        let composition = composer.compose(effects, shader, None).unwrap_or_else(|error| panic!("{error}"));
        for rung in Rung::ALL {
            match composer.lower(&composition, rung) {
                Ok(_) => {}
                Err(Error::Unavailable { reason, .. }) if reason == NOTHING_STABLE && rung == Rung::Stable => {
                    nothing_stable += 1;
                }
                Err(error) => panic!("{effects}, {}: {error}", rung.name()),
            }
        }
    }
    assert!(nothing_stable < 100, "{nothing_stable}");
}
