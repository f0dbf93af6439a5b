//! Whether a vector points from the surface to what it is for.

use super::Review;
use super::role::words;
use crate::graph::{Binary, NodeId, Op, Origin};

/// What tells which way a vector points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Direction {
    /// Whether it points from the surface.
    pub(super) is_toward: bool,
    /// Whether what it is made of says so, and not its name alone.
    pub(super) is_certain: bool,
}

impl Review<'_> {
    /// Which way the core of a vector points, with the sign of what stands around it; none if nothing says it.
    pub(super) fn direction(&self, id: NodeId) -> Option<Direction> {
        let (core, is_negated) = self.core(id);
        match *self.graph.op(core) {
            Op::Binary(Binary::Subtract, a, b) => {
                let is_toward = match (self.is_of_surface(a)?, self.is_of_surface(b)?) {
                    (false, true) => true,
                    (true, false) => false,
                    _ => return None,
                };
                Some(Direction { is_toward: is_toward != is_negated, is_certain: true })
            }
            Op::Leaf(_) | Op::MatrixVector(..) | Op::Swizzle(..) => {
                let is_toward = self.named_direction(core)?;
                Some(Direction { is_toward: is_toward != is_negated, is_certain: false })
            }
            _ => None,
        }
    }

    fn named_direction(&self, core: NodeId) -> Option<bool> {
        let names = self.names(core);
        let text = names.to_lowercase();
        let has = |all: &[&str]| all.iter().any(|own| text.contains(own));
        if has(&["surfaceto", "tolight", "to_light", "toeye", "to_eye", "toview", "tocam"]) {
            return Some(true);
        }
        if has(&["fromlight", "lighttopixel", "fromeye"]) {
            return Some(false);
        }
        let is_direction = has(&["dir", "norm"]);
        let is_position = |word: &String| {
            ["position", "pos", "vertex", "p", "vert", "point"].contains(&&**word)
                || ["vertex", "position", "pos"].iter().any(|end| word.ends_with(end))
        };
        let of_light = has(&["light", "lamp", "sun"]);
        (words(&names).iter().any(is_position) && !is_direction && !of_light).then_some(false)
    }

    /// Whether a position is the surface's, and not the light's or the eye's.
    fn is_of_surface(&self, id: NodeId) -> Option<bool> {
        let leaves: Vec<_> = self.graph.leaves_of(id).into_iter().filter_map(|own| self.graph.leaf_of(own)).collect();
        if leaves.iter().all(|leaf| leaf.origin == Origin::Uniform) {
            return Some(false);
        }
        let is_given = |origin: Origin| matches!(origin, Origin::Input | Origin::Texture | Origin::BuiltIn);
        if leaves.iter().any(|leaf| is_given(leaf.origin)) {
            // An input may be the light's position, moved by the stage before.
            let text = leaves.iter().map(|leaf| leaf.name.to_lowercase()).collect::<Vec<_>>().join(" ");
            let of_light = ["light", "lamp", "sun", "eye", "cam"].iter().any(|own| text.contains(own));
            return if of_light { None } else { Some(true) };
        }
        let text = leaves.iter().map(|leaf| leaf.name.to_lowercase()).collect::<Vec<_>>().join(" ");
        let has = |all: &[&str]| all.iter().any(|own| text.contains(own));
        if has(&["light", "eye", "cam", "view", "lamp", "sun"]) && !text.contains("viewpos") {
            Some(false)
        } else {
            has(&["pos", "frag", "vert", "surface"]).then_some(true)
        }
    }
}
