//! Laws of interpolation, coverage and the viewport.

use crate::family;
use lightmeter_reference::interpolation::{
    Viewport, clip_volume, clip_volume_opengl, clipped_coverage, coverage, edge, flat, forward_differences, frag_depth,
    fragment, front_facing, line, perspective, perspective_line, scanline, triangle, viewport, viewport_opengl,
    weights,
};
use lightmeter_reference::{Vec2, Vector};
use lightmeter_scene::raster::Provoking;
use proptest::prelude::*;

family!("interpolation", 2048);

fn point() -> impl Strategy<Value = Vec2<f64>> {
    (0.0..256.0_f64, 0.0..256.0_f64).prop_map(|(x, y)| Vector([x, y]))
}

fn on_grid() -> impl Strategy<Value = Vec2<f64>> {
    (0..16_u32, 0..16_u32).prop_map(|(x, y)| Vector([f64::from(x) * 0.5, f64::from(y) * 0.5]))
}

fn three<S: Strategy + Clone>(each: S) -> impl Strategy<Value = [S::Value; 3]> {
    [each.clone(), each.clone(), each]
}

const WHOLE: Viewport<f64> =
    Viewport { origin: Vector([0.0, 0.0]), size: Vector([256.0, 256.0]), depth: Vector([0.0, 1.0]) };

