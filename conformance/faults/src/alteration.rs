//! What a mistake does to a named step of a formula.

use super::op::Op;
use super::row::Arithmetic;
use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::mistaken::{Alteration, Taken, place};
use lightmeter_reference::departure::{FresnelHighlight, smoothstep};
use lightmeter_reference::lighting::schlick;
use lightmeter_reference::vector::{halfway, reflect};
use lightmeter_reference::{Mat3, NamedStep, Real, Vec3, Vector};
use std::f64::consts::FRAC_1_PI;

/// Stands for each step.
pub(super) const ANY: &str = "*";
/// Stands for each step that normalises a vector.
pub(super) const NORMALISED: &str = "⟨*⟩";
/// Their names.
const NORMALISED_STEPS: [&str; 9] = ["n", "l", "v", "h", "axis", "face's n", "⟨v⟩", "⟨n⟩", "⟨Σn⟩"];

/// A step that goes wrong, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct At {
    pub(super) step: &'static str,
    pub(super) what: Do,
}

/// How a step goes wrong. What it is given is named as the step names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Do {
    /// Its own numbers change.
    Result(Op),
    /// What it is given changes.
    Given(&'static str, Op),
    /// It gives what it is given.
    Pass(&'static str),
    /// The same, changed.
    PassAs(&'static str, Op),
    /// The step returns its first operand, with the operation applied to it, instead of computing its result.
    FirstAs(Op),
    /// It is given one in the place of the other, and the reverse.
    Swap(&'static str, &'static str),
    /// The first named operand is also used in place of the second.
    Copy(&'static str, &'static str),
    /// It gives the sum of the two.
    Sum(&'static str, &'static str),
    /// It gives more by what it is given.
    Plus(&'static str),
    /// It is multiplied by a number that it is given.
    Times(&'static str),
    /// It is computed by another formula.
    Form(Form),
}

/// Another formula for a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// i + 2(i·n)n.
    ReflectWithPlus,
    /// i − (i·n)n.
    ReflectOnce,
    /// n·h for r·v.
    Blinn,
    /// r·v for n·h.
    Phong,
    /// (r·v)^exponent.
    PhongPower,
    /// The normal turned to the eye, n·v ≥ 0.
    NormalToTheEye,
    /// The normal turned to the light, n·l ≥ 0.
    NormalToTheLight,
    /// |cosine|^exponent.
    LobeOfBothSides,
    /// Schlick's approximation of the power.
    SchlickPower,
    /// cosine·exponent.
    ProductForPower,
    /// max(cosine, 10⁻⁴)^exponent, or any other floor.
    PowerOfAtLeast(u8),
    /// The power times (exponent + 8)/8π.
    EnergyConserving,
    /// The power times (exponent + 2)/2π.
    NormalisedPhong,
    /// 0 where the cosine is at most 0.
    Gated,
    /// 0 where the cosine is above 0.
    GateTurned,
    /// Times max(cosine, 0).
    TimesIncidence,
    /// Blinn's normalised lobe with Schlick's Fresnel term, times n·l; over π or not.
    Fresnel { over_pi: bool },
    /// (½·cosine + ½)², or without the square.
    HalfLambert { squared: bool },
    /// kc + kl·d + kq·d².
    NotInverted,
    /// 1/(kc + kl·d + kq·d).
    QuadraticOfDistance,
    /// 1/(kc + d·kl + (d·kq)²).
    QuadraticOfProduct,
    /// The cone's edge by smoothstep from the cutoff to the axis, times the power.
    SmoothCone,
    /// The same without the power.
    SmoothConeAlone,
    /// The cone's edge by a straight line from the cutoff to the axis.
    LinearCone,
    /// The power of the cosine rescaled from the cutoff to the axis.
    RescaledCone,
    /// The cone without its edge.
    ConeWithoutEdge,
    /// The spotlight shines where its cone is not.
    ConeTurned,
    /// |z|.
    Planar,
    /// |p|.
    Radial,
    /// z, which is negative before the eye.
    SignedDepth,
    /// −z, which is negative behind the eye.
    NegatedDepth,
    /// exp(−density·distance).
    FogExp,
    /// exp(−density·distance²).
    FogExp2Document,
    /// exp(−(density·distance)²).
    FogExp2OpenGl,
    /// 1/(1 + density·distance).
    FogRational,
    /// 1/(1 − x + x²/2) for e^x.
    ExpByQuadratic,
    /// The full surface colour plus the fog's colour times 1 − f: the surface's colour is not multiplied by f.
    FogAdded,
    /// The surface's colour as far as the fog leaves it.
    FogToBlack,
    /// shaded − (1 − f)(shaded − fog).
    FogFromTheSurface,
    /// 1 − (distance − dmin)/(dmax − dmin).
    FogFromDmin,
    /// |v|².
    SquaredLength,
    /// The inverse, not transposed.
    NormalByInverse,
    /// The modelview as such.
    NormalByModelview,
    /// The cofactor matrix, not divided by the determinant: where the determinant is negative, the normal points the wrong way.
    NormalByCofactors,
    /// A direction moved by the view's translation.
    DirectionAsPosition,
    /// A position that is not moved by a matrix's translation.
    PositionAsDirection,
    /// Divided by w though that is 0.
    DividedAlways,
    /// Not divided by w.
    NotDivided,
    /// b − (1 − t)(b − a).
    MixFromTheEnd,
    /// (p − b) × (a − b) for (b − a) × (p − a).
    EdgeFromItsEnd,
    /// near(1 − z) + far·z.
    DepthBetween,
    /// Depth from [−1, 1] for [0, 1] or the reverse.
    DepthRange,
    /// y the other way up.
    UpsideDown,
    /// ⌊255·c⌋.
    TruncatedByte,
    /// ⌊256·c⌋, at most 255.
    ByteBy256,
    /// round(255·c), not clamped.
    UnclampedByte,
    /// ⌊255·c + ½⌋.
    ByteBySum,
    /// How far z is between near and far.
    LinearDepth,
    /// far/(far − near)·(1 − near/z), or near/(far − near)·(far/z − 1).
    DepthByProjection,
    /// Depth read back as if it grew evenly.
    LinearDepthRead,
    /// sRGB encoding that switches from the linear piece to the curved piece at the threshold of decoding, 0.04045.
    EncodeThreshold,
    /// The same, decoded.
    DecodeThreshold,
    /// c^(1/2.2) for the curved piece.
    EncodeCurve,
    /// c^(1/2.4) − 0.055.
    EncodeWithoutScale,
    /// Rec. 709's pieces for sRGB's.
    EncodeRec709,
    /// The same, decoded.
    DecodeRec709,
    /// The middle of three vertices.
    Middle,
}

impl Form {
    /// The operands that this form needs, as alternative sets of names: a step must have every operand of at least one set.
    const fn needs(self) -> &'static [&'static [&'static str]] {
        match self {
            Self::ReflectWithPlus | Self::ReflectOnce => &[&["i", "n"], &["l", "n"]],
            Self::Blinn | Self::Phong => &[&["n", "l", "v"]],
            Self::PhongPower => &[&["n", "l", "v", "exponent"]],
            Self::NormalToTheEye | Self::NormalToTheLight => &[&["n", "l", "v"]],
            Self::ExpByQuadratic => &[&["exponent"]],
            Self::LobeOfBothSides
            | Self::SchlickPower
            | Self::ProductForPower
            | Self::PowerOfAtLeast(_)
            | Self::EnergyConserving
            | Self::NormalisedPhong => &[&["cosine", "exponent"], &["a", "b", "exponent"]],
            Self::Gated | Self::GateTurned | Self::TimesIncidence | Self::HalfLambert { .. } => &[&["cosine"]],
            Self::Fresnel { .. } => {
                &[&["light", "material", "n", "l", "v", "shininess"], &["ks", "n", "l", "v", "shininess"]]
            }
            Self::NotInverted | Self::QuadraticOfDistance | Self::QuadraticOfProduct => &[&["kc", "kl", "kq", "d"]],
            Self::SmoothCone
            | Self::SmoothConeAlone
            | Self::LinearCone
            | Self::RescaledCone
            | Self::ConeWithoutEdge
            | Self::ConeTurned => &[&["cosine", "cutoff_cosine", "exponent"]],
            Self::Planar | Self::Radial | Self::SignedDepth | Self::NegatedDepth => &[&["p"]],
            Self::FogExp | Self::FogExp2Document | Self::FogExp2OpenGl | Self::FogRational => {
                &[&["distance", "density"]]
            }
            Self::FogAdded | Self::FogToBlack | Self::FogFromTheSurface => &[&["fog", "shaded", "f"]],
            Self::FogFromDmin => &[&["distance", "dmin", "dmax"]],
            Self::SquaredLength => &[&["v"]],
            Self::NormalByInverse | Self::NormalByModelview | Self::NormalByCofactors => &[&["modelview", "n"]],
            Self::DirectionAsPosition => &[&["view", "direction"]],
            Self::PositionAsDirection => &[&["view", "model", "position"]],
            Self::DividedAlways | Self::NotDivided => &[&["eye"], &["clip"]],
            Self::MixFromTheEnd => &[&["a", "b", "t"]],
            Self::EdgeFromItsEnd => &[&["a", "b", "p"]],
            Self::DepthBetween | Self::DepthRange | Self::UpsideDown => &[&["ndc", "origin", "size", "depth"]],
            Self::TruncatedByte | Self::ByteBy256 | Self::UnclampedByte | Self::ByteBySum => &[&["c"]],
            Self::LinearDepth | Self::DepthByProjection => &[&["near", "far", "z"]],
            Self::LinearDepthRead => &[&["near", "far", "depth"]],
            Self::EncodeThreshold | Self::EncodeRec709 | Self::EncodeWithoutScale | Self::EncodeCurve => &[&["c"]],
            Self::DecodeRec709 | Self::DecodeThreshold => &[&["e"]],
            Self::Middle => &[&["a", "b", "c"]],
        }
    }
}

impl At {
    fn is_at(&self, step: &NamedStep) -> bool {
        match self.step {
            ANY => true,
            NORMALISED => NORMALISED_STEPS.contains(&step.name),
            name => step.name == name,
        }
    }

    /// Whether this mistake can be made in a step. `sizes` says how many numbers each of the step's operands has, and `out` how many
    /// numbers the step returns.
    pub(super) fn fits(&self, step: &NamedStep, sizes: &[usize], out: usize) -> bool {
        let size = |name: &str| place(step, sizes, name).map(|range| range.len());
        let has = |name: &&'static str| size(name).is_some();
        self.is_at(step)
            && match self.what {
                Do::Result(op) => op.fits(out),
                Do::Given(name, op) => size(name).is_some_and(|count| op.fits(count)),
                Do::Pass(name) | Do::Plus(name) => size(name) == Some(out),
                Do::PassAs(name, op) => size(name).is_some_and(|count| op.fits(count) && count == out),
                Do::FirstAs(op) => sizes.first() == Some(&out) && op.fits(out),
                Do::Swap(a, b) | Do::Copy(a, b) => size(a).is_some() && size(a) == size(b),
                Do::Times(name) => size(name) == Some(1),
                Do::Sum(a, b) => size(a) == Some(out) && size(b) == Some(out),
                Do::Form(form) => form.needs().iter().any(|names| names.iter().all(has)),
            }
    }

    /// Whether two mistakes cannot be combined: they are the same one, or both replace the computation of the same step.
    pub(super) fn collides(&self, other: &Self) -> bool {
        let replaces = |at: &Self| matches!(at.what, Do::Pass(_) | Do::PassAs(..) | Do::Sum(..) | Do::Form(_));
        self.step == other.step && (self.what == other.what || (replaces(self) && replaces(other)))
    }

    fn make<R: Arithmetic>(&self, taken: &mut Taken<'_, R>) {
        match self.what {
            Do::Result(op) => {
                taken.compute();
                op.apply(taken.out);
            }
            Do::Given(name, op) => {
                if let Some(range) = taken.place(name) {
                    op.apply(&mut taken.from[range]);
                }
                taken.compute();
            }
            Do::Pass(name) => pass(taken, name),
            Do::PassAs(name, op) => {
                pass(taken, name);
                op.apply(taken.out);
            }
            Do::FirstAs(op) => {
                taken.out.copy_from_slice(&taken.from[..taken.out.len()]);
                op.apply(taken.out);
            }
            Do::Swap(a, b) => {
                if let (Some(a), Some(b)) = (taken.place(a), taken.place(b)) {
                    a.zip(b).for_each(|(a, b)| taken.from.swap(a, b));
                }
                taken.compute();
            }
            Do::Copy(from, to) => {
                if let (Some(from), Some(to)) = (taken.place(from), taken.place(to)) {
                    taken.from.copy_within(from, to.start);
                }
                taken.compute();
            }
            Do::Sum(a, b) => {
                pass(taken, a);
                add(taken, b);
            }
            Do::Plus(name) => {
                taken.compute();
                add(taken, name);
            }
            Do::Times(name) => {
                taken.compute();
                if let Some([factor]) = taken.array(name) {
                    taken.out.iter_mut().for_each(|x| *x = *x * factor);
                }
            }
            Do::Form(form) => {
                if computed(form, taken).is_none() {
                    taken.compute();
                }
            }
        }
    }
}

impl Alteration for At {
    fn concerns(&self, step: &'static NamedStep) -> bool {
        self.is_at(step)
    }
    fn on_f64(&self, taken: &mut Taken<'_, f64>) {
        self.make(taken);
    }
    fn on_f32(&self, taken: &mut Taken<'_, f32>) {
        self.make(taken);
    }
    fn on_accept(&self, taken: &mut Taken<'_, Accept>) {
        self.make(taken);
    }
}

fn pass<R: Real>(taken: &mut Taken<'_, R>, name: &str) {
    if let Some(range) = taken.place(name).filter(|range| range.len() == taken.out.len()) {
        taken.out.copy_from_slice(&taken.from[range]);
    }
}

fn add<R: Real>(taken: &mut Taken<'_, R>, name: &str) {
    if let Some(range) = taken.place(name) {
        taken.out.iter_mut().zip(&taken.from[range]).for_each(|(x, &more)| *x = *x + more);
    }
}

fn scalar<R: Real>(taken: &Taken<'_, R>, name: &str) -> Option<R> {
    taken.array(name).map(|[x]| x)
}

fn vector<R: Real>(taken: &Taken<'_, R>, name: &str) -> Option<Vec3<R>> {
    taken.array(name).map(Vector)
}

/// Computes the step by another formula; `None` where it is not given what that needs.
fn computed<R: Arithmetic>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    match form {
        Form::ReflectWithPlus | Form::ReflectOnce | Form::Blinn | Form::Phong | Form::PhongPower => {
            mirrored(form, taken)
        }
        Form::NormalToTheEye | Form::NormalToTheLight => turned(form, taken),
        Form::LobeOfBothSides
        | Form::SchlickPower
        | Form::ProductForPower
        | Form::PowerOfAtLeast(_)
        | Form::EnergyConserving
        | Form::NormalisedPhong => power(form, taken),
        Form::Gated | Form::GateTurned | Form::TimesIncidence | Form::HalfLambert { .. } => incident(form, taken),
        Form::Fresnel { over_pi } => fresnel(over_pi, taken),
        Form::NotInverted | Form::QuadraticOfDistance | Form::QuadraticOfProduct => attenuated(form, taken),
        Form::SmoothCone
        | Form::SmoothConeAlone
        | Form::LinearCone
        | Form::RescaledCone
        | Form::ConeWithoutEdge
        | Form::ConeTurned => cone(form, taken),
        Form::Planar | Form::Radial | Form::SignedDepth | Form::NegatedDepth | Form::SquaredLength => {
            length(form, taken)
        }
        Form::FogExp
        | Form::FogExp2Document
        | Form::FogExp2OpenGl
        | Form::FogRational
        | Form::ExpByQuadratic
        | Form::FogAdded
        | Form::FogToBlack
        | Form::FogFromTheSurface
        | Form::FogFromDmin => fogged(form, taken),
        Form::NormalByInverse | Form::NormalByModelview | Form::NormalByCofactors => normal(form, taken),
        Form::DirectionAsPosition | Form::PositionAsDirection | Form::DividedAlways | Form::NotDivided => {
            placed(form, taken)
        }
        Form::MixFromTheEnd | Form::EdgeFromItsEnd | Form::Middle => between(form, taken),
        Form::DepthBetween | Form::DepthRange | Form::UpsideDown => window(form, taken),
        Form::TruncatedByte | Form::ByteBy256 | Form::UnclampedByte | Form::ByteBySum => byte(form, taken),
        Form::LinearDepth | Form::LinearDepthRead | Form::DepthByProjection => depth(form, taken),
        Form::EncodeThreshold
        | Form::DecodeThreshold
        | Form::EncodeWithoutScale
        | Form::EncodeCurve
        | Form::EncodeRec709
        | Form::DecodeRec709 => converted(form, taken),
    }
}

fn give<R: Copy, const N: usize>(taken: &mut Taken<'_, R>, v: [R; N]) -> Option<()> {
    taken.out.get_mut(..N)?.copy_from_slice(&v);
    Some(())
}

fn mirrored<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let n = vector(taken, "n")?;
    if matches!(form, Form::Blinn | Form::Phong | Form::PhongPower) {
        let (l, v) = (vector(taken, "l")?, vector(taken, "v")?);
        let cosine = if form == Form::Blinn { n.dot(halfway(v, l)) } else { reflect(-l, n).dot(v) };
        return match scalar(taken, "exponent") {
            Some(exponent) => give(taken, [cosine.lobe(exponent)]),
            None => give(taken, [cosine]),
        };
    }
    let i = vector(taken, "i").or_else(|| vector(taken, "l").map(|l| -l))?;
    let mirrored = match form {
        Form::ReflectOnce => i - n.scale(i.dot(n)),
        _ => i + n.map(|c| R::product([R::literal(2.0), i.dot(n), c])),
    };
    give(taken, mirrored.0)
}

fn turned<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let [n, l, v] = [vector(taken, "n")?, vector(taken, "l")?, vector(taken, "v")?];
    let toward = if form == Form::NormalToTheEye { v } else { l };
    let n = R::if_ge(n.dot(toward), R::literal(0.0), || n, || -n);
    let [n, l, v] = [n, l, v].map(|v| v.0);
    give(taken, [n[0], n[1], n[2], l[0], l[1], l[2], v[0], v[1], v[2]])
}

