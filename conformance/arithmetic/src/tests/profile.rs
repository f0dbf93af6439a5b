//! Profiles: their published figures, and how they come into force.

use crate::profile::{Excess, GrowingUlp, OPENGL, PROFILES, Profile, VULKAN, WGSL};
use crate::{Accept, RandomLegal};
use lightmeter_reference::Real;

#[test]
fn the_figures_are_the_published_ones() {
    for profile in [&WGSL, &VULKAN] {
        let three = GrowingUlp { base: 3.0, slope: 2.0 };
        assert_eq!(
            (profile.relative, profile.divide_ulp, profile.inverse_sqrt_ulp),
            (0.0, 2.5, 2.0),
            "{}",
            profile.name
        );
        assert_eq!((profile.exp_ulp, profile.exp2_ulp), (three, three), "{}", profile.name);
        assert_eq!((profile.log2_absolute, profile.log2_ulp), (2.0_f64.powi(-21), 3.0), "{}", profile.name);
        assert_eq!(
            (profile.exp_excess, profile.exp2_excess, profile.subpixel_bits),
            (None, None, 4),
            "{}",
            profile.name
        );
    }
    // One part in 10⁵ of a number just below a power of two, where 2²⁴ ULP are the number itself.
    let ulps = [OPENGL.divide_ulp, OPENGL.inverse_sqrt_ulp, OPENGL.exp_ulp.base, OPENGL.exp2_ulp.base, OPENGL.log2_ulp];
    for ulps in ulps {
        assert!((ulps / 2.0_f64.powi(24) - 1e-5).abs() < 1e-18, "{ulps}");
    }
    assert_eq!(
        (OPENGL.relative, OPENGL.log2_absolute, OPENGL.exp_ulp.slope, OPENGL.exp2_ulp.slope),
        (1e-5, 1e-5, 2.0, 2.0)
    );
}

#[test]
fn each_profile_names_its_own_source() {
    for (profile, source) in PROFILES.into_iter().zip(["WGSL", "Vulkan", "OpenGL"]) {
        assert!(profile.source.starts_with(source), "{}: {}", profile.name, profile.source);
    }
}

#[test]
fn profiles_are_found_by_name() {
    for (profile, name) in PROFILES.into_iter().zip(["wgsl", "vulkan", "opengl"]) {
        assert_eq!(profile.name, name);
        assert_eq!((Profile::by_name(name), Profile::named(name)), (Some(profile), Ok(profile)));
    }
    assert_eq!(Profile::by_name("WGSL"), None);
    let message = Profile::named("metal").expect_err("there is no such profile");
    assert_eq!(message, "no profile `metal`; expected one of wgsl, vulkan, opengl");
}

/// The width of 1/3, which tells the profile in force.
fn width_of_a_third() -> f64 {
    (exactly(1.0) / exactly(3.0)).width()
}

/// The width of a sum that rounds.
fn width_of_a_sum() -> f64 {
    (exactly(1.0) + exactly(2.0_f64.powi(-30))).width()
}

#[test]
fn a_scope_within_a_scope_ends_with_it() {
    let widths = || (width_of_a_third(), width_of_a_sum());
    let (wgsl, opengl) = (WGSL.scope(widths), OPENGL.scope(widths));
    assert!(opengl.0 > 10.0 * wgsl.0 && opengl.1 > 10.0 * wgsl.1);
    let (before, inner, same, after) = WGSL.scope(|| {
        let before = widths();
        let (inner, same) = OPENGL.scope(|| (widths(), OPENGL.scope(widths)));
        (before, inner, same, widths())
    });
    assert_eq!((before, inner, same, after), (wgsl, opengl, opengl, wgsl));
    // Back through two, the outer of which has the same figures as the one before.
    let deep = VULKAN.scope(|| {
        let inner = WGSL.scope(|| OPENGL.scope(|| VULKAN.scope(widths)));
        (inner, widths())
    });
    assert_eq!(deep, (wgsl, wgsl));
    let nested = OPENGL.scope(|| (WGSL.scope(|| VULKAN.scope(widths)), widths()));
    assert_eq!(nested, (wgsl, opengl));
}

