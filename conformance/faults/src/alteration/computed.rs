//! Computes a step by another formula.

use super::super::row::Arithmetic;
use super::Form;
use lightmeter_arithmetic::mistaken::Taken;
use lightmeter_reference::departure::{FresnelHighlight, smoothstep};
use lightmeter_reference::interpolation::edge;
use lightmeter_reference::lighting::schlick;
use lightmeter_reference::vector::{halfway, reflect};
use lightmeter_reference::{Components as _, Mat3, Real, Vec3, Vector};
use std::f64::consts::FRAC_1_PI;

fn scalar<R: Real>(taken: &Taken<'_, R>, name: &str) -> Option<R> {
    taken.array(name).map(|[x]| x)
}

fn vector<R: Real>(taken: &Taken<'_, R>, name: &str) -> Option<Vec3<R>> {
    taken.array(name).map(Vector)
}

/// Computes the step by another formula; `None` where it is not given what that needs.
pub(super) fn computed<R: Arithmetic>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    use Form as F;
    match form {
        F::ReflectWithPlus | F::ReflectOnce | F::Blinn | F::BlinnByDifference | F::Phong | F::PhongPower => {
            mirrored(form, taken)
        }
        F::NormalToTheEye | F::NormalToTheLight => turned(form, taken),
        F::LobeOfBothSides
        | F::SchlickPower
        | F::ProductForPower
        | F::PowerOfAtLeast(_)
        | F::PowerOfAtMostOne
        | F::NoneWithoutExponent
        | F::PowerUnguarded
        | F::EnergyConserving
        | F::NormalisedPhong => power(form, taken),
        F::Gated | F::GatedBelow | F::GateTurned | F::TimesIncidence | F::HalfLambert { .. } => incident(form, taken),
        F::Fresnel { over_pi } => fresnel(over_pi, taken),
        F::NotInverted | F::ConstantInverted | F::QuadraticOfDistance | F::QuadraticOfProduct => {
            attenuated(form, taken)
        }
        F::SmoothCone | F::SmoothConeAlone | F::LinearCone | F::RescaledCone | F::ConeWithoutEdge | F::ConeTurned => {
            cone(form, taken)
        }
        F::Planar | F::Radial | F::SignedDepth | F::NegatedDepth | F::SquaredLength => length(form, taken),
        F::FogExp
        | F::FogExp2Document
        | F::FogExp2OpenGl
        | F::FogRational
        | F::ExpByQuadratic
        | F::FogAdded
        | F::FogToBlack
        | F::FogFromTheSurface
        | F::FogFromDmin
        | F::FogNotTurned
        | F::FogStepBeyond => fogged(form, taken),
        F::NormalByInverse | F::NormalByModelview | F::NormalByCofactors | F::NormalByUnsigned => normal(form, taken),
        F::DirectionAsPosition | F::PositionAsDirection | F::DividedAlways | F::DividedIfPositive | F::NotDivided => {
            placed(form, taken)
        }
        F::MixFromTheEnd | F::OverFromTheProduct | F::AlongByShare | F::Middle => between(form, taken),
        F::EdgeFromItsEnd | F::EdgeFromThePoint | F::NormalByVertices => sides(form, taken),
        F::WeightsBySum | F::WeightsByDifference => weights(form, taken),
        F::DepthRange | F::UpsideDown => window(form, taken),
        F::TruncatedByte | F::ByteBy256 | F::UnclampedByte | F::ByteBySum => byte(form, taken),
        F::LinearDepth | F::LinearDepthRead | F::DepthByProjection | F::DepthByReciprocals | F::DepthByDifference => {
            depth(form, taken)
        }
        F::LastWeightAsTheRest | F::FromTheFirst => shared(form, taken),
        F::NearPlaneOutside | F::FarPlaneOutside => clipped(form, taken),
        F::EncodeThreshold
        | F::DecodeThreshold
        | F::DecodeOldThreshold
        | F::EncodeShortExponent
        | F::EncodeWithoutScale
        | F::EncodeCurve
        | F::EncodeRec709
        | F::DecodeRec709 => converted(form, taken),
    }
}

fn give<R: Copy, const N: usize>(taken: &mut Taken<'_, R>, v: [R; N]) -> Option<()> {
    taken.out.get_mut(..N)?.copy_from_slice(&v);
    Some(())
}