fn power<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let exponent = scalar(taken, "exponent")?;
    let cosine = match scalar(taken, "cosine") {
        Some(cosine) => cosine,
        None => vector(taken, "a")?.dot(vector(taken, "b")?),
    };
    let more = |share: f64, constant: f64| R::product([exponent + R::literal(constant), R::literal(share)]);
    let fs = match form {
        Form::LobeOfBothSides => cosine.abs().lobe(exponent),
        Form::SchlickPower => schlick(cosine, exponent),
        Form::ProductForPower => cosine.max(R::literal(0.0)) * exponent,
        Form::PowerOfAtLeast(digits) => cosine.max(R::literal(10.0_f64.powi(-i32::from(digits)))).pow(exponent),
        _ => {
            taken.compute();
            let fs = *taken.out.first()?;
            let share =
                if form == Form::NormalisedPhong { more(FRAC_1_PI / 2.0, 2.0) } else { more(FRAC_1_PI / 8.0, 8.0) };
            share * fs
        }
    };
    give(taken, [fs])
}

fn incident<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (zero, half, cosine) = (R::literal(0.0), R::literal(0.5), scalar(taken, "cosine")?);
    if let Form::HalfLambert { squared } = form {
        let wrapped = half * cosine + half;
        return give(taken, [if squared { wrapped * wrapped } else { wrapped }]);
    }
    if form == Form::GateTurned {
        // With a cosine of 1 the gate is open, so the step computes the value that the gate would otherwise have cut to 0.
        let range = taken.place("cosine")?;
        taken.from[range].fill(R::literal(1.0));
    }
    taken.compute();
    let fs = *taken.out.first()?;
    let shown = match form {
        Form::GateTurned => R::if_ge(zero, cosine, || fs, || zero),
        Form::Gated => R::if_ge(zero, cosine, || zero, || fs),
        _ => fs * cosine.max(zero),
    };
    give(taken, [shown])
}

