//! The reports of a run's shards, joined: what the whole run would have reported, but for times. Counts are added. What explains failures, and
//! what is wrong with all values of a group together, is worked out once more, from the samples that the shards kept.

mod differences;
mod samples;

use crate::expected::{expect_nothing, expect_problems};
use crate::run::routes;
use differences::differences;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::scene_id;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_catalogue::special::Class;
use lightmeter_document::Number;
use lightmeter_document::by_case::{CaseCounts, RendererUse};
use lightmeter_document::report::{BlendState, DeviationUse, Failure, Group, Report};
use lightmeter_judge::cases::joined;
use lightmeter_judge::diagnose::Diagnose;
use lightmeter_judge::tally::KEPT_FAILURES;
use lightmeter_judge::{is_worse, telling, worse};
use lightmeter_scene::target::TargetFormat;
use samples::Kept;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::PathBuf;

/// Missing shards that are named.
const MOST_NAMED: usize = 8;

/// Why reports make no whole.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct NoWhole(pub String);

/// Joins the reports of all shards of a run.
///
/// # Errors
/// Where a shard is missing or there twice, where they are of different runs, and where one was interrupted.
pub fn merge(mut parts: Vec<(PathBuf, Report)>, diagnose: &dyn Diagnose) -> Result<Report, NoWhole> {
    check(&parts)?;
    // In their order, whatever the order in which they are given.
    parts.sort_by_key(|(_, report)| shard_of(report).map(|(index, _)| index));
    let mut kept = Kept::default();
    let mut parts = parts.into_iter().map(|(_, mut report)| {
        kept.take(&mut report);
        expect_nothing(&mut report);
        report
    });
    let Some(mut whole) = parts.next() else { unreachable!("a run has a shard at least") };
    let catalogue = samples::catalogue(&whole);
    let order = Order::new(&catalogue);
    for part in parts {
        add_places(&mut whole, &part);
        add(&mut whole, part, &order);
    }
    order.sort(&mut whole);
    kept.diagnose(&mut whole, catalogue, diagnose)?;
    expect_problems(&mut whole.groups, &mut whole.expectations);
    whole.groups.iter_mut().for_each(|group| group.totals.failed_groups = u64::from(!group.problems.is_empty()));
    whole.sum_up();
    let not_needed = whole.deviations.iter().filter(|deviation| !deviation.still_needed).count();
    if let Some(compared_by) = &mut whole.compared_by {
        compared_by.shard = None;
    }
    let pass = whole.passing_unexpectedly().count();
    whole.totals.unexpected_passes += (not_needed + pass) as u64;
    whole.routes = routes(&whole);
    sort_failures(&mut whole, &order);
    warn_of_unknown_builds(&mut whole);
    Ok(whole)
}

/// Shards of a renderer that does not tell its code from other code of the same version may be of two.
fn warn_of_unknown_builds(whole: &mut Report) {
    let Some(renderer) = whole.renderer.as_mut().filter(|renderer| !renderer.declares.contains_key("build")) else {
        return;
    };
    renderer.warnings.push(
        "whether all shards judged the same code is not known: the renderer's hello has no `build`, such as a commit"
            .into(),
    );
}

/// Adds the lines of a shader in which a part's mistakes are made.
fn add_places(whole: &mut Report, part: &Report) {
    let (Some(whole), Some(part)) = (&mut whole.shader, &part.shader) else { return };
    for (whole, part) in whole.formulas.iter_mut().zip(&part.formulas) {
        for place in &part.mistakes {
            if !whole.mistakes.contains(place) {
                whole.mistakes.push(place.clone());
            }
        }
    }
}

