//! The page on blending, made from a run's JSON: states against routes and drivers, in Markdown and as a picture.

mod picture;
pub mod renderers;
pub mod scenes;
pub mod selftest;
pub mod special;
pub mod stability;
pub mod sweep;

pub use picture::svg;

use lightmeter_document::report::{BlendState, DeviationUse, Group, Identity, Report, Tiers};
use lightmeter_document::{Document as _, ReadError};
use lightmeter_scene::blend::{Equation, Factor, State};
use lightmeter_scene::blend::{Route, routes};
use lightmeter_scene::target::TargetFormat;
use std::collections::BTreeMap;
use std::fmt::{Result, Write};
use std::ops::Deref;

/// A run that blend states were drawn in.
#[derive(Clone, Debug)]
pub struct BlendRun(Report);

impl Deref for BlendRun {
    type Target = Report;

    fn deref(&self) -> &Report {
        &self.0
    }
}

/// Why no page can be made of a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PageError {
    /// It is not a run's JSON.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Nothing was blended.
    #[error("no blend state was drawn in that run; make one with `lightmeter run blend --target all --format json`")]
    Empty,
}

impl BlendRun {
    /// Reads a run's JSON.
    ///
    /// # Errors
    /// Where it is another document, or a run without blend states.
    pub fn read(json: &str) -> std::result::Result<Self, PageError> {
        let run = Self(Report::read(json)?);
        if run.blend_states.iter().all(|state| state.skip_reason.is_some()) {
            return Err(PageError::Empty);
        }
        Ok(run)
    }

    fn rows<'a>(&'a self, adapter: &'a Identity, target: &'a str) -> impl Iterator<Item = &'a BlendState> {
        self.blend_states.iter().filter(move |row| row.adapter == adapter.name && row.target == target)
    }

    fn row<'a>(&'a self, adapter: &'a Identity, target: &'a str, state: State) -> Option<&'a BlendState> {
        let id = format!("blend/{}", state.canonical());
        self.rows(adapter, target).find(|row| row.id == id && row.skip_reason.is_none())
    }

    fn targets(&self) -> Vec<&'static str> {
        let named = TargetFormat::ALL.map(TargetFormat::name).into_iter();
        named.filter(|name| self.blend_states.iter().any(|row| row.target == *name)).collect()
    }

    /// The target of the matrices: of 8 bits, where one was drawn on.
    fn pictured(&self) -> &'static str {
        let targets = self.targets();
        let wanted = [TargetFormat::Rgba8Unorm, TargetFormat::Bgra8Unorm, TargetFormat::Rgba8UnormSrgb];
        let found = wanted.into_iter().map(TargetFormat::name).find(|name| targets.contains(name));
        found.unwrap_or_else(|| targets.first().copied().unwrap_or_default())
    }
}

/// The farthest tier that some value of a state fell in.
const fn letter(row: &BlendState) -> &'static str {
    match row.tiers {
        _ if row.failed > 0 => "✗",
        None => "·",
        Some(Tiers { bound: 1.., .. }) => "b",
        Some(Tiers { neighbour: 1.., .. }) => "i",
        Some(Tiers { nearest: 1.., .. }) => "n",
        Some(_) => "e",
    }
}

const READING: [Equation; 3] = [Equation::Add, Equation::Subtract, Equation::ReverseSubtract];

/// The page in Markdown. `picture` is where the picture lies, as the page names it.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(run: &BlendRun, picture: Option<&str>, out: &mut impl Write) -> Result {
    writeln!(out, "# Blending: states against routes and drivers\n")?;
    writeln!(out, "Made from a run's JSON; the seed was {}:\n", run.seed)?;
    writeln!(out, "```\n./x run blend --adapter all --target all --format json --out blend.json")?;
    writeln!(out, "./x page blend blend.json --out docs/blend.md\n```\n")?;
    for adapter in &run.adapters {
        writeln!(out, "* **{}**: {}, {}, {}", adapter.name, adapter.device, adapter.backend, adapter.driver)?;
    }
    drivers(run, out)?;
    route_table(out)?;
    matrices(run, picture, out)?;
    failures(run, out)?;
    special(run, out)
}

