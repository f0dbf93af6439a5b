//! Mistakes that follow from what formulas are, their steps and inputs: a factor left out or counted twice, a term left out, a sign, one thing
//! in the place of another of its size, a step left out, the whole times an input.

mod probe;
mod words;

use super::alteration::{At, Do};
use super::change::{After, Before};
use super::fault::{Fault, Step, formulas, is_computed};
use super::op::Op;
use super::table;
use lightmeter_catalogue::cases::Spec;
use probe::{Operand, Probed, probed};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashSet};
use std::sync::LazyLock;
use words::Called;

/// All of them, of all formulas, by name.
pub(super) fn all() -> &'static [&'static Fault] {
    static ALL: LazyLock<Vec<&'static Fault>> = LazyLock::new(|| {
        let mut made = Made::default();
        for member in formulas().iter().filter(|member| is_computed(&member.spec)) {
            made.of_inputs(&member.spec);
            probed(member).iter().for_each(|step| made.of_step(step));
        }
        made.faults()
    });
    &ALL
}

/// A mistake in a step: its name, what it says, and what goes wrong.
type InStep = (String, String, Do);

/// Those of one thing that a step is given.
fn of_operand(whole: Called, (operand, Called { slug, says }): (Operand, Called), out: usize) -> Vec<InStep> {
    let (s, of, name) = (whole.slug, whole.says, operand.name);
    if !operand.is_read {
        let times = (format!("{s}-times-{slug}"), format!("{of} is multiplied by {says}"), Do::Times(name));
        return if operand.size == 1 { vec![times] } else { vec![] };
    }
    let given = |op| Do::Given(name, op);
    let mut made = vec![];
    let mut add = |name: String, says: String, what: Do| made.push((name, says, what));
    if operand.is_factor() {
        add(format!("{s}-without-{slug}"), format!("{of} is not multiplied by {says}"), given(Op::Set(1.0)));
        add(format!("{s}-with-{slug}-twice"), format!("{of} is multiplied by {says} twice"), given(Op::Square));
        add(format!("{s}-over-{slug}"), format!("{of} is divided by {says}, not multiplied"), given(Op::Reciprocal));
    } else if operand.is_term() {
        add(format!("{s}-without-{slug}"), format!("{of} lacks {says}"), given(Op::Set(0.0)));
        add(format!("{s}-with-{slug}-twice"), format!("{of} has {says} twice"), given(Op::Scale(2.0)));
    } else if operand.size == 1 {
        add(format!("{s}-with-{slug}-squared"), format!("{of} is computed with {says} squared"), given(Op::Square));
        let inverted = format!("{of} is computed with the reciprocal of {says}");
        add(format!("{s}-with-{slug}-inverted"), inverted, given(Op::Reciprocal));
        add(format!("{s}-with-{slug}-1"), format!("{of} is computed with 1 for {says}"), given(Op::Set(1.0)));
    }
    let negated = format!("{of} is computed with {says} of the other sign");
    add(format!("{s}-with-{slug}-negated"), negated, given(Op::Negate));
    if operand.is_alone && operand.size == out {
        add(format!("{slug}-for-{s}"), format!("{of} is left out: {says} stands in its place"), Do::Pass(name));
    }
    made
}

/// Those of what a step gives.
fn of_result(Called { slug, says }: Called, out: usize) -> Vec<InStep> {
    let mut made = vec![(format!("{slug}-negated"), format!("{says} has the other sign"), Do::Result(Op::Negate))];
    if out == 1 {
        let own = |what: &str| format!("{says} is its own {what}");
        made.push((format!("{slug}-inverted"), own("reciprocal"), Do::Result(Op::Reciprocal)));
        made.push((format!("{slug}-squared"), format!("{says} is squared"), Do::Result(Op::Square)));
        made.push((format!("{slug}-rooted"), own("square root"), Do::Result(Op::Root)));
        made.push((format!("{slug}-zero"), format!("{says} is 0 throughout"), Do::Result(Op::Set(0.0))));
    }
    made
}

/// Mistakes by name, each with what it says and the ways in which it is made.
#[derive(Default)]
struct Made {
    /// The names in the order in which they were made.
    names: Vec<String>,
    by_name: BTreeMap<String, (String, Vec<Step>)>,
}

impl Made {
    fn take(&mut self, name: String, says: String, step: Step) {
        match self.by_name.entry(name) {
            Entry::Vacant(entry) => {
                self.names.push(entry.key().clone());
                entry.insert((says, vec![step]));
            }
            Entry::Occupied(mut entry) => {
                let ways = &mut entry.get_mut().1;
                // Functions cannot be compared, which no step of these has.
                if ways.iter().all(|way| format!("{way:?}") != format!("{step:?}")) {
                    ways.push(step);
                }
            }
        }
    }

