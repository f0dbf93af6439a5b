//! An earlier result, than which nothing may be worse.

use lightmeter_catalogue::cases::GENERATOR_VERSION;
use lightmeter_catalogue::filter::Filter;
use lightmeter_document::by_case::{CaseCounts, CaseTotals};
use lightmeter_document::pack::Choice;
use lightmeter_document::report::{Group, Report, Totals};
use lightmeter_document::{Document, cases, thousands};
use lightmeter_files::read::MOST_TEXT;
use lightmeter_files::shown;
use lightmeter_judge::cases::{count_of, expanded};
use lightmeter_judge::image::file::whole;
use lightmeter_scene::target::TargetFormat;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};

/// Errors up to this are no worse than others: half a step, half a ULP.
const FLOOR: f64 = 0.5;
/// The same of the mean of many errors.
const MEAN_FLOOR: f64 = 0.05;
/// Cases that are named, of each formula.
const MOST_NAMED: usize = 8;

/// A result, as far as it is compared: of a run or of a gate.
#[derive(Debug)]
pub struct Standard {
    choice: Choice,
    generator: u64,
    profile: String,
    /// Who answered, by name.
    subjects: Subjects,
    /// Whether a shader was judged in the place of the suite's own.
    is_of_a_shader: bool,
    /// Which part of the cases, as `2/8`; none for all.
    shard: Option<String>,
    /// The formats that were asked to be blended on.
    targets: Vec<String>,
    groups: Vec<ComparedGroup>,
    /// Failures that are expected, by their globs.
    expected: Vec<String>,
    /// What is counted over all groups: its name, the count that the result gives, and the sum of the groups' counts.
    sums: Vec<(&'static str, u64, u64)>,
    /// Why it is no standard to hold others to.
    unfit: Option<&'static str>,
}

/// Who was judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subjects {
    /// Adapters of a run, by their names; its groups name them as well.
    Adapters(BTreeSet<String>),
    /// A renderer that was asked.
    Renderer(String),
}

impl Subjects {
    /// Those of a report.
    #[must_use]
    pub fn of(report: &Report) -> Self {
        match &report.renderer {
            Some(renderer) => Self::Renderer(shown(&renderer.identity.name).into_owned()),
            None => Self::Adapters(report.adapters.iter().map(|adapter| shown(&adapter.name).into_owned()).collect()),
        }
    }

    fn is_one(&self) -> bool {
        match self {
            Self::Adapters(names) => names.len() == 1,
            Self::Renderer(_) => true,
        }
    }
}

impl Display for Subjects {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Adapters(names) => f.write_str(&names.iter().map(String::as_str).collect::<Vec<_>>().join(" and ")),
            Self::Renderer(name) => f.write_str(name),
        }
    }
}

/// A group that is compared with the one of the same name.
#[derive(Debug)]
struct ComparedGroup {
    /// Its id and place.
    name: String,
    group: Group,
    /// Counts of cases, or of verdicts.
    counts: CaseCounts,
    /// Whether they are of cases.
    is_by_case: bool,
}

impl ComparedGroup {
    fn of(group: &Group) -> Self {
        let totals = &group.totals;
        let of_verdicts = CaseTotals {
            asked: totals.cases.saturating_sub(totals.skipped),
            passed: totals.passed,
            failed: totals.failed,
            skipped: totals.skipped,
            ..CaseTotals::default()
        };
        Self {
            name: group.name(),
            counts: group
                .by_case
                .clone()
                .unwrap_or_else(|| CaseCounts { totals: of_verdicts, ..CaseCounts::default() }),
            is_by_case: group.by_case.is_some(),
            group: group.clone(),
        }
    }

    /// By what its cases are found in the baseline: its name, or its id where two adapters are compared, one of which may lack a stage.
    fn key(&self, across: bool) -> &str {
        if across { &self.group.id } else { &self.name }
    }

    /// Its name without the adapter.
    fn across(&self) -> String {
        format!("{}, {}", self.group.id, self.group.place())
    }
}

