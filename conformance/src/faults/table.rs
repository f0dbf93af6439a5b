//! The catalogue of mistakes.

use super::blend::Twist as Blended;
use super::body::Body as Wrong;
use super::catalogue::Fault;
use super::catalogue::Step::{self, After, Before, Body, Instead};
use super::change::After as Out;
use super::change::Before as In;
use super::fog::Twist as Fogged;
use super::lighting::Twist as Lit;
use crate::cases::blend::Program;
use crate::cases::{Kind, Spec};
use lightmeter_scene::blend::{Factor, WriteMask};

type Ways = &'static [&'static [Step]];

const fn fault(name: &'static str, says: &'static str, ways: Ways) -> Fault {
    Fault { name, says, seen_in: None, ways, only: everywhere }
}

impl Fault {
    const fn seen_in(self, seen_in: &'static str) -> Self {
        Self { seen_in: Some(seen_in), ..self }
    }

    const fn only(self, only: fn(&Spec) -> bool) -> Self {
        Self { only, ..self }
    }
}

const fn lit(twist: Lit) -> Step {
    Step::Lighting(twist)
}

const fn fogged(twist: Fogged) -> Step {
    Step::Fog(twist)
}

const fn blended(twist: Blended) -> Step {
    Step::Blend(twist)
}

const fn everywhere(_: &Spec) -> bool {
    true
}

fn in_lighting(spec: &Spec) -> bool {
    spec.family() == "lighting"
}

/// A fault of the output shows where a colour comes out that is not 0 throughout, nor kept from being written.
fn where_colors_are_drawn(spec: &Spec) -> bool {
    match spec.kind {
        Kind::Blend(Program::Draw(state, mask)) => {
            let is_zero = |s: lightmeter_scene::blend::State| {
                !s.equation.ignores_factors() && s.src == Factor::Zero && s.dst == Factor::Zero
            };
            mask == WriteMask::ALL && !is_zero(state.color)
        }
        Kind::Blend(Program::WithoutAlpha(_) | Program::Layers(_)) => true,
        _ => !is_encoded(spec),
    }
}

/// Formulas whose output is a code, or whose own fault it would be.
fn is_encoded(spec: &Spec) -> bool {
    ["color/srgb", "color/gamma", "color/from-unorm8", "blend/subtract"].iter().any(|id| spec.id.starts_with(id))
}

/// Sums that may leave [0, 1].
fn where_sums_go_beyond(spec: &Spec) -> bool {
    match spec.family() {
        "lighting" => {
            !["ambient", "diffuse-", "specular-", "highlight-"]
                .iter()
                .any(|stem| spec.id["lighting/".len()..].starts_with(stem))
                || spec.id == "lighting/ambient-constant"
        }
        _ => matches!(spec.id.as_str(), "blend/mode-add" | "blend/unpremultiply" | "blend/unpremultiply-guarded"),
    }
}

pub(super) fn all() -> impl Iterator<Item = &'static Fault> {
    [LIGHTING, ATTENUATION, FOG, OUTPUT, VECTOR, INTERPOLATION, COLOR, DEPTH, BLEND].into_iter().flatten()
}

