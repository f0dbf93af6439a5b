//! Mistakes of fog.

use super::super::alteration::Form;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::Before;
use super::super::op::Op;
use super::{fault, form, given, input, output, pass, pass_as, result, swap};

pub(super) const FAULTS: &[Fault] = &[
    fault("fog-radial", "fog uses radial distance", &[&[form("distance", Form::Radial)]])
        .only(|spec| !spec.id.ends_with("-radial-scaled"))
        .seen_in("OpenGL drivers; Unity; o3"),
    fault("fog-planar", "fog uses planar distance", &[&[form("distance", Form::Planar)]])
        .seen_in("three.js; OpenGL drivers"),
    fault("fog-signed-depth", "fog uses z with its sign", &[&[form("distance", Form::SignedDepth)]])
        .only(|spec| !spec.id.contains("exp2")),
    fault("fog-smoothstep", "linear fog is smoothed by smoothstep", &[&[result("f", Op::Smoothstep)]])
        .only(|spec| spec.id.starts_with("fog/linear"))
        .seen_in("three.js, Fog"),
    fault("fog-from-the-eye", "linear fog begins at the eye", &[&[given("f", "dmin", Op::Set(0.0))]]),
    fault(
        "fog-ends-exchanged",
        "the near and far ends of linear fog are exchanged",
        &[&[Before(In::Swap("dmin", "dmax"))]],
    ),
    fault(
        "fog-exp-for-exp2",
        "fog is exponential where it is to be exponential-squared",
        &[&[form("f", Form::FogExp)]],
    )
    .only(|spec| spec.id.contains("exp2")),
    fault("fog-exp2-opengl", "fog is exp(−(density·distance)²), OpenGL's form", &[&[form("f", Form::FogExp2OpenGl)]])
        .seen_in("OpenGL; three.js, FogExp2"),
    fault(
        "fog-exp2-document",
        "fog is exp(−density·distance²), document 000's form",
        &[&[form("f", Form::FogExp2Document)]],
    ),
    fault(
        "fog-base-two",
        "fog is a power of 2 where it is to be one of e",
        &[&[pass_as("exp", "exponent", Op::Exp2)], &[input("density", Op::Scale(std::f64::consts::LN_2))]],
    )
    .seen_in("exp2 without its factor of log₂ e"),
    fault(
        "fog-inverted",
        "the fog factor is inverted",
        &[&[result("f", Op::OneMinus)], &[output("opacity", Op::OneMinus)]],
    )
    .only(|spec| spec.family() == "fog"),
    fault("fog-unclamped", "the fog factor is not clamped", &[&[pass("clamp", "f")]]),
    fault(
        "fog-clamped-above",
        "the fog factor is limited to 1 and not held above 0",
        &[&[pass_as("clamp", "f", Op::AtMost(1.0))]],
    )
    .only(|spec| spec.id.starts_with("fog/linear")),
    fault(
        "fog-clamped-below",
        "the fog factor is held above 0 and not limited to 1",
        &[&[pass_as("clamp", "f", Op::AtLeast(0.0))]],
    )
    .only(|spec| spec.id.starts_with("fog/linear")),
    fault(
        "fog-not-turned",
        "linear fog is a step where dmax lies before dmin, where it is to be turned round",
        &[&[form("f", Form::FogNotTurned)]],
    ),
    fault(
        "fog-step-beyond",
        "where dmin and dmax are the same, fog begins beyond that distance and not at it",
        &[&[form("f", Form::FogStepBeyond)]],
    )
    .seen_in("step(distance, dmax)"),
    fault(
        "fog-of-a-clamped-color",
        "the surface's colour is clamped to [0, 1] before the fog is mixed in",
        &[&[given("color", "shaded", Op::Clamp)]],
    )
    .seen_in("OpenGL's fixed function"),
    fault(
        "fog-by-complement",
        "the fog factor is 1 − (1 − f), which loses a small one",
        &[&[result("f", Op::Complement)]],
    )
    .seen_in("three.js, FogExp2"),
    fault("fog-mixed-the-wrong-way", "fog and surface are exchanged in the mix", &[&[swap("color", "fog", "shaded")]]),
    fault("fog-added", "the fog's colour is added to the surface's", &[&[form("color", Form::FogAdded)]]),
    fault("fog-not-applied", "the fog is not applied to the colour", &[&[pass("color", "shaded")]]),
    fault("fog-rational", "fog is 1/(1 + density·distance) for an exponential", &[&[form("f", Form::FogRational)]]),
    fault("fog-exp-by-quadratic", "fog's exponential is 1/(1 + x + x²/2)", &[&[form("exp", Form::ExpByQuadratic)]]),
    fault("fog-factor-one", "the fog factor is 1 throughout: there is no fog", &[&[result("f", Op::Set(1.0))]]),
    fault(
        "fog-factor-zero",
        "the fog factor is 0 throughout: there is nothing but fog",
        &[&[result("f", Op::Set(0.0))]],
    ),
    fault(
        "fog-exponent-positive",
        "the sign of fog's exponent is lost, so that the factor is 1 throughout",
        &[&[given("exp", "exponent", Op::Negate)]],
    )
    .seen_in("exp((−d)²); MicrosoftDocs/win32, PR 1904"),
    fault(
        "fog-density-squared",
        "the fog's density is squared, and its distance is not",
        &[&[given("f", "density", Op::Square)]],
    )
    .only(|spec| !spec.id.contains("exp2"))
    .seen_in("OpenGL's squared form written for the plain one"),
    fault("fog-twice", "the fog's factor is squared", &[&[result("f", Op::Square)]]),
    fault(
        "fog-to-black",
        "the fog's colour is forgotten: surfaces fade to black",
        &[&[form("color", Form::FogToBlack)]],
    )
    .seen_in("fog under additive blending; Godot, issue 104427"),
    fault("fog-factor-in-8-bits", "the fog's factor is rounded to whole 255ths", &[&[result("f", Op::Bytes)]])
        .seen_in("a factor in a vertex colour's alpha"),
    fault(
        "fog-mixed-in-8-bits",
        "the fog's factor is rounded to whole 255ths before the mix",
        &[&[given("color", "f", Op::Bytes)]],
    ),
    fault(
        "fog-in-encoded-space",
        "fog and surface are mixed as sRGB",
        &[&[
            result("color", Op::Rgb(&Op::Decode)),
            given("color", "fog", Op::Rgb(&Op::Encode)),
            given("color", "shaded", Op::Rgb(&Op::Encode)),
        ]],
    )
    .seen_in("three.js, issue 26208"),
    fault(
        "fog-color-decoded",
        "the fog's colour is decoded as if it were sRGB",
        &[&[input("fog", Op::Rgb(&Op::Decode))]],
    ),
    fault("fog-of-squared-distance", "fog is given the squared distance", &[&[given("f", "distance", Op::Square)]]),
    fault(
        "fog-negated-depth",
        "fog uses −z for |z|, which differs behind the eye",
        &[&[form("distance", Form::NegatedDepth)]],
    )
    .seen_in("three.js, vFogDepth"),
];
