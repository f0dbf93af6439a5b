//! Mistakes of lighting.

use super::super::body::Body as Wrong;
use super::super::change::After as Out;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{After, Before, Body, Instead};
use super::super::lighting::Twist as Lit;
use super::{fault, in_lighting, lit};
use lightmeter_catalogue::cases::Spec;

pub(super) const FAULTS: &[Fault] = &[
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
    fault(
        "alpha-of-the-material",
        "alpha is the diffuse material's, not the sum of all terms",
        &[&[lit(Lit::AlphaOfTheMaterial)]],
    )
    .seen_in("OpenGL's fixed function"),
];

/// Powers of cosines, spotlights apart.
fn in_lighting_powers(spec: &Spec) -> bool {
    in_lighting(spec) && (spec.place("shininess").is_some() || spec.id.starts_with("lighting/cosine-power"))
}