const LIGHTING: &[Fault] = &[
    fault(
        "normal-not-normalised",
        "the normal is not normalised",
        &[&[lit(Lit::NormalNotNormalised)], &[Body(Wrong::NotNormalised)]],
    )
    .seen_in("interpolated normals used as they come"),
    fault(
        "normal-reversed",
        "the normal points the other way",
        &[&[Before(In::Negate("normal"))], &[Before(In::Negate("n"))]],
    )
    .only(|spec| !spec.id.starts_with("vector/reflect")),
    fault(
        "light-not-normalised",
        "the vector to the light is not normalised",
        &[&[lit(Lit::LightNotNormalised)], &[Body(Wrong::TowardNotNormalised)]],
    )
    .only(|spec| !matches!(spec.id.as_str(), "lighting/phong-unit-light" | "lighting/phong-nonlocal")),
    fault(
        "light-reversed",
        "the light vector is reversed",
        &[
            &[lit(Lit::LightReversed)],
            &[Before(In::Negate("l"))],
            &[Before(In::Negate("i"))],
            &[After(Out::Negate("l"))],
        ],
    )
    .seen_in("OpenGL's direction to the light for the direction of travel"),
    fault(
        "position-as-direction",
        "a positional light is taken as a direction",
        &[&[lit(Lit::PositionAsDirection)], &[Body(Wrong::TowardFromOrigin)], &[Body(Wrong::PositionAsDirection)]],
    ),
    fault(
        "direction-as-position",
        "a light's direction is taken as a position",
        &[&[lit(Lit::DirectionAsPosition)], &[Body(Wrong::DirectionAsPosition)]],
    ),
    fault("view-not-normalised", "the view vector is not normalised", &[&[lit(Lit::ViewNotNormalised)]]),
    fault("view-reversed", "the view vector is reversed", &[&[lit(Lit::ViewReversed)], &[Before(In::Negate("v"))]])
        .only(|spec| spec.family() == "lighting" || spec.id.starts_with("vector/halfway")),
    fault("viewer-at-infinity", "the viewer is taken to be at infinity", &[&[lit(Lit::ViewerAtInfinity)]])
        .seen_in("OpenGL's GL_LIGHT_MODEL_LOCAL_VIEWER left off"),
    fault(
        "reflect-with-plus",
        "reflect adds the normal's share where it takes it off",
        &[&[lit(Lit::ReflectWithPlus)], &[Body(Wrong::ReflectWithPlus)]],
    ),
    fault(
        "reflect-of-toward",
        "reflect is given the vector to the light for the direction of travel",
        &[&[lit(Lit::ReflectOfToward)], &[Before(In::Negate("r"))]],
    ),
    fault("reflect-once", "reflect takes the normal's share off once, not twice", &[&[Body(Wrong::ReflectOnce)]]),
    fault(
        "blinn-for-phong",
        "Blinn's highlight is drawn for Phong's, of the same exponent",
        &[&[lit(Lit::BlinnForPhong)]],
    )
    .seen_in("three.js, MeshPhongMaterial"),
    fault(
        "phong-for-blinn",
        "Phong's highlight is drawn for Blinn's, of the same exponent",
        &[&[lit(Lit::PhongForBlinn)]],
    ),
    fault(
        "shininess-times-4",
        "the shininess is 4 times what was asked",
        &[&[Before(In::Scale("shininess", 4.0))], &[Before(In::Scale("exponent", 4.0))]],
    )
    .only(in_lighting_powers)
    .seen_in("Blinn's exponent converted from Phong's"),
    fault(
        "shininess-over-4",
        "the shininess is a quarter of what was asked",
        &[&[Before(In::Scale("shininess", 0.25))], &[Before(In::Scale("exponent", 0.25))]],
    )
    .only(in_lighting_powers)
    .seen_in("Phong's exponent converted from Blinn's"),
    fault(
        "shininess-of-1000-as-128",
        "the shininess is rescaled from a range of 1000 to one of 128",
        &[&[Before(In::Scale("shininess", 0.128))], &[Before(In::Scale("exponent", 0.128))]],
    )
    .only(in_lighting_powers)
    .seen_in("importers of Wavefront materials for OpenGL"),
    fault(
        "shininess-ignored",
        "the shininess is ignored: the highlight is the bare cosine",
        &[&[Before(In::Set("shininess", 1.0))], &[Before(In::Set("exponent", 1.0))]],
    )
    .only(in_lighting_powers),
    fault(
        "half-vector-not-normalised",
        "the half vector is not normalised",
        &[
            &[lit(Lit::HalfNotNormalised)],
            &[Instead(&[
                ("vector/halfway", "vector/halfway-unnormalised"),
                ("vector/halfway-unguarded", "vector/halfway-unnormalised"),
            ])],
        ],
    )
    .seen_in("document 000's program"),
    fault(
        "half-vector-normalised",
        "the half vector is normalised where it is not to be",
        &[&[lit(Lit::HalfNormalised)], &[Instead(&[("vector/halfway-unnormalised", "vector/halfway")])]],
    ),
    fault("half-vector-as-mean", "the half vector is the mean (v + l)/2", &[&[Body(Wrong::HalfwayAsMean)]]),
    fault("incidence-unclamped", "the diffuse cosine is not clamped at 0", &[&[lit(Lit::IncidenceUnclamped)]]),
    fault(
        "incidence-of-both-sides",
        "the diffuse cosine is taken by its magnitude",
        &[&[lit(Lit::IncidenceOfBothSides)]],
    )
    .seen_in("two-sided lighting by abs"),
    fault("half-lambert", "the diffuse cosine is wrapped: (½·l·n + ½)²", &[&[lit(Lit::HalfLambert)]])
        .seen_in("Valve's half Lambert"),
    fault("no-incidence", "the diffuse term does not depend on the angle", &[&[lit(Lit::NoIncidence)]]),
    fault(
        "specular-unclamped",
        "the highlight is a power of the cosine's magnitude, not clamped at 0",
        &[&[lit(Lit::LobeOfBothSides)]],
    )
    .only(|spec| spec.id != "lighting/cosine-power-unguarded"),
    fault("schlick-power", "the highlight's power is Schlick's approximation", &[&[lit(Lit::SchlickPower)]])
        .seen_in("shaders that spare a pow"),
    fault("specular-gated", "the highlight is 0 where the light is behind the surface", &[&[lit(Lit::Gated)]])
        .seen_in("OpenGL's fixed function"),
    fault(
        "specular-not-gated",
        "the highlight is drawn where the light is behind the surface",
        &[&[lit(Lit::NotGated)]],
    )
    .seen_in("document 000's programs"),
    fault("specular-times-incidence", "the highlight is multiplied by n·l", &[&[lit(Lit::SpecularTimesIncidence)]])
        .seen_in("three.js and physically based shading"),
    fault(
        "normalised-lobe-with-fresnel",
        "the highlight is Blinn's normalised lobe with Schlick's Fresnel term, times n·l",
        &[&[lit(Lit::NormalisedLobeWithFresnel)]],
    )
    .seen_in("three.js, BRDF_BlinnPhong under lights of intensity π"),
    fault(
        "normalised-lobe-over-pi",
        "all terms are over π, the highlight Blinn's normalised lobe with Schlick's Fresnel term",
        &[&[lit(Lit::NormalisedLobeWithFresnel), lit(Lit::OverPi)]],
    )
    .seen_in("three.js, MeshPhongMaterial under lights of intensity 1"),
    fault(
        "energy-conserving-lobe",
        "the highlight is multiplied by (shininess + 8)/8π",
        &[&[lit(Lit::EnergyConservingLobe)]],
    )
    .seen_in("Hoffman's normalisation"),
    fault("lambert-over-pi", "ambient and diffuse terms are divided by π", &[&[lit(Lit::OverPi)]])
        .seen_in("three.js, BRDF_Lambert"),
    fault(
        "no-ambient",
        "the ambient term is forgotten",
        &[&[lit(Lit::NoAmbient)], &[Before(In::Set("la", 0.0))], &[Before(In::Set("ambient", 0.0))]],
    ),
    fault(
        "ambient-twice",
        "the ambient term is counted twice",
        &[&[lit(Lit::AmbientTwice)], &[Before(In::Scale("la", 2.0))], &[Before(In::Scale("ambient", 2.0))]],
    )
    .seen_in("an ambient light added for each light"),
    fault("no-emission", "the emission is forgotten", &[&[Before(In::Set("emissive", 0.0))]]),
    fault(
        "no-diffuse",
        "the diffuse term is forgotten",
        &[
            &[lit(Lit::NoDiffuse)],
            &[Before(In::Set("diffuse", 0.0))],
            &[Before(In::Set("diffuse0", 0.0)), Before(In::Set("diffuse1", 0.0))],
        ],
    ),
    fault(
        "no-specular",
        "the highlight is forgotten",
        &[&[lit(Lit::NoSpecular)], &[Before(In::Set("specular0", 0.0)), Before(In::Set("specular1", 0.0))]],
    ),
    fault(
        "light-specular-ignored",
        "the highlight takes the light's diffuse colour for its specular one",
        &[&[Before(In::Copy("ld", "ls"))]],
    )
    .seen_in("engines whose lights have one colour"),
    fault(
        "light-ambient-by-diffuse",
        "the light's diffuse colour stands for its ambient one",
        &[&[Before(In::Copy("ld", "la"))]],
    ),
    fault(
        "material-specular-by-diffuse",
        "the highlight takes the material's diffuse colour for its specular one",
        &[&[Before(In::Copy("md", "ms"))]],
    ),
    fault(
        "material-ambient-by-diffuse",
        "the material's diffuse colour stands for its ambient one",
        &[&[Before(In::Copy("md", "ma"))]],
    )
    .seen_in("three.js; OpenGL's glColorMaterial"),
    fault(
        "diffuse-and-specular-exchanged",
        "the material's diffuse and specular colours are exchanged",
        &[&[Before(In::Swap("md", "ms"))], &[Before(In::Swap("kd", "ks"))], &[Before(In::Swap("diffuse", "specular"))]],
    ),
    fault(
        "light-and-ambient-exchanged",
        "the light's colour and the ambient one are exchanged",
        &[&[Before(In::Swap("ambient_color", "light_color"))], &[Before(In::Swap("la", "ld"))]],
    ),
    fault(
        "light-and-surface-exchanged",
        "the light's colour and the surface's are exchanged",
        &[
            &[Instead(&[("lighting/highlight-metal", "lighting/highlight-plastic")])],
            &[Before(In::Swap("ls", "surface"))],
        ],
    )
    .only(in_lighting),
    fault(
        "plastic-as-metal",
        "the highlight takes the surface's colour where it has the light's alone",
        &[&[Instead(&[("lighting/highlight-plastic", "lighting/highlight-metal")])]],
    ),
    fault("specular-share-forgotten", "the highlight's share ks is forgotten", &[&[Before(In::Set("ks", 1.0))]])
        .only(|spec| !matches!(spec.id.as_str(), "lighting/gouraud")),
    fault(
        "one-light-alone",
        "the second light is forgotten",
        &[&[lit(Lit::OneLightAlone)], &[Before(In::Set("diffuse1", 0.0)), Before(In::Set("specular1", 0.0))]],
    ),
    fault(
        "gouraud-for-phong",
        "the surface is lit at its vertices where it is to be lit at the point",
        &[&[lit(Lit::GouraudForPhong)]],
    )
    .seen_in("OpenGL's fixed function; three.js, MeshLambertMaterial of old"),
    fault(
        "phong-for-gouraud",
        "the surface is lit at the point where it is to be lit at its vertices",
        &[&[lit(Lit::PhongForGouraud)]],
    ),
    fault(
        "vectors-at-the-vertices",
        "normal, light and view vectors are interpolated between unit vectors of the vertices",
        &[&[lit(Lit::VectorsAtTheVertices)]],
    )
    .seen_in("shaders that pass normalised l and v as varyings"),
    fault("lit-at-the-last-vertex", "a flat face is lit at its last vertex", &[&[lit(Lit::LitAtTheLastVertex)]])
        .seen_in("OpenGL's provoking vertex"),
    fault("lit-at-the-middle", "a flat face is lit at its middle", &[&[lit(Lit::LitAtTheMiddle)]]),
];

