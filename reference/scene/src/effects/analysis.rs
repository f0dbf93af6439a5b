//! What one draw calls for, and why.

use super::{Called, Effect, Reason, ReasonSubject};
use crate::frame::{Draw, FogForm, Frame, Light, Place, Sampled, Shading, TextureFilter};
use crate::shading::{Ambient, Distance, Frequency, LightAmbient, Normals, Specular, SpecularGate, Viewer};
use std::fmt;

/// The analysis of one draw.
struct Analysis<'a> {
    frame: &'a Frame,
    draw: &'a Draw,
    /// Call for what is named even where it changes nothing.
    everything: bool,
    called: Called,
}

pub(super) fn of_draw(frame: &Frame, draw: &Draw, everything: bool) -> Called {
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
        self.called.reasons.push(Reason { subject: ReasonSubject::Effect(effect), called: chosen, why: why.into() });
    }

    /// Whether nothing of the colour is left, so that what it is made from changes nothing.
    fn is_replaced(&self) -> bool {
        !self.everything && self.draw.texture.is_some_and(|textured| textured.replaces)
    }

    fn lighting(&mut self) {
        let Some(shading) = self.draw.shading else { return };
        if self.is_replaced() {
            return self.replaced_lighting(shading.frequency);
        }
        self.ambient();
        let terms = self.lights();
        self.choice(Effect::LightAmbient, terms.ambient, of_a_light(terms.ambient, "LA * MA"));
        self.choice(Effect::Diffuse, terms.diffuse, of_a_light(terms.diffuse, "LD * MD"));
        self.highlight(&shading, &terms);
        self.kinds(&terms);
        self.frequency(shading.frequency);
        if terms.diffuse || terms.specular {
            let by = shading.normals == Normals::InverseTranspose;
            let why = if by { "the dialect of normals" } else { "normals are brought to eye space by the modelview" };
            self.choice(Effect::InverseTranspose, by, why);
        }
    }

    /// The lighting of a draw whose colour a texture replaces: none of it is called for.
    fn replaced_lighting(&mut self, frequency: Frequency) {
        let why = "a texture stands in its place";
        let light = |place| Reason { subject: ReasonSubject::Light(place), called: false, why: why.into() };
        self.called.reasons.extend((0..self.frame.lights.len()).map(light));
        let effect = match frequency {
            Frequency::Flat => Effect::Flat,
            Frequency::Gouraud => Effect::Gouraud,
            Frequency::Phong => Effect::Phong,
        };
        self.choice(effect, false, why);
    }

    /// The terms that no light gives: the emitted colour and the scene's ambient light.
    fn ambient(&mut self) {
        let (frame, material) = (self.frame, &self.draw.material);
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
    }

    /// The specular term by its form, where the viewer is for it, and OpenGL's gate.
    fn highlight(&mut self, shading: &Shading, terms: &Terms) {
        let specular = match shading.specular {
            Specular::Phong => Effect::SpecularPhong,
            Specular::Blinn => Effect::SpecularBlinn,
            Specular::BlinnUnnormalised => Effect::SpecularUnnormalised,
        };
        self.choice(specular, terms.specular, of_a_light(terms.specular, "LS * MS"));
        if !terms.specular {
            return;
        }
        let local = shading.viewer == Viewer::Local;
        let why = if local { "the viewer is at the eye" } else { "the viewer is infinitely far away" };
        self.choice(Effect::LocalViewer, local, why);
        let gated = shading.gate == SpecularGate::OpenGl;
        let why =
            if gated { "a face that is turned away has no highlight" } else { "one that is turned away may have one" };
        self.choice(Effect::Gate, gated, why);
    }

    /// Where the lighting is computed.
    fn frequency(&mut self, frequency: Frequency) {
        let lit = !self.called.lights.is_empty();
        match frequency {
            Frequency::Flat => self.choice(Effect::Flat, lit, "its colour varies with the face"),
            // A constant colour that is interpolated is rounded, which leaving that out would change.
            Frequency::Gouraud => {
                let constant = [Effect::Emissive, Effect::AmbientProduct, Effect::AmbientConstant];
                let any = lit || self.called.effects.has_any(&constant);
                self.choice(Effect::Gouraud, any, "its colour is interpolated");
            }
            Frequency::Phong => self.choice(Effect::Phong, lit, "its colour varies with position and normal"),
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
            self.called.reasons.push(Reason { subject: ReasonSubject::Light(place), called: shines, why });
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
                TextureFilter::Nearest => Effect::TextureNearest,
                TextureFilter::Bilinear => Effect::TextureBilinear,
            };
            self.worth(effect, changes, if changes { "its texels" } else { "every texel is 1" });
            let why = if textured.replaces { "it stands in the colour's place" } else { "it multiplies the colour" };
            self.choice(Effect::TextureReplace, textured.replaces, why);
        }
        if let Some(sampled) = draw.lightmap {
            let changes = !is_white(frame, sampled);
            let effect = match sampled.filter {
                TextureFilter::Nearest => Effect::LightmapNearest,
                TextureFilter::Bilinear => Effect::LightmapBilinear,
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
            let radial = fog.distance == Distance::Radial;
            let why = if radial { "it is of the distance from the eye" } else { "it is of the depth" };
            self.choice(Effect::FogRadial, radial, why);
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

fn of_a_light(called: bool, product: &str) -> String {
    if called { format!("{product} of a light is not 0") } else { format!("{product} of every light is 0") }
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
    sampled.filter == TextureFilter::Nearest
        && frame.textures[sampled.texture].texels.iter().all(|texel| *texel == [1.0; 4])
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