fn fresnel<R: Real>(over_pi: bool, taken: &mut Taken<'_, R>) -> Option<()> {
    let [n, l, v] = [vector(taken, "n")?, vector(taken, "l")?, vector(taken, "v")?];
    let zero = R::literal(0.0);
    let incidence = l.dot(n).max(zero);
    let fresnel = FresnelHighlight::new(n, l, v, incidence, scalar(taken, "shininess")?);
    let pi = R::literal(if over_pi { FRAC_1_PI } else { 1.0 });
    let lit = |material: R| R::product([fresnel.tinted(material), fresnel.density, fresnel.incidence, pi]);
    if let (Some(kd), Some(ks)) = (scalar(taken, "kd"), scalar(taken, "ks")) {
        let diffuse = R::product([kd, scalar(taken, "incidence")?, pi]);
        return give(taken, [diffuse + lit(ks)]);
    }
    let weight = match (scalar(taken, "cone"), scalar(taken, "atten")) {
        (Some(cone), Some(atten)) => R::product([cone, atten]),
        _ => R::literal(1.0),
    };
    let (light, material) = (taken.given("light")?.to_vec(), taken.given("material")?.to_vec());
    for ((out, light), material) in taken.out.iter_mut().zip(light).zip(material) {
        *out = R::product([light, lit(material), weight]);
    }
    Some(())
}

