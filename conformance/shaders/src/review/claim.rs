//! What is to be said of each step: its verdict by where it is used, which way its vectors point, and how long they are.

use super::Review;
use super::direction::Direction;
use super::role::Role;
use super::site::{Site, Way};
use crate::graph::{Binary, Function, NodeId, Op, Origin};
use crate::templates::Worth;
use crate::unify::{Bound, Class, Length, Template};
use lightmeter_document::report::{ShaderStep, StepFunction, StepParameter, StepVerdict};
use std::collections::HashMap;

/// Operations of a step that is made a function.
const MOST_OPERATIONS: usize = 100;
/// How deep a step's code is shown.
const DEPTH: u32 = 6;

/// The signs with which Lambert factors take a normal and a light.
type Signs = HashMap<(NodeId, NodeId), Vec<bool>>;

/// A claim that is being made.
struct Claim {
    verdict: StepVerdict,
    name: String,
    sentence: String,
}

impl Claim {
    fn set(&mut self, verdict: StepVerdict, name: &str, more: &str) {
        self.verdict = verdict;
        self.name = name.into();
        self.sentence += more;
    }
}

impl Review<'_> {
    pub(super) fn claim_all(&mut self) {
        let sites: Vec<Site> = self.sites.values().cloned().collect();
        let mut signs = Signs::new();
        for site in &sites {
            let template = self.finder.template(&site.matched);
            if template.head.kind == "lambert" {
                let (n, l) = self.normal_and_light(site, template);
                let key = (self.core(n.id).0, self.core(l.id).0);
                signs.entry(key).or_default().push(sign_of(site, template, &n, &l));
            }
        }
        for site in &sites {
            self.claim(site, &signs);
        }
    }

    /// Which of a Lambert factor's two vectors is the normal, and which the light's.
    fn normal_and_light(&self, site: &Site, template: &Template) -> (Bound, Bound) {
        let of = |name: &str| {
            let slot = template.parameters.iter().position(|own| own.0 == name).unwrap_or(0);
            site.matched.bound[slot]
        };
        let (n, l) = (of("n"), of("l"));
        let known = [n, l].map(|own| self.normals.contains(&self.core(own.id).0));
        let named = [n, l].map(|own| self.named(own.id));
        let by_names =
            named[1] == Role::Normal && named[0] != Role::Normal || named[0] == Role::Light && named[1] != Role::Light;
        let is_turned = known == [false, true] || known[0] == known[1] && by_names;
        if is_turned { (l, n) } else { (n, l) }
    }

    fn claim(&mut self, site: &Site, signs: &Signs) {
        let template = self.finder.template(&site.matched);
        let head = &template.head;
        let mut claim = Claim { verdict: head.worth.into(), name: head.name.clone(), sentence: head.sentence.clone() };
        if !head.source.is_empty() {
            claim.sentence += &format!(" ({})", head.source);
        }
        if !site.matched.is_exact {
            claim.sentence += "; a constant is rounded";
        }
        match &*head.kind {
            "lambert" => self.claim_lambert(site, template, signs, &mut claim),
            "phong" | "blinn" => self.claim_highlight(site, template, signs, &mut claim),
            "lobe" if matches!(&*site.kind, "phong" | "blinn") => {
                let normal = ["a", "b"]
                    .into_iter()
                    .find_map(|name| Self::of(site, template, name).copied().filter(|own| self.is_normal(own.id)));
                if claim.verdict == StepVerdict::Right && normal.is_some_and(|n| self.is_gated(site, &n, true)) {
                    claim.set(StepVerdict::Dialect, "gated", ", within a branch on n·l");
                }
            }
            "ramp" => self.claim_ramp(site, template, &mut claim),
            "divisor" => self.claim_divisor(site, &mut claim),
            "gamma" => self.claim_gamma(site, template, &mut claim),
            "mix" => self.claim_mix(site, template, &mut claim),
            "spot" => self.claim_spot(site, template, &mut claim),
            _ => {}
        }
        if head.name == "unguarded" {
            self.claim_unguarded(site, &mut claim);
        }
        // The way from the light is the sum of two vectors too.
        let is_cone = site.kind == "spot" && matches!(&*head.kind, "phong" | "blinn");
        if is_cone {
            claim.sentence = "the spotlight's cone with an exponent".into();
        }
        if site.kind == "fog" {
            self.claim_distance(site, template, &mut claim);
        }
        if !is_cone {
            self.claim_lengths(site, template, &mut claim);
        }
        let line = self.line_of(site.id);
        let also = self.lines_of(site.id).into_iter().filter(|own| *own != line).collect();
        let kind = if site.kind == "divisor" { "attenuation".into() } else { site.kind.clone() };
        let code = self.code(site.id);
        // A cone that is made like a highlight is none.
        let function = if is_cone { None } else { self.function(site, template, &claim) };
        self.say(ShaderStep {
            line,
            also,
            kind,
            verdict: claim.verdict,
            name: claim.name,
            sentence: claim.sentence,
            accepted: false,
            code,
            function,
            judged: None,
        });
    }

    /// A step as a function of its form's parameters, where the form says what it is.
    fn function(&self, site: &Site, template: &Template, claim: &Claim) -> Option<StepFunction> {
        let is_of_form = StepVerdict::from(template.head.worth) == claim.verdict
            || template.head.worth == Worth::Mistake && claim.verdict == StepVerdict::Perhaps;
        // What is a claim only by how it is used shows nothing by itself.
        let is_by_use = template.head.worth == Worth::Mistake && template.head.is_weak;
        if !is_of_form || claim.name != template.head.name || is_by_use || !self.graph.ty(site.id).is_float() {
            return None;
        }
        let ids: Vec<NodeId> = site.matched.bound.iter().map(|own| own.id).collect();
        let cone = self.graph.cone(site.id, &ids, MOST_OPERATIONS)?;
        let (mut cut, mut parameters): (Vec<(NodeId, String)>, Vec<StepParameter>) = (vec![], vec![]);
        for ((name, class), bound) in template.parameters.iter().zip(&site.matched.bound) {
            let constant = self.graph.constant_of(bound.id);
            if constant.is_none() {
                // What the step normalises itself is a unit vector behind that.
                let unit = if *class == Class::Unit { self.normalized(bound.id, &cone) } else { None };
                let id = unit.unwrap_or(bound.id);
                // One value may be two of the form's, which then is another function.
                if cut.iter().any(|own| own.0 == id) {
                    return None;
                }
                cut.push((id, name.clone()));
            }
            #[expect(clippy::cast_possible_truncation, reason = "shaders compute in f32")]
            let bits = constant.iter().flat_map(|own| own.components().to_vec()).map(|own| (own as f32).to_bits());
            let (bits, is_negated) = (bits.collect(), bound.is_negated);
            parameters.push(StepParameter { name: name.clone(), is_negated, bits });
        }
        let wgsl = self.graph.wgsl(site.id, &cut, MOST_OPERATIONS)?;
        Some(StepFunction { form: template.name.clone(), wgsl, parameters })
    }

    /// A vector of length 1 that is all that a cone has of a vector.
    fn normalized(&self, id: NodeId, cone: &[NodeId]) -> Option<NodeId> {
        let mut users = self.users(id).iter().filter(|own| cone.contains(own));
        let only = users.next().filter(|_| users.next().is_none())?;
        matches!(self.graph.op(*only), Op::Call(Function::Normalize, _)).then_some(*only)
    }

    pub(super) fn code(&self, id: NodeId) -> String {
        let text = self.graph.text(id, DEPTH);
        let text = text
            .strip_prefix('(')
            .and_then(|own| own.strip_suffix(')'))
            .filter(|own| is_balanced(own))
            .unwrap_or(&text);
        crate::read::shown(text)
    }

    fn of<'b>(site: &'b Site, template: &Template, name: &str) -> Option<&'b Bound> {
        template.parameters.iter().position(|own| own.0 == name).map(|slot| &site.matched.bound[slot])
    }

    fn claim_lambert(&mut self, site: &Site, template: &Template, signs: &Signs, claim: &mut Claim) {
        let (n, l) = self.normal_and_light(site, template);
        // What keeps it from 0 alone is no ambient light.
        const LEAST: f64 = 0.01;
        let floor = Self::of(site, template, "floor").and_then(|own| self.graph.number_of(own.id));
        if claim.name == "ambient-as-floor" && floor.is_some_and(|floor| floor > 0.0 && floor <= LEAST) {
            claim.set(StepVerdict::Right, "", ", which keeps it from 0 alone");
        }
        let own = sign_of(site, template, &n, &l);
        if template.head.is_weak {
            let own = self.conditions_of(site);
            let is_held = |way: &Way| {
                let conditions = [&*way.conditions, &*own].concat();
                way.held.0 && !way.is_negated || self.is_held_positive(site.id, way.is_negated, &conditions)
            };
            // Where it is no factor, it is no Lambert factor.
            if site.ways.iter().filter(|way| way.is_factor).all(is_held) {
                claim.verdict = StepVerdict::Right;
                claim.name = String::new();
                claim.sentence = "Lambert's cosine n·l, used where it is above 0".into();
            }
        }
        // What a vertex shader hands on may be held above 0 behind it.
        if claim.name == "not-clamped"
            && claim.verdict == StepVerdict::Mistake
            && self.is_vertex
            && self.is_last(site.id, 0)
        {
            claim.set(StepVerdict::Perhaps, "not-clamped", "; it is handed on as it is");
        }
        let all = signs.get(&(self.core(n.id).0, self.core(l.id).0));
        let agree = all.is_none_or(|all| all.iter().all(|other| *other == own));
        // Which side the difference of two places or a cross product points to, nobody knows.
        let is_sided = !matches!(
            self.graph.op(self.core(n.id).0),
            Op::Binary(Binary::Subtract, ..) | Op::Call(Function::Cross, _)
        );
        if let Some(direction) = self.direction(l.id).filter(|_| agree && is_sided) {
            // Both sides of a thin thing may be lit.
            let both = matches!(&*template.head.name, "incidence-of-both-sides");
            // The core's direction counts its sign already: the bound value's own sign does not come again.
            if direction.is_toward == own && !both {
                let verdict = if direction.is_certain { StepVerdict::Mistake } else { StepVerdict::Perhaps };
                claim.set(verdict, "light-reversed", "; the light's vector points from the light to the surface");
            }
        }
    }

    fn claim_highlight(&mut self, site: &Site, template: &Template, signs: &Signs, claim: &mut Claim) {
        let of = |name: &str| Self::of(site, template, name).copied();
        if let Some(n) = of("n")
            && claim.verdict == StepVerdict::Right
            && self.is_gated(site, &n, false)
        {
            claim.set(StepVerdict::Dialect, "gated", ", within a branch on n·l");
        }
        if let Some(e) = of("exponent")
            && let Op::Binary(Binary::Multiply, a, b) = *self.graph.op(e.id)
            && let Some(k) = self.graph.number_of(a).or(self.graph.number_of(b))
        {
            claim.sentence += &format!("; the exponent is scaled by {k}");
        }
        let is_seen_along = claim.name == "viewer-at-infinity" && of("v").is_none();
        if is_seen_along && of("l").is_some_and(|own| self.named(own.id) == Role::Eye) {
            claim.set(StepVerdict::Right, "", "; it is the light that shines along a fixed direction");
        }
        let (Some(n), Some(a), Some(b)) = (of("n"), of("l"), of("v")) else { return };
        let core = self.core(n.id).0;
        let lambert = |own: &Bound| signs.get(&(core, self.core(own.id).0)).cloned();
        let by_names = self.named(a.id) == Role::Eye && self.named(b.id) != Role::Eye
            || self.named(b.id) == Role::Light && self.named(a.id) != Role::Light;
        let is_turned = match (lambert(&a), lambert(&b)) {
            (Some(_), None) => false,
            (None, Some(_)) => true,
            _ => by_names,
        };
        let (l, v) = if is_turned { (b, a) } else { (a, b) };
        if self.graph.constant_of(v.id).is_some() && claim.verdict != StepVerdict::Mistake {
            claim.set(StepVerdict::Dialect, "viewer-at-infinity", ", seen along a fixed direction");
            return;
        }
        self.claim_directions(template, &l, &v, &lambert(&l).unwrap_or_default(), claim);
    }

    fn claim_directions(&mut self, template: &Template, l: &Bound, v: &Bound, signs: &[bool], claim: &mut Claim) {
        // A Lambert factor with the light's vector tells which way that points.
        let by_lambert = signs.first().map(|is_negated| Direction { is_toward: !is_negated, is_certain: true });
        let Some(light) = self.direction(l.id).or(by_lambert) else { return };
        let Some(eye) = self.direction(v.id) else {
            // Blinn's half vector tells the two apart without the eye's direction.
            let differs = !signs.is_empty() && !signs.contains(&l.is_negated);
            if template.head.kind == "blinn" && differs && !v.is_negated {
                claim.set(
                    StepVerdict::Mistake,
                    "light-reversed",
                    "; the light's vector points the other way than in the Lambert factor",
                );
            }
            return;
        };
        let (to_light, to_eye) = (light.is_toward != l.is_negated, eye.is_toward != v.is_negated);
        if to_light == to_eye {
            return;
        }
        let verdict = if light.is_certain && eye.is_certain { StepVerdict::Mistake } else { StepVerdict::Perhaps };
        if signs.contains(&l.is_negated) || signs.is_empty() || template.head.kind == "phong" {
            claim.set(verdict, "view-reversed", "; the eye's vector points away from the eye");
        } else {
            claim.set(
                verdict,
                "light-reversed",
                "; the light's vector points the other way than in the Lambert factor",
            );
        }
    }

    /// A cone's axis points away from the light, and the light's vector towards it.
    fn claim_spot(&mut self, site: &Site, template: &Template, claim: &mut Claim) {
        let (Some(l), Some(axis)) = (Self::of(site, template, "l"), Self::of(site, template, "axis")) else { return };
        if claim.name == "not-clamped" && self.is_compared(site) {
            claim.verdict = StepVerdict::Dialect;
            claim.name = "ramp".into();
            claim.sentence =
                "the spotlight's edge as a straight ramp of cosines, held within its limits by branches".into();
        }
        // Which of the two is the axis, names say.
        let is_turned = self.named(l.id) == Role::Axis && self.named(axis.id) != Role::Axis;
        let (l, axis) = if is_turned { (axis, l) } else { (l, axis) };
        let is_plain = |own: &Bound| matches!(self.graph.op(self.core(own.id).0), Op::Leaf(_) | Op::Swizzle(..));
        let name = self.lower_names(l.id);
        let by_name = (name == "l" || name == "tolight").then_some(true);
        let toward = self.direction(l.id).map(|own| own.is_toward).or(by_name);
        if toward.is_some_and(|is_toward| is_toward == (l.is_negated != axis.is_negated))
            && is_plain(axis)
            && self.named(axis.id) == Role::Axis
        {
            claim.set(StepVerdict::Perhaps, "spot-backwards", "; the axis and the vector to the light point the same way: the cone opens away from what it should light");
        }
    }

    /// Whether a step stands in a branch on its own cosine.
    fn is_compared(&self, site: &Site) -> bool {
        let below = self.graph.all_of(site.id);
        let cosines: Vec<NodeId> =
            below.into_iter().filter(|own| matches!(self.graph.op(*own), Op::Call(Function::Dot, _))).collect();
        self.conditions_of(site)
            .iter()
            .any(|(condition, _)| self.graph.all_of(*condition).iter().any(|own| cosines.contains(own)))
    }

    /// Whether a highlight stands in a branch on the cosine of its normal and another vector of it.
    /// Where the highlight's light is not known, any other vector.
    fn is_gated(&self, site: &Site, n: &Bound, by_any: bool) -> bool {
        let normal = self.core(n.id).0;
        let others: Vec<NodeId> =
            site.matched.bound.iter().map(|own| self.core(own.id).0).filter(|own| *own != normal).collect();
        self.conditions_of(site).iter().any(|(condition, _)| {
            self.graph.all_of(*condition).iter().any(|own| match self.graph.op(*own) {
                Op::Call(Function::Dot, x) => {
                    let (a, b) = (self.core(x[0]).0, self.core(x[1]).0);
                    let is_other = |own: &NodeId| others.contains(own) != by_any;
                    a == normal && is_other(&b) || b == normal && is_other(&a)
                }
                _ => false,
            })
        })
    }

    /// A power whose base a branch holds above 0 needs no guard.
    fn claim_unguarded(&mut self, site: &Site, claim: &mut Claim) {
        let power = self.graph.all_of(site.id).into_iter().rev().find_map(|own| match self.graph.op(own) {
            Op::Call(Function::Pow, x) => Some(x[0]),
            _ => None,
        });
        let Some(base) = power else { return };
        let (bare, is_negated) = self.graph.without_sign(base);
        let conditions = self.conditions_of(site);
        let is_in_cone = site.kind == "spot"
            && conditions.iter().any(|(condition, _)| self.graph.all_of(*condition).contains(&bare));
        if is_in_cone || self.is_held_positive(bare, is_negated, &conditions) {
            claim.verdict = StepVerdict::Right;
            claim.name = "by-a-branch".into();
            claim.sentence = claim
                .sentence
                .replace(", the power of a cosine that may be negative", ", used where its cosine is above 0");
        }
    }

    fn claim_ramp(&mut self, site: &Site, template: &Template, claim: &mut Claim) {
        if template.head.worth == Worth::Mistake && site.ways.iter().all(|way| way.held == (true, true)) {
            claim.verdict = StepVerdict::Right;
            claim.name = String::new();
            claim.sentence = claim.sentence.replace(", not held within 0 and 1", ", held within 0 and 1 afterwards");
        }
        if site.kind == "spot" && claim.verdict == StepVerdict::Right {
            claim.verdict = StepVerdict::Dialect;
            claim.name = "ramp".into();
        }
    }

    /// A divisor divides.
    fn claim_divisor(&mut self, site: &Site, claim: &mut Claim) {
        let users = self.users(site.id);
        let divides =
            users.iter().any(|own| matches!(self.graph.op(*own), Op::Binary(Binary::Divide, _, b) if *b == site.id));
        let multiplies = users.iter().any(|own| matches!(self.graph.op(*own), Op::Binary(Binary::Multiply, ..)));
        if multiplies && !divides {
            claim.set(StepVerdict::Mistake, "multiplied-for-divided", "; it multiplies where it is to divide");
        }
    }

    fn claim_gamma(&mut self, site: &Site, template: &Template, claim: &mut Claim) {
        let given = Self::of(site, template, "power").map(|own| own.id);
        let power = given.map_or(Some(0.5), |own| self.graph.number_of(own));
        let is_reciprocal = given.is_some_and(
            |own| matches!(self.graph.op(own), Op::Binary(Binary::Divide, one, _) if self.graph.is_number(*one, 1.0)),
        );
        let encodes = power.map_or(is_reciprocal, |power| power < 1.0);
        let (name, what) = if encodes { ("encode", "encoding") } else { ("decode", "decoding") };
        claim.name = name.into();
        claim.sentence = match power {
            Some(power) => format!("a power of {power:.4}: gamma {what}, near sRGB's curve, which it is not"),
            None => format!("a power that is given: gamma {what}"),
        };
    }

    /// By what distance fog is.
    fn claim_distance(&mut self, site: &Site, template: &Template, claim: &mut Claim) {
        let Some(d) = Self::of(site, template, "d").or_else(|| Self::of(site, template, "x")) else { return };
        let text = self.graph.text(d.id, 3);
        let what = match self.graph.op(d.id) {
            Op::Call(Function::Length, _) => "the distance itself",
            Op::Call(Function::Abs, _) => "the depth |z|",
            _ if text.contains("gl_FragCoord.z") && !text.contains("gl_FragCoord.w") => {
                let line = self.line_of(site.id);
                let sentence = "fog by gl_FragCoord.z, which is no distance".into();
                let (kind, name, code) = ("fog-distance".into(), "window-depth".into(), text.clone());
                self.say(ShaderStep {
                    line,
                    also: vec![],
                    kind,
                    verdict: StepVerdict::Mistake,
                    name,
                    sentence,
                    accepted: false,
                    code,
                    function: None,
                    judged: None,
                });
                return;
            }
            _ => return,
        };
        claim.sentence += &format!("; by {what}");
    }

    fn claim_mix(&mut self, site: &Site, template: &Template, claim: &mut Claim) {
        let (Some(a), Some(b), Some(amount)) =
            (Self::of(site, template, "color"), Self::of(site, template, "other"), Self::of(site, template, "amount"))
        else {
            return;
        };
        let is_fog = |id: NodeId| self.lower_names(id).contains("fog") && self.graph.leaves_of(id).len() <= 2;
        let wanted = match (is_fog(a.id), is_fog(b.id)) {
            (false, true) => true,
            (true, false) => false,
            _ => return,
        };
        if self.is_amount(amount.id).is_some_and(|given| given != wanted) {
            claim.set(StepVerdict::Mistake, "fog-mixed-the-wrong-way", "; fog and surface are exchanged");
        }
    }

    /// Whether a factor is the amount of fog, and not what is left of the surface; none if nothing says it.
    fn is_amount(&self, factor: NodeId) -> Option<bool> {
        let fog = self
            .graph
            .all_of(factor)
            .into_iter()
            .find(|own| self.sites.get(own).is_some_and(|site| site.kind == "fog"))?;
        let site = &self.sites[&fog];
        let template = self.finder.template(&site.matched);
        let own = if template.head.kind == "ramp" {
            let text =
                |name: &str| Self::of(site, template, name).map(|own| self.lower_names(own.id)).unwrap_or_default();
            let (from, to) = (text("start"), text("to"));
            let is_late = |text: &str| ["end", "max", "far"].iter().any(|word| text.contains(word));
            let is_early = |text: &str| ["start", "min", "near"].iter().any(|word| text.contains(word));
            if is_early(&from) && is_late(&to) {
                !template.head.falls
            } else if is_late(&from) && is_early(&to) {
                template.head.falls
            } else {
                return None;
            }
        } else {
            template.head.name.ends_with("amount") || template.name.ends_with("amount")
        };
        // Between the two it may be turned.
        let (mut at, mut is_turned) = (factor, false);
        while at != fog {
            at = match self.graph.op(at) {
                Op::Binary(Binary::Subtract, one, inner) if self.graph.is_number(*one, 1.0) => {
                    is_turned = !is_turned;
                    *inner
                }
                Op::Call(Function::Min | Function::Max, x) => self.held_part(x)?,
                _ => return None,
            };
        }
        Some(own != is_turned)
    }

    /// Vectors that are taken to be of length 1, and are not.
    fn claim_lengths(&mut self, site: &Site, template: &Template, claim: &mut Claim) {
        for (slot, bound) in site.matched.bound.iter().enumerate() {
            let (name, class) = &template.parameters[slot];
            if *class != Class::Unit || !bound.by_length || self.finder.length(bound.id) == Length::One {
                continue;
            }
            let role = self.role_of(site, template, name, bound);
            let (what, id) = match role {
                Role::Normal => ("normal", "normal-not-normalised"),
                Role::Axis => ("axis", "axis-not-normalised"),
                Role::Half => ("half vector", "half-vector-not-normalised"),
                Role::Eye => ("eye's vector", "eye-not-normalised"),
                _ => ("light's vector", "light-not-normalised"),
            };
            let code = self.graph.text(bound.id, 3);
            let from = match self.origin_of(bound.id) {
                Some(Origin::Input) if self.is_vertex => Some("host"),
                Some(Origin::Input) => None,
                Some(Origin::Parameter) => Some("caller"),
                Some(Origin::Uniform) => Some("host"),
                Some(Origin::Texture) => Some("texture"),
                Some(_) => continue,
                None => None,
            };
            if let Some(whose) = from {
                claim.sentence += &format!("; that the {what} is of length 1 is left to the {whose}");
                continue;
            }
            let is_interpolated = self.origin_of(bound.id).is_some();
            let is_transformed = matches!(self.graph.op(bound.id), Op::MatrixVector(..) | Op::VectorMatrix(..));
            // What moves an axis or a light is a rotation by habit.
            let is_certain = is_interpolated || is_transformed == (role == Role::Normal);
            // What a texture filters is left as it is by many.
            let is_filtered = role == Role::Normal && self.is_of_texture(bound.id);
            let verdict = if is_certain && !is_filtered { StepVerdict::Mistake } else { StepVerdict::Perhaps };
            let sentence = if is_interpolated {
                format!("the {what} comes interpolated, and is not normalised")
            } else {
                format!("the {what} is not normalised")
            };
            let line = self.line_of(site.id);
            let also = self.lines_of(site.id).into_iter().filter(|own| *own != line).collect();
            let is_known = self.steps.iter().any(|own| own.kind == "length" && own.name == id && own.code == code);
            if !is_known {
                self.say(ShaderStep {
                    line,
                    also,
                    kind: "length".into(),
                    verdict,
                    name: id.into(),
                    sentence,
                    accepted: false,
                    code,
                    function: None,
                    judged: None,
                });
            }
        }
    }

    fn is_of_texture(&self, id: NodeId) -> bool {
        let leaves = self.graph.leaves_of(id);
        leaves.iter().any(|own| self.graph.leaf_of(*own).is_some_and(|leaf| leaf.origin == Origin::Texture))
    }

    fn role_of(&self, site: &Site, template: &Template, name: &str, bound: &Bound) -> Role {
        let named = self.named(bound.id);
        match &*template.head.kind {
            "lambert" => {
                if self.normal_and_light(site, template).0.id == bound.id {
                    Role::Normal
                } else {
                    Role::Light
                }
            }
            "lobe" | "schlick" if self.normals.contains(&bound.id) => Role::Normal,
            "lobe" | "schlick" => named,
            _ if name == "n" => Role::Normal,
            _ if name == "axis" => Role::Axis,
            _ if matches!(named, Role::Eye | Role::Axis) => named,
            _ => Role::Light,
        }
    }

    /// Where a vector comes from that no operation made; none if one did.
    fn origin_of(&mut self, id: NodeId) -> Option<Origin> {
        match *self.graph.op(id) {
            Op::Negate(inner) => self.origin_of(inner),
            Op::Swizzle(of, _) => self.graph.leaf_of(of).map(|leaf| leaf.origin),
            Op::Select(_, a, b) => {
                let is_fine = |own: NodeId, review: &mut Self| {
                    review.finder.length(own) == Length::One || review.graph.constant_of(own).is_some()
                };
                match (is_fine(a, self), is_fine(b, self)) {
                    (true, _) => self.origin_of(b),
                    (_, true) => self.origin_of(a),
                    _ => match (self.origin_of(a), self.origin_of(b)) {
                        (Some(Origin::Input), _) | (_, Some(Origin::Input)) => Some(Origin::Input),
                        (a, b) => a.and(b),
                    },
                }
            }
            Op::Call(Function::FaceForward, ref of) => self.origin_of(of[0]),
            _ => self.graph.leaf_of(id).map(|leaf| leaf.origin),
        }
    }
}

/// Whether a Lambert factor takes one of its vectors with the other sign.
fn sign_of(site: &Site, template: &Template, n: &Bound, l: &Bound) -> bool {
    let by_way = template.head.is_weak && site.ways.iter().any(|way| way.is_negated);
    (n.is_negated != l.is_negated) != by_way
}

fn is_balanced(text: &str) -> bool {
    let mut depth = 0;
    text.chars().all(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth >= 0
    })
}
