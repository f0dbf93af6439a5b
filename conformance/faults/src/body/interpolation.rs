//! Interpolation, coverage and the viewport with a step wrong.

use super::super::row::{InputRow, put};
use super::Body;
use lightmeter_catalogue::cases::Spec;
use lightmeter_reference::{Real, Vec3, Vec4, Vector, interpolation};

pub(super) fn interpolated<R: Real>(spec: &Spec, body: Body, x: &InputRow<'_, R>, out: &mut [R]) -> Option<()> {
    let opengl = spec.id.ends_with("-opengl");
    match body {
        Body::LinearForPerspective | Body::MultipliedByW | Body::NotRenormalised => {
            put(out, 0, Vector([perspective(body, x)?]));
        }
        Body::UnsignedWeights | Body::WeightsTwice => {
            let weights = weights(body, x)?;
            if out.len() == 1 { put(out, 0, Vector([weights[2]])) } else { put(out, 0, Vector(weights)) }
        }
        Body::EveryEdge | Body::NoEdge => put(out, 0, Vector([coverage(body, x)?])),
        Body::FrontAlways => put(out, 0, Vector([R::literal(1.0)])),
        Body::MixFromTheEnd => {
            let [a, b, t] = [x.scalar("a")?, x.scalar("b")?, x.scalar("t")?];
            put(out, 0, Vector([b - (R::literal(1.0) - t) * (b - a)]));
        }
        Body::EdgeFromItsEnd => {
            let [a, b, p] = [x.vector::<2>("a")?, x.vector("b")?, x.vector("p")?];
            let edge = |a, b, p| interpolation::edge(b, p, a);
            match (x.vector("c"), out.len()) {
                (None, _) => put(out, 0, Vector([edge(a, b, p)])),
                (Some(c), 1) => put(out, 0, Vector([edge(a, b, p) / edge(a, b, c)])),
                (Some(c), _) => {
                    put(out, 0, Vector([(b, c), (c, a), (a, b)].map(|(u, v)| edge(u, v, p) / edge(a, b, c))))
                }
            }
        }
        Body::WindowNotDivided | Body::UpsideDown | Body::DepthRange | Body::DepthBetween => {
            put(out, 0, window(body, opengl, x)?)
        }
        Body::NoFarPlane => put(out, 0, Vector([before_the_far_plane(opengl, x)?])),
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

/// An attribute over a triangle, or along a line as over a triangle whose third weight is 0.
fn perspective<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<R> {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let (lambda, w, attr) = match x.scalar("t") {
        Some(t) => {
            let ([wa, wb], [a, b]): ([R; 2], [R; 2]) = (x.array("w")?, x.array("attr")?);
            ([one - t, t, zero], [wa, wb, one], [a, b, zero])
        }
        None => (x.array("lambda")?, x.array("w")?, x.array("attr")?),
    };
    let weights = |by: &dyn Fn(R, R) -> R| [0, 1, 2].map(|k: usize| by(lambda[k], w[k]));
    Some(match body {
        Body::LinearForPerspective => interpolation::triangle(lambda, attr),
        Body::MultipliedByW => {
            let q = weights(&|l, w| l * w);
            interpolation::triangle(q, attr) / R::sum(q)
        }
        _ => interpolation::triangle(weights(&|l, w| l / w), attr),
    })
}

/// The weights of a point in a triangle.
fn weights<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<[R; 3]> {
    let corners = [x.vector("a")?, x.vector("b")?, x.vector("c")?];
    let weights = interpolation::weights(corners, x.vector("p")?);
    Some(weights.map(|weight| if body == Body::WeightsTwice { weight * R::literal(2.0) } else { weight.abs() }))
}

/// Whether a triangle covers a point: 1 or 0.
fn coverage<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<R> {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
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
    Some(R::if_ge(area, zero, wound, || inside(-one)))
}

/// Window coordinates and depth of a vertex.
fn window<R: Real>(body: Body, opengl: bool, x: &InputRow<'_, R>) -> Option<Vec3<R>> {
    let (one, half) = (R::literal(1.0), R::literal(0.5));
    let clip: Vec4<R> = x.vector("clip")?;
    let ([ox, oy], [sx, sy], [near, far]): ([R; 2], [R; 2], [R; 2]) =
        (x.array("origin")?, x.array("size")?, x.array("depth")?);
    let ndc = if body == Body::WindowNotDivided { clip.xyz() } else { clip.xyz().map(|c| c / clip.w()) };
    let up = opengl != (body == Body::UpsideDown);
    let halved = opengl != (body == Body::DepthRange);
    let y = if up { ndc.y() + one } else { one - ndc.y() };
    let range = far - near;
    let z = if body == Body::DepthBetween {
        let t = if halved { (ndc.z() + one) * half } else { ndc.z() };
        near * (one - t) + far * t
    } else {
        near + if halved { R::product([ndc.z() + one, half, range]) } else { ndc.z() * range }
    };
    Some(Vector([ox + R::product([ndc.x() + one, half, sx]), oy + R::product([y, half, sy]), z]))
}

/// Whether a vertex lies in the clip volume, but for its far plane: 1 or 0.
fn before_the_far_plane<R: Real>(opengl: bool, x: &InputRow<'_, R>) -> Option<R> {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let [cx, cy, z, w]: [R; 4] = x.array("clip")?;
    let near = if opengl { -w } else { zero };
    let planes = [(cx, -w), (w, cx), (cy, -w), (w, cy), (z, near)];
    Some(planes.into_iter().fold(one, |all, (a, b)| R::if_ge(a, b, || all, || zero)))
}