fn attenuated<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let [kc, kl, kq, d] = [scalar(taken, "kc")?, scalar(taken, "kl")?, scalar(taken, "kq")?, scalar(taken, "d")?];
    let one = R::literal(1.0);
    let atten = match form {
        Form::NotInverted => R::quadratic([kc, kl, kq], d),
        Form::QuadraticOfDistance => one / R::sum([kc, kl * d, kq * d]),
        _ => one / R::sum([kc, kl * d, R::product([kq, d, kq, d])]),
    };
    give(taken, [atten])
}

fn cone<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let [cosine, cutoff, exponent] =
        [scalar(taken, "cosine")?, scalar(taken, "cutoff_cosine")?, scalar(taken, "exponent")?];
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let power = || R::if_ge(zero, exponent, || one, || cosine.lobe(exponent));
    let rescaled = || ((cosine - cutoff) / (one - cutoff)).clamp(zero, one);
    let share = match form {
        Form::SmoothCone => smoothstep(cutoff, one, cosine) * power(),
        Form::SmoothConeAlone => smoothstep(cutoff, one, cosine),
        Form::LinearCone => rescaled() * power(),
        Form::ConeWithoutEdge => R::if_ge(cutoff, cosine, || zero, power),
        Form::ConeTurned => R::if_ge(cosine, cutoff, || zero, power),
        _ => R::if_ge(cosine, cutoff, || R::if_ge(zero, exponent, || one, || rescaled().lobe(exponent)), || zero),
    };
    give(taken, [share])
}