impl From<&Report> for Standard {
    fn from(report: &Report) -> Self {
        let why = [
            (report.interrupted.is_some(), "it was interrupted"),
            (report.is_broken(), "the renderer broke off, or wrote what is no answer"),
            (report.unstable > 0, "answers changed when they were asked once more"),
            (!report.has_judged(), "nothing was judged"),
        ];
        let compared_by = report.compared_by.clone().unwrap_or_default();
        let mut sum = Totals::default();
        report.groups.iter().for_each(|group| sum.add(&group.totals));
        let totals = &report.totals;
        let mut sums = vec![
            ("cases", totals.cases, sum.cases),
            ("verdicts", totals.verdicts, sum.verdicts),
            ("passed", totals.passed, sum.passed),
            ("failed", totals.failed, sum.failed),
            ("skipped", totals.skipped, sum.skipped),
            ("indeterminate", totals.indeterminate, sum.indeterminate),
        ];
        if let Some(own) = &report.by_case {
            let sum = report.cases();
            sums.extend([
                ("cases that were asked", own.asked, sum.asked),
                ("cases that failed", own.failed, sum.failed),
                ("cases that were skipped", own.skipped, sum.skipped),
                ("cases that are missing", own.missing, sum.missing),
            ]);
        }
        Self {
            sums,
            choice: compared_by.choice,
            generator: compared_by.generator,
            profile: report.profile.to_string(),
            subjects: Subjects::of(report),
            is_of_a_shader: report.shader.is_some(),
            shard: compared_by.shard,
            targets: compared_by.targets.iter().map(ToString::to_string).collect(),
            groups: report.groups.iter().map(ComparedGroup::of).collect(),
            expected: report.expectations.iter().map(|one| one.id.clone()).collect(),
            unfit: why.into_iter().find(|(is_so, _)| *is_so).map(|(_, why)| why),
        }
    }
}

impl Standard {
    /// Whether a group that is missing here, and is there in an earlier result, was asked for.
    fn asks_for(&self, before: &ComparedGroup, is_part: bool) -> bool {
        let is_asked = matches!(self.subjects, Subjects::Renderer(_));
        let (group, target) = (&before.group, before.group.blended_on().filter(|_| is_asked));
        if target.is_some_and(|target| !self.targets.iter().any(|asked| target == asked)) {
            return false;
        }
        // A renderer's group on a target is there where its states are asked for at all.
        let is_below =
            |other: &ComparedGroup| other.group.id.strip_prefix(&group.id).is_some_and(|rest| rest.starts_with('/'));
        !is_part || (target.is_some() && self.groups.iter().any(is_below))
    }
}

/// An earlier result.
#[derive(Debug)]
pub struct Baseline(Standard);

/// Why a baseline cannot be compared with, or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// It cannot be read.
    #[error("cannot read {}: {message}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// It is of other cases.
    #[error("{} is of other cases: {}", .path.display(), .differences.join("; "))]
    Others {
        /// The file.
        path: PathBuf,
        /// What differs.
        differences: Vec<String>,
    },
    /// It is of another adapter or renderer.
    #[error(
        "{} is a result of {before}, and this is one of {now}; a baseline is of the same adapters or the same renderer. `--across` of `run` and \
         `gate` compares one with another, formula by formula",
        .path.display()
    )]
    Subjects {
        /// The file.
        path: PathBuf,
        /// Who was judged then.
        before: String,
        /// Who is judged now.
        now: String,
    },
    /// One is to be compared with another, and there are several.
    #[error(
        "{} is a result of {before}, and this is one of {now}; with `--across` each must be of one adapter",
        .path.display()
    )]
    Several {
        /// The file.
        path: PathBuf,
        /// Who was judged then.
        before: String,
        /// Who is judged now.
        now: String,
    },
    /// It cannot be written.
    #[error("cannot write {}: {message}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// The result is no standard to hold others to.
    #[error("the baseline {} is left as it is: {why}", .path.display())]
    Unfit {
        /// The file.
        path: PathBuf,
        /// What is wrong with the result.
        why: &'static str,
    },
}

impl Baseline {
    /// Reads the JSON of a gate, where a renderer is asked, or else of a run.
    ///
    /// # Errors
    /// Where it is not that, or does not say what chose its cases.
    pub fn read(path: &Path, is_asked: bool) -> Result<Self, BaselineError> {
        let report = read(path)?;
        let refused = |message: &str| Err(BaselineError::Read { path: path.into(), message: message.into() });
        match (report.renderer.is_some(), is_asked) {
            (true, false) => return refused("it is the JSON of `gate`; expected that of `run`"),
            (false, true) => return refused("it is the JSON of `run`; expected that of `gate`"),
            _ => {}
        }
        if report.compared_by.is_none() {
            return refused(
                "it does not say what chose its cases (`compared_by`), so that nothing can be compared with it",
            );
        }
        Self::checked(Standard::from(&report), path)
    }

