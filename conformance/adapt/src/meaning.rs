//! What the variables of shaders mean, and how each meaning is had from the inputs of a formula.

use crate::program::From;
use lightmeter_catalogue::cases::{Domain, Spec};
use std::collections::BTreeSet;

/// A term of the lighting sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Term {
    Ambient,
    Diffuse,
    Specular,
}

/// What a variable stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Meaning {
    Normal,
    Point,
    Eye,
    ToEye,
    ToEyeWithLength,
    ToLight,
    Travel,
    LightPosition,
    Half,
    Reflected,
    Shininess,
    OfLight(Term),
    OfMaterial(Term),
    LightColor,
    SurfaceColor,
    Weight(Term),
    Emission,
    Alpha,
    Constant,
    Linear,
    Quadratic,
    Falloff,
    Attenuation,
    Distance,
    Axis,
    CutoffCosine,
    SpotExponent,
    FogColor,
    FogDensity,
    FogStart,
    FogEnd,
    FogFactor,
    Incidence,
    HalfCosine,
    ReflectedCosine,
    Identity,
    Count,
    TexturePlace,
    Source,
    Destination,
}

use Meaning as M;
use Term::{Ambient, Diffuse, Specular};

/// What a meaning is for, where the shader as a whole decides it.
pub(crate) struct Context<'a> {
    pub(crate) spec: &'a Spec,
    /// All meanings that the shader's variables have.
    pub(crate) meanings: BTreeSet<Meaning>,
    /// How many of them may be the surface's position.
    pub(crate) points: usize,
}

