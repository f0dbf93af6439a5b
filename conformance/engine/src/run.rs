//! The runner: draws cases, has every subject evaluate them, computes what is legal meanwhile, and judges.
//!
//! Work goes group by group and chunk by chunk, so that memory stays flat however many cases there are. A thread of its own draws the
//! chunks and works out what is legal, ahead of the subjects (`supply.rs`).

use crate::ask_again::{Noted, ask_again};
use crate::blend_unit;
use crate::blend_unit::run::NotedPixels;
use crate::device::DeviceError;
use crate::expected::expect_problems;
use crate::image;
use crate::options::Options;
use crate::renderer::AskedRenderer;
use crate::row_run::{Asked, CompiledGroups, RowRun};
use crate::scout;
use crate::selection::Selection;
use crate::special::verdict::Table;
use crate::subject::{Compiled, Subject};
use crate::supply::{RowGroup, Supply};
use crate::turn::{Turn, not_asked, scene_of, turns};
use crate::under_way::{is_over, tell};
use crate::witness;
use crate::{special, stability};
use lightmeter_catalogue::cases::blend;
use lightmeter_catalogue::cases::{Kind, Stage};
use lightmeter_catalogue::scene::select::Chosen;
use lightmeter_catalogue::select::{Member, Selected, Shard};
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::run::{BlendPromise, Failure, Group, Report};
use lightmeter_judge::blend_unit::policy::{InterfacePromise, PROMISES};
use lightmeter_judge::stability::UNSTABLE;
use lightmeter_scene::blend::Equation;
use std::time::Instant;

/// Failing cases of each formula that are asked once more.
const MOST_AGAIN: usize = 1024;

/// Runs what the options select on every subject. Where a device fails, what was judged until then is the report, which says
/// what was under way. Renderers that are asked case by case are asked all there is for them, and are judged by themselves.
///
/// # Errors
/// Where a shader is invalid, or a device fails before anything ran.
pub fn run(subjects: &mut [Subject], options: &Options, observer: &mut dyn Observer) -> Result<Report, DeviceError> {
    let selection = selection_of(subjects, options);
    run_selection(&selection, subjects, options, observer)
}

/// What the options select for the subjects: of renderers, what they declare besides formulas and scenes.
fn selection_of(subjects: &[Subject], options: &Options) -> Selection {
    let asked: Vec<&dyn AskedRenderer> = subjects.iter().filter_map(Subject::asked).collect();
    if asked.len() < subjects.len() {
        return Selection::of(options);
    }
    let mut selection = Selection::of_renderer(options);
    let catalogue = &selection.catalogue;
    let is_declared = |id: &str| asked.iter().all(|renderer| renderer.lacks(id).is_none());
    selection.blended.retain(|chosen| is_declared(&catalogue[chosen.member].spec.id));
    if asked.iter().all(|renderer| renderer.asks_special()) {
        selection.tables = special::verdict::select(&options.filter, options.shard);
    }
    selection
}

