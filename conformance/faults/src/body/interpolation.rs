//! Interpolation, coverage and the viewport with a step wrong.

use super::super::row::{InputRow, put};
use super::Body;
use lightmeter_catalogue::cases::Spec;
use lightmeter_reference::{Real, Vec4, Vector, interpolation};

pub(super) fn interpolated<R: Real>(spec: &Spec, body: Body, x: &InputRow<'_, R>, out: &mut [R]) -> Option<()> {
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
