//! Vectors and transforms with a step wrong.

use super::super::row::InputRow;
use super::Body;
use lightmeter_reference::vector::{light_with_model, reflect};
use lightmeter_reference::{Real, Vec3, Vec4, Vector};

pub(super) fn vectors<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<Vec3<R>> {
    Some(match body {
        Body::ReflectOnce | Body::ReflectWithPlus => reflected(body, x)?,
        Body::HalfwayAsMean => (x.vector::<3>("v")? + x.vector("l")?).scale(R::literal(0.5)),
        Body::NormalizeBySum | Body::NormalizeByLargest | Body::NormalizeBySquare => normalized(body, x)?,
        Body::SquaredLength => {
            let v: Vec3<R> = x.vector("v")?;
            Vector([v.dot(v), R::literal(0.0), R::literal(0.0)])
        }
        Body::NormalByInverse | Body::NormalByModelview | Body::NormalByBareCofactors => normal(body, x)?,
        Body::DirectionAsPosition
        | Body::PositionAsDirection
        | Body::NotDivided
        | Body::DividedAlways
        | Body::MatricesExchanged => light(body, x)?,
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

/// Light that is mirrored at a surface, in the three forms of reflect.
fn reflected<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<Vec3<R>> {
    let i: Vec3<R> = x.vector("i").or_else(|| x.vector("l").map(|l: Vec3<R>| -l))?;
    let n = x.vector::<3>("n")?.normalize();
    Some(match body {
        Body::ReflectOnce => i - n.scale(i.dot(n)),
        _ => i + n.map(|c| R::product([R::literal(2.0), i.dot(n), c])),
    })
}

/// A vector over what is not its length.
fn normalized<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<Vec3<R>> {
    let zero = R::literal(0.0);
    let v: Vec3<R> = x.vector("v")?;
    let by = match body {
        Body::NormalizeBySum => R::sum(v.map(R::abs).0),
        Body::NormalizeByLargest => v.largest(),
        _ => v.dot(v),
    };
    Some(R::if_ge(zero, by, || Vector::splat(zero), || v.map(|c| c / by)))
}

/// A normal in eye space.
fn normal<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<Vec3<R>> {
    let m = x.mat3("modelview")?;
    let (cofactors, n) = (m.cofactors(), x.vector::<3>("n")?);
    let turned = match body {
        Body::NormalByInverse => {
            let determinant = m.0[0].dot(cofactors.0[0]);
            Vector(cofactors.0.map(|column| column.dot(n) / determinant))
        }
        Body::NormalByModelview => m.transform(n),
        _ => cofactors.transform(n),
    };
    Some(if x.is_normalised() { turned.normalize() } else { turned })
}

/// A light's direction or position in eye space.
fn light<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<Vec3<R>> {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    Some(match body {
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
        _ => light_with_model(&x.mat4("model")?, &x.mat4("view")?, x.vector("position")?),
    })
}
