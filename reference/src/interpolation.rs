//! Interpolation, coverage and the viewport (000 §6.1, 004).
//!
//! Symbols: `alpha beta gamma` barycentric weights that sum to 1; `a b c` the attribute at the vertices; `w` a vertex's
//! homogeneous coordinate, > 0; `x y` window coordinates in pixels, y down unless said; a pixel's centre lies at its
//! whole coordinates plus ½.

use crate::algebra::{Vec2, Vec3, Vec4, Vector};
use crate::real::Real;
use crate::step::step;
use lightmeter_scene::raster::Provoking;

/// `Attr(p) = α·Attr(a) + β·Attr(b)` with α + β = 1. Source: 000 §6.1.
pub fn line<R: Real>([alpha, beta]: [R; 2], [a, b]: [R; 2]) -> R {
    alpha * a + beta * b
}

/// `Attr(p) = α·Attr(a) + β·Attr(b) + γ·Attr(c)` with α + β + γ = 1. Source: 000 §6.1.
pub fn triangle<R: Real>([alpha, beta, gamma]: [R; 3], [a, b, c]: [R; 3]) -> R {
    R::sum([alpha * a, beta * b, gamma * c])
}

/// Twice the signed area of the triangle `a b p`: `(b.x − a.x)(p.y − a.y) − (b.y − a.y)(p.x − a.x)`.
///
/// 0 where p lies on the line through a and b. Subtracting a vertex first keeps it exact far from the origin.
pub fn edge<R: Real>(a: Vec2<R>, b: Vec2<R>, p: Vec2<R>) -> R {
    step!("edge", |a, b, p| area_of(a, b, p))
}

/// The same of a whole triangle.
fn area<R: Real>(a: Vec2<R>, b: Vec2<R>, c: Vec2<R>) -> R {
    step!("2·area", |a, b, c| area_of(a, b, c))
}

fn area_of<R: Real>(a: Vec2<R>, b: Vec2<R>, c: Vec2<R>) -> R {
    let (ab, ac) = (b - a, c - a);
    ab.x() * ac.y() - ab.y() * ac.x()
}

/// The same without a vertex subtracted: `a × b + b × p + p × a`, six products as great as the vertices are far.
pub fn edge_from_origin<R: Real>(a: Vec2<R>, b: Vec2<R>, p: Vec2<R>) -> R {
    R::sum([a.x() * b.y(), -(a.y() * b.x()), b.x() * p.y(), -(b.y() * p.x()), p.x() * a.y(), -(p.y() * a.x())])
}

/// The same by a difference of products that keeps its relative error small for slivers too.
pub fn edge_compensated<R: Real>(a: Vec2<R>, b: Vec2<R>, p: Vec2<R>) -> R {
    let (ab, ap) = (b - a, p - a);
    R::difference_of_products([ab.x(), ap.y()], [ab.y(), ap.x()])
}

/// The weight of c at p: the area of `a b p` over that of `a b c`.
pub fn last_weight<R: Real>([a, b, c]: [Vec2<R>; 3], p: Vec2<R>) -> R {
    let (part, whole) = (edge(a, b, p), area(a, b, c));
    step!(quiet "weight", |part, whole| part / whole)
}

/// The same as what the other two leave of 1: near the edge from a to b it is a small difference of great numbers.
pub fn last_weight_by_difference<R: Real>([a, b, c]: [Vec2<R>; 3], p: Vec2<R>) -> R {
    let [alpha, beta, _] = weights([a, b, c], p);
    R::literal(1.0) - alpha - beta
}

/// `a(1 − t) + b·t`: b to the last bit at t = 1.
pub fn mix<R: Real>(a: R, b: R, t: R) -> R {
    step!("mix", |a, b, t| a * (R::literal(1.0) - t) + b * t)
}

/// `a + t(b − a)`: one multiplication less; at t = 1 it misses b by the rounding of b − a.
pub fn mix_incremental<R: Real>(a: R, b: R, t: R) -> R {
    a + t * (b - a)
}

/// The barycentric weights of p: each the area opposite its vertex over the whole. No value for a triangle without area.
pub fn weights<R: Real>([a, b, c]: [Vec2<R>; 3], p: Vec2<R>) -> [R; 3] {
    step!(quiet "weights", |a, b, c, p| {
        let whole = area(a, b, c);
        [edge(b, c, p), edge(c, a, p), edge(a, b, p)].map(|part| step!(quiet "weight", |part, whole| part / whole))
    })
}

