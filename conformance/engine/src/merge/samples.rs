//! What explains the failures of the whole, and what is wrong with its groups: worked out once more, from the samples that the shards kept, by
//! the same functions as in a run.

use super::{GroupKey, NoWhole, key};
use crate::blend_unit::standing::{diagnosed, unpacked_pixels, with_cases};
use crate::diagnosed::GroupRows;
use crate::options::{Adapted, Constant};
use crate::stability;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::cases::blend::{Samples, separate_of};
use lightmeter_catalogue::cases::{Kind, Stage};
use lightmeter_catalogue::select::{CaseRef, Member, alias_members, catalogue_of};
use lightmeter_document::report::{
    Diagnosis, Group, GroupSample, JudgedAs, Problem, ProblemKind, Report, SampledStores, Sentence,
};
use lightmeter_judge::blend_unit::store::{problems, store_of};
use lightmeter_judge::devices::{Known, known};
use lightmeter_judge::diagnose::Diagnose;
use lightmeter_judge::formula::{KEPT_FAILING, evaluated, most_passing};
use lightmeter_judge::kept::KeptRow;
use lightmeter_judge::packed::{BadSample, ReadRows, unpacked};
use lightmeter_judge::sample::Sample;
use lightmeter_judge::tally::problem;
use lightmeter_scene::target::TargetFormat;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// What each shard kept of each group that it judged.
#[derive(Default)]
pub(super) struct Kept(HashMap<GroupKey, Vec<Option<GroupSample>>>);

/// What is the same for all groups.
struct Context<'a> {
    catalogue: Vec<Member>,
    profile: &'static Profile,
    seed: u64,
    diagnose: &'a dyn Diagnose,
}

impl Kept {
    /// Takes the samples of a shard.
    pub(super) fn take(&mut self, part: &mut Report) {
        for group in &mut part.groups {
            self.0.entry(key(group)).or_default().push(group.sample.take());
        }
    }

    /// Works out what explains the failures of each group, and what is wrong with it as a whole.
    pub(super) fn diagnose(
        &self,
        whole: &mut Report,
        catalogue: Vec<Member>,
        diagnose: &dyn Diagnose,
    ) -> Result<(), NoWhole> {
        let Some(profile) = Profile::by_name(&whole.profile) else {
            return Err(NoWhole(format!("there is no profile `{}`", whole.profile)));
        };
        let context = Context { catalogue, profile, seed: whole.seed, diagnose };
        let mut groups = std::mem::take(&mut whole.groups);
        let mut left_out = 0;
        for group in &mut groups {
            let kept = self.0.get(&key(group)).map_or(&[][..], Vec::as_slice);
            let samples: Vec<&GroupSample> = kept.iter().flatten().collect();
            // Scenes and tables of special values keep none, nor does what a renderer was not asked.
            if samples.len() == kept.len() && !samples.is_empty() {
                let told = context.group(group, &samples, whole);
                told.map_err(|error| NoWhole(format!("{}: {error}", group.id)))?;
            } else if kept.len() > 1 && group.totals.verdicts > 0 && !group.id.starts_with("special/") {
                left_out += 1;
                group.diagnosis = None;
                group.problems.clear();
            }
            group.problems.retain(|problem| problem.kind != ProblemKind::Stability);
            group.problems.extend(stability::problem(&whole.stability, &group.id, &group.adapter, &group.stage));
        }
        whole.groups = groups;
        if left_out > 0 {
            let of = if left_out == 1 { "1 group".into() } else { format!("{left_out} groups") };
            whole.notes.push(Sentence::from(format!(
                "not all shards carry samples (`--no-samples`), so that of {of} nothing tells what explains the failures, or what is wrong with \
                 all values together"
            )));
        }
        Ok(())
    }
}

