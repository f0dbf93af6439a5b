//! What fails, as text, as soon as it is judged.

use crate::gate::{GateStyle, MOST_TOLD, told};
use crate::text::{failing_group, failure, formula_of};
use lightmeter_document::event::Event;
use lightmeter_document::gate::{GateFailure, GateGroup};
use lightmeter_document::run::{Failure, Group};
use std::collections::BTreeSet;
use std::fmt::{Result, Write};

/// Tells each group that fails once, and of each formula on an adapter one failing case.
#[derive(Debug, Default)]
pub struct Live {
    style: GateStyle,
    groups: BTreeSet<(String, String, String)>,
    formulas: BTreeSet<(String, String)>,
    /// Groups of a renderer that were told.
    asked: usize,
}

impl Live {
    /// One that tells in this style.
    #[must_use]
    pub fn new(style: GateStyle) -> Self {
        Self { style, ..Self::default() }
    }

    /// What there is to say of an event; nothing of most.
    #[must_use]
    pub fn text(&mut self, event: &Event<'_>) -> String {
        let mut out = String::new();
        if let Event::Judged { group, failures, .. } = event
            && let Some(counts) = &group.by_case
            && group.stage == "answer"
        {
            let group = GateGroup::of(group, counts);
            if group.is_failed() && self.asked < MOST_TOLD {
                self.asked += 1;
                let failures: Vec<GateFailure> = failures.iter().filter_map(|one| GateFailure::of(one)).collect();
                let Ok(()) = told(&group, &failures, &self.style, &mut out) else { unreachable!("a string takes all") };
            }
            return out;
        }
        if let Event::Judged { group, failures, is_scouted } = event
            && (group.totals.failed > 0 || group.problem.is_some())
        {
            let Ok(()) = self.group(group, failures, *is_scouted, &mut out) else { unreachable!("a string takes all") };
        }
        out
    }

    fn group(&mut self, group: &Group, failures: &[&Failure], is_scouted: bool, out: &mut String) -> Result {
        let key = (group.id.clone(), group.adapter.clone(), group.place());
        let is_new = self.groups.insert(key);
        if is_new {
            failing_group(group, if is_scouted { " of the first" } else { " of" }, out)?;
        }
        let mut told = is_new;
        for one in failures {
            if self.formulas.insert((formula_of(one).to_owned(), one.adapter.clone())) {
                failure(one, self.style.level, out)?;
                told = true;
            }
        }
        if told { writeln!(out) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::run::Totals;

    #[test]
    fn a_group_that_fails_is_told_once() {
        let mut group = Group::new("fog/linear".into(), "lavapipe".into(), "compute");
        group.explanation = Some("2 of 2 failing cases are explained by: it clamps".into());
        let (mut live, mut said) = (Live::default(), String::new());
        for (failed, is_scouted) in [(0, true), (2, true), (400, false)] {
            group.totals = Totals { verdicts: 10 * failed, failed, ..Totals::default() };
            said += &live.text(&Event::Judged { group: &group, failures: vec![], is_scouted });
        }
        let lines: Vec<&str> = said.lines().filter(|line| !line.is_empty()).collect();
        assert_eq!(lines.len(), 2, "{said}");
        assert!(lines[0].contains("2 of the first 20") && lines[1].contains("it clamps"), "{said}");
        assert_eq!(live.text(&Event::Group("fog/linear")), "");
    }
}
