//! Single formulas with a mistake in their midst, where neither inputs nor outputs can be changed to the same effect.

use super::lighting::smoothstep;
use super::row::{Row, put};
use crate::cases::{Kind, Spec};
use lightmeter_reference::depth::passes;
use lightmeter_reference::vector::{light_with_model, reflect};
use lightmeter_reference::{Real, Vec3, Vec4, Vector, attenuation, color, interpolation};
use lightmeter_scene::depth::Compare;

/// What is computed instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Body {
    // Vectors.
    /// i − (i·n)n.
    ReflectOnce,
    /// i + 2(i·n)n.
    ReflectWithPlus,
    /// (v + l)/2.
    HalfwayAsMean,
    /// v/Σ|vᵢ|.
    NormalizeBySum,
    /// v/max|vᵢ|.
    NormalizeByLargest,
    /// v/|v|².
    NormalizeBySquare,
    /// |v|².
    SquaredLength,
    /// Normals by the inverse, not transposed: transposed cofactors over the determinant.
    NormalByInverse,
    /// Normals by the modelview, as such or normalised.
    NormalByModelview,
    /// Normals by the cofactors without the determinant, whose sign is lost.
    NormalByBareCofactors,
    /// A direction moved by the view's translation.
    DirectionAsPosition,
    /// A position without the view's translation.
    PositionAsDirection,
    /// A position not divided by its w.
    NotDivided,
    /// A position divided by its w though that is 0.
    DividedAlways,
    /// model·(view·position).
    MatricesExchanged,
    /// The sum of normals, or their interpolation, not normalised.
    NotNormalised,
    /// The sum of normals over three.
    MeanNormal,
    /// Fogless: light − p not normalised.
    TowardNotNormalised,
    /// ⟨light⟩.
    TowardFromOrigin,
    /// (b − a) × (c − b), the edges in a row: the same for triangles; or with the last vertex for the first.
    FaceNotNormalised,
    // Attenuation.
    /// d² in the place of d.
    DistanceSquared,
    /// kc + kl·d + kq·d² itself.
    NotInverted,
    /// At most 1.
    AtMostOne,
    /// The cone's edge by smoothstep.
    SmoothCone,
    /// The exponent without the cone.
    NoCutoff,
    // Interpolation.
    /// Σ λa.
    LinearForPerspective,
    /// Σ λaw / Σ λw.
    MultipliedByW,
    /// Σ λa/w, not divided by Σ λ/w.
    NotRenormalised,
    /// Signed areas made positive.
    UnsignedWeights,
    /// Twice the weights: over the area rather than twice the area.
    WeightsTwice,
    /// Every edge belongs to the triangle.
    EveryEdge,
    /// No edge does.
    NoEdge,
    /// Both windings are front.
    FrontAlways,
    /// Clip coordinates not divided by w.
    WindowNotDivided,
    /// y the other way up.
    UpsideDown,
    /// Depth from [−1, 1] for [0, 1] or the reverse.
    DepthRange,
    /// The near plane at the eye, the far plane nowhere.
    NoFarPlane,
    /// One step too many along the span.
    OneStepTooMany,
    // Colours.
    /// ⌊255·c⌋.
    TruncatedByte,
    /// ⌊256·c⌋, at most 255.
    By256,
    /// round(255·c), not clamped.
    UnclampedByte,
    /// byte/256.
    Over256,
    /// One power for the two pieces, 1/2.2 or 2.2.
    OnePower,
    /// Encoded for decoded.
    Encoded,
    /// Decoded for encoded.
    Decoded,
    /// Not converted at all.
    NotConverted,
    /// Twice: encoded after it is encoded.
    Twice,
    /// The straight piece everywhere.
    StraightPiece,
    /// texel + color.
    Added,
    /// Alpha converted as the colour is.
    AlphaToo,
    /// A sum beyond [0, 1].
    SumNotClamped,
    // Depth.
    /// Equal depths pass where they do not, and the reverse.
    OtherStrictness,
    /// Less for greater.
    ReversedCompare,
    /// Written though it is not to be, or the reverse.
    OtherWriting,
    /// Written though the test fails.
    WrittenAlways,
    /// Not clamped.
    DepthNotClamped,
    /// Read back as if it grew evenly from near to far.
    LinearDepth,
    /// near and far exchanged when it is read back.
    PlanesExchanged,
}