proptest! {
    #[test]
    fn weights_sum_to_1_and_bring_the_point_back(v in three(point().boxed()), p in point()) {
        prop_assume!(edge(v[0], v[1], v[2]).abs() > 1.0);
        let lambda = weights(v, p);
        prop_assert!((lambda.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        for axis in 0..2 {
            prop_assert!((triangle(lambda, v.map(|v| v[axis])) - p[axis]).abs() < 1e-6);
        }
    }

    #[test]
    fn a_vertex_has_its_own_attribute(v in three(point().boxed()), a in three((-2.0..2.0_f64).boxed())) {
        prop_assume!(edge(v[0], v[1], v[2]).abs() > 1.0);
        for k in 0..3 {
            prop_assert!((triangle(weights(v, v[k]), a) - a[k]).abs() < 1e-9);
        }
    }

    #[test]
    fn the_scan_line_form_is_the_triangle_form(v in three(point().boxed()), a in three((-2.0..2.0_f64).boxed()), p in point()) {
        prop_assume!(edge(v[0], v[1], v[2]).abs() > 100.0);
        prop_assume!((v[0].y() - v[1].y()).abs() > 1.0 && (v[0].y() - v[2].y()).abs() > 1.0);
        let (by_line, by_weights) = (scanline(v, a, p), triangle(weights(v, p), a));
        prop_assert!(!by_line.is_finite() || (by_line - by_weights).abs() < 1e-6 * (1.0 + by_weights.abs()), "{} {}", by_line, by_weights);
    }

    #[test]
    fn equal_w_is_linear(lambda in three((0.01..1.0_f64).boxed()), a in three((-2.0..2.0_f64).boxed()), w in 0.1..10.0_f64, t in 0.0..=1.0_f64) {
        let sum: f64 = lambda.iter().sum();
        let lambda = lambda.map(|x| x / sum);
        prop_assert!((perspective(lambda, [w; 3], a) - triangle(lambda, a)).abs() < 1e-14);
        prop_assert!((perspective_line(t, [w; 2], [a[0], a[1]]) - line([1.0 - t, t], [a[0], a[1]])).abs() < 1e-14);
    }

    #[test]
    fn perspective_stays_between_the_attributes_and_ignores_the_scale_of_w(lambda in three((0.01..1.0_f64).boxed()), a in three((-2.0..2.0_f64).boxed()), w in three((0.1..10.0_f64).boxed()), s in 0.1..10.0_f64) {
        let value = perspective(lambda, w, a);
        let (low, high) = (a.iter().copied().fold(f64::INFINITY, f64::min), a.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        prop_assert!(value >= low - 1e-12 && value <= high + 1e-12);
        prop_assert!((perspective(lambda, w.map(|w| w * s), a) - value).abs() < 1e-12);
    }

    #[test]
    fn forward_differences_reach_the_end(a in -2.0..2.0_f64, b in -2.0..2.0_f64) {
        prop_assert!((forward_differences::<f64, 17>(a, b) - b).abs() < 1e-14);
    }

    #[test]
    fn a_point_of_a_split_quad_is_covered_once(a in on_grid(), b in on_grid(), c in on_grid(), p in on_grid()) {
        // A parallelogram a b c d is convex, whatever its three corners.
        let d = a + c - b;
        let whole = [a, b, c, d];
        let one_way = coverage([a, b, c], p) + coverage([a, c, d], p);
        let other_way = coverage([a, b, d], p) + coverage([b, c, d], p);
        prop_assert_eq!(one_way, other_way, "{:?}", whole);
        prop_assert!(one_way <= 1.0);
    }

    #[test]
    fn coverage_ignores_the_order_of_vertices(v in three(on_grid().boxed()), p in on_grid()) {
        let [a, b, c] = v;
        let orders = [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]];
        prop_assert!(orders.iter().all(|&order| coverage(order, p) == coverage(v, p)));
    }

    #[test]
    fn facing_turns_with_the_winding(v in three(point().boxed())) {
        prop_assume!(edge(v[0], v[1], v[2]) != 0.0);
        prop_assert_eq!(front_facing(v) + front_facing([v[0], v[2], v[1]]), 1.0);
    }

    #[test]
    fn the_clip_volumes_ends_are_the_viewports(x in -1.0..=1.0_f64, y in -1.0..=1.0_f64, z in 0.0..=1.0_f64, w in 0.1..10.0_f64) {
        let clip = Vector([x * w, y * w, z * w, w]);
        let window = viewport(clip, &WHOLE);
        prop_assert!((0.0..=256.0).contains(&window.x()) && (0.0..=256.0).contains(&window.y()) && (-1e-15..=1.0 + 1e-15).contains(&window.z()));
        // OpenGL: y turned, and depth from [-1, 1].
        let same = viewport_opengl(Vector([x * w, -y * w, (2.0 * z - 1.0) * w, w]), &WHOLE);
        prop_assert!(approx::abs_diff_eq!(window, same, epsilon = 1e-12));
    }

    #[test]
    fn the_volume_of_opengl_holds_that_of_webgpu(clip in [-2.0..2.0_f64, -2.0..2.0_f64, -2.0..2.0_f64, -1.0..2.0_f64]) {
        let clip = Vector(clip);
        prop_assert!(clip_volume_opengl(clip) >= clip_volume(clip));
        prop_assert!(clip.w() >= 0.0 || clip_volume_opengl(clip) == 0.0);
    }

    #[test]
    fn without_clipping_homogeneous_coverage_is_the_windows(v in three(point().boxed()), w in three((0.5..8.0_f64).boxed()), p in point()) {
        let clip: [_; 3] = std::array::from_fn(|k| {
            let (x, y) = (v[k].x() / 128.0 - 1.0, 1.0 - v[k].y() / 128.0);
            Vector([x * w[k], y * w[k], 0.5 * w[k], w[k]])
        });
        let near_edge = [(0, 1), (1, 2), (2, 0)].iter().any(|&(a, b)| edge(v[a], v[b], p).abs() < 1e-6);
        prop_assume!(!near_edge && edge(v[0], v[1], v[2]).abs() > 1e-3);
        prop_assert_eq!(clipped_coverage(clip, &WHOLE, p), coverage(v, p));
    }

    #[test]
    fn depth_and_attributes_are_what_their_formulas_say(v in three(point().boxed()), w in three((0.5..8.0_f64).boxed()), a in three((-2.0..2.0_f64).boxed()), p in point()) {
        prop_assume!(edge(v[0], v[1], v[2]).abs() > 100.0);
        let clip: [_; 3] = std::array::from_fn(|k| Vector([(v[k].x() / 128.0 - 1.0) * w[k], (1.0 - v[k].y() / 128.0) * w[k], 0.25 * w[k], w[k]]));
        let drawn = fragment(clip, a, &WHOLE, p);
        let lambda = weights(v, p);
        prop_assert!((drawn.linear - triangle(lambda, a)).abs() < 1e-6 * (1.0 + drawn.linear.abs()));
        prop_assert!((drawn.depth - 0.25).abs() < 1e-9);
        prop_assert!((drawn.inverse_w - triangle(lambda, w.map(f64::recip))).abs() < 1e-6 * (1.0 + drawn.inverse_w.abs()));
    }

    #[test]
    fn a_stored_depth_lies_in_0_to_1(depth in -10.0..10.0_f64) {
        prop_assert!((0.0..=1.0).contains(&frag_depth(depth)));
        prop_assert!(frag_depth(frag_depth(depth)) == frag_depth(depth));
    }
}

#[test]
fn the_provoking_vertex_is_an_end() {
    assert_eq!((flat([1, 2, 3], Provoking::First), flat([1, 2, 3], Provoking::Last)), (1, 3));
}