/// Runs a selection, or a part of one, on every subject. Where a device fails, what was judged until then is the report, which
/// says what was under way.
///
/// # Errors
/// Where a shader is invalid, or a device fails before anything ran.
pub fn run_selection(
    selection: &Selection,
    subjects: &mut [Subject],
    options: &Options,
    observer: &mut dyn Observer,
) -> Result<Report, DeviceError> {
    let started = Instant::now();
    observer.see(&Event::Begun(work(selection, subjects, options)));
    let mut report = options.report(subjects);
    let turns = turns_in_order(selection, subjects);
    let lacks = |id: &str| subjects.iter().filter_map(Subject::asked).any(|renderer| renderer.lacks(id).is_some());
    let (catalogue, is_asked) = (&selection.catalogue, is_asked(subjects));
    let rows: Vec<RowGroup<'_>> =
        turns.iter().filter_map(|turn| RowGroup::of(turn, catalogue, is_asked, lacks)).collect();
    std::thread::scope(|scope| -> Result<(), DeviceError> {
        if let Some(read) = subjects.iter().find_map(|subject| subject.device()?.read_ahead(&options.code)) {
            let firsts = rows.iter().map(|group| group.members()[0]);
            scope.spawn(move || firsts.take_while(|_| !options.stop.is_set()).for_each(read));
        }
        let supply = Supply::start(scope, &rows, options);
        let Some(compiled) = scout::scout(selection, subjects, options, &mut report, observer)? else { return Ok(()) };
        for &deviation in &selection.deviations {
            witness::ask(deviation, &selection.catalogue, subjects, options, &mut report)?;
        }
        let ahead = Ahead { turns: &turns, rows: &rows, supply };
        judge_in_turn(selection, ahead, subjects, options, compiled, &mut report, observer)
    })?;
    for group in &report.groups {
        report.totals.add(&group.totals);
    }
    report.totals.unexpected_passes +=
        report.deviations.iter().filter(|deviation| !deviation.still_needed).count() as u64;
    if options.shard == Shard::WHOLE {
        report.totals.unexpected_passes += report.passing_unexpectedly().count() as u64;
    }
    report.aliases = blend::aliases()
        .filter(|(alias, canonical)| options.filter.selects(alias) || options.filter.selects(canonical))
        .count() as u64;
    report.routes = routes(&report);
    if !report.special.is_empty() {
        let told = |promise: &InterfacePromise| BlendPromise {
            interface: promise.interface.into(),
            says: promise.says.into(),
        };
        report.blend_promises = PROMISES.iter().map(told).collect();
    }
    report.renderer = subjects.iter_mut().find_map(|subject| subject.asked_mut()).map(|renderer| renderer.used());
    if !report.stability.is_empty() {
        report.unstable_beyond = Some(UNSTABLE);
        report.stable_forms = stability::stable_forms(&selection.catalogue);
    }
    report.seconds = started.elapsed().as_secs_f64();
    Ok(report)
}

/// Whether a renderer is asked, case by case.
fn is_asked(subjects: &[Subject]) -> bool {
    subjects.iter().any(|subject| subject.asked().is_some())
}

/// All that is judged, in the order in which it is, each with its place in the order of reports.
fn turns_in_order<'a>(selection: &'a Selection, subjects: &[Subject]) -> Vec<(usize, Turn<'a>)> {
    let mut turns: Vec<(usize, Turn<'_>)> = turns(selection).into_iter().enumerate().collect();
    if !is_asked(subjects) {
        turns.sort_by_key(|(_, turn)| turn.rank(&selection.catalogue));
    }
    turns
}

/// What is to be judged, and the chunks of its formulas, which are made ahead.
struct Ahead<'a> {
    turns: &'a [(usize, Turn<'a>)],
    rows: &'a [RowGroup<'a>],
    supply: Supply<'a>,
}