fn length<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let v = vector(taken, "p").or_else(|| vector(taken, "v"))?;
    let zero = R::literal(0.0);
    let length = match form {
        Form::Planar => v.z().abs(),
        Form::Radial => R::if_ge(zero, v.dot(v), || zero, || v.length()),
        Form::SignedDepth => v.z(),
        Form::NegatedDepth => -v.z(),
        _ => v.dot(v),
    };
    give(taken, [length])
}

fn fogged<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    if matches!(form, Form::FogAdded | Form::FogToBlack | Form::FogFromTheSurface) {
        let (fog, shaded, f) = (vector(taken, "fog")?, vector(taken, "shaded")?, scalar(taken, "f")?);
        let color = match form {
            Form::FogAdded => shaded + fog.scale(one - f),
            Form::FogToBlack => shaded.scale(f),
            _ => shaded - (shaded - fog).scale(one - f),
        };
        return give(taken, color.0);
    }
    if form == Form::FogFromDmin {
        let [distance, dmin, dmax] = [scalar(taken, "distance")?, scalar(taken, "dmin")?, scalar(taken, "dmax")?];
        let ramp = || (one - (distance - dmin) / (dmax - dmin)).clamp(zero, one);
        let at_once = || R::if_ge(distance, dmax, || zero, || one);
        let f = R::if_ge(dmin, dmax, || R::if_ge(dmax, dmin, at_once, ramp), ramp);
        return give(taken, [f]);
    }
    if form == Form::ExpByQuadratic {
        let x = -scalar(taken, "exponent")?;
        return give(taken, [one / R::sum([one, x, R::product([x, x, R::literal(0.5)])])]);
    }
    let (d, density) = (scalar(taken, "distance")?, scalar(taken, "density")?);
    let t = density * d;
    let f = match form {
        Form::FogExp => (-t).exp(),
        Form::FogExp2Document => (-R::product([density, d, d])).exp(),
        Form::FogExp2OpenGl => (-(t * t)).exp(),
        _ => one / (one + t),
    };
    give(taken, [f.clamp(zero, one)])
}

