//! The page on hard cases, made from a run's JSON: naive against stable error with condition numbers, what stable forms
//! claim and cost, and a picture of both errors against the condition.

use crate::bench::figures::{grouped, scientific};
use crate::plot::{Chart, Quantity, Series, Undrawn, marker};
use lightmeter_document::Document as _;
use lightmeter_document::report::{Examined, Report, StableForm};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{Result as Written, Write};
use std::ops::Deref;

/// A run that hard cases were examined in.
#[derive(Clone, Debug)]
pub struct StabilityRun(Report);

impl Deref for StabilityRun {
    type Target = Report;

    fn deref(&self) -> &Report {
        &self.0
    }
}

/// What stages and adapters found of one case: the stable form at its worst, the naive one at its best.
struct Case<'a> {
    row: &'a Examined,
    stable: f64,
    naive: BTreeMap<&'a str, f64>,
    /// The naive form's error against its own exact value, at its greatest.
    rounding: f64,
    /// How many times more than its condition explains an unstable form errs.
    unstable_beyond: f64,
}

impl Case<'_> {
    /// What is wrong with the naive form: that it computes something else, its rounding, or no more than its condition.
    fn fault(&self) -> &'static str {
        let naive = self.least_naive();
        if self.rounding < 0.1 * naive {
            "another function"
        } else if naive > self.unstable_beyond * (1.0 + self.row.condition.0) {
            "unstable"
        } else {
            "as its condition"
        }
    }

    fn least_naive(&self) -> f64 {
        self.naive.values().copied().fold(f64::INFINITY, f64::min)
    }
}

impl StabilityRun {
    /// Reads the JSON.
    ///
    /// # Errors
    /// Where it is another document, or of a run without hard cases or without the claims of stable forms.
    pub fn read(json: &str) -> Result<Self, String> {
        let run = Report::read(json).map_err(|error| error.to_string())?;
        if run.stability.is_empty() {
            return Err("the run examined no hard case; expected one of `lightmeter run '*/*/hard'`".into());
        }
        if run.stable_forms.is_empty() {
            return Err("it does not say what stable forms claim, as older versions did not; run the cases anew".into());
        }
        Ok(Self(run))
    }

    fn cases(&self) -> Vec<Case<'_>> {
        let unstable_beyond = self.unstable_beyond.unwrap_or(f64::INFINITY);
        let mut cases: Vec<Case<'_>> = vec![];
        for row in &self.stability {
            let case = if let Some(place) = cases.iter().position(|case| case.row.id == row.id) {
                &mut cases[place]
            } else {
                cases.push(Case { row, stable: 0.0, naive: BTreeMap::new(), rounding: 0.0, unstable_beyond });
                cases.last_mut().expect("one was just put there")
            };
            case.stable = case.stable.max(row.stable.0);
            case.rounding = case.rounding.max(row.naive_rounding.0);
            let naive = case.naive.entry(&row.adapter).or_insert(f64::INFINITY);
            *naive = naive.min(row.naive.0);
        }
        cases
    }
}

/// The page. `picture` is the name of the SVG beside it.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(run: &StabilityRun, picture: Option<&str>, out: &mut impl Write) -> Written {
    let cases = run.cases();
    writeln!(out, "# Hard cases: where the naive form fails, and the form that does not\n")?;
    let quoted: Vec<String> = run.filter.iter().map(|glob| format!("'{glob}'")).collect();
    let filter = quoted.join(" ");
    let timing = if run.stable_costs.is_empty() { "" } else { " --timing" };
    writeln!(out, "Made by\n\n```\n./x run {filter} --adapter all{timing} --format json --out hard.json")?;
    writeln!(out, "./x page stability hard.json --out docs/stability.md\n```\n")?;
    for adapter in &run.adapters {
        writeln!(out, "* {}: {} ({})", adapter.name, adapter.device, adapter.driver)?;
    }
    let kept = cases.iter().filter(|case| case.stable <= case.row.bound).count();
    let failing = cases.iter().filter(|case| case.least_naive() >= case.row.naive_at_least.0).count();
    let families: BTreeSet<&str> = cases.iter().filter_map(|case| case.row.id.split('/').next()).collect();
    writeln!(
        out,
        "\n{} hard cases of {} families, each with 32 more within 3 ULP of it, in the compute and the fragment stage: the \
         stable form keeps its bound at {kept}, the naive form fails at {failing}, on every one of these adapters.\n",
        cases.len(),
        families.len()
    )?;
    writeln!(
        out,
        "Errors are in *roundings*: the distance from the exact value over 2⁻²⁴ of its size, or of 1 where the result is a \
         share of what is seen. One operation that rounds to nearest errs by at most one. The *condition* is how many \
         roundings of the result come of one rounding of each input. A naive form is *unstable* where it errs by more than \
         {} times what the condition explains. Where its error is smaller than that, inputs that were already rounded lose \
         just as much accuracy in any form, so that the stable form only helps if the inputs are exact. It is said to compute *another \
         function* if at least nine tenths of its error remain in exact arithmetic: a model that is wrong there, or a cosine of vectors \
         that are not quite unit for the angle between them.\n\nA bound holds at the hard cases and within 3 ULP of them. It covers all that \
         WGSL permits there, with directed rounding of sums and products and its bounds of the rest, which a test holds. Five forms are an \
         exception: their bounds hold only if the operations are executed as written, and the language allows a compiler to reassociate \
         them: `interpolation/edge-compensated`, `vector/face-normal-compensated`, `blend/subtract-compensated`, \
         `fog/exp2-document` and `fog/exp2-opengl`. Of those the intervals promise little or nothing.\n",
        run.unstable_beyond.unwrap_or_default()
    )?;
    if let Some(picture) = picture {
        writeln!(out, "![Errors of naive and stable forms against the condition]({picture})\n")?;
    }
    table(run, &cases, out)?;
    claims(run, &cases, out)
}

