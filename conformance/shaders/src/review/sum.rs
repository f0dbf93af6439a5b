//! What multiplies what: an output as a sum of products of steps.

use super::Review;
use super::site::Site;
use crate::graph::{Binary, Function, NodeId, Op, Origin, Type};
use crate::lower::Root;
use lightmeter_document::report::{ShaderStep, ShaderSum, StepVerdict};
use std::collections::HashSet;

/// Terms of a sum that are told apart.
const MOST_TERMS: usize = 60;
/// Terms that are shown.
const MOST_SHOWN: usize = 12;
/// Operations within each other that are looked into.
const MOST_DEPTH: u32 = 40;

/// A factor of a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Factor {
    Step(NodeId),
    Over(NodeId),
    Other(NodeId),
    /// 1 less it.
    Rest(NodeId),
    Where(NodeId, bool),
    Minus,
}

type Term = Vec<Factor>;

/// What is said of terms: verdict, name, sentence.
type Said = (StepVerdict, &'static str, &'static str);

impl Review<'_> {
    fn expand(&self, id: NodeId, mut factors: Term, found: &mut Vec<Term>, depth: u32) {
        let graph = self.graph;
        let with = |factors: &Term, own: Factor| [&**factors, &[own]].concat();
        if found.len() > MOST_TERMS || depth > MOST_DEPTH {
            found.push(with(&factors, Factor::Other(id)));
            return;
        }
        if let Some(site) = self.sites.get(&id) {
            factors.push(Factor::Step(id));
            if !self.finder.template(&site.matched).head.is_transparent {
                found.push(factors);
                return;
            }
        }
        match graph.op(id).clone() {
            Op::Binary(Binary::Add, a, b) => {
                self.expand(a, factors.clone(), found, depth + 1);
                self.expand(b, factors, found, depth + 1);
            }
            Op::Binary(Binary::Subtract, a, b) => {
                self.expand(a, factors.clone(), found, depth + 1);
                self.expand(b, with(&factors, Factor::Minus), found, depth + 1);
            }
            Op::Negate(a) => self.expand(a, with(&factors, Factor::Minus), found, depth + 1),
            Op::Binary(Binary::Multiply, a, b) => {
                let (mut left, mut right) = (vec![], vec![]);
                self.expand(a, vec![], &mut left, depth + 1);
                self.expand(b, vec![], &mut right, depth + 1);
                for own in &left {
                    found.extend(right.iter().take(MOST_TERMS).map(|other| [&*factors, own, other].concat()));
                }
            }
            Op::Binary(Binary::Divide, a, b) => {
                let divisor = if let Op::Splat(inner) = graph.op(b) { *inner } else { b };
                self.expand(a, with(&factors, Factor::Over(divisor)), found, depth + 1);
            }
            Op::Splat(a) => self.expand(a, factors, found, depth + 1),
            Op::Call(Function::Min | Function::Max, x) if self.held_part(&x).is_some() => {
                let inner = self.held_part(&x).unwrap_or(id);
                self.expand(inner, factors, found, depth + 1);
            }
            Op::Call(Function::Mix, x) => {
                self.expand(x[0], with(&factors, Factor::Rest(x[2])), found, depth + 1);
                self.expand(x[1], with(&factors, Factor::Other(x[2])), found, depth + 1);
            }
            Op::Select(condition, yes, no) => {
                for (own, holds) in [(yes, true), (no, false)] {
                    if !graph.is_number(own, 0.0) {
                        self.expand(own, with(&factors, Factor::Where(condition, holds)), found, depth + 1);
                    }
                }
            }
            Op::Constant(_) if graph.is_number(id, 0.0) => {}
            Op::Constant(_) if graph.is_number(id, 1.0) => found.push(factors),
            Op::Vector(parts) if graph.ty(parts[0]).length() == 3 => self.expand(parts[0], factors, found, depth + 1),
            _ => found.push(with(&factors, Factor::Other(id))),
        }
    }

    fn kind_of(&self, factor: &Factor) -> Option<&str> {
        match factor {
            Factor::Step(id) | Factor::Over(id) => self.sites.get(id).map(|site| &*site.kind),
            _ => None,
        }
    }

    fn has(&self, term: &Term, kinds: &[&str]) -> bool {
        term.iter().any(|factor| self.kind_of(factor).is_some_and(|kind| kinds.contains(&kind)))
    }

    fn factor_text(&self, factor: &Factor) -> String {
        let step = |id: &NodeId| {
            self.sites.get(id).map_or_else(|| crate::read::shown(&self.graph.text(*id, 3)), |site| site.kind.clone())
        };
        match factor {
            Factor::Step(id) | Factor::Other(id) => step(id),
            Factor::Over(id) => format!("1/{}", step(id)),
            Factor::Rest(id) => format!("(1 - {})", step(id)),
            Factor::Where(id, true) => format!("[{}]", self.graph.text(*id, 2)),
            Factor::Where(id, false) => format!("[not {}]", self.graph.text(*id, 2)),
            Factor::Minus => "-1".into(),
        }
    }

    /// Whether a colour is decoded: that is done with what comes in.
    fn decodes(&self, site: &Site) -> bool {
        let template = self.finder.template(&site.matched);
        let power = template.parameters.iter().zip(&site.matched.bound).find(|(own, _)| own.0 == "power");
        let is_above_one = power.is_some_and(|(_, own)| self.graph.number_of(own.id).is_some_and(|own| own > 1.0));
        template.head.name == "decode" || is_above_one
    }

    /// What is done with a sum, from the output inwards, and the sum.
    fn peeled(&self, value: NodeId) -> (NodeId, Vec<NodeId>) {
        let (mut own, mut through) = (value, vec![]);
        loop {
            let next = match self.sites.get(&own) {
                Some(site) if matches!(&*site.kind, "gamma" | "tone" | "srgb" | "fog-mix") && !self.decodes(site) => {
                    through.push(own);
                    let template = self.finder.template(&site.matched);
                    let colors = template.parameters.iter().zip(&site.matched.bound);
                    let colors = colors
                        .filter(|(parameter, _)| matches!(&*parameter.0, "color" | "other"))
                        .map(|(_, own)| own.id);
                    colors.max_by_key(|id| self.graph.all_of(*id).len())
                }
                Some(_) => None,
                None => match self.graph.op(own) {
                    Op::Vector(parts) if self.graph.ty(parts[0]).length() == 3 => Some(parts[0]),
                    Op::Swizzle(of, pattern) if pattern.len() == 3 => Some(*of),
                    _ => None,
                },
            };
            match next {
                Some(next) => own = next,
                None => return (own, through),
            }
        }
    }

    /// What an output is made of, and what is wrong with how.
    pub(super) fn combination(&mut self, output: &str, value: NodeId) {
        if !matches!(self.graph.ty(value), Type::Float(1 | 3 | 4)) || self.sites.is_empty() {
            return;
        }
        let (sum, through) = self.peeled(value);
        let mut terms = vec![];
        self.expand(sum, vec![], &mut terms, 0);
        let is_lit = terms.iter().any(|term| self.has(term, &["lambert", "phong", "blinn"]));
        if !is_lit && through.is_empty() {
            return;
        }
        let mut said = if is_lit { self.terms_said(&terms) } else { vec![] };
        let place = |kinds: &[&str]| through.iter().position(|own| kinds.contains(&&*self.sites[own].kind));
        if let (Some(fog), Some(gamma)) = (place(&["fog-mix"]), place(&["gamma", "srgb"]))
            && fog < gamma
            && ["fog", "mist", "haze"].iter().any(|word| self.lower_names(through[fog]).contains(word))
        {
            said.push((StepVerdict::Mistake, "fog-after-gamma", "fog is mixed into a colour that is encoded already"));
        }
        let line = self.graph.line(sum);
        let terms: Vec<String> = terms
            .iter()
            .take(MOST_SHOWN)
            .map(|term| term.iter().map(|factor| self.factor_text(factor)).collect::<Vec<_>>().join(" · "))
            .collect();
        for (verdict, name, sentence) in said {
            let code = terms.join(" + ");
            let (kind, name, sentence) = ("terms".into(), name.into(), sentence.into());
            self.say(ShaderStep {
                line,
                also: vec![],
                kind,
                verdict,
                name,
                sentence,
                accepted: false,
                code,
                function: None,
                judged: None,
            });
        }
        let then = through.iter().rev().map(|own| self.sites[own].kind.clone()).collect();
        self.sums.push(ShaderSum { line, output: crate::read::shown(output), terms, then });
    }

    fn is_attenuated(&self, term: &Term) -> bool {
        self.has(term, &["attenuation", "divisor"])
    }

    #[expect(clippy::too_many_lines, reason = "a table of what is said, in code")]
    fn terms_said(&self, terms: &[Term]) -> Vec<Said> {
        use StepVerdict::{Dialect, Mistake, Perhaps};
        let mut said: Vec<Said> = vec![];
        let is_shine = |term: &&Term| self.has(term, &["phong", "blinn"]);
        let is_diffuse = |term: &&Term| self.has(term, &["lambert"]) && !is_shine(term);
        let diffuse: Vec<&Term> = terms.iter().filter(is_diffuse).collect();
        let shine: Vec<&Term> = terms.iter().filter(is_shine).collect();
        let rest: Vec<&Term> = terms
            .iter()
            .filter(|term| !is_shine(term) && !is_diffuse(term) && !self.has_origin(term, Origin::NoValue))
            .collect();
        if terms.iter().any(|term| self.is_twice(term)) {
            said.push((Mistake, "attenuated-twice", "a term is attenuated twice"));
        }
        if shine.iter().any(|term| self.has(term, &["lambert"])) {
            said.push((Mistake, "highlight-times-lambert", "the highlight is multiplied by n·l"));
        }
        if rest.iter().any(|term| self.is_attenuated(term)) {
            said.push((
                Dialect,
                "ambient-attenuated",
                "a term without a light's vector is attenuated too, as OpenGL's fixed function has it",
            ));
        }
        if rest.iter().any(|term| self.has(term, &["spot"])) {
            said.push((
                Dialect,
                "ambient-in-the-cone",
                "a term without a light's vector is within the cone too, as OpenGL's fixed function has it",
            ));
        }
        if !diffuse.is_empty() && !shine.is_empty() {
            // Whether none of these terms is attenuated, and one of the others of the same light is: other branches are other lights.
            let lacks = |own: &[&Term], others: &[&Term]| {
                let is_mate = |term: &&&Term| own.iter().any(|one| Self::is_in_a_branch_of(one, term));
                own.iter().all(|term| !self.is_attenuated(term))
                    && others.iter().filter(is_mate).any(|term| self.is_attenuated(term))
                    && others.iter().filter(is_mate).all(|term| self.is_attenuated(term))
            };
            match (lacks(&shine, &diffuse), lacks(&diffuse, &shine)) {
                (true, false) => said.push((
                    Mistake,
                    "specular-not-attenuated",
                    "the highlight is not attenuated, and the diffuse term is",
                )),
                (false, true) => said.push((
                    Mistake,
                    "diffuse-not-attenuated",
                    "the diffuse term is not attenuated, and the highlight is",
                )),
                _ => {}
            }
            let lights = |terms: &[&Term], with_specular: bool| {
                terms.iter().any(|term| self.has_light_color(term, with_specular))
            };
            if !lights(&diffuse, true) && lights(&shine, false) {
                said.push((
                    Perhaps,
                    "diffuse-without-light-color",
                    "the highlight has the light's colour, and the diffuse term has not",
                ));
            }
            if lights(&diffuse, true) && !lights(&shine, true) {
                said.push((
                    Dialect,
                    "highlight-without-light-color",
                    "the diffuse term has the light's colour, and the highlight has not",
                ));
            }
        }
        let is_ambient = |term: &&Term| {
            term.iter().any(|factor| matches!(factor, Factor::Other(id) if self.lower_names(*id).contains("ambient")))
        };
        if diffuse.iter().any(is_ambient) && !rest.iter().any(is_ambient) {
            said.push((
                Mistake,
                "ambient-multiplies-diffuse",
                "what is named ambient multiplies the Lambert factor, and is not added",
            ));
        }
        said
    }

    /// Whether the conditions of one of two terms are among those of the other.
    fn is_in_a_branch_of(a: &Term, b: &Term) -> bool {
        let conditions = |term: &Term| -> Vec<Factor> {
            term.iter().copied().filter(|factor| matches!(factor, Factor::Where(..))).collect()
        };
        let (a, b) = (conditions(a), conditions(b));
        a.iter().all(|own| b.contains(own)) || b.iter().all(|own| a.contains(own))
    }

    fn has_origin(&self, term: &Term, origin: Origin) -> bool {
        term.iter().any(|factor| match factor {
            Factor::Other(id) => self
                .graph
                .leaves_of(*id)
                .iter()
                .any(|own| self.graph.leaf_of(*own).is_some_and(|leaf| leaf.origin == origin)),
            _ => false,
        })
    }

    fn is_twice(&self, term: &Term) -> bool {
        let mut seen = HashSet::new();
        term.iter().any(|factor| match factor {
            Factor::Step(id) | Factor::Over(id) => {
                let is_own = self.kind_of(factor).is_some_and(|kind| matches!(kind, "attenuation" | "divisor"));
                is_own && !seen.insert(*id)
            }
            _ => false,
        })
    }

    fn has_light_color(&self, term: &Term, with_specular: bool) -> bool {
        term.iter().any(|factor| {
            let Factor::Other(id) = factor else { return false };
            self.graph.names_of(*id).iter().map(|name| name.to_lowercase()).any(|name| {
                let of_light = ["light", "lamp", "sun"].iter().any(|word| name.contains(word));
                of_light && (with_specular || !name.contains("spec"))
            })
        })
    }

    /// Variables that are used before they have a value.
    pub(super) fn values_without(&mut self, roots: &[Root]) {
        let mut seen = HashSet::new();
        for output in roots.iter().flat_map(|root| &root.outputs) {
            let demanded = self.graph.demanded(output.value);
            let is_demanded = |own: NodeId| demanded.get(&own).is_some_and(|components| *components > 0);
            for own in self.graph.leaves_of(output.value).into_iter().filter(|own| is_demanded(*own)) {
                let Some(leaf) = self.graph.leaf_of(own).filter(|leaf| leaf.origin == Origin::NoValue) else {
                    continue;
                };
                if !seen.insert(own) {
                    continue;
                }
                let name = crate::read::shown(&leaf.name);
                // What is only handed on may be set wherever it matters.
                let (verdict, line) = match self.first_use(own) {
                    // Parts of a structure may be set wherever they matter.
                    Some(line) if name.contains(['.', '[']) => (StepVerdict::Perhaps, line),
                    Some(line) => (StepVerdict::Mistake, line),
                    None if name.split('.').next() == output.name.split('.').next() => continue,
                    None => (StepVerdict::Perhaps, self.graph.line(output.value)),
                };
                let sentence = format!("`{name}` has no value before it is used");
                let (kind, id) = ("value".into(), "not-initialised".into());
                self.say(ShaderStep {
                    line,
                    also: vec![],
                    kind,
                    verdict,
                    name: id,
                    sentence,
                    accepted: false,
                    code: name,
                    function: None,
                    judged: None,
                });
            }
        }
    }

    /// The line that first computes with a value, and does not hand it on alone.
    fn first_use(&self, id: NodeId) -> Option<u32> {
        let (mut todo, mut seen, mut found): (Vec<NodeId>, HashSet<NodeId>, Option<u32>) =
            (vec![id], HashSet::new(), None);
        while let Some(own) = todo.pop() {
            for user in self.users(own).iter().copied() {
                if !seen.insert(user) {
                    continue;
                }
                match self.graph.op(user) {
                    Op::Swizzle(..) | Op::Vector(_) | Op::Splat(_) => todo.push(user),
                    Op::Select(condition, ..) if *condition != own => todo.push(user),
                    _ => {
                        let line = self.graph.line(user);
                        found = Some(found.map_or(line, |known| known.min(line)));
                    }
                }
            }
        }
        found
    }
}
