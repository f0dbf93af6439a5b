//! Cases of interpolation: as arithmetic, and by the rasteriser. Formulas: `lightmeter_reference::interpolation`.

use super::Visitor;
use super::draw::narrow;
use super::formula::{Formula, formula};
use super::rows::{Reader, Writer};
use super::spec::{Domain, Hard, Input, Kind, Output, Shape, Spec};
use lightmeter_gpu::{Raster, TARGET_SIZE};
use lightmeter_reference::interpolation::{self, Viewport};
use lightmeter_reference::{Real, Vec2, Vector};
use lightmeter_scene::raster::{Provoking, Topology};

const ATTRIBUTE: Domain = Domain::Uniform(-2.0, 2.0);
const ATTR: Output = Output::new("attr", Shape::Scalar, "1");
const WEIGHTS: Input = Input::new("weights", Shape::Vec3, "1", Domain::Weights);

const fn attr(name: &'static str) -> Input {
    Input::scalar(name, "1", ATTRIBUTE)
}

const fn window(name: &'static str) -> Input {
    Input::new(name, Shape::Vec2, "pixel", Domain::Uniform(0.0, 256.0))
}

const fn half_pixels(name: &'static str) -> Input {
    Input::new(name, Shape::Vec2, "pixel", Domain::Halves(0.0, 64.0))
}