fn normal<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (numbers, n) = (taken.array::<9>("modelview")?, vector(taken, "n")?);
    let m = Mat3([0, 3, 6].map(|k| Vector([numbers[k], numbers[k + 1], numbers[k + 2]])));
    let cofactors = m.cofactors();
    let turned = match form {
        Form::NormalByInverse => {
            let determinant = m.0[0].dot(cofactors.0[0]);
            Vector(cofactors.0.map(|column| column.dot(n) / determinant))
        }
        Form::NormalByModelview => m.transform(n),
        _ => cofactors.transform(n),
    };
    give(taken, if taken.step.name.starts_with('⟨') { turned.normalize() } else { turned }.0)
}

fn placed<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let matrix = |taken: &Taken<'_, R>, name: &str| {
        let m = taken.array::<16>(name)?;
        Some(lightmeter_reference::Mat4([0, 4, 8, 12].map(|k| Vector([m[k], m[k + 1], m[k + 2], m[k + 3]]))))
    };
    let moved = match form {
        Form::DirectionAsPosition => matrix(taken, "view")?.transform(vector(taken, "direction")?.extend(one)).xyz(),
        Form::PositionAsDirection => {
            let moved = matrix(taken, "model")?.transform(vector(taken, "position")?.extend(zero));
            matrix(taken, "view")?.transform(moved).xyz()
        }
        _ => {
            let [x, y, z, w] = taken.array("eye").or_else(|| taken.array("clip"))?;
            Vector(if form == Form::NotDivided { [x, y, z] } else { [x, y, z].map(|c| c / w) })
        }
    };
    give(taken, moved.0)
}