fn drivers(run: &BlendRun, out: &mut impl Write) -> Result {
    writeln!(out, "\n## Drivers and targets\n")?;
    writeln!(
        out,
        "States count with the route that they took; those with another state for alpha, with write masks and the"
    )?;
    writeln!(
        out,
        "rest are among them. The largest error is in ULP on float targets, which grows where a sum cancels, and in"
    )?;
    writeln!(
        out,
        "steps of 1/255 on the others. A value is *exact* where the formula gives a whole step, then the *nearest*"
    )?;
    writeln!(out, "step, the other *neighbour*, within the format's *bound*, or *outside*.\n")?;
    writeln!(
        out,
        "| driver | target | states | pixels | failed | largest error | exact | nearest | neighbour | bound | outside | stored |"
    )?;
    writeln!(out, "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|")?;
    for adapter in &run.adapters {
        for target in run.targets() {
            driver(run, adapter, target, out)?;
        }
    }
    skipped(run, out)?;
    for deviation in run.deviations.iter().filter(|deviation| deviation.excused > 0) {
        let DeviationUse { name, adapter, reason, excused, .. } = deviation;
        writeln!(out, "\nDeviation *{name}* of {adapter}, {excused} verdicts: {reason}.")?;
    }
    Ok(())
}

/// A driver on a target, on a row.
fn driver(run: &BlendRun, adapter: &Identity, target: &str, out: &mut impl Write) -> Result {
    let groups = || {
        let of = |group: &&Group| group.adapter == adapter.name && group.target.as_deref() == Some(target);
        run.groups.iter().filter(of)
    };
    if let Some(reason) = groups().find_map(|group| group.skip_reason.as_ref()) {
        return writeln!(out, "| {} | {target} | — | | | | | | | | | skipped: {reason} |", adapter.name);
    }
    let drawn: Vec<&BlendState> = run.rows(adapter, target).filter(|row| row.skip_reason.is_none()).collect();
    let sum = |of: fn(&BlendState) -> u64| drawn.iter().map(|row| of(row)).sum::<u64>();
    let error = drawn.iter().map(|row| row.error_max.0).fold(0.0, f64::max);
    let mut stores: Vec<&str> = groups().filter_map(|group| Some(group.store.as_ref()?.identified.as_ref())).collect();
    stores.sort_unstable();
    stores.dedup();
    let error = if error < 1000.0 { format!("{error:.2}") } else { format!("{error:.1e}") };
    writeln!(
        out,
        "| {} | {target} | {} | {} | {} | {error} | {} | {} |",
        adapter.name,
        drawn.len(),
        lightmeter_document::thousands(sum(|row| row.cases)),
        sum(|row| row.failed),
        shares(&drawn).join(" | "),
        stores.join(", ")
    )
}

/// The share of the values of each tier; nothing where the target has none.
fn shares(drawn: &[&BlendState]) -> [String; 5] {
    let mut sum = Tiers::default();
    drawn.iter().for_each(|row| sum.add(&row.tiers()));
    let tiers = sum.named().map(|(_, count)| count);
    let all = tiers.iter().sum::<u64>();
    #[expect(clippy::cast_precision_loss, reason = "shares")]
    tiers.map(|n| match (100.0 * n as f64 / all.max(1) as f64, n) {
        _ if all == 0 => String::new(),
        (share, 1..) if share < 0.005 => "< 0.01 %".into(),
        (share, _) => format!("{share:.2} %"),
    })
}

/// Drawings of states that were skipped one by one, by adapter, route and reason.
fn skipped(run: &BlendRun, out: &mut impl Write) -> Result {
    let mut skipped = BTreeMap::<_, usize>::new();
    let fully = |row: &BlendState| {
        let of = |group: &Group| group.adapter == row.adapter && group.target.as_deref() == Some(&row.target);
        run.groups.iter().any(|group| of(group) && group.skip_reason.is_some())
    };
    for row in run.blend_states.iter().filter(|row| !fully(row)) {
        if let Some(reason) = &row.skip_reason {
            *skipped.entry((&row.adapter, &row.route, reason)).or_default() += 1;
        }
    }
    for ((adapter, route, reason), count) in skipped {
        writeln!(
            out,
            "\n{count} drawings by {route} were skipped on {adapter}: {reason}. The states were drawn by another route."
        )?;
    }
    Ok(())
}

fn route_table(out: &mut impl Write) -> Result {
    writeln!(out, "\n## Routes\n")?;
    writeln!(
        out,
        "WebGPU has no factor of the constant's alpha. A state reaches the unit by one of these routes, the same on every"
    )?;
    writeln!(out, "driver; MIN and MAX are native and ignore their factors.\n")?;
    writeln!(out, "| letter | route | what it does |\n|---|---|---|")?;
    writeln!(out, "| N | native | the unit's own factors |")?;
    writeln!(out, "| R | constant replicated | the constant is given as its alpha in all four components |")?;
    writeln!(
        out,
        "| F | folded into the source | the shader multiplies the source's colour by its constant factor and the unit takes \
         ONE; where the target has 8 bits both are clamped first, since the unit would clamp the product |"
    )?;
    writeln!(
        out,
        "| D | dual source | the constant's alpha is that of a second source colour; drawn besides F where the adapter can |"
    )
}