fn table(run: &StabilityRun, cases: &[Case<'_>], out: &mut impl Write) -> Written {
    let mut group = "";
    for case in cases {
        let (formula, name) = case.row.id.split_once("/hard/").unwrap_or((&case.row.id, ""));
        if formula != group {
            group = formula;
            writeln!(out, "\n### {formula}\n")?;
            write!(out, "| hard case | condition | stable | naive form |")?;
            for adapter in &run.adapters {
                write!(out, " {} |", adapter.name)?;
            }
            writeln!(out, " what is wrong with it | |")?;
            write!(out, "|---|--:|--:|---|")?;
            for _ in &run.adapters {
                write!(out, "--:|")?;
            }
            writeln!(out, "---|---|")?;
        }
        let row = case.row;
        write!(out, "| {name} | {} | {} | `{}` |", short(row.condition.0), short(case.stable), row.naive_formula)?;
        for adapter in &run.adapters {
            write!(out, " {} |", case.naive.get(adapter.name.as_str()).map_or("–".into(), |&naive| short(naive)))?;
        }
        writeln!(out, " {} | {} |", row.fails, case.fault())?;
    }
    writeln!(out)
}

fn claims(run: &StabilityRun, cases: &[Case<'_>], out: &mut impl Write) -> Written {
    writeln!(out, "## What stable forms claim, and what they cost\n")?;
    writeln!(
        out,
        "Nanoseconds of wall time for an evaluation in the compute stage, reading the inputs not counted: medians of turns \
         in which each form is measured. The ratio, with its quartiles, is that of the two times with the reading in both.\n"
    )?;
    writeln!(out, "| stable form | bound | seen | because | adapter | ns | naive form | ns | ratio |")?;
    writeln!(out, "|---|--:|--:|---|---|--:|---|--:|--:|")?;
    for StableForm { formula: id, bound, because } in &run.stable_forms {
        let of = |case: &&Case<'_>| case.row.id.starts_with(&format!("{id}/hard/"));
        let seen = cases.iter().filter(of).map(|case| case.stable).fold(0.0, f64::max);
        let mut costs = run.stable_costs.iter().filter(|cost| cost.formula == *id).peekable();
        if costs.peek().is_none() {
            writeln!(out, "| `{id}` | {bound} | {} | {because} | | | | | |", short(seen))?;
        }
        for (place, cost) in costs.enumerate() {
            let (seen, because) = if place == 0 { (short(seen), because.as_ref()) } else { (String::new(), "") };
            let name = if place == 0 { format!("`{id}` | {bound}") } else { " | ".into() };
            writeln!(
                out,
                "| {name} | {seen} | {because} | {} | {:.2} | `{}` | {:.2} | {:.2} ({:.2}–{:.2}) |",
                cost.adapter,
                cost.stable_ns.max(0.0),
                cost.naive,
                cost.naive_ns.max(0.0),
                cost.ratio,
                cost.quartiles[0],
                cost.quartiles[1]
            )?;
        }
    }
    Ok(())
}

/// Two digits, a power of ten for what is great or small.
fn short(x: f64) -> String {
    match x {
        x if x.is_infinite() => "no number".into(),
        0.0 => "0".into(),
        x if !(1e-2..99_999.5).contains(&x) => scientific(x),
        x if x >= 999.5 => grouped(x),
        x if x >= 10.0 => format!("{x:.0}"),
        x => format!("{x:.1}"),
    }
}

/// The error of each hard case's two forms against its condition, on logarithmic axes.
///
/// # Errors
/// Where the library that draws it fails.
pub fn svg(run: &StabilityRun) -> Result<String, Undrawn> {
    let cases = run.cases();
    let series = |name: &str, like: &str, error: fn(&Case<'_>) -> f64| Series {
        // What has lost less than a tenth of a rounding has lost nothing.
        large: cases.iter().map(|case| [case.row.condition.0.max(0.1), error(case).max(0.1)]).collect(),
        ..Series::new(name, marker(like, 0))
    };
    let explained = (0..=50).map(|step| {
        let condition = 10_f64.powf(f64::from(step) / 5.0 - 1.0);
        [condition, 1.0 + condition]
    });
    let chart = Chart {
        title: "Errors of naive and stable forms at hard cases".into(),
        below: "a mark for each hard case; the least and the worst of all adapters; 0.1 stands for all below it".into(),
        across: Quantity::new("condition: roundings of the result for one rounding of each input"),
        upwards: Quantity::new("error in roundings, 2⁻²⁴ of the result"),
        series: vec![
            series("naive form, at its best", "f64", |case| case.least_naive()),
            series("stable form, at its worst", "f32", |case| case.stable),
        ],
        line: Some(("what the condition explains".into(), explained.collect())),
        notes: vec![],
    };
    chart.svg()
}
