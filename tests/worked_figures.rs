//! The figures that the documents work out, each by name. 000, 002, 003 and 004 are the documents' numbers.

use approx::assert_abs_diff_eq;
use glam::Vec3 as GlamVec3;
use glam::camera::rh::proj::directx::perspective;
use glam::camera::rh::view::look_at_mat4;
use lightmeter_reference::attenuation::{constant, linear, square};
use lightmeter_reference::blend::{Operands, Saturate, blend};
use lightmeter_reference::lighting::{Vertex, ambient, gouraud, phong, scalar_material, two_lights};
use lightmeter_reference::vector::normalize;
use lightmeter_reference::{Mat4, Rgba, Vec3, Vector, color};
use lightmeter_scene::blend::{Equation, Factor, State};

const ALPHA: State = State { equation: Equation::Add, src: Factor::SrcAlpha, dst: Factor::OneMinusSrcAlpha };

fn over(src: [f64; 4], dst: [f64; 4]) -> Rgba<f64> {
    let of = Operands { src: Vector(src), dst: Vector(dst), constant: Vector([0.0; 4]) };
    blend(ALPHA, &of, Saturate::SourceAndDestination)
}

#[test]
fn document_000_blends_blue_over_red() {
    assert_abs_diff_eq!(
        over([0.0, 0.0, 1.0, 0.6], [1.0, 0.0, 0.0, 1.0]),
        Vector([0.4, 0.0, 0.6, 0.76]),
        epsilon = 1e-15
    );
}

#[test]
fn document_002_blends_half_red_over_blue() {
    assert_eq!(over([1.0, 0.0, 0.0, 0.5], [0.0, 0.0, 1.0, 1.0]).xyz(), Vector([0.5, 0.0, 0.5]));
}

#[test]
fn document_000_lights_a_blue_material() {
    let blue = Vector([0.0, 0.0, 1.0]);
    assert_eq!(ambient(Vector([1.0, 1.0, 1.0]), blue), blue);
    assert_eq!(ambient(Vector([1.0, 0.0, 0.0]), blue), Vector([0.0, 0.0, 0.0]));
}

/// 003's camera: eye (4, 3, −3), looking at the origin, y up.
fn view() -> Mat4<f64> {
    look_at_mat4(GlamVec3::new(4.0, 3.0, -3.0), GlamVec3::ZERO, GlamVec3::Y).into()
}

#[test]
fn document_003_sees_the_origin_down_the_axis() {
    let origin = view().transform(Vector([0.0, 0.0, 0.0, 1.0])).xyz();
    assert_abs_diff_eq!(origin, Vector([0.0, 0.0, -34.0_f64.sqrt()]), epsilon = 1e-5);
    // 45° vertical field of view: a point as far up as half the distance times tan 22.5° reaches the upper edge.
    let projection: Mat4<f64> = perspective(45.0_f32.to_radians(), 1.0, 0.1, 100.0).into();
    let edge = projection.transform(Vector([0.0, 10.0 * (22.5_f64.to_radians()).tan(), -10.0, 1.0]));
    assert_abs_diff_eq!(edge.y() / edge.w(), 1.0, epsilon = 1e-6);
    let near = projection.transform(Vector([0.0, 0.0, -0.1, 1.0]));
    let far = projection.transform(Vector([0.0, 0.0, -100.0, 1.0]));
    assert_abs_diff_eq!(Vector([near.z() / near.w(), far.z() / far.w()]), Vector([0.0, 1.0]), epsilon = 1e-5);
}

/// The top of a unit cube under 003's camera: position and normal in eye space.
fn top() -> Vertex<f64> {
    let view = view();
    Vertex {
        p: view.transform(Vector([0.0, 1.0, 0.0, 1.0])).xyz(),
        n: view.transform(Vector([0.0, 1.0, 0.0, 0.0])).xyz(),
    }
}

#[test]
fn document_003_phong_program() {
    // ka 0.10, kd 0.55, ks 0.70, n 32, light (0.75, …) at (0, 3, −3) in eye space untransformed, ambient (0.1, …).
    let (grey, dim, light) = (Vector([0.75; 3]), Vector([0.1; 3]), Vector([0.0, 3.0, -3.0]));
    let Vertex { p, n } = top();
    let lit = scalar_material([dim, grey], [0.10, 0.55, 0.70, 32.0], [p, n, light]);
    // By hand, from 003's own lines.
    let (n, l, v) = (n.normalize(), (light - p).normalize(), (-p).normalize());
    let r = l.scale(-1.0) + n.scale(2.0 * n.dot(l));
    let by_hand = 0.10 * 0.1 + 0.55 * 0.75 * n.dot(l).max(0.0) + 0.70 * 0.75 * r.dot(v).max(0.0).powi(32);
    assert_abs_diff_eq!(lit, Vector([by_hand, by_hand, by_hand, 1.0]), epsilon = 1e-14);
    assert!(by_hand > 0.3, "the light stands above the surface: {by_hand}");
}

