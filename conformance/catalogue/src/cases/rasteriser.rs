//! The values that a rasteriser may give.
//!
//! No specification bounds interpolation in ULP. The bounds here follow from two things that it may do:
//!
//! * *Snapping.* Positions are moved to a grid of 2⁻ᵇ pixel, b the device's subpixel bits, each by less than δ = 2⁻ᵇ in x
//!   and in y (the rounding is left open), besides the rounding of the viewport's transformation. A point p of the moved
//!   triangle with weights λ′ is the point p − Σλ′ᵢdᵢ of the given one, and the λ′ of a covered point lie in [0, 1]: it is
//!   at most δ away in x and in y. So the value is one that the exact attribute takes in the square p ± δ. An attribute,
//!   linear or perspective-correct, is a quotient of functions linear in x and y, which takes its extremes over a square
//!   at its corners.
//! * *The plane equation in binary32*, with its origin at the target's corner: evaluated in acceptance intervals, whose
//!   distance from the exact value is added.
//!
//! Coverage follows from signs of linear functions: it is decided where those agree at the corners of the square, and may go
//! either way elsewhere.

use lightmeter_arithmetic::{Accept, F32};
use lightmeter_reference::interpolation::{self, Viewport};
use lightmeter_reference::{Real, Vec2, Vec4, Vector};
use lightmeter_scene::raster::{Raster, TARGET_SIZE};

/// The whole target, depth from 0 to 1.
pub(super) fn target<R: Real>() -> Viewport<R> {
    let size = R::literal(f64::from(TARGET_SIZE));
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    Viewport { origin: Vector([zero, zero]), size: Vector([size, size]), depth: Vector([zero, one]) }
}

/// The interval of each output of a raster case.
pub(super) fn interval(kind: Raster, inputs: &[f32], subpixel_bits: u32, out: &mut [Accept]) {
    let snap = f64::from(2.0_f32).powi(-i32::try_from(subpixel_bits).unwrap_or(0));
    match kind {
        Raster::TriangleAttributes => {
            let [perspective, linear, ..] =
                SnappedTriangle::new(inputs, snap).map_or([Accept::ANY; 4], |drawn| drawn.fragment());
            out.copy_from_slice(&[perspective, linear]);
        }
        Raster::TrianglePosition => {
            let [_, _, depth, inverse_w] =
                SnappedTriangle::new(inputs, snap).map_or([Accept::ANY; 4], |drawn| drawn.fragment());
            let [x, y] = pixel(inputs).0.map(|x| Accept::from_bounds(x, x));
            out.copy_from_slice(&[x, y, depth, inverse_w]);
        }
        Raster::LineAttributes => line(inputs, snap, out),
        Raster::Quad => out[0] = quad(inputs, snap),
        Raster::Facing => out[0] = facing(inputs, snap),
        Raster::Culled { back, front_is_ccw } => {
            let front = facing(inputs, snap);
            out[0] = if back == front_is_ccw { front } else { Accept::exactly(1.0) - front };
        }
        Raster::Clipped => out[0] = clipped(inputs, snap),
        Raster::OwnDepth => out[0] = interpolation::frag_depth(Accept::input(inputs[0])),
        Raster::Flat { .. } | Raster::SameDepth(_) => {
            unreachable!("a flat attribute and a depth met again have no tolerance: the interval is the formula's own")
        }
    }
}

const UNDECIDED: (f64, f64) = (0.0, 1.0);

fn wide(inputs: &[f32]) -> Vec<f64> {
    inputs.iter().map(|&x| f64::from(x)).collect()
}

/// The pixel's centre.
fn pixel(inputs: &[f32]) -> Vec2<f64> {
    let [.., x, y] = inputs else { unreachable!("a raster row ends with its pixel") };
    Vector([f64::from(*x) + 0.5, f64::from(*y) + 0.5])
}

/// p and the corners of the square p ± (dx, dy).
fn square(p: Vec2<f64>, [dx, dy]: [f64; 2]) -> [Vec2<f64>; 5] {
    [(0.0, 0.0), (-dx, -dy), (dx, -dy), (-dx, dy), (dx, dy)].map(|(x, y)| p + Vector([x, y]))
}

/// The vertices, in clip coordinates, and how far their window positions may be off.
fn vertices<const N: usize>(inputs: &[f32], snap: f64) -> ([Vec4<f64>; N], [f64; 2]) {
    let row = wide(inputs);
    let clip: [Vec4<f64>; N] = std::array::from_fn(|k| Vector(std::array::from_fn(|c| row[4 * k + c])));
    let mut off = [snap; 2];
    for vertex in clip {
        let exact = interpolation::viewport(vertex, &target());
        let legal = interpolation::viewport(Vector(vertex.0.map(|x| Accept::<F32>::from_bounds(x, x))), &target());
        for (axis, off) in off.iter_mut().enumerate() {
            let rounding = (legal[axis].high() - exact[axis]).max(exact[axis] - legal[axis].low());
            *off = off.max(snap + rounding);
        }
    }
    (clip, off)
}