/// The scan-line form: along two edges to the line of the pixel, then along the span between them.
///
/// `Ia = (I1(ys − y2) + I2(y1 − ys))/(y1 − y2)`, `Ib` likewise on the edge 1–3, `Ip = (Ia(xb − xp) + Ib(xp − xa))/(xb − xa)`.
/// Equal to [`triangle`] wherever y1 ≠ y2, y1 ≠ y3 and xa ≠ xb. Source: 004.
pub fn scanline<R: Real>(vertices: [Vec2<R>; 3], i: [R; 3], p: Vec2<R>) -> R {
    let [v1, v2, v3] = vertices;
    let (x, y) = (p.x(), p.y());
    let along = |near: R, far: R, top: R, bottom: R| step!(quiet "along an edge", |near, far, top, bottom, y| (near * (y - bottom) + far * (top - y)) / (top - bottom));
    let (ia, xa) = (along(i[0], i[1], v1.y(), v2.y()).named("Ia"), along(v1.x(), v2.x(), v1.y(), v2.y()).named("xa"));
    let (ib, xb) = (along(i[0], i[2], v1.y(), v3.y()).named("Ib"), along(v1.x(), v3.x(), v1.y(), v3.y()).named("xb"));
    step!(quiet "along the span", |ia, ib, xa, xb, x| (ia * (xb - x) + ib * (x - xa)) / (xb - xa))
}

/// The span's end reached by forward differences: `a` and then N − 1 times the step `(b − a)/(N − 1)`. Source: 004.
///
/// Exact arithmetic gives b; rounding grows with the number of steps.
pub fn forward_differences<R: Real, const N: usize>(a: R, b: R) -> R {
    let steps = u32::try_from(N - 1).map_or(f64::INFINITY, f64::from);
    let step = ((b - a) / R::literal(steps)).named("step");
    step!("end", |a, step| R::sum(std::array::from_fn::<R, N, _>(|k| if k == 0 { a } else { step })))
}

/// The last of a span's N pixels by forward differences: `a` and N − 1 times the step `(b − a)/N`. Source: 004.
pub fn last_by_differences<R: Real, const N: usize>(a: R, b: R) -> R {
    let step = ((b - a) / R::literal(u32::try_from(N).map_or(f64::INFINITY, f64::from))).named("step");
    step!("end", |a, step| R::sum(std::array::from_fn::<R, N, _>(|k| if k == 0 { a } else { step })))
}

/// `Attr(p) = Σ λᵢ·Attrᵢ/wᵢ / Σ λᵢ/wᵢ`, λ the weights in screen space: perspective-correct interpolation.
pub fn perspective<R: Real>(lambda: [R; 3], w: [R; 3], attr: [R; 3]) -> R {
    step!("perspective", |lambda, w, attr| {
        let q: [R; 3] = std::array::from_fn(|k| lambda[k] / w[k]);
        renormalised(triangle(q, attr).named("Σλa/w"), R::sum(q).named("Σλ/w"))
    })
}

/// [`perspective`] with weights `λᵢ·(w_min/wᵢ)`, which are at most λᵢ: nothing overflows as a w goes to 0, and where it is 0
/// the vertex of that w is all that is seen. For w ≥ 0.
pub fn perspective_scaled<R: Real>(lambda: [R; 3], w: [R; 3], attr: [R; 3]) -> R {
    step!("perspective", |lambda, w, attr| {
        let least = w[0].min(w[1]).min(w[2]);
        let q: [R; 3] = std::array::from_fn(|k| {
            R::if_ge(least, w[k], || lambda[k], || lambda[k] * (least / w[k])).named("λ·w_min/w")
        });
        renormalised(triangle(q, attr), R::sum(q))
    })
}

/// What is interpolated over w, times the w there.
fn renormalised<R: Real>(over_w: R, inverse_w: R) -> R {
    step!(quiet "over the interpolated 1/w", |over_w, inverse_w| over_w / inverse_w)
}

/// `((1 − t)·a/wa + t·b/wb) / ((1 − t)/wa + t/wb)`: the same along a line.
pub fn perspective_line<R: Real>(t: R, [wa, wb]: [R; 2], [a, b]: [R; 2]) -> R {
    let (w, attr) = ([wa, wb], [a, b]);
    step!("perspective along a line", |t, w, attr| {
        let (qa, qb) = ((R::literal(1.0) - t) / w[0], t / w[1]);
        renormalised(qa * attr[0] + qb * attr[1], qa + qb)
    })
}

/// The attribute of the provoking vertex. Source: 000 §6.1; ruling 7.
pub fn flat<R: Copy, const N: usize>(attr: [R; N], provoking: Provoking) -> R {
    match provoking {
        Provoking::First => attr[0],
        Provoking::Last => attr[N - 1],
    }
}

