//! A run's result for people to read.

use crate::Level;
use crate::against::{self, Against};
use crate::table::{Align, TextTable};
use lightmeter_document::run::{
    BlendState, DeviationUse, Failure, Group, ImageUse, JudgedAs, MistakePlace, Report, ShaderUse, Tiers, Totals,
};
use lightmeter_document::{Number, Word, distance_told, error_told, is_worse, thousands, worse};
use lightmeter_scene::blend::Route;
use lightmeter_scene::target::TargetFormat;
use std::collections::BTreeMap;
use std::fmt::{Result, Write};

/// How much is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// A row for each family and stage.
    Families,
    /// A row for each group.
    Groups,
}

/// How a report is written.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// How much is told.
    pub detail: Detail,
    /// Whether it is said where the time went.
    pub timing: bool,
    /// Whether failing cases were told already, as they were judged.
    pub is_told: bool,
    /// How much is said.
    pub level: Level,
}

/// Writes the report.
///
/// # Errors
/// Where the writer fails.
pub fn write(report: &Report, style: Style, out: &mut impl Write) -> Result {
    // What a file says may be why something passes.
    if let Some(config) = &report.config {
        writeln!(out, "{config}")?;
    }
    if style.level > Level::Quiet {
        for adapter in &report.adapters {
            writeln!(out, "{}: {}, {}, {}", adapter.name, adapter.device, adapter.backend, adapter.driver)?;
        }
        writeln!(out)?;
        let rows = match style.detail {
            Detail::Families => families(&report.groups),
            Detail::Groups => report.groups.iter().map(TableRow::of).collect(),
        };
        if !rows.is_empty() {
            table(&rows, report.adapters.len() > 1, style.level, out)?;
        }
    }
    if style.is_told {
        told_above(report, out)?;
    } else {
        failures(report, style.level, out)?;
    }
    shader_lines(report, out)?;
    if style.level > Level::Quiet {
        writeln!(out)?;
    }
    notes(report, style.level, out)?;
    against::text(Against::of_run(report), out)?;
    if style.timing {
        let t = report.timing;
        blend_timing(report, out)?;
        writeln!(
            out,
            "time: devices {:.2} s (their compilers included), pipelines {:.2} s, judging {:.2} s, diagnosis {:.2} s; for the most \
             part beside these: reference {:.2} s, inputs {:.2} s",
            t.devices, t.compile, t.judge, t.diagnose, t.reference, t.generate
        )?;
    }
    if let Some(interrupted) = &report.interrupted {
        writeln!(out, "interrupted: {} was under way: {}", interrupted.under_way, interrupted.message)?;
    }
    if report.totals.cases == 0 && report.is_success() && !report.deviations.is_empty() {
        let count = report.deviations.len();
        return writeln!(out, "✓ {count} known deviations were looked for in {:.1} s, and seen", report.seconds);
    }
    totals(&report.totals, report.is_success(), report.seconds, out)
}

/// Images that lie to one side of their reference by no more than the accuracy rules permit: a line for all stages that show the same.
fn legal_biases(report: &Report, out: &mut impl Write) -> Result {
    let mut told: Vec<(&str, &str, String, Vec<&str>)> = vec![];
    for group in &report.groups {
        let bias = group.image.as_ref().and_then(|image| image.bias).filter(|bias| bias.beyond.is_none());
        let Some(bias) = bias else { continue };
        let says = format!("{}, {} on average", bias.as_if(), bias.on_average());
        match told
            .iter_mut()
            .find(|(id, adapter, other, _)| (*id, *adapter) == (&*group.id, &*group.adapter) && *other == says)
        {
            Some((.., stages)) => stages.push(&group.stage),
            None => told.push((&group.id, &group.adapter, says, vec![&group.stage])),
        }
    }
    for (id, adapter, says, stages) in told {
        let stages = stages.join(", ");
        writeln!(out, "{id} on {adapter} ({stages}) lies to one side, which is legal there: {says}")?;
    }
    Ok(())
}