    /// A result that others can be held to: one of something, in which no group has more cases that did not pass than it has.
    fn checked(standard: Standard, path: &Path) -> Result<Self, BaselineError> {
        let refused = |message: String| Err(BaselineError::Read { path: path.into(), message });
        if standard.groups.is_empty() {
            return refused(
                "it contains no results to compare with; expected the JSON of a run that judged at least one case"
                    .into(),
            );
        }
        for (what, total, sum) in &standard.sums {
            if total != sum {
                return refused(format!(
                    "its totals count {total} {what}, and its groups {sum}: it was changed by hand"
                ));
            }
        }
        let mut names = HashSet::new();
        for ComparedGroup { name, counts, .. } in &standard.groups {
            if !names.insert(name) {
                return refused(format!("{name} stands there twice"));
            }
            let named = counts.not_passed.values().flatten().map(|text| count_of(text));
            let named = named.fold(0, u64::saturating_add);
            if named > counts.totals.asked {
                let asked = counts.totals.asked;
                return refused(format!("{name}: {named} cases did not pass of {asked} that were asked"));
            }
        }
        Ok(Self(standard))
    }

    /// Checks that it is of the same adapters or the same renderer, or, where that is asked for, of one as well as the other.
    ///
    /// # Errors
    /// Where it is of others.
    pub fn is_by(&self, now: &Subjects, across: bool, path: &Path) -> Result<(), BaselineError> {
        let before = &self.0.subjects;
        let [several, other] = [!(before.is_one() && now.is_one()), before != now];
        let (path, before, now) = (path.into(), before.to_string(), now.to_string());
        match (across, other) {
            (true, _) if several => Err(BaselineError::Several { path, before, now }),
            (false, true) => Err(BaselineError::Subjects { path, before, now }),
            _ => Ok(()),
        }
    }

    /// What is worse in a result, beyond `factor` where it is an error. A part of the cases, as a shard, is compared with the same part. With
    /// `across` one adapter or renderer is compared with another, formula by formula.
    ///
    /// # Errors
    /// Where the cases are others.
    pub fn compare(
        &self,
        now: &Standard,
        factor: f64,
        (is_shard, across): (bool, bool),
        path: &Path,
    ) -> Result<Vec<String>, BaselineError> {
        let asked = now.groups.iter().map(|group| (group.key(across), group.counts.totals.asked));
        self.is_of(&now.choice, (asked, across), Some(&now.profile), path)?;
        if self.0.shard.is_some() && self.0.shard != now.shard {
            let [before, now] = [&self.0.shard, &now.shard].map(|shard| shard.as_deref().unwrap_or("1/1"));
            let differences = vec![format!("shard {before} there, {now} here")];
            return Err(BaselineError::Others { path: path.into(), differences });
        }
        self.is_by(&now.subjects, across, path)?;
        let name = |group: &ComparedGroup| if across { group.across() } else { group.name.clone() };
        if self.0.is_of_a_shader != now.is_of_a_shader {
            let what = |is_own: bool| if is_own { "a shader of your own" } else { "the built-in shaders" };
            let differences = vec![format!("{} there, {} here", what(self.0.is_of_a_shader), what(now.is_of_a_shader))];
            return Err(BaselineError::Others { path: path.into(), differences });
        }
        let is_part = is_shard || !self.has_filter_of(&now.choice);
        // They were read when the expectations were.
        let expected: Vec<Filter> = now.expected.iter().filter_map(|glob| Filter::new(&[glob]).ok()).collect();
        let comparison = Comparison { factor, is_part, expected };
        let mut worse = vec![];
        for before in &self.0.groups {
            let before_name = name(before);
            match now.groups.iter().find(|group| name(group) == before_name) {
                None if !now.asks_for(before, is_part) => {}
                None => worse.push(format!("{}: it is not among the cases any more", before.name)),
                Some(now) => worse.extend(comparison.of(before, now)),
            }
        }
        Ok(worse)
    }