/// Checks that the parts are all shards of one run.
fn check(parts: &[(PathBuf, Report)]) -> Result<(), NoWhole> {
    let no_whole = |message: String| Err(NoWhole(message));
    let [(first_path, _), ..] = parts else {
        return no_whole("there is nothing to merge; expected the results of each shard".into());
    };
    let mut seen: BTreeMap<u64, &PathBuf> = BTreeMap::new();
    let mut count = None;
    are_of_one_run(parts)?;
    for (path, part) in parts {
        let (a, b) = (first_path.display(), path.display());
        let shard = part.compared_by.as_ref().and_then(|by| by.shard.as_deref()).unwrap_or_default();
        let Some((index, shards)) = shard_of(part) else {
            return no_whole(format!("{b}: `{shard}` is no shard; expected I/N"));
        };
        let of = *count.get_or_insert(shards);
        if of != shards {
            return no_whole(format!(
                "{a} is one of {of} shards and {b} one of {shards}; expected shards of the same number"
            ));
        }
        if let Some(twice) = seen.insert(index, path) {
            if twice == path {
                return no_whole(format!("{b} overlaps itself: it is given twice, as shard {shard}"));
            }
            return no_whole(format!("{} and {b} overlap: both are shard {shard}", twice.display()));
        }
    }
    let count = count.unwrap_or(1);
    let is_missing = |index: &u64| !seen.contains_key(index);
    let missing: Vec<String> =
        (1..=count).filter(is_missing).map(|index| format!("{index}/{count}")).take(MOST_NAMED).collect();
    if missing.is_empty() { Ok(()) } else { no_whole(format!("there is no result of shard {}", missing.join(", "))) }
}

/// Which shard of how many a report is.
fn shard_of(report: &Report) -> Option<(u64, u64)> {
    let (index, count) = report.compared_by.as_ref()?.shard.as_deref()?.split_once('/')?;
    let (index, count) = (index.parse().ok()?, count.parse().ok()?);
    (1..=count).contains(&index).then_some((index, count))
}

/// Checks that the parts are finished shards, and that all that must be the same in shards of one run is.
fn are_of_one_run(parts: &[(PathBuf, Report)]) -> Result<(), NoWhole> {
    let no_whole = |message: String| Err(NoWhole(message));
    for (path, part) in parts {
        if part.compared_by.as_ref().is_none_or(|by| by.shard.is_none()) {
            return no_whole(format!(
                "{} is no shard of a run; expected the JSON of `run` or `gate` with --shard I/N",
                path.display()
            ));
        }
        if let Some(interrupted) = &part.interrupted {
            return no_whole(format!("{} is not finished: {}", path.display(), interrupted.message));
        }
    }
    for (path, part) in parts {
        if let Some(what) = edited(part) {
            return no_whole(format!("{}: {what}: it was changed by hand", path.display()));
        }
    }
    match differences(parts) {
        None => Ok(()),
        Some(fields) => {
            no_whole(format!("the files are of different runs; expected the same in all of them:\n{fields}"))
        }
    }
}

/// What in a report does not fit the rest of it; `None` where nothing is amiss.
fn edited(part: &Report) -> Option<String> {
    let mut names = BTreeSet::new();
    if let Some(twice) = part.groups.iter().find(|group| !names.insert(key(group))) {
        return Some(format!("{} stands there twice", twice.name()));
    }
    let mut again = part.clone();
    again.sum_up();
    again.totals.unexpected_passes = part.totals.unexpected_passes;
    (again.totals != part.totals || again.by_case != part.by_case)
        .then(|| "its totals are not the sums of its groups' counts".into())
}

/// The order of reports, by the ids of groups, formulas, hard cases and scenes.
#[derive(Default)]
struct Order {
    places: HashMap<String, usize>,
    /// The place of the formula that a hard case is of, whose id the case's need not begin with.
    of_hard: HashMap<String, usize>,
}

/// The place of a case in its group: that of its formula, then hard ones, those near them, those at boundaries, random ones, each by its path and number.
type CasePlace = (usize, u8, usize, String, u64);

