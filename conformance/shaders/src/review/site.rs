//! Which parts of the graph are steps, the largest first, and under what they are used.

use super::Review;
use crate::graph::{Binary, Function, NodeId, Op};
use crate::lower::Root;
use crate::unify::Match;
use std::collections::HashSet;

/// A condition, and whether it holds.
pub(super) type Condition = (NodeId, bool);

/// A value that a template is.
#[derive(Clone, Debug)]
pub(super) struct Site {
    pub(super) id: NodeId,
    pub(super) matched: Match,
    pub(super) kind: String,
    /// How it is used, in each place.
    pub(super) ways: Vec<Way>,
}

/// Ways that are kept of a step.
const MOST_WAYS: usize = 16;

/// How a value is used on the way from an output to it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Way {
    pub(super) conditions: Vec<Condition>,
    /// Whether it is negated.
    pub(super) is_negated: bool,
    /// Whether it is held above a constant, and below one.
    pub(super) held: (bool, bool),
    /// Whether fog is mixed by it.
    pub(super) is_fog: bool,
    /// Whether it multiplies what is given, or is given itself.
    pub(super) is_factor: bool,
    /// Whether there are sums, products and limits alone between it and what is given.
    pub(super) is_linear: bool,
}

impl Way {
    fn under(&self) -> Self {
        Self { conditions: self.conditions.clone(), is_fog: self.is_fog, ..Self::default() }
    }
}

/// A highlight's normal, light and eye.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mates {
    pub(super) n: NodeId,
    pub(super) l: NodeId,
    pub(super) v: NodeId,
}

