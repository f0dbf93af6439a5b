//! Laws of lighting.

use crate::{family, wide};
use lightmeter_reference::lighting::{
    Falloff, Light, Material, Specular, SpecularGate, Vertex, ambient, ambient_constant, compute_light, diffuse_toward,
    diffuse_travel, directional, flat, gouraud, highlight, highlight_metal, highlight_plastic, incidence, nonlocal,
    phong, phong_interpolated, point, point_opengl, scalar_material, specular_blinn, specular_nonlocal, specular_phong,
    spot, sum, terms, two_lights, unit_light,
};
use lightmeter_reference::vector::{halfway, reflect};
use lightmeter_reference::{Real, Vec3, Vector};
use lightmeter_tests::direction;
use proptest::prelude::*;

family!("lighting", 2048);

const WHITE: Vec3<f64> = Vector([1.0; 3]);
const LIGHT: Light<f64> = Light { ambient: WHITE, diffuse: WHITE, specular: WHITE };

fn material(shininess: f64) -> Material<f64> {
    Material { ambient: Vector([0.1; 3]), diffuse: Vector([0.5; 3]), specular: Vector([0.4; 3]), shininess }
}

fn unit() -> impl Strategy<Value = Vec3<f64>> {
    direction().prop_map(|v| wide(v).normalize())
}

