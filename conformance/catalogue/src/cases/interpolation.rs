//! Cases of interpolation as arithmetic; those of the rasteriser are in `raster`. Formulas:
//! `lightmeter_reference::interpolation`.

use super::Visitor;
use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, Spec, ValueShape};
use lightmeter_reference::Vector;
use lightmeter_reference::interpolation::{self, Viewport};
use lightmeter_scene::raster::Provoking;

pub(super) mod raster;

pub(super) const ATTRIBUTE: Domain = Domain::Uniform(-2.0, 2.0);
pub(super) const ATTR: Output = Output::new("attr", ValueShape::Scalar, "1");
const WEIGHTS: Input = Input::new("weights", ValueShape::Vec3, "1", Domain::Weights);

pub(super) const fn attr(name: &'static str) -> Input {
    Input::scalar(name, "1", ATTRIBUTE)
}

pub(super) const fn window(name: &'static str) -> Input {
    Input::new(name, ValueShape::Vec2, "pixel", Domain::Uniform(0.0, 256.0))
}

pub(super) const fn half_pixels(name: &'static str) -> Input {
    Input::new(name, ValueShape::Vec2, "pixel", Domain::Halves(0.0, 64.0))
}

formula!(
    /// Along a line.
    Line: "interpolation/line" by "interpolation_line",
    "attr = α·a + β·b", "000 §6.1",
    [Input::new("weights", ValueShape::Vec2, "1", Domain::Weights), attr("a"), attr("b")] -> [ATTR],
    |weights, a, b; out| { out.scalar(interpolation::line(weights, [a, b])); },
    hard [
        Hard::new("weights-of-another-sum", "each weight counts as it is given", &[("weights", &[0.5, 0.25]), ("a", &[1.0]), ("b", &[1.0])]),
    ],
);
formula!(
    /// Over a triangle.
    Triangle: "interpolation/triangle" by "interpolation_triangle",
    "attr = α·a + β·b + γ·c", "000 §6.1",
    [WEIGHTS, attr("a"), attr("b"), attr("c")] -> [ATTR],
    |weights, a, b, c; out| { out.scalar(interpolation::triangle(weights, [a, b, c])); },
    hard [
        Hard::new("at-a-vertex", "the vertex's own value", &[("weights", &[0.0, 1.0, 0.0]), ("a", &[1e8]), ("b", &[1.0]), ("c", &[-1e8])]),
    ],
);
formula!(
    /// The weights of a point.
    Weights: "interpolation/weights" by "interpolation_weights",
    "λ = area opposite each vertex over the whole", "000 §6.1",
    [window("a"), window("b"), window("c"), window("p")] -> [Output::new("lambda", ValueShape::Vec3, "1")],
    |a, b, c, p; out| { out.vector(Vector(interpolation::weights([a, b, c], p))); },
    hard [
        Hard::new("far-from-the-origin", "a unit triangle at 1e4: subtract a vertex first", &[("a", &[1e4, 1e4]), ("b", &[10001.0, 1e4]), ("c", &[1e4, 10001.0]), ("p", &[10000.25, 10000.25])]),
        Hard::new("no-area", "no value: nothing is promised", &[("a", &[0.0, 0.0]), ("b", &[1.0, 1.0]), ("c", &[2.0, 2.0]), ("p", &[1.0, 1.0])]),
        Hard::new("near-a-corner", "the point is 0.02 from the vertex that its sides are taken from", &[("a", &[3.1, 2.7]), ("b", &[103.3, 47.9]), ("c", &[-47.3, 99.9]), ("p", &[3.09, 2.72])]),
        Hard::new("short-side", "a side of 0.02, from one end of which the others are taken", &[("a", &[3.1, 2.7]), ("b", &[3.11, 2.72]), ("c", &[-47.3, 99.9]), ("p", &[60.3, -80.7])]),
        Hard::new("far-outside", "weights of hundreds, which add up to 1", &[("a", &[0.1, 0.2]), ("b", &[1.3, 0.3]), ("c", &[0.4, 1.7]), ("p", &[317.3, -211.9])]),
    ],
);
formula!(
    /// The scan-line form.
    Scanline: "interpolation/scanline" by "interpolation_scanline",
    "Ip = (Ia(xb − xp) + Ib(xp − xa))/(xb − xa), Ia and Ib along the edges", "004",
    [
        window("v1"), window("v2"), window("v3"), Input::new("i", ValueShape::Vec3, "1", Domain::Unit), window("p"),
    ] -> [ATTR],
    fit within_the_scanlines,
    |v1, v2, v3, i, p; out| { out.scalar(interpolation::scanline([v1, v2, v3], i, p)); },
);
formula!(
    /// Forward differences.
    ForwardDifferences: "interpolation/forward-differences" by "interpolation_forward_differences",
    "a, then 16 times a step of (b − a)/16", "004",
    [attr("a"), attr("b")] -> [ATTR],
    |a, b; out| { out.scalar(interpolation::forward_differences::<R, 17>(a, b)); },
);
formula!(
    /// Perspective-correct over a triangle.
    Perspective: "interpolation/perspective" by "interpolation_perspective",
    "attr = Σ λᵢ·aᵢ/wᵢ / Σ λᵢ/wᵢ", "000 §6.1",
    [
        Input::new("lambda", ValueShape::Vec3, "1", Domain::Weights),
        Input::new("w", ValueShape::Vec3, "1", Domain::LogUniform(0.1, 100.0)),
        Input::new("attr", ValueShape::Vec3, "1", ATTRIBUTE),
    ] -> [ATTR],
    |lambda, w, attr; out| { out.scalar(interpolation::perspective(lambda, w, attr)); },
    hard [
        Hard::new("near-zero-w", "1/w overflows: nothing is promised of the published form", &[("w", &[1e-39, 1.0, 1.0])]),
        Hard::new("equal-w", "the same as linear", &[("w", &[4.0, 4.0, 4.0])]),
        Hard::new("near-w", "a vertex 20 times nearer", &[("lambda", &[0.5, 0.25, 0.25]), ("w", &[0.05, 1.0, 1.0]), ("attr", &[2.0, -2.0, 1.0])]),
        Hard::new("nearest-w", "a vertex 100,000 times nearer", &[("lambda", &[0.5, 0.25, 0.25]), ("w", &[1e-5, 1.0, 1.0]), ("attr", &[2.0, -2.0, 1.0])]),
        Hard::new("all-near", "however small the three are", &[("lambda", &[0.5, 0.25, 0.25]), ("w", &[1e-12, 2e-12, 5e-12]), ("attr", &[2.0, -2.0, 1.0])]),
        Hard::new("all-far", "however great the three are", &[("lambda", &[0.5, 0.25, 0.25]), ("w", &[1e12, 2e12, 5e12]), ("attr", &[2.0, -2.0, 1.0])]),
    ],
);
formula!(
    /// Perspective-correct along a line.
    PerspectiveLine: "interpolation/perspective-line" by "interpolation_perspective_line",
    "attr = ((1 − t)a/wa + t·b/wb)/((1 − t)/wa + t/wb)", "000 §6.1",
    [
        Input::scalar("t", "1", Domain::Unit),
        Input::new("w", ValueShape::Vec2, "1", Domain::LogUniform(0.1, 100.0)),
        Input::new("attr", ValueShape::Vec2, "1", ATTRIBUTE),
    ] -> [ATTR],
    |t, w, attr; out| { out.scalar(interpolation::perspective_line(t, w, attr)); },
    hard [
        Hard::new("at-the-second-vertex", "its attribute, though the first one's is a million times as great", &[("t", &[1.0]), ("w", &[2.0, 3.0]), ("attr", &[1000.0, 0.000_7])]),
        Hard::new("both-near", "however small the two are", &[("t", &[0.5]), ("w", &[1e-12, 3e-12]), ("attr", &[2.0, -2.0])]),
        Hard::new("both-far", "however great the two are", &[("t", &[0.5]), ("w", &[1e12, 3e12]), ("attr", &[2.0, -2.0])]),
    ],
);
formula!(
    /// The first vertex's attribute.
    FlatFirst: "interpolation/flat-first" by "interpolation_flat_first",
    "attr = the first vertex's", "000 §6.1; ruling 7",
    [Input::new("attr", ValueShape::Vec3, "1", ATTRIBUTE)] -> [ATTR],
    |attr; out| { out.scalar(interpolation::flat::<R, 3>(attr, Provoking::First)); },
);
formula!(
    /// The last vertex's attribute.
    FlatLast: "interpolation/flat-last" by "interpolation_flat_last",
    "attr = the last vertex's", "000 §6.1; ruling 7",
    [Input::new("attr", ValueShape::Vec3, "1", ATTRIBUTE)] -> [ATTR],
    |attr; out| { out.scalar(interpolation::flat::<R, 3>(attr, Provoking::Last)); },
);
formula!(
    /// Coverage by the top-left rule.
    Coverage: "interpolation/coverage" by "interpolation_coverage",
    "1 where p lies inside, or on a top or left edge", "000 §6.1",
    [half_pixels("a"), half_pixels("b"), half_pixels("c"), half_pixels("p")] -> [Output::new("covered", ValueShape::Scalar, "1")],
    fit near_the_triangle,
    |a, b, c, p; out| { out.scalar(interpolation::coverage([a, b, c], p)); },
    hard [
        Hard::new("top-edge", "belongs to the triangle", &[("a", &[0.0, 0.0]), ("b", &[8.0, 0.0]), ("c", &[4.0, 8.0]), ("p", &[4.0, 0.0])]),
        Hard::new("bottom-edge", "does not", &[("a", &[0.0, 8.0]), ("b", &[8.0, 8.0]), ("c", &[4.0, 0.0]), ("p", &[4.0, 8.0])]),
        Hard::new("left-edge", "belongs to the triangle", &[("a", &[0.0, 0.0]), ("b", &[8.0, 4.0]), ("c", &[0.0, 8.0]), ("p", &[0.0, 4.0])]),
        Hard::new("right-edge", "does not", &[("a", &[8.0, 0.0]), ("b", &[8.0, 8.0]), ("c", &[0.0, 4.0]), ("p", &[8.0, 4.0])]),
        Hard::new("of-half-a-pixel", "covers what lies inside, however small", &[("a", &[0.0, 0.0]), ("b", &[1.0, 0.0]), ("c", &[0.0, 1.0]), ("p", &[0.25, 0.25])]),
        Hard::new("of-half-a-pixel-turned", "likewise the other way round", &[("a", &[0.0, 0.0]), ("b", &[0.0, 1.0]), ("c", &[1.0, 0.0]), ("p", &[0.25, 0.25])]),
        Hard::new("just-outside-a-left-edge", "by 1/256 of a pixel, of a triangle of 1/16: not covered", &[("a", &[8.0, 8.0]), ("b", &[8.062_5, 8.0]), ("c", &[8.0, 8.062_5]), ("p", &[7.996_093_8, 8.015_625])]),
        Hard::new("just-outside-a-top-edge", "likewise", &[("a", &[8.0, 8.0]), ("b", &[8.062_5, 8.0]), ("c", &[8.0, 8.062_5]), ("p", &[8.015_625, 7.996_093_8])]),
        Hard::new("just-inside-a-right-edge", "by 1/256 of a pixel, of a triangle of 1/16: covered", &[("a", &[8.0, 8.0]), ("b", &[8.0, 8.062_5]), ("c", &[7.937_5, 8.031_25]), ("p", &[7.996_093_8, 8.031_25])]),
        Hard::new("no-area", "covers nothing", &[("a", &[0.0, 0.0]), ("b", &[4.0, 4.0]), ("c", &[8.0, 8.0]), ("p", &[4.0, 4.0])]),
    ],
);