/// Writes each group that fails, with what explains it, and of each formula on an adapter one failing case.
///
/// # Errors
/// Where the writer fails.
pub fn failures(report: &Report, level: Level, out: &mut impl Write) -> Result {
    failing_groups(report, out)?;
    // One failure a formula and adapter explains more than many; the JSON has the first of every stage.
    let mut told: Vec<(&str, &str)> = vec![];
    let fails = |failure: &&Failure| {
        let mut groups = report.groups.iter();
        groups.any(|group| {
            let is_of =
                failure.adapter == group.adapter && failure.stage == group.stage && failure.target == group.target;
            is_of && group.totals.failed > 0 && group.has_case(&failure.id)
        })
    };
    for failure in report.failures.iter().filter(fails) {
        let formula = formula_of(failure);
        if !told.contains(&(formula, &failure.adapter)) {
            told.push((formula, &failure.adapter));
            writeln!(out)?;
            self::failure(failure, level, out)?;
        }
    }
    Ok(())
}

/// A line for each formula or scene that fails on an adapter, where all that is known of it was told as it was judged.
fn told_above(report: &Report, out: &mut impl Write) -> Result {
    let mut formulas: Vec<Vec<&Group>> = vec![];
    for group in report.groups.iter().filter(|group| is_failing(group)) {
        match formulas.iter_mut().find(|own| own[0].id == group.id && own[0].adapter == group.adapter) {
            Some(own) => own.push(group),
            None => formulas.push(vec![group]),
        }
    }
    if formulas.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nfailed, as is told above")?;
    for groups in formulas {
        let places: Vec<String> = groups.iter().map(|group| group.place()).collect();
        let sum = |count: fn(&Totals) -> u64| thousands(groups.iter().map(|group| count(&group.totals)).sum());
        let (failed, verdicts) = (sum(|totals| totals.failed), sum(|totals| totals.verdicts));
        let cause = groups.iter().find_map(|group| group.cause.as_ref().or(group.problem.as_ref()));
        let cause = cause.map_or_else(String::new, |cause| format!(": {cause}"));
        let (id, adapter) = (&groups[0].id, &groups[0].adapter);
        writeln!(out, "  {id} on {adapter}, {}: {failed} of {verdicts}{cause}", places.join(" and "))?;
    }
    Ok(())
}

fn is_failing(group: &Group) -> bool {
    group.totals.failed > 0 || group.problem.is_some()
}

fn failing_groups(report: &Report, out: &mut impl Write) -> Result {
    for (place, group) in report.groups.iter().filter(|group| is_failing(group)).enumerate() {
        if place == 0 {
            writeln!(out)?;
        }
        failing_group(group, " of", out)?;
    }
    Ok(())
}

/// The lines of a shader in which the mistakes are made that explain its failures.
fn shader_lines(report: &Report, out: &mut impl Write) -> Result {
    let Some(shader) = &report.shader else { return Ok(()) };
    for place in shader.formulas.iter().flat_map(|formula| &formula.mistakes) {
        writeln!(out, "{}", made_at(shader, place))?;
    }
    let fails = |id: &str| report.groups.iter().any(|group| group.id == id && group.totals.failed > 0);
    for formula in shader.formulas.iter().filter(|formula| fails(&formula.id)) {
        if let Some(unbound) = unbound(formula) {
            writeln!(out, "{}: {unbound}", shader.file)?;
        }
    }
    Ok(())
}

/// What says that inputs of a formula have nothing in a shader.
pub(crate) fn unbound(formula: &JudgedAs) -> Option<String> {
    let names = formula.unbound.join(", ");
    let says = "nothing in it stands for";
    (!names.is_empty()).then(|| format!("{says} {names} of {}, so that failures may be by that alone", formula.id))
}

/// Where in a shader a mistake is made.
pub(crate) fn made_at(shader: &ShaderUse, place: &MistakePlace) -> String {
    format!("{}:{}: {}\n  is the likely place of {}", shader.file, place.line, place.code, place.mistake)
}

/// Writes that a group fails, with what explains it. Its counts are of some of its verdicts.
pub(crate) fn failing_group(group: &Group, of: &str, out: &mut impl Write) -> Result {
    let (failed, verdicts) = (thousands(group.totals.failed), thousands(group.totals.verdicts));
    write!(out, "✗ {} on {}, {}: {failed}{of} {verdicts} failed", group.id, group.adapter, group.place())?;
    writeln!(out)?;
    for what in group.explanation.iter().chain(&group.problem) {
        facts(what, out)?;
    }
    Ok(())
}

/// What is said of a group: of an image, the command that shows its worst pixel and its files stand on lines of their own.
fn facts(what: &str, out: &mut impl Write) -> Result {
    let Some((says, rest)) = what.split_once("; the worst: ") else { return writeln!(out, "  {what}") };
    let (command, files) = rest.split_once("; see ").map_or((rest, None), |(command, files)| (command, Some(files)));
    says.split("; ").try_for_each(|fact| writeln!(out, "  {fact}"))?;
    writeln!(out, "  worst pixel")?;
    writeln!(out, "    {command}")?;
    match files {
        Some(files) => files.split(", ").try_for_each(|file| writeln!(out, "    {file}")),
        None => Ok(()),
    }
}

