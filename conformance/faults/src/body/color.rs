//! Colours and their storage with a step wrong.

use super::super::row::{InputRow, put};
use super::Body;
use lightmeter_catalogue::cases::Spec;
use lightmeter_reference::{Real, Vec4, Vector, color};

pub(super) fn colors<R: Real>(spec: &Spec, body: Body, x: &InputRow<'_, R>, out: &mut [R]) -> Option<()> {
    let (zero, one, byte) = (R::literal(0.0), R::literal(1.0), R::literal(255.0));
    let decodes = spec.id == "color/srgb-decode";
    match body {
        Body::TruncatedByte | Body::By256 | Body::UnclampedByte | Body::RoundedBySum => {
            let c = x.scalar("c")?;
            let unit = c.clamp(zero, one);
            let value = match body {
                Body::TruncatedByte => (byte * unit).floor_then(R::literal),
                Body::RoundedBySum => (byte * unit + R::literal(0.5)).floor_then(R::literal),
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
