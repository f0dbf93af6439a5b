//! The effects that a frame calls for, draw by draw and light by light, each with its reason.
//!
//! An effect is called for when leaving it out could change a pixel. Where that cannot be ruled out it is called for, so the
//! analysis may call for too much and never for too little. It compares inputs with 0 and 1, and asks of a spotlight and of
//! linear fog whether the mesh's bounding box is within reach.

#![expect(clippy::float_cmp, reason = "what is exactly 0 or 1 changes nothing; anything else may")]

use crate::frame::{Draw, Filter, FogForm, Frame, Light, Place, Sampled};
use crate::shading::{Ambient, Distance, Frequency, Gate, LightAmbient, Normals, Specular, Viewer};
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
        let exclusive: [&[E]; 6] = [
            &[E::Flat, E::Gouraud, E::Phong],
            &[E::SpecularPhong, E::SpecularBlinn, E::SpecularUnnormalised],
            &[E::AmbientProduct, E::AmbientConstant],
            &[E::TextureNearest, E::TextureBilinear],
            &[E::LightmapNearest, E::LightmapBilinear],
            &[E::FogLinear, E::FogExp, E::FogExp2Document, E::FogExp2OpenGl],
        ];
        let lit = self.has(E::Diffuse) || self.has_specular() || self.has(E::LightAmbient);
        let positional = self.has_any(&[E::Point, E::Spot]);
        let at_a_frequency = self.has_any(&[E::Flat, E::Gouraud, E::Phong]);
        let rules = [
            (exclusive.iter().any(|set| set.iter().filter(|&&e| self.has(e)).count() > 1), "two of one kind"),
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
    pub subject: Subject,
    /// Whether it is.
    pub called: bool,
    /// Why.
    pub why: String,
}

/// What a reason is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
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

/// The analysis of one draw.
struct Analysis<'a> {
    frame: &'a Frame,
    draw: &'a Draw,
    /// Call for what is named even where it changes nothing.
    everything: bool,
    called: Called,
}

fn of_draw(frame: &Frame, draw: &Draw, everything: bool) -> Called {
    let mut analysis = Analysis { frame, draw, everything, called: Called::default() };
    analysis.lighting();
    analysis.surface();
    analysis.fog();
    analysis.called
}

