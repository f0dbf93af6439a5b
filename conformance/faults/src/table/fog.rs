//! Mistakes of fog.

use super::super::change::After as Out;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{After, Before};
use super::super::fog::Twist as Fogged;
use super::{fault, fogged};

pub(super) const FAULTS: &[Fault] = &[
    fault("fog-radial", "fog uses radial distance", &[&[fogged(Fogged::Radial)]]).seen_in("OpenGL drivers; Unity; o3"),
    fault("fog-planar", "fog uses planar distance", &[&[fogged(Fogged::Planar)]]).seen_in("three.js; OpenGL drivers"),
    fault("fog-signed-depth", "fog uses z with its sign", &[&[fogged(Fogged::SignedDepth)]])
        .only(|spec| !spec.id.contains("exp2")),
    fault("fog-smoothstep", "linear fog is smoothed by smoothstep", &[&[fogged(Fogged::Smoothstep)]])
        .seen_in("three.js, Fog"),
    fault("fog-from-the-eye", "linear fog begins at the eye", &[&[fogged(Fogged::FromTheEye)]]),
    fault(
        "fog-ends-exchanged",
        "the near and far ends of linear fog are exchanged",
        &[&[Before(In::Swap("dmin", "dmax"))]],
    ),
    fault("fog-exp-for-exp2", "fog is exponential where it is to be exponential-squared", &[&[fogged(Fogged::Exp)]])
        .only(|spec| spec.id.contains("exp2")),
    fault("fog-exp2-opengl", "fog is exp(−(density·distance)²), OpenGL's form", &[&[fogged(Fogged::Exp2OpenGl)]])
        .seen_in("OpenGL; three.js, FogExp2"),
    fault(
        "fog-exp2-document",
        "fog is exp(−density·distance²), document 000's form",
        &[&[fogged(Fogged::Exp2Document)]],
    ),
    fault(
        "fog-base-two",
        "fog is a power of 2 where it is to be one of e",
        &[&[fogged(Fogged::BaseTwo)], &[Before(In::Scale("density", std::f64::consts::LN_2))]],
    )
    .seen_in("exp2 without its factor of log₂ e"),
    fault(
        "fog-inverted",
        "the fog factor is inverted",
        &[&[fogged(Fogged::Inverted)], &[After(Out::OneMinus("opacity"))]],
    )
    .only(|spec| spec.family() == "fog"),
    fault("fog-unclamped", "the fog factor is not clamped", &[&[fogged(Fogged::Unclamped)]]),
    fault(
        "fog-by-complement",
        "the fog factor is 1 − (1 − f), which loses a small one",
        &[&[fogged(Fogged::ByComplement)]],
    )
    .seen_in("three.js, FogExp2"),
    fault(
        "fog-mixed-the-wrong-way",
        "fog and surface are exchanged in the mix",
        &[&[fogged(Fogged::MixedTheWrongWay)]],
    ),
    fault("fog-added", "the fog's colour is added to the surface's", &[&[fogged(Fogged::Added)]]),
    fault("fog-not-applied", "the fog is not applied to the colour", &[&[fogged(Fogged::NotApplied)]]),
];
