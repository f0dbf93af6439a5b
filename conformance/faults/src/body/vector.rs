//! Vectors and transforms with a step wrong.

use super::super::row::InputRow;
use super::Body;
use lightmeter_reference::vector::{light_with_model, reflect};
use lightmeter_reference::{Real, Vec3, Vec4, Vector};

pub(super) fn vectors<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<Vec3<R>> {
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