fn between<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    match form {
        Form::MixFromTheEnd => {
            let [a, b, t] = [scalar(taken, "a")?, scalar(taken, "b")?, scalar(taken, "t")?];
            give(taken, [b - (R::literal(1.0) - t) * (b - a)])
        }
        Form::EdgeFromItsEnd => {
            let [a, b, p]: [Vector<R, 2>; 3] =
                [Vector(taken.array("a")?), Vector(taken.array("b")?), Vector(taken.array("p")?)];
            give(taken, [lightmeter_reference::interpolation::edge(b, p, a)])
        }
        _ => {
            let corners = [vector(taken, "a")?, vector(taken, "b")?, vector(taken, "c")?];
            give(taken, Vector::sum(corners).map(|x| x / R::literal(3.0)).0)
        }
    }
}

/// Window coordinates and depth, as WebGPU has them or, counted from below and with depth from −1, as OpenGL.
fn window<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (one, half) = (R::literal(1.0), R::literal(0.5));
    let [x, y, z] = taken.array("ndc")?;
    let ([ox, oy], [sx, sy], [near, far]) = (taken.array("origin")?, taken.array("size")?, taken.array("depth")?);
    let opengl = taken.step.name == "window from below";
    let (up, halved) = (opengl != (form == Form::UpsideDown), opengl != (form == Form::DepthRange));
    let y = if up { y + one } else { one - y };
    let range = far - near;
    let depth = if form == Form::DepthBetween {
        let t = if halved { (z + one) * half } else { z };
        near * (one - t) + far * t
    } else {
        near + if halved { R::product([z + one, half, range]) } else { z * range }
    };
    give(taken, [ox + R::product([x + one, half, sx]), oy + R::product([y, half, sy]), depth])
}