/// Powers of cosines, spotlights apart.
fn in_lighting_powers(spec: &Spec) -> bool {
    in_lighting(spec) && (spec.place("shininess").is_some() || spec.id.starts_with("lighting/cosine-power"))
}

const ATTENUATION: &[Fault] = &[
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
        &[&[Body(Wrong::AtMostOne)], &[After(Out::AtMostOne("atten"))]],
    )
    .only(|spec| spec.id != "attenuation/constant"),
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

const FOG: &[Fault] = &[
    fault("fog-radial", "fog uses radial distance", &[&[fogged(Fogged::Radial)]]).seen_in("OpenGL drivers; Unity; o3"),
    fault("fog-planar", "fog uses planar distance", &[&[fogged(Fogged::Planar)]]).seen_in("three.js; OpenGL drivers"),
    fault("fog-signed-depth", "fog uses z with its sign", &[&[fogged(Fogged::SignedDepth)]]),
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
        "fog-mixed-the-wrong-way",
        "fog and surface are exchanged in the mix",
        &[&[fogged(Fogged::MixedTheWrongWay)]],
    ),
    fault("fog-added", "the fog's colour is added to the surface's", &[&[fogged(Fogged::Added)]]),
    fault("fog-not-applied", "the fog is not applied to the colour", &[&[fogged(Fogged::NotApplied)]]),
];

