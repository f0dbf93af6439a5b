//! Mistakes of attenuation and spotlights.

use super::super::alteration::Form;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{Before, Instead};
use super::super::op::Op;
use super::{fault, form, given, input, pass, result, times};

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "attenuation-terms-swapped",
        "the linear and quadratic terms of attenuation are swapped",
        &[&[Before(In::Swap("kl", "kq"))]],
    ),
    fault(
        "attenuation-constant-missing",
        "the constant term of attenuation is missing",
        &[&[input("kc", Op::Set(0.0))]],
    ),
    fault("attenuation-linear-missing", "the linear term of attenuation is missing", &[&[input("kl", Op::Set(0.0))]]),
    fault(
        "attenuation-quadratic-missing",
        "the quadratic term of attenuation is missing",
        &[&[input("kq", Op::Set(0.0))]],
    ),
    fault(
        "inverse-square-only",
        "the light falls off as 1/d² whatever the coefficients",
        &[
            &[input("kc", Op::Set(0.0)), input("kl", Op::Set(0.0)), input("kq", Op::Set(1.0))],
            &[Instead(&[("attenuation/linear", "attenuation/square")])],
        ],
    )
    .seen_in("three.js, decay 2; Filament"),
    fault(
        "inverse-distance-only",
        "the light falls off as 1/d whatever the coefficients",
        &[
            &[input("kc", Op::Set(0.0)), input("kl", Op::Set(1.0)), input("kq", Op::Set(0.0))],
            &[Instead(&[("attenuation/square", "attenuation/linear")])],
        ],
    ),
    fault(
        "attenuation-by-squared-distance",
        "attenuation is given the squared distance",
        &[&[given("atten", "d", Op::Square)]],
    )
    .only(|spec| spec.id != "attenuation/constant")
    .seen_in("dot(d, d) for length(d)"),
    fault(
        "attenuation-not-inverted",
        "the light is multiplied by the polynomial it is to be divided by",
        &[&[form("atten", Form::NotInverted)]],
    )
    .only(|spec| spec.id != "attenuation/constant"),
    fault(
        "constant-alone-inverted",
        "attenuation is 1/kc + kl·d + kq·d²: the parentheses around the divisor are missing",
        &[&[form("atten", Form::ConstantInverted)]],
    )
    .only(|spec| spec.id != "attenuation/constant"),
    fault("attenuation-at-most-one", "attenuation is limited to 1", &[&[result("atten", Op::AtMost(1.0))]])
        .only(|spec| spec.id != "attenuation/constant"),
    fault(
        "linear-divisor-floored",
        "the distance that light is divided by is held above 0.01",
        &[&[input("d", Op::AtLeast(0.01))]],
    )
    .only(|spec| spec.id == "attenuation/linear")
    .seen_in("three.js, decay 1"),
    fault(
        "square-divisor-floored",
        "the squared distance that light is divided by is held above 0.01",
        &[&[input("d", Op::AtLeast(0.1))]],
    )
    .only(|spec| spec.id == "attenuation/square")
    .seen_in("three.js, decay 2"),
    fault("not-attenuated", "the light is not attenuated", &[&[result("atten", Op::Set(1.0))]])
        .only(|spec| spec.id != "attenuation/constant"),
    fault(
        "attenuated-all-the-same",
        "a light is attenuated that is not to be",
        &[&[Instead(&[("attenuation/constant", "attenuation/linear")])]],
    ),
    fault("distance-from-the-eye", "attenuation takes the distance from the eye", &[&[input("light", Op::Set(0.0))]])
        .only(|spec| spec.family() == "attenuation"),
    fault("ambient-attenuated", "attenuation is applied to the ambient term", &[&[times("CA", "atten")]])
        .only(|spec| spec.id != "lighting/point-opengl")
        .seen_in("OpenGL's fixed function"),
    fault("ambient-not-attenuated", "the ambient term is not attenuated", &[&[given("CA", "atten", Op::Set(1.0))]]),
    fault("diffuse-not-attenuated", "the diffuse term is not attenuated", &[&[given("CD", "atten", Op::Set(1.0))]]),
    fault("specular-not-attenuated", "the highlight is not attenuated", &[&[given("CS", "atten", Op::Set(1.0))]]),
    fault("cutoff-by-sine", "the spotlight's cutoff is compared by its sine", &[&[input("cutoff_cosine", Op::Sine)]]),
    fault(
        "cutoff-halved",
        "the spotlight's cutoff is taken as the whole cone's angle, and halved",
        &[&[input("cutoff_cosine", Op::HalfAngle)]],
    ),
    fault(
        "cutoff-doubled",
        "the spotlight's cone is twice as wide as was asked",
        &[&[input("cutoff_cosine", Op::DoubleAngle)]],
    ),
    fault("spot-exponent-ignored", "the spotlight's exponent is ignored", &[&[input("exponent", Op::Set(0.0))]])
        .only(|spec| spec.place("cutoff_cosine").is_some())
        .seen_in("three.js and most engines"),
    fault(
        "spot-exponent-at-least-1",
        "the spotlight's exponent is at least 1",
        &[&[given("spot", "exponent", Op::AtLeast(1.0))]],
    ),
    fault("spot-axis-reversed", "the spotlight's axis is reversed", &[&[input("axis", Op::Negate)]]),
    fault("no-cone", "the spotlight shines all round", &[&[result("spot", Op::Set(1.0))]]),
    fault("no-cutoff", "the spotlight has no cutoff", &[&[given("spot", "cutoff_cosine", Op::Set(-2.0))]]),
    fault(
        "smooth-cone",
        "the spotlight's edge is smoothed by smoothstep, in the place of its exponent",
        &[&[form("spot", Form::SmoothConeAlone)]],
    )
    .seen_in("three.js, penumbra 1"),
    fault("specular-not-in-cone", "the highlight is not kept within the cone", &[&[given("CS", "cone", Op::Set(1.0))]]),
    fault("axis-not-normalised", "the spotlight's axis is not normalised", &[&[pass("axis", "axis")]]),
    fault(
        "attenuation-quadratic-of-distance",
        "the quadratic term is kq·d for kq·d²",
        &[&[form("atten", Form::QuadraticOfDistance)]],
    ),
    fault(
        "attenuation-quadratic-squared",
        "the quadratic term is (kq·d)² for kq·d²",
        &[&[form("atten", Form::QuadraticOfProduct)]],
    ),
    fault(
        "attenuation-plus-one",
        "1 is added to what attenuation divides by",
        &[&[given("atten", "kc", Op::Offset(1.0))]],
    )
    .seen_in("PlayCanvas; (1 + d²) that never divides by 0"),
    fault("attenuated-twice", "the light is attenuated twice", &[&[result("atten", Op::Square)]]),
    fault("attenuation-rooted", "attenuation is its own square root", &[&[result("atten", Op::Root)]]),
    fault(
        "smooth-cone-with-power",
        "the spotlight's edge is smoothed by smoothstep, beside its exponent",
        &[&[form("spot", Form::SmoothCone)]],
    ),
    fault(
        "linear-cone",
        "the spotlight fades by a straight line from its axis to its edge, beside its exponent",
        &[&[form("spot", Form::LinearCone)]],
    ),
    fault(
        "linear-cone-power",
        "the spotlight's power is of the cosine rescaled from its edge to its axis",
        &[&[form("spot", Form::RescaledCone)]],
    )
    .only(|spec| spec.id != "attenuation/spot-cutoff")
    .seen_in("Direct3D's penumbra; Ogre"),
    fault(
        "cosine-clamped-before-the-cutoff",
        "the spotlight's cosine is clamped before it is compared: a cutoff beyond 90° lights everything",
        &[&[given("spot", "cosine", Op::AtLeast(0.0))]],
    )
    .seen_in("Babylon.js"),
    fault(
        "cutoff-at-most-90",
        "a cutoff beyond 90° is taken for 90°",
        &[&[given("spot", "cutoff_cosine", Op::AtLeast(0.0))]],
    ),
    fault(
        "cutoff-of-90",
        "the spotlight's cutoff is 90° whatever was asked",
        &[&[given("spot", "cutoff_cosine", Op::Set(0.0))]],
    ),
    fault("cutoff-squared", "the cutoff's cosine is squared", &[&[given("spot", "cutoff_cosine", Op::Square)]]),
    fault(
        "cone-without-its-edge",
        "what lies on the edge of the spotlight's cone is not lit",
        &[&[form("spot", Form::ConeWithoutEdge)]],
    )
    .seen_in("> for ≥; three.js"),
    fault(
        "cone-turned",
        "the spotlight shines outside of its cone and not inside: the comparison is turned round",
        &[&[form("spot", Form::ConeTurned)]],
    )
    .seen_in("cosine < cutoff for cosine ≥ cutoff"),
];