fn byte<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (c, byte) = (scalar(taken, "c")?, R::literal(255.0));
    let unit = c.clamp(R::literal(0.0), R::literal(1.0));
    let value = match form {
        Form::TruncatedByte => (byte * unit).floor_then(R::literal),
        Form::ByteBySum => (byte * unit + R::literal(0.5)).floor_then(R::literal),
        Form::ByteBy256 => (R::literal(256.0) * unit).floor_then(|n| R::literal(n.min(255.0))),
        _ => (byte * c).round(),
    };
    give(taken, [value])
}

fn depth<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (near, far) = (scalar(taken, "near")?, scalar(taken, "far")?);
    let range = far - near;
    let value = match form {
        Form::DepthByProjection => {
            let (z, one) = (scalar(taken, "z")?, R::literal(1.0));
            if taken.step.name == "reversed depth" {
                near / range * (far / z - one)
            } else {
                far / range * (one - near / z)
            }
        }
        Form::LinearDepth if taken.step.name == "reversed depth" => (far - scalar(taken, "z")?) / range,
        Form::LinearDepth => (scalar(taken, "z")? - near) / range,
        _ => near + scalar(taken, "depth")? * range,
    };
    give(taken, [value])
}

fn converted<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let literal = R::literal;
    let value = match form {
        Form::DecodeRec709 => {
            let e = scalar(taken, "e")?;
            let power = || ((e + literal(0.099)) / literal(1.099)).pow(literal(1.0 / 0.45));
            R::if_ge(literal(0.081), e, || e / literal(4.5), power)
        }
        Form::EncodeRec709 => {
            let c = scalar(taken, "c")?;
            let power = || literal(1.099) * c.pow(literal(0.45)) - literal(0.099);
            R::if_ge(literal(0.018), c, || literal(4.5) * c, power)
        }
        Form::DecodeThreshold => {
            let e = scalar(taken, "e")?;
            let power = || ((e + literal(0.055)) / literal(1.055)).pow(literal(2.4));
            R::if_ge(literal(0.003_130_8), e, || e / literal(12.92), power)
        }
        Form::EncodeCurve => {
            let c = scalar(taken, "c")?;
            R::if_ge(literal(0.003_130_8), c, || literal(12.92) * c, || c.pow(literal(1.0 / 2.2)))
        }
        Form::EncodeWithoutScale => {
            let c = scalar(taken, "c")?;
            let power = || c.pow(literal(1.0 / 2.4)) - literal(0.055);
            R::if_ge(literal(0.003_130_8), c, || literal(12.92) * c, power)
        }
        // The bound of decoding for that of encoding.
        _ => {
            let c = scalar(taken, "c")?;
            let power = || literal(1.055) * c.pow(literal(1.0 / 2.4)) - literal(0.055);
            R::if_ge(literal(0.040_45), c, || literal(12.92) * c, power)
        }
    };
    give(taken, [value])
}