/// A drawn triangle.
struct SnappedTriangle {
    clip: [Vec4<f64>; 3],
    attr: [f64; 3],
    p: Vec2<f64>,
    off: [f64; 2],
}

impl SnappedTriangle {
    /// `None` where snapping may leave the triangle without area: it is undecided as a whole.
    fn new(inputs: &[f32], snap: f64) -> Option<Self> {
        let (clip, off) = vertices(inputs, snap);
        let attr = std::array::from_fn(|k| f64::from(inputs[12 + k]));
        let drawn = Self { clip, attr, p: pixel(inputs), off };
        (drawn.area().abs() > drawn.area_slack()).then_some(drawn)
    }

    fn window(&self) -> [Vec2<f64>; 3] {
        self.clip.map(|vertex| {
            let window = interpolation::viewport(vertex, &target());
            Vector([window.x(), window.y()])
        })
    }

    /// Twice the signed area.
    fn area(&self) -> f64 {
        let [a, b, c] = self.window();
        interpolation::edge(a, b, c)
    }

    /// How much moving each vertex by `off` may change twice the area: |Δx|·2dy + |Δy|·2dx + 2·2dx·2dy on two edges.
    fn area_slack(&self) -> f64 {
        let [a, b, c] = self.window();
        let [dx, dy] = self.off.map(|off| 2.0 * off);
        let edge = |u: Vec2<f64>, v: Vec2<f64>| (v.x() - u.x()).abs() * dy + (v.y() - u.y()).abs() * dx + dx * dy;
        edge(a, b) + edge(a, c)
    }

    /// Perspective-correct attribute, linear attribute, depth and 1/w.
    fn fragment(&self) -> [Accept; 4] {
        let values = |p| {
            let fragment = interpolation::fragment(self.clip, self.attr, &target(), p);
            [fragment.perspective, fragment.linear, fragment.depth, fragment.inverse_w]
        };
        let (exact, around) = (values(self.p), square(self.p, self.off).map(values));
        let rounded = self.in_binary32();
        std::array::from_fn(|k| {
            let low = around.iter().map(|values| values[k]).fold(f64::INFINITY, f64::min);
            let high = around.iter().map(|values| values[k]).fold(f64::NEG_INFINITY, f64::max);
            let rounded: Accept = rounded[k];
            if rounded.is_any() || around.iter().any(|values| values[k].is_nan()) {
                return Accept::ANY;
            }
            Accept::from_bounds(low - (exact[k] - rounded.low()).max(0.0), high + (rounded.high() - exact[k]).max(0.0))
        })
    }

    /// The same by plane equations in binary32.
    fn in_binary32(&self) -> [Accept; 4] {
        let number = |x: f64| Accept::from_bounds(x, x);
        let attr = self.attr.map(number);
        let inverse_w = self.clip.map(|v| Accept::literal(1.0) / number(v.w()));
        let depth = self.clip.map(|v| number(v.z()) / number(v.w()));
        let over_w = std::array::from_fn(|k| attr[k] * inverse_w[k]);
        let [attr, inverse_w, depth, over_w] = [attr, inverse_w, depth, over_w].map(|at| self.plane(at));
        [over_w / inverse_w, attr, depth, inverse_w]
    }

    /// c + gx·x + gy·y with c = q0 − gx·x0 − gy·y0 and the gradient g from the vertices.
    fn plane(&self, q: [Accept; 3]) -> Accept {
        let [v0, v1, v2] = self.window().map(|v| v.0.map(|x| Accept::from_bounds(x, x)));
        let [px, py] = self.p.0.map(Accept::exactly);
        let (x1, y1, x2, y2) = (v1[0] - v0[0], v1[1] - v0[1], v2[0] - v0[0], v2[1] - v0[1]);
        let (q1, q2) = (q[1] - q[0], q[2] - q[0]);
        let area = x1 * y2 - x2 * y1;
        let gx = (q1 * y2 - q2 * y1) / area;
        let gy = (q2 * x1 - q1 * x2) / area;
        let c = Accept::sum([q[0], -(gx * v0[0]), -(gy * v0[1])]);
        Accept::sum([c, gx * px, gy * py])
    }
}