formula!(
    /// Along a line.
    Line: "interpolation/line" by "interpolation_line",
    "attr = α·a + β·b", "000 §6.1",
    [Input::new("weights", Shape::Vec2, "1", Domain::Weights), attr("a"), attr("b")] -> [ATTR],
    |x, out| { out.scalar(interpolation::line(x.array(), x.array())); },
);
formula!(
    /// Over a triangle.
    Triangle: "interpolation/triangle" by "interpolation_triangle",
    "attr = α·a + β·b + γ·c", "000 §6.1",
    [WEIGHTS, attr("a"), attr("b"), attr("c")] -> [ATTR],
    |x, out| { out.scalar(interpolation::triangle(x.array(), x.array())); },
    hard [
        Hard { name: "at-a-vertex", pins: "the vertex's own value", inputs: &[("weights", &[0.0, 1.0, 0.0]), ("a", &[1e8]), ("b", &[1.0]), ("c", &[-1e8])] },
    ],
);
formula!(
    /// The weights of a point.
    Weights: "interpolation/weights" by "interpolation_weights",
    "λ = area opposite each vertex over the whole", "000 §6.1",
    [window("a"), window("b"), window("c"), window("p")] -> [Output::new("lambda", Shape::Vec3, "1")],
    |x, out| { out.vector(Vector(interpolation::weights(x.vectors(), x.vector()))); },
    hard [
        Hard { name: "far-from-the-origin", pins: "a unit triangle at 1e4: subtract a vertex first", inputs: &[("a", &[1e4, 1e4]), ("b", &[10001.0, 1e4]), ("c", &[1e4, 10001.0]), ("p", &[10000.25, 10000.25])] },
        Hard { name: "no-area", pins: "no value: nothing is promised", inputs: &[("a", &[0.0, 0.0]), ("b", &[1.0, 1.0]), ("c", &[2.0, 2.0]), ("p", &[1.0, 1.0])] },
    ],
);
formula!(
    /// The scan-line form.
    Scanline: "interpolation/scanline" by "interpolation_scanline",
    "Ip = (Ia(xb − xp) + Ib(xp − xa))/(xb − xa), Ia and Ib along the edges", "004",
    [
        window("v1"), window("v2"), window("v3"), Input::new("i", Shape::Vec3, "1", Domain::Unit), window("p"),
    ] -> [ATTR],
    fit within_the_scanlines,
    |x, out| { out.scalar(interpolation::scanline(x.vectors(), x.array(), x.vector())); },
);
formula!(
    /// Forward differences.
    ForwardDifferences: "interpolation/forward-differences" by "interpolation_forward_differences",
    "a, then 16 times a step of (b − a)/16", "004",
    [attr("a"), attr("b")] -> [ATTR],
    |x, out| { out.scalar(interpolation::forward_differences::<R, 17>(x.scalar(), x.scalar())); },
);
formula!(
    /// Perspective-correct over a triangle.
    Perspective: "interpolation/perspective" by "interpolation_perspective",
    "attr = Σ λᵢ·aᵢ/wᵢ / Σ λᵢ/wᵢ", "000 §6.1",
    [
        Input::new("lambda", Shape::Vec3, "1", Domain::Weights),
        Input::new("w", Shape::Vec3, "1", Domain::LogUniform(0.1, 100.0)),
        Input::new("attr", Shape::Vec3, "1", ATTRIBUTE),
    ] -> [ATTR],
    |x, out| { out.scalar(interpolation::perspective(x.array(), x.array(), x.array())); },
    hard [
        Hard { name: "near-zero-w", pins: "1/w overflows: nothing is promised of the published form", inputs: &[("w", &[1e-39, 1.0, 1.0])] },
        Hard { name: "equal-w", pins: "the same as linear", inputs: &[("w", &[4.0, 4.0, 4.0])] },
    ],
);
formula!(
    /// Perspective-correct along a line.
    PerspectiveLine: "interpolation/perspective-line" by "interpolation_perspective_line",
    "attr = ((1 − t)a/wa + t·b/wb)/((1 − t)/wa + t/wb)", "000 §6.1",
    [
        Input::scalar("t", "1", Domain::Unit),
        Input::new("w", Shape::Vec2, "1", Domain::LogUniform(0.1, 100.0)),
        Input::new("attr", Shape::Vec2, "1", ATTRIBUTE),
    ] -> [ATTR],
    |x, out| { out.scalar(interpolation::perspective_line(x.scalar(), x.array(), x.array())); },
);
formula!(
    /// The first vertex's attribute.
    FlatFirst: "interpolation/flat-first" by "interpolation_flat_first",
    "attr = the first vertex's", "000 §6.1; ruling 7",
    [Input::new("attr", Shape::Vec3, "1", ATTRIBUTE)] -> [ATTR],
    |x, out| { out.scalar(interpolation::flat(x.array::<3>(), Provoking::First)); },
);
formula!(
    /// The last vertex's attribute.
    FlatLast: "interpolation/flat-last" by "interpolation_flat_last",
    "attr = the last vertex's", "000 §6.1; ruling 7",
    [Input::new("attr", Shape::Vec3, "1", ATTRIBUTE)] -> [ATTR],
    |x, out| { out.scalar(interpolation::flat(x.array::<3>(), Provoking::Last)); },
);
formula!(
    /// Coverage by the top-left rule.
    Coverage: "interpolation/coverage" by "interpolation_coverage",
    "1 where p lies inside, or on a top or left edge", "000 §6.1",
    [half_pixels("a"), half_pixels("b"), half_pixels("c"), half_pixels("p")] -> [Output::new("covered", Shape::Scalar, "1")],
    fit near_the_triangle,
    |x, out| { out.scalar(interpolation::coverage(x.vectors(), x.vector())); },
    hard [
        Hard { name: "top-edge", pins: "belongs to the triangle", inputs: &[("a", &[0.0, 0.0]), ("b", &[8.0, 0.0]), ("c", &[4.0, 8.0]), ("p", &[4.0, 0.0])] },
        Hard { name: "bottom-edge", pins: "does not", inputs: &[("a", &[0.0, 8.0]), ("b", &[8.0, 8.0]), ("c", &[4.0, 0.0]), ("p", &[4.0, 8.0])] },
        Hard { name: "left-edge", pins: "belongs to the triangle", inputs: &[("a", &[0.0, 0.0]), ("b", &[8.0, 4.0]), ("c", &[0.0, 8.0]), ("p", &[0.0, 4.0])] },
        Hard { name: "right-edge", pins: "does not", inputs: &[("a", &[8.0, 0.0]), ("b", &[8.0, 8.0]), ("c", &[0.0, 4.0]), ("p", &[8.0, 4.0])] },
        Hard { name: "no-area", pins: "covers nothing", inputs: &[("a", &[0.0, 0.0]), ("b", &[4.0, 4.0]), ("c", &[8.0, 8.0]), ("p", &[4.0, 4.0])] },
    ],
);