/// Whether the formula has that step.
pub(super) fn concerns(spec: &Spec, body: Body) -> bool {
    let is = |ids: &[&str]| ids.contains(&spec.id.as_str());
    let interpolated_normal = ["vector/interpolated-normal", "vector/interpolated-normal-guarded"];
    let polynomial = [
        "attenuation/polynomial",
        "attenuation/polynomial-expanded",
        "attenuation/polynomial-bounded",
        "attenuation/point",
        "attenuation/point-scaled",
    ];
    let spot = ["attenuation/spot-exponent", "attenuation/spot-exponent-by-chord"];
    let perspective =
        ["interpolation/perspective", "interpolation/perspective-scaled", "interpolation/perspective-line"];
    let viewport = ["interpolation/viewport", "interpolation/viewport-opengl"];
    let encode = ["color/srgb-encode", "color/srgb-encode-component"];
    let normals = ["vector/normal-inverse-transpose", "vector/normal-by-determinant", "vector/normal-by-cofactors"];
    let normalize = ["vector/normalize", "vector/normalize-unguarded", "vector/normalize-scaled"];
    let tested = matches!(spec.kind, Kind::Depth(_));
    match body {
        Body::ReflectOnce | Body::ReflectWithPlus => {
            is(&["vector/reflect", "vector/reflect-toward", "vector/reflect-any-normal"])
        }
        Body::HalfwayAsMean => is(&["vector/halfway", "vector/halfway-unguarded", "vector/halfway-unnormalised"]),
        Body::NormalizeBySum | Body::NormalizeByLargest | Body::NormalizeBySquare => is(&normalize),
        Body::SquaredLength => is(&["vector/length", "vector/length-scaled"]),
        Body::NormalByInverse => is(&normals),
        Body::NormalByModelview => is(&normals),
        Body::NormalByBareCofactors => is(&normals),
        Body::DirectionAsPosition => is(&["vector/light-direction"]),
        Body::PositionAsDirection => is(&["vector/light-position", "vector/light-with-model"]),
        Body::NotDivided | Body::DividedAlways => is(&["vector/light-position"]),
        Body::MatricesExchanged => is(&["vector/light-with-model"]),
        Body::NotNormalised => {
            is(&["vector/average-normal"]) || is(&interpolated_normal) || is(&["vector/reflect-any-normal"])
        }
        Body::MeanNormal => is(&["vector/average-normal"]),
        Body::TowardNotNormalised | Body::TowardFromOrigin => is(&["vector/toward"]),
        Body::FaceNotNormalised => is(&["vector/face-normal", "vector/face-normal-compensated"]),
        Body::DistanceSquared | Body::NotInverted | Body::AtMostOne => is(&polynomial),
        Body::SmoothCone => is(&spot) || is(&["attenuation/spot-cutoff"]),
        Body::NoCutoff => is(&spot),
        Body::LinearForPerspective | Body::MultipliedByW | Body::NotRenormalised => is(&perspective),
        Body::UnsignedWeights => is(&["interpolation/weights", "interpolation/last-weight"]),
        Body::WeightsTwice => is(&["interpolation/weights", "interpolation/last-weight"]),
        Body::EveryEdge | Body::NoEdge => is(&["interpolation/coverage"]),
        Body::FrontAlways => is(&["interpolation/front-facing"]),
        Body::WindowNotDivided | Body::UpsideDown | Body::DepthRange => is(&viewport),
        Body::NoFarPlane => is(&["interpolation/clip-volume", "interpolation/clip-volume-opengl"]),
        Body::OneStepTooMany => is(&["interpolation/forward-differences"]),
        Body::TruncatedByte | Body::By256 | Body::UnclampedByte => is(&["color/to-unorm8"]),
        Body::Over256 => is(&["color/from-unorm8"]),
        Body::OnePower => is(&encode) || is(&["color/srgb-encode-power", "color/srgb-decode"]),
        Body::Encoded => is(&["color/srgb-decode"]),
        Body::Decoded | Body::Twice | Body::StraightPiece => {
            is(&encode) || is(&["color/srgb-encode-power", "color/gamma-encode"])
        }
        Body::NotConverted => {
            is(&encode) || is(&["color/srgb-decode", "color/srgb-encode-power", "color/gamma-encode"])
        }
        Body::Added => is(&["color/modulate"]),
        Body::AlphaToo => is(&["color/srgb-encode", "color/srgb-decode"]),
        Body::SumNotClamped => is(&["color/sum"]),
        Body::OtherStrictness | Body::ReversedCompare => match spec.kind {
            Kind::Depth(by) => other_compare(body, by.compare) != by.compare,
            _ => false,
        },
        Body::OtherWriting => {
            matches!(spec.kind, Kind::Depth(by) if by.compare != Compare::Never && by.compare != Compare::Equal)
        }
        Body::WrittenAlways => {
            matches!(spec.kind, Kind::Depth(by) if by.write && !matches!(by.compare, Compare::Always | Compare::NotEqual))
        }
        Body::DepthNotClamped => tested || is(&["interpolation/frag-depth"]),
        Body::LinearDepth | Body::PlanesExchanged => is(&["depth/recovered", "depth/recovered-reversed"]),
    }
}