impl Context<'_> {
    /// How many rows of each formula fail, of all shards.
    fn failing(samples: &[&GroupSample], members: &[&Member]) -> Result<BTreeMap<usize, u64>, BadSample> {
        let mut all = BTreeMap::new();
        for sample in samples {
            let failing = sample.failing.iter().fold(0, |sum: u64, count| sum.saturating_add(*count));
            if sample.failing.len() != sample.formulas.len() || failing != sample.wrong.of {
                return Err(BadSample("its counts of failing cases do not add up"));
            }
            for (place, count) in
                places(sample, members).into_iter().zip(&sample.failing).filter(|(_, count)| **count > 0)
            {
                *all.entry(place).or_default() += count;
            }
        }
        Ok(all)
    }

    /// A row that a shard kept, drawn and evaluated again.
    fn row(&self, member: &Member, case: CaseRef, values: Vec<f32>, (stage, known): (Stage, &Known)) -> KeptRow {
        let mut inputs = vec![];
        member.inputs(case, self.seed, &mut inputs);
        evaluated(member, inputs, values, (stage, known, self.profile))
    }

    fn group(&self, group: &mut Group, samples: &[&GroupSample], whole: &Report) -> Result<(), BadSample> {
        let named: BTreeSet<&String> = samples.iter().flat_map(|sample| &sample.formulas).collect();
        let is_of_group = |member: &&Member| member.spec.group() == group.id || member.spec.id == group.id;
        let is_named = |member: &&Member| named.contains(&member.spec.id);
        let members: Vec<&Member> = self.catalogue.iter().filter(is_named).filter(is_of_group).collect();
        if members.len() != named.len() {
            return Err(BadSample("it names a formula that is none of the group's"));
        }
        let Some(first) = members.first() else { return Ok(()) };
        let Some(stage) = Stage::ALL.into_iter().find(|stage| group.stage == stage.name()) else {
            return Err(BadSample("its stage is none that there is"));
        };
        agrees(group, samples)?;
        let random =
            samples.iter().fold((0, 0), |(all, open), sample| (all + sample.random[0], open + sample.random[1]));
        let undecided = problem(random, group.totals.verdicts, group.totals.indeterminate);
        let known = known_of(group, whole);
        if let Some(target) = group.blended_on().and_then(|name| TargetFormat::by_name(name)) {
            if !matches!(first.spec.kind, Kind::Blend(_)) {
                return Err(BadSample("it was not blended, though it has a target"));
            }
            let pixels = read(samples, |sample| unpacked_pixels(sample, &members))?;
            let stores = stores(samples);
            let special = whole.special.iter().filter(|special| {
                group.has_case(&special.id) && special.adapter == group.adapter && special.target == target.name()
            });
            group.problems = problems(special, &stores, &known, target);
            if group.problems.is_empty() {
                group.problems.extend(undecided);
            }
            group.store = store_of(&stores, &known, target).filter(|_| target.is_unorm() && group.totals.cases > 0);
            group.diagnosis =
                pixels.and_then(|pixels| diagnosed(&with_cases(pixels, &members, target, self.profile, self.seed)));
            return Ok(());
        }
        let failing = Self::failing(samples, &members)?;
        let places = |sample: &GroupSample| places(sample, &members);
        let numbered: Vec<(&Member, u64)> = members.iter().map(|member| (*member, member.number)).collect();
        let (most_wrong, most_right) = (KEPT_FAILING, most_passing(first.spec.output_len()));
        let wrong = read(samples, |sample| unpacked(&sample.wrong, &places(sample), &numbered, most_wrong))?;
        let right = read(samples, |sample| unpacked(&sample.right, &places(sample), &numbered, most_right))?;
        let cases = |rows: &Option<ReadRows>| -> BTreeSet<(usize, CaseRef)> {
            rows.iter().flat_map(ReadRows::rows).map(|(place, _)| place).collect()
        };
        if !cases(&wrong).is_disjoint(&cases(&right)) {
            return Err(BadSample("a case is among those that fail and among those that pass"));
        }
        let evaluated = |rows: Option<ReadRows>, most| match rows {
            Some(rows) => rows.with(|(place, case), values| self.row(members[place], case, values, (stage, &known))),
            None => Sample::new(most),
        };
        let (wrong, right) = (evaluated(wrong, most_wrong), evaluated(right, most_right));
        let rows = GroupRows { members: &members, stage, failing: &failing, wrong: &wrong, right: &right };
        let told = rows.told(Some(self.diagnose), &known.granted(self.profile));
        let unjudged = group.by_case.as_ref().map_or(0, |counts| counts.totals.unjudged);
        group.diagnosis = told.diagnosis.map(|found| Diagnosis { unjudged, ..found });
        group.problems = undecided.or(told.systematic).into_iter().collect::<Vec<Problem>>();
        Ok(())
    }
}