proptest! {
    #[test]
    fn incidence_is_a_cosine_and_0_from_behind(l in unit(), n in unit()) {
        let fi = incidence(l, n);
        prop_assert!((0.0..=1.0 + 1e-15).contains(&fi));
        prop_assert_eq!(fi == 0.0, l.dot(n) <= 0.0);
        prop_assert_eq!(diffuse_toward(WHITE, WHITE, l, n), diffuse_travel(WHITE, WHITE, -l, n));
        prop_assert!((incidence(l, n) - incidence(n, l)).abs() < 1e-15);
    }

    #[test]
    fn a_highlight_lies_in_0_to_1_and_sharpens(n in unit(), l in unit(), v in unit(), s in 1.0..128.0_f64, more in 0.0..128.0_f64) {
        for model in [Specular::Phong, Specular::Blinn] {
            let fs = highlight(model, n, l, v, s);
            prop_assert!((0.0..=1.0 + 1e-12).contains(&fs));
            prop_assert!(highlight(model, n, l, v, s + more) <= fs + 1e-12);
        }
    }

    #[test]
    fn light_and_eye_may_change_places(n in unit(), l in unit(), v in unit(), s in 1.0..64.0_f64) {
        for model in [Specular::Phong, Specular::Blinn] {
            prop_assert!((highlight(model, n, l, v, s) - highlight(model, n, v, l, s)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_mirror_direction_is_brightest(n in unit(), l in unit(), s in 1.0..64.0_f64) {
        prop_assume!(l.dot(n) > 0.01);
        let r = reflect(-l, n);
        prop_assert!((highlight(Specular::Phong, n, l, r, s) - 1.0).abs() < 1e-9);
        prop_assert!((highlight(Specular::Blinn, n, l, r, s) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_power_of_a_cosine_is_0_from_behind(c in -1.0..=0.0_f64, s in 0.1..100.0_f64, t in 0.01..1.0_f64) {
        prop_assert_eq!(c.lobe(s), 0.0);
        prop_assert_eq!(t.lobe(0.0), 1.0);
        prop_assert!((t.lobe(s) * t.lobe(s) - t.lobe(2.0 * s)).abs() < 1e-13);
    }

    #[test]
    fn light_adds_up(n in unit(), l in unit(), v in unit(), s in 1.0..64.0_f64, k in 0.0..4.0_f64) {
        let lit = |scale: f64| {
            let light = Light { ambient: WHITE.scale(scale), diffuse: WHITE.scale(scale), specular: WHITE.scale(scale) };
            terms((Specular::Phong, SpecularGate::Documents), &light, &material(s), [n, l, v], 1.0).sum()
        };
        prop_assert!(approx::abs_diff_eq!(lit(1.0).scale(k), lit(k), epsilon = 1e-13));
        prop_assert!(lit(1.0).0.iter().all(|c| (0.1 - 1e-15..=1.0 + 1e-12).contains(c)));
    }

    #[test]
    fn the_gate_darkens_only_what_faces_away(n in unit(), l in unit(), v in unit(), s in 1.0..64.0_f64) {
        let lit = |gate| terms((Specular::Phong, gate), &LIGHT, &material(s), [n, l, v], 1.0).sum();
        if l.dot(n) > 0.0 {
            prop_assert_eq!(lit(SpecularGate::OpenGl), lit(SpecularGate::Documents));
        } else {
            prop_assert_eq!(lit(SpecularGate::OpenGl), Vector([0.1; 3]));
        }
    }

    #[test]
    fn lengths_of_normal_and_light_do_not_count(p in unit(), n in unit(), d in unit(), a in 0.1..10.0_f64, b in 0.1..10.0_f64) {
        for model in [Specular::Phong, Specular::Blinn] {
            let dialect = (model, SpecularGate::Documents);
            let plain = directional(dialect, &LIGHT, &material(8.0), [p, n, d]);
            let scaled = directional(dialect, &LIGHT, &material(8.0), [p, n.scale(a), d.scale(b)]);
            prop_assert!(approx::abs_diff_eq!(plain, scaled, epsilon = 1e-12));
        }
        // A unit light is what it is taken for.
        let plain = directional((Specular::Phong, SpecularGate::Documents), &LIGHT, &material(8.0), [p, n, d]);
        prop_assert!(approx::abs_diff_eq!(plain, unit_light(&LIGHT, &material(8.0), [p, n, d]), epsilon = 1e-12));
    }

    #[test]
    fn far_away_a_local_viewer_is_a_nonlocal_one(n in unit(), d in unit()) {
        let far = Vector([0.0, 0.0, -1e12]);
        let local = unit_light(&LIGHT, &material(4.0), [far, n, d]);
        prop_assert!(approx::abs_diff_eq!(local, nonlocal(&LIGHT, &material(4.0), n, d), epsilon = 1e-9));
        let r = reflect(d, n);
        prop_assert_eq!(specular_nonlocal(WHITE, WHITE, r, 4.0), specular_phong(WHITE, WHITE, r, Vector([0.0, 0.0, 1.0]), 4.0));
    }

    #[test]
    fn a_point_light_without_falloff_is_a_directional_one(p in unit(), n in unit(), at in unit()) {
        let position = at.scale(5.0);
        let none = Falloff { kc: 1.0, kl: 0.0, kq: 0.0 };
        for model in [Specular::Phong, Specular::Blinn] {
            let dialect = (model, SpecularGate::Documents);
            let lit = point(dialect, &LIGHT, &material(8.0), [p, n, position], &none);
            let same = directional(dialect, &LIGHT, &material(8.0), [p, n, p - position]);
            prop_assert!(approx::abs_diff_eq!(lit, same, epsilon = 1e-12));
        }
        // The widest evenly lit cone that holds the surface changes nothing.
        let axis = p - position;
        let lit = spot(&LIGHT, &material(8.0), [p, n, position, axis], &none, [0.5, 0.0]);
        prop_assert!(approx::abs_diff_eq!(lit, point((Specular::Phong, SpecularGate::Documents), &LIGHT, &material(8.0), [p, n, position], &none), epsilon = 1e-12));
    }

    #[test]
    fn opengl_attenuates_the_ambient_term_too(p in unit(), n in unit(), at in unit(), kc in 1.0..4.0_f64) {
        let position = at.scale(5.0);
        let falloff = Falloff { kc, kl: 0.0, kq: 0.0 };
        let lit = point_opengl(&LIGHT, &material(8.0), [p, n, position], &falloff, 0.25);
        let full = point_opengl(&LIGHT, &material(8.0), [p, n, position], &Falloff { kc: 1.0, ..falloff }, 0.25);
        prop_assert!(approx::abs_diff_eq!(lit.xyz().scale(kc), full.xyz(), epsilon = 1e-12));
        prop_assert_eq!(lit.w(), 0.25);
    }

    #[test]
    fn a_scalar_material_is_a_grey_one(p in unit(), n in unit(), at in unit(), ka in 0.0..1.0_f64, kd in 0.0..1.0_f64, ks in 0.0..1.0_f64) {
        let (position, color) = (at.scale(5.0), Vector([0.3, 0.6, 0.9]));
        let by_scalars = scalar_material([WHITE, color], [ka, kd, ks, 8.0], [p, n, position]);
        let light = Light { ambient: WHITE, diffuse: color, specular: color };
        let grey = Material { ambient: Vector([ka; 3]), diffuse: Vector([kd; 3]), specular: Vector([ks; 3]), shininess: 8.0 };
        let none = Falloff { kc: 1.0, kl: 0.0, kq: 0.0 };
        prop_assert!(approx::abs_diff_eq!(by_scalars, point((Specular::Phong, SpecularGate::Documents), &light, &grey, [p, n, position], &none), epsilon = 1e-13));
    }

    #[test]
    fn two_lights_are_the_sum_of_each(p in unit(), n in unit(), d in unit(), at in unit()) {
        let position = at.scale(5.0);
        let [color, dark, half] = [1.0, 0.0, 0.5].map(|x| Vector([x; 4]));
        let lit = |colors| two_lights(dark, colors, [half, half], 8.0, [p, n, d, position]);
        prop_assert!(approx::abs_diff_eq!(lit([color, color]), lit([color, dark]) + lit([dark, color]), epsilon = 1e-13));
        let v = (-p).normalize();
        let [cd, cs] = compute_light(color, [half, half], 8.0, [n, d, v]);
        prop_assert!(approx::abs_diff_eq!(lit([color, dark]), cd + cs, epsilon = 1e-12));
        prop_assert!(approx::abs_diff_eq!(cs.xyz(), specular_blinn(WHITE, Vector([0.5; 3]), n, halfway(v, d), 8.0), epsilon = 1e-13));
    }

    #[test]
    fn terms_may_be_summed_in_any_order(a in unit(), b in unit(), c in unit()) {
        prop_assert!(approx::abs_diff_eq!(sum(a, b, [c, a], [b, c]), sum(b, a, [a, c], [c, b]), epsilon = 1e-14));
        prop_assert_eq!(ambient(a, b), ambient(b, a));
        prop_assert_eq!(ambient_constant(a, b), a + b);
        prop_assert_eq!(highlight_metal(a, WHITE, 0.5, 0.5), highlight_plastic(a, b, 0.5, 0.5));
    }

    #[test]
    fn shading_frequencies_agree_at_a_vertex(pa in unit(), na in unit(), pb in unit(), nb in unit(), at in unit()) {
        let position = at.scale(5.0);
        let (a, b, k) = (Vertex { p: pa, n: na }, Vertex { p: pb, n: nb }, [0.5, 0.5, 8.0]);
        for t in [0.0, 1.0] {
            let expected = gouraud(a, b, t, position, k);
            prop_assert!((phong(a, b, t, position, k) - expected).abs() < 1e-12);
            prop_assert!((phong_interpolated(a, b, t, position, k) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn a_flat_face_is_lit_by_its_own_normal(a in unit(), b in unit(), c in unit(), at in unit()) {
        prop_assume!((b - a).cross(c - a).length() > 1e-3);
        let (position, k) = (at.scale(5.0), [0.5, 0.5, 8.0]);
        let vertex = Vertex { p: a, n: (b - a).cross(c - a) };
        prop_assert!((flat([a, b, c], position, k) - gouraud(vertex, vertex, 0.0, position, k)).abs() < 1e-9);
    }
}
