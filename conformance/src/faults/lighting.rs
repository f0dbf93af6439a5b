//! Lighting with mistakes: one model of a lit surface whose every step can be wrong, arranged as each formula of the family has
//! it. Without a mistake it computes what the formula does (a test holds that).

use super::row::{Row, put};
use crate::cases::Spec;
use lightmeter_reference::attenuation::{polynomial, spot_exponent};
use lightmeter_reference::lighting::{cosine_power_by_chord, cosine_power_by_schlick};
use lightmeter_reference::vector::{face_normal, halfway, halfway_unnormalised, reflect};
use lightmeter_reference::{Real, Vec3, Vector};
use std::f64::consts::FRAC_1_PI;

/// A step of the model that goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Twist {
    NormalNotNormalised,
    LightNotNormalised,
    LightReversed,
    PositionAsDirection,
    DirectionAsPosition,
    ViewNotNormalised,
    ViewReversed,
    ViewerAtInfinity,
    ReflectWithPlus,
    ReflectOfToward,
    BlinnForPhong,
    PhongForBlinn,
    HalfNotNormalised,
    HalfNormalised,
    IncidenceUnclamped,
    IncidenceOfBothSides,
    HalfLambert,
    NoIncidence,
    LobeOfBothSides,
    SchlickPower,
    Gated,
    NotGated,
    SpecularTimesIncidence,
    NormalisedLobeWithFresnel,
    EnergyConservingLobe,
    OverPi,
    NoAmbient,
    AmbientTwice,
    NoDiffuse,
    NoSpecular,
    AmbientAttenuated,
    AmbientNotAttenuated,
    DiffuseNotAttenuated,
    SpecularNotAttenuated,
    DistanceSquaredTwice,
    AttenuationNotInverted,
    NotAttenuated,
    NoCone,
    NoCutoff,
    SmoothCone,
    SpecularNotInCone,
    GouraudForPhong,
    PhongForGouraud,
    VectorsAtTheVertices,
    LitAtTheLastVertex,
    LitAtTheMiddle,
    OneLightAlone,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    /// The way light travels.
    Travel,
    /// A vector to the light.
    Toward,
    /// A place.
    Position,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edge {
    Gouraud,
    Phong,
    Interpolated,
    /// Between unit vectors.
    UnitVectors,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Arrangement {
    /// LD * MD * max(l·n, 0) alone.
    Diffuse(Source, &'static str),
    /// A power of the cosine between two inputs, the exponent of a name.
    Power([&'static str; 2], &'static str),
    /// A surface under a light.
    Surface(Source),
    /// Document 004's pair.
    TwoLights,
    /// Between two vertices.
    Edge(Edge),
    /// A face.
    Face,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cosine {
    Phong,
    Blinn,
    BlinnUnnormalised,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mirror {
    Right,
    WithPlus,
    OfToward,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum View {
    Local,
    NotNormalised,
    Reversed,
    Infinity,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Incidence {
    Max,
    Unclamped,
    Abs,
    HalfLambert,
    One,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lobe {
    Max,
    Abs,
    Schlick,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Strength {
    Plain,
    TimesIncidence,
    NormalisedWithFresnel,
    EnergyConserving,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Attenuation {
    Right,
    DistanceSquared,
    NotInverted,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cone {
    None,
    Right,
    Ignored,
    NoCutoff,
    Smooth,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LitAt {
    First,
    Last,
    Middle,
}

/// How each step is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Model {
    arrangement: Arrangement,
    normal_normalised: bool,
    light_normalised: bool,
    light_reversed: bool,
    position_as_direction: bool,
    direction_as_position: bool,
    view: View,
    cosine: Cosine,
    mirror: Mirror,
    incidence: Incidence,
    lobe: Lobe,
    /// Powers by the chord between the vectors.
    by_chord: bool,
    gated: bool,
    strength: Strength,
    over_pi: bool,
    ambient: u8,
    diffuse: bool,
    specular: bool,
    attenuation: Attenuation,
    /// Of ambient, diffuse and specular.
    attenuated: [bool; 3],
    cone: Cone,
    specular_in_cone: bool,
    lit_at: LitAt,
    both_lights: bool,
}

/// The model of a formula, right throughout; `None` where there is none.
fn right(id: &str) -> Option<Model> {
    use Arrangement::{Diffuse, Face, Power, Surface, TwoLights};
    let arrangement = match id {
        "lighting/diffuse-toward" => Diffuse(Source::Toward, "l"),
        "lighting/diffuse-travel" => Diffuse(Source::Travel, "i"),
        "lighting/specular-phong" => Power(["r", "v"], "shininess"),
        "lighting/specular-blinn" => Power(["n", "h"], "shininess"),
        "lighting/cosine-power" | "lighting/cosine-power-unguarded" | "lighting/cosine-power-by-chord" => {
            Power(["a", "b"], "exponent")
        }
        "lighting/phong"
        | "lighting/blinn"
        | "lighting/phong-gated"
        | "lighting/blinn-unnormalised"
        | "lighting/phong-unit-light"
        | "lighting/phong-nonlocal"
        | "lighting/blinn-stable" => Surface(Source::Travel),
        "lighting/point-phong"
        | "lighting/point-blinn"
        | "lighting/point-opengl"
        | "lighting/spot"
        | "lighting/scalar-material" => Surface(Source::Position),
        "lighting/two-lights" => TwoLights,
        "lighting/gouraud" => Arrangement::Edge(Edge::Gouraud),
        "lighting/phong-shading" => Arrangement::Edge(Edge::Phong),
        "lighting/phong-interpolated" => Arrangement::Edge(Edge::Interpolated),
        "lighting/flat" => Face,
        _ => return None,
    };
    let is = |ids: &[&str]| ids.iter().any(|name| id.strip_prefix("lighting/") == Some(name));
    let attenuated = is(&["point-phong", "point-blinn", "point-opengl", "spot"]);
    let cosine = if is(&["blinn", "point-blinn", "point-opengl", "blinn-stable", "two-lights"]) {
        Cosine::Blinn
    } else if is(&["blinn-unnormalised"]) {
        Cosine::BlinnUnnormalised
    } else {
        Cosine::Phong
    };
    Some(Model {
        arrangement,
        normal_normalised: true,
        light_normalised: !is(&["phong-unit-light", "phong-nonlocal"]),
        light_reversed: false,
        position_as_direction: false,
        direction_as_position: false,
        view: if is(&["phong-nonlocal"]) { View::Infinity } else { View::Local },
        cosine,
        mirror: Mirror::Right,
        incidence: Incidence::Max,
        lobe: Lobe::Max,
        by_chord: is(&["cosine-power-by-chord", "blinn-stable"]),
        gated: is(&["phong-gated", "point-opengl", "blinn-stable"]),
        strength: Strength::Plain,
        over_pi: false,
        ambient: 1,
        diffuse: true,
        specular: true,
        attenuation: if attenuated { Attenuation::Right } else { Attenuation::None },
        attenuated: [is(&["point-opengl"]), attenuated, attenuated],
        cone: if is(&["spot"]) { Cone::Right } else { Cone::None },
        specular_in_cone: true,
        lit_at: LitAt::First,
        both_lights: true,
    })
}

impl Model {
    /// Whether it computes n, l and v by itself and lights a point with them.
    const fn is_lit(&self) -> bool {
        !matches!(self.arrangement, Arrangement::Diffuse(..) | Arrangement::Power(..))
    }

    const fn has_incidence(&self) -> bool {
        !matches!(self.arrangement, Arrangement::Power(..))
    }

    const fn has_lobe(&self) -> bool {
        !matches!(self.arrangement, Arrangement::Diffuse(..))
    }

    const fn has_ambient(&self) -> bool {
        matches!(self.arrangement, Arrangement::Surface(_) | Arrangement::TwoLights)
    }

    const fn has_position(&self) -> bool {
        self.is_lit() && !matches!(self.arrangement, Arrangement::Surface(Source::Travel | Source::Toward))
    }

    /// Makes the mistake; `false` where the model has no such step, or does it so by right.
    fn twist(&mut self, twist: Twist) -> bool {
        let before = *self;
        let lit = self.is_lit();
        let attenuated = self.attenuated[1];
        match twist {
            Twist::NormalNotNormalised if lit && !matches!(self.arrangement, Arrangement::Face) => {
                self.normal_normalised = false;
            }
            Twist::LightNotNormalised if lit => self.light_normalised = false,
            Twist::LightReversed if lit => self.light_reversed = true,
            Twist::PositionAsDirection if self.has_position() => self.position_as_direction = true,
            Twist::DirectionAsPosition
                if matches!(self.arrangement, Arrangement::Surface(Source::Travel))
                    && !matches!(self.view, View::Infinity) =>
            {
                self.direction_as_position = true;
            }
            Twist::ViewNotNormalised if lit && self.view == View::Local => self.view = View::NotNormalised,
            Twist::ViewReversed if lit && self.view == View::Local => self.view = View::Reversed,
            Twist::ViewerAtInfinity if lit => self.view = View::Infinity,
            Twist::ReflectWithPlus if lit && self.cosine == Cosine::Phong => self.mirror = Mirror::WithPlus,
            Twist::ReflectOfToward if lit && self.cosine == Cosine::Phong => self.mirror = Mirror::OfToward,
            Twist::BlinnForPhong if lit && self.cosine == Cosine::Phong => self.cosine = Cosine::Blinn,
            Twist::PhongForBlinn if lit && self.cosine != Cosine::Phong => self.cosine = Cosine::Phong,
            Twist::HalfNotNormalised if lit && self.cosine == Cosine::Blinn => self.cosine = Cosine::BlinnUnnormalised,
            Twist::HalfNormalised if lit && self.cosine == Cosine::BlinnUnnormalised => self.cosine = Cosine::Blinn,
            Twist::IncidenceUnclamped if self.has_incidence() => self.incidence = Incidence::Unclamped,
            Twist::IncidenceOfBothSides if self.has_incidence() => self.incidence = Incidence::Abs,
            Twist::HalfLambert if self.has_incidence() => self.incidence = Incidence::HalfLambert,
            Twist::NoIncidence if self.has_incidence() => self.incidence = Incidence::One,
            Twist::LobeOfBothSides if self.has_lobe() => self.lobe = Lobe::Abs,
            Twist::SchlickPower if self.has_lobe() => self.lobe = Lobe::Schlick,
            Twist::Gated if lit => self.gated = true,
            Twist::NotGated if lit => self.gated = false,
            Twist::SpecularTimesIncidence if lit => self.strength = Strength::TimesIncidence,
            Twist::NormalisedLobeWithFresnel if lit => self.strength = Strength::NormalisedWithFresnel,
            Twist::EnergyConservingLobe if self.has_lobe() => self.strength = Strength::EnergyConserving,
            Twist::OverPi if self.has_incidence() => self.over_pi = true,
            Twist::NoAmbient if self.has_ambient() => self.ambient = 0,
            Twist::AmbientTwice if self.has_ambient() => self.ambient = 2,
            Twist::NoDiffuse if lit => self.diffuse = false,
            Twist::NoSpecular if lit => self.specular = false,
            Twist::AmbientAttenuated if attenuated => self.attenuated[0] = true,
            Twist::AmbientNotAttenuated if attenuated => self.attenuated[0] = false,
            Twist::DiffuseNotAttenuated if attenuated => self.attenuated[1] = false,
            Twist::SpecularNotAttenuated if attenuated => self.attenuated[2] = false,
            Twist::DistanceSquaredTwice if attenuated => self.attenuation = Attenuation::DistanceSquared,
            Twist::AttenuationNotInverted if attenuated => self.attenuation = Attenuation::NotInverted,
            Twist::NotAttenuated if attenuated => self.attenuation = Attenuation::None,
            Twist::NoCone if self.cone == Cone::Right => self.cone = Cone::Ignored,
            Twist::NoCutoff if self.cone == Cone::Right => self.cone = Cone::NoCutoff,
            Twist::SmoothCone if self.cone == Cone::Right => self.cone = Cone::Smooth,
            Twist::SpecularNotInCone if self.cone == Cone::Right => self.specular_in_cone = false,
            Twist::GouraudForPhong => self.edge(&[Edge::Phong, Edge::Interpolated], Edge::Gouraud),
            Twist::PhongForGouraud => self.edge(&[Edge::Gouraud], Edge::Phong),
            Twist::VectorsAtTheVertices => self.edge(&[Edge::Phong, Edge::Interpolated], Edge::UnitVectors),
            Twist::LitAtTheLastVertex if matches!(self.arrangement, Arrangement::Face) => self.lit_at = LitAt::Last,
            Twist::LitAtTheMiddle if matches!(self.arrangement, Arrangement::Face) => self.lit_at = LitAt::Middle,
            Twist::OneLightAlone if matches!(self.arrangement, Arrangement::TwoLights) => self.both_lights = false,
            _ => {}
        }
        *self != before
    }

    fn edge(&mut self, from: &[Edge], to: Edge) {
        if let Arrangement::Edge(edge) = &mut self.arrangement
            && from.contains(edge)
        {
            *edge = to;
        }
    }

    fn normal<R: Real>(&self, n: Vec3<R>) -> Vec3<R> {
        if self.normal_normalised { n.normalize() } else { n }
    }

    fn eye<R: Real>(&self, p: Vec3<R>) -> Vec3<R> {
        match self.view {
            View::Local => (-p).normalize(),
            View::NotNormalised => -p,
            View::Reversed => p.normalize(),
            View::Infinity => Vector([0.0, 0.0, 1.0].map(R::literal)),
        }
    }

    /// The vector that is taken for l.
    fn light<R: Real>(&self, source: Source, light: Vec3<R>, p: Vec3<R>) -> Vec3<R> {
        let unnormalised = match source {
            Source::Travel if self.direction_as_position => -light - p,
            Source::Travel => -light,
            Source::Toward => light,
            Source::Position if self.position_as_direction => light,
            Source::Position => light - p,
        };
        let l = if self.light_normalised { unnormalised.normalize() } else { unnormalised };
        if self.light_reversed { -l } else { l }
    }

    fn incidence<R: Real>(&self, l: Vec3<R>, n: Vec3<R>) -> R {
        let cosine = l.dot(n);
        let half = R::literal(0.5);
        match self.incidence {
            Incidence::Max => cosine.max(R::literal(0.0)),
            Incidence::Unclamped => cosine,
            Incidence::Abs => cosine.abs(),
            Incidence::HalfLambert => {
                let wrapped = half * cosine + half;
                wrapped * wrapped
            }
            Incidence::One => R::literal(1.0),
        }
    }

    fn power<R: Real>(&self, a: Vec3<R>, b: Vec3<R>, exponent: R) -> R {
        let lobe = match self.lobe {
            Lobe::Max if self.by_chord => cosine_power_by_chord(a, b, exponent),
            Lobe::Max => a.dot(b).lobe(exponent),
            Lobe::Abs => a.dot(b).abs().lobe(exponent),
            Lobe::Schlick => cosine_power_by_schlick(a, b, exponent),
        };
        match self.strength {
            Strength::EnergyConserving => R::product([exponent + R::literal(8.0), R::literal(FRAC_1_PI / 8.0), lobe]),
            _ => lobe,
        }
    }

    /// FS with the material's share in it.
    fn highlight<R: Real, const N: usize>(
        &self,
        [n, l, v]: [Vec3<R>; 3],
        material: Vector<R, N>,
        shininess: R,
    ) -> Vector<R, N> {
        let (zero, one) = (R::literal(0.0), R::literal(1.0));
        let fs = || match self.cosine {
            Cosine::Phong => {
                let r = match self.mirror {
                    Mirror::Right => reflect(-l, n),
                    Mirror::WithPlus => -l - n.map(|x| R::product([R::literal(2.0), l.dot(n), x])),
                    Mirror::OfToward => reflect(l, n),
                };
                self.power(r, v, shininess)
            }
            Cosine::Blinn => self.power(n, halfway(v, l), shininess),
            Cosine::BlinnUnnormalised => self.power(n, halfway_unnormalised(v, l), shininess),
        };
        let gated = || if self.gated { R::if_ge(zero, l.dot(n), || zero, fs) } else { fs() };
        let incidence = || l.dot(n).max(zero);
        match self.strength {
            Strength::Plain | Strength::EnergyConserving => material.scale(gated()),
            Strength::TimesIncidence => material.scale(gated() * incidence()),
            Strength::NormalisedWithFresnel => {
                let h = halfway(v, l);
                // Schlick's fresnel with the exponential that engines have taken from Karis 2013.
                let cosine = v.dot(h).max(zero);
                let exponent = (R::literal(-5.55473) * cosine - R::literal(6.98316)) * cosine;
                let fresnel = exponent.exp2();
                let lobe = n.dot(h).lobe(shininess);
                let density = (shininess * R::literal(0.5) + one) * lobe * R::literal(0.25);
                let pi = if self.over_pi { R::literal(FRAC_1_PI) } else { one };
                material.map(|f0| R::product([f0 * (one - fresnel) + fresnel, density, incidence(), pi]))
            }
        }
    }

    /// The sum of the terms of one light, of which each has a weight.
    fn shade<R: Real, const N: usize>(
        &self,
        light: [Vector<R, N>; 3],
        material: [Vector<R, N>; 3],
        vectors: [Vec3<R>; 3],
        shininess: R,
        weights: [R; 3],
    ) -> [Vector<R, N>; 3] {
        let zero = Vector::splat(R::literal(0.0));
        let [n, l, _] = vectors;
        let pi = Vector::splat(R::literal(if self.over_pi { FRAC_1_PI } else { 1.0 }));
        let weight = |k: usize| Vector::splat(weights[k]);
        let ambient = match self.ambient {
            0 => zero,
            count => Vector::product([light[0], material[0], weight(0), Vector::splat(R::literal(count.into())), pi]),
        };
        let diffuse = if self.diffuse {
            let incidence = Vector::splat(self.incidence(l, n));
            Vector::product([light[1], material[1], incidence, weight(1), pi])
        } else {
            zero
        };
        let specular = if self.specular {
            Vector::product([light[2], self.highlight(vectors, material[2], shininess), weight(2)])
        } else {
            zero
        };
        [ambient, diffuse, specular]
    }

    fn weights<R: Real>(&self, x: &Row<'_, R>, light: Vec3<R>, p: Vec3<R>, l: Vec3<R>) -> Option<[R; 3]> {
        let one = R::literal(1.0);
        let atten = match self.attenuation {
            Attenuation::None => one,
            _ => {
                let [kc, kl, kq] = [x.scalar("kc")?, x.scalar("kl")?, x.scalar("kq")?];
                let d = (light - p).length();
                match self.attenuation {
                    Attenuation::DistanceSquared => polynomial(kc, kl, kq, d * d),
                    Attenuation::NotInverted => R::quadratic([kc, kl, kq], d),
                    _ => polynomial(kc, kl, kq, d),
                }
            }
        };
        let cone = match self.cone {
            Cone::None | Cone::Ignored => one,
            _ => {
                let axis: Vec3<R> = x.vector("axis")?;
                cone_of(self.cone, l, axis.normalize(), x.scalar("cutoff_cosine")?, x.scalar("exponent")?)
            }
        };
        let weight = |term: usize| {
            let cone = if term == 0 || (term == 2 && !self.specular_in_cone) { one } else { cone };
            if self.attenuated[term] { R::product([cone, atten]) } else { cone }
        };
        Some([weight(0), weight(1), weight(2)])
    }

    /// Lit between two vertices, or at a face: kd and ks under a white light.
    fn intensity<R: Real>(&self, vectors: [Vec3<R>; 3], [kd, ks, shininess]: [R; 3]) -> R {
        let (zero, one) = (Vector([R::literal(0.0)]), R::literal(1.0));
        let white = Vector([one]);
        let material = [zero, Vector([kd]), Vector([ks])];
        let [_, diffuse, specular] = self.shade([zero, white, white], material, vectors, shininess, [one; 3]);
        (diffuse + specular).x()
    }

    fn surface<R: Real>(&self, source: Source, x: &Row<'_, R>, out: &mut [R]) -> Option<()> {
        let zero = Vector([0.0; 3].map(R::literal));
        let p: Vec3<R> = x.vector("p").unwrap_or(zero);
        let n = self.normal(x.vector("normal")?);
        let given: Vec3<R> = x.vector(if source == Source::Position { "position" } else { "direction" })?;
        let l = self.light(source, given, p);
        let (light, material) = match x.vector::<3>("light_color") {
            Some(color) => {
                let scalars = [x.scalar("ka")?, x.scalar("kd")?, x.scalar("ks")?];
                ([x.vector("ambient_color")?, color, color], scalars.map(Vector::splat))
            }
            None => (
                [x.vector("la")?, x.vector("ld")?, x.vector("ls")?],
                [x.vector("ma")?, x.vector("md")?, x.vector("ms")?],
            ),
        };
        let weights = self.weights(x, given, p, l)?;
        let terms = self.shade::<R, 3>(light, material, [n, l, self.eye(p)], x.scalar("shininess")?, weights);
        let alpha = x.scalar("alpha").unwrap_or_else(|| R::literal(1.0));
        put(out, 0, Vector::sum(terms).extend(alpha));
        Some(())
    }

    fn two_lights<R: Real>(&self, x: &Row<'_, R>, out: &mut [R]) -> Option<()> {
        let (p, n): (Vec3<R>, _) = (x.vector("p")?, self.normal(x.vector("normal")?));
        let one = R::literal(1.0);
        let material = [Vector::splat(one), x.vector("diffuse")?, x.vector("specular")?];
        let lit = |color: &str, source: Source, light: &str, ambient: Vector<R, 4>| {
            let color = x.vector::<4>(color)?;
            let l = self.light(source, x.vector(light)?, p);
            let vectors = [n, l, self.eye(p)];
            Some(self.shade([ambient, color, color], material, vectors, x.scalar("shininess")?, [one; 3]))
        };
        let [ambient, d0, s0] = lit("color0", Source::Toward, "direction", x.vector("ambient")?)?;
        let [_, d1, s1] = lit("color1", Source::Position, "position", Vector::splat(R::literal(0.0)))?;
        let sum =
            if self.both_lights { Vector::sum([ambient, d0, s0, d1, s1]) } else { Vector::sum([ambient, d0, s0]) };
        put(out, 0, sum);
        Some(())
    }

    fn along_edge<R: Real>(&self, edge: Edge, x: &Row<'_, R>) -> Option<R> {
        let [pa, na, pb, nb]: [Vec3<R>; 4] = [x.vector("pa")?, x.vector("na")?, x.vector("pb")?, x.vector("nb")?];
        let (t, position) = (x.scalar("t")?, x.vector("position")?);
        let material = [x.scalar("kd")?, x.scalar("ks")?, x.scalar("shininess")?];
        let lit = |p: Vec3<R>, n: Vec3<R>| {
            self.intensity([self.normal(n), self.light(Source::Position, position, p), self.eye(p)], material)
        };
        let from = |p: Vec3<R>| if self.position_as_direction { position } else { position - p };
        Some(match edge {
            Edge::UnitVectors => {
                let unit = |a: Vec3<R>, b: Vec3<R>| a.normalize().mix(b.normalize(), t);
                let l = self.light(Source::Toward, unit(from(pa), from(pb)), pa);
                self.intensity([self.normal(unit(na, nb)), l, self.eye(-unit(-pa, -pb))], material)
            }
            Edge::Gouraud => R::mix(lit(pa, na), lit(pb, nb), t),
            Edge::Phong => lit(pa.mix(pb, t), na.mix(nb, t)),
            Edge::Interpolated => {
                let l = self.light(Source::Toward, from(pa).mix(from(pb), t), pa);
                let v = self.eye(-(-pa).mix(-pb, t));
                self.intensity([self.normal(na.mix(nb, t)), l, v], material)
            }
        })
    }

    fn face<R: Real>(&self, x: &Row<'_, R>) -> Option<R> {
        let [a, b, c]: [Vec3<R>; 3] = [x.vector("a")?, x.vector("b")?, x.vector("c")?];
        let material = [x.scalar("kd")?, x.scalar("ks")?, x.scalar("shininess")?];
        let p = match self.lit_at {
            LitAt::First => a,
            LitAt::Last => c,
            LitAt::Middle => Vector::sum([a, b, c]).map(|x| x / R::literal(3.0)),
        };
        let l = self.light(Source::Position, x.vector("position")?, p);
        Some(self.intensity([face_normal(a, b, c), l, self.eye(p)], material))
    }

    fn evaluate<R: Real>(&self, x: &Row<'_, R>, out: &mut [R]) -> Option<()> {
        match self.arrangement {
            Arrangement::Diffuse(source, l) => {
                let given: Vec3<R> = x.vector(l)?;
                let l = if source == Source::Travel { -given } else { given };
                let incidence = Vector::splat(self.incidence(l, x.vector("n")?));
                let pi = Vector::splat(R::literal(if self.over_pi { FRAC_1_PI } else { 1.0 }));
                put(out, 0, Vector::product([x.vector::<3>("ld")?, x.vector("md")?, incidence, pi]));
            }
            Arrangement::Power([a, b], exponent) => {
                let fs = self.power(x.vector(a)?, x.vector(b)?, x.scalar(exponent)?);
                match (x.vector::<3>("ls"), x.vector("ms")) {
                    (Some(ls), Some(ms)) => put(out, 0, Vector::product([ls, ms, Vector::splat(fs)])),
                    _ => put(out, 0, Vector([fs])),
                }
            }
            Arrangement::Surface(source) => self.surface(source, x, out)?,
            Arrangement::TwoLights => self.two_lights(x, out)?,
            Arrangement::Edge(edge) => put(out, 0, Vector([self.along_edge(edge, x)?])),
            Arrangement::Face => put(out, 0, Vector([self.face(x)?])),
        }
        Some(())
    }
}

/// A spotlight's cone.
fn cone_of<R: Real>(cone: Cone, l: Vec3<R>, axis: Vec3<R>, cutoff_cosine: R, exponent: R) -> R {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let cosine = (-l).dot(axis);
    match cone {
        Cone::NoCutoff => R::if_ge(zero, exponent, || one, || cosine.lobe(exponent)),
        Cone::Smooth => smoothstep(cutoff_cosine, one, cosine),
        Cone::None | Cone::Ignored => one,
        Cone::Right => spot_exponent(l, axis, cutoff_cosine, exponent),
    }
}

/// The shading languages' smoothstep.
pub(super) fn smoothstep<R: Real>(low: R, high: R, x: R) -> R {
    let t = ((x - low) / (high - low)).clamp(R::literal(0.0), R::literal(1.0));
    R::product([t, t, R::literal(3.0) - R::literal(2.0) * t])
}

/// Whether the formula has these steps, and each makes a difference to it.
pub(super) fn concerns(spec: &Spec, twists: &[Twist]) -> bool {
    right(&spec.id).is_some_and(|mut model| twists.iter().all(|&twist| model.twist(twist)))
}

/// The formula with these steps wrong; `None` where it is not of this family's model.
pub(super) fn evaluate<R: Real>(spec: &Spec, twists: &[Twist], numbers: &[R], out: &mut [R]) -> Option<()> {
    let mut model = right(&spec.id)?;
    for &twist in twists {
        model.twist(twist);
    }
    model.evaluate(&Row::new(spec, numbers), out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faults::catalogue::formulas;
    use crate::select::CaseRef;

    #[test]
    fn without_a_mistake_the_model_is_the_formula() {
        let mut seen = 0;
        for member in formulas().iter().filter(|member| right(&member.spec.id).is_some()) {
            for k in 0..256 {
                let mut row = vec![];
                member.inputs(CaseRef::Random(k), 1, &mut row);
                let wide: Vec<f64> = row.iter().map(|&x| x.into()).collect();
                let (mut model, mut formula) =
                    (vec![f64::NAN; member.spec.output_len()], vec![0.0; member.spec.output_len()]);
                evaluate(&member.spec, &[], &wide, &mut model).expect("a model");
                member.formula.reference(&row, &mut formula);
                for (a, b) in model.iter().zip(&formula) {
                    assert!((a - b).abs() <= 1e-9 * b.abs().max(1.0), "{} {k}: {a} for {b}", member.spec.id);
                }
                seen += 1;
            }
        }
        assert!(seen > 20 * 256, "{seen}");
    }
}
