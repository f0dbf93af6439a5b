//! The model evaluated.

use super::super::row::{InputRow, put};
use super::model::{
    Arrangement, Attenuation, Cone, Cosine, Edge, Incidence, LitAt, Lobe, Mirror, Model, Source, Strength, View,
};
use lightmeter_reference::attenuation::{polynomial, spot_exponent};
use lightmeter_reference::departure::{FresnelHighlight, smoothstep};
use lightmeter_reference::lighting::{cosine_power_by_chord, cosine_power_by_schlick};
use lightmeter_reference::vector::{face_normal, halfway, halfway_unnormalised, reflect};
use lightmeter_reference::{Real, Vec3, Vector};
use std::f64::consts::FRAC_1_PI;

impl Model {
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
                let fresnel = FresnelHighlight::new(n, l, v, incidence(), shininess);
                let pi = if self.over_pi { R::literal(FRAC_1_PI) } else { one };
                material.map(|f0| R::product([fresnel.tinted(f0), fresnel.density, fresnel.incidence, pi]))
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

    fn weights<R: Real>(&self, x: &InputRow<'_, R>, light: Vec3<R>, p: Vec3<R>, l: Vec3<R>) -> Option<[R; 3]> {
        let one = R::literal(1.0);
        let atten = match self.attenuation {
            Attenuation::None => one,
            _ => {
                let [kc, kl, kq] = [x.scalar("kc")?, x.scalar("kl")?, x.scalar("kq")?];
                let d = (light - p).length();
                match self.attenuation {
                    Attenuation::DistanceSquared => polynomial(kc, kl, kq, d * d),
                    Attenuation::NotInverted => R::quadratic([kc, kl, kq], d),
                    Attenuation::AtMostOne => polynomial(kc, kl, kq, d).min(one),
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

    fn surface<R: Real>(&self, source: Source, x: &InputRow<'_, R>, out: &mut [R]) -> Option<()> {
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

    fn two_lights<R: Real>(&self, x: &InputRow<'_, R>, out: &mut [R]) -> Option<()> {
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
        put(out, 0, if self.alpha_of_material { sum.xyz().extend(x.vector::<4>("diffuse")?.w()) } else { sum });
        Some(())
    }

    fn along_edge<R: Real>(&self, edge: Edge, x: &InputRow<'_, R>) -> Option<R> {
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

    fn face<R: Real>(&self, x: &InputRow<'_, R>) -> Option<R> {
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

    pub(super) fn evaluate<R: Real>(&self, x: &InputRow<'_, R>, out: &mut [R]) -> Option<()> {
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