impl Order {
    fn new(catalogue: &[Member]) -> Self {
        let mut order = Self::default();
        Class::ALL.into_iter().for_each(|class| order.push(format!("special/{}", class.name())));
        for member in catalogue {
            order.push(member.spec.group().to_owned());
            order.push(member.spec.id.clone());
            let formula = order.of(&member.spec.id);
            for id in (0..member.spec.hard.len()).map(|place| member.case_id(CaseRef::Hard(place))) {
                order.of_hard.entry(id.clone()).or_insert(formula);
                order.push(id);
            }
        }
        (0..SCENES.len()).for_each(|place| order.push(scene_id(place)));
        order
    }

    fn push(&mut self, id: String) {
        let place = self.places.len();
        self.places.entry(id).or_insert(place);
    }

    /// The place of an id; of one that is not in the catalogue, as a sampled state, behind all others.
    fn of(&self, id: &str) -> usize {
        self.places.get(id).copied().unwrap_or(usize::MAX)
    }

    fn of_case(&self, id: &str) -> CasePlace {
        let number = id.rsplit_once('/').and_then(|(path, number)| Some((path.to_owned(), number.parse().ok()?)));
        let (path, number) = number.unwrap_or_else(|| (id.to_owned(), 0));
        let of_hard = |hard: &str| self.of_hard.get(hard).copied().unwrap_or(usize::MAX);
        let formula = |kind: &str| self.of(path.strip_suffix(kind).unwrap_or(&path));
        // A hard case may have any name, that of those near it, too.
        match path.strip_suffix("/near").filter(|hard| self.of_hard.contains_key(*hard)) {
            Some(hard) => (of_hard(hard), 1, self.of(hard), path.clone(), number),
            None if id.contains("/hard/") => (of_hard(id), 0, self.of(id), path, number),
            None if id.contains("/boundary/") => (formula("/boundary"), 2, 0, path, number),
            None => (formula("/random"), 3, 0, path, number),
        }
    }

    /// The place of the group of an id.
    fn of_group(&self, id: &str) -> usize {
        let ends = id.match_indices('/').map(|(at, _)| at).chain([id.len()]);
        ends.filter_map(|end| self.places.get(&id[..end]).copied()).next().unwrap_or(usize::MAX)
    }

    /// Puts a report in order: tables of special values, formulas, blend states on the targets of renderers, scenes.
    fn sort(&self, report: &mut Report) {
        report.groups.sort_by_key(|group| {
            let is_scene = group.id.starts_with("scene/");
            let is_asked_on_target = group.stage == "answer" && group.target.is_some() && !is_scene;
            (is_scene, is_asked_on_target, self.of(&group.id))
        });
        report
            .stability
            .sort_by_key(|one| (self.of_group(&one.id), one.adapter.clone(), one.stage.to_string(), self.of(&one.id)));
        let target = |name: &str| TargetFormat::ALL.iter().position(|format| format.name() == name);
        report.blend_states.sort_by_key(|state| {
            (self.of_group(&state.id), state.adapter.clone(), target(&state.target), self.of(&state.id))
        });
        report
            .special
            .sort_by_key(|one| (self.of_group(&one.id), one.adapter.clone(), target(&one.target), self.of(&one.id)));
    }
}

/// Id, adapter, stage and target.
type GroupKey = (String, String, String, Option<String>);

/// What tells a group from all others.
fn key(group: &Group) -> GroupKey {
    let target = group.target.as_ref().map(ToString::to_string);
    (group.id.clone(), group.adapter.clone(), group.stage.to_string(), target)
}