    /// What is better in a result, and what is there that was not.
    #[must_use]
    pub fn progress(&self, now: &Standard, across: bool) -> (Vec<String>, Vec<String>) {
        let (mut mended, mut added) = (vec![], vec![]);
        let called = |group: &ComparedGroup| if across { group.across() } else { group.name.clone() };
        for group in now.groups.iter().filter(|group| group.counts.totals.asked > 0) {
            let (ComparedGroup { name, counts: now, .. }, own) = (group, called(group));
            let Some(ComparedGroup { counts: before, .. }) = self.0.groups.iter().find(|group| called(group) == own)
            else {
                added.push(format!("{name}: {} cases", now.totals.asked));
                continue;
            };
            let (before, now) = (&before.totals, &now.totals);
            for (what, before, now) in [("failed", before.failed, now.failed), ("missing", before.missing, now.missing)]
            {
                if now < before {
                    mended.push(format!("{name}: {now} {what}, {before} in the baseline"));
                }
            }
        }
        (mended, added)
    }

    /// Whether its cases were chosen by the same globs, in whatever order.
    fn has_filter_of(&self, now: &Choice) -> bool {
        let [before, now] = [&self.0.choice.filter, &now.filter].map(|globs| globs.iter().collect::<BTreeSet<_>>());
        before == now
    }

    /// Checks that the baseline has the chosen cases: `asked` gives the name of each group and its number of cases, or the id where one adapter
    /// is compared with another. The profile is compared where it is known already.
    ///
    /// # Errors
    /// What differs.
    pub fn is_of<'a>(
        &self,
        now: &Choice,
        (asked, across): (impl Iterator<Item = (&'a str, u64)>, bool),
        profile: Option<&String>,
        path: &Path,
    ) -> Result<(), BaselineError> {
        let mut differences = vec![];
        let mut differs = |what: &str, before: String, now: String| {
            if before != now {
                differences.push(format!("{what} {before} there, {now} here"));
            }
        };
        let before = &self.0.choice;
        differs("cases", before.cases.to_string(), now.cases.to_string());
        differs("seed", before.seed.to_string(), now.seed.to_string());
        differs("size", format!("{:?}", before.size), format!("{:?}", now.size));
        differs("constants", format!("{:?}", before.held), format!("{:?}", now.held));
        differs("generator", self.0.generator.to_string(), GENERATOR_VERSION.to_string());
        if let Some(profile) = profile {
            differs("profile", self.0.profile.clone(), profile.clone());
        }
        if !self.has_filter_of(now) {
            // What the renderer did not declare then has no cases there, and may have some now.
            let mut known = HashMap::<&str, u64>::new();
            for group in &self.0.groups {
                let most = known.entry(group.key(across)).or_default();
                *most = group.counts.totals.asked.max(*most);
            }
            let lacks = |(id, asked): &(&str, u64)| known.get(id).is_none_or(|before| (1..*asked).contains(before));
            let mut missing = asked.filter(lacks).map(|(id, _)| id);
            if let Some(first) = missing.next() {
                let more = missing.count();
                let and = if more > 0 { format!(" and {more} more") } else { String::new() };
                differences.push(format!("filter {:?} there, and {first}{and} here", before.filter));
            }
        }
        if differences.is_empty() { Ok(()) } else { Err(BaselineError::Others { path: path.into(), differences }) }
    }
}

/// How groups are compared.
struct Comparison {
    /// By how much an error may grow.
    factor: f64,
    /// Whether the cases may be a part of those of the baseline.
    is_part: bool,
    /// Failures that are expected.
    expected: Vec<Filter>,
}

impl Comparison {
    /// What is worse in a group. Only like is compared with like: the greatest error of all cases, and the errors of those that pass where
    /// no other cases pass than did, since a case that passes now may err by more than all that passed before.
    fn of(&self, before: &ComparedGroup, now: &ComparedGroup) -> Vec<String> {
        let (id, is_by_case) = (&now.name, before.is_by_case && now.is_by_case);
        let [of_before, of_now] = [before, now].map(|one| (&one.group, one.counts.totals));
        let (before, now) = (&before.counts, &now.counts);
        let ((group_before, before_all), (group, now_all)) = (of_before, of_now);
        let mut worse = vec![];
        if before_all.asked == 0 {
            return worse;
        }
        if now_all.asked < before_all.asked && (!self.is_part || now_all.asked == 0) {
            let (asked, were) = (now_all.asked, before_all.asked);
            worse.push(format!("{id}: {asked} cases are asked, {were} were: the renderer declares less"));
        }
        for what in ["failed", "skipped", "missing"] {
            worse.extend(self.new_cases((id, &group.id), [before, now], what));
        }
        if !is_by_case && now_all.failed > before_all.failed {
            worse.push(format!("{id}: {} verdicts fail, {} did", now_all.failed, before_all.failed));
        }
        let others_pass = {
            let of = |counts: &CaseCounts| -> HashSet<String> {
                counts.not_passed.values().flatten().flat_map(|text| expanded(text)).collect()
            };
            !of(before).is_subset(&of(now))
        };
        let is_same = now_all.asked == before_all.asked && !others_pass;
        let undecided = |group: &Group| group.totals.indeterminate;
        if is_same && undecided(group) > undecided(group_before) {
            let [now, before] = [group, group_before].map(undecided);
            worse.push(format!("{id}: {now} verdicts permit anything, {before} did"));
        }
        let format = group.target.as_deref().filter(|_| group.asked().is_none() || group.blended_on().is_some());
        let unit = match format.and_then(TargetFormat::by_name) {
            Some(format) if format.is_unorm() => "steps",
            None if group.id.starts_with("scene/") => "steps or ULP",
            _ => "ULP",
        };
        let all_expected = now_all.expected_failures > before_all.expected_failures;
        for (is_alike, what, before, now, floor) in [
            (!all_expected, "errs by", group_before.error_ulp_max, group.error_ulp_max, FLOOR),
            (!others_pass, "errs where it passes by", before.error_passing, now.error_passing, FLOOR),
            (is_same, "errs where it passes, in the mean, by", before.error_mean, now.error_mean, MEAN_FLOOR),
        ] {
            // A NaN is worse than any number.
            if is_alike && lightmeter_judge::is_worse(now.0, self.factor * before.0.max(floor)) {
                worse.push(format!(
                    "{id}: {what} {} {unit}; in the baseline it was {}, and more than {} times that counts as worse",
                    now.brief(),
                    before.brief(),
                    self.factor
                ));
            }
        }
        worse
    }