#[test]
fn a_panic_ends_a_scope_too() {
    let outcome = std::panic::catch_unwind(|| WGSL.scope(|| OPENGL.scope(|| panic!("on the way"))));
    assert!(outcome.is_err());
    let outside = std::panic::catch_unwind(width_of_a_sum);
    assert!(outside.is_err(), "a profile is in force outside of every scope: {outside:?}");
    assert!(WGSL.scope(width_of_a_sum) < 1e-6);
}

/// A figure's name, a profile that differs from WGSL in it, and the width of an operation that it concerns.
type Variant = (&'static str, Profile, fn() -> f64);

fn exactly(x: f64) -> Accept {
    Accept::exactly(x)
}

fn variants() -> [Variant; 13] {
    let grown = |base: f64, slope: f64| GrowingUlp { base, slope };
    let excess = Some(Excess { from: 1.0, to: 2.0, factor: 9.0 });
    let exp = || exactly(1.5).exp().width();
    let exp2 = || exactly(1.5).exp2().width();
    let product = || Accept::product([1.1_f32, 1.3].map(<Accept as Real>::input)).width();
    [
        ("relative", Profile { relative: 1e-4, ..WGSL }, width_of_a_sum),
        ("relative of a product", Profile { relative: 1e-4, ..WGSL }, product),
        ("divide_ulp", Profile { divide_ulp: 40.0, ..WGSL }, width_of_a_third),
        ("inverse_sqrt_ulp", Profile { inverse_sqrt_ulp: 40.0, ..WGSL }, || exactly(3.0).inverse_sqrt().width()),
        ("exp_ulp.base", Profile { exp_ulp: grown(40.0, 2.0), ..WGSL }, exp),
        ("exp_ulp.slope", Profile { exp_ulp: grown(3.0, 40.0), ..WGSL }, exp),
        ("exp2_ulp.base", Profile { exp2_ulp: grown(40.0, 2.0), ..WGSL }, exp2),
        ("exp2_ulp.slope", Profile { exp2_ulp: grown(3.0, 40.0), ..WGSL }, exp2),
        ("log2_absolute", Profile { log2_absolute: 1e-4, ..WGSL }, || exactly(1.5).log2().width()),
        ("log2_absolute of ln(1 + x)", Profile { log2_absolute: 1e-4, ..WGSL }, || exactly(0.5).ln_1p().width()),
        ("log2_ulp", Profile { log2_ulp: 40.0, ..WGSL }, || exactly(5.0).log2().width()),
        ("exp_excess", Profile { exp_excess: excess, ..WGSL }, exp),
        ("exp2_excess", Profile { exp2_excess: excess, ..WGSL }, exp2),
    ]
}

#[test]
fn each_figure_reaches_its_operation() {
    for (name, profile, width) in variants() {
        let wgsl = WGSL.scope(width);
        // The figures of the last scope stay where they are, so that a difference in any of them must be noticed.
        let (own, within) = (profile.scope(width), WGSL.scope(|| (profile.scope(width), width())));
        assert!(own > 2.0 * wgsl, "{name}: {own} against {wgsl}");
        assert_eq!(within, (own, wgsl), "{name} within another scope");
    }
}

#[test]
#[should_panic(expected = "outside of `Profile::scope`")]
fn a_sum_needs_a_profile() {
    width_of_a_sum();
}

#[test]
#[should_panic(expected = "outside of `Profile::scope`")]
fn a_chain_needs_a_profile() {
    let _ = <Accept as Real>::sum([1.0, 2.0, 3.0].map(Accept::exactly));
}

#[test]
#[should_panic(expected = "outside of `Profile::scope`")]
fn a_product_needs_a_profile() {
    let _ = <Accept as Real>::product([1.1, 1.3].map(Real::input));
}

#[test]
#[should_panic(expected = "outside of `Profile::scope`")]
fn a_quotient_needs_a_profile() {
    width_of_a_third();
}

#[test]
#[should_panic(expected = "outside of `Profile::scope`")]
fn a_drawn_function_needs_a_profile() {
    let _ = RandomLegal::of(2.0).exp();
}
