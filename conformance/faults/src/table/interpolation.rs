//! Mistakes of interpolation, coverage and the viewport.

use super::super::alteration::Form;
use super::super::change::After as Out;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{After, Before, Instead};
use super::super::op::Op;
use super::{fault, form, given, input, pass, plus, result};
use lightmeter_catalogue::cases::{Kind, Spec};

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "linear-for-perspective",
        "attributes are interpolated linearly for perspective",
        &[
            &[given("perspective", "w", Op::Set(1.0))],
            &[given("perspective along a line", "w", Op::Set(1.0))],
            &[After(Out::Copy("linear", "perspective"))],
        ],
    )
    .seen_in("affine texture mapping; noperspective"),
    fault(
        "perspective-for-linear",
        "attributes are perspective-correct where they are to be linear",
        &[&[After(Out::Copy("perspective", "linear"))]],
    ),
    fault(
        "multiplied-by-w",
        "attributes are multiplied by w where they are to be divided",
        &[&[given("perspective", "w", Op::Reciprocal)], &[given("perspective along a line", "w", Op::Reciprocal)]],
    ),
    fault(
        "perspective-not-renormalised",
        "a/w is not divided by the interpolated 1/w",
        &[&[pass("over the interpolated 1/w", "over_w")]],
    ),
    fault(
        "ends-exchanged",
        "the ends of an interpolation are exchanged",
        &[
            &[Before(In::Swap("pa", "pb")), Before(In::Swap("na", "nb"))],
            &[Before(In::Swap("n0", "n1"))],
            &[Before(In::Swap("attr_a", "attr_b"))],
            &[Before(In::Swap("a", "b"))],
        ],
    )
    .only(|spec| {
        let id = spec.id.as_str();
        ["lighting/gouraud", "lighting/phong-shading", "lighting/phong-interpolated", "vector/interpolated-normal"]
            .contains(&id)
            || ["interpolation/mix", "interpolation/line", "interpolation/forward", "interpolation/raster-line"]
                .iter()
                .any(|stem| id.starts_with(stem))
    }),
    fault(
        "weights-rotated",
        "weights and vertices do not go together",
        &[&[input("weights", Op::Rotate)], &[input("lambda", Op::Rotate)]],
    ),
    fault("weights-unsigned", "the weights of a point are areas without their sign", &[&[result("weight", Op::Abs)]]),
    fault("weights-twice", "the weights are twice the areas over the whole", &[&[result("weight", Op::Scale(2.0))]]),
    fault(
        "provoking-vertex",
        "a flat attribute is taken from the other provoking vertex",
        &[&[Instead(&[
            ("*flat-first", "*flat-last"),
            ("*flat-last", "*flat-first"),
            ("*-first", "*-last"),
            ("*-last", "*-first"),
        ])]],
    )
    .only(|spec| !spec.id.contains("flat-point"))
    .seen_in("OpenGL's last vertex for Vulkan's first"),
    fault("every-edge-covers", "points on any edge are covered", &[&[result("share of an edge", Op::Set(1.0))]]),
    fault(
        "edges-of-the-lower-right",
        "points on lower and right edges are covered, where those on upper and left ones are to be",
        &[&[given("share of an edge", "ab", Op::Negate)]],
    )
    .seen_in("a y axis that points up"),
    fault("no-edge-covers", "points on edges are not covered", &[&[result("share of an edge", Op::Set(0.0))]]),
    fault("always-front", "every triangle is front facing", &[&[result("front", Op::Set(1.0))]]),
    fault(
        "image-upside-down",
        "the image is upside down",
        &[&[form("window", Form::UpsideDown)], &[form("window from below", Form::UpsideDown)]],
    )
    .seen_in("OpenGL's origin for WebGPU's"),
    fault("position-from-below", "a fragment's position counts from the lower edge", &[&[After(Out::FromBelow)]])
        .seen_in("gl_FragCoord"),
    fault(
        "depth-range",
        "the depth ranges [−1, 1] and [0, 1] are confused",
        &[
            &[form("window", Form::DepthRange)],
            &[form("window from below", Form::DepthRange)],
            &[input("a", Op::FromMinusOne), input("b", Op::FromMinusOne), input("c", Op::FromMinusOne)],
        ],
    )
    .only(|spec| !matches!(spec.kind, Kind::Raster(_)) || spec.id == "interpolation/raster-clip")
    .seen_in("OpenGL's clip space in WebGPU, and the reverse"),
    fault(
        "half-pixel-offset",
        "everything lies half a pixel too far along x and y, as if pixels were sampled at the corner where both are least",
        &[&[input("p", Op::Offset(-0.5))], &[input("pixel", Op::Offset(-0.5))], &[input("origin", Op::Offset(0.5))]],
    )
    .only(where_half_a_pixel_shows)
    .seen_in("Direct3D 9"),
    fault(
        "half-pixel-offset-reversed",
        "everything lies half a pixel short along x and y, as if pixels were sampled at the corner where both are greatest",
        &[&[input("p", Op::Offset(0.5))], &[input("pixel", Op::Offset(0.5))], &[input("origin", Op::Offset(-0.5))]],
    )
    .only(where_half_a_pixel_shows)
    .seen_in("corrections for Direct3D 9 that are kept elsewhere"),
    fault(
        "other-clip-volume",
        "the clip volume is the other convention's",
        &[&[Instead(&[
            ("interpolation/clip-volume", "interpolation/clip-volume-opengl"),
            ("interpolation/clip-volume-opengl", "interpolation/clip-volume"),
        ])]],
    ),
    fault("no-far-plane", "nothing is clipped at the far plane", &[&[pass("before the far plane", "inside")]])
        .seen_in("depth clamping left on"),
    fault(
        "near-plane-outside",
        "what lies in the near plane is clipped",
        &[&[form("before the far plane", Form::NearPlaneOutside)]],
    )
    .seen_in("0 < z for 0 ≤ z"),
    fault(
        "far-plane-outside",
        "what lies in the far plane is clipped",
        &[&[form("before the far plane", Form::FarPlaneOutside)]],
    )
    .seen_in("z < w for z ≤ w"),
    fault("one-step-too-many", "forward differences take a step too many", &[&[plus("end", "step")]]),
    fault(
        "scanline-of-the-other-edge",
        "the second and the third vertex are exchanged, not their attributes",
        &[&[Before(In::Swap("v2", "v3"))]],
    ),
    fault(
        "last-attributes-exchanged",
        "the last two vertices' attributes are exchanged",
        &[&[input("attr", Op::SwapLast)]],
    )
    .only(|spec| matches!(spec.kind, Kind::Arithmetic)),
    fault(
        "culled-by-the-other-winding",
        "the other side of a triangle is culled",
        &[&[Instead(&[
            ("interpolation/cull-back-ccw", "interpolation/cull-back-cw"),
            ("interpolation/cull-back-cw", "interpolation/cull-back-ccw"),
            ("interpolation/cull-front-ccw", "interpolation/cull-front-cw"),
            ("interpolation/cull-front-cw", "interpolation/cull-front-ccw"),
        ])]],
    )
    .seen_in("clockwise front faces; a mirrored projection"),
];

/// What a rasteriser covers half a pixel away is mostly the same, as its cases leave room for where it snaps.
fn where_half_a_pixel_shows(spec: &Spec) -> bool {
    let is_raster = matches!(spec.kind, Kind::Raster(_));
    let shows = ["interpolation/raster-attributes", "interpolation/raster-position", "interpolation/raster-top-left"];
    spec.family() == "interpolation" && (!is_raster || shows.contains(&spec.id.as_str()))
}
