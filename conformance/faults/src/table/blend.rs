//! Mistakes of blending.

use super::super::blend::Twist as Blended;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::Before;
use super::super::op::Op;
use super::{blended, colors, fault, input, where_colors_are_drawn};
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_scene::blend::{Factor, WriteMask};

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "blend-factors-exchanged",
        "the source's and the destination's factors are exchanged",
        &[&[blended(Blended::FactorsExchanged)]],
    ),
    fault(
        "blend-operands-reversed",
        "the operands of the subtraction are reversed",
        &[&[blended(Blended::OperandsReversed)], &[Before(In::Swap("src", "dst")), Before(In::Swap("s", "d"))]],
    ),
    fault(
        "blend-always-adds",
        "products are added where they are to be subtracted",
        &[&[blended(Blended::AlwaysAdd)], &[input("dst", Op::Negate)]],
    )
    .only(|spec| {
        spec.id.starts_with("blend/sub") || spec.id.starts_with("blend/rev") || spec.id.starts_with("blend/sep")
    }),
    fault("blend-min-for-max", "minimum and maximum are exchanged", &[&[blended(Blended::MinForMax)]]),
    fault(
        "factors-in-min-and-max",
        "MIN and MAX multiply by their factors",
        &[&[Before(In::Times("src", "constant"))]],
    )
    .only(|spec| spec.id.ends_with("-factors-ignored")),
    fault(
        "constant-alpha-for-color",
        "factors read the constant's alpha where they are to read its colour",
        &[&[blended(Blended::ConstantAlphaForColor)]],
    ),
    fault(
        "constant-color-for-alpha",
        "factors read the constant's colour where they are to read its alpha",
        &[&[blended(Blended::ConstantColorForAlpha)]],
    ),
    fault(
        "one-minus-forgotten",
        "1 − is forgotten in the destination's factor",
        &[&[blended(Blended::OneMinusForgotten)]],
    ),
    fault(
        "one-minus-forgotten-in-source",
        "1 − is forgotten in the source's factor",
        &[&[blended(Blended::OneMinusForgottenInSource)]],
    ),
    fault(
        "blended-as-premultiplied",
        "the source is blended as if it were premultiplied, by ONE for SRC_ALPHA",
        &[&[blended(Blended::AsPremultiplied)]],
    )
    .seen_in("three.js, premultipliedAlpha"),
    fault(
        "source-for-destination",
        "factors read the source where they are to read the destination",
        &[&[blended(Blended::SourceForDestination)]],
    ),
    fault(
        "destination-for-source",
        "factors read the destination where they are to read the source",
        &[&[blended(Blended::DestinationForSource)]],
    ),
    fault(
        "alpha-for-color",
        "factors read alpha where they are to read the colour",
        &[&[blended(Blended::AlphaForColor)]],
    ),
    fault(
        "color-for-alpha",
        "factors read the colour where they are to read alpha",
        &[&[blended(Blended::ColorForAlpha)]],
    ),
    fault(
        "source-premultiplied-too",
        "the source is multiplied by its alpha before it is blended",
        &[&[input("src", Op::Premultiply)]],
    )
    .only(where_source_color_counts),
    fault(
        "multiplied-by-coverage",
        "what is multiplied by shows through as far as the source's alpha is below 1",
        &[&[input("src", Op::Premultiply), blended(Blended::MultipliedByCoverage)]],
    )
    .seen_in("three.js, MultiplyBlending"),
    fault("saturate-not-saturated", "SRC_ALPHA_SATURATE is SRC_ALPHA", &[&[blended(Blended::NotSaturated)]]),
    fault(
        "saturate-by-source-alpha",
        "SRC_ALPHA_SATURATE saturates by the source's own alpha",
        &[&[blended(Blended::SaturatedBySource)]],
    )
    .seen_in("document 000"),
    fault(
        "alpha-blended-like-color",
        "alpha is blended by the state of the colour",
        &[&[blended(Blended::AlphaByTheColorsState)]],
    ),
    fault("alpha-replaced", "the source's alpha replaces the destination's", &[&[blended(Blended::AlphaReplaced)]]),
    fault("alpha-kept", "the destination's alpha is kept", &[&[blended(Blended::AlphaKept)]]),
    fault("write-mask-ignored", "the write mask is ignored", &[&[blended(Blended::MaskIgnored)]]),
    fault("not-blended", "the source replaces what is there", &[&[blended(Blended::NotBlended)]]),
    fault("blend-clamped", "operands and result are clamped to [0, 1]", &[&[blended(Blended::Clamped)]])
        .only(where_blending_goes_beyond),
    fault(
        "nothing-without-alpha",
        "what has an alpha of 0 or less is not drawn at all",
        &[&[blended(Blended::NothingWithoutAlpha)]],
    )
    .seen_in("VTK, vtkPolyDataFS.glsl; alpha tests left on"),
    fault(
        "last-layer-alone",
        "only the last layer is blended with what is there",
        &[&[blended(Blended::LastLayerAlone)]],
    ),
    fault("layers-reversed", "layers are drawn in reverse", &[&[blended(Blended::LayersReversed)]])
        .seen_in("transparent objects sorted front to back"),
    fault("opacity-not-raised", "many layers hide as one does", &[&[input("layers", Op::Set(1.0))]]),
    fault(
        "unpremultiplied-again",
        "the colour is multiplied by alpha where it is to be divided",
        &[&[input("alpha", Op::Reciprocal)]],
    )
    .only(|spec| spec.id.starts_with("blend/unpremultiply")),
    fault("write-mask-red-blue", "red and blue are exchanged in the write mask", &[&[blended(Blended::MaskRedBlue)]])
        .seen_in("Ryujinx, PR 2087"),
    fault(
        "saturate-in-alpha-too",
        "SRC_ALPHA_SATURATE is min(As, 1 − Ad) in alpha too, where it is 1",
        &[&[blended(Blended::SaturatedInAlpha)]],
    )
    .seen_in("bgfx, PR 3891"),
    fault(
        "source-in-8-bits",
        "the source is rounded to whole 255ths before it is blended",
        &[&[input("src", Op::Bytes)]],
    )
    .only(where_source_color_counts)
    .seen_in("PCSX2, PR 6809"),
    fault("blend-constant-clamped", "the blend constant is clamped to [0, 1]", &[&[input("constant", Op::Clamp)]])
        .only(|spec| matches!(spec.kind, Kind::Blend(Program::Draw(..))))
        .seen_in("Adreno; KhronosGroup/WebGL, PR 3464"),
    fault(
        "blended-in-encoded-space",
        "source and destination are blended as sRGB",
        &[&[input("src", Op::Rgb(&Op::Encode)), input("dst", Op::Rgb(&Op::Encode)), colors(Op::Rgb(&Op::Decode))]],
    )
    .only(|spec| spec.id.starts_with("blend/mode-") || spec.id.starts_with("blend/over"))
    .seen_in("imgui, issue 578"),
    fault("blended-and-cut", "what is blended is cut to whole 255ths, and not limited to 1", &[&[colors(Op::Cut)]])
        .only(|spec| spec.id.starts_with("blend/over") || spec.id.starts_with("blend/mode-")),
];

/// Draws whose colour depends on the source's.
fn where_source_color_counts(spec: &Spec) -> bool {
    match spec.kind {
        Kind::Blend(Program::Draw(state, mask)) => {
            let of = state.color;
            let reads = |factor: Factor| matches!(factor, Factor::SrcColor | Factor::OneMinusSrcColor);
            mask == WriteMask::ALL && (of.equation.ignores_factors() || of.src != Factor::Zero || reads(of.dst))
        }
        Kind::Blend(_) => true,
        _ => spec.id == "blend/over" || spec.id == "blend/over-incremental",
    }
}

/// Draws of operands beyond [0, 1].
fn where_blending_goes_beyond(spec: &Spec) -> bool {
    match spec.kind {
        Kind::Blend(Program::Draw(..)) => where_colors_are_drawn(spec),
        _ => false,
    }
}
