//! Finds which template a value is, by numeric unification: parts of the graph and templates are compared on random inputs.
//!
//! A value is a function of each of its cuts. A cut and a template whose parameters are of the same types are compared under all
//! assignments, at 40 points in f64, to 1e-9; what agrees to 1e-4 alone has a constant that is rounded. So syntax does not matter.

mod class;
mod cuts;
mod length;
mod library;
#[cfg(test)]
mod tests;

pub(crate) use class::Class;
pub(crate) use length::Length;
pub(crate) use library::{Library, Plain, Template};

use crate::graph::{Binary, Evaluation, Function, Graph, NodeId, Op, Type, Value};
use crate::templates::Worth;
use cuts::{Cut, Cuts};
use library::{Form, Group, MOST_OPERATIONS, SAMPLES};
use std::collections::HashMap;

/// Equal but for rounding in f64.
const EXACT: f64 = 1e-9;
/// Equal but for a constant's rounding.
const ROUNDED: f64 = 1e-4;

/// Whether two values are the same; infinities and what is no number have to be in the same places.
#[expect(clippy::float_cmp, reason = "infinities are equal, or are not")]
pub(crate) fn is_close(a: &Value<f64>, b: &Value<f64>, tolerance: f64) -> bool {
    let close = |(a, b): (&f64, &f64)| {
        a.is_nan() && b.is_nan()
            || a == b
            || a.is_finite() && b.is_finite() && (a - b).abs() <= tolerance * (1e-3 + a.abs().max(b.abs()))
    };
    a.components().len() == b.components().len() && a.components().iter().zip(b.components()).all(close)
}

/// A value that stands for a template's parameter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    pub(crate) id: NodeId,
    /// Whether the template's parameter is its negative.
    pub(crate) is_negated: bool,
    /// Whether its length matters, of one that is taken for a unit vector.
    pub(crate) by_length: bool,
}

/// A template that a value is.
#[derive(Clone, Debug)]
pub(crate) struct Match {
    pub(crate) template: usize,
    pub(crate) bound: Vec<Bound>,
    /// Equal to 1e-9, and not to 1e-4 alone.
    pub(crate) is_exact: bool,
    score: i64,
}

/// Finds templates in a graph.
pub(crate) struct Finder<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) library: &'a Library,
    cuts: Cuts,
    known: HashMap<NodeId, Option<Match>>,
    lengths: HashMap<NodeId, Length>,
    /// Kept from one evaluation to the next.
    buffer: Vec<Value<f64>>,
}

/// One comparison: a cut's evaluation, and which slot of the group each of its values is.
struct Trial<'a> {
    evaluation: &'a Evaluation<'a>,
    group: &'a Group,
    /// Of each slot, the place in the cut.
    places: &'a [usize],
}

impl Trial<'_> {
    fn given(&self, sample: usize) -> Vec<Value<f64>> {
        let mut given = vec![Value::zero(0); self.places.len()];
        for (value, place) in self.group.samples[sample].iter().zip(self.places) {
            given[*place] = *value;
        }
        given
    }
}

impl<'a> Finder<'a> {
    pub(crate) fn new(graph: &'a Graph, library: &'a Library) -> Self {
        Self { graph, library, cuts: Cuts::default(), known: HashMap::new(), lengths: HashMap::new(), buffer: vec![] }
    }

