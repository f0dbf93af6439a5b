//! Depth tests (000 §6.6, 002): which of two fragments at a pixel stays, and the depth that stays with it.
//!
//! Symbols: `new` the depth of the fragment that is drawn, `old` the one that is there. Both are clamped to the viewport's
//! range, [0, 1], before they are stored or compared (ruling 15), so that what lies beyond is equal to its end.

use crate::interpolation::frag_depth;
use crate::real::Real;
use crate::step::step;
use lightmeter_scene::depth::{Compare, DepthTest};

/// What a pixel holds after a fragment was drawn over another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tested<R> {
    /// 1 where the fragment that was there stays, 2 where the new one is seen.
    pub seen: R,
    /// The depth that is left.
    pub depth: R,
}

/// A fragment at depth `new` over one at depth `old`. Without a test (always, not written) the order of drawing decides.
/// Source: 000 §6.6, 002.
pub fn test<R: Real>(by: DepthTest, new: R, old: R) -> Tested<R> {
    let (new, old) = (frag_depth(new), frag_depth(old));
    let passes = passes(by.compare, new, old);
    let written = if by.write { new } else { old };
    let depth = step!("depth left", |passes, written, old| R::if_ge(passes, R::literal(0.5), || written, || old));
    Tested { seen: passes + R::literal(1.0), depth }
}

/// 1 where `new` passes against `old`, else 0.
pub fn passes<R: Real>(compare: Compare, new: R, old: R) -> R {
    let (yes, no) = (R::literal(1.0), R::literal(0.0));
    let at_least = |a: R, b: R| R::if_ge(a, b, || yes, || no);
    match compare {
        Compare::Never => no,
        Compare::Less => yes - at_least(new, old),
        Compare::Equal => at_least(new, old) * at_least(old, new),
        Compare::LessEqual => at_least(old, new),
        Compare::Greater => yes - at_least(old, new),
        Compare::NotEqual => yes - at_least(new, old) * at_least(old, new),
        Compare::GreaterEqual => at_least(new, old),
        Compare::Always => yes,
    }
}

/// The depth that a perspective projection stores for an eye-space distance z: `f(z − n)/(z(f − n))`, 0 at the near plane n and 1 at the
/// far plane f. Source: 000 §6.6; ruling 15.
pub fn stored<R: Real>(near: R, far: R, z: R) -> R {
    step!("depth", |near, far, z| far * (z - near) / (z * (far - near)))
}

/// The same with depth reversed, `n(f − z)/(z(f − n))`: 1 at the near plane, and 0 at the far plane, where binary32 has its finest steps.
pub fn stored_reversed<R: Real>(near: R, far: R, z: R) -> R {
    step!("reversed depth", |near, far, z| near * (far - z) / (z * (far - near)))
}

/// An eye-space distance z written as [`stored`] depth and read back as `n·f/(f − depth(f − n))`: z again, but for what the depth has
/// lost near 1. For n ≤ z ≤ f.
pub fn recovered<R: Real>(near: R, far: R, z: R) -> R {
    let depth = stored(near, far, z);
    step!("z", |near, far, depth| near * far / (far - depth * (far - near)))
}

/// The same with depth reversed: [`stored_reversed`].
pub fn recovered_reversed<R: Real>(near: R, far: R, z: R) -> R {
    let depth = stored_reversed(near, far, z);
    step!("z", |near, far, depth| near * far / (near + depth * (far - near)))
}