impl Analysis<'_> {
    /// An effect that changes something, or may as well be left out.
    fn worth(&mut self, effect: Effect, changes: bool, why: impl Into<String>) {
        self.choice(effect, changes || self.everything, why);
    }

    /// An effect that the description chooses.
    fn choice(&mut self, effect: Effect, chosen: bool, why: impl Into<String>) {
        if chosen {
            self.called.effects = self.called.effects.with(effect);
        }
        self.called.reasons.push(Reason { subject: Subject::Effect(effect), called: chosen, why: why.into() });
    }

    /// Whether nothing of the colour is left, so that what it is made from changes nothing.
    fn is_replaced(&self) -> bool {
        !self.everything && self.draw.texture.is_some_and(|textured| textured.replaces)
    }

    fn lighting(&mut self) {
        let (frame, draw) = (self.frame, self.draw);
        let (Some(shading), material) = (draw.shading, &draw.material) else { return };
        if self.is_replaced() {
            let why = "a texture stands in its place";
            let light = |place| Reason { subject: Subject::Light(place), called: false, why: why.into() };
            self.called.reasons.extend((0..frame.lights.len()).map(light));
            let effect = match shading.frequency {
                Frequency::Flat => Effect::Flat,
                Frequency::Gouraud => Effect::Gouraud,
                Frequency::Phong => Effect::Phong,
            };
            self.choice(effect, false, why);
            return;
        }
        self.worth(Effect::Emissive, any(material.emissive), format!("CE is {}", triple(material.emissive)));
        match frame.ambient_form {
            Ambient::Product => self.worth(
                Effect::AmbientProduct,
                both(frame.ambient, material.ambient),
                format!("LA is {} and MA {}", triple(frame.ambient), triple(material.ambient)),
            ),
            Ambient::Constant => {
                let why = format!("the ambient constant is {}", triple(frame.ambient));
                self.worth(Effect::AmbientConstant, any(frame.ambient), why);
            }
        }
        let terms = self.lights();
        self.choice(Effect::LightAmbient, terms.ambient, "LA * MA of a light");
        self.choice(Effect::Diffuse, terms.diffuse, "LD * MD of a light");
        let specular = match shading.specular {
            Specular::Phong => Effect::SpecularPhong,
            Specular::Blinn => Effect::SpecularBlinn,
            Specular::BlinnUnnormalised => Effect::SpecularUnnormalised,
        };
        self.choice(specular, terms.specular, "LS * MS of a light");
        if terms.specular {
            self.choice(Effect::LocalViewer, shading.viewer == Viewer::Local, "the viewer of the highlight");
            self.choice(Effect::Gate, shading.gate == Gate::OpenGl, "highlights on faces that are turned away");
        }
        self.kinds(&terms);
        let lit = !self.called.lights.is_empty();
        match shading.frequency {
            Frequency::Flat => self.choice(Effect::Flat, lit, "its colour varies with the face"),
            // A constant colour that is interpolated is rounded, which leaving that out would change.
            Frequency::Gouraud => {
                let constant = [Effect::Emissive, Effect::AmbientProduct, Effect::AmbientConstant];
                let any = lit || self.called.effects.has_any(&constant);
                self.choice(Effect::Gouraud, any, "its colour is interpolated");
            }
            Frequency::Phong => self.choice(Effect::Phong, lit, "its colour varies with position and normal"),
        }
        if terms.diffuse || terms.specular {
            let by = shading.normals == Normals::InverseTranspose;
            self.choice(Effect::InverseTranspose, by, "how normals are brought to eye space");
        }
    }

    /// The lights that shine on the draw, and which terms they give.
    fn lights(&mut self) -> Terms {
        let (frame, draw) = (self.frame, self.draw);
        let mut terms = Terms::default();
        for (place, light) in frame.lights.iter().enumerate() {
            let of = if self.everything { Terms::ALL } else { Terms::of(light, draw) };
            let reach = if self.everything { None } else { out_of_reach(frame, draw, light) };
            let keeps_ambient = of.ambient && frame.light_ambient == LightAmbient::Documents;
            let (shines, why) = match (of.any(), reach) {
                (false, _) => (false, "each of its colours times the material's is 0".to_owned()),
                (true, Some(why)) if !keeps_ambient => (false, why),
                (true, Some(why)) => (true, format!("{why}, but its ambient term is not bound to the cone")),
                (true, None) => (true, of.to_string()),
            };
            self.called.reasons.push(Reason { subject: Subject::Light(place), called: shines, why });
            if shines {
                self.called.lights.push(place);
                terms = terms.or(&of);
            }
        }
        terms
    }

    /// The kinds of light among those that shine.
    fn kinds(&mut self, terms: &Terms) {
        let places: Vec<Place> = self.called.lights.iter().map(|&light| self.frame.lights[light].place).collect();
        let count = |is: &dyn Fn(&Place) -> bool| places.iter().filter(|place| is(place)).count();
        let directional = count(&|p| matches!(p, Place::Directional { unit: false, .. }));
        let unit = count(&|p| matches!(p, Place::Directional { unit: true, .. }));
        let point = count(&|p| matches!(p, Place::Point { .. }));
        let spot = count(&|p| matches!(p, Place::Spot { .. }));
        self.choice(Effect::Directional, directional > 0, format!("{directional} directional, normalised"));
        self.choice(Effect::DirectionalUnit, unit > 0, format!("{unit} directional, taken as unit"));
        self.choice(Effect::Point, point > 0, format!("{point} at a point"));
        self.choice(Effect::Spot, spot > 0, format!("{spot} within a cone"));
        let attenuated = count(&|p| falloff(p).is_some_and(|falloff| falloff != [1.0, 0.0, 0.0]));
        let exponents = count(&|p| matches!(p, Place::Spot { exponent, .. } if *exponent != 0.0));
        if spot > 0 {
            self.worth(Effect::SpotExponent, exponents > 0, format!("{exponents} with an exponent other than 0"));
        }
        if point + spot > 0 {
            self.worth(
                Effect::Attenuation,
                attenuated > 0,
                format!("{attenuated} with a falloff other than (1, 0, 0)"),
            );
        }
        if self.frame.light_ambient == LightAmbient::OpenGl && terms.ambient && point + spot > 0 {
            let why = "the dialect weakens ambient terms";
            self.worth(Effect::AttenuatedAmbient, spot + attenuated > 0, why);
        }
    }

    fn surface(&mut self) {
        let (frame, draw) = (self.frame, self.draw);
        if draw.vertex_colors {
            // Ones that are interpolated are rounded, which leaving them out would change.
            let replaced = self.is_replaced();
            let why = if replaced { "a texture stands in their place" } else { "colours of the vertices" };
            self.choice(Effect::VertexColor, !replaced, why);
        }
        if let Some(textured) = draw.texture {
            let changes = textured.replaces || !is_white(frame, textured.sampled);
            let effect = match textured.sampled.filter {
                Filter::Nearest => Effect::TextureNearest,
                Filter::Bilinear => Effect::TextureBilinear,
            };
            self.worth(effect, changes, if changes { "its texels" } else { "every texel is 1" });
            self.choice(Effect::TextureReplace, textured.replaces, "whether it stands in the colour's place");
        }
        if let Some(sampled) = draw.lightmap {
            let changes = !is_white(frame, sampled);
            let effect = match sampled.filter {
                Filter::Nearest => Effect::LightmapNearest,
                Filter::Bilinear => Effect::LightmapBilinear,
            };
            self.worth(effect, changes, if changes { "its texels" } else { "every texel is 1" });
        }
        if let Some(threshold) = draw.cutout {
            self.worth(Effect::Cutout, threshold > 0.0, format!("alpha below {threshold} is left out"));
        }
    }

    fn fog(&mut self) {
        let Some(fog) = &self.frame.fog else { return };
        let dense = |density: f32| (density != 0.0, format!("its density is {density}"));
        let (effect, (changes, why)) = match fog.form {
            FogForm::Linear { dmin, dmax } => (Effect::FogLinear, self.reaches_linear_fog(fog.distance, [dmin, dmax])),
            FogForm::Exp { density } => (Effect::FogExp, dense(density)),
            FogForm::Exp2Document { density } => (Effect::FogExp2Document, dense(density)),
            FogForm::Exp2OpenGl { density } => (Effect::FogExp2OpenGl, dense(density)),
        };
        self.worth(effect, changes, why);
        if self.called.effects.has(effect) {
            self.choice(Effect::FogRadial, fog.distance == Distance::Radial, "which distance the fog is of");
        }
    }

    fn reaches_linear_fog(&self, distance: Distance, [dmin, dmax]: [f32; 2]) -> (bool, String) {
        let farthest = Bounds::of(self.frame, self.draw).farthest(distance);
        let before = dmin < dmax && farthest < f64::from(dmin);
        let what = if before { "nothing is farther than" } else { "the surface reaches to" };
        (!before, format!("it begins at {dmin}, and {what} {farthest:.3}"))
    }
}

