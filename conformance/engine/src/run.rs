//! The runner: draws cases, has every subject evaluate them, computes what is legal meanwhile, and judges.
//!
//! Work goes group by group and chunk by chunk, so that memory stays flat however many cases there are. A thread of its own draws the
//! chunks and works out what is legal, ahead of the subjects (`supply.rs`).

use crate::ask_again::ask_again;
use crate::blend_unit;
use crate::device::DeviceError;
use crate::in_turn::{InTurn, Outcome};
use crate::options::Options;
use crate::renderer::AskedRenderer;
use crate::scout;
use crate::selection::Selection;
use crate::special::verdict::Table;
use crate::subject::Subject;
use crate::supply::{RowGroup, Supply};
use crate::turn::{Turn, in_order_of_devices, turns};
use crate::under_way::is_over;
use crate::witness;
use crate::{special, stability};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::cases::blend;
use lightmeter_catalogue::scene::select::Chosen;
use lightmeter_catalogue::select::{Selected, Shard};
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::{BlendPromise, Report};
use lightmeter_judge::blend_unit::policy::{InterfacePromise, PROMISES};
use lightmeter_judge::stability::UNSTABLE;
use lightmeter_scene::blend::Equation;
use std::time::Instant;

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
    let mut rows: Vec<RowGroup<'_>> =
        turns.iter().filter_map(|turn| RowGroup::of(turn, catalogue, is_asked, lacks)).collect();
    scout::choose(&mut rows, subjects);
    std::thread::scope(|scope| -> Result<(), DeviceError> {
        if let Some(read) = subjects.iter().find_map(|subject| subject.device()?.read_ahead(&options.code)) {
            let firsts = rows.iter().map(|group| group.members()[0]);
            scope.spawn(move || firsts.take_while(|_| !options.stop.is_set()).for_each(read));
        }
        let supply = Supply::start(scope, &rows, options);
        let scouted = scout::scout(&rows, subjects, options, &mut report, observer)?;
        let is_ended = report.interrupted.is_some();
        for &deviation in selection.deviations.iter().filter(|_| !is_ended) {
            witness::ask(deviation, &selection.catalogue, subjects, options, &mut report)?;
        }
        let in_turn = InTurn::new(selection, supply, subjects, (options, scouted), &mut report, observer);
        let turns = if is_ended { &[][..] } else { &turns };
        let Outcome { mut judged, noted } = in_turn.judge_all(turns, &rows)?;
        if report.interrupted.is_none() {
            let result = ask_again(selection, (&noted, &rows), subjects, options, &mut report, observer);
            is_over(result, "what is asked again", options, &mut report)?;
        }
        judged.sort_by_key(|(place, ..)| *place);
        for (_, groups, failures) in judged {
            report.groups.extend(groups);
            report.failures.extend(failures);
        }
        Ok(())
    })?;
    report.sum_up();
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
        in_order_of_devices(&mut turns, &selection.catalogue);
    }
    turns
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
