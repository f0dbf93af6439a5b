//! Cases of interpolation as arithmetic; those of the rasteriser are in `raster`. Formulas:
//! `lightmeter_reference::interpolation`.

use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, Shape};
use super::{Visitor, raster};
use lightmeter_reference::Vector;
use lightmeter_reference::interpolation::{self, Viewport};
use lightmeter_scene::raster::Provoking;

pub(super) const ATTRIBUTE: Domain = Domain::Uniform(-2.0, 2.0);
pub(super) const ATTR: Output = Output::new("attr", Shape::Scalar, "1");
const WEIGHTS: Input = Input::new("weights", Shape::Vec3, "1", Domain::Weights);

pub(super) const fn attr(name: &'static str) -> Input {
    Input::scalar(name, "1", ATTRIBUTE)
}

pub(super) const fn window(name: &'static str) -> Input {
    Input::new(name, Shape::Vec2, "pixel", Domain::Uniform(0.0, 256.0))
}

pub(super) const fn half_pixels(name: &'static str) -> Input {
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
                Hard { name: "on-the-near-plane", pins: "z = 0 lies within WebGPU's volume and OpenGL's", inputs: &[("clip", &[0.0, 0.0, 0.0, 1.0])] },
                Hard { name: "on-opengls-near-plane", pins: "z = −w lies within OpenGL's volume alone", inputs: &[("clip", &[0.0, 0.0, -1.0, 1.0])] },
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
    raster::visit(visitor);
}