fn other_compare(body: Body, compare: Compare) -> Compare {
    use Compare::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    match (body, compare) {
        (Body::OtherStrictness, Less) => LessEqual,
        (Body::OtherStrictness, LessEqual) => Less,
        (Body::OtherStrictness, Greater) => GreaterEqual,
        (Body::OtherStrictness, GreaterEqual) => Greater,
        (Body::ReversedCompare, Less) => Greater,
        (Body::ReversedCompare, Greater) => Less,
        (Body::ReversedCompare, LessEqual) => GreaterEqual,
        (Body::ReversedCompare, GreaterEqual) => LessEqual,
        (Body::ReversedCompare, Equal) => NotEqual,
        (Body::ReversedCompare, NotEqual) => Equal,
        (_, compare) => compare,
    }
}

/// The formula with that step wrong; `None` where it has none such.
pub(super) fn evaluate<R: Real>(spec: &Spec, body: Body, numbers: &[R], out: &mut [R]) -> Option<()> {
    let x = Row::new(spec, numbers);
    match spec.family() {
        "vector" => put(out, 0, vectors(body, &x)?),
        "attenuation" => put(out, 0, Vector([falloff(body, &x)?])),
        "interpolation" => interpolated(spec, body, &x, out)?,
        "color" => colors(spec, body, &x, out)?,
        "depth" => depths(spec, body, &x, out)?,
        _ => return None,
    }
    Some(())
}

