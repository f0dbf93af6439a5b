//! Mistakes of attenuation and spotlights.

use super::super::body::Body as Wrong;
use super::super::change::After as Out;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{After, Before, Body, Instead};
use super::super::lighting::Twist as Lit;
use super::{fault, lit};

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "attenuation-terms-swapped",
        "the linear and quadratic terms of attenuation are swapped",
        &[&[Before(In::Swap("kl", "kq"))]],
    ),
    fault(
        "attenuation-constant-missing",
        "the constant term of attenuation is missing",
        &[&[Before(In::Set("kc", 0.0))]],
    ),
    fault("attenuation-linear-missing", "the linear term of attenuation is missing", &[&[Before(In::Set("kl", 0.0))]]),
    fault(
        "attenuation-quadratic-missing",
        "the quadratic term of attenuation is missing",
        &[&[Before(In::Set("kq", 0.0))]],
    ),
    fault(
        "inverse-square-only",
        "the light falls off as 1/d² whatever the coefficients",
        &[
            &[Before(In::Set("kc", 0.0)), Before(In::Set("kl", 0.0)), Before(In::Set("kq", 1.0))],
            &[Instead(&[("attenuation/linear", "attenuation/square")])],
        ],
    )
    .seen_in("three.js, decay 2; Filament"),
    fault(
        "inverse-distance-only",
        "the light falls off as 1/d whatever the coefficients",
        &[
            &[Before(In::Set("kc", 0.0)), Before(In::Set("kl", 1.0)), Before(In::Set("kq", 0.0))],
            &[Instead(&[("attenuation/square", "attenuation/linear")])],
        ],
    ),
    fault(
        "attenuation-by-squared-distance",
        "attenuation is given the squared distance",
        &[&[lit(Lit::DistanceSquaredTwice)], &[Body(Wrong::DistanceSquared)], &[Before(In::Square("d"))]],
    )
    .only(|spec| spec.id != "attenuation/constant")
    .seen_in("dot(d, d) for length(d)"),
    fault(
        "attenuation-not-inverted",
        "the light is multiplied by the polynomial it is to be divided by",
        &[&[lit(Lit::AttenuationNotInverted)], &[Body(Wrong::NotInverted)], &[After(Out::Reciprocal("atten"))]],
    )
    .only(|spec| spec.id != "attenuation/constant"),
    fault(
        "attenuation-at-most-one",
        "attenuation is limited to 1",
        &[&[lit(Lit::AttenuationAtMostOne)], &[After(Out::AtMostOne("atten"))]],
    )
    .only(|spec| spec.id != "attenuation/constant"),
    fault(
        "linear-divisor-floored",
        "the distance that light is divided by is held above 0.01",
        &[&[Before(In::AtLeast("d", 0.01))]],
    )
    .only(|spec| spec.id == "attenuation/linear")
    .seen_in("three.js, decay 1"),
    fault(
        "square-divisor-floored",
        "the squared distance that light is divided by is held above 0.01",
        &[&[Before(In::AtLeast("d", 0.1))]],
    )
    .only(|spec| spec.id == "attenuation/square")
    .seen_in("three.js, decay 2"),
    fault(
        "not-attenuated",
        "the light is not attenuated",
        &[&[lit(Lit::NotAttenuated)], &[After(Out::Set("atten", 1.0))]],
    )
    .only(|spec| spec.id != "attenuation/constant"),
    fault(
        "attenuated-all-the-same",
        "a light is attenuated that is not to be",
        &[&[Instead(&[("attenuation/constant", "attenuation/linear")])]],
    ),
    fault("distance-from-the-eye", "attenuation takes the distance from the eye", &[&[Before(In::Set("light", 0.0))]])
        .only(|spec| spec.family() == "attenuation"),
    fault("ambient-attenuated", "attenuation is applied to the ambient term", &[&[lit(Lit::AmbientAttenuated)]])
        .seen_in("OpenGL's fixed function"),
    fault("ambient-not-attenuated", "the ambient term is not attenuated", &[&[lit(Lit::AmbientNotAttenuated)]]),
    fault("diffuse-not-attenuated", "the diffuse term is not attenuated", &[&[lit(Lit::DiffuseNotAttenuated)]]),
    fault("specular-not-attenuated", "the highlight is not attenuated", &[&[lit(Lit::SpecularNotAttenuated)]]),
    fault("cutoff-by-sine", "the spotlight's cutoff is compared by its sine", &[&[Before(In::Sine("cutoff_cosine"))]]),
    fault(
        "cutoff-halved",
        "the spotlight's cutoff is taken as the whole cone's angle",
        &[&[Before(In::HalfAngle("cutoff_cosine"))]],
    ),
    fault(
        "cutoff-doubled",
        "the spotlight's cutoff is taken as half of what was asked of the angle from the axis",
        &[&[Before(In::DoubleAngle("cutoff_cosine"))]],
    ),
    fault("spot-exponent-ignored", "the spotlight's exponent is ignored", &[&[Before(In::Set("exponent", 0.0))]])
        .only(|spec| spec.place("cutoff_cosine").is_some())
        .seen_in("three.js and most engines"),
    fault("spot-axis-reversed", "the spotlight's axis is reversed", &[&[Before(In::Negate("axis"))]]),
    fault("no-cone", "the spotlight shines all round", &[&[lit(Lit::NoCone)], &[After(Out::Set("spot", 1.0))]]),
    fault("no-cutoff", "the spotlight has no cutoff", &[&[lit(Lit::NoCutoff)], &[Body(Wrong::NoCutoff)]]),
    fault(
        "smooth-cone",
        "the spotlight's edge is smoothed by smoothstep",
        &[&[lit(Lit::SmoothCone)], &[Body(Wrong::SmoothCone)]],
    )
    .seen_in("three.js, penumbra 1"),
    fault("specular-not-in-cone", "the highlight is not kept within the cone", &[&[lit(Lit::SpecularNotInCone)]]),
];