/// 1 where p belongs to the triangle, 0 elsewhere: inside, or on a top or a left edge (y down).
///
/// Every point of an edge shared by two triangles belongs to exactly one of them. A triangle without area has no points.
pub fn coverage<R: Real>([a, b, c]: [Vec2<R>; 3], p: Vec2<R>) -> R {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let sides = |a: Vec2<R>, b: Vec2<R>, c: Vec2<R>| owns(a, b, p, || owns(b, c, p, || owns(c, a, p, || one)));
    let area = area(a, b, c);
    let wound = || R::if_ge(zero, area, || zero, || sides(a, b, c));
    R::if_ge(area, zero, wound, || sides(a, c, b))
}

/// `inside` where p lies on the inner side of a → b or on it and the edge is a top or left one, 0 elsewhere. The
/// triangle is wound so that its inside has [`edge`] > 0: clockwise as seen, y being down.
fn owns<R: Real>(a: Vec2<R>, b: Vec2<R>, p: Vec2<R>, inside: impl Fn() -> R) -> R {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let outside = || zero;
    let e = edge(a, b, p);
    let ab = b - a;
    // Clockwise as seen: a left edge goes up (y falls), a top edge is level and goes right.
    let owned = || {
        step!(quiet "share of an edge", |ab| {
            let level = || R::if_ge(ab.y(), zero, || R::if_ge(zero, ab.x(), || zero, || one), || one);
            R::if_ge(zero, ab.y(), level, || zero)
        })
    };
    let on_edge = || R::if_ge(owned(), one, &inside, outside);
    let not_outside = || R::if_ge(zero, e, on_edge, &inside);
    R::if_ge(e, zero, not_outside, outside)
}

/// A viewport: its upper left corner, its size in pixels and its range of depth.
#[derive(Clone, Copy, Debug)]
pub struct Viewport<R> {
    /// Left and top edge (lower left corner in OpenGL's convention), in pixels.
    pub origin: Vec2<R>,
    /// Width and height, in pixels.
    pub size: Vec2<R>,
    /// The depths that the near and the far plane are taken to.
    pub depth: Vec2<R>,
}

/// Clip → window as WebGPU and Vulkan have it: x and y from [−1, 1], y turned to point down, z from [0, 1].
///
/// `x = ox + (x/w + 1)·sx/2`, `y = oy + (1 − y/w)·sy/2`, `z = near + z/w·(far − near)`. No value at w = 0.
pub fn viewport<R: Real>(clip: Vec4<R>, to: &Viewport<R>) -> Vec3<R> {
    let (half, one) = (R::literal(0.5), R::literal(1.0));
    let (ndc, Viewport { origin, size, depth }) = (ndc(clip), *to);
    step!("window", |ndc, origin, size, depth| Vector([
        origin.x() + R::product([ndc.x() + one, half, size.x()]),
        origin.y() + R::product([one - ndc.y(), half, size.y()]),
        R::mix(depth.x(), depth.y(), ndc.z()),
    ]))
}

/// Clip → window as OpenGL has it: the origin at the lower left, y up, and z from [−1, 1].
pub fn viewport_opengl<R: Real>(clip: Vec4<R>, to: &Viewport<R>) -> Vec3<R> {
    let (half, one) = (R::literal(0.5), R::literal(1.0));
    let (ndc, Viewport { origin, size, depth }) = (ndc(clip), *to);
    step!("window from below", |ndc, origin, size, depth| Vector([
        origin.x() + R::product([ndc.x() + one, half, size.x()]),
        origin.y() + R::product([ndc.y() + one, half, size.y()]),
        R::mix(depth.x(), depth.y(), (ndc.z() + one) * half),
    ]))
}

fn ndc<R: Real>(clip: Vec4<R>) -> Vec3<R> {
    step!("ndc", |clip| clip.xyz().map(|x| x / clip.w()))
}

/// 1 where a vertex lies within the clip volume of WebGPU, `−w ≤ x, y ≤ w` and `0 ≤ z ≤ w`, and 0 outside.
pub fn clip_volume<R: Real>(clip: Vec4<R>) -> R {
    inside_planes(clip, R::literal(0.0))
}

/// 1 where a vertex lies within the clip volume of OpenGL, `−w ≤ x, y, z ≤ w`, and 0 outside.
pub fn clip_volume_opengl<R: Real>(clip: Vec4<R>) -> R {
    inside_planes(clip, -clip.w())
}

fn inside_planes<R: Real>(clip: Vec4<R>, near: R) -> R {
    let [x, y, z, w] = clip.0;
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let five = [(x, -w), (w, x), (y, -w), (w, y), (z, near)];
    let inside = five.into_iter().fold(one, |inside, (a, b)| R::if_ge(a, b, || inside, || zero));
    step!(quiet "before the far plane", |inside, z, w, near| R::if_ge(w, z, || inside, || zero))
}