const OUTPUT: &[Fault] = &[
    fault("gamma-encoded", "the output is gamma-encoded, c^(1/2.2)", &[&[After(Out::Gamma)]])
        .only(where_colors_are_drawn),
    fault("srgb-encoded", "the output is sRGB-encoded", &[&[After(Out::Srgb)]])
        .only(where_colors_are_drawn)
        .seen_in("three.js, the default output colour space"),
    fault("srgb-decoded", "the output is decoded as if it were sRGB", &[&[After(Out::Decode)]])
        .only(where_colors_are_drawn),
    fault(
        "materials-decoded",
        "the material's colours are decoded as if they were sRGB",
        &[
            &[Before(In::Decode("ma")), Before(In::Decode("md")), Before(In::Decode("ms"))],
            &[Before(In::Decode("ma"))],
            &[Before(In::Decode("md"))],
            &[Before(In::Decode("ms"))],
            &[Before(In::Decode("diffuse")), Before(In::Decode("specular"))],
            &[Before(In::Decode("surface"))],
            &[Before(In::Decode("texel"))],
        ],
    )
    .only(|spec| spec.id != "lighting/highlight-plastic")
    .seen_in("three.js, Color.setHex under colour management"),
    fault("output-clamped", "the sum is clamped to [0, 1] before the target's own clamp", &[&[After(Out::Clamp)]])
        .only(where_sums_go_beyond)
        .seen_in("OpenGL's fixed function"),
    fault("red-and-blue-swapped", "red and blue are swapped", &[&[After(Out::RedBlue)]])
        .only(where_colors_are_drawn)
        .seen_in("BGRA read as RGBA"),
    fault("truncated-store", "the output is cut to whole 255ths", &[&[After(Out::Truncate)]])
        .only(where_colors_are_drawn),
    fault("stored-in-8-bits", "the output is rounded to whole 255ths", &[&[After(Out::Round)]])
        .only(where_colors_are_drawn)
        .seen_in("answers read back from an 8-bit target"),
    fault("premultiplied-output", "the output is multiplied by its alpha", &[&[After(Out::Premultiply)]])
        .only(where_alpha_varies)
        .seen_in("a browser's canvas"),
    fault("alpha-dropped", "alpha is 1 whatever it is to be", &[&[After(Out::Opaque)]])
        .only(where_alpha_varies)
        .seen_in("three.js, materials not marked transparent"),
];