    pub(crate) fn template(&self, own: &Match) -> &'a Template {
        &self.library.templates[own.template]
    }

    /// The template that says most of a value.
    pub(crate) fn best(&mut self, id: NodeId) -> Option<Match> {
        if let Some(known) = self.known.get(&id) {
            return known.clone();
        }
        let found = self.found(id);
        self.known.insert(id, found.clone());
        found
    }

    fn found(&mut self, id: NodeId) -> Option<Match> {
        let ty = self.graph.ty(id);
        let is_made = match self.graph.op(id) {
            Op::Leaf(_) | Op::Constant(_) | Op::Splat(_) => false,
            // A sign belongs to what reads it, but for that of a quotient, which may come of a difference.
            Op::Negate(inner) => matches!(self.graph.op(*inner), Op::Binary(Binary::Divide, ..)),
            _ => true,
        };
        if !is_made || !matches!(ty, Type::Float(1 | 3 | 4) | Type::Bool(1)) {
            return None;
        }
        let mut best: Option<Match> = None;
        for cut in self.cuts.of(self.graph, id).iter() {
            if cut.is_empty() || **cut == [id] {
                continue;
            }
            let mut types: Vec<Type> = cut.iter().map(|own| self.graph.ty(*own)).collect();
            types.sort_unstable();
            let groups: Vec<&Group> = self.library.groups.iter().filter(|group| group.types == types).collect();
            if groups.is_empty() {
                continue;
            }
            let Some(evaluation) = Evaluation::new(self.graph, id, cut, MOST_OPERATIONS) else { continue };
            for places in assignments(self.graph, cut, &types) {
                for group in &groups {
                    let trial = Trial { evaluation: &evaluation, group, places: &places };
                    self.compare(id, cut, &trial, &mut best);
                }
            }
        }
        best
    }

    fn compare(&mut self, id: NodeId, cut: &Cut, trial: &Trial<'_>, best: &mut Option<Match>) {
        let first = trial.evaluation.value(&trial.given(0), &mut self.buffer);
        let number = first.first();
        let forms = &trial.group.forms;
        let reach = ROUNDED * (1e-3 + number.abs()) * 2.0;
        let start = forms.partition_point(|form| form.values[0].first().total_cmp(&(number - reach)).is_lt());
        let near = |form: &&Form| number.is_nan() || form.values[0].first() <= number + reach;
        let from: &[Form] = if number.is_nan() { forms } else { &forms[start..] };
        let mut values = vec![first];
        for form in from.iter().take_while(near) {
            let mut tolerance = EXACT;
            let agrees = (0..SAMPLES).all(|k| {
                if values.len() == k {
                    values.push(trial.evaluation.value(&trial.given(k), &mut self.buffer));
                }
                if !is_close(&values[k], &form.values[k], tolerance) {
                    tolerance = ROUNDED;
                }
                is_close(&values[k], &form.values[k], tolerance)
            });
            if agrees && let Some(own) = self.weighed(id, cut, form, tolerance < ROUNDED, trial) {
                let is_better = best.as_ref().is_none_or(|known| own.score > known.score);
                if is_better {
                    *best = Some(own);
                }
            }
        }
    }

    /// Whether a value changes with the length of a vector.
    fn depends_on_length(&mut self, trial: &Trial<'_>, slot: usize) -> bool {
        (0..8).any(|k| {
            let mut given = trial.given(k);
            let before = trial.evaluation.value(&given, &mut self.buffer);
            let place = trial.places[slot];
            given[place] = given[place].map(|own| own * 1.7);
            !is_close(&before, &trial.evaluation.value(&given, &mut self.buffer), 1e-7)
        })
    }

    /// Whether a coefficient or an exponent is made of what else the form is of: kq·d is no coefficient of d².
    fn has_parameter_of_another(&self, template: &Template, bound: &[Bound]) -> bool {
        let is_variable = |k: usize| {
            let (name, class) = &template.parameters[k];
            matches!(class, Class::Unit | Class::Vector) || matches!(&**name, "d" | "x")
        };
        let is_coefficient = |k: usize| {
            !is_variable(k) && matches!(template.parameters[k].1, Class::Positive | Class::Exponent | Class::Cosine)
        };
        let has = |whole: usize, part: usize| self.graph.all_of(bound[whole].id).binary_search(&bound[part].id).is_ok();
        let all = || 0..bound.len();
        // A distance that a coefficient is in is none either.
        all().filter(|k| is_coefficient(*k) && self.graph.constant_of(bound[*k].id).is_none()).any(|coefficient| {
            all().filter(|k| is_variable(*k)).any(|own| has(coefficient, own) || has(own, coefficient))
        })
    }

    /// A match with how much speaks for it; none if something speaks against it.
    fn weighed(&mut self, id: NodeId, cut: &Cut, form: &Form, is_exact: bool, trial: &Trial<'_>) -> Option<Match> {
        let template = &self.library.templates[form.template];
        let mut bound = vec![];
        let mut score = 0;
        for (slot, place) in trial.places.iter().enumerate() {
            let node = cut[*place];
            let by_length = template.parameters[slot].1 == Class::Unit && self.depends_on_length(trial, slot);
            score += self.fits(node, &template.parameters[slot], by_length)?;
            bound.push(Bound { id: node, is_negated: form.negated[slot], by_length });
        }
        self.lengths_fit(template, &bound).then_some(())?;
        if self.has_parameter_of_another(template, &bound) {
            return None;
        }
        // A steep ramp is no edge, however few values lie on it.
        let is_edge = ["spot_hard", "spot_gate", "spot_turned"].iter().any(|name| template.name.starts_with(name));
        if is_edge && !self.has_edge(id, cut, &bound) {
            return None;
        }
        score -= self.dependence(template, &bound);
        if template.head.worth == Worth::Mistake && self.has_part(template, &bound) {
            return None;
        }
        // Larger cuts explain less.
        score -= 3 * i64::try_from(bound.len()).unwrap_or(0);
        score += match template.head.worth {
            Worth::Right => 8,
            Worth::Dialect => 5,
            Worth::Mistake => 0,
        };
        score -= if template.head.is_weak { 30 } else { 0 };
        score -= if is_exact { 0 } else { 4 };
        let explained = self.graph.cone(id, cut, MOST_OPERATIONS).map_or(0, |cone| cone.len());
        score += i64::try_from(explained).unwrap_or(0);
        score = score * 1000 - i64::try_from(template.order).unwrap_or(0);
        Some(Match { template: form.template, bound, is_exact, score })
    }

    /// How well a value fits a parameter; none if it cannot be one.
    fn fits(&mut self, id: NodeId, (name, class): &(String, Class), by_length: bool) -> Option<i64> {
        let number = self.graph.number_of(id);
        let is_constant = self.graph.constant_of(id).is_some();
        let is_factor = self.graph.is_number(id, 2.0) || self.graph.is_number(id, 0.5);
        let mut score = if is_factor { -6 } else { 0 };
        match class {
            Class::Unit => {
                if is_constant && !matches!(&**name, "v" | "l" | "axis" | "b") {
                    return None;
                }
                score += match (self.length(id), by_length) {
                    _ if is_constant => 0,
                    (Length::One, _) => 12,
                    (Length::Open, false) => 14,
                    (Length::NotOne, false) => 13,
                    (Length::Open, true) => 4,
                    (Length::NotOne, true) => -6,
                };
            }
            // Four components that are put together are another form.
            Class::Vector if self.graph.ty(id) == Type::Float(4) && matches!(self.graph.op(id), Op::Vector(_)) => {
                return None;
            }
            Class::Exponent => {
                // A reciprocal exponent is a mistake of its own.
                if let Op::Binary(Binary::Divide, one, _) = *self.graph.op(id)
                    && self.graph.is_number(one, 1.0)
                {
                    score -= 12;
                }
                if number.is_some_and(|own| own < 0.9) {
                    return None;
                }
            }
            Class::Matrix | Class::Color if is_constant => score -= 8,
            Class::Vector if is_constant => return None,
            Class::Positive => score += self.fits_number(id, name, is_constant)?,
            _ => {}
        }
        Some(score)
    }

    /// How well a number fits a parameter that is one; none if it cannot be it.
    fn fits_number(&self, id: NodeId, name: &str, is_constant: bool) -> Option<i64> {
        let is_distance = matches!(name, "d" | "x");
        if is_distance && is_constant {
            return None;
        }
        let against = match self.graph.op(id) {
            Op::Binary(Binary::Subtract, ..) if name != "width" => 10,
            // A square is no distance, and what is held above 0 is what is left of one.
            Op::Binary(Binary::Multiply, a, b) if a == b => 20,
            Op::Call(Function::Max, _) => 10,
            // A reciprocal among the terms is a mistake of its own.
            Op::Binary(Binary::Divide, ..) if name == "kc" => 20,
            _ if name == "power" && !is_constant => 20,
            _ => 0,
        };
        let towards = if is_distance { self.distance(id) } else { 0 };
        Some(towards - against)
    }

    /// How much a number looks like a distance.
    pub(crate) fn distance(&self, id: NodeId) -> i64 {
        match self.graph.op(id) {
            Op::Call(Function::Length, _) => 10,
            Op::Call(Function::Abs, _) => 6,
            _ => {
                let name = self.graph.text(id, 3).to_lowercase();
                let is_named =
                    ["dist", "depth", "fogcoord", "fogfragcoord", ".z", "len"].iter().any(|own| name.contains(own));
                if is_named { 5 } else { 0 }
            }
        }
    }

    /// One vector may be of a wrong length by mistake, not several; and the sum of two positions is no half vector.
    fn lengths_fit(&mut self, template: &Template, bound: &[Bound]) -> bool {
        if !matches!(&*template.head.kind, "blinn" | "phong") {
            return true;
        }
        let wrong = |own: &&Bound| own.by_length && self.length(own.id) == Length::NotOne;
        if bound.iter().filter(wrong).count() > 1 {
            return false;
        }
        let of = |name: &str| template.parameters.iter().position(|own| own.0 == name).map(|slot| bound[slot].id);
        let (Some(l), Some(v), "blinn") = (of("l"), of("v"), &*template.head.kind) else { return true };
        let lengths = (self.length(l), self.length(v));
        lengths.0 == Length::One
            || lengths.1 == Length::One
            || lengths == (Length::Open, Length::Open)
            || !bound.iter().any(|own| own.by_length)
    }

    /// Whether something is chosen by vectors of a match.
    fn has_edge(&self, id: NodeId, cut: &Cut, bound: &[Bound]) -> bool {
        let vectors: Vec<NodeId> =
            bound.iter().map(|own| own.id).filter(|own| self.graph.ty(*own) == Type::Float(3)).take(2).collect();
        let depends = |own: NodeId| {
            let below = self.graph.all_of(own);
            vectors.iter().all(|vector| below.binary_search(vector).is_ok())
        };
        let chooses = |own: &NodeId| match self.graph.op(*own) {
            Op::Call(Function::Step, _) => depends(*own),
            Op::Binary(op, ..) => op.compares() && depends(*own),
            _ => false,
        };
        self.graph.cone(id, cut, MOST_OPERATIONS).is_some_and(|cone| cone.iter().any(chooses))
    }

    /// Whether one number is made of another: what is wrong with a form may then be made good within it.
    fn has_part(&self, template: &Template, bound: &[Bound]) -> bool {
        let is_number = |slot: usize| matches!(template.parameters[slot].1, Class::Positive | Class::Cosine);
        bound.iter().enumerate().filter(|(slot, _)| is_number(*slot)).any(|(i, a)| {
            let below = self.graph.all_of(a.id);
            bound.iter().enumerate().any(|(j, b)| j != i && is_number(j) && below.binary_search(&b.id).is_ok())
        })
    }

    /// Parameters are independent of each other where they can be.
    fn dependence(&self, template: &Template, bound: &[Bound]) -> i64 {
        let is_number =
            |slot: usize| matches!(template.parameters[slot].1, Class::Positive | Class::Cosine | Class::Exponent);
        let mut score = 0;
        for (i, a) in bound.iter().enumerate() {
            let below = self.graph.all_of(a.id);
            for (j, b) in bound.iter().enumerate().filter(|(j, _)| *j != i) {
                let parts = matches!((self.graph.op(a.id), self.graph.op(b.id)), (Op::Swizzle(..), Op::Swizzle(..)));
                if below.binary_search(&b.id).is_ok() {
                    score += 25;
                } else if i < j && is_number(i) && is_number(j) && !parts {
                    let shared = self.graph.leaves_of(b.id).iter().any(|leaf| below.binary_search(leaf).is_ok());
                    score += if shared { 14 } else { 0 };
                }
            }
        }
        score
    }
}

/// Ways to give a cut's values to slots of their types.
fn assignments(graph: &Graph, cut: &Cut, slots: &[Type]) -> Vec<Vec<usize>> {
    let mut found = vec![];
    let mut own = vec![];
    assign(graph, cut, slots, &mut own, &mut found);
    found
}

fn assign(graph: &Graph, cut: &Cut, slots: &[Type], own: &mut Vec<usize>, found: &mut Vec<Vec<usize>>) {
    let Some(ty) = slots.get(own.len()) else {
        found.push(own.clone());
        return;
    };
    for place in 0..cut.len() {
        if !own.contains(&place) && graph.ty(cut[place]) == *ty {
            own.push(place);
            assign(graph, cut, slots, own, found);
            own.pop();
        }
    }
}