/// 1 where the triangle is seen from its front, 0 from its back or without area: front is counter-clockwise as seen.
///
/// In window coordinates with y down, counter-clockwise is a negative [`edge`].
pub fn front_facing<R: Real>([a, b, c]: [Vec2<R>; 3]) -> R {
    let area = area(a, b, c);
    step!("front", |area| R::if_ge(area, R::literal(0.0), || R::literal(0.0), || R::literal(1.0)))
}

/// The depth that is stored for a fragment that writes its own: clamped to the viewport's range, [0, 1] by default.
/// Source: 000 §6.1 (`gl_FragDepth`).
pub fn frag_depth<R: Real>(depth: R) -> R {
    step!(quiet "depth clamped", |depth| depth.clamp(R::literal(0.0), R::literal(1.0)))
}

/// A rasterised triangle's window coordinates: [`viewport`] of each vertex.
fn window<R: Real>(clip: [Vec4<R>; 3], to: &Viewport<R>) -> [Vec3<R>; 3] {
    clip.map(|vertex| viewport(vertex, to).named("window"))
}

fn xy<R: Real>(window: [Vec3<R>; 3]) -> [Vec2<R>; 3] {
    window.map(|v| Vector([v.x(), v.y()]))
}

/// What a rasteriser makes of a triangle at a point in window coordinates.
#[derive(Clone, Copy, Debug)]
pub struct InterpolatedValues<R> {
    /// The attribute, perspective-correct.
    pub perspective: R,
    /// The attribute, linear in screen space.
    pub linear: R,
    /// Depth: linear in screen space.
    pub depth: R,
    /// 1/w, linear in screen space: `gl_FragCoord.w`.
    pub inverse_w: R,
}

/// The attribute, depth and 1/w of a triangle at p, from its vertices in clip coordinates. Ruling 15: the depth is that of
/// the window.
pub fn fragment<R: Real>(clip: [Vec4<R>; 3], attr: [R; 3], to: &Viewport<R>, p: Vec2<R>) -> InterpolatedValues<R> {
    let vertices = window(clip, to);
    let lambda = weights(xy(vertices), p).map(|weight| weight.named("λ"));
    InterpolatedValues {
        perspective: perspective(lambda, clip.map(|v| v.w()), attr),
        linear: triangle(lambda, attr),
        depth: triangle(lambda, vertices.map(|v| v.z())),
        inverse_w: triangle(lambda, clip.map(|v| R::literal(1.0) / v.w())),
    }
}

/// The attribute of a line at the point of it nearest to p, perspective-correct and linear.
pub fn fragment_of_line<R: Real>(clip: [Vec4<R>; 2], attr: [R; 2], to: &Viewport<R>, p: Vec2<R>) -> [R; 2] {
    let [a, b] = clip.map(|vertex| viewport(vertex, to)).map(|v| Vector([v.x(), v.y()]));
    let ab: Vec2<R> = b - a;
    let t = ((p - a).dot(ab) / ab.dot(ab)).named("t");
    [perspective_line(t, clip.map(|v| v.w()), attr), R::mix(attr[0], attr[1], t)]
}

/// What decides whether a triangle that is clipped to WebGPU's volume covers p: λ₀, λ₁, λ₂, z, w − z, and w, up to one
/// common sign. Each is a linear function of p; vertices may lie behind the eye.
///
/// In homogeneous coordinates: p is the point Σ λᵢ·clipᵢ, with λ from the 2D cross products of the vertices' distances to p.
pub fn clip_functions<R: Real>(clip: [Vec4<R>; 3], to: &Viewport<R>, p: Vec2<R>) -> [R; 6] {
    let (one, two) = (R::literal(1.0), R::literal(2.0));
    let x = R::product([two, p.x() - to.origin.x()]) / to.size.x() - one;
    let y = one - R::product([two, p.y() - to.origin.y()]) / to.size.y();
    let dx = Vector(clip.map(|v| v.x() - x * v.w()));
    let dy = Vector(clip.map(|v| v.y() - y * v.w()));
    let lambda = dx.cross(dy).named("λ");
    let z = lambda.dot(Vector(clip.map(|v| v.z())));
    let w = lambda.dot(Vector(clip.map(|v| v.w())));
    [lambda.x(), lambda.y(), lambda.z(), z, w - z, w]
}

/// 1 where a triangle that is clipped to WebGPU's volume covers p, 0 elsewhere: all of [`clip_functions`] have one sign.
pub fn clipped_coverage<R: Real>(clip: [Vec4<R>; 3], to: &Viewport<R>, p: Vec2<R>) -> R {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let functions = clip_functions(clip, to, p);
    let inside = |sign: R| functions.into_iter().fold(one, |all, value| R::if_ge(sign * value, zero, || all, || zero));
    R::if_ge(functions[5], zero, || inside(one), || inside(-one))
}
