//! Which matches are steps: a step's result is used as what the step is for.

use super::Review;
use super::role::Role;
use super::site::Way;
use crate::graph::{Binary, Function, NodeId, Op, Origin, Type};
use crate::templates::Worth;
use crate::unify::{Length, Match, Template};

/// Powers that are taken to encode, or to decode.
const GAMMAS: [f64; 3] = [2.2, 2.4, 2.0];

impl Review<'_> {
    fn bound(&self, own: &Match, name: &str) -> Option<NodeId> {
        let template = self.finder.template(own);
        template.parameters.iter().position(|parameter| parameter.0 == name).map(|slot| own.bound[slot].id)
    }

    /// The kind of step that a match is; none if it is none.
    pub(super) fn accepted(&mut self, id: NodeId, own: &Match, way: &Way) -> Option<String> {
        let template = self.finder.template(own);
        let kind = &*template.head.kind;
        let get = |name: &str| self.bound(own, name);
        let is_step = match kind {
            "lambert" => self.is_lambert(id, own, template, way),
            "lobe" => return self.kind_of_lobe(id, get("a")?, get("b")?),
            "ramp" => return self.kind_of_ramp(id, get("x")?, template, way),
            "fog" => {
                let text = self.lower_names(id);
                let is_named = |words: &[&str]| words.iter().any(|word| text.contains(word));
                // An exponential is much else: a mistake is claimed of what is called fog alone.
                is_named(&["fog"])
                    || way.is_fog
                    || self.is_of_root(id, "fog")
                    || template.head.worth != Worth::Mistake
                        && (is_named(&["densit", "mist", "haze"]) || self.finder.distance(get("d")?) > 4)
            }
            "mix" => return self.is_fog_mix(id, get("amount")?).then(|| "fog-mix".into()),
            "gamma" => self.is_gamma(id, get("power")),
            "normal-transform" => {
                let normal = get("normal")?;
                // A normal that is added to a place gives a place.
                if template.head.worth == Worth::Mistake && matches!(self.graph.op(normal), Op::Binary(Binary::Add, ..))
                {
                    return None;
                }
                self.named(normal) == Role::Normal || self.is_decoded(normal) || self.normals.contains(&id)
            }
            "decode-normal" => {
                let leaves = self.graph.leaves_of(get("color")?);
                let has_texture = leaves
                    .iter()
                    .any(|own| self.graph.leaf_of(*own).is_some_and(|leaf| leaf.origin == Origin::Texture));
                let text = self.lower_names(id);
                has_texture && ["norm", "bump", "nrm", "tangent", "texture"].iter().any(|word| text.contains(word))
            }
            "blinn" => {
                let is_cone = get("exponent").is_some_and(|own| self.lower_names(own).contains("spot"));
                return Some(if is_cone { "spot" } else { "blinn" }.into());
            }
            "attenuation" | "divisor" => self.is_attenuation(id, own, template),
            "spot" => self.is_spot(id, own, template),
            "schlick" => self.is_fresnel(id, own, template),
            "blend" => self.is_blend(id, own),
            "interpolation" => self.is_interpolation(own),
            _ => true,
        };
        is_step.then(|| kind.to_owned())
    }

    /// A power of a colour, by an exponent that is usual, or where nothing but the output follows.
    fn is_gamma(&self, id: NodeId, power: Option<NodeId>) -> bool {
        let is_vector = matches!(self.graph.ty(id), Type::Float(3 | 4));
        let Some(power) = power else { return is_vector && self.is_last(id, 0) };
        let Some(power) = self.graph.number_of(power) else {
            return self.lower_names(power).contains("gamma") && (is_vector || self.is_color(id));
        };
        let power = if power < 1.0 { 1.0 / power } else { power };
        let is_usual = GAMMAS.iter().any(|gamma| (power - gamma).abs() < 0.01);
        is_usual && self.is_color(id) || is_vector && ((1.3..2.7).contains(&power) || self.is_last(id, 0))
    }

    /// Whether nothing is done with a value but handing it on.
    pub(super) fn is_last(&self, id: NodeId, depth: u32) -> bool {
        const MOST: u32 = 6;
        let hands_on = |own: &NodeId| {
            let keeps = match self.graph.op(*own) {
                Op::Vector(_) | Op::Swizzle(..) | Op::Splat(_) | Op::Negate(_) => true,
                Op::Select(condition, ..) => *condition != id,
                Op::Call(Function::Min | Function::Max, x) => self.held_part(x) == Some(id),
                _ => false,
            };
            keeps && self.is_last(*own, depth + 1)
        };
        depth < MOST && self.users(id).iter().all(hands_on)
    }

    /// Whether something holds it above 0: there it is a Lambert factor, and here something else.
    fn is_clamped_elsewhere(&self, id: NodeId) -> bool {
        let negated = self.users(id).iter().copied().filter(|own| matches!(self.graph.op(*own), Op::Negate(_)));
        let not_below = |limit: &NodeId| self.graph.number_of(*limit).is_some_and(|own| own >= 0.0);
        let holds = |own: &NodeId| matches!(self.graph.op(*own), Op::Call(Function::Max, x) if x.iter().any(not_below));
        std::iter::once(id).chain(negated).any(|own| self.users(own).iter().any(holds))
    }

    fn is_lambert(&mut self, id: NodeId, own: &Match, template: &Template, way: &Way) -> bool {
        let (Some(a), Some(b)) = (self.bound(own, "n"), self.bound(own, "l")) else { return false };
        let roles = [self.named(a), self.named(b)];
        let has = |role: Role| roles.contains(&role);
        if has(Role::Half) || has(Role::Mirrored) || has(Role::Axis) && !has(Role::Normal) {
            return false;
        }
        let is_constant = |name: &str| self.bound(own, name).is_none_or(|id| self.graph.constant_of(id).is_some());
        if template.name == "lambert_scaled" && !(is_constant("share") && is_constant("floor")) {
            return false;
        }
        let (core_a, core_b) = (self.core(a).0, self.core(b).0);
        // By a highlight with the same normal: the other is its light.
        let by_mate = |n: NodeId, other: NodeId, named: Role| {
            let mates = self.mates.iter().find(|mates| mates.n == n && (mates.l == other || mates.v == other))?;
            let third = if mates.l == other { mates.v } else { mates.l };
            Some(named != Role::Eye || !self.has_dot(n, third))
        };
        let known = by_mate(core_a, core_b, roles[1]).or_else(|| by_mate(core_b, core_a, roles[0]));
        if known == Some(false) {
            return false;
        }
        let named = has(Role::Light) && has(Role::Normal);
        if template.head.is_weak {
            return (known == Some(true) || named) && way.is_factor && !self.is_clamped_elsewhere(id);
        }
        // A square in another formula is none of the cosine's own.
        if template.name == "lambert_squared" && !way.is_linear {
            return false;
        }
        if known == Some(true) {
            return true;
        }
        // A mistake is claimed of vectors alone that are what their names say.
        let is_mistake = template.head.worth == Worth::Mistake;
        if self.graph.constant_of(a).is_some() || self.graph.constant_of(b).is_some() {
            return has(Role::Normal) && !is_mistake;
        }
        let is_light = has(Role::Light) && !has(Role::Eye) && roles != [Role::Light, Role::Light];
        let is_normal = has(Role::Normal) && !has(Role::Eye) && roles != [Role::Normal, Role::Normal];
        // Of vectors of which nothing is known, unit vectors alone are taken for a normal and a light.
        let is_plain = !own.bound.iter().any(|bound| bound.by_length && self.finder.length(bound.id) != Length::One);
        named || !is_mistake && (is_light || is_normal || roles == [Role::Unknown, Role::Unknown] && is_plain)
    }

    /// The power of a cosine by what its vectors are.
    fn kind_of_lobe(&self, id: NodeId, a: NodeId, b: NodeId) -> Option<String> {
        let roles = [self.named(a), self.named(b)];
        let has = |role: Role| roles.contains(&role);
        let is_highlight = has(Role::Half) || has(Role::Mirrored);
        let text = self.names_compared(id);
        let is_cone = ["cutoff", "spot", "cone"].iter().any(|word| text.contains(word)) && !is_highlight;
        Some(
            if is_cone || has(Role::Axis) && !is_highlight {
                "spot"
            } else if has(Role::Half) {
                "blinn"
            } else if has(Role::Mirrored) {
                "phong"
            } else {
                "lobe"
            }
            .into(),
        )
    }

    /// The names of what the cosines below a value are compared with.
    fn names_compared(&self, id: NodeId) -> String {
        let mut text = String::new();
        for own in self.graph.all_of(id) {
            if !matches!(self.graph.op(own), Op::Call(Function::Dot, _)) {
                continue;
            }
            let negated = self.users(own).iter().copied().filter(|next| matches!(self.graph.op(*next), Op::Negate(_)));
            for value in std::iter::once(own).chain(negated) {
                for user in self.users(value) {
                    if matches!(self.graph.op(*user), Op::Binary(op, ..) if op.compares()) {
                        text += &self.lower_names(*user);
                    }
                }
            }
        }
        text
    }

    /// A ramp by what its variable is, and by what is done with it.
    fn kind_of_ramp(&self, id: NodeId, x: NodeId, template: &Template, way: &Way) -> Option<String> {
        let text = format!("{} {}", self.graph.text(x, 6), self.names(id)).to_lowercase();
        let mixes = self.users(id).iter().any(|own| matches!(self.graph.op(*own), Op::Call(Function::Mix, _)));
        let is_named = text.contains("fog") || self.is_of_root(id, "fog") || way.is_fog;
        let is_distance = self.finder.distance(x) > 4;
        if is_named || is_distance && mixes || mixes && ["dist", "depth", "far"].iter().any(|word| text.contains(word))
        {
            Some("fog".into())
        } else if ["falloff", "atten", "light", "range"].iter().any(|word| text.contains(word))
            && (is_distance || ["dist", "length"].iter().any(|word| text.contains(word)))
            && !template.head.is_weak
        {
            Some("attenuation".into())
        } else if ["cutoff", "spot", "cone", "angle"].iter().any(|word| text.contains(word)) && !template.head.is_weak {
            Some("spot".into())
        } else {
            None
        }
    }

    /// Whether a function that stands alone, and that gives a value, has a word in its name.
    fn is_of_root(&self, id: NodeId, word: &str) -> bool {
        self.given.get(&id).is_some_and(|name| name.contains(word))
    }

    fn is_fog_mix(&self, id: NodeId, amount: NodeId) -> bool {
        let below = self.graph.all_of(amount);
        below.iter().any(|own| self.sites.get(own).is_some_and(|site| site.kind == "fog"))
            || ["fog", "visib", "haze", "mist"].iter().any(|word| self.lower_names(id).contains(word))
            || below.iter().any(|own| {
                matches!(self.graph.op(*own), Op::Call(Function::Exp, _))
                    && self.graph.all_of(*own).iter().any(|inner| self.finder.distance(*inner) > 4)
            })
    }

    /// Whether a value is a colour: a vector, or a scalar that is made one.
    fn is_color(&self, id: NodeId) -> bool {
        let ty = self.graph.ty(id);
        let text = self.lower_names(id);
        matches!(ty, Type::Float(3 | 4))
            || ["color", "colour", "col", "rgb", "tex", "lum", "gamma"].iter().any(|word| text.contains(word))
            || self.users(id).iter().any(|own| matches!(self.graph.op(*own), Op::Vector(_)))
    }

    fn is_decoded(&mut self, id: NodeId) -> bool {
        let (bare, _) = self.graph.without_sign(id);
        let inner = if let Op::Call(Function::Normalize, of) = self.graph.op(bare) { of[0] } else { bare };
        let decodes = |own: NodeId, review: &mut Self| {
            review.finder.best(own).is_some_and(|found| review.finder.template(&found).head.kind == "decode-normal")
        };
        decodes(bare, self) || decodes(inner, self)
    }

    fn is_attenuation(&self, id: NodeId, own: &Match, template: &Template) -> bool {
        let is_divisor = template.head.kind == "divisor";
        let divides = |user: &NodeId| matches!(self.graph.op(*user), Op::Binary(Binary::Divide, _, b) if *b == id);
        let is_divided = self.users(id).iter().any(divides);
        if is_divisor && template.head.is_weak && !is_divided {
            return false;
        }
        let offset = self.bound(own, "offset");
        let Some(d) = self.bound(own, "d").or(offset) else { return true };
        let text = format!("{} {}", self.graph.text(d, 6), self.names(id)).to_lowercase();
        let has = |all: &[&str]| all.iter().any(|word| text.contains(word));
        let of_light = has(&["light", "lamp", "atten", "falloff"]);
        if offset.is_some() {
            return of_light || has(&["dist", "radius"]) || self.named(d) == Role::Light;
        }
        let is_length = matches!(self.graph.op(d), Op::Call(Function::Length, _)) || has(&["dist"]);
        if is_divisor || template.head.is_weak {
            return is_length && (of_light || !template.head.is_weak || has(&["dist"]));
        }
        is_length || of_light || has(&["radius", "range"])
    }

    fn is_spot(&self, id: NodeId, own: &Match, template: &Template) -> bool {
        let (Some(l), Some(axis)) = (self.bound(own, "l"), self.bound(own, "axis")) else { return true };
        if self.is_normal(l) || self.is_normal(axis) {
            return false;
        }
        let text = self.lower_names(id);
        let is_cone =
            ["cutoff", "spot", "cone", "limit", "angle", "inner", "outer"].iter().any(|word| text.contains(word));
        let has_axis = [l, axis].iter().any(|own| self.named(*own) == Role::Axis);
        if template.head.is_weak {
            let cut = self.bound(own, "cut");
            let is_named = ["cutoff", "spot", "cone"].iter().any(|word| text.contains(word));
            return (is_named || has_axis) && cut.is_none_or(|cut| !self.graph.is_number(cut, 0.0));
        }
        let mirrored = [l, axis].iter().any(|own| matches!(self.named(*own), Role::Half | Role::Mirrored));
        !mirrored && (is_cone || has_axis || text.contains("light"))
    }

    /// A rim's power has to be of a normal's cosine.
    fn is_fresnel(&self, id: NodeId, own: &Match, template: &Template) -> bool {
        let (Some(a), Some(b)) = (self.bound(own, "a"), self.bound(own, "b")) else {
            let text = self.lower_names(id);
            return template.name != "rim" || text.contains("norm");
        };
        let is_constant =
            template.name == "rim" && self.bound(own, "exponent").is_some_and(|e| self.graph.is_number(e, 2.0));
        !is_constant && (self.is_normal(a) || self.is_normal(b) || template.name != "rim")
    }

    /// Modes mix two colours.
    fn is_blend(&self, id: NodeId, own: &Match) -> bool {
        let (Some(a), Some(b)) = (self.bound(own, "color"), self.bound(own, "other")) else { return false };
        let text = self.lower_names(id);
        let words: &[&str] = match &*self.finder.template(own).name {
            // Light is added to light everywhere.
            name if name.starts_with("linear_dodge") => &["blend"],
            _ => &["blend", "base", "src", "dst", "color", "tex", "col"],
        };
        let is_named = words.iter().any(|word| text.contains(word));
        let is_given = |own: NodeId| self.graph.constant_of(own).is_none();
        let is_mode = self.graph.ty(id) != Type::Float(1) || text.contains("blend");
        is_named && is_given(a) && is_given(b) && is_mode
    }

    fn is_interpolation(&self, own: &Match) -> bool {
        let Some(weights) = self.bound(own, "weights") else { return false };
        let text = self.lower_names(weights);
        ["bary", "weight", "uvw", "lambda"].iter().any(|word| text.contains(word))
    }
}