#[test]
fn document_003_gouraud_program() {
    // ka 0, kd 0.70, ks 0.35, n 32, light (0.75, …) at (100, 100, 100), no ambient light.
    let (grey, dark, light) = (Vector([0.75; 3]), Vector([0.0; 3]), Vector([100.0, 100.0, 100.0]));
    let Vertex { p, n } = top();
    let lit = scalar_material([dark, grey], [0.0, 0.70, 0.35, 32.0], [p, n, light]);
    let (n, l, v) = (n.normalize(), (light - p).normalize(), (-p).normalize());
    let r = l.scale(-1.0) + n.scale(2.0 * n.dot(l));
    let by_hand = 0.70 * 0.75 * n.dot(l).max(0.0) + 0.35 * 0.75 * r.dot(v).max(0.0).powi(32);
    assert_abs_diff_eq!(lit, Vector([by_hand, by_hand, by_hand, 1.0]), epsilon = 1e-14);
}

#[test]
fn document_004_two_lights() {
    let l0 = normalize(Vector([0.5, 0.0, 0.0]));
    assert_eq!(l0, Vector([1.0, 0.0, 0.0]));
    let ambient = Vector([0.2, 0.2, 0.2, 1.0]);
    let colors = [Vector([1.0, 0.5, 0.0, 1.0]), Vector([0.0, 0.5, 1.0, 1.0])];
    let material = [Vector([0.5, 0.5, 0.5, 1.0]), Vector([1.0, 1.0, 1.0, 1.0])];
    let lit = |n: Vec3<f64>, p: Vec3<f64>| {
        two_lights(ambient, colors, material, 100.0, [p, n, Vector([0.5, 0.0, 0.0]), Vector([0.0, -0.5, 0.0])])
    };
    // A surface that faces light 0 and has light 1 edge on: 0.2 + 0.5·(1, 0.5, 0), no highlight worth the name.
    let side = lit(Vector([1.0, 0.0, 0.0]), Vector([0.0, 0.0, -1.0]));
    assert_abs_diff_eq!(side.xyz(), Vector([0.7, 0.45, 0.2]), epsilon = 1e-12);
    // Alpha is summed: 1 + 1 + 0, above 1 (ruling 14).
    assert_abs_diff_eq!(side.w(), 2.0, epsilon = 1e-12);
    // A surface that faces light 1 from above it: light 0 edge on, n·l1 = 0.5/|(0, −0.5, 1)|.
    let below = lit(Vector([0.0, -1.0, 0.0]), Vector([0.0, 0.0, -1.0]));
    let cosine = 0.5 / 1.25_f64.sqrt();
    assert_abs_diff_eq!(below.xyz(), Vector([0.2, 0.2 + 0.25 * cosine, 0.2 + 0.5 * cosine]), epsilon = 1e-12);
}

#[test]
fn document_004_gouraud_misses_the_highlight_that_phong_shows() {
    // I1 = 0 since n·v < 0 at one vertex, I2 = 0 since n·l < 0 at the other; the mirror direction lies between.
    let a = Vertex { p: Vector([-1.0, 0.0, -5.0]), n: Vector([-1.0, 0.0, 0.0]) };
    let b = Vertex { p: Vector([1.0, 0.0, -5.0]), n: Vector([1.0, 0.0, 0.001]) };
    let light = Vector([0.0, 0.0, 0.0]);
    let material = [0.0, 1.0, 100.0];
    assert!(gouraud(a, b, 0.5, light, material) < 1e-6);
    assert!(phong(a, b, 0.5, light, material) > 0.99);
}

#[test]
fn document_004_falloffs() {
    assert_eq!((constant(4.0_f64), linear(4.0_f64), square(4.0_f64)), (1.0, 0.25, 0.0625));
}

#[test]
fn document_004_colour_cube() {
    let [red, green, blue] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector);
    let [yellow, cyan, magenta, white] =
        [[1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]].map(Vector);
    assert_eq!(color::sum(red, green), yellow);
    assert_eq!(color::sum(green, blue), cyan);
    assert_eq!(color::sum(blue, red), magenta);
    assert_eq!(color::sum(yellow, blue), white);
}