/// Whether an alpha comes out that may be other than 1.
fn where_alpha_varies(spec: &Spec) -> bool {
    where_colors_are_drawn(spec)
        && match spec.family() {
            "lighting" => matches!(spec.id.as_str(), "lighting/point-opengl" | "lighting/two-lights"),
            "color" => matches!(spec.id.as_str(), "color/modulate" | "color/replace"),
            _ => true,
        }
}

const VECTOR: &[Fault] = &[
    fault(
        "matrix-transposed",
        "columns of a matrix are taken for rows",
        &[
            &[Before(In::Transpose("view")), Before(In::Transpose("model"))],
            &[Before(In::Transpose("view"))],
            &[Before(In::Transpose("modelview"))],
        ],
    )
    .seen_in("row-major matrices uploaded as they are"),
    fault("normals-by-modelview", "normals are transformed by the modelview", &[&[Body(Wrong::NormalByModelview)]])
        .seen_in("documents 000 and 003"),
    fault(
        "normals-by-inverse-transpose",
        "normals are transformed by the inverse transpose where the modelview is asked for",
        &[&[Instead(&[("vector/normal-modelview", "vector/normal-inverse-transpose")])]],
    ),
    fault(
        "inverse-not-transposed",
        "normals are transformed by the inverse, not transposed",
        &[&[Body(Wrong::NormalByInverse)]],
    ),
    fault(
        "determinant-forgotten",
        "normals are transformed by the cofactors, not over the determinant",
        &[&[Body(Wrong::NormalByBareCofactors)]],
    )
    .seen_in("mirrored objects lit from behind"),
    fault(
        "w-divide-missing",
        "a position is not divided by its w",
        &[&[Body(Wrong::NotDivided)], &[Body(Wrong::WindowNotDivided)]],
    ),
    fault("direction-divided", "a light at infinity is divided by its w of 0", &[&[Body(Wrong::DividedAlways)]]),
    fault(
        "matrices-exchanged",
        "model and view are multiplied in the wrong order",
        &[&[Body(Wrong::MatricesExchanged)]],
    ),
    fault(
        "translation-forgotten",
        "a matrix's translation is forgotten",
        &[&[Before(In::NoTranslation("modelview"))], &[Before(In::NoTranslation("view"))]],
    )
    .only(|spec| spec.id != "vector/light-direction"),
    fault(
        "normals-averaged",
        "averaged normals are divided by their number, not normalised",
        &[&[Body(Wrong::MeanNormal)]],
    ),
    fault(
        "winding-reversed",
        "the face's corners are taken in reverse",
        &[&[Before(In::Swap("b", "c"))], &[After(Out::OneMinus("front"))]],
    )
    .only(|spec| {
        let id = spec.id.as_str();
        id.starts_with("vector/face-normal")
            || matches!(id, "lighting/flat" | "interpolation/front-facing" | "interpolation/raster-facing")
    })
    .seen_in("clockwise meshes; a mirrored projection"),
    fault("face-normal-not-normalised", "the normal of a face is not normalised", &[&[Body(Wrong::FaceNotNormalised)]])
        .seen_in("normals weighted by area"),
    fault("normalised-by-sum", "vectors are divided by the sum of their components", &[&[Body(Wrong::NormalizeBySum)]]),
    fault(
        "normalised-by-largest",
        "vectors are divided by their largest component",
        &[&[Body(Wrong::NormalizeByLargest)]],
    ),
    fault("normalised-by-square", "vectors are divided by their squared length", &[&[Body(Wrong::NormalizeBySquare)]]),
    fault("length-squared", "the length is squared", &[&[Body(Wrong::SquaredLength)]]),
];