const CLIP: Input = Input::new("clip", Shape::Vec4, "1", Domain::Uniform(0.5, 2.0));

macro_rules! viewport {
    ($name:ident, $id:literal, $function:literal, $formula:path, $text:literal) => {
        formula!(
            /// The viewport's transformation.
            $name: $id by $function, $text, "000 §6.1",
            [
                CLIP,
                Input::new("origin", Shape::Vec2, "pixel", Domain::Uniform(0.0, 100.0)),
                Input::new("size", Shape::Vec2, "pixel", Domain::Uniform(1.0, 4096.0)),
                Input::new("depth", Shape::Vec2, "1", Domain::Unit),
            ] -> [Output::new("window", Shape::Vec3, "pixel")],
            |x, out| {
                let clip = x.vector();
                let to = Viewport { origin: x.vector(), size: x.vector(), depth: x.vector() };
                out.vector($formula(clip, &to));
            },
        );
    };
}

viewport!(
    ViewportWebGpu,
    "interpolation/viewport",
    "interpolation_viewport",
    interpolation::viewport,
    "x = ox + (x/w + 1)·sx/2, y = oy + (1 − y/w)·sy/2, z = near + z/w·(far − near)"
);
viewport!(
    ViewportOpenGl,
    "interpolation/viewport-opengl",
    "interpolation_viewport_opengl",
    interpolation::viewport_opengl,
    "x = ox + (x/w + 1)·sx/2, y = oy + (y/w + 1)·sy/2, z = near + (z/w + 1)·(far − near)/2"
);

macro_rules! clip_volume {
    ($name:ident, $id:literal, $function:literal, $formula:path, $text:literal) => {
        formula!(
            /// The clip volume.
            $name: $id by $function, $text, "000 §6.1",
            [Input::new("clip", Shape::Vec4, "1", Domain::Uniform(-2.0, 4.0))] -> [Output::new("inside", Shape::Scalar, "1")],
            |x, out| { out.scalar($formula(x.vector())); },
            hard [
                Hard { name: "on-a-plane", pins: "the planes belong to the volume", inputs: &[("clip", &[2.0, -2.0, 2.0, 2.0])] },
                Hard { name: "behind-the-eye", pins: "outside", inputs: &[("clip", &[0.0, 0.0, 0.0, -1.0])] },
            ],
        );
    };
}

clip_volume!(
    ClipVolume,
    "interpolation/clip-volume",
    "interpolation_clip_volume",
    interpolation::clip_volume,
    "1 where −w ≤ x, y ≤ w and 0 ≤ z ≤ w"
);
clip_volume!(
    ClipVolumeOpenGl,
    "interpolation/clip-volume-opengl",
    "interpolation_clip_volume_opengl",
    interpolation::clip_volume_opengl,
    "1 where −w ≤ x, y, z ≤ w"
);
formula!(
    /// Front facing.
    FrontFacing: "interpolation/front-facing" by "interpolation_front_facing",
    "1 where the triangle is counter-clockwise as seen", "000 §6.1",
    [window("a"), window("b"), window("c")] -> [Output::new("front", Shape::Scalar, "1")],
    |x, out| { out.scalar(interpolation::front_facing(x.vectors())); },
    hard [Hard { name: "no-area", pins: "not front", inputs: &[("a", &[0.0, 0.0]), ("b", &[1.0, 1.0]), ("c", &[2.0, 2.0])] }],
);
formula!(
    /// A fragment's own depth.
    FragDepth: "interpolation/frag-depth" by "interpolation_frag_depth",
    "clamp(depth, 0, 1)", "000 §6.1",
    [Input::scalar("depth", "1", Domain::Uniform(-0.5, 1.5))] -> [Output::new("depth", Shape::Scalar, "1")],
    |x, out| { out.scalar(interpolation::frag_depth(x.scalar())); },
);