fn mirrored<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let n = vector(taken, "n")?;
    if matches!(form, Form::Blinn | Form::BlinnByDifference | Form::Phong | Form::PhongPower) {
        let (l, v) = (vector(taken, "l")?, vector(taken, "v")?);
        let cosine = match form {
            Form::Blinn => n.dot(halfway(v, l)),
            Form::BlinnByDifference => n.dot(halfway(v, -l)),
            _ => reflect(-l, n).dot(v),
        };
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
        Form::PowerOfAtMostOne => cosine.min(R::literal(1.0)).lobe(exponent),
        Form::NoneWithoutExponent => {
            let zero = R::literal(0.0);
            R::if_ge(zero, exponent, || zero, || cosine.lobe(exponent))
        }
        Form::PowerUnguarded => {
            // The root of what is below 0 is no number either.
            R::if_ge(cosine, R::literal(0.0), || cosine.lobe(exponent), || cosine.sqrt())
        }
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
    if matches!(form, Form::GateTurned | Form::GatedBelow) {
        // With a cosine of 1 the gate is open, so the step computes the value that the gate would otherwise have cut to 0.
        let range = taken.place("cosine")?;
        taken.from[range].fill(R::literal(1.0));
    }
    taken.compute();
    let fs = *taken.out.first()?;
    let shown = match form {
        Form::GateTurned => R::if_ge(zero, cosine, || fs, || zero),
        Form::Gated => R::if_ge(zero, cosine, || zero, || fs),
        Form::GatedBelow => R::if_ge(cosine, zero, || fs, || zero),
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
        Form::ConstantInverted => R::sum([one / kc, kl * d, R::product([kq, d, d])]),
        Form::QuadraticOfDistance => one / R::sum([kc, kl * d, kq * d]),
        _ => one / R::sum([kc, kl * d, R::product([kq, d, kq, d])]),
    };
    give(taken, [atten])
}

fn cone<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let [cosine, cutoff] = [scalar(taken, "cosine")?, scalar(taken, "cutoff_cosine")?];
    let exponent = scalar(taken, "exponent");
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    // A cone without an exponent is evenly lit.
    let power_of = |cosine: R| exponent.map_or(one, |exponent| cosine.lobe(exponent));
    let power = || power_of(cosine);
    let rescaled = || ((cosine - cutoff) / (one - cutoff)).clamp(zero, one);
    let share = match form {
        Form::SmoothCone => smoothstep(cutoff, one, cosine) * power(),
        Form::SmoothConeAlone => smoothstep(cutoff, one, cosine),
        Form::LinearCone => rescaled() * power(),
        Form::ConeWithoutEdge => R::if_ge(cutoff, cosine, || zero, power),
        Form::ConeTurned => R::if_ge(cosine, cutoff, || zero, power),
        _ => R::if_ge(cosine, cutoff, || power_of(rescaled()), || zero),
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
    if matches!(form, Form::FogNotTurned | Form::FogStepBeyond) {
        let [distance, dmin, dmax] = [scalar(taken, "distance")?, scalar(taken, "dmin")?, scalar(taken, "dmax")?];
        let ramp = || ((dmax - distance) / (dmax - dmin)).clamp(zero, one);
        let at_once = || R::if_ge(distance, dmax, || zero, || one);
        let beyond = || R::if_ge(dmax, distance, || one, || zero);
        let f = if form == Form::FogNotTurned {
            R::if_ge(dmin, dmax, at_once, ramp)
        } else {
            R::if_ge(dmin, dmax, || R::if_ge(dmax, dmin, beyond, ramp), ramp)
        };
        return give(taken, [f]);
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
        Form::NormalByUnsigned => {
            let determinant = m.0[0].dot(cofactors.0[0]).abs();
            cofactors.transform(n).map(|x| x / determinant)
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
            let divided = || Vector([x, y, z].map(|c| c / w));
            match form {
                Form::NotDivided => Vector([x, y, z]),
                Form::DividedIfPositive => R::if_ge(zero, w, || Vector([x, y, z]), divided),
                _ => divided(),
            }
        }
    };
    give(taken, moved.0)
}

fn between<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let one = R::literal(1.0);
    let over = |taken: &Taken<'_, R>| {
        let [r, g, b, alpha] = taken.array("src")?;
        Some((Vector([r, g, b]), alpha, vector(taken, "dst")?))
    };
    match form {
        Form::MixFromTheEnd if taken.place("src").is_some() => {
            let (src, alpha, dst) = over(taken)?;
            give(taken, src.zip(dst, |s, d| s - (one - alpha) * (s - d)).0)
        }
        Form::MixFromTheEnd => {
            let [a, b, t] = [scalar(taken, "a")?, scalar(taken, "b")?, scalar(taken, "t")?];
            give(taken, [b - (one - t) * (b - a)])
        }
        Form::OverFromTheProduct => {
            let (src, alpha, dst) = over(taken)?;
            give(taken, src.zip(dst, |s, d| s * alpha + (d - d * alpha)).0)
        }
        Form::AlongByShare => {
            let names = if taken.place("ia").is_some() {
                ["ia", "ib", "xa", "xb", "x"]
            } else {
                ["near", "far", "top", "bottom", "y"]
            };
            let mut given = [one; 5];
            for (place, name) in given.iter_mut().zip(names) {
                *place = scalar(taken, name)?;
            }
            let [from, to, start, end, at] = given;
            let share = (at - start) / (end - start);
            give(taken, [from + (to - from) * share])
        }
        _ => {
            let corners = [vector(taken, "a")?, vector(taken, "b")?, vector(taken, "c")?];
            give(taken, Vector::sum(corners).map(|x| x / R::literal(3.0)).0)
        }
    }
}

