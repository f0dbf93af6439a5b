//! What is worse or better than in a baseline, as lines of a report.

use super::matrix::{self, is_failing};
use lightmeter_document::report::{Group, Report};
use maud::{Markup, html};
use std::collections::HashMap;

/// Lines back in which a group's other places are looked for: each has a few things said of it.
const MOST_PLACES: usize = 16;

/// What a comparison says of groups. What it says of several places of a formula alike is one line. A formula that fails is a link to its card.
pub(super) fn compared(report: &Report, lines: &[String]) -> Vec<Markup> {
    // A run calls its groups by subject and place, a gate by the target that they are blended on.
    let of_run = |group: &Group| format!("{} on {}, {}", group.id, group.adapter, group.place());
    let of_gate = |group: &Group| match &group.target {
        Some(target) => format!("{} on {target}", group.id),
        None => group.id.clone(),
    };
    let by_name: HashMap<String, &Group> =
        report.groups.iter().flat_map(|group| [(of_run(group), group), (of_gate(group), group)]).collect();
    // What is said, the first of the groups that it is said of, and the places of all.
    let mut said: Vec<(&str, Option<&Group>, Vec<String>)> = vec![];
    for line in lines {
        let of = line.split_once(": ").and_then(|(name, what)| Some((what, *by_name.get(name)?)));
        let Some((what, group)) = of else {
            said.push((line, None, vec![]));
            continue;
        };
        let is_alike = |(other, first, _): &&mut (&str, Option<&Group>, Vec<String>)| {
            *other == what && first.is_some_and(|first| (&first.id, &first.adapter) == (&group.id, &group.adapter))
        };
        // The places of a group stand next to each other.
        match said.iter_mut().rev().take(MOST_PLACES).find(is_alike) {
            Some((.., places)) => places.push(group.place()),
            None => said.push((what, Some(group), vec![group.place()])),
        }
    }
    let line = |(what, group, places): (&str, Option<&Group>, Vec<String>)| match group {
        Some(group) => html! {
            @if is_failing(group) {
                a href={ "#" (matrix::card_id(&group.id, &group.adapter)) } { (group.id) }
            } @else {
                (group.id)
            }
            " on " (group.adapter) ", " (places.join(" and ")) ": " (what)
        },
        None => html! { (what) },
    };
    said.into_iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::report::Totals;

    fn group(stage: &'static str, failed: u64) -> Group {
        let totals = Totals { cases: 9, verdicts: 9, failed, ..Totals::default() };
        Group { totals, ..Group::new("fog/exp".into(), "lavapipe".into(), stage) }
    }

    fn told(groups: Vec<Group>, lines: &[&str]) -> Vec<String> {
        let report = Report { groups, ..Report::empty(1, "wgsl".into(), vec![], vec![]) };
        let lines: Vec<String> = lines.iter().map(ToString::to_string).collect();
        compared(&report, &lines).into_iter().map(|line| line.0).collect()
    }

    #[test]
    fn what_is_said_of_all_stages_is_one_line() {
        let lines = ["fog/exp on lavapipe, compute: 2 fail", "fog/exp on lavapipe, fragment: 2 fail"];
        let groups = || vec![group("compute", 0), group("fragment", 0)];
        assert_eq!(told(groups(), &lines), ["fog/exp on lavapipe, compute and fragment: 2 fail"]);
        let apart = ["fog/exp on lavapipe, compute: 2 fail", "fog/exp on lavapipe, fragment: 3 fail"];
        assert_eq!(told(groups(), &apart), apart);
        assert_eq!(told(groups(), &["something else: a < b"]), ["something else: a &lt; b"]);
    }

    #[test]
    fn what_fails_is_a_link_to_its_card_in_a_run_and_in_a_gate() {
        let card = matrix::card_id("fog/exp", "lavapipe");
        for (stage, line) in [("compute", "fog/exp on lavapipe, compute: 2 fail"), ("answer", "fog/exp: 2 fail")] {
            let said = told(vec![group(stage, 2)], &[line]);
            assert!(said[0].starts_with(&format!("<a href=\"#{card}\">fog/exp</a>")), "{said:?}");
        }
    }
}