/// Judges one after the other, until a device fails or the run is stopped. In the report all stands in the order of reports.
fn judge_in_turn(
    selection: &Selection,
    ahead: Ahead<'_>,
    subjects: &mut [Subject],
    options: &Options,
    mut compiled: CompiledGroups,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<(), DeviceError> {
    let catalogue = &selection.catalogue;
    let is_asked = is_asked(subjects);
    let mut judged: Vec<(usize, Vec<Group>, Vec<Failure>)> = vec![];
    let mut noted: Vec<(Turn<'_>, Noted)> = vec![];
    for &(place, turn) in ahead.turns {
        let id = turn.id(selection);
        observer.see(&Event::Group(&id));
        let result = match turn {
            Turn::Table(table) => judge_table(table, subjects, options, report, observer),
            Turn::Formulas(group) => {
                let rows = ahead.rows.iter().find(|rows| rows.turn() == place).map(|rows| (rows, &ahead.supply));
                let compiled = compiled.remove(&id);
                judge_group(catalogue, (group, rows), subjects, (options, compiled), report, observer)
            }
            Turn::Blended(group) => {
                let members: Vec<&Member> = group.iter().map(|chosen| &catalogue[chosen.member]).collect();
                blend_unit::run::run_group(&members, group, subjects, options, report, observer).map(Noted::Pixels)
            }
            Turn::Scene(chosen) => {
                let loaded = scene_of(chosen, selection);
                image::run::run_scene(&loaded, chosen, subjects, options, report, observer).map(Noted::Images)
            }
        };
        let result = result.map(|of_turn| noted.push((turn, of_turn)));
        let (mut groups, failures) = (std::mem::take(&mut report.groups), std::mem::take(&mut report.failures));
        expect_problems(&mut groups, &mut report.expectations);
        find_sources(&mut groups, subjects);
        tell(&groups, &failures, false, observer);
        judged.push((place, groups, failures));
        // Of a renderer everything is reported: what it was not asked is missing.
        if is_over(result, &id, options, report)? && !is_asked {
            break;
        }
    }
    drop(ahead.supply);
    if report.interrupted.is_none() {
        let result = ask_again(selection, &noted, subjects, options, report, observer);
        is_over(result, "what is asked again", options, report)?;
    }
    judged.sort_by_key(|(place, ..)| *place);
    for (_, groups, failures) in judged {
        report.groups.extend(groups);
        report.failures.extend(failures);
    }
    Ok(())
}

/// Notes where a renderer's code of each group stands, as far as it says so.
fn find_sources(groups: &mut [Group], subjects: &[Subject]) {
    let Some(renderer) = subjects.iter().find_map(Subject::asked) else { return };
    groups.iter_mut().for_each(|group| group.source = renderer.source(&group.id));
}

/// Cases that are to be judged, for the progress: those of a formula once for its stages that take rows, and once for each
/// target of each blend unit; results of tables and pixels of scenes on each subject.
fn work(selection: &Selection, subjects: &[Subject], options: &Options) -> u64 {
    if let Some(renderer) = subjects.iter().find_map(Subject::asked) {
        let count = |all: &[Selected]| all.iter().map(Selected::count).sum::<u64>();
        let targets = options.targets.iter().filter(|target| renderer.targets().contains(target)).count() as u64;
        let pixels = targets * count(&selection.blended);
        let probes = selection.tables.iter().map(|table| table.functions().count() as u64).sum::<u64>();
        return options.runs * (count(&selection.formulas) + selection.scenes.len() as u64) + pixels + probes;
    }
    let of_formula = |chosen: &Selected| {
        let member = &selection.catalogue[chosen.member];
        let unit = match member.spec.kind {
            Kind::Blend(_) => blend_unit::run::targets_of(member, &options.targets).len() * subjects.len(),
            _ => 0,
        };
        let rows = if member.spec.row_stages().is_empty() { 0 } else { chosen.rows(member).count() };
        chosen.count() * unit as u64 + rows
    };
    let formulas: u64 = selection.formulas.iter().map(of_formula).sum();
    let others: u64 = selection.tables.iter().map(Table::work).chain(selection.scenes.iter().map(Chosen::work)).sum();
    formulas + others * subjects.len() as u64
}

/// Judges a table of special values.
fn judge_table(
    table: &Table,
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<Noted, DeviceError> {
    if let [subject] = subjects
        && subject.asked().is_some()
    {
        return special::asked::run_table(table, subject, options, report, observer).map(Noted::Probes);
    }
    special::verdict::run_table(table, subjects, options, report, observer).map(|()| Noted::Nothing)
}

/// Judges a group in the blend unit, if that draws it, and in the stages that take rows, which may be compiled already.
fn judge_group<'a>(
    catalogue: &[Member],
    (group, ahead): (&[Selected], Option<(&'a RowGroup<'a>, &Supply<'a>)>),
    subjects: &mut [Subject],
    (options, compiled): (&Options, Option<Vec<Compiled>>),
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<Noted, DeviceError> {
    let members: Vec<&Member> = group.iter().map(|chosen| &catalogue[chosen.member]).collect();
    if let [subject] = subjects
        && let Some(renderer) = subject.asked()
    {
        if let Some(reason) = renderer.lacks(&members[0].spec.id) {
            report.groups.push(not_asked(
                members[0].spec.id.clone(),
                Stage::Answer.name(),
                group[0].count(),
                reason,
                subject,
            ));
            return Ok(Noted::Nothing);
        }
        let (rows, supply) = ahead.expect("it is made ahead where the renderer does not lack it");
        return run_rows(rows, supply, subjects, (options, compiled), report, observer);
    }
    let mut pixels = NotedPixels::default();
    if matches!(members[0].spec.kind, Kind::Blend(_)) {
        pixels = blend_unit::run::run_group(&members, group, subjects, options, report, observer)?;
    }
    let Some((rows, supply)) = ahead.filter(|_| !options.stop.is_set()) else { return Ok(Noted::Pixels(pixels)) };
    let first = report.groups.len();
    let noted = run_rows(rows, supply, subjects, (options, compiled), report, observer)?;
    for (member, chosen) in members.iter().zip(group) {
        stability::examine(member, &chosen.hard, subjects, options, report)?;
    }
    for group in &mut report.groups[first..] {
        if let Some(unstable) = stability::problem(&report.stability, &group.id, &group.adapter, &group.stage) {
            group.problem =
                Some(group.problem.take().map_or(unstable.clone(), |problem| format!("{problem}; {unstable}")));
            group.totals.failed_groups = 1;
        }
    }
    Ok(match noted {
        Noted::Rows(rows) => Noted::Both(pixels, rows),
        _ => Noted::Pixels(pixels),
    })
}

/// How the distinct states of the 15 × 15 × 5 reached a blend unit: states by route, on any adapter and target.
pub(crate) fn routes(report: &Report) -> serde_json::Map<String, serde_json::Value> {
    let mut routes = std::collections::BTreeMap::<&str, std::collections::BTreeSet<&str>>::new();
    let is_state = |id: &str| id.split('/').nth(1).is_some_and(|name| Equation::ALL.iter().any(|e| e.name() == name));
    let on_device =
        |name: &str| report.adapters.iter().any(|adapter| adapter.name == name && adapter.backend != "embedded");
    for state in report.blend_states.iter().filter(|state| state.is_drawn() && on_device(&state.adapter)) {
        if is_state(&state.id) {
            routes.entry(&state.route).or_default().insert(&state.id);
        }
    }
    routes.into_iter().map(|(route, states)| (route.into(), states.len().into())).collect()
}

/// Judges cases of formulas of one group, chunk by chunk, in the stages that take rows.
fn run_rows<'a>(
    group: &'a RowGroup<'a>,
    supply: &Supply<'a>,
    subjects: &mut [Subject],
    (options, compiled): (&Options, Option<Vec<Compiled>>),
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<Noted, DeviceError> {
    let clock = Instant::now();
    let members = group.members();
    let compiled = compiled.map_or_else(|| RowRun::compile(members[0], subjects, options), Ok)?;
    let mut run = RowRun::new(members, compiled, Asked::All);
    if options.runs > 1 {
        run = run.noting();
    }
    report.timing.compile += clock.elapsed().as_secs_f64();
    let is_asked = is_asked(subjects);
    for next in group.chunks() {
        if !is_asked && options.stop.is_set() {
            break;
        }
        if is_asked && subjects.iter().all(|subject| subject.asked().is_some_and(AskedRenderer::is_over)) {
            run.leave_out(&next);
            continue;
        }
        let ready = supply.next(group.turn());
        report.timing.generate += ready.drawing;
        report.timing.reference += ready.evaluating;
        let begun = run.start(ready.chunk, subjects, report);
        if let Err(error) = begun.and_then(|begun| run.judge(begun, subjects, options, report, observer)) {
            // What was judged until then stays.
            run.finish(subjects, options, report);
            return Err(error);
        }
        if !is_asked {
            observer.see(&Event::Advanced(next.len() as u64));
        }
    }
    let noted = match run.noted() {
        Some(digests) => Noted::Rows(digests),
        None if is_asked => Noted::Failing(run.failing(MOST_AGAIN)),
        None => Noted::Nothing,
    };
    run.finish(subjects, options, report);
    Ok(noted)
}
