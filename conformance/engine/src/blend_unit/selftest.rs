//! Whether the suite catches what it should: every fault on every target, made by the embedded blend unit and judged like any
//! other, must be found and told by its name; without a fault nothing may be found.

use super::run::run_group;
use crate::device::{Code, DeviceError};
use crate::options::Options;
use crate::subject::Subject;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::cases::blend::{Program, Samples, every_state};
use lightmeter_catalogue::select::{Member, Random, Selected, catalogue_of};
use lightmeter_document::event::{Silent, Stop};
use lightmeter_document::report::{Group, Problem, Report};
use lightmeter_document::selftest::{UnitFinding, UnitRow};
use lightmeter_judge::blend_unit::rules::{FAULTS, Rules, Store, UnitFault};
use lightmeter_scene::blend::{Separate, State};
use lightmeter_scene::target::TargetFormat;

/// Tries every fault, and none, on every target, with `cases` pairs of each state; `None` where it was told to stop before the end.
///
/// # Errors
/// Where a built-in shader is invalid, which a test rules out.
pub fn selftest(
    targets: &[TargetFormat],
    cases: u64,
    stop: &Stop,
    progress: &mut impl FnMut(&str),
) -> Result<Option<Vec<UnitRow>>, DeviceError> {
    let groups = groups();
    let mut rows = vec![];
    for &target in targets {
        progress(target.name());
        let judged = judge(&groups, target, Rules::RIGHT, cases, stop)?;
        rows.push(row("none", target, &judged, |groups| {
            let found = |group: &Group| group.totals.failed > 0 || !group.problems.is_empty();
            if groups.iter().any(found) { UnitFinding::FalseAlarm } else { UnitFinding::Clean }
        }));
        for fault in FAULTS {
            if stop.is_set() {
                return Ok(None);
            }
            if !fault.concerns(target) {
                rows.push(row(fault.name, target, &empty_report(target)?, |_| UnitFinding::NotApplicable));
                continue;
            }
            // A fault of one state has that state's values alone to show in.
            let judged = match fault.rules.only_state() {
                Some(state) => judge(&[beside(state)], target, fault.rules, 4096, stop)?,
                None => judge(&groups, target, fault.rules, cases, stop)?,
            };
            rows.push(row(fault.name, target, &judged, |groups| finding(fault, groups)));
        }
    }
    // What was under way when it was told to stop has not been judged in full.
    Ok((!stop.is_set()).then_some(rows))
}

/// What a run draws with its unit, apart from sampled states; and the states that MIN and MAX make aliases of one, since a
/// renderer may not ignore their factors.
fn groups() -> Vec<Vec<Member>> {
    let catalogue = catalogue_of(&Samples { count: 0, ..Samples::default() });
    let drawn = catalogue
        .into_iter()
        .filter(|member| matches!(member.spec.kind, Kind::Blend(program) if !program.is_special()));
    let aliases = every_state().into_iter().map(Member::new);
    let aliases = aliases.filter(
        |member| matches!(member.spec.kind, Kind::Blend(Program::Draw(state, _)) if state != state.canonical()),
    );
    let mut groups: Vec<Vec<Member>> = vec![];
    for member in drawn.chain(aliases) {
        match groups.last_mut() {
            Some(group) if group[0].spec.group() == member.spec.group() => group.push(member),
            _ => groups.push(vec![member]),
        }
    }
    groups
}

fn options(target: TargetFormat, cases: u64) -> Result<Options, DeviceError> {
    Ok(Options { cases, targets: vec![target], ..Options::new(Code::default()) })
}

fn empty_report(target: TargetFormat) -> Result<Report, DeviceError> {
    Ok(options(target, 0)?.report(&[]))
}

/// The states that share a state's equation and source factor.
fn beside(state: State) -> Vec<Member> {
    let formulas = every_state().into_iter().map(Member::new);
    let shares = |program: Program| {
        let (Separate { color, .. }, _) = program.layer(0);
        (color.equation, color.src) == (state.equation, state.src)
    };
    formulas.filter(|member| matches!(member.spec.kind, Kind::Blend(program) if shares(program))).collect()
}

fn judge(
    groups: &[Vec<Member>],
    target: TargetFormat,
    rules: Rules,
    cases: u64,
    stop: &Stop,
) -> Result<Report, DeviceError> {
    let options = Options { stop: stop.clone(), ..options(target, cases)? };
    let mut subjects = [Subject::faulty(rules)];
    let mut report = options.report(&subjects);
    for group in groups {
        let members: Vec<&Member> = group.iter().collect();
        // As many values as a run has where a group has few states.
        let cases = cases.max(4096 / members.len() as u64);
        let selected: Vec<Selected> =
            (0..members.len()).map(|place| Selected::whole(place, Random::First(cases))).collect();
        run_group(&members, &selected, &mut subjects, &options, &mut report, &mut Silent)?;
    }
    Ok(report)
}

fn row(
    fault: &'static str,
    target: TargetFormat,
    report: &Report,
    finding: impl FnOnce(&[Group]) -> UnitFinding,
) -> UnitRow {
    let mut said: Vec<String> = vec![];
    for group in &report.groups {
        let problems = group.problems.iter().map(ToString::to_string);
        let all = problems.chain(group.diagnosis.iter().map(ToString::to_string));
        said.extend(all.map(|text| format!("{}: {text}", group.id)));
    }
    UnitRow {
        fault: fault.into(),
        target: target.name().into(),
        finding: finding(&report.groups),
        verdicts: report.groups.iter().map(|group| group.totals.verdicts).sum(),
        failed: report.groups.iter().map(|group| group.totals.failed).sum(),
        said,
    }
}

/// A wrong store must be named by the verdict on each group that has enough values to tell; any fault by each group that it
/// fails values in.
fn finding(fault: &UnitFault, groups: &[Group]) -> UnitFinding {
    let is_found = |group: &Group| group.totals.failed > 0 || !group.problems.is_empty();
    let is_store = fault.rules.store != Store::Nearest;
    let says = format!("as if {}", fault.says);
    let is_named = |group: &Group| {
        let is_stored = |one: &Problem| one.store.as_deref() == Some(fault.rules.store.name());
        let by_store = is_store && group.problems.iter().any(is_stored);
        by_store || group.diagnosis.iter().flat_map(|found| &found.explanations).any(|one| one.says == says)
    };
    let throughout = fault.rules.stores_wrong_throughout();
    // What wrong stores come to over several layers has no name.
    let is_chain = |group: &Group| is_store && group.id == "blend/layers";
    let must_show = |group: &&Group| !is_chain(group) && (is_found(group) || (throughout && group.store.is_some()));
    if !groups.iter().any(is_found) {
        UnitFinding::Survived
    } else if groups.iter().filter(must_show).all(is_named) {
        UnitFinding::Named
    } else {
        UnitFinding::Caught
    }
}
