//! The effects that a frame calls for, draw by draw and light by light, each with its reason.
//!
//! An effect is called for when leaving it out could change a pixel. Where that cannot be ruled out it is called for, so the
//! analysis may call for too much and never for too little. It compares inputs with 0 and 1, and asks of a spotlight and of
//! linear fog whether the mesh's bounding box is within reach.

#![expect(clippy::float_cmp, reason = "what is exactly 0 or 1 changes nothing; anything else may")]

mod analysis;

use crate::frame::Frame;
use analysis::of_draw;
use std::fmt;

macro_rules! effects {
    ($($variant:ident $name:literal $doc:literal)*) => {
        /// Something that a scene may call for, and that costs.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Effect {
            $(#[doc = $doc] $variant,)*
        }

        impl Effect {
            /// All of them.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$variant),*];

            /// The name in reports, and of the shader file.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }
    };
}

effects! {
    Flat "flat" "Lit once a face."
    Gouraud "gouraud" "Lit at the vertices."
    Phong "phong" "Lit at the fragments."
    InverseTranspose "inverse_transpose" "Normals by the inverse transpose of the modelview rather than by itself."
    Emissive "emissive" "CE."
    AmbientProduct "ambient_product" "CA = LA * MA."
    AmbientConstant "ambient_constant" "CA, a constant."
    LightAmbient "light_ambient" "A light's own LA * MA."
    AttenuatedAmbient "attenuated_ambient" "The same weakened with distance and by the cone."
    Diffuse "diffuse" "CD."
    SpecularPhong "specular_phong" "CS of r·v."
    SpecularBlinn "specular_blinn" "CS of n·h."
    SpecularUnnormalised "specular_unnormalised" "CS of n·(v + l)."
    LocalViewer "local_viewer" "v = ⟨−p⟩ rather than (0, 0, 1)."
    Gate "gate" "No highlight on a face that is turned away."
    Directional "directional" "A light infinitely far away, its vector normalised."
    DirectionalUnit "directional_unit" "The same, its vector taken as a unit vector."
    Point "point" "A light at a point."
    Spot "spot" "A light within a cone."
    SpotExponent "spot_exponent" "A cone that is brighter in its middle."
    Attenuation "attenuation" "Light that weakens with distance."
    VertexColor "vertex_color" "Colours of the vertices."
    TextureNearest "texture_nearest" "A texture, read at the nearest texel."
    TextureBilinear "texture_bilinear" "A texture, mixed from four texels."
    TextureReplace "texture_replace" "A texture in place of the colour."
    LightmapNearest "lightmap_nearest" "A lightmap, read at the nearest texel."
    LightmapBilinear "lightmap_bilinear" "A lightmap, mixed from four texels."
    Cutout "cutout" "Fragments below a threshold of alpha left out."
    FogLinear "fog_linear" "Linear fog."
    FogExp "fog_exp" "Exponential fog."
    FogExp2Document "fog_exp2_document" "Exponential-squared fog as document 000 has it."
    FogExp2OpenGl "fog_exp2_opengl" "Exponential-squared fog as OpenGL has it."
    FogRadial "fog_radial" "Fog by the distance from the eye rather than the depth."
}

/// A set of effects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Effects(u64);

/// Effects of which a draw has one at most.
pub const EXCLUSIVE: [&[Effect]; 6] = [
    &[Effect::Flat, Effect::Gouraud, Effect::Phong],
    &[Effect::SpecularPhong, Effect::SpecularBlinn, Effect::SpecularUnnormalised],
    &[Effect::AmbientProduct, Effect::AmbientConstant],
    &[Effect::TextureNearest, Effect::TextureBilinear],
    &[Effect::LightmapNearest, Effect::LightmapBilinear],
    &[Effect::FogLinear, Effect::FogExp, Effect::FogExp2Document, Effect::FogExp2OpenGl],
];

impl Effects {
    /// None.
    pub const NONE: Self = Self(0);

    /// Whether the effect is in the set.
    #[must_use]
    pub const fn has(self, effect: Effect) -> bool {
        self.0 >> effect as u32 & 1 == 1
    }

    /// Whether any of them is.
    #[must_use]
    pub fn has_any(self, effects: &[Effect]) -> bool {
        effects.iter().any(|&effect| self.has(effect))
    }

    /// With the effect.
    #[must_use]
    pub const fn with(self, effect: Effect) -> Self {
        Self(self.0 | 1 << effect as u32)
    }

    /// Without the effect.
    #[must_use]
    pub const fn without(self, effect: Effect) -> Self {
        Self(self.0 & !(1 << effect as u32))
    }

    /// Each effect of the set.
    pub fn iter(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.into_iter().filter(move |&effect| self.has(effect))
    }

    /// One bit an effect, in the order of [`Effect::ALL`].
    #[must_use]
    pub const fn bits(self) -> u64 {
        self.0
    }

    /// Whether the light's terms vary over the surface, so that there are lights to go through.
    #[must_use]
    pub fn has_lights(self) -> bool {
        self.has_any(&[Effect::Directional, Effect::DirectionalUnit, Effect::Point, Effect::Spot])
    }

    /// Whether there is a highlight.
    #[must_use]
    pub fn has_specular(self) -> bool {
        self.has_any(&[Effect::SpecularPhong, Effect::SpecularBlinn, Effect::SpecularUnnormalised])
    }

    /// Whether there is fog.
    #[must_use]
    pub fn has_fog(self) -> bool {
        self.has_any(&[Effect::FogLinear, Effect::FogExp, Effect::FogExp2Document, Effect::FogExp2OpenGl])
    }

    /// Whether there is a texture.
    #[must_use]
    pub fn has_texture(self) -> bool {
        self.has_any(&[Effect::TextureNearest, Effect::TextureBilinear])
    }

    /// Whether there is a lightmap.
    #[must_use]
    pub fn has_lightmap(self) -> bool {
        self.has_any(&[Effect::LightmapNearest, Effect::LightmapBilinear])
    }

    /// Whether normals are called for: only incidence and highlights have use for them.
    #[must_use]
    pub fn has_normals(self) -> bool {
        self.has(Effect::Diffuse) || self.has_specular()
    }

    /// What makes this set one that no frame calls for; `None` for those that some frame does.
    #[must_use]
    pub fn contradiction(self) -> Option<&'static str> {
        use Effect as E;
        let lit = self.has(E::Diffuse) || self.has_specular() || self.has(E::LightAmbient);
        let positional = self.has_any(&[E::Point, E::Spot]);
        let at_a_frequency = self.has_any(&[E::Flat, E::Gouraud, E::Phong]);
        let rules = [
            (EXCLUSIVE.iter().any(|set| set.iter().filter(|&&e| self.has(e)).count() > 1), "two of one kind"),
            (lit != self.has_lights(), "lights and terms of lights go together"),
            (lit && !at_a_frequency, "lights shine at a frequency"),
            (
                !lit && self.has_any(&[E::Flat, E::Phong]),
                "without lights there is nothing to light at a face or a fragment",
            ),
            (
                self.has(E::Gouraud) && !lit && !self.has_any(&[E::Emissive, E::AmbientProduct, E::AmbientConstant]),
                "nothing to interpolate",
            ),
            (self.has(E::InverseTranspose) && !self.has_normals(), "no use for normals"),
            (self.has_any(&[E::LocalViewer, E::Gate]) && !self.has_specular(), "no highlight"),
            (self.has(E::Attenuation) && !positional, "no light at a point"),
            (self.has(E::SpotExponent) && !self.has(E::Spot), "no spotlight"),
            (
                self.has(E::AttenuatedAmbient)
                    && !(self.has(E::LightAmbient) && (self.has(E::Attenuation) || self.has(E::Spot))),
                "no light's ambient term that could be weakened",
            ),
            (self.has(E::TextureReplace) && !self.has_texture(), "no texture"),
            (self.has(E::FogRadial) && !self.has_fog(), "no fog"),
        ];
        rules.into_iter().find(|(broken, _)| *broken).map(|(_, says)| says)
    }
}