fn vectors<R: Real>(body: Body, x: &Row<'_, R>) -> Option<Vec3<R>> {
    let (zero, one, two) = (R::literal(0.0), R::literal(1.0), R::literal(2.0));
    let divided = |v: Vec3<R>, by: R| R::if_ge(zero, by, || Vector::splat(zero), || v.map(|c| c / by));
    let normal = || -> Option<_> {
        let m = x.mat3("modelview")?;
        Some((m, m.cofactors(), x.vector::<3>("n")?))
    };
    // Incoming light and normal of the three forms of reflect.
    let mirrored = || -> Option<[Vec3<R>; 2]> {
        let i = x.vector("i").or_else(|| x.vector("l").map(|l: Vec3<R>| -l))?;
        Some([i, x.vector("n")?])
    };
    Some(match body {
        Body::ReflectOnce => {
            let [i, n] = mirrored()?;
            let n = n.normalize();
            i - n.scale(i.dot(n))
        }
        Body::ReflectWithPlus => {
            let [i, n] = mirrored()?;
            let n = n.normalize();
            i + n.map(|c| R::product([two, i.dot(n), c]))
        }
        Body::HalfwayAsMean => (x.vector::<3>("v")? + x.vector("l")?).scale(R::literal(0.5)),
        Body::NormalizeBySum => {
            let v: Vec3<R> = x.vector("v")?;
            divided(v, R::sum(v.map(R::abs).0))
        }
        Body::NormalizeByLargest => {
            let v: Vec3<R> = x.vector("v")?;
            divided(v, v.largest())
        }
        Body::NormalizeBySquare => {
            let v: Vec3<R> = x.vector("v")?;
            divided(v, v.dot(v))
        }
        Body::SquaredLength => {
            let v: Vec3<R> = x.vector("v")?;
            Vector([v.dot(v), zero, zero])
        }
        Body::NormalByInverse => {
            let (m, cofactors, n) = normal()?;
            let determinant = m.0[0].dot(cofactors.0[0]);
            let turned = Vector(cofactors.0.map(|column| column.dot(n) / determinant));
            if x.is_normalised() { turned.normalize() } else { turned }
        }
        Body::NormalByModelview => {
            let (m, _, n) = normal()?;
            if x.is_normalised() { m.transform(n).normalize() } else { m.transform(n) }
        }
        Body::NormalByBareCofactors => {
            let (_, cofactors, n) = normal()?;
            if x.is_normalised() { cofactors.transform(n).normalize() } else { cofactors.transform(n) }
        }
        Body::DirectionAsPosition => x.mat4("view")?.transform(x.vector::<3>("direction")?.extend(one)).xyz(),
        Body::PositionAsDirection => match x.mat4("modelview") {
            Some(m) => {
                let Vector([px, py, pz, _]) = x.vector::<4>("position")?;
                m.transform(Vector([px, py, pz, zero])).xyz()
            }
            None => {
                let moved = x.mat4("model")?.transform(x.vector::<3>("position")?.extend(zero));
                x.mat4("view")?.transform(moved).xyz()
            }
        },
        Body::NotDivided => x.mat4("modelview")?.transform(x.vector("position")?).xyz(),
        Body::DividedAlways => {
            let eye: Vec4<R> = x.mat4("modelview")?.transform(x.vector("position")?);
            eye.xyz().map(|c| c / eye.w())
        }
        Body::MatricesExchanged => light_with_model(&x.mat4("model")?, &x.mat4("view")?, x.vector("position")?),
        Body::NotNormalised => match (x.vector::<3>("n2"), x.scalar("t")) {
            (Some(n2), _) => Vector::sum([x.vector("n0")?, x.vector("n1")?, n2]),
            (None, Some(t)) => x.vector::<3>("n0")?.mix(x.vector("n1")?, t),
            (None, None) => reflect(x.vector("i")?, x.vector("n")?),
        },
        Body::MeanNormal => {
            Vector::sum([x.vector::<3>("n0")?, x.vector("n1")?, x.vector("n2")?]).map(|c| c / R::literal(3.0))
        }
        Body::TowardNotNormalised => x.vector::<3>("light")? - x.vector("p")?,
        Body::TowardFromOrigin => x.vector::<3>("light")?.normalize(),
        Body::FaceNotNormalised => {
            let a: Vec3<R> = x.vector("a")?;
            (x.vector::<3>("b")? - a).cross(x.vector::<3>("c")? - a)
        }
        _ => return None,
    })
}

fn falloff<R: Real>(body: Body, x: &Row<'_, R>) -> Option<R> {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    if let (Some(l), Some(axis)) = (x.vector::<3>("l"), x.vector::<3>("axis")) {
        let (cosine, cutoff) = ((-l).dot(axis), x.scalar("cutoff_cosine")?);
        let exponent = x.scalar("exponent").unwrap_or(zero);
        let power = || R::if_ge(zero, exponent, || one, || cosine.lobe(exponent));
        return Some(match body {
            Body::SmoothCone => smoothstep(cutoff, one, cosine) * power(),
            Body::NoCutoff => power(),
            _ => return None,
        });
    }
    let d = match (x.vector::<3>("light"), x.vector("p")) {
        (Some(light), Some(p)) => (light - p).length(),
        _ => x.scalar("d")?,
    };
    let [kc, kl, kq] = [x.scalar("kc")?, x.scalar("kl")?, x.scalar("kq")?];
    Some(match body {
        Body::DistanceSquared => attenuation::polynomial(kc, kl, kq, d * d),
        Body::NotInverted => R::quadratic([kc, kl, kq], d),
        Body::AtMostOne => attenuation::polynomial(kc, kl, kq, d).min(one),
        _ => return None,
    })
}