const CLIP: Input = Input::new("clip", ValueShape::Vec4, "1", Domain::Uniform(0.5, 2.0));

macro_rules! viewport {
    ($name:ident, $id:literal, $function:literal, $formula:path, $text:literal) => {
        formula!(
            /// The viewport's transformation.
            $name: $id by $function, $text, "000 §6.1",
            [
                CLIP,
                Input::new("origin", ValueShape::Vec2, "pixel", Domain::Uniform(0.0, 100.0)),
                Input::new("size", ValueShape::Vec2, "pixel", Domain::Uniform(1.0, 4096.0)),
                Input::new("depth", ValueShape::Vec2, "1", Domain::Unit),
            ] -> [Output::new("window", ValueShape::Vec3, "pixel")],
            |clip, origin, size, depth; out| {
                out.vector($formula(clip, &Viewport { origin, size, depth }));
            },
            hard [
                Hard::new("no-depth-range", "near = far is the depth of every vertex, to the last bit", &[
                    ("clip", &[0.3, -0.4, 0.6, 1.3]), ("origin", &[0.0, 0.0]), ("size", &[640.0, 480.0]), ("depth", &[0.7, 0.7]),
                ]),
                Hard::new("behind-the-eye", "a negative w divides as any other", &[
                    ("clip", &[0.5, -0.75, 1.25, -2.0]), ("origin", &[10.0, 20.0]), ("size", &[640.0, 480.0]), ("depth", &[0.25, 0.75]),
                ]),
                Hard::new("nearly-in-the-eyes-plane", "however small, w divides", &[
                    ("clip", &[5e-13, -7e-13, 6e-13, 1e-12]), ("origin", &[10.0, 20.0]), ("size", &[640.0, 480.0]), ("depth", &[0.25, 0.75]),
                ]),
                Hard::new("beside-the-screen", "nothing is clamped", &[
                    ("clip", &[5.0, -7.0, 3.0, 2.0]), ("origin", &[10.0, 20.0]), ("size", &[640.0, 480.0]), ("depth", &[0.25, 0.75]),
                ]),
                Hard::new("beside-the-screen-on-the-other-sides", "nothing is clamped", &[
                    ("clip", &[-7.0, 5.0, -3.0, 2.0]), ("origin", &[10.0, 20.0]), ("size", &[640.0, 480.0]), ("depth", &[0.25, 0.75]),
                ]),
            ],
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
            [Input::new("clip", ValueShape::Vec4, "1", Domain::Uniform(-2.0, 4.0))] -> [Output::new("inside", ValueShape::Scalar, "1")],
            |clip; out| { out.scalar($formula(clip)); },
            hard [
                Hard::new("on-a-plane", "the planes belong to the volume", &[("clip", &[2.0, -2.0, 2.0, 2.0])]),
                Hard::new("on-the-near-plane", "z = 0 lies within WebGPU's volume and OpenGL's", &[("clip", &[0.0, 0.0, 0.0, 1.0])]),
                Hard::new("on-opengls-near-plane", "z = −w lies within OpenGL's volume alone", &[("clip", &[0.0, 0.0, -1.0, 1.0])]),
                Hard::new("behind-the-eye", "outside", &[("clip", &[0.0, 0.0, 0.0, -1.0])]),
                Hard::new("just-before-the-near-plane", "9e-7 outside of WebGPU's volume", &[("clip", &[0.0, 0.0, -9e-7, 1.0])]),
                Hard::new("just-before-opengls-near-plane", "1e-6 outside of OpenGL's volume", &[("clip", &[0.0, 0.0, -1.000_001, 1.0])]),
                Hard::new("all-zero", "inside: 0 ≤ 0 holds", &[("clip", &[0.0, 0.0, 0.0, 0.0])]),
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
    [window("a"), window("b"), window("c")] -> [Output::new("front", ValueShape::Scalar, "1")],
    |a, b, c; out| { out.scalar(interpolation::front_facing([a, b, c])); },
    hard [Hard::new("no-area", "not front", &[("a", &[0.0, 0.0]), ("b", &[1.0, 1.0]), ("c", &[2.0, 2.0])])],
);
formula!(
    /// A fragment's own depth.
    FragDepth: "interpolation/frag-depth" by "interpolation_frag_depth",
    "clamp(depth, 0, 1)", "000 §6.1",
    [Input::scalar("depth", "1", Domain::Uniform(-0.5, 1.5))] -> [Output::new("depth", ValueShape::Scalar, "1")],
    |depth; out| { out.scalar(interpolation::frag_depth(depth)); },
);

/// The point between the first vertex's line and the nearer of the other two, where both edges have a scan line.
fn within_the_scanlines(_: &Spec, row: &mut [f32]) {
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
fn near_the_triangle(_: &Spec, row: &mut [f32]) {
    for k in 0..2 {
        let middle = (row[k] + row[2 + k]) * 0.5;
        let t = row[6 + k] / 64.0;
        row[6 + k] = (2.0 * (middle + (row[4 + k] - middle) * (t * 1.5 - 0.25))).round() * 0.5;
    }
}

const TWICE_AREA: Output = Output::new("edge", ValueShape::Scalar, "pixel²");
const LAST_WEIGHT: Output = Output::new("gamma", ValueShape::Scalar, "1");

formula!(
    /// The edge function.
    Edge: "interpolation/edge" by "interpolation_edge",
    "e = (b − a) × (p − a)", "000 §6.1; a vertex subtracted first",
    [window("a"), window("b"), window("p")] -> [TWICE_AREA],
    stable 8.0 Own "two exact differences, two products and a difference that does not cancel by more than 4",
    |a, b, p; out| { out.scalar(interpolation::edge(a, b, p)); },
    hard [
        Hard::new("far-1e3", "a unit triangle at 1e3", &[("a", &[1000.0, 1000.0]), ("b", &[1001.0, 1000.25]), ("p", &[1000.25, 1000.75])])
            .naive("interpolation/edge-from-origin", "six products of 1e6 cancel to 1", 1e3),
        Hard::new("far-1e4", "a unit triangle at 1e4: its sign is left to chance", &[("a", &[1e4, 1e4]), ("b", &[10001.0, 10000.25]), ("p", &[10000.25, 10000.75])])
            .naive("interpolation/edge-from-origin", "six products of 1e8 cancel to 1", 1e6),
        Hard::new("far-1e6", "a unit triangle at 1e6, where a step is 1/16", &[("a", &[1e6, 1e6]), ("b", &[1_000_001.0, 1_000_000.25]), ("p", &[1_000_000.25, 1_000_000.75])])
            .naive("interpolation/edge-from-origin", "six products of 1e12 cancel to 1", 1e8),
        Hard::new("near-a-corner", "the point is 0.02 from the vertex that the sides are taken from", &[("a", &[3.1, 2.7]), ("b", &[103.3, 47.9]), ("p", &[3.09, 2.72])]),
        Hard::new("short-side", "a side of 0.02, from one end of which the other is taken", &[("a", &[3.1, 2.7]), ("b", &[3.11, 2.72]), ("p", &[-47.3, 99.9])]),
    ],
);
formula!(
    /// The edge function from the origin.
    EdgeFromOrigin: "interpolation/edge-from-origin" by "interpolation_edge_from_origin",
    "e = a × b + b × p + p × a", "000 §6.1; no vertex subtracted",
    [window("a"), window("b"), window("p")] -> [TWICE_AREA],
    |a, b, p; out| { out.scalar(interpolation::edge_from_origin(a, b, p)); },
);
formula!(
    /// The edge function of slivers.
    EdgeCompensated: "interpolation/edge-compensated" by "interpolation_edge_compensated",
    "e = (b − a) × (p − a), a difference of products with their errors", "Cornea, Harrison & Tang 2002",
    [window("a"), window("b"), window("p")] -> [TWICE_AREA],
    stable 2.0 Own "2 roundings (Cornea, Harrison & Tang), for corners whose differences are exact: within a factor of 2 of each other, or from the origin",
    |a, b, p; out| { out.scalar(interpolation::edge_compensated(a, b, p)); },
    hard [
        Hard::new("sliver-1e-5", "the products agree to 5 digits", &[("a", &[0.0, 0.0]), ("b", &[0.7, 0.3]), ("p", &[1.4, 0.600_01])])
            .naive("interpolation/edge", "the rounding of the products is what is left", 1e3),
        Hard::new("sliver-1e-6", "the products agree to 6 digits", &[("a", &[0.0, 0.0]), ("b", &[0.7, 0.3]), ("p", &[1.4, 0.600_000_6])])
            .naive("interpolation/edge", "the rounding of the products is what is left", 1e4),
        Hard::new("sliver-of-a-few-ulp", "the products agree to the last bits", &[("a", &[0.0, 0.0]), ("b", &[0.1, 0.3]), ("p", &[0.7, 2.1])])
            .naive("interpolation/edge", "not one digit is right", 1e6),
        Hard::new("sliver-across-the-screen", "a sliver of 4,000 pixels", &[("a", &[0.0, 0.0]), ("b", &[1371.3, 2903.7]), ("p", &[2742.65, 5807.4])])
            .naive("interpolation/edge", "products of 1e7 cancel", 1e4),
    ],
);
formula!(
    /// The weight of the last vertex.
    LastWeight: "interpolation/last-weight" by "interpolation_last_weight",
    "γ = (a b p)/(a b c), an area of its own", "000 §6.1",
    [window("a"), window("b"), window("c"), window("p")] -> [LAST_WEIGHT],
    stable 16.0 Own "two areas that do not cancel, and a division of at most 2½ ULP",
    |a, b, c, p; out| { out.scalar(interpolation::last_weight([a, b, c], p)); },
    hard [
        Hard::new("near-the-edge", "a weight of 1e-4", &[("a", &[0.0, 0.0]), ("b", &[100.0, 0.0]), ("c", &[30.0, 70.0]), ("p", &[41.3, 0.007])])
            .naive("interpolation/last-weight-by-difference", "1 − α − β cancels", 500.0),
        Hard::new("at-the-edge", "a weight of 1e-6", &[("a", &[0.0, 0.0]), ("b", &[100.0, 0.0]), ("c", &[30.0, 70.0]), ("p", &[41.3, 7e-5])])
            .naive("interpolation/last-weight-by-difference", "1 − α − β cancels", 5e4),
        Hard::new("near-a-corner", "the point is 0.02 from the vertex that the sides are taken from", &[("a", &[3.1, 2.7]), ("b", &[103.3, 47.9]), ("c", &[-47.3, 99.9]), ("p", &[3.09, 2.72])]),
        Hard::new("short-side", "a side of 0.02, from one end of which the others are taken", &[("a", &[3.1, 2.7]), ("b", &[3.11, 2.72]), ("c", &[-47.3, 99.9]), ("p", &[60.3, -80.7])]),
    ],
);
formula!(
    /// The weight of the last vertex by difference.
    LastWeightByDifference: "interpolation/last-weight-by-difference" by "interpolation_last_weight_by_difference",
    "γ = 1 − α − β", "a shortcut",
    [window("a"), window("b"), window("c"), window("p")] -> [LAST_WEIGHT],
    |a, b, c, p; out| { out.scalar(interpolation::last_weight_by_difference([a, b, c], p)); },
);
formula!(
    /// Linear interpolation.
    Mix: "interpolation/mix" by "interpolation_mix",
    "attr = a(1 − t) + b·t", "WGSL, mix",
    [attr("a"), attr("b"), Input::scalar("t", "1", Domain::Unit)] -> [ATTR],
    stable 4.0 Own "two products and a sum of one sign, or of which one is 0",
    |a, b, t; out| { out.scalar(interpolation::mix(a, b, t)); },
    hard [
        Hard::new("the-end", "b itself at t = 1", &[("a", &[0.9]), ("b", &[1e-5]), ("t", &[1.0])])
            .naive("interpolation/mix-incremental", "misses b by the rounding of b − a", 1e3),
        Hard::new("the-end-of-a-great-step", "1 at the end, from 1e8", &[("a", &[1e8]), ("b", &[1.0]), ("t", &[1.0])])
            .naive("interpolation/mix-incremental", "b − a has lost b", 1e7),
        Hard::new("from-end-to-end", "from −3e38 to 3e38", &[("a", &[-3e38]), ("b", &[3e38]), ("t", &[1.0])])
            .naive("interpolation/mix-incremental", "b − a overflows", f64::INFINITY),
    ],
);
formula!(
    /// Linear interpolation by a difference.
    MixIncremental: "interpolation/mix-incremental" by "interpolation_mix_incremental",
    "attr = a + t(b − a)", "WGSL, mix, in its other form",
    [attr("a"), attr("b"), Input::scalar("t", "1", Domain::Unit)] -> [ATTR],
    |a, b, t; out| { out.scalar(interpolation::mix_incremental(a, b, t)); },
);
formula!(
    /// Perspective-correct by scaled weights.
    PerspectiveScaled: "interpolation/perspective-scaled" by "interpolation_perspective_scaled",
    "attr = Σ qᵢ·aᵢ / Σ qᵢ, qᵢ = λᵢ·(w_min/wᵢ)", "000 §6.1, with weights that are at most λ",
    [
        Input::new("lambda", ValueShape::Vec3, "1", Domain::Weights),
        Input::new("w", ValueShape::Vec3, "1", Domain::LogUniform(0.1, 100.0)),
        Input::new("attr", ValueShape::Vec3, "1", ATTRIBUTE),
    ] -> [ATTR],
    stable 24.0 Own "two divisions of at most 2½ ULP, for attributes of one sign",
    |lambda, w, attr; out| { out.scalar(interpolation::perspective_scaled(lambda, w, attr)); },
    hard [
        Hard::new("w-zero", "a vertex in the plane of the eye: all that is seen", &[("lambda", &[0.25, 0.25, 0.5]), ("w", &[0.0, 1.0, 1.0]), ("attr", &[0.75, 2.0, 1.0])])
            .naive("interpolation/perspective", "∞/∞ is NaN", f64::INFINITY),
        Hard::new("w-tiny", "1/w is 8e37", &[("lambda", &[0.5, 0.25, 0.25]), ("w", &[1.2e-38, 1.0, 1.0]), ("attr", &[50.0, 1.0, 2.0])])
            .naive("interpolation/perspective", "the numerator overflows", f64::INFINITY),
        Hard::new("w-tiny-all", "all three close to the eye's plane", &[("lambda", &[0.5, 0.25, 0.25]), ("w", &[1.2e-38, 2e-38, 3e-38]), ("attr", &[50.0, 10.0, 20.0])])
            .naive("interpolation/perspective", "the numerator overflows", f64::INFINITY),
        Hard::new("w-huge", "small attributes far away", &[("lambda", &[0.3, 0.3, 0.4]), ("w", &[8e37, 7e37, 6e37]), ("attr", &[1e-6, 2e-6, 3e-6])])
            .naive("interpolation/perspective", "λ/w and the numerator underflow", 1e4),
        Hard::new("almost-equal-w", "a w that is 9e-6 greater than the least", &[("lambda", &[0.5, 0.25, 0.25]), ("w", &[1.000_009, 1.0, 1.0]), ("attr", &[2.0, -2.0, 1.0])]),
    ],
);

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
    visitor.formula(Edge);
    visitor.formula(EdgeFromOrigin);
    visitor.formula(EdgeCompensated);
    visitor.formula(LastWeight);
    visitor.formula(LastWeightByDifference);
    visitor.formula(Mix);
    visitor.formula(MixIncremental);
    visitor.formula(PerspectiveScaled);
}