/// Checks that samples say no more than the group's own counts do.
fn agrees(group: &Group, samples: &[&GroupSample]) -> Result<(), BadSample> {
    let sum = |of: &dyn Fn(&GroupSample) -> u64| samples.iter().fold(0, |sum: u64, one| sum.saturating_add(of(one)));
    let (verdicts, open) = (sum(&|one| one.random[0]), sum(&|one| one.random[1]));
    let (wrong, right) = (sum(&|one| one.wrong.of), sum(&|one| one.right.of));
    let totals = &group.totals;
    let is_too_much = verdicts > totals.verdicts
        || open > totals.indeterminate.min(verdicts)
        || wrong > totals.failed.saturating_add(totals.expected_failures)
        || wrong.saturating_add(right) > totals.cases;
    let is_named_twice = |one: &&GroupSample| {
        let mut names: Vec<&String> = one.formulas.iter().collect();
        names.sort_unstable();
        names.windows(2).any(|pair| pair[0] == pair[1])
    };
    if samples.iter().any(is_named_twice) {
        return Err(BadSample("it names a formula twice"));
    }
    if is_too_much { Err(BadSample("its counts are not those of the group")) } else { Ok(()) }
}

/// The places of a sample's formulas among the whole's.
fn places(sample: &GroupSample, members: &[&Member]) -> Vec<usize> {
    let place = |id: &String| members.iter().position(|member| member.spec.id == *id).unwrap_or(usize::MAX);
    sample.formulas.iter().map(place).collect()
}

/// The rows of all shards' samples, of which no two have the same case; `None` where there is no sample.
fn read(
    samples: &[&GroupSample],
    unpacked: impl Fn(&GroupSample) -> Result<ReadRows, BadSample>,
) -> Result<Option<ReadRows>, BadSample> {
    let mut all: Option<ReadRows> = None;
    for sample in samples {
        let rows = unpacked(sample)?;
        match &mut all {
            Some(all) => all.add(rows),
            None => all = Some(rows),
        }
    }
    let is_twice = |all: &ReadRows| all.rows().windows(2).any(|pair| pair[0].0 == pair[1].0);
    match all.as_ref().is_some_and(is_twice) {
        true => Err(BadSample("a case is in the samples of two shards")),
        false => Ok(all),
    }
}

/// What is known of the subject of a group.
fn known_of(group: &Group, whole: &Report) -> Known {
    let subject = whole.adapters.iter().find(|adapter| adapter.name == group.adapter);
    match subject.filter(|subject| matches!(&*subject.backend, "vulkan" | "gl")) {
        Some(subject) => known(&subject.device, &subject.driver),
        None => Known::default(),
    }
}

/// What the values of all shards say of how they are stored.
fn stores(samples: &[&GroupSample]) -> SampledStores {
    let mut all = SampledStores::default();
    for stores in samples.iter().filter_map(|sample| sample.stores.as_ref()) {
        all.components.iter_mut().zip(&stores.components).for_each(|(counts, more)| counts.add(more));
        all.model = [all.model[0] + stores.model[0], all.model[1] + stores.model[1]];
        all.departure = all.departure.take().or_else(|| stores.departure.clone());
        for state in &stores.states {
            match all.states.iter_mut().find(|known| (&known.id, &known.route) == (&state.id, &state.route)) {
                Some(known) => {
                    known.components.iter_mut().zip(&state.components).for_each(|(counts, more)| counts.add(more));
                }
                None => all.states.push(state.clone()),
            }
        }
    }
    all
}

/// The formulas as they were judged: with those of sampled blend states, of a renderer with aliases, of a shader with what it does not take.
pub(super) fn catalogue(whole: &Report) -> Vec<Member> {
    let by = whole.compared_by.clone().unwrap_or_default();
    let named = by.choice.filter.iter().filter_map(|glob| separate_of(glob)).collect();
    let samples = Samples { seed: whole.seed, count: by.separate.unwrap_or_default(), named };
    let mut catalogue = catalogue_of(&samples);
    if whole.renderer.is_some() {
        catalogue.extend(alias_members());
    }
    let judged: Vec<Adapted> = whole.shader.iter().flat_map(|shader| &shader.formulas).map(adapted).collect();
    let applied = |member: Member| match judged.iter().find(|adapted| adapted.id == member.spec.id) {
        Some(adapted) => adapted.applied(member),
        None => member,
    };
    catalogue.into_iter().map(applied).collect()
}

fn adapted(judged: &JudgedAs) -> Adapted {
    let constants = judged.held.iter().map(|held| {
        let constant = match &held.same_as {
            Some(other) => Constant::SameAs(other.clone()),
            None => Constant::Numbers(held.bits.iter().map(|&bits| f32::from_bits(bits)).collect()),
        };
        (held.name.clone(), constant)
    });
    Adapted {
        id: judged.id.clone(),
        missing: judged.not_given.clone(),
        constants: constants.collect(),
        ..Adapted::default()
    }
}