/// The formula, or the scene, that a failure is of.
pub(crate) fn formula_of(failure: &Failure) -> &str {
    let path = failure.id.rsplit_once('/').map_or(failure.id.as_str(), |(path, _)| path);
    path.split("/hard").next().unwrap_or(path).trim_end_matches("/random")
}

/// What the first drawing of the blend states costs, and the second, by adapter: the product of factors and equations, and
/// apart from it the states with another one for alpha.
fn blend_timing(report: &Report, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        let groups = || report.groups.iter().filter(|group| group.adapter == adapter.name);
        for (what, separate) in [("blend unit", false), ("states separate for alpha", true)] {
            let of =
                || groups().filter(|group| (group.id == "blend/separate") == separate && group.seconds_warm.is_some());
            let (cold, warm) = of().fold((0.0, 0.0), |(cold, warm), group| {
                (cold + group.seconds, warm + group.seconds_warm.unwrap_or_default())
            });
            if of().next().is_some() {
                writeln!(
                    out,
                    "{what} of {}: {cold:.2} s at first, {warm:.2} s again, so {:.2} s are the driver's compilation",
                    adapter.name,
                    (cold - warm).max(0.0)
                )?;
            }
        }
    }
    Ok(())
}

/// How many hard cases the stable forms keep their claims at, and where a naive form does better than it is known for.
fn stability(report: &Report, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        let on_adapter: Vec<_> = report.stability.iter().filter(|one| one.adapter == adapter.name).collect();
        if on_adapter.is_empty() {
            continue;
        }
        let (kept, fails) = (
            on_adapter.iter().filter(|one| one.is_stable()).count(),
            on_adapter.iter().filter(|one| one.naive_fails()).count(),
        );
        writeln!(
            out,
            "hard cases of {}, by stage: the stable form keeps its bound at {kept} of {}, the naive form fails at {fails}",
            adapter.name,
            on_adapter.len()
        )?;
        for one in on_adapter.iter().filter(|one| !one.naive_fails()) {
            writeln!(
                out,
                "  {} does not fail at {} here, {}: {} roundings, said to be {} at least",
                one.naive_formula,
                one.id,
                one.stage,
                Number(one.naive.0.round()),
                one.naive_at_least
            )?;
        }
    }
    Ok(())
}

fn notes(report: &Report, level: Level, out: &mut impl Write) -> Result {
    deviations(report, level, out)?;
    skips(report, out)?;
    if level > Level::Quiet {
        legal_biases(report, out)?;
    }
    if level == Level::Verbose {
        stores(report, out)?;
        images(report, out)?;
        stability(report, out)?;
    }
    for special in report.special.iter().filter(|special| !special.is_as_recorded()) {
        let (seen, recorded) = (&special.seen, special.recorded.as_deref().unwrap_or_default());
        writeln!(
            out,
            "{} on {}, {}: {seen}, where {recorded} is on record",
            special.id, special.adapter, special.target
        )?;
    }
    if level == Level::Verbose && !report.routes.is_empty() {
        let states: u64 = report.routes.values().filter_map(serde_json::Value::as_u64).sum();
        // They went another way before.
        let dual = report.routes.get(Route::DualSource.name()).and_then(serde_json::Value::as_u64).unwrap_or(0);
        let routes: Vec<String> = report.routes.iter().map(|(route, states)| format!("{states} {route}")).collect();
        writeln!(
            out,
            "blend states: {} judged ({}), {} more are aliases of those",
            thousands(states.saturating_sub(dual)),
            routes.join(", "),
            thousands(report.aliases)
        )?;
    }
    Ok(())
}

/// The known deviations of each adapter: those that are still needed on one line, unless all is to be told.
fn deviations(report: &Report, level: Level, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        let is_of = |deviation: &&DeviationUse| deviation.adapter == adapter.name;
        let (needed, not_needed): (Vec<_>, Vec<_>) =
            report.deviations.iter().filter(is_of).partition(|deviation| deviation.still_needed);
        if level == Level::Verbose {
            needed.iter().try_for_each(|deviation| self::deviation(deviation, out))?;
        } else if level == Level::Normal && !needed.is_empty() {
            let names: Vec<&str> = needed.iter().map(|deviation| deviation.name.as_ref()).collect();
            let excused: u64 = needed.iter().map(|deviation| deviation.excused).sum();
            let excuse =
                if excused > 0 { format!("; they excuse {} verdicts", thousands(excused)) } else { String::new() };
            writeln!(out, "known deviations of {}, seen again: {}{excuse}", adapter.name, names.join(", "))?;
        }
        not_needed.iter().try_for_each(|deviation| self::deviation(deviation, out))?;
    }
    Ok(())
}