impl Context<'_> {
    pub(crate) fn has(&self, input: &str) -> bool {
        self.spec.inputs.iter().any(|own| own.name == input)
    }

    fn all(&self, inputs: &[&str]) -> bool {
        inputs.iter().all(|input| self.has(input))
    }

    /// The light's direction as the formula takes it, towards the light.
    fn toward(&self) -> Option<String> {
        let input = self.spec.inputs.iter().find(|input| input.name == "direction")?;
        let sign = if self.spec.id == "lighting/two-lights" { "" } else { "-" };
        Some(if input.domain == Domain::Direction {
            format!("{sign}direction")
        } else {
            format!("normalize({sign}direction)")
        })
    }

    fn to_light(&self, keeps_length: bool) -> Option<String> {
        let between =
            |light: &str| if keeps_length { format!("{light} - p") } else { format!("normalize({light} - p)") };
        match () {
            () if self.has("l") => Some("l".into()),
            () if self.has("i") => Some("-i".into()),
            () if self.has("direction") => self.toward(),
            () if self.all(&["position", "p"]) => Some(between("position")),
            () if self.all(&["light", "p"]) => Some(between("light")),
            () => None,
        }
    }

    fn to_eye(&self, keeps_length: bool) -> Option<String> {
        match () {
            () if self.has("v") => Some("v".into()),
            () if self.has("p") => Some(if keeps_length { "-p".into() } else { "normalize(-p)".into() }),
            // Of a viewer infinitely far away.
            () if self.has("normal") || self.has("r") => Some("vec3f(0.0, 0.0, 1.0)".into()),
            () => None,
        }
    }

    fn normal(&self, keeps_length: bool) -> Option<String> {
        match () {
            () if self.has("normal") => Some(if keeps_length { "normal".into() } else { "normalize(normal)".into() }),
            () if self.has("n") => Some("n".into()),
            () => None,
        }
    }

    fn half(&self) -> Option<String> {
        if self.has("h") {
            Some("h".into())
        } else {
            Some(format!("normalize({} + {})", self.to_eye(false)?, self.to_light(false)?))
        }
    }

    fn reflected(&self) -> Option<String> {
        if self.has("r") {
            Some("r".into())
        } else {
            Some(format!("reflect(-({}), {})", self.to_light(false)?, self.normal(false)?))
        }
    }

    /// The names of a term's two colours.
    pub(crate) const fn colors(term: Term) -> [&'static str; 2] {
        match term {
            Ambient => ["la", "ma"],
            Diffuse => ["ld", "md"],
            Specular => ["ls", "ms"],
        }
    }

    /// A term's colour of the light, or of the material: their product where the shader has only one of the two.
    fn color(&self, term: Term, is_of_light: bool) -> Option<String> {
        let [light, material] = Self::colors(term);
        let (own, other) = if is_of_light { (light, M::OfMaterial(term)) } else { (material, M::OfLight(term)) };
        let (whole, input) = (["ambient", "diffuse", "specular"][term as usize], own);
        match () {
            () if self.all(&[light, material]) => {
                // The light's single colour stands for its part where the formula has one part alone.
                let parts = ["la", "ld", "ls"].into_iter().filter(|part| self.has(part)).count();
                let is_shared = parts == 1 && self.meanings.contains(&M::LightColor);
                // A weight that has colours is the material's part.
                let is_weighted = is_of_light && !self.has("ka") && self.meanings.contains(&M::Weight(term));
                Some(if self.meanings.contains(&other) || is_shared || is_weighted {
                    input.into()
                } else {
                    format!("{light} * {material}")
                })
            }
            () if self.has(whole) => Some(whole.into()),
            () if self.has("surface") && term == Specular && !is_of_light => Some("surface".into()),
            () => None,
        }
    }

    /// The light's single colour: white where the products of light and material are the material's.
    fn light_color(&self) -> Option<String> {
        let found: Vec<&str> = ["ld", "ls", "la", "light_color"].into_iter().filter(|input| self.has(input)).collect();
        match found.as_slice() {
            [] => None,
            [one] => Some((*one).into()),
            _ => Some("vec3f(1.0)".into()),
        }
    }

    fn surface_color(&self, from: From) -> Option<String> {
        let candidates = if from == From::Texture {
            ["texel", "shaded", "surface", "md", "ma", "ms"]
        } else {
            ["shaded", "color", "surface", "md", "ma", "ms"]
        };
        let named = candidates.into_iter().find(|input| self.has(input))?;
        let term = match named {
            "ma" => Ambient,
            "md" => Diffuse,
            "ms" => Specular,
            _ => return Some(named.into()),
        };
        let is_white = self.meanings.contains(&M::OfMaterial(term));
        if is_white { Some("vec3f(1.0)".into()) } else { self.color(term, false) }
    }

    fn distance(&self) -> Option<String> {
        let named = ["d", "distance"].into_iter().find(|input| self.has(input));
        match named {
            Some(input) => Some(input.into()),
            None if self.has("fog") && self.spec.id.contains("radial") => Some("length(p)".into()),
            None if self.has("fog") => Some("abs(p.z)".into()),
            None if self.all(&["position", "p"]) => Some("distance(position, p)".into()),
            None if self.all(&["light", "p"]) => Some("distance(light, p)".into()),
            None => None,
        }
    }

    fn attenuation(&self) -> Option<String> {
        let d = self.distance().filter(|_| self.all(&["kc", "kl", "kq"]))?;
        Some(format!("1.0 / (kc + {d} * (kl + {d} * kq))"))
    }

    /// A coefficient of the attenuation; without any, of a light that has none.
    fn coefficient(&self, input: &'static str, otherwise: &'static str) -> Option<String> {
        if self.has(input) { Some(input.into()) } else { (self.has("la") || self.has("ld")).then(|| otherwise.into()) }
    }

    fn input(&self, name: &'static str) -> Option<String> {
        self.has(name).then(|| name.into())
    }

    /// The expression over the formula's inputs that a meaning has; `None` where the formula has nothing of the kind.
    pub(crate) fn expression(&self, meaning: Meaning, from: From) -> Option<String> {
        // What comes from the stage before is normalised by the shader, what is a parameter by its caller.
        let keeps_length = from == From::Input || from == From::Uniform;
        match meaning {
            M::Normal => self.normal(keeps_length),
            M::Point => self.input("p"),
            M::Eye => (self.has("p") || self.has("v")).then(|| "vec3f(0.0)".into()),
            M::ToEye => self.to_eye(keeps_length),
            M::ToEyeWithLength => self.to_eye(true),
            M::ToLight => self.to_light(keeps_length),
            M::Travel if self.has("axis") => self.input("axis"),
            M::Travel => self
                .input("direction")
                .or_else(|| self.input("i"))
                .or_else(|| Some(format!("-({})", self.to_light(keeps_length)?))),
            M::LightPosition => self.input("position").or_else(|| self.input("light")),
            M::Half => self.half(),
            M::Reflected => self.reflected(),
            M::Shininess if self.has("cutoff_cosine") && !self.has("shininess") => self.input("exponent"),
            M::Shininess => self.input("shininess").or_else(|| self.input("exponent")),
            M::OfLight(term) => self.color(term, true),
            M::OfMaterial(term) => self.color(term, false),
            M::LightColor => self.light_color(),
            M::SurfaceColor => self.surface_color(from),
            M::Weight(term) => self.input(["ka", "kd", "ks"][term as usize]).or_else(|| {
                // Beside the term's own colour a weight is 1.
                let is_beside = self.meanings.contains(&M::OfMaterial(term));
                if is_beside { Some("1.0".into()) } else { self.color(term, false) }
            }),
            M::Emission => self.input("emissive").or_else(|| self.has("la").then(|| "vec3f(0.0)".into())),
            M::Alpha => self.input("alpha").or_else(|| Some("1.0".into())),
            M::Constant => self.coefficient("kc", "1.0"),
            M::Linear => self.coefficient("kl", "0.0"),
            M::Quadratic => self.coefficient("kq", "0.0"),
            M::Falloff if self.has("kc") => Some("vec3f(kc, kl, kq)".into()),
            M::Falloff => self.has("la").then(|| "vec3f(1.0, 0.0, 0.0)".into()),
            M::Attenuation => self.attenuation(),
            M::Distance => self.distance(),
            M::Axis => self.input("axis"),
            M::CutoffCosine => self.input("cutoff_cosine"),
            M::SpotExponent => self.has("cutoff_cosine").then(|| self.input("exponent"))?,
            M::FogColor => self.input("fog"),
            M::FogDensity => self.input("density"),
            M::FogStart => self.input("dmin"),
            M::FogEnd => self.input("dmax"),
            M::FogFactor => self.input("f"),
            M::Incidence => Some(format!("max(dot({}, {}), 0.0)", self.normal(false)?, self.to_light(false)?)),
            M::HalfCosine => Some(format!("max(dot({}, {}), 0.0)", self.normal(false)?, self.half()?)),
            M::ReflectedCosine => Some(format!("max(dot({}, {}), 0.0)", self.reflected()?, self.to_eye(false)?)),
            M::Identity => Some("1.0".into()),
            M::Count => Some("1".into()),
            M::TexturePlace => Some("0.5".into()),
            M::Source => self.input("src"),
            M::Destination => self.input("dst"),
        }
    }
}

