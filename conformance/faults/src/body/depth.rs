//! The depth test, and distances read back from depth with a step wrong.

use super::super::row::{InputRow, put};
use super::Body;
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_reference::depth::passes;
use lightmeter_reference::{Real, Vector, interpolation};
use lightmeter_scene::depth::Compare;

pub(super) fn other_compare(body: Body, compare: Compare) -> Compare {
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

pub(super) fn depths<R: Real>(spec: &Spec, body: Body, x: &InputRow<'_, R>, out: &mut [R]) -> Option<()> {
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
    if spec.id.starts_with("depth/stored") {
        let wrong = match (body, reversed) {
            (Body::LinearDepth, false) => (z - near) / range,
            (Body::LinearDepth, true) => (far - z) / range,
            (Body::PlanesExchanged, false) => near * (far - z) / (z * range),
            (Body::PlanesExchanged, true) => far * (z - near) / (z * range),
            _ => return None,
        };
        put(out, 0, Vector([wrong]));
        return Some(());
    }
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