/// The point between the first vertex's line and the nearer of the other two, where both edges have a scan line.
fn within_the_scanlines(row: &mut [f32]) {
    let (y1, far) = (row[1], if (row[3] - row[1]).abs() < (row[5] - row[1]).abs() { row[3] } else { row[5] });
    if (row[3] < y1) != (row[5] < y1) {
        // The other two on one side of the first.
        row[5] = 2.0 * y1 - row[5];
    }
    let far = if (row[3] < y1) == (far < y1) { far } else { row[3] };
    let t = 0.1 + 0.8 * row[10] / 256.0;
    row[10] = y1 + (far - y1) * t;
}

/// The point on the line between a vertex and the middle of another edge, moved to the half-pixel grid.
fn near_the_triangle(row: &mut [f32]) {
    for k in 0..2 {
        let middle = (row[k] + row[2 + k]) * 0.5;
        let t = row[6 + k] / 64.0;
        row[6 + k] = (2.0 * (middle + (row[4 + k] - middle) * (t * 1.5 - 0.25))).round() * 0.5;
    }
}

// ---- By the rasteriser -----------------------------------------------------------------------------------------------

/// The whole target, depth from 0 to 1.
pub(super) fn target<R: Real>() -> Viewport<R> {
    let size = R::literal(f64::from(TARGET_SIZE));
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    Viewport { origin: Vector([zero, zero]), size: Vector([size, size]), depth: Vector([zero, one]) }
}

/// The middle of the pixel that a row ends with.
fn pixel_center<R: Real>(x: &mut Reader<'_, R>) -> Vec2<R> {
    x.vector().map(|corner| corner + R::literal(0.5))
}

const fn around(name: &'static str) -> Input {
    Input::new(name, Shape::Vec4, "clip", Domain::Around)
}

const PIXEL: Input = Input::new("pixel", Shape::Vec2, "pixel", Domain::Pixel);
const COVERED: Output = Output::new("covered", Shape::Scalar, "1");
const BOTH: [Output; 2] = [Output::new("perspective", Shape::Scalar, "1"), Output::new("linear", Shape::Scalar, "1")];

macro_rules! raster_triangle {
    ($name:ident, $id:literal, $kind:expr, $fit:expr, $text:literal, [$($output:expr),*], |$x:ident, $out:ident| $body:block) => {
        formula!(
            /// A triangle by the rasteriser.
            $name: $id by "", $text, "000 §6.1",
            [
                around("a"), around("b"), around("c"), Input::new("attr", Shape::Vec3, "1", ATTRIBUTE), PIXEL,
            ] -> [$($output),*],
            fit $fit,
            kind Kind::Raster($kind),
            |$x, $out| $body,
        );
    };
}

raster_triangle!(
    RasterAttributes,
    "interpolation/raster-attributes",
    Raster::TriangleAttributes,
    triangle_around_the_pixel,
    "the attribute of a drawn triangle at a pixel: Σ λa/w / Σ λ/w, and Σ λa",
    [BOTH[0], BOTH[1]],
    |x, out| {
        let (clip, attr) = (x.vectors(), x.array());
        let fragment = interpolation::fragment(clip, attr, &target(), pixel_center(x));
        out.scalar(fragment.perspective);
        out.scalar(fragment.linear);
    }
);
raster_triangle!(
    RasterPosition,
    "interpolation/raster-position",
    Raster::TrianglePosition,
    triangle_around_the_pixel,
    "gl_FragCoord of a drawn triangle: the pixel's centre from the upper left, window z, 1/w",
    [Output::new("position", Shape::Vec4, "pixel")],
    |x, out| {
        let (clip, attr, p) = (x.vectors(), x.array(), pixel_center(x));
        let fragment = interpolation::fragment(clip, attr, &target(), p);
        out.vector(Vector([p.x(), p.y(), fragment.depth, fragment.inverse_w]));
    }
);
raster_triangle!(
    RasterFacing,
    "interpolation/raster-facing",
    Raster::Facing,
    triangle_around_the_pixel,
    "gl_FrontFacing of a drawn triangle: 1 where it is counter-clockwise as seen",
    [Output::new("front", Shape::Scalar, "1")],
    |x, out| {
        out.scalar(facing(x));
    }
);
raster_triangle!(
    RasterClip,
    "interpolation/raster-clip",
    Raster::Clipped,
    triangle_across_the_volume,
    "1 where a triangle that reaches out of the clip volume still covers the pixel",
    [COVERED],
    |x, out| {
        let (clip, _attr) = (x.vectors(), x.array::<3>());
        out.scalar(interpolation::clipped_coverage(clip, &target(), pixel_center(x)));
    }
);

