//! What fails, as text, as soon as it is judged.

use crate::Level;
use crate::text::{MOST_TOLD, Style, asked, failure, formula_of, judged};
use lightmeter_document::event::Event;
use lightmeter_document::report::{Failure, Group};
use std::collections::BTreeSet;
use std::fmt::{Result, Write};

/// Tells each group that fails once, and of each formula on a subject one failing case.
#[derive(Debug, Default)]
pub struct Live {
    style: Style,
    groups: BTreeSet<(String, String, String)>,
    formulas: BTreeSet<(String, String)>,
    /// Groups of a renderer that were told.
    asked: usize,
}

impl Live {
    /// One that says so much.
    #[must_use]
    pub fn new(level: Level) -> Self {
        Self { style: Style { level, is_told: true, ..Style::default() }, ..Self::default() }
    }

    /// What there is to say of an event; nothing of most.
    #[must_use]
    pub fn text(&mut self, event: &Event<'_>) -> String {
        let mut out = String::new();
        if let Event::Judged { group, failures, is_scouted } = event
            && group.is_failed()
        {
            let told = self.group(group, failures, *is_scouted, &mut out);
            let Ok(()) = told else { unreachable!("a string takes all") };
        }
        out
    }

    fn group(&mut self, group: &Group, failures: &[&Failure], is_scouted: bool, out: &mut String) -> Result {
        if group.asked().is_some() {
            self.asked += 1;
            return if self.asked <= MOST_TOLD { asked(group, failures, self.style, out) } else { Ok(()) };
        }
        let key = (group.id.clone(), group.adapter.clone(), group.place());
        let is_new = self.groups.insert(key);
        if is_new {
            judged(group, if is_scouted { " of the first" } else { " of" }, out)?;
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
    use lightmeter_document::report::{Diagnosis, Explanation, Standing, Totals};

    #[test]
    fn a_group_that_fails_is_told_once() {
        let mut group = Group::new("fog/linear".into(), "lavapipe".into(), "compute");
        let explanation = Explanation {
            says: "it clamps".into(),
            mistakes: vec![],
            parameter: None,
            explained: 2,
            open: 0,
            standing: Standing::Best,
        };
        group.diagnosis =
            Some(Diagnosis { failing: 2, looked_at: 2, explanations: vec![explanation], ..Diagnosis::default() });
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