/// The weights of a point by the sum of their areas, or the last by difference.
fn weights<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let [a, b, c, p]: [Vector<R, 2>; 4] =
        [Vector(taken.array("a")?), Vector(taken.array("b")?), Vector(taken.array("c")?), Vector(taken.array("p")?)];
    let areas = [[b, c], [c, a], [a, b]].map(|[from, to]| edge(from, to, p));
    if form == Form::WeightsBySum {
        return give(taken, areas.map(|area| area / R::sum(areas)));
    }
    let whole = edge(a, b, c);
    let [first, second] = [areas[0] / whole, areas[1] / whole];
    give(taken, [first, second, R::literal(1.0) - first - second])
}

/// Values between vertices, counted from one of them.
fn shared<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    if form == Form::FromTheFirst {
        let (t, w, [a, b]) = (scalar(taken, "t")?, taken.array::<2>("w")?, taken.array("attr")?);
        let (qa, qb) = ((R::literal(1.0) - t) / w[0], t / w[1]);
        return give(taken, [a + qb / (qa + qb) * (b - a)]);
    }
    let [alpha, beta, _] = taken.array("weights")?;
    let [a, b, c] = [vector(taken, "a")?, vector(taken, "b")?, vector(taken, "c")?];
    give(taken, Vector::sum([c, (a - c).scale(alpha), (b - c).scale(beta)]).0)
}

/// The clip volume without one of its planes.
fn clipped<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (z, zero) = (scalar(taken, "z")?, R::literal(0.0));
    let (greater, less) =
        if form == Form::NearPlaneOutside { (scalar(taken, "near")?, z) } else { (z, scalar(taken, "w")?) };
    taken.compute();
    let inside = *taken.out.first()?;
    give(taken, [R::if_ge(greater, less, || zero, || inside)])
}

/// A triangle's sides taken from another vertex, in the plane or in space.
fn sides<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let third = if taken.place("p").is_some() { "p" } else { "c" };
    let order = if form == Form::EdgeFromItsEnd { [1, 2, 0] } else { [2, 0, 1] };
    if form == Form::NormalByVertices {
        let [a, b, c] = [vector(taken, "a")?, vector(taken, "b")?, vector(taken, "c")?];
        return give(taken, Vector::sum([a.cross(b), b.cross(c), c.cross(a)]).0);
    }
    if let [Some(a), Some(b), Some(c)] = ["a", "b", third].map(|name| vector(taken, name)) {
        let [a, b, c] = order.map(|k| [a, b, c][k]);
        return give(taken, (b - a).cross(c - a).0);
    }
    let corners: [Vector<R, 2>; 3] =
        [Vector(taken.array("a")?), Vector(taken.array("b")?), Vector(taken.array(third)?)];
    let [a, b, c] = order.map(|k| corners[k]);
    give(taken, [edge(a, b, c)])
}

/// Window coordinates and depth, as WebGPU has them or, counted from below and with depth from −1, as OpenGL.
fn window<R: Real>(form: Form, taken: &mut Taken<'_, R>) -> Option<()> {
    let (one, half) = (R::literal(1.0), R::literal(0.5));
    let [x, y, z] = taken.array("ndc")?;
    let ([ox, oy], [sx, sy], [near, far]) = (taken.array("origin")?, taken.array("size")?, taken.array("depth")?);
    let opengl = taken.step.name == "window from below";
    let (up, halved) = (opengl != (form == Form::UpsideDown), opengl != (form == Form::DepthRange));
    let y = if up { y + one } else { one - y };
    let depth = R::mix(near, far, if halved { (z + one) * half } else { z });
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
        Form::DepthByReciprocals => {
            let one = R::literal(1.0);
            let [near, far, z] = [near, far, scalar(taken, "z")?].map(|distance| one / distance);
            let (from, to) = if taken.step.name == "reversed depth" { (far, near) } else { (near, far) };
            (z - from) / (to - from)
        }
        Form::DepthByDifference => {
            let (z, reversed) = (scalar(taken, "z")?, taken.step.name == "reversed depth");
            let (nearer, whole) = (far * near / (range * z), if reversed { near / range } else { far / range });
            if reversed { nearer - whole } else { whole - nearer }
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
        Form::DecodeThreshold | Form::DecodeOldThreshold => {
            let e = scalar(taken, "e")?;
            let threshold = if form == Form::DecodeThreshold { 0.003_130_8 } else { 0.039_28 };
            let power = || ((e + literal(0.055)) / literal(1.055)).pow(literal(2.4));
            R::if_ge(literal(threshold), e, || e / literal(12.92), power)
        }
        Form::EncodeShortExponent => {
            let c = scalar(taken, "c")?;
            let power = || literal(1.055) * c.pow(literal(0.416_66)) - literal(0.055);
            R::if_ge(literal(0.003_130_8), c, || literal(12.92) * c, power)
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