impl FromIterator<Effect> for Effects {
    fn from_iter<I: IntoIterator<Item = Effect>>(effects: I) -> Self {
        effects.into_iter().fold(Self::NONE, Self::with)
    }
}

impl fmt::Display for Effects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.iter().map(Effect::name).collect();
        if names.is_empty() { f.write_str("none") } else { f.write_str(&names.join(" ")) }
    }
}

/// What one draw calls for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Called {
    /// The effects.
    pub effects: Effects,
    /// The lights whose terms could change a pixel, by their places in the frame.
    pub lights: Vec<usize>,
    /// Why each effect and each light is called for, or is not.
    pub reasons: Vec<Reason>,
}

/// Why something is called for, or is not.
#[derive(Clone, Debug, PartialEq)]
pub struct Reason {
    /// What.
    pub subject: ReasonSubject,
    /// Whether it is.
    pub called: bool,
    /// Why.
    pub why: String,
}

/// What a reason is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReasonSubject {
    /// An effect.
    Effect(Effect),
    /// A light, by its place in the frame.
    Light(usize),
}

/// What each draw of the frame calls for.
#[must_use]
pub fn effects(frame: &Frame) -> Vec<Called> {
    frame.draws.iter().map(|draw| of_draw(frame, draw, false)).collect()
}

/// What each draw's description names, whether or not it could change a pixel: what a renderer without this analysis computes.
#[must_use]
pub fn named(frame: &Frame) -> Vec<Called> {
    frame.draws.iter().map(|draw| of_draw(frame, draw, true)).collect()
}
