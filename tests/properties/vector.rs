//! Laws of vectors and transforms.

use crate::{family, wide};
use glam::Mat4 as GlamMat4;
use lightmeter_reference::vector::{
    average_normal, dehomogenise, face_normal, halfway, halfway_unnormalised, light_direction, light_position,
    light_with_model, normal_inverse_transpose, normal_modelview, normalize, reflect, reflect_toward, toward,
};
use lightmeter_reference::{Mat4, Vec3, Vector};
use lightmeter_tests::direction;
use proptest::prelude::*;

family!("vector", 4096);

fn near(a: Vec3<f64>, b: Vec3<f64>, epsilon: f64) -> bool {
    approx::abs_diff_eq!(a, b, epsilon = epsilon)
}

fn rotation(axis: [f32; 3], angle: f32) -> GlamMat4 {
    GlamMat4::from_axis_angle(glam::Vec3::from_array(axis).normalize(), angle)
}

proptest! {
    #[test]
    fn reflection_keeps_length_and_is_its_own_inverse(i in direction(), n in direction()) {
        let (i, n) = (wide(i), wide(n).normalize());
        let r = reflect(i, n);
        prop_assert!((r.length() - i.length()).abs() < 1e-14);
        prop_assert!(near(reflect(r, n), i, 1e-14));
        prop_assert!((r.dot(n) + i.dot(n)).abs() < 1e-14);
        prop_assert!(near(r, reflect_toward(-i, n), 1e-15));
        prop_assert!(near(reflect(i, -n), r, 1e-15));
    }

    #[test]
    fn halfway_is_symmetric_and_lies_between(v in direction(), l in direction()) {
        let (v, l) = (wide(v).normalize(), wide(l).normalize());
        prop_assume!((v + l).length() > 1e-6);
        let h = halfway(v, l);
        prop_assert_eq!(h, halfway(l, v));
        prop_assert!((h.length() - 1.0).abs() < 1e-14);
        prop_assert!((h.dot(v) - h.dot(l)).abs() < 1e-9);
        prop_assert!(near(h.scale(halfway_unnormalised(v, l).length()), v + l, 1e-14));
    }

    #[test]
    fn normalize_forgets_length(v in direction(), length in 1e-6..1e6_f64) {
        let v = wide(v);
        prop_assert!(near(normalize(v.scale(length)), normalize(v), 1e-14));
        prop_assert!((normalize(v).length() - 1.0).abs() < 1e-14);
        prop_assert_eq!(normalize(Vector([0.0; 3])), Vector([0.0; 3]));
    }

    #[test]
    fn normals_agree_for_rigid_motion_and_part_for_other_scale(axis in direction(), angle in -3.0..3.0_f32, n in direction(), s in 1.5..4.0_f32) {
        let n = wide(n);
        let rigid = Mat4::<f64>::from(rotation(axis, angle)).upper3();
        prop_assert!(near(normal_modelview(&rigid, n).normalize(), normal_inverse_transpose(&rigid, n).normalize(), 1e-5));
        // Ruling 6: with a scale of one axis the modelview turns a slanted normal away.
        let squeezed = Mat4::<f64>::from(GlamMat4::from_scale(glam::Vec3::new(1.0, 1.0, s))).upper3();
        let slanted = Vector([0.6, 0.0, 0.8]);
        prop_assert!(!near(normal_modelview(&squeezed, slanted).normalize(), normal_inverse_transpose(&squeezed, slanted).normalize(), 0.05));
    }

    #[test]
    fn the_inverse_transpose_keeps_normals_at_right_angles(axis in direction(), angle in -3.0..3.0_f32, x in 0.3..3.0_f32, y in 0.3..3.0_f32, z in 0.3..3.0_f32, mirrored: bool, a in direction(), b in direction()) {
        let x = if mirrored { -x } else { x };
        let m = Mat4::<f64>::from(rotation(axis, angle) * GlamMat4::from_scale(glam::Vec3::new(x, y, z))).upper3();
        let (a, b) = (wide(a), wide(b));
        let n = normal_inverse_transpose(&m, a.cross(b));
        prop_assert!(n.dot(m.transform(a)).abs() < 1e-13 && n.dot(m.transform(b)).abs() < 1e-13);
    }

    #[test]
    fn a_translation_moves_positions_and_not_directions(d in direction(), t in direction()) {
        let m = Mat4::<f64>::from(GlamMat4::from_translation(glam::Vec3::from_array(t)));
        prop_assert_eq!(light_direction(&m, wide(d)), wide(d));
        prop_assert!(near(light_position(&m, wide(d).extend(1.0)), wide(d) + wide(t), 1e-15));
        prop_assert_eq!(light_position(&m, wide(d).extend(0.0)), wide(d));
        let identity = Mat4::<f64>::from(GlamMat4::IDENTITY);
        prop_assert_eq!(light_with_model(&identity, &m, wide(d)), light_with_model(&m, &identity, wide(d)));
    }

    #[test]
    fn dehomogenising_forgets_scale(d in direction(), s in 0.1..10.0_f64) {
        let p = wide(d).extend(1.0);
        prop_assert!(near(dehomogenise(p.scale(s)), wide(d), 1e-14));
    }

    #[test]
    fn toward_leads_to_the_light(light in direction(), p in direction()) {
        let (light, p) = (wide(light), wide(p));
        prop_assume!((light - p).length() > 1e-6);
        prop_assert!(near(p + toward(light, p).scale((light - p).length()), light, 1e-14));
    }

    #[test]
    fn face_normals_turn_with_the_winding(a in direction(), b in direction(), c in direction()) {
        let (a, b, c) = (wide(a), wide(b), wide(c));
        prop_assume!((b - a).cross(c - a).length() > 1e-6);
        let n = face_normal(a, b, c);
        prop_assert!(near(n, -face_normal(a, c, b), 1e-9));
        prop_assert!(near(average_normal([n, n, n]), n, 1e-14));
        prop_assert!(n.dot(b - a).abs() < 1e-9);
    }
}
