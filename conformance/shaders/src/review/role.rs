//! What a vector is for: by what it is made of, and by names where that leaves it open.

use super::Review;
use crate::graph::{Binary, Function, NodeId, Op};

/// What a vector is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Normal,
    Light,
    Eye,
    Half,
    Mirrored,
    Axis,
    Unknown,
}

/// The words of a name: camel case and underscores are their borders.
pub(super) fn words(name: &str) -> Vec<String> {
    let mut found: Vec<String> = vec![];
    let mut before = ' ';
    for c in name.chars() {
        let begins = !before.is_alphanumeric() || c.is_uppercase() && before.is_lowercase();
        if c.is_alphanumeric() {
            match found.last_mut() {
                Some(word) if !begins => word.extend(c.to_lowercase()),
                _ => found.push(c.to_lowercase().collect()),
            }
        }
        before = c;
    }
    found
}

/// Whether a word is one of these, or holds one of more than three letters.
fn is_any(words: &[String], of: &[&str]) -> bool {
    words.iter().any(|word| of.iter().any(|own| word == own || own.len() > 3 && word.contains(own)))
}

impl Review<'_> {
    /// What is behind signs, normalisation and the first three components, and whether its sign is turned.
    pub(super) fn core(&self, id: NodeId) -> (NodeId, bool) {
        let (mut own, mut is_negated) = (id, false);
        loop {
            own = match self.graph.op(own) {
                Op::Negate(inner) => {
                    is_negated = !is_negated;
                    *inner
                }
                Op::Call(Function::Normalize, of) => of[0],
                Op::Swizzle(of, pattern) if pattern.len() == 3 && matches!(self.graph.op(*of), Op::Leaf(_)) => *of,
                _ => return (own, is_negated),
            };
        }
    }

    /// The names of all that a value is made of, in one text.
    pub(super) fn names(&self, id: NodeId) -> String {
        self.graph.names_of(id).join(" ")
    }

    pub(super) fn lower_names(&self, id: NodeId) -> String {
        self.names(id).to_lowercase()
    }

    /// Whether a vector is what a role's names say: a tie-breaker.
    pub(super) fn named(&self, id: NodeId) -> Role {
        let core = self.core(id).0;
        match self.graph.op(core) {
            Op::Call(Function::Reflect, _) => return Role::Mirrored,
            Op::Binary(Binary::Add | Binary::Subtract, a, b) => {
                let is_unit = |own: NodeId| {
                    matches!(self.graph.op(self.graph.without_sign(own).0), Op::Call(Function::Normalize, _))
                };
                let is_known = |own: NodeId| matches!(self.named(own), Role::Light | Role::Eye);
                let are_both = || {
                    let of = [self.named(*a), self.named(*b)];
                    let is_sum = matches!(self.graph.op(core), Op::Binary(Binary::Add, ..));
                    is_sum
                        && of.contains(&Role::Light)
                        && of.contains(&Role::Eye)
                        && !self.lower_names(core).contains("pos")
                };
                if is_unit(*a) && (is_unit(*b) || is_known(*b)) || is_unit(*b) && is_known(*a) || are_both() {
                    return Role::Half;
                }
            }
            _ => {}
        }
        let text = self.names(core);
        let lower = text.to_lowercase();
        // A field is what its own name says.
        let flat = lower.rsplit('.').next().filter(|last| !last.contains(' ')).unwrap_or(&lower);
        let words = words(&text);
        let has = |of: &[&str]| is_any(&words, of);
        let is_light_normal =
            text.split(' ').map(str::to_lowercase).any(|own| own.contains("light") && own.contains("normal"));
        if flat == "axis"
            || has(&["spot", "cone", "axis"]) && !has(&["position", "pos", "posn", "location"]) && lower.contains("dir")
        {
            Role::Axis
        } else if has(&["half", "halfway"]) || flat == "h" {
            Role::Half
        } else if is_light_normal {
            Role::Light
        } else if has(&["normal", "norm", "normals", "nrm", "bump"]) || ["n", "nn"].contains(&flat) {
            Role::Normal
        } else if has(&["light", "sun", "lamp", "lights", "lightpos", "lpos", "lightdir"]) || flat == "l" {
            Role::Light
        // A surface's position is the vector from the eye, where that is the origin.
        } else if has(&[
            "eye", "view", "camera", "cam", "viewer", "position", "posn", "vertex", "pos", "point", "p", "frag",
        ]) || ["v", "e"].contains(&flat)
        {
            Role::Eye
        } else {
            Role::Unknown
        }
    }

    /// Whether the two of a Lambert factor are as a normal and a light are: not of one kind.
    pub(super) fn is_normal(&self, id: NodeId) -> bool {
        self.named(id) == Role::Normal || self.normals.contains(&self.core(id).0)
    }

    /// Whether somewhere the dot product of two vectors is taken.
    pub(super) fn has_dot(&self, a: NodeId, b: NodeId) -> bool {
        self.users(a).iter().chain(self.users(b)).any(|own| match self.graph.op(*own) {
            Op::Call(Function::Dot, x) => {
                let cores = (self.core(x[0]).0, self.core(x[1]).0);
                cores == (a, b) || cores == (b, a)
            }
            Op::Call(Function::Normalize, _) | Op::Negate(_) => {
                self.users(*own).iter().any(|next| match self.graph.op(*next) {
                    Op::Call(Function::Dot, x) => {
                        let cores = (self.core(x[0]).0, self.core(x[1]).0);
                        cores == (a, b) || cores == (b, a)
                    }
                    _ => false,
                })
            }
            _ => false,
        })
    }
}