/// What was skipped, with the reason that several groups have in common.
fn skips(report: &Report, out: &mut impl Write) -> Result {
    let mut groups = BTreeMap::<_, Vec<&str>>::new();
    for group in report.groups.iter() {
        if let Some(reason) = &group.skip_reason {
            groups.entry((&group.adapter, group.place(), reason)).or_default().push(&group.id);
        }
    }
    for ((adapter, place, reason), ids) in groups {
        let which = match ids.as_slice() {
            [one] => (*one).to_owned(),
            [first, .., last] => format!("{} groups, from {first} to {last},", ids.len()),
            [] => continue,
        };
        writeln!(out, "skipped {which} on {adapter}, {place}: {reason}")?;
    }
    let mut routes = BTreeMap::<_, u64>::new();
    let on_targets = |state: &&BlendState| {
        let group = report
            .groups
            .iter()
            .find(|group| group.adapter == state.adapter && group.target.as_ref() == Some(&state.target));
        group.is_some_and(|group| group.skip_reason.is_none())
    };
    for state in report.blend_states.iter().filter(on_targets) {
        if let Some(reason) = &state.skip_reason {
            *routes.entry((&state.adapter, &state.target, &state.route, reason)).or_default() += 1;
        }
    }
    for ((adapter, target, route, reason), states) in routes {
        writeln!(out, "skipped {states} states by {route} on {adapter}, {target}: {reason}")?;
    }
    Ok(())
}

/// Whether a named deviation is still needed, and what it excused.
///
/// # Errors
/// Where the writer fails.
pub fn deviation(deviation: &DeviationUse, out: &mut impl Write) -> Result {
    let DeviationUse { name, adapter, reason, .. } = deviation;
    let state = if deviation.still_needed {
        "seen again, so it is granted".to_owned()
    } else {
        format!("no longer seen: take it out ({reason})")
    };
    write!(out, "known deviation {name} of {adapter}: {state}")?;
    match deviation.excused {
        0 => writeln!(out, "; no verdict needed it"),
        1 => writeln!(out, "; it excuses 1 verdict"),
        more => writeln!(out, "; it excuses {} verdicts", thousands(more)),
    }
}

/// Of scenes, by adapter: how many pixels are marked, whether both kinds of shader draw alike, and what all effects cost.
fn images(report: &Report, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        let of_adapter = report.groups.iter().filter(|group| group.adapter == adapter.name);
        let images: Vec<_> = of_adapter.filter_map(|group| Some((group, group.image.as_ref()?))).collect();
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        let share =
            |(group, image): &(&Group, &ImageUse)| 100.0 * image.marked as f64 / group.totals.cases.max(1) as f64;
        let Some(most) = images.iter().max_by(|a, b| share(a).total_cmp(&share(b))) else { continue };
        write!(out, "images of {}: at most {:.3} % of the pixels marked ({})", adapter.name, share(most), most.0.id)?;
        let differing: Vec<u64> = images.iter().filter_map(|(_, image)| image.differs_from_composed).collect();
        if !differing.is_empty() {
            let alike = differing.iter().filter(|&&pixels| pixels == 0).count();
            let pixels: u64 = differing.iter().sum();
            let of = differing.len();
            write!(out, "; {alike} of {of} are the same bit for bit by the shader with all effects")?;
            if pixels > 0 {
                write!(out, ", {} pixels of the others differ", thousands(pixels))?;
            }
        }
        writeln!(out)?;
        for (group, image) in &images {
            if let Some(cost) = image.cost {
                writeln!(
                    out,
                    "  {:<26} {:>8.2} ms composed, {:>8.2} ms with all effects: {:.2} times (quartiles {:.2} to {:.2})",
                    group.id, cost.composed_ms, cost.full_ms, cost.ratio, cost.quartiles[0], cost.quartiles[1]
                )?;
            }
        }
    }
    Ok(())
}