/// A state's route, as a letter.
fn route_letters(state: State) -> &'static str {
    match routes(state.canonical().into()) {
        [Route::Native] => "N",
        [Route::ConstantReplicated] => "R",
        _ => "FD",
    }
}

fn matrices(run: &BlendRun, picture: Option<&str>, out: &mut impl Write) -> Result {
    let target = run.pictured();
    let names: Vec<&str> = run.adapters.iter().map(|adapter| adapter.name.as_str()).collect();
    writeln!(out, "\n## Each state on {target}\n")?;
    writeln!(
        out,
        "Each cell has the route, then for each driver in turn ({}) the farthest tier that some value fell in:",
        names.join(", ")
    )?;
    writeln!(
        out,
        "e exact, n nearest, i either neighbour, b within the bound, ✗ outside, · a float target, – not drawn.\n"
    )?;
    if let Some(picture) = picture {
        writeln!(out, "![The largest error of each state, by equation and driver]({picture})\n")?;
    }
    for equation in READING {
        writeln!(out, "### {}\n", equation.name())?;
        write!(out, "| src ↓ dst → |")?;
        for dst in Factor::ALL {
            write!(out, " {} |", dst.name())?;
        }
        writeln!(out, "\n|---|{}", "---|".repeat(Factor::ALL.len()))?;
        for src in Factor::ALL {
            write!(out, "| {} |", src.name())?;
            for dst in Factor::ALL {
                let state = State { equation, src, dst };
                write!(out, " {} {} |", route_letters(state), letters(run, target, state))?;
            }
            writeln!(out)?;
        }
        writeln!(out)?;
    }
    for equation in [Equation::Min, Equation::Max] {
        let state = State { equation, src: Factor::One, dst: Factor::One };
        writeln!(
            out,
            "### {}\n\nAll 225 pairs of factors: {} {}\n",
            equation.name(),
            route_letters(state),
            letters(run, target, state)
        )?;
    }
    Ok(())
}

fn letters(run: &BlendRun, target: &str, state: State) -> String {
    let letter = |adapter| run.row(adapter, target, state).map_or("–", letter);
    run.adapters.iter().map(letter).collect()
}

fn failures(run: &BlendRun, out: &mut impl Write) -> Result {
    writeln!(out, "## What fails\n")?;
    let mut failed = run.blend_states.iter().filter(|row| row.failed > 0).peekable();
    if failed.peek().is_none() {
        writeln!(out, "Nothing.\n")?;
    }
    for row in failed {
        writeln!(
            out,
            "* {} on {}, {}, {}: {} of {} values",
            row.id,
            row.adapter,
            row.target,
            row.route,
            row.failed,
            4 * row.cases
        )?;
    }
    Ok(())
}

fn special(run: &BlendRun, out: &mut impl Write) -> Result {
    if run.special.is_empty() {
        return Ok(());
    }
    writeln!(out, "## NaN and infinity\n")?;
    for promise in &run.blend_promises {
        writeln!(out, "* {}: {}.", promise.interface, promise.says)?;
    }
    writeln!(out, "\nSo nothing is promised. This is what drivers leave.\n")?;
    let mut columns: Vec<(&str, &str)> = vec![];
    let mut cases: Vec<&str> = vec![];
    for special in &run.special {
        let column = (special.adapter.as_str(), &*special.target);
        if !columns.contains(&column) {
            columns.push(column);
        }
        if !cases.contains(&special.id.as_str()) {
            cases.push(&special.id);
        }
    }
    write!(out, "| case |")?;
    for (adapter, target) in &columns {
        write!(out, " {adapter}, {target} |")?;
    }
    writeln!(out, "\n|---|{}", "---|".repeat(columns.len()))?;
    for case in cases {
        write!(out, "| {} |", case.rsplit('/').next().unwrap_or_default())?;
        for column in &columns {
            let found = run.special.iter().find(|s| s.id == case && (s.adapter.as_str(), &*s.target) == *column);
            write!(out, " {} |", found.map_or("–", |special| special.seen.as_str()))?;
        }
        writeln!(out)?;
    }
    Ok(())
}