const INTERPOLATION: &[Fault] = &[
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
    fault("depth-range", "depth is taken from [−1, 1] for [0, 1], or the reverse", &[&[Body(Wrong::DepthRange)]])
        .seen_in("OpenGL's clip space in WebGPU, and the reverse"),
    fault(
        "half-pixel-offset",
        "everything is half a pixel off",
        &[&[Before(In::Offset("p", 0.5))], &[Before(In::Offset("pixel", 0.5))], &[Before(In::Offset("origin", 0.5))]],
    )
    .only(|spec| {
        spec.family() == "interpolation"
            && spec.id != "interpolation/raster-frag-depth"
            && !spec.id.contains("raster-flat")
            && !spec.id.contains("facing")
    })
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

const COLOR: &[Fault] = &[
    fault("byte-truncated", "8 bits are cut, not rounded", &[&[Body(Wrong::TruncatedByte)]]).seen_in("int(255·c)"),
    fault("byte-by-256", "8 bits are the whole part of 256·c", &[&[Body(Wrong::By256)]]),
    fault("byte-unclamped", "8 bits are not clamped", &[&[Body(Wrong::UnclampedByte)]])
        .seen_in("bytes that wrap around"),
    fault("byte-over-256", "8 bits are divided by 256", &[&[Body(Wrong::Over256)]]),
    fault("one-power-for-srgb", "one power of 2.2 stands for sRGB", &[&[Body(Wrong::OnePower)]]),
    fault("encoded-for-decoded", "sRGB is encoded where it is to be decoded", &[&[Body(Wrong::Encoded)]]),
    fault("decoded-for-encoded", "sRGB is decoded where it is to be encoded", &[&[Body(Wrong::Decoded)]]),
    fault("not-converted", "sRGB is not converted at all", &[&[Body(Wrong::NotConverted)]]),
    fault("encoded-twice", "sRGB is encoded twice", &[&[Body(Wrong::Twice)]])
        .seen_in("an sRGB target beneath a shader that encodes"),
    fault("straight-piece-throughout", "sRGB's straight piece is taken throughout", &[&[Body(Wrong::StraightPiece)]]),
    fault("alpha-encoded", "alpha is sRGB-encoded too", &[&[Body(Wrong::AlphaToo)]]),
    fault("sum-not-clamped", "the clamp of the sum is missing", &[&[Body(Wrong::SumNotClamped)]]),
    fault("texture-added", "the texture is added where it is to modulate", &[&[Body(Wrong::Added)]]),
    fault(
        "texture-replaces",
        "the texture replaces where it is to modulate",
        &[&[Instead(&[("color/modulate", "color/replace")])]],
    ),
    fault(
        "texture-modulates",
        "the texture modulates where it is to replace",
        &[&[Instead(&[("color/replace", "color/modulate")])]],
    ),
    fault("modulated-twice-as-bright", "a lightmap is twice as bright", &[&[After(Out::Scale("color", 2.0))]])
        .only(|spec| spec.id == "color/modulate" || spec.id == "blend/mode-mul")
        .seen_in("modulate2x"),
];

const DEPTH: &[Fault] = &[
    fault(
        "depth-compare-strictness",
        "equal depths pass where they are not to, or the reverse",
        &[&[Body(Wrong::OtherStrictness)]],
    )
    .seen_in("GL_LESS for GL_LEQUAL"),
    fault("depth-compare-reversed", "the depth test is the other way round", &[&[Body(Wrong::ReversedCompare)]])
        .seen_in("reversed depth without its compare function"),
    fault(
        "depth-mask-ignored",
        "depth is written where it is not to be, or the reverse",
        &[&[Body(Wrong::OtherWriting)]],
    ),
    fault("depth-written-always", "depth is written by fragments that fail the test", &[&[Body(Wrong::WrittenAlways)]]),
    fault("depth-not-clamped", "depth is not clamped to [0, 1]", &[&[Body(Wrong::DepthNotClamped)]]),
    fault("depth-taken-as-linear", "depth is read back as if it grew evenly", &[&[Body(Wrong::LinearDepth)]]),
    fault(
        "planes-exchanged",
        "near and far are exchanged where depth is read back",
        &[&[Body(Wrong::PlanesExchanged)]],
    ),
];

const BLEND: &[Fault] = &[
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