/// Whether a row's triangle faces front: the pixel, which lies inside, is not looked at.
fn facing<R: Real>(x: &mut Reader<'_, R>) -> R {
    let clip = x.vectors::<4, 3>();
    interpolation::front_facing(clip.map(|v| {
        let window = interpolation::viewport(v, &target());
        Vector([window.x(), window.y()])
    }))
}

macro_rules! raster_culled {
    ($name:ident, $id:literal, $back:literal, $ccw:literal, $text:literal) => {
        raster_triangle!(
            $name,
            $id,
            Raster::Culled { back: $back, front_is_ccw: $ccw },
            triangle_around_the_pixel,
            $text,
            [COVERED],
            |x, out| {
                let (shown, front) = ($back == $ccw, facing(x));
                out.scalar(if shown { front } else { R::literal(1.0) - front });
            }
        );
    };
}

raster_culled!(
    CullBackCcw,
    "interpolation/cull-back-ccw",
    true,
    true,
    "1 where a triangle survives: back faces culled, counter-clockwise is front"
);
raster_culled!(
    CullBackCw,
    "interpolation/cull-back-cw",
    true,
    false,
    "1 where a triangle survives: back faces culled, clockwise is front"
);
raster_culled!(
    CullFrontCcw,
    "interpolation/cull-front-ccw",
    false,
    true,
    "1 where a triangle survives: front faces culled, counter-clockwise is front"
);
raster_culled!(
    CullFrontCw,
    "interpolation/cull-front-cw",
    false,
    false,
    "1 where a triangle survives: front faces culled, clockwise is front"
);

formula!(
    /// A line by the rasteriser.
    RasterLine: "interpolation/raster-line" by "",
    "the attribute of a drawn line at a pixel that it passes through: perspective-correct, and linear", "000 §6.1",
    [around("a"), around("b"), attr("attr_a"), attr("attr_b"), PIXEL] -> [BOTH[0], BOTH[1]],
    fit line_through_the_pixel,
    kind Kind::Raster(Raster::LineAttributes),
    |x, out| {
        let (clip, attr) = (x.vectors(), x.array());
        let [perspective, linear] = interpolation::fragment_of_line(clip, attr, &target(), pixel_center(x));
        out.scalar(perspective);
        out.scalar(linear);
    },
);
const COUNT: Output = Output::new("count", Shape::Scalar, "1");

macro_rules! raster_quad {
    ($name:ident, $id:literal, $fit:expr, $text:literal, [$($input:expr),*]) => {
        formula!(
            /// Two triangles that share an edge.
            $name: $id by "", $text, "000 §6.1",
            [$($input),*, PIXEL] -> [COUNT],
            fit $fit,
            kind Kind::Raster(Raster::Quad),
            |x, out| {
                let ([a, b, c, d], p) = (x.vectors(), pixel_center(x));
                out.scalar(interpolation::coverage([a, b, c], p) + interpolation::coverage([a, c, d], p));
            },
        );
    };
}

raster_quad!(
    RasterTopLeft,
    "interpolation/raster-top-left",
    quad_on_the_grid,
    "how many of two triangles with vertices on the half-pixel grid cover the pixel, ties by the top-left rule",
    [half_pixels("a"), half_pixels("b"), half_pixels("c"), half_pixels("d")]
);
raster_quad!(
    RasterSharedEdge,
    "interpolation/raster-shared-edge",
    quad_around_the_pixel,
    "how many of two triangles that share an edge cover a pixel near that edge: one, wherever it lies",
    [window("a"), window("b"), window("c"), window("d")]
);
formula!(
    /// A fragment's own depth, stored.
    RasterDepth: "interpolation/raster-frag-depth" by "",
    "the depth that a fragment wrote, read back from the depth buffer: clamp(depth, 0, 1)", "000 §6.1",
    [Input::scalar("depth", "1", Domain::Uniform(-0.5, 1.5)), PIXEL] -> [Output::new("depth", Shape::Scalar, "1")],
    kind Kind::Raster(Raster::OwnDepth),
    |x, out| { out.scalar(interpolation::frag_depth(x.scalar())); },
);