/// On targets of 8 bits: how near values come, and how they are stored.
fn stores(report: &Report, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        for target in TargetFormat::ALL {
            let groups = || {
                let of =
                    |group: &&Group| group.adapter == adapter.name && group.target.as_deref() == Some(target.name());
                report.groups.iter().filter(of)
            };
            let mut tiers = Tiers::default();
            groups().filter_map(|group| group.tiers).for_each(|of| tiers.add(&of));
            let all: u64 = tiers.named().into_iter().map(|(_, count)| count).sum();
            if all == 0 {
                continue;
            }
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            let share = |count: u64| 100.0 * count as f64 / all as f64;
            let shares = tiers.named().map(|(name, count)| format!("{name} {:.2} %", share(count)));
            let mut stores: Vec<&str> = groups().filter_map(|group| Some(&*group.store.as_ref()?.identified)).collect();
            stores.sort_unstable();
            stores.dedup();
            let stores = if stores.is_empty() { "too few values to tell".into() } else { stores.join(", ") };
            writeln!(out, "{} of {}: {}; stored: {stores}", target.name(), adapter.name, shares.join(", "))?;
        }
    }
    Ok(())
}

/// Writes the last line of a run: how many verdicts there are of which outcome.
///
/// # Errors
/// Where the writer fails.
pub fn totals(t: &Totals, is_success: bool, seconds: f64, out: &mut impl Write) -> Result {
    let [verdicts, cases, failed] = [t.verdicts, t.cases, t.failed].map(thousands);
    let mark = match is_success {
        true if t.verdicts == 0 && t.skipped > 0 => '–',
        true => '✓',
        false => '✗',
    };
    write!(out, "{mark} {verdicts} verdicts on {cases} cases in {seconds:.1} s: {failed} failed")?;
    for (count, what) in [
        (t.expected_failures, "expected failures"),
        (t.unexpected_passes, "passed unexpectedly"),
        (t.skipped, "cases skipped"),
    ] {
        if count > 0 {
            write!(out, ", {} {what}", thousands(count))?;
        }
    }
    writeln!(out)?;
    if t.indeterminate == 0 {
        return Ok(());
    }
    #[expect(clippy::cast_precision_loss, reason = "a share")]
    let share = 100.0 * t.indeterminate as f64 / t.verdicts.max(1) as f64;
    writeln!(
        out,
        "  {} verdicts ({share:.2} %) are undecided: there the accuracy rules permit any value",
        thousands(t.indeterminate)
    )
}

/// A row of the table.
struct TableRow {
    id: String,
    adapter: String,
    stage: Word,
    groups: usize,
    totals: Totals,
    error_ulp_max: f64,
    unit: &'static str,
    margin_max: f64,
    worst: Option<String>,
    seconds: f64,
}

impl TableRow {
    fn of(group: &Group) -> Self {
        Self {
            id: group.id.clone(),
            adapter: group.adapter.clone(),
            // A blend unit is told by its target.
            stage: group.target.as_ref().filter(|_| group.image.is_none()).unwrap_or(&group.stage).clone(),
            groups: 1,
            totals: group.totals,
            error_ulp_max: group.error_ulp_max.0,
            unit: unit_on(group.target.as_deref()),
            margin_max: group.margin_max.0,
            worst: group.worst.clone(),
            seconds: group.seconds,
        }
    }

    fn add(&mut self, other: &Self) {
        self.groups += 1;
        self.totals.add(&other.totals);
        self.error_ulp_max = worse(self.error_ulp_max, other.error_ulp_max);
        if is_worse(other.margin_max, self.margin_max) {
            self.margin_max = other.margin_max;
            self.worst.clone_from(&other.worst);
        }
        self.seconds += other.seconds;
    }
}

fn families(groups: &[Group]) -> Vec<TableRow> {
    let mut rows: Vec<TableRow> = vec![];
    for group in groups {
        let mut row = TableRow::of(group);
        row.id = group.id.split('/').next().unwrap_or_default().into();
        match rows.iter_mut().find(|r| r.id == row.id && r.adapter == row.adapter && r.stage == row.stage) {
            Some(known) => known.add(&row),
            None => rows.push(row),
        }
    }
    rows
}