/// Which terms of a light are not 0 on a material.
#[derive(Clone, Copy, Debug, Default)]
struct Terms {
    ambient: bool,
    diffuse: bool,
    specular: bool,
}

impl Terms {
    const ALL: Self = Self { ambient: true, diffuse: true, specular: true };

    fn of(light: &Light, draw: &Draw) -> Self {
        Self {
            ambient: both(light.ambient, draw.material.ambient),
            diffuse: both(light.diffuse, draw.material.diffuse),
            specular: both(light.specular, draw.material.specular),
        }
    }

    const fn any(&self) -> bool {
        self.ambient || self.diffuse || self.specular
    }

    const fn or(&self, other: &Self) -> Self {
        Self {
            ambient: self.ambient || other.ambient,
            diffuse: self.diffuse || other.diffuse,
            specular: self.specular || other.specular,
        }
    }
}

impl fmt::Display for Terms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = [(self.ambient, "ambient"), (self.diffuse, "diffuse"), (self.specular, "specular")];
        let names: Vec<&str> = named.into_iter().filter(|(has, _)| *has).map(|(_, name)| name).collect();
        write!(f, "it gives {} light", names.join(" and "))
    }
}

fn any(color: [f32; 3]) -> bool {
    color.iter().any(|&c| c != 0.0)
}