/// A line's rasterisation is left open: the pixel's centre may lie half a pixel off it, besides the snapping.
fn line(inputs: &[f32], snap: f64, out: &mut [Accept]) {
    let (clip, off) = vertices::<2>(inputs, snap);
    let attr = [inputs[8], inputs[9]].map(f64::from);
    let p = pixel(inputs);
    let around = square(p, off.map(|off| off + 0.5)).map(|p| interpolation::fragment_of_line(clip, attr, &target(), p));
    let number = |x: f64| Accept::from_bounds(x, x);
    let exact = interpolation::fragment_of_line(clip, attr, &target(), p);
    let to: Viewport<Accept> = target();
    let rounded = interpolation::fragment_of_line(
        clip.map(|v| Vector(v.0.map(number))),
        attr.map(number),
        &to,
        Vector(p.0.map(number)),
    );
    for (k, out) in out.iter_mut().enumerate() {
        // A line without a length has no value of its own.
        if rounded[k].is_any() || around.iter().any(|values| values[k].is_nan()) {
            *out = Accept::ANY;
            continue;
        }
        let low = around.iter().map(|values| values[k]).fold(f64::INFINITY, f64::min);
        let high = around.iter().map(|values| values[k]).fold(f64::NEG_INFINITY, f64::max);
        *out = Accept::from_bounds(
            low - (exact[k] - rounded[k].low()).max(0.0),
            high + (rounded[k].high() - exact[k]).max(0.0),
        );
    }
}

/// Two triangles a b c and a c d. On the grid of 1/16 pixel nothing is moved, and coverage is exact. Elsewhere a pixel
/// within the outline by more than δ is covered once, since both triangles see the shared edge moved alike.
fn quad(inputs: &[f32], snap: f64) -> Accept {
    let row = wide(inputs);
    let corners: [Vec2<f64>; 4] = std::array::from_fn(|k| Vector([row[2 * k], row[2 * k + 1]]));
    let p = pixel(inputs);
    let [a, b, c, d] = corners;
    if row.iter().all(|x| (x * 16.0).fract() == 0.0) {
        return Accept::exactly(interpolation::coverage([a, b, c], p) + interpolation::coverage([a, c, d], p));
    }
    let distance = |from: Vec2<f64>, to: Vec2<f64>| interpolation::edge(from, to, p) / (to - from).length();
    let outline = [distance(a, b), distance(b, c), distance(c, d), distance(d, a)];
    // A vertex moves by less than √2 δ, and so does every point of an edge; clip coordinates hold a place of up to 256 pixels
    // to 2⁻¹⁵ pixel, and going there and back rounds less than eight times.
    let margin = std::f64::consts::SQRT_2 * (snap + 8.0 / 32_768.0);
    if outline.iter().all(|&x| x > margin) || outline.iter().all(|&x| x < -margin) {
        Accept::exactly(1.0)
    } else {
        Accept::from_bounds(0.0, 2.0)
    }
}

fn facing(inputs: &[f32], snap: f64) -> Accept {
    SnappedTriangle::new(inputs, snap).map_or(Accept::from_bounds(UNDECIDED.0, UNDECIDED.1), |drawn| {
        Accept::exactly(interpolation::front_facing(drawn.window()))
    })
}

/// Clipping makes new vertices, which are snapped in turn: twice the square. Where a vertex lies behind the eye they may
/// lie as far away as the guard band reaches, 2¹⁵ pixels, where binary32 has steps of 2⁻⁸ pixel; the product, the sum and
/// the quotient that make such a vertex, and the viewport, err by at most 8 of those in all.
///
/// What decides is linear in the place, so it is certain where it has one sign at the corners of the square: the pixel is
/// covered where everything has the sign of w, and not covered where something has the other.
fn clipped(inputs: &[f32], snap: f64) -> Accept {
    let (clip, off) = vertices::<3>(inputs, snap);
    let behind = clip.iter().any(|v| v.w() <= 0.0);
    let reach = off.map(|off| 2.0 * off + if behind { 8.0 / 256.0 } else { 0.0 });
    let at_corners = square(pixel(inputs), reach).map(|p| interpolation::clip_functions(clip, &target(), p));
    let all = |sign: f64, function: usize| at_corners.iter().all(|values| sign * values[function] > 0.0);
    for sign in [1.0, -1.0] {
        if all(sign, 5) && (0..5).all(|function| all(sign, function)) {
            return Accept::exactly(1.0);
        }
        if all(sign, 5) && (0..5).any(|function| all(-sign, function)) {
            return Accept::exactly(0.0);
        }
    }
    Accept::from_bounds(UNDECIDED.0, UNDECIDED.1)
}
