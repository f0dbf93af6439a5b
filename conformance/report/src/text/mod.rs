//! A result for people to read.

mod failure;
mod group;
mod notes;
mod table;

pub use failure::failure;
pub(crate) use failure::{formula_of, one_line, plain, unit_of};
pub use group::failing;
pub(crate) use group::{MOST_TOLD, asked, judged, sentence};
pub use notes::deviation;

use crate::Level;
use crate::against::{self, interrupted, listed};
use lightmeter_document::by_case::{Coverage, Problems, RendererIdentity, RendererUse};
use lightmeter_document::report::{Failure, Group, JudgedAs, MistakePlace, Report, ShaderUse, Totals};
use lightmeter_document::{cases, thousands};
use std::fmt::{Result, Write};

/// How much is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// A row for each family and stage.
    #[default]
    Families,
    /// A row for each group.
    Groups,
}

/// How a report is written.
#[derive(Clone, Copy, Debug, Default)]
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

/// The first line of a renderer's result: who is judged, and by which accuracy rules.
///
/// # Errors
/// Where the writer fails.
pub fn begun(renderer: &RendererIdentity, profile: &str, out: &mut impl Write) -> Result {
    writeln!(out, "{renderer} · profile {profile}")
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
        subjects(report, style, out)?;
        // What failed of a renderer was told above.
        if report.renderer.is_none() || (style.is_told && report.groups.iter().any(Group::is_failed)) {
            writeln!(out)?;
        }
        match report.renderer {
            Some(_) => table::asked(report, style.level, out)?,
            None => table::judged(report, style.detail, style.level, out)?,
        }
    }
    match style.is_told {
        true => group::told_above(report, out)?,
        false => group::failing(report, style, out)?,
    }
    group::more(report, out)?;
    shader_lines(report, out)?;
    if style.level > Level::Quiet && report.renderer.is_none() {
        writeln!(out)?;
    }
    notes::notes(report, style.level, out)?;
    against::text(report, out)?;
    if let Some(renderer) = &report.renderer {
        process(renderer, out)?;
    }
    report.notes.iter().try_for_each(|note| writeln!(out, "\nnote: {note}"))?;
    if style.timing {
        let t = report.timing;
        notes::blend_timing(report, out)?;
        writeln!(
            out,
            "time: devices {:.2} s (their compilers included), pipelines {:.2} s, judging {:.2} s, diagnosis {:.2} s; for the most \
             part beside these: reference {:.2} s, inputs {:.2} s",
            t.devices, t.compile, t.judge, t.diagnose, t.reference, t.generate
        )?;
    }
    if let Some(why) = &report.interrupted {
        match report.renderer {
            Some(_) => writeln!(out, "\n{}", interrupted(why, report))?,
            None => writeln!(out, "interrupted: {}", interrupted(why, report))?,
        }
    }
    if report.totals.cases == 0 && report.is_success() && !report.deviations.is_empty() {
        let count = report.deviations.len();
        return writeln!(out, "✓ {count} known deviations were looked for in {:.1} s, and seen", report.seconds);
    }
    match report.renderer {
        Some(_) => cases_told(report, style.level, out),
        None => totals(&report.totals, report.is_success(), report.seconds, out),
    }
}

/// Who is judged.
fn subjects(report: &Report, style: Style, out: &mut impl Write) -> Result {
    match &report.renderer {
        Some(_) if style.is_told => Ok(()),
        Some(renderer) => begun(&renderer.identity, &report.profile, out),
        None => report.adapters.iter().try_for_each(|adapter| {
            writeln!(out, "{}: {}, {}, {}", adapter.name, adapter.device, adapter.backend, adapter.driver)
        }),
    }
}

/// Whether a failure is told of a group: it is one of its cases, on the same subject, stage and target.
pub(crate) fn is_told_by(group: &Group, failure: &Failure) -> bool {
    let place = (&failure.adapter, &failure.stage, &failure.target) == (&group.adapter, &group.stage, &group.target);
    let smallest = group.by_case.as_ref().and_then(|counts| counts.smallest.as_ref());
    place && (group.has_case(&failure.id) || smallest == Some(&failure.id))
}

/// What went wrong with a renderer apart from its answers.
fn process(renderer: &RendererUse, out: &mut impl Write) -> Result {
    for (what, all) in [
        ("crashes and hangs are expected", &renderer.expected_incidents),
        ("went wrong with the process", &renderer.incidents),
    ] {
        listed(all.len() as u64, what, all, out)?;
    }
    problems(&renderer.problems, out)?;
    renderer.warnings.iter().try_for_each(|warning| writeln!(out, "\nwarning: {warning}"))
}

/// Lines that are no answers.
fn problems(problems: &Problems, out: &mut impl Write) -> Result {
    const MOST: usize = 4;
    if problems.is_empty() {
        return Ok(());
    }
    let counts: Vec<String> =
        problems.counts.iter().map(|(kind, count)| format!("{} {kind}", thousands(*count))).collect();
    writeln!(out, "\nlines that cannot be read as answers: {}", counts.join(", "))?;
    problems.first.iter().take(MOST).try_for_each(|what| writeln!(out, "  {what}"))?;
    if problems.first.len() > MOST { writeln!(out, "  …") } else { Ok(()) }
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

/// How many pass and fail, and what else there is to count, each on a line of its own.
fn cases_told(report: &Report, level: Level, out: &mut impl Write) -> Result {
    let totals = report.cases();
    if level > Level::Quiet {
        writeln!(out)?;
    }
    let [passed, failed] = [totals.passed, totals.failed].map(thousands);
    writeln!(out, "{passed} of {} pass, {failed} fail, in {:.1} s", cases(totals.asked), report.seconds)?;
    for (count, what) in [
        (totals.broken, "fail because the renderer ended or hung"),
        (totals.expected_failures, "fail as expected"),
        (report.totals.unexpected_passes, "are expected to fail, and pass"),
        (report.unstable, "are unstable: the renderer answers them differently when it is asked again"),
        (totals.missing, "were never answered"),
        (totals.skipped, "were skipped"),
        (totals.undeclared, "of those without having been declared"),
    ] {
        if count > 0 {
            writeln!(out, "  {} {what}", thousands(count))?;
        }
    }
    let Coverage { chosen, judged, excluded } = report.coverage();
    if excluded > 0 {
        let [chosen, judged, excluded] = [chosen, judged, excluded].map(thousands);
        writeln!(out, "of {chosen} chosen cases {judged} were judged and {excluded} excluded")?;
    }
    if let Some(declared) = against::declared(report) {
        writeln!(out, "{declared}")?;
    }
    let undecided = report.totals.indeterminate;
    if level == Level::Verbose && undecided > 0 {
        let (undecided, all) = (thousands(undecided), thousands(report.totals.verdicts));
        writeln!(out, "  {undecided} of {all} numbers could be anything: there the accuracy rules promise nothing")?;
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
