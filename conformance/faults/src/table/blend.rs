//! Mistakes of blending.

use super::super::blend::Twist as Blended;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::Before;
use super::{blended, fault, where_colors_are_drawn};
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
        &[&[blended(Blended::AlwaysAdd)], &[Before(In::Negate("dst"))]],
    )
    .only(|spec| {
        spec.id.starts_with("blend/sub") || spec.id.starts_with("blend/rev") || spec.id.starts_with("blend/sep")
    }),
    fault(
        "blend-min-for-max",
        "the lesser is taken for the greater, or the reverse",
        &[&[blended(Blended::MinForMax)]],
    ),
    fault(
        "factors-in-min-and-max",
        "MIN and MAX multiply by their factors",
        &[&[Before(In::Times("src", "constant"))]],
    )
    .only(|spec| spec.id.ends_with("-factors-ignored")),
    fault(
        "constant-alpha-for-color",
        "the constant's alpha stands for its colour, or the reverse",
        &[&[blended(Blended::ConstantAlphaForColor)]],
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
        "blended-as-premultiplied",
        "the source is blended as if it were premultiplied",
        &[&[blended(Blended::AsPremultiplied)]],
    )
    .seen_in("three.js, premultipliedAlpha"),
    fault(
        "source-premultiplied-too",
        "the source is multiplied by its alpha before it is blended",
        &[&[Before(In::Premultiply("src"))]],
    )
    .only(where_source_color_counts),
    fault(
        "multiplied-by-coverage",
        "what is multiplied by shows through as far as the source's alpha is below 1",
        &[&[Before(In::Premultiply("src")), blended(Blended::MultipliedByCoverage)]],
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
        "last-layer-alone",
        "only the last layer is blended with what is there",
        &[&[blended(Blended::LastLayerAlone)]],
    ),
    fault("layers-reversed", "layers are drawn in reverse", &[&[blended(Blended::LayersReversed)]])
        .seen_in("transparent objects sorted front to back"),
    fault("opacity-not-raised", "many layers hide as one does", &[&[Before(In::Set("layers", 1.0))]]),
    fault(
        "unpremultiplied-again",
        "the colour is multiplied by alpha where it is to be divided",
        &[&[Before(In::Reciprocal("alpha"))]],
    )
    .only(|spec| spec.id.starts_with("blend/unpremultiply")),
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