impl Meaning {
    /// What it is, in words.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            M::Normal => "the surface's normal",
            M::Point => "the surface's position",
            M::Eye => "the eye's position, which is the origin",
            M::ToEye | M::ToEyeWithLength => "the vector towards the eye",
            M::ToLight => "the vector towards the light",
            M::Travel => "the light's direction as the formula takes it; of a spotlight, its axis",
            M::LightPosition => "the light's position",
            M::Half => "the half vector",
            M::Reflected => "the reflected vector",
            M::Shininess => "the highlight's exponent",
            M::OfLight(Ambient) => "the light's ambient colour",
            M::OfLight(Diffuse) => "the light's diffuse colour",
            M::OfLight(Specular) => "the light's specular colour",
            M::OfMaterial(Ambient) => "the material's ambient colour",
            M::OfMaterial(Diffuse) => "the material's diffuse colour",
            M::OfMaterial(Specular) => "the material's specular colour",
            M::LightColor => "the light's only colour",
            M::SurfaceColor => "the surface's only colour, or the one before fog",
            M::Weight(Ambient) => "the ambient weight",
            M::Weight(Diffuse) => "the diffuse weight",
            M::Weight(Specular) => "the specular weight",
            M::Emission => "the emission",
            M::Alpha => "alpha",
            M::Constant => "the attenuation's constant coefficient",
            M::Linear => "its linear coefficient",
            M::Quadratic => "its quadratic coefficient",
            M::Falloff => "the three coefficients as a vector",
            M::Attenuation => "the attenuation",
            M::Distance => "the distance, to the light or into the fog",
            M::Axis => "the spotlight's axis",
            M::CutoffCosine => "the cosine of the spotlight's cutoff",
            M::SpotExponent => "the spotlight's exponent",
            M::FogColor => "the fog's colour",
            M::FogDensity => "the fog's density",
            M::FogStart => "where the fog begins",
            M::FogEnd => "where the fog is full",
            M::FogFactor => "the fog's factor",
            M::Incidence => "the cosine of light and normal, not below 0",
            M::HalfCosine => "the cosine of normal and half vector, not below 0",
            M::ReflectedCosine => "the cosine of reflection and eye, not below 0",
            M::Identity => "a transform, which is the identity",
            M::Count => "the number of lights, which is 1",
            M::TexturePlace => "a place in a texture",
            M::Source => "the colour that is drawn, in blending",
            M::Destination => "the colour that is there, in blending",
        }
    }
}
