//! Texts in every rung's arithmetic: that they are valid, and what they compute.

use super::dialect::Prelude;
use super::lower::{Asked, NOTHING_CHEAP, NOTHING_STABLE, lower};
use super::probe::probe_with;
use super::writer::READS_BITS;
use super::*;
use crate::adapters;
use crate::compose::tests::sets;
use crate::compose::{Composer, Recipe, ShaderForm};
use crate::shaders::{Shaders, validate_lowered};
use crate::{Kernel, RepeatPipeline};
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
                    Err(reason) if reason == NOTHING_CHEAP && rung == Rung::Cheap => {}
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
    let opaque = "bitcast<f32>(bitcast<u32>(x) ^ u32(rung_zero))";
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
#[ignore = "long: ./x campaign long"]
fn shaders_of_scenes_are_valid_at_every_rung() {
    let composer = Composer::new(&built_in()).unwrap_or_else(|error| panic!("{error}"));
    let sets = sets();
    let sample = sets.iter().step_by(sets.len() / 300).map(|&effects| (effects, ShaderForm::Composed));
    let mut nothing_stable = 0;
    for (effects, shader) in sample.chain([(Effects::NONE, ShaderForm::Full)]) {
        let composition = composer.compose(effects, Recipe::of(shader), 0).unwrap_or_else(|error| panic!("{error}"));
        for rung in Rung::ALL {
            match composer.lower(&composition, rung) {
                Ok(_) => {}
                Err(GpuError::Unavailable { reason, .. }) if reason == NOTHING_STABLE && rung == Rung::Stable => {
                    nothing_stable += 1;
                }
                Err(GpuError::Unavailable { reason, .. }) if reason == NOTHING_CHEAP && rung == Rung::Cheap => {}
                Err(error) => panic!("{effects}, {}: {error}", rung.name()),
            }
        }
    }
    assert!(nothing_stable < 100, "{nothing_stable}");
}

/// What a function gives for rows of inputs, as sums of its words.
fn values(gpu: &Gpu, file: &str, function: &str, rung: Rung, rows: &[f32]) -> Vec<f64> {
    let shaders = built_in();
    let failed = |error: GpuError| panic!("{function}, {}: {error}", rung.name());
    let kernel = Kernel::new(&shaders, file, function).unwrap_or_else(failed);
    let pipeline = RepeatPipeline::new(gpu, &shaders, &kernel, rung, rows)
        .unwrap_or_else(|error| panic!("{function}, {}: {error}", rung.name()))
        .unwrap_or_else(|reason| panic!("{function}, {}: {reason}", rung.name()));
    let words = pipeline.outputs(gpu, rows).unwrap_or_else(|error| panic!("{function}, {}: {error}", rung.name()));
    let value = |parts: &[u32]| parts.iter().rev().map(|&part| f64::from(f32::from_bits(part))).sum();
    words.chunks_exact(rung.parts()).map(value).collect()
}

#[test]
fn functions_have_the_values_of_f64_to_the_digits_of_the_rung() {
    let bases = [0.001_f32, 0.3, 0.5, 0.9, 0.99, 0.999_999, 1.0, 1.3, 7.5, 1000.0];
    let exponents = [0.5_f32, 1.0, 3.7, 12.0];
    let pairs: Vec<[f32; 2]> = bases.iter().flat_map(|&x| exponents.map(|y| [x, y])).collect();
    let given: Vec<f32> = pairs.iter().flatten().copied().collect();
    let vectors: Vec<f32> = (0..60_u8).map(|k| (f32::from(k) * 1.37 + 0.3).sin() * 40.0).collect();
    let unit = |v: &[f32]| {
        let v: Vec<f64> = v.iter().copied().map(f64::from).collect();
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.into_iter().map(move |x| x / length).collect::<Vec<f64>>()
    };
    let wide = |[x, y]: [f32; 2]| [f64::from(x), f64::from(y)];
    let rows: [(&str, &str, &[f32], Vec<f64>); 4] = [
        ("vector.wgsl", "vector_lobe", &given, pairs.iter().map(|&p| wide(p)).map(|[x, y]| x.powf(y)).collect()),
        (
            "fog.wgsl",
            "fog_opacity_expm1",
            &given,
            pairs.iter().map(|&p| wide(p)).map(|[x, y]| -(-x * y).exp_m1()).collect(),
        ),
        ("fog.wgsl", "fog_exp_factor", &given, pairs.iter().map(|&p| wide(p)).map(|[x, y]| (-x * y).exp()).collect()),
        ("vector.wgsl", "vector_normalize", &vectors, vectors.chunks_exact(3).flat_map(unit).collect()),
    ];
    for adapter in adapters() {
        let gpu = adapter.open().unwrap_or_else(|error| panic!("{error}"));
        for (rung, share) in [(Rung::DoubleFloat, 2.0_f64.powi(-40)), (Rung::F64, 1e-13)] {
            if rung.unavailable(&gpu).unwrap_or_else(|error| panic!("{error}")).is_some() {
                continue;
            }
            for (file, function, given, expected) in &rows {
                let found = values(&gpu, file, function, rung, given);
                assert_eq!(found.len(), expected.len());
                for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
                    // Below 2^-100 the low part has fewer digits, and below 2^-126 there is nothing.
                    let off = (found - expected).abs();
                    let is_near = off <= share * expected.abs() + 2.0_f64.powi(-126);
                    assert!(is_near, "{}, {function} {place}: {found:e}, {expected:e}, {}", adapter.name, rung.name());
                }
            }
        }
    }
}

#[test]
fn what_is_lowered_to_f32_is_what_it_was() {
    let rows: Vec<f32> = (0..24 * 16_u16).map(|k| (f32::from(k) * 0.37).sin() * 3.0).collect();
    let shaders = built_in();
    let kernel = Kernel::new(&shaders, "lighting.wgsl", "lighting_blinn").unwrap_or_else(|error| panic!("{error}"));
    let source = shaders.source("lighting.wgsl");
    let lowered = lower(&source, Rung::F32, &shaders.stable_forms(), Asked::Function("lighting_blinn"));
    let lowered = lowered.unwrap_or_else(|reason| panic!("{reason}")).source;
    let plain = kernel.repeat(&shaders, Rung::F32).unwrap_or_else(|error| panic!("{error}"));
    let plain = plain.unwrap_or_else(|reason| panic!("{reason}"));
    let written = plain.replace(&source, &lowered);
    assert_ne!(plain, written);
    for adapter in adapters() {
        let gpu = adapter.open().unwrap_or_else(|error| panic!("{error}"));
        let outputs = |source: &str| {
            let pipeline = RepeatPipeline::of(&gpu, &kernel, source.into(), &rows, kernel.outputs);
            let pipeline =
                pipeline.unwrap_or_else(|error| panic!("{error}")).unwrap_or_else(|reason| panic!("{reason}"));
            pipeline.outputs(&gpu, &rows).unwrap_or_else(|error| panic!("{error}"))
        };
        assert_eq!(outputs(&plain), outputs(&written), "{}", adapter.name);
    }
}