/// A flat attribute of a drawn list or strip.
#[derive(Clone, Copy, Debug)]
struct RasterFlat {
    topology: Topology,
    provoking: Provoking,
}

impl RasterFlat {
    /// Primitives that six vertices make.
    const fn primitives(self) -> u32 {
        match self.topology {
            Topology::Points => 6,
            Topology::LineList => 3,
            Topology::LineStrip => 5,
            Topology::TriangleList => 2,
            Topology::TriangleStrip => 4,
        }
    }
}

macro_rules! flat_inputs {
    ($last:literal) => {
        const {
            &[
                attr("a0"),
                attr("a1"),
                attr("a2"),
                attr("a3"),
                attr("a4"),
                attr("a5"),
                Input::scalar("primitive", "1", Domain::Whole(0, $last)),
                PIXEL,
            ]
        }
    };
}

impl Formula for RasterFlat {
    fn spec(&self) -> Spec {
        let inputs: &'static [Input] = match self.topology {
            Topology::Points => flat_inputs!(5),
            Topology::LineList => flat_inputs!(2),
            Topology::LineStrip => flat_inputs!(4),
            Topology::TriangleList => flat_inputs!(1),
            Topology::TriangleStrip => flat_inputs!(3),
        };
        Spec {
            id: format!("interpolation/raster-flat-{}-{}", self.topology.name(), self.provoking.name()),
            text: "the flat attribute of one primitive of a drawn list or strip: that of its provoking vertex",
            source: "000 §6.1; ruling 7",
            function: "",
            kind: Kind::Raster(Raster::Flat { topology: self.topology, provoking: self.provoking }),
            selectors: vec![],
            inputs,
            outputs: &[ATTR],
            fit: None,
            hard: &[],
        }
    }

    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let (attr, primitive) = (x.array::<6>(), x.scalar());
        let step = match self.topology {
            Topology::LineList => 2,
            Topology::TriangleList => 3,
            _ => 1,
        };
        let of = |m: u32| -> R {
            let first = (m * step) as usize;
            match self.topology.corners() {
                1 => attr[first],
                2 => interpolation::flat([attr[first], attr[first + 1]], self.provoking),
                _ => interpolation::flat([attr[first], attr[first + 1], attr[first + 2]], self.provoking),
            }
        };
        let chosen = (1..self.primitives())
            .fold(of(0), |value, m| R::if_ge(primitive, R::literal(f64::from(m)), || of(m), || value));
        out.scalar(chosen);
    }
}

/// From raw numbers between 0 and 1 to a vertex in clip coordinates at that angle about the pixel.
fn place(raw: &mut [f32], pixel: [f64; 2], angle: f64) {
    let [_, radius, z, w] = [raw[0], raw[1], raw[2], raw[3]].map(f64::from);
    let radius = 8.0 * core_math::exp2(radius * core_math::log2(60.0 / 8.0));
    let (x, y) = (pixel[0] + radius * core_math::cos(angle), pixel[1] + radius * core_math::sin(angle));
    let half = f64::from(TARGET_SIZE) / 2.0;
    let w = 0.5 * core_math::exp2(4.0 * w);
    for (raw, value) in raw.iter_mut().zip([(x / half - 1.0) * w, (1.0 - y / half) * w, z * w, w]) {
        *raw = narrow(value);
    }
}

fn center(row: &[f32]) -> [f64; 2] {
    [f64::from(row[row.len() - 2]) + 0.5, f64::from(row[row.len() - 1]) + 0.5]
}

fn triangle_around_the_pixel(row: &mut [f32]) {
    for k in 0..3 {
        row[4 * k + 2] = 0.05 + 0.9 * row[4 * k + 2];
    }
    triangle_around(row);
}

fn triangle_across_the_volume(row: &mut [f32]) {
    let behind = row[12].to_bits() & 3 == 0;
    for k in 0..3 {
        row[4 * k + 2] = 2.0 * row[4 * k + 2] - 0.5;
    }
    triangle_around(row);
    if behind {
        // A vertex behind the eye: the triangle opens away from it.
        row[..4].iter_mut().for_each(|x| *x = -*x);
    }
}