fn table(rows: &[TableRow], has_adapters: bool, level: Level, out: &mut impl Write) -> Result {
    let (left, right) = (Align::Left, Align::Right);
    let mut columns = vec![("", left), ("family", left), ("adapter", left), ("stage", left)];
    columns.extend([("formulas", right), ("verdicts", right), ("failed", right)]);
    if !has_adapters {
        columns.remove(2);
    }
    let mut table = TextTable::new(&columns);
    for row in rows {
        let (verdicts, failed) = (row.totals.verdicts, row.totals.failed);
        let mark = match (failed + row.totals.failed_groups, verdicts) {
            (0, 0) => '–',
            (0, _) => '✓',
            _ => '✗',
        };
        let mut cells = vec![mark.to_string(), row.id.clone(), row.adapter.clone(), row.stage.to_string()];
        cells.extend([row.groups.to_string(), thousands(verdicts), thousands(failed)]);
        if !has_adapters {
            cells.remove(2);
        }
        table.row(cells);
    }
    let mut lines = table.lines().into_iter();
    lines.next().map_or(Ok(()), |heading| writeln!(out, "{heading}"))?;
    for (row, line) in rows.iter().zip(lines) {
        writeln!(out, "{line}")?;
        if level == Level::Verbose
            && let Some(worst) = &row.worst
        {
            let (margin, error) = (short(100.0 * row.margin_max), error_told(Number(row.error_ulp_max), row.unit));
            writeln!(out, "    {worst} takes {margin} % of its tolerance, the largest error is {error}")?;
        }
    }
    Ok(())
}

/// A failure with all that is needed to understand it and to run it again.
///
/// # Errors
/// Where the writer fails.
pub fn failure(failure: &Failure, level: Level, out: &mut impl Write) -> Result {
    let Failure { id, adapter, stage, output, .. } = failure;
    let target = failure.target.as_ref().map(|target| format!(" on {target}")).unwrap_or_default();
    writeln!(out, "FAIL {id} on {adapter}, {stage}{target}: {output}")?;
    // NaNs differ only in their bits, so the bits are shown.
    let has_bits = level == Level::Verbose || failure.promise.is_some() || failure.value.0.is_nan();
    for ((name, value), bits) in failure.inputs.iter().zip(failure.inputs_hex.values()) {
        let unit = failure.units.get(name).map(|unit| format!("  {unit}")).unwrap_or_default();
        let bits = if has_bits { format!("  {}", plain(bits)) } else { String::new() };
        writeln!(out, "  {name:<14} {}{bits}{unit}", plain(value))?;
    }
    match &failure.promise {
        Some(promise) => writeln!(out, "  {:<14} {promise}", "legal")?,
        None => {
            let [low, high] = failure.interval.map(Number::narrow);
            writeln!(out, "  {:<14} {}", "reference", failure.reference)?;
            writeln!(out, "  {:<14} {low} to {high}", "legal")?;
        }
    }
    if failure.unwritten {
        writeln!(out, "  {:<14} never written", "value")?;
    } else if failure.promise.is_some() || failure.value.0.is_nan() {
        writeln!(out, "  {:<14} {}  {}", "value", failure.value, failure.value_hex)?;
    } else {
        let bits = if has_bits { format!("  {}", failure.value_hex) } else { String::new() };
        let off = distance_told(failure.error_ulp, unit_of(failure), failure.value, failure.reference);
        writeln!(out, "  {:<14} {}{bits}, {off}", "value", failure.value.narrow())?;
    }
    // What was typed into a page has no command that judges it again.
    if failure.rerun.is_empty() { Ok(()) } else { writeln!(out, "  {:<14} {}", "again", failure.rerun) }
}

/// What the error of a failure is counted in.
pub(crate) fn unit_of(failure: &Failure) -> &'static str {
    unit_on(failure.target.as_deref())
}

/// What errors on a target are counted in; without a target there are no steps.
fn unit_on(target: Option<&str>) -> &'static str {
    if target.and_then(TargetFormat::by_name).is_some_and(TargetFormat::is_unorm) { "steps" } else { "ULP" }
}

/// JSON without quotes and commas: `[0.5 1]`.
pub(crate) fn plain(value: &serde_json::Value) -> String {
    match value {
        serde_json::Value::Array(values) => format!("[{}]", values.iter().map(plain).collect::<Vec<_>>().join(" ")),
        serde_json::Value::String(text) => text.clone(),
        serde_json::Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), |x| Number(x).narrow()),
        other => other.to_string(),
    }
}

/// Two digits after the point, or an exponent.
fn short(x: f64) -> String {
    if x.is_finite() && x >= 1e6 {
        format!("{x:.1e}")
    } else if x.is_finite() {
        format!("{x:.2}")
    } else {
        Number(x).to_string()
    }
}