/// Whether some component of the product is not 0 by its factors.
fn both(a: [f32; 3], b: [f32; 3]) -> bool {
    a.iter().zip(b).any(|(&a, b)| a != 0.0 && b != 0.0)
}

fn triple([r, g, b]: [f32; 3]) -> String {
    format!("({r}, {g}, {b})")
}

const fn falloff(place: &Place) -> Option<[f32; 3]> {
    match place {
        Place::Directional { .. } => None,
        Place::Point { falloff, .. } | Place::Spot { falloff, .. } => Some(*falloff),
    }
}

/// Whether a texture multiplies by 1 exactly. A mix of ones is rounded.
fn is_white(frame: &Frame, sampled: Sampled) -> bool {
    sampled.filter == Filter::Nearest && frame.textures[sampled.texture].texels.iter().all(|texel| *texel == [1.0; 4])
}

/// Why a spotlight's cone misses the mesh; `None` where it may not.
///
/// The box's ball is seen from the light under an angle of asin(radius/distance). It is missed where the angle between the
/// axis and its middle is beyond the cutoff by more than that; a hundredth of a radian is kept for rounding.
fn out_of_reach(frame: &Frame, draw: &Draw, light: &Light) -> Option<String> {
    let Place::Spot { position, axis, cutoff_cosine, .. } = light.place else { return None };
    let bounds = Bounds::of(frame, draw);
    let toward: [f64; 3] = std::array::from_fn(|k| bounds.middle()[k] - f64::from(position[k]));
    let axis = axis.map(f64::from);
    let distance = length(toward);
    if distance <= bounds.radius() * 1.01 {
        return None;
    }
    let cosine = (0..3).map(|k| toward[k] * axis[k]).sum::<f64>() / (distance * length(axis));
    let beyond = cosine.clamp(-1.0, 1.0).acos() - (bounds.radius() / distance).asin();
    let cutoff = f64::from(cutoff_cosine).clamp(-1.0, 1.0).acos();
    (beyond > cutoff + 0.01).then(|| {
        format!("its cone ends at {:.1}°, and the mesh begins at {:.1}°", cutoff.to_degrees(), beyond.to_degrees())
    })
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A box in eye space around a draw's mesh.
struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    fn of(frame: &Frame, draw: &Draw) -> Self {
        let mut bounds = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        for position in &frame.meshes[draw.mesh].positions {
            for k in 0..3 {
                let m = |column: usize| f64::from(draw.modelview[column][k]);
                let [x, y, z] = position.map(f64::from);
                let at = m(0) * x + m(1) * y + m(2) * z + m(3);
                bounds.low[k] = bounds.low[k].min(at);
                bounds.high[k] = bounds.high[k].max(at);
            }
        }
        bounds
    }

    fn middle(&self) -> [f64; 3] {
        std::array::from_fn(|k| f64::midpoint(self.low[k], self.high[k]))
    }

    fn radius(&self) -> f64 {
        length(std::array::from_fn(|k| self.high[k] - self.low[k])) / 2.0
    }

    /// No point of the mesh is farther, a thousandth kept for rounding.
    fn farthest(&self, distance: Distance) -> f64 {
        let reach: [f64; 3] = std::array::from_fn(|k| self.low[k].abs().max(self.high[k].abs()));
        1.001 * if distance == Distance::Planar { reach[2] } else { length(reach) }
    }
}
