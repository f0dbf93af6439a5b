//! Mistakes of interpolation, coverage and the viewport.

use super::super::body::Body as Wrong;
use super::super::change::After as Out;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{After, Before, Body, Instead};
use super::fault;
use lightmeter_catalogue::cases::{Kind, Spec};

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "linear-for-perspective",
        "attributes are interpolated linearly for perspective",
        &[&[Body(Wrong::LinearForPerspective)], &[After(Out::Copy("linear", "perspective"))]],
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
        &[&[Body(Wrong::MultipliedByW)]],
    ),
    fault(
        "perspective-not-renormalised",
        "a/w is not divided by the interpolated 1/w",
        &[&[Body(Wrong::NotRenormalised)]],
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
        &[&[Before(In::Rotate("weights"))], &[Before(In::Rotate("lambda"))]],
    ),
    fault(
        "weights-unsigned",
        "the weights of a point are areas without their sign",
        &[&[Body(Wrong::UnsignedWeights)]],
    ),
    fault("weights-twice", "the weights are twice the areas over the whole", &[&[Body(Wrong::WeightsTwice)]]),
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
    fault("every-edge-covers", "points on any edge are covered", &[&[Body(Wrong::EveryEdge)]]),
    fault("no-edge-covers", "points on edges are not covered", &[&[Body(Wrong::NoEdge)]]),
    fault("always-front", "every triangle is front facing", &[&[Body(Wrong::FrontAlways)]]),
    fault("image-upside-down", "the image is upside down", &[&[Body(Wrong::UpsideDown)]])
        .seen_in("OpenGL's origin for WebGPU's"),
    fault("position-from-below", "a fragment's position counts from the lower edge", &[&[After(Out::FromBelow)]])
        .seen_in("gl_FragCoord"),
    fault("depth-range", "depth is taken from [−1, 1] for [0, 1], or the reverse", &[&[Body(Wrong::DepthRange)]])
        .seen_in("OpenGL's clip space in WebGPU, and the reverse"),
    fault(
        "half-pixel-offset",
        "everything is half a pixel off",
        &[&[Before(In::Offset("p", 0.5))], &[Before(In::Offset("pixel", 0.5))], &[Before(In::Offset("origin", 0.5))]],
    )
    .only(where_half_a_pixel_shows)
    .seen_in("Direct3D 9"),
    fault(
        "other-clip-volume",
        "the clip volume is the other convention's",
        &[&[Instead(&[
            ("interpolation/clip-volume", "interpolation/clip-volume-opengl"),
            ("interpolation/clip-volume-opengl", "interpolation/clip-volume"),
        ])]],
    ),
    fault("no-far-plane", "nothing is clipped at the far plane", &[&[Body(Wrong::NoFarPlane)]])
        .seen_in("depth clamping left on"),
    fault("one-step-too-many", "forward differences take a step too many", &[&[Body(Wrong::OneStepTooMany)]]),
    fault(
        "scanline-of-the-other-edge",
        "the second and the third vertex are exchanged, not their attributes",
        &[&[Before(In::Swap("v2", "v3"))]],
    ),
];

/// What a rasteriser covers half a pixel away is mostly the same, as its cases leave room for where it snaps.
fn where_half_a_pixel_shows(spec: &Spec) -> bool {
    let is_raster = matches!(spec.kind, Kind::Raster(_));
    let shows = ["interpolation/raster-attributes", "interpolation/raster-position", "interpolation/raster-top-left"];
    spec.family() == "interpolation" && (!is_raster || shows.contains(&spec.id.as_str()))
}