impl Review<'_> {
    pub(super) fn visit_all(&mut self, roots: &[Root]) {
        self.sites.clear();
        let mut seen = HashSet::new();
        for output in roots.iter().flat_map(|root| &root.outputs).filter(|own| !own.is_position) {
            self.visit(output.value, &mut seen, &Way { is_factor: true, is_linear: true, ..Way::default() });
        }
        while let Some(condition) = self.waiting.pop() {
            self.visit(condition, &mut seen, &Way::default());
        }
    }

    /// What highlights say of the vectors of the others.
    pub(super) fn learn(&mut self) {
        let mut mates = vec![];
        for site in self.sites.values() {
            let template = self.finder.template(&site.matched);
            if matches!(&*template.head.kind, "phong" | "blinn") {
                let get = |name: &str| {
                    let slot = template.parameters.iter().position(|own| own.0 == name)?;
                    Some(self.core(site.matched.bound[slot].id).0)
                };
                if let Some(n) = get("n") {
                    let l = get("l").unwrap_or(n);
                    mates.push(Mates { n, l, v: get("v").unwrap_or(l) });
                }
            }
        }
        self.normals = mates.iter().map(|own| own.n).collect();
        self.mates = mates;
    }

    fn visit(&mut self, id: NodeId, seen: &mut HashSet<NodeId>, way: &Way) {
        if let Some(site) = self.sites.get_mut(&id) {
            if site.ways.len() < MOST_WAYS && !site.ways.contains(way) {
                site.ways.push(way.clone());
            }
            return;
        }
        if !seen.insert(id) {
            return;
        }
        if let Some(matched) = self.finder.best(id)
            && let Some(kind) = self.accepted(id, &matched, way)
        {
            let template = self.finder.template(&matched);
            let names = template.parameters.iter().map(|own| own.0 == "amount" && kind == "fog-mix");
            let next: Vec<(NodeId, bool)> = matched.bound.iter().map(|own| own.id).zip(names).collect();
            let mut inner = way.under();
            if let Op::Select(condition, _, no) = *self.graph.op(id) {
                self.conjuncts(condition, self.graph.is_number(no, 0.0), &mut inner.conditions);
            }
            self.sites.insert(id, Site { id, matched, kind, ways: vec![way.clone()] });
            for (own, is_fog) in next {
                self.visit(own, seen, &Way { is_fog, ..inner.clone() });
            }
            return;
        }
        self.visit_operands(id, seen, way);
    }

    fn visit_operands(&mut self, id: NodeId, seen: &mut HashSet<NodeId>, way: &Way) {
        let plain = Way { held: (false, false), ..way.clone() };
        let turned = Way { is_negated: !way.is_negated, ..plain.clone() };
        match self.graph.op(id).clone() {
            Op::Negate(a) => self.visit(a, seen, &turned),
            Op::Binary(Binary::Subtract, a, b) => {
                self.visit(a, seen, &plain);
                self.visit(b, seen, &Way { is_factor: false, ..turned });
            }
            // A product of what is not negative with a factor is held above 0 as the factor is.
            Op::Binary(Binary::Multiply | Binary::Divide, a, b) => {
                let held = Way { held: (way.held.0, false), is_factor: true, ..plain };
                self.visit(a, seen, &held);
                self.visit(b, seen, &held);
            }
            Op::Binary(Binary::Add, a, b) => {
                self.visit(a, seen, &plain);
                self.visit(b, seen, &plain);
            }
            Op::Select(condition, yes, no) => {
                for (value, holds) in [(yes, true), (no, false)] {
                    let mut own = way.clone();
                    self.conjuncts(condition, holds, &mut own.conditions);
                    self.visit(value, seen, &own);
                }
                self.waiting.push(condition);
            }
            Op::Call(function @ (Function::Max | Function::Min), x) if self.held_part(&x).is_some() => {
                let (above, below) = way.held;
                let held = (above || function == Function::Max, below || function == Function::Min);
                if let Some(own) = self.held_part(&x) {
                    self.visit(own, seen, &Way { held, ..way.clone() });
                }
            }
            op => {
                let keeps = matches!(op, Op::Splat(_) | Op::Vector(_) | Op::Swizzle(..));
                let next = if keeps { way.clone() } else { way.under() };
                for own in op.operands() {
                    self.visit(own, seen, &next);
                }
            }
        }
    }

    /// What a constant holds above or below it.
    pub(super) fn held_part(&self, x: &[NodeId]) -> Option<NodeId> {
        match (self.graph.constant_of(x[0]).is_some(), self.graph.constant_of(x[1]).is_some()) {
            (true, false) => Some(x[1]),
            (false, true) => Some(x[0]),
            _ => None,
        }
    }

    /// The conditions that a condition is made of.
    fn conjuncts(&self, condition: NodeId, holds: bool, found: &mut Vec<Condition>) {
        match *self.graph.op(condition) {
            Op::Binary(Binary::And, a, b) if holds => {
                self.conjuncts(a, true, found);
                self.conjuncts(b, true, found);
            }
            Op::Binary(Binary::Or, a, b) if !holds => {
                self.conjuncts(a, false, found);
                self.conjuncts(b, false, found);
            }
            Op::Not(a) => self.conjuncts(a, !holds, found),
            _ => found.push((condition, holds)),
        }
    }

    /// Whether conditions say that a value, or its negative, is above 0.
    pub(super) fn is_held_positive(&self, value: NodeId, is_negated: bool, conditions: &[Condition]) -> bool {
        conditions.iter().any(|(condition, holds)| {
            let Op::Binary(op, a, b) = *self.graph.op(*condition) else { return false };
            let (above, below) = match (op, *holds) {
                (Binary::Greater | Binary::GreaterEqual, true) | (Binary::Less | Binary::LessEqual, false) => (a, b),
                (Binary::Less | Binary::LessEqual, true) | (Binary::Greater | Binary::GreaterEqual, false) => (b, a),
                _ => return false,
            };
            let unclamped = match self.graph.op(above) {
                Op::Call(Function::Max, x) if self.graph.is_number(x[0], 0.0) => x[1],
                Op::Call(Function::Max, x) if self.graph.is_number(x[1], 0.0) => x[0],
                _ => above,
            };
            let not_below_zero = self.graph.number_of(below).is_some_and(|own| own >= 0.0);
            self.graph.without_sign(unclamped) == (value, is_negated) && not_below_zero
        })
    }

    /// The conditions under which a step is used: those of its way, and of the branches it stands in.
    pub(super) fn conditions_of(&self, site: &Site) -> Vec<Condition> {
        let mut found: Vec<Condition> = site.ways.first().map(|way| way.conditions.clone()).unwrap_or_default();
        for (condition, holds) in self.graph.occurrences(site.id).iter().take(1).flat_map(|own| own.conditions.iter()) {
            self.conjuncts(*condition, *holds, &mut found);
        }
        found
    }

    /// The line of a step: that of what is held within limits, if it is.
    pub(super) fn line_of(&self, id: NodeId) -> u32 {
        let mut own = id;
        loop {
            own = match self.graph.op(own) {
                Op::Call(Function::Min | Function::Max, x) => match self.held_part(x) {
                    Some(inner) if !matches!(self.graph.op(inner), Op::Call(Function::Dot, _)) => inner,
                    _ => break,
                },
                Op::Negate(inner) | Op::Splat(inner) => *inner,
                _ => break,
            };
        }
        match (self.graph.line(own), self.graph.line(id)) {
            // A compiler may say no line: that of what is made of it is the next best.
            (0, 0) => self.users(id).iter().map(|user| self.graph.line(*user)).find(|line| *line > 0).unwrap_or(0),
            (0, line) | (line, _) => line,
        }
    }

    /// All lines of a value.
    pub(super) fn lines_of(&self, id: NodeId) -> Vec<u32> {
        let mut found: Vec<u32> =
            self.graph.occurrences(id).iter().map(|own| own.line).filter(|line| *line > 0).collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}