fn triangle_around(row: &mut [f32]) {
    let (pixel, base) = (center(row), std::f64::consts::TAU * f64::from(row[0]));
    let clockwise = row[1].to_bits() & 1 == 0;
    for (k, turn) in (0..3).zip([0.0, 1.0, 2.0]) {
        let jitter = if k == 0 { 0.0 } else { 0.7 * (f64::from(row[4 * k]) - 0.5) };
        let angle = std::f64::consts::TAU / 3.0 * turn + jitter;
        place(&mut row[4 * k..4 * k + 4], pixel, base + if clockwise { angle } else { -angle });
    }
}

fn line_through_the_pixel(row: &mut [f32]) {
    let (pixel, angle) = (center(row), std::f64::consts::TAU * f64::from(row[0]));
    for (k, turn) in [(0, 0.0), (1, std::f64::consts::PI)] {
        row[4 * k + 2] = 0.05 + 0.9 * row[4 * k + 2];
        place(&mut row[4 * k..4 * k + 4], pixel, angle + turn);
    }
}

/// Four corners in order about the middle of the grid, moved so that they surround the pixel.
fn quad_on_the_grid(row: &mut [f32]) {
    let [px, py] = [row[8], row[9]];
    for (k, (right, down)) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].into_iter().enumerate() {
        // Corners 0 to 8 pixels from the pixel, so that edges often pass through its centre.
        let reach = |raw: f32| (raw / 8.0 * 2.0).round() * 0.5;
        row[2 * k] = px + 0.5 + (2.0 * right - 1.0) * reach(row[2 * k]);
        row[2 * k + 1] = py + 0.5 + (2.0 * down - 1.0) * reach(row[2 * k + 1]);
    }
}

/// Four corners about the pixel, two of them nearly opposite, so that the shared edge passes close by.
fn quad_around_the_pixel(row: &mut [f32]) {
    let pixel = center(row);
    let base = std::f64::consts::TAU * f64::from(row[0]) / 256.0;
    for (k, turn) in (0..4).zip([0.0, 0.25, 0.5, 0.75]) {
        let [angle, radius] = [row[2 * k], row[2 * k + 1]].map(|raw| f64::from(raw) / 256.0);
        let jitter = if k == 2 { 0.02 * (angle - 0.5) } else { 0.0 };
        let (angle, radius) = (base + std::f64::consts::TAU * (turn + jitter), 16.0 + 44.0 * radius);
        row[2 * k] = narrow(pixel[0] + radius * core_math::cos(angle));
        row[2 * k + 1] = narrow(pixel[1] + radius * core_math::sin(angle));
    }
}

pub(super) fn visit(visitor: &mut impl Visitor) {
    visitor.formula(Line);
    visitor.formula(Triangle);
    visitor.formula(Weights);
    visitor.formula(Scanline);
    visitor.formula(ForwardDifferences);
    visitor.formula(Perspective);
    visitor.formula(PerspectiveLine);
    visitor.formula(FlatFirst);
    visitor.formula(FlatLast);
    visitor.formula(Coverage);
    visitor.formula(ViewportWebGpu);
    visitor.formula(ViewportOpenGl);
    visitor.formula(ClipVolume);
    visitor.formula(ClipVolumeOpenGl);
    visitor.formula(FrontFacing);
    visitor.formula(FragDepth);
    visitor.formula(RasterAttributes);
    visitor.formula(RasterPosition);
    visitor.formula(RasterLine);
    visitor.formula(RasterFacing);
    visitor.formula(RasterClip);
    visitor.formula(CullBackCcw);
    visitor.formula(CullBackCw);
    visitor.formula(CullFrontCcw);
    visitor.formula(CullFrontCw);
    visitor.formula(RasterTopLeft);
    visitor.formula(RasterSharedEdge);
    visitor.formula(RasterDepth);
    for topology in Topology::ALL {
        for provoking in Provoking::ALL {
            visitor.formula(RasterFlat { topology, provoking });
        }
    }
}