    /// The cases that passed and do not, and are not expected to fail; that were answered or skipped and are missing.
    fn new_cases(&self, (name, group): (&str, &str), [before, now]: [&CaseCounts; 2], what: &str) -> Option<String> {
        let spared = if what == "skipped" { &["skipped", "failed"][..] } else { &[what][..] };
        let known: HashSet<String> = (spared.iter().filter_map(|state| before.not_passed.get(*state)).flatten())
            .flat_map(|text| expanded(text))
            .collect();
        let cases = now.not_passed.get(what).into_iter().flatten().flat_map(|text| expanded(text));
        // A hard case of several formulas has its whole id there.
        let id = |case: &str| format!("{group}/{case}");
        let is_expected =
            |case: &str| self.expected.iter().any(|filter| filter.selects(case) || filter.selects(&id(case)));
        let new: Vec<String> =
            cases.filter(|case| !known.contains(case)).filter(|case| what != "failed" || !is_expected(case)).collect();
        let named = new.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
        let more = match new.len().saturating_sub(MOST_NAMED) {
            0 => String::new(),
            more => format!(" and {} more", thousands(more as u64)),
        };
        (!new.is_empty()).then(|| format!("{name}: {} newly {what}: {named}{more}", cases_of(new.len())))
    }
}

fn cases_of(count: usize) -> String {
    cases(count as u64)
}

fn read(path: &Path) -> Result<Report, BaselineError> {
    let failed = |message: String| BaselineError::Read { path: path.into(), message };
    let text = lightmeter_files::read::text(path, MOST_TEXT).map_err(|error| failed(error.to_string()))?;
    Report::read(&text).map_err(|error| failed(error.to_string()))
}

/// Writes a result as a baseline, whole or not at all. Whether anything changed: a file that says the same but for times is left as it is.
///
/// # Errors
/// Where it cannot be written, or the run was broken off, unstable or judged nothing.
pub fn update(report: &Report, path: &Path) -> Result<bool, BaselineError> {
    if let Some(why) = Standard::from(report).unfit {
        return Err(BaselineError::Unfit { path: path.into(), why });
    }
    let failed = |message: String| BaselineError::Write { path: path.into(), message };
    let json = |report: &Report| report.to_json().map_err(|error| failed(error.to_string()));
    // What is no result is written over.
    if let Ok(before) = read(path)
        && json(&before.without_times())? == json(&report.without_times())?
    {
        return Ok(false);
    }
    whole(path, json(report)?.as_bytes()).map_err(|error| failed(error.to_string()))?;
    Ok(true)
}