/// Adds a part to the whole.
fn add(whole: &mut Report, part: Report, order: &Order) {
    // What stands before a group in a part stands before it in the whole.
    let mut after = 0;
    for group in part.groups {
        match whole.groups.iter().position(|known| key(known) == key(&group)) {
            Some(place) => {
                add_group(&mut whole.groups[place], group, order);
                after = place + 1;
            }
            None => {
                whole.groups.insert(after, group);
                after += 1;
            }
        }
    }
    add_states(whole, part.blend_states);
    add_deviations(whole, part.deviations);
    for (known, more) in whole.expectations.iter_mut().zip(part.expectations) {
        known.failed += more.failed;
        known.passed += more.passed;
    }
    whole.special.extend(part.special);
    whole.stability.extend(part.stability);
    whole.stable_costs.extend(part.stable_costs);
    whole.failures.extend(part.failures);
    whole.unstable += part.unstable;
    whole.unstable_cases.extend(part.unstable_cases);
    whole.regressions.extend(part.regressions);
    if let (Some(known), Some(more)) = (&mut whole.renderer, part.renderer) {
        add_renderer(known, more);
    }
    whole.timing.add(&part.timing);
    whole.seconds += part.seconds;
    if whole.blend_promises.is_empty() {
        whole.blend_promises = part.blend_promises;
    }
    whole.unstable_beyond = whole.unstable_beyond.or(part.unstable_beyond);
    if whole.stable_forms.is_empty() {
        whole.stable_forms = part.stable_forms;
    }
}

fn add_states(whole: &mut Report, states: Vec<BlendState>) {
    for state in states {
        let is_it = |known: &&mut BlendState| {
            (&known.id, &known.adapter, &known.target, &known.route)
                == (&state.id, &state.adapter, &state.target, &state.route)
        };
        match whole.blend_states.iter_mut().find(is_it) {
            Some(known) => {
                known.cases += state.cases;
                known.failed += state.failed;
                known.error_max = Number(worse(known.error_max.0, state.error_max.0));
                if let Some(tiers) = &state.tiers {
                    known.tiers.get_or_insert_default().add(tiers);
                }
            }
            None => whole.blend_states.push(state),
        }
    }
}

fn add_deviations(whole: &mut Report, deviations: Vec<DeviationUse>) {
    for deviation in deviations {
        let is_it = |known: &&mut DeviationUse| (&known.name, &known.adapter) == (&deviation.name, &deviation.adapter);
        match whole.deviations.iter_mut().find(is_it) {
            Some(known) => {
                known.excused += deviation.excused;
                known.still_needed &= deviation.still_needed;
            }
            None => whole.deviations.push(deviation),
        }
    }
}

fn add_renderer(known: &mut RendererUse, more: RendererUse) {
    known.starts += more.starts;
    let new = more.warnings.into_iter().filter(|warning| !known.warnings.contains(warning)).collect::<Vec<_>>();
    known.warnings.extend(new);
    known.incidents.extend(more.incidents);
    known.expected_incidents.extend(more.expected_incidents);
    known.problems.first.extend(more.problems.first);
    for (kind, count) in more.problems.counts {
        *known.problems.counts.entry(kind).or_default() += count;
    }
}

fn add_group(known: &mut Group, more: Group, order: &Order) {
    known.totals.add(&more.totals);
    known.error_ulp_max = Number(worse(known.error_ulp_max.0, more.error_ulp_max.0));
    let is_worst = is_worse(more.margin_max.0, known.margin_max.0)
        || (more.margin_max == known.margin_max
            && more.worst.as_deref().map(|id| order.of_case(id)) < known.worst.as_deref().map(|id| order.of_case(id)));
    if known.worst.is_none() || (more.worst.is_some() && is_worst) {
        known.worst = more.worst;
        known.worst_answer = more.worst_answer;
    }
    known.margin_max = Number(worse(known.margin_max.0, more.margin_max.0));
    known.seconds += more.seconds;
    if let Some(warm) = more.seconds_warm {
        *known.seconds_warm.get_or_insert(0.0) += warm;
    }
    if let Some(tiers) = &more.tiers {
        known.tiers.get_or_insert_default().add(tiers);
    }
    known.by_case = match (known.by_case.take(), more.by_case) {
        (Some(a), Some(b)) => Some(counts(a, b, &known.id, order)),
        (a, b) => a.or(b),
    };
    known.image = known.image.take().or(more.image);
}