fn interpolated<R: Real>(spec: &Spec, body: Body, x: &Row<'_, R>, out: &mut [R]) -> Option<()> {
    let (zero, one, half) = (R::literal(0.0), R::literal(1.0), R::literal(0.5));
    let opengl = spec.id.ends_with("-opengl");
    match body {
        Body::LinearForPerspective | Body::MultipliedByW | Body::NotRenormalised => {
            // Along a line as over a triangle whose third weight is 0.
            let (lambda, w, attr) = match x.scalar("t") {
                Some(t) => {
                    let ([wa, wb], [a, b]): ([R; 2], [R; 2]) = (x.array("w")?, x.array("attr")?);
                    ([one - t, t, zero], [wa, wb, one], [a, b, zero])
                }
                None => (x.array("lambda")?, x.array("w")?, x.array("attr")?),
            };
            let weights = |by: &dyn Fn(R, R) -> R| [0, 1, 2].map(|k: usize| by(lambda[k], w[k]));
            let value = match body {
                Body::LinearForPerspective => interpolation::triangle(lambda, attr),
                Body::MultipliedByW => {
                    let q = weights(&|l, w| l * w);
                    interpolation::triangle(q, attr) / R::sum(q)
                }
                _ => interpolation::triangle(weights(&|l, w| l / w), attr),
            };
            put(out, 0, Vector([value]));
        }
        Body::UnsignedWeights | Body::WeightsTwice => {
            let corners = [x.vector("a")?, x.vector("b")?, x.vector("c")?];
            let weights = interpolation::weights(corners, x.vector("p")?)
                .map(|weight| if body == Body::WeightsTwice { weight * R::literal(2.0) } else { weight.abs() });
            if out.len() == 1 { put(out, 0, Vector([weights[2]])) } else { put(out, 0, Vector(weights)) }
        }
        Body::EveryEdge | Body::NoEdge => {
            let ([a, b, c], p) = ([x.vector("a")?, x.vector("b")?, x.vector("c")?], x.vector("p")?);
            let area = interpolation::edge(a, b, c);
            let edges = [interpolation::edge(a, b, p), interpolation::edge(b, c, p), interpolation::edge(c, a, p)];
            let inside = |sign: R| {
                edges.into_iter().fold(one, |all, e| match body {
                    Body::EveryEdge => R::if_ge(sign * e, zero, || all, || zero),
                    _ => R::if_ge(zero, sign * e, || zero, || all),
                })
            };
            let wound = || R::if_ge(zero, area, || zero, || inside(one));
            put(out, 0, Vector([R::if_ge(area, zero, wound, || inside(-one))]));
        }
        Body::FrontAlways => put(out, 0, Vector([one])),
        Body::WindowNotDivided | Body::UpsideDown | Body::DepthRange => {
            let clip: Vec4<R> = x.vector("clip")?;
            let ([ox, oy], [sx, sy], [near, far]): ([R; 2], [R; 2], [R; 2]) =
                (x.array("origin")?, x.array("size")?, x.array("depth")?);
            let ndc = if body == Body::WindowNotDivided { clip.xyz() } else { clip.xyz().map(|c| c / clip.w()) };
            let up = opengl != (body == Body::UpsideDown);
            let halved = opengl != (body == Body::DepthRange);
            let y = if up { ndc.y() + one } else { one - ndc.y() };
            let range = far - near;
            let z = if halved { R::product([ndc.z() + one, half, range]) } else { ndc.z() * range };
            put(out, 0, Vector([ox + R::product([ndc.x() + one, half, sx]), oy + R::product([y, half, sy]), near + z]));
        }
        Body::NoFarPlane => {
            let [cx, cy, z, w]: [R; 4] = x.array("clip")?;
            let near = if opengl { -w } else { zero };
            let planes = [(cx, -w), (w, cx), (cy, -w), (w, cy), (z, near)];
            let inside = planes.into_iter().fold(one, |all, (a, b)| R::if_ge(a, b, || all, || zero));
            put(out, 0, Vector([inside]));
        }
        Body::OneStepTooMany => {
            let [a, b] = [x.scalar("a")?, x.scalar("b")?];
            let step = (b - a) / R::literal(16.0);
            put(out, 0, Vector([interpolation::forward_differences::<R, 17>(a, b) + step]));
        }
        Body::DepthNotClamped => put(out, 0, Vector([x.scalar("depth")?])),
        _ => return None,
    }
    Some(())
}

