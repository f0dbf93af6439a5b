//! Mistakes of lighting.

use super::super::alteration::Form;
use super::super::change::After as Out;
use super::super::change::Before as In;
use super::super::fault::Step::{After, Before, Instead};
use super::super::fault::{Fault, Step};
use super::super::op::Op;
use super::{copy, fault, form, given, in_lighting, input, pass, pass_as, result, times};
use lightmeter_catalogue::cases::Spec;
use std::f64::consts::FRAC_1_PI;

const AMBIENT_OVER_PI: Step = result("CA", Op::Scale(FRAC_1_PI));
const DIFFUSE_OVER_PI: Step = result("CD", Op::Scale(FRAC_1_PI));
const CONSTANT_OVER_PI: Step = input("ambient", Op::Scale(FRAC_1_PI));
const FRESNEL_OVER_PI: Step = form("CS", Form::Fresnel { over_pi: true });
const UNIT_N: Step = result("n at a vertex", Op::Normalize);
const UNIT_L: Step = result("l at a vertex", Op::Normalize);
const UNIT_V: Step = result("v at a vertex", Op::Normalize);

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "normal-not-normalised",
        "the normal is not normalised",
        &[&[pass("n", "n")], &[pass("⟨Σn⟩", "sum")], &[pass("⟨n⟩", "n")], &[pass("⟨n⟩", "turned")]],
    )
    .seen_in("interpolated normals used as they come"),
    fault(
        "normal-reversed",
        "the normal points the other way",
        &[&[input("normal", Op::Negate)], &[input("n", Op::Negate)]],
    )
    .only(|spec| !spec.id.starts_with("vector/reflect")),
    fault("light-not-normalised", "the vector to the light is not normalised", &[&[pass("l", "to_light")]])
        .only(|spec| !matches!(spec.id.as_str(), "lighting/phong-unit-light" | "lighting/phong-nonlocal")),
    fault(
        "light-reversed",
        "the light vector is reversed",
        &[&[result("l", Op::Negate)], &[input("l", Op::Negate)], &[input("i", Op::Negate)]],
    )
    .only(|spec| matches!(spec.family(), "lighting" | "vector" | "attenuation"))
    .seen_in("OpenGL's direction to the light for the direction of travel"),
    fault(
        "position-as-direction",
        "a positional light is taken as a direction",
        &[
            &[pass("light − p", "light")],
            &[pass("light − p", "position")],
            &[form("view·model·position", Form::PositionAsDirection)],
            &[given("modelview·position", "position", Op::Component(3, &Op::Set(0.0)))],
        ],
    ),
    fault(
        "direction-as-position",
        "a light's direction is taken as a position",
        &[&[Before(In::Plus("direction", "p"))], &[form("view·direction", Form::DirectionAsPosition)]],
    )
    .only(|spec| spec.id != "lighting/two-lights"),
    fault("view-not-normalised", "the view vector is not normalised", &[&[pass("v", "to_eye")]]),
    fault("view-reversed", "the view vector is reversed", &[&[result("v", Op::Negate)], &[input("v", Op::Negate)]])
        .only(|spec| spec.family() == "lighting" || spec.id.starts_with("vector/halfway")),
    fault(
        "viewer-at-infinity",
        "the viewer is taken to be at infinity",
        &[&[result("v", Op::Component(2, &Op::Set(1.0))), result("v", Op::Set(0.0))]],
    )
    .seen_in("OpenGL's GL_LIGHT_MODEL_LOCAL_VIEWER left off"),
    fault(
        "reflect-with-plus",
        "reflect adds the normal's share where it takes it off",
        &[&[form("r", Form::ReflectWithPlus)]],
    ),
    fault(
        "reflect-of-toward",
        "reflect is given the vector to the light for the direction of travel",
        &[&[result("r", Op::Negate)], &[input("r", Op::Negate)]],
    ),
    fault("reflect-once", "reflect takes the normal's share off once, not twice", &[&[form("r", Form::ReflectOnce)]]),
    fault(
        "blinn-for-phong",
        "Blinn's highlight is drawn for Phong's, of the same exponent",
        &[&[form("r·v", Form::Blinn)]],
    )
    .seen_in("three.js, MeshPhongMaterial"),
    fault(
        "phong-for-blinn",
        "Phong's highlight is drawn for Blinn's, of the same exponent",
        &[&[form("n·h", Form::Phong)], &[form("n·(v + l)", Form::Phong)], &[form("(n·h)^S", Form::PhongPower)]],
    ),
    fault(
        "shininess-times-4",
        "the shininess is 4 times what was asked",
        &[&[input("shininess", Op::Scale(4.0))], &[input("exponent", Op::Scale(4.0))]],
    )
    .only(in_lighting_powers)
    .seen_in("Blinn's exponent converted from Phong's"),
    fault(
        "shininess-over-4",
        "the shininess is a quarter of what was asked",
        &[&[input("shininess", Op::Scale(0.25))], &[input("exponent", Op::Scale(0.25))]],
    )
    .only(in_lighting_powers)
    .seen_in("Phong's exponent converted from Blinn's"),
    fault(
        "shininess-of-1000-as-128",
        "the shininess is rescaled from a range of 1000 to one of 128",
        &[&[input("shininess", Op::Scale(0.128))], &[input("exponent", Op::Scale(0.128))]],
    )
    .only(in_lighting_powers)
    .seen_in("importers of Wavefront materials for OpenGL"),
    fault(
        "shininess-ignored",
        "the shininess is ignored: the highlight is the bare cosine",
        &[&[input("shininess", Op::Set(1.0))], &[input("exponent", Op::Set(1.0))]],
    )
    .only(in_lighting_powers),
    fault("half-vector-not-normalised", "the half vector is not normalised", &[&[pass("h", "sum")]])
        .seen_in("document 000's program"),
    fault(
        "half-vector-normalised",
        "the half vector is normalised where it is not to be",
        &[&[form("n·(v + l)", Form::Blinn)], &[Instead(&[("vector/halfway-unnormalised", "vector/halfway")])]],
    ),
    fault(
        "half-vector-by-difference",
        "the half vector is that of v − l, not of v + l",
        &[&[form("n·h", Form::BlinnByDifference)], &[given("v + l", "l", Op::Negate)]],
    )
    .seen_in("programs that take the light's direction of travel for the one to the light"),
    fault(
        "half-vector-as-mean",
        "the half vector is the mean (v + l)/2",
        &[&[pass_as("h", "sum", Op::Scale(0.5))], &[result("v + l", Op::Scale(0.5))]],
    ),
    fault("incidence-unclamped", "the diffuse cosine is not clamped at 0", &[&[pass("FI", "cosine")]]),
    fault(
        "incidence-of-both-sides",
        "the diffuse cosine is taken by its magnitude",
        &[&[pass_as("FI", "cosine", Op::Abs)]],
    )
    .seen_in("two-sided lighting by abs"),
    fault(
        "half-lambert",
        "the diffuse cosine is wrapped: (½·l·n + ½)²",
        &[&[form("FI", Form::HalfLambert { squared: true })]],
    )
    .seen_in("Valve's half Lambert"),
    fault("no-incidence", "the diffuse term does not depend on the angle", &[&[result("FI", Op::Set(1.0))]]),
    fault(
        "specular-unclamped",
        "the highlight is a power of the cosine's magnitude, not clamped at 0",
        &[&[form("FS", Form::LobeOfBothSides)]],
    )
    .only(|spec| spec.id != "lighting/cosine-power-unguarded"),
    fault(
        "power-of-a-negative-cosine",
        "the highlight is a power of a cosine that may be below 0, which has no value there",
        &[&[form("FS", Form::PowerUnguarded)]],
    )
    .only(|spec| spec.id != "lighting/cosine-power-unguarded")
    .seen_in("pow(dot(n, h), shininess) without a max"),
    fault("schlick-power", "the highlight's power is Schlick's approximation", &[&[form("FS", Form::SchlickPower)]])
        .seen_in("shaders that spare a pow"),
    fault(
        "specular-gated",
        "the highlight is 0 where the light is behind the surface",
        &[&[form("FS of either side", Form::Gated)]],
    )
    .seen_in("OpenGL's fixed function"),
    fault(
        "specular-not-gated",
        "the highlight is drawn where the light is behind the surface",
        &[&[given("FS of the lit side", "cosine", Op::Set(1.0))]],
    )
    .seen_in("document 000's programs"),
    fault(
        "specular-times-incidence",
        "the highlight is multiplied by n·l",
        &[&[form("FS of either side", Form::TimesIncidence)], &[form("FS of the lit side", Form::TimesIncidence)]],
    )
    .seen_in("three.js and physically based shading"),
    fault(
        "normalised-lobe-with-fresnel",
        "the highlight is Blinn's normalised lobe with Schlick's Fresnel term, times n·l",
        &[&[form("CS", Form::Fresnel { over_pi: false })], &[form("I", Form::Fresnel { over_pi: false })]],
    )
    .seen_in("three.js, BRDF_BlinnPhong under lights of intensity π"),
    fault(
        "normalised-lobe-over-pi",
        "all terms are over π, the highlight Blinn's normalised lobe with Schlick's Fresnel term",
        &[
            &[FRESNEL_OVER_PI, AMBIENT_OVER_PI, DIFFUSE_OVER_PI],
            &[FRESNEL_OVER_PI, CONSTANT_OVER_PI, DIFFUSE_OVER_PI],
            &[form("I", Form::Fresnel { over_pi: true })],
        ],
    )
    .seen_in("three.js, MeshPhongMaterial under lights of intensity 1"),
    fault(
        "energy-conserving-lobe",
        "the highlight is multiplied by (shininess + 8)/8π",
        &[&[form("FS", Form::EnergyConserving)]],
    )
    .seen_in("Hoffman's normalisation"),
    fault(
        "diffuse-over-pi",
        "the diffuse term is divided by π",
        &[&[DIFFUSE_OVER_PI], &[given("I", "kd", Op::Scale(FRAC_1_PI))]],
    )
    .seen_in("Lambert's BRDF under lights of intensity 1"),
    fault(
        "lambert-over-pi",
        "ambient and diffuse terms are divided by π",
        &[&[AMBIENT_OVER_PI, DIFFUSE_OVER_PI], &[CONSTANT_OVER_PI, DIFFUSE_OVER_PI]],
    )
    .seen_in("three.js, BRDF_Lambert"),
    fault(
        "no-ambient",
        "the ambient term is forgotten",
        &[&[result("CA", Op::Set(0.0))], &[input("ambient", Op::Set(0.0))]],
    ),
    fault(
        "ambient-twice",
        "the ambient term is counted twice",
        &[&[result("CA", Op::Scale(2.0))], &[input("ambient", Op::Scale(2.0))]],
    )
    .seen_in("an ambient light added for each light"),
    fault("no-emission", "the emission is forgotten", &[&[input("emissive", Op::Set(0.0))]]),
    fault(
        "no-diffuse",
        "the diffuse term is forgotten",
        &[
            &[result("CD", Op::Set(0.0))],
            &[given("I", "kd", Op::Set(0.0))],
            &[input("diffuse", Op::Set(0.0))],
            &[input("diffuse0", Op::Set(0.0)), input("diffuse1", Op::Set(0.0))],
        ],
    ),
    fault(
        "no-specular",
        "the highlight is forgotten",
        &[
            &[result("CS", Op::Set(0.0))],
            &[given("I", "ks", Op::Set(0.0))],
            &[input("specular0", Op::Set(0.0)), input("specular1", Op::Set(0.0))],
        ],
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
    fault("specular-share-forgotten", "the highlight's share ks is forgotten", &[&[input("ks", Op::Set(1.0))]])
        .only(|spec| !matches!(spec.id.as_str(), "lighting/gouraud")),
    fault(
        "one-light-alone",
        "the second light is forgotten",
        &[
            &[given("CF", "d1", Op::Set(0.0)), given("CF", "s1", Op::Set(0.0))],
            &[input("diffuse1", Op::Set(0.0)), input("specular1", Op::Set(0.0))],
        ],
    ),
    fault(
        "gouraud-for-phong",
        "the surface is lit at its vertices where it is to be lit at the point",
        &[&[Instead(&[
            ("lighting/phong-shading", "lighting/gouraud"),
            ("lighting/phong-interpolated", "lighting/gouraud"),
        ])]],
    )
    .seen_in("OpenGL's fixed function; three.js, MeshLambertMaterial of old"),
    fault(
        "phong-for-gouraud",
        "the surface is lit at the point where it is to be lit at its vertices",
        &[&[Instead(&[("lighting/gouraud", "lighting/phong-shading")])]],
    ),
    fault(
        "vectors-at-the-vertices",
        "normal, light and view vectors are interpolated between unit vectors of the vertices",
        &[
            &[UNIT_N, UNIT_L, UNIT_V],
            &[Instead(&[("lighting/phong-shading", "lighting/phong-interpolated")]), UNIT_N, UNIT_L, UNIT_V],
        ],
    )
    .seen_in("shaders that pass normalised l and v as varyings"),
    fault("lit-at-the-last-vertex", "a flat face is lit at its last vertex", &[&[pass("where it is lit", "c")]])
        .seen_in("OpenGL's provoking vertex"),
    fault("lit-at-the-middle", "a flat face is lit at its middle", &[&[form("where it is lit", Form::Middle)]]),
    fault(
        "alpha-of-the-material",
        "alpha is the diffuse material's, not the sum of all terms",
        &[&[After(Out::Take("color", "diffuse"))]],
    )
    .seen_in("OpenGL's fixed function"),
    fault("one-light-reversed", "the direction of the first light is reversed", &[&[input("direction", Op::Negate)]])
        .only(|spec| spec.id == "lighting/two-lights"),
    fault(
        "second-highlight-copied",
        "the second light's highlight is the first one's",
        &[&[copy("CF", "s0", "s1")], &[Before(In::Copy("specular0", "specular1"))]],
    )
    .seen_in("copy and paste"),
    fault(
        "second-diffuse-copied",
        "the second light's diffuse term is the first one's",
        &[&[copy("CF", "d0", "d1")], &[Before(In::Copy("diffuse0", "diffuse1"))]],
    )
    .seen_in("copy and paste"),
    fault(
        "second-light-in-the-first-color",
        "the second light has the first one's colour",
        &[&[Before(In::Copy("color0", "color1"))]],
    )
    .seen_in("copy and paste"),
    fault(
        "first-light-in-the-second-color",
        "the first light has the second one's colour",
        &[&[Before(In::Copy("color1", "color0"))]],
    )
    .seen_in("a uniform that is written twice"),
    fault(
        "colors-of-the-lights-exchanged",
        "the two lights' colours are exchanged",
        &[&[Before(In::Swap("color0", "color1"))]],
    ),
    fault(
        "clamped-at-the-vertices",
        "colours are clamped at the vertices, before they are interpolated",
        &[&[given("I between the vertices", "a", Op::Clamp), given("I between the vertices", "b", Op::Clamp)]],
    )
    .seen_in("gl4es; OpenGL's fixed function"),
    fault(
        "half-lambert-not-squared",
        "the diffuse cosine is wrapped and not squared: ½·l·n + ½",
        &[&[form("FI", Form::HalfLambert { squared: false })]],
    ),
    fault("shininess-at-most-128", "the shininess is limited to 128", &[&[given("FS", "exponent", Op::AtMost(128.0))]])
        .seen_in("OpenGL's GL_SHININESS"),
    fault("shininess-at-least-1", "the shininess is at least 1", &[&[given("FS", "exponent", Op::AtLeast(1.0))]])
        .seen_in("Babylon.js"),
    fault("shininess-rounded", "the shininess is rounded to a whole number", &[&[given("FS", "exponent", Op::Round)]]),
    fault("shininess-floored", "the shininess is cut to a whole number", &[&[given("FS", "exponent", Op::Floor)]])
        .seen_in("int shininess"),
    fault(
        "cosine-at-least-0.01",
        "the highlight's cosine is held above 0.01",
        &[&[form("FS", Form::PowerOfAtLeast(2))]],
    )
    .seen_in("Cesium, PR 4423"),
    fault(
        "cosine-at-least-0.001",
        "the highlight's cosine is held above 0.001",
        &[&[form("FS", Form::PowerOfAtLeast(3))]],
    ),
    fault(
        "cosine-at-least-0.0001",
        "the highlight's cosine is held above 0.0001",
        &[&[form("FS", Form::PowerOfAtLeast(4))]],
    )
    .seen_in("guards against pow(0, 0)"),
    fault(
        "cosine-at-least-0.00001",
        "the highlight's cosine is held above 0.00001",
        &[&[form("FS", Form::PowerOfAtLeast(5))]],
    )
    .seen_in("VTK, ReplaceShaderLight"),
    fault("cosine-at-most-1", "the highlight's cosine is limited to 1", &[&[form("FS", Form::PowerOfAtMostOne)]])
        .seen_in("saturate(dot(n, h)) of vectors that are not of length 1"),
    fault(
        "no-highlight-without-shininess",
        "the highlight is 0 where its exponent is 0",
        &[&[form("FS", Form::NoneWithoutExponent)]],
    )
    .seen_in("guards against pow(0, 0)"),
    fault(
        "product-for-power",
        "the highlight is the cosine times the shininess, not its power",
        &[&[form("FS", Form::ProductForPower)]],
    ),
    fault(
        "normalised-phong-lobe",
        "the highlight is multiplied by (shininess + 2)/2π",
        &[&[form("FS", Form::NormalisedPhong)]],
    )
    .seen_in("Lafortune and Willems's normalised Phong"),
    fault(
        "gate-turned-round",
        "the highlight is drawn only where the light is behind the surface",
        &[&[form("FS of the lit side", Form::GateTurned)]],
    ),
    fault(
        "gate-open-at-the-edge",
        "the highlight is kept where l·n is 0 exactly",
        &[&[form("FS of the lit side", Form::GatedBelow)]],
    )
    .seen_in("l·n ≥ 0 for l·n > 0"),
    fault(
        "normal-turned-to-the-eye",
        "the normal is turned to the eye: both sides are lit",
        &[&[form("n, l and v", Form::NormalToTheEye)]],
    )
    .seen_in("faceforward; pygfx, issue 105"),
    fault(
        "normal-turned-to-the-light",
        "the normal is turned to the light: both sides are lit",
        &[&[form("n, l and v", Form::NormalToTheLight)]],
    ),
    fault(
        "normals-normalised-at-the-vertices",
        "normals are normalised at the vertices before they are interpolated",
        &[&[result("n at a vertex", Op::Normalize)]],
    ),
    fault(
        "light-normalised-at-the-vertices",
        "the vector to the light is normalised at the vertices before it is interpolated",
        &[&[result("l at a vertex", Op::Normalize)]],
    ),
    fault(
        "view-normalised-at-the-vertices",
        "the view vector is normalised at the vertices before it is interpolated",
        &[&[result("v at a vertex", Op::Normalize)]],
    ),
    fault("ambient-in-the-cone", "the spotlight's cone dims the ambient term too", &[&[times("CA", "cone")]]),
    fault(
        "incidence-floored",
        "the diffuse cosine is held above 0.01",
        &[&[pass_as("FI", "cosine", Op::AtLeast(0.01))]],
    ),
    fault(
        "no-light-specular",
        "the highlight is not multiplied by the light's colour",
        &[&[given("CS", "light", Op::Set(1.0))], &[input("ls", Op::Set(1.0))]],
    ),
];

/// Powers of cosines, spotlights apart.
fn in_lighting_powers(spec: &Spec) -> bool {
    in_lighting(spec) && (spec.place("shininess").is_some() || spec.id.starts_with("lighting/cosine-power"))
}