#[expect(clippy::cast_precision_loss, reason = "counts of errors")]
fn counts(a: CaseCounts, b: CaseCounts, group: &str, order: &Order) -> CaseCounts {
    let errors = a.errors + b.errors;
    let mean = (a.error_mean.0 * a.errors as f64 + b.error_mean.0 * b.errors as f64) / errors.max(1) as f64;
    let mut not_passed = a.not_passed;
    for (state, more) in b.not_passed {
        let all = not_passed.remove(&state).unwrap_or_default().into_iter().chain(more);
        not_passed.insert(state, joined(all.collect(), |id| (order.of_case(&whole_id(group, id)), id.to_owned())));
    }
    let reasons: BTreeSet<String> = a.reason.into_iter().chain(b.reason).collect();
    let mut totals = a.totals;
    totals.add(&b.totals);
    CaseCounts {
        totals,
        error_passing: Number(worse(a.error_passing.0, b.error_passing.0)),
        error_mean: Number(mean),
        errors,
        not_passed,
        reason: (!reasons.is_empty()).then(|| reasons.into_iter().collect::<Vec<_>>().join("; ")),
        smallest: a.smallest.or(b.smallest),
    }
}

/// The id of a case of a group, of which a list may have the end alone. A hard case of several formulas has its whole id there.
fn whole_id(group: &str, ending: &str) -> String {
    if ending.contains("/hard/") { ending.to_owned() } else { format!("{group}/{ending}") }
}

/// Puts the failures that are reported in order: of each group the one of the simplest inputs, then the first. Those of a scene, which one shard
/// draws, stay in their order.
fn sort_failures(whole: &mut Report, order: &Order) {
    let known = std::mem::take(&mut whole.failures);
    for group in &mut whole.groups {
        let mut of: Vec<&Failure> = known.iter().filter(|failure| is_of(failure, group)).collect();
        if group.id.starts_with("scene/") {
            whole.failures.extend(of.into_iter().cloned());
            continue;
        }
        of.sort_by_key(|failure| order.of_case(&failure.id));
        if let Some(simplest) = (0..of.len()).min_by_key(|&k| simplicity(of[k])) {
            let simplest = of.remove(simplest);
            of.insert(0, simplest);
        }
        let has_values = |failure: &&&Failure| failure.answer.as_ref().is_none_or(|answer| !answer.value.is_empty());
        if let (Some(first), Some(counts)) = (of.first().filter(has_values), &mut group.by_case) {
            counts.smallest = Some(first.id.clone());
        }
        whole.failures.extend(of.into_iter().take(KEPT_FAILURES).cloned());
    }
}

/// Whether a failure is one of a group's cases.
fn is_of(failure: &Failure, group: &Group) -> bool {
    let place = (&failure.adapter, &failure.stage, &failure.target) == (&group.adapter, &group.stage, &group.target);
    let is_below = failure.id.strip_prefix(&group.id).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
    // A hard case of several formulas has the id of what they have in common.
    let failed = group.by_case.as_ref().and_then(|counts| counts.not_passed.get("failed"));
    place && (is_below || failed.is_some_and(|failed| failed.contains(&failure.id)))
}

/// How simple the inputs of a failure are.
fn simplicity(failure: &Failure) -> u32 {
    let bits = |text: &serde_json::Value| {
        let digits = text.as_str()?.strip_prefix("0x")?;
        u32::from_str_radix(digits, 16).ok().map(f32::from_bits)
    };
    let numbers = failure
        .inputs_hex
        .values()
        .flat_map(|value| value.as_array().map_or(std::slice::from_ref(value), Vec::as_slice));
    let mut inputs: Vec<f32> = numbers.filter_map(bits).collect();
    #[expect(clippy::cast_possible_truncation, reason = "inputs are f32")]
    if let Some(answer) = &failure.answer {
        inputs = answer.inputs.iter().map(|number| number.0 as f32).collect();
    }
    telling(&inputs, !["/hard/", "/boundary/"].iter().any(|kind| failure.id.contains(kind)))
}