    /// Those of a step.
    fn of_step(&mut self, Probed { step, out, operands }: &Probed) {
        let Some(whole) = words::step(step.name) else { return };
        let known = operands.iter().map(|operand| (*operand, words::operand(step.name, operand.name)));
        let known: Vec<(Operand, Called)> = known.collect();
        let at = |(name, says, what)| (name, says, Step::At(At { step: step.name, what }));
        let mut made = vec![];
        for (operand, called) in &known {
            made.extend(of_operand(whole, (*operand, *called), *out));
            let is_other = |other: &&(Operand, Called)| other.0.name != operand.name && other.0.size == operand.size;
            let are_read = |other: &&(Operand, Called)| operand.is_read && other.0.is_read;
            made.extend(known.iter().filter(is_other).filter(are_read).map(|(other, said)| {
                (
                    format!("{}-of-{}-for-{}", whole.slug, said.slug, called.slug),
                    format!("{} is computed with {} in the place of {}", whole.says, said.says, called.says),
                    Do::Copy(other.name, operand.name),
                )
            }));
        }
        made.extend(of_result(whole, *out));
        made.into_iter().map(at).for_each(|(name, says, step)| self.take(name, says, step));
    }

    /// Makes the mistakes of a formula's inputs: one input replaces another of its shape and unit, two are exchanged, or the colour is multiplied by one.
    fn of_inputs(&mut self, spec: &Spec) {
        let known = spec.inputs.iter().map(|input| (input, words::operand("", input.name)));
        let known: Vec<_> = known.collect();
        for (place, (input, Called { slug, says })) in known.iter().enumerate() {
            for (other, Called { slug: other_slug, says: other_says }) in &known[place + 1..] {
                if input.shape != other.shape || input.unit != other.unit {
                    continue;
                }
                let (a, b) = (input.name, other.name);
                let for_other = format!("{says} stands in the place of {other_says}");
                let for_this = format!("{other_says} stands in the place of {says}");
                self.take(format!("{slug}-for-{other_slug}"), for_other, Step::Before(Before::Copy(a, b)));
                self.take(format!("{other_slug}-for-{slug}"), for_this, Step::Before(Before::Copy(b, a)));
                let exchanged = format!("{says} and {other_says} are exchanged");
                self.take(format!("{slug}-and-{other_slug}-exchanged"), exchanged, Step::Before(Before::Swap(a, b)));
            }
            let is_number = input.shape.components() == 1 || input.unit == "color";
            if is_number && spec.outputs.iter().any(|output| output.unit == "color") {
                let whole = format!("the whole colour is multiplied by {says}");
                self.take(format!("all-times-{slug}"), whole, Step::After(After::ColorsTimes(input.name)));
            }
        }
    }

    fn faults(self) -> Vec<&'static Fault> {
        let Self { names, mut by_name } = self;
        let listed: HashSet<&str> = table::all().flat_map(|fault| [fault.name, fault.says]).collect();
        let fault = |name: String| {
            let (says, steps) = by_name.remove(&name)?;
            // What a table has by this name or in these words is another mistake, or the same.
            if listed.contains(&*name) || listed.contains(&*says) {
                return None;
            }
            let ways: Vec<&'static [Step]> = steps.into_iter().map(|step| &*Vec::leak(vec![step])).collect();
            Some(&*Box::leak(Box::new(Fault::generated(name.leak(), says.leak(), ways.leak()))))
        };
        names.into_iter().filter_map(fault).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn each_step_has_words() {
        let mut without = BTreeSet::new();
        for member in formulas().iter().filter(|member| is_computed(&member.spec)) {
            for Probed { step, .. } in probed(member).iter().filter(|probed| !probed.step.is_quiet) {
                if words::step(step.name).is_none() {
                    without.insert(format!("the step {}", step.name));
                }
            }
        }
        assert!(without.is_empty(), "{without:#?}");
    }

    #[test]
    fn names_and_sentences_are_no_others() {
        let listed: HashSet<&str> = table::all().flat_map(|fault| [fault.name, fault.says]).collect();
        let mut seen = HashSet::new();
        for fault in all() {
            assert!(!listed.contains(fault.name) && !listed.contains(fault.says), "{} is in a table", fault.name);
            assert!(seen.insert(fault.name) && seen.insert(fault.says), "{}: {}", fault.name, fault.says);
            assert!(fault.name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-'), "{}", fault.name);
        }
        assert!(all().len() > 500, "{}", all().len());
    }
}