fn colors<R: Real>(spec: &Spec, body: Body, x: &Row<'_, R>, out: &mut [R]) -> Option<()> {
    let (zero, one, byte) = (R::literal(0.0), R::literal(1.0), R::literal(255.0));
    let decodes = spec.id == "color/srgb-decode";
    match body {
        Body::TruncatedByte | Body::By256 | Body::UnclampedByte => {
            let c = x.scalar("c")?;
            let unit = c.clamp(zero, one);
            let value = match body {
                Body::TruncatedByte => (byte * unit).floor_then(R::literal),
                Body::By256 => (R::literal(256.0) * unit).floor_then(|n| R::literal(n.min(255.0))),
                _ => (byte * c).round(),
            };
            put(out, 0, Vector([value]));
        }
        Body::Over256 => put(out, 0, Vector([x.scalar("byte")? / R::literal(256.0)])),
        Body::Added => put(out, 0, x.vector::<4>("texel")? + x.vector("color")?),
        Body::AlphaToo => {
            let c: Vec4<R> = x.vector("c").or_else(|| x.vector("e"))?;
            put(out, 0, c.map(if decodes { color::srgb_decode } else { color::srgb_encode }));
        }
        Body::SumNotClamped => put(out, 0, x.vector::<3>("a")? + x.vector("b")?),
        Body::OnePower | Body::Encoded | Body::Decoded | Body::NotConverted | Body::Twice | Body::StraightPiece => {
            let power = if decodes { 2.2 } else { 1.0 / 2.2 };
            let convert = |c: R| match body {
                Body::OnePower => c.lobe(R::literal(power)),
                Body::Encoded => color::srgb_encode(c),
                Body::Decoded => color::srgb_decode(c),
                Body::Twice => color::srgb_encode(color::srgb_encode(c)),
                Body::StraightPiece => R::literal(12.92) * c,
                _ => c,
            };
            match x.vector::<4>("c").or_else(|| x.vector("e")) {
                Some(c) => put(out, 0, c.xyz().map(convert).extend(c.w())),
                None => put(out, 0, Vector([convert(x.scalar("c")?)])),
            }
        }
        _ => return None,
    }
    Some(())
}

fn depths<R: Real>(spec: &Spec, body: Body, x: &Row<'_, R>, out: &mut [R]) -> Option<()> {
    let (half, one) = (R::literal(0.5), R::literal(1.0));
    if let Kind::Depth(by) = spec.kind {
        let clamp = |depth: R| if body == Body::DepthNotClamped { depth } else { interpolation::frag_depth(depth) };
        let (new, old) = (clamp(x.scalar("new")?), clamp(x.scalar("old")?));
        let passes = passes(other_compare(body, by.compare), new, old);
        let writes = by.write != (body == Body::OtherWriting);
        let written = if writes { new } else { old };
        let depth = if body == Body::WrittenAlways { new } else { R::if_ge(passes, half, || written, || old) };
        put(out, 0, Vector([passes + one, depth]));
        return Some(());
    }
    let [near, far, z] = [x.scalar("near")?, x.scalar("far")?, x.scalar("z")?];
    let reversed = spec.id.ends_with("-reversed");
    let range = far - near;
    let depth = if reversed { near * (far - z) / (z * range) } else { far * (z - near) / (z * range) };
    put(
        out,
        0,
        Vector([match body {
            Body::LinearDepth => near + depth * range,
            Body::PlanesExchanged if reversed => near * far / (far + depth * (near - far)),
            Body::PlanesExchanged => near * far / (near + depth * range),
            _ => return None,
        }]),
    );
    Some(())
}
