//! Attenuation and spotlights with a step wrong.

use super::super::row::InputRow;
use super::Body;
use lightmeter_reference::departure::smoothstep;
use lightmeter_reference::{Real, attenuation};

pub(super) fn falloff<R: Real>(body: Body, x: &InputRow<'_, R>) -> Option<R> {
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
        _ => return None,
    })
}
