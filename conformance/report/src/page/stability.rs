//! The page on hard cases, made from a run's JSON: naive against stable error with condition numbers, what stable forms
//! claim and cost, and a picture of both errors against the condition.

use lightmeter_document::Document as _;
use lightmeter_document::run::{Examined, Report, StableForm};
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
         {} times what the condition explains. Where it errs by no more than that, inputs that were rounded before lose as \
         much in any form, and only inputs that are exact are done a favour. It computes *another function* where nine tenths \
         of its error are there in exact arithmetic too: a model that is wrong there, or a cosine of vectors that are not quite \
         unit for the angle between them.\n\nA bound holds at the hard cases and within 3 ULP of them. It covers all that \
         WGSL permits there, with directed rounding of sums and products and its bounds of the rest, which a test holds; but for \
         five forms whose bounds hold for the operations as they are written, since the language lets a compiler reassociate \
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
        x if !(1e-2..1e5).contains(&x) => format!("{x:.1e}"),
        x if x >= 10.0 => format!("{x:.0}"),
        x => format!("{x:.1}"),
    }
}

/// The picture's frame in pixels.
const LEFT: f64 = 76.0;
const TOP: f64 = 24.0;
const WIDTH: f64 = 600.0;
const HEIGHT: f64 = 440.0;
/// Powers of ten from the left end to the right one, and from the bottom to the top, where what is no number stands.
const CONDITIONS: (i32, i32) = (-1, 9);
const ERRORS: (i32, i32) = (-1, 14);

fn x_of(condition: f64) -> f64 {
    LEFT + WIDTH * share(condition, CONDITIONS)
}

fn y_of(error: f64) -> f64 {
    TOP + HEIGHT * (1.0 - share(error, ERRORS))
}

fn share(x: f64, (from, to): (i32, i32)) -> f64 {
    let (from, to) = (f64::from(from), f64::from(to));
    if x <= 0.0 { 0.0 } else { ((x.log10() - from) / (to - from)).clamp(0.0, 1.0) }
}

/// The error of each hard case's two forms against its condition, on logarithmic axes.
///
/// # Errors
/// Where the writer fails.
pub fn svg(run: &StabilityRun, out: &mut impl Write) -> Written {
    let (width, height) = (LEFT + WIDTH + 24.0, TOP + HEIGHT + 92.0);
    writeln!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">
<rect width="100%" height="100%" fill="#ffffff"/>"##
    )?;
    for power in CONDITIONS.0..=CONDITIONS.1 {
        let x = x_of(10_f64.powi(power));
        let (bottom, name) = (TOP + HEIGHT, TOP + HEIGHT + 16.0);
        writeln!(out, r##"<path d="M{x:.1} {TOP}V{bottom}" stroke="#e4e4e4"/>"##)?;
        writeln!(out, r#"<text x="{x:.1}" y="{name}" text-anchor="middle">{}</text>"#, axis(power))?;
    }
    for power in ERRORS.0..=ERRORS.1 {
        let (y, right) = (y_of(10_f64.powi(power)), LEFT + WIDTH);
        writeln!(out, r##"<path d="M{LEFT} {y:.1}H{right}" stroke="#e4e4e4"/>"##)?;
        let name = if power == ERRORS.1 { "no number".into() } else { axis(power) };
        writeln!(out, r#"<text x="{}" y="{:.1}" text-anchor="end">{name}</text>"#, LEFT - 6.0, y + 4.0)?;
    }
    explained(out)?;
    for case in run.cases() {
        let (x, name) = (x_of(case.row.condition.0), &case.row.id);
        let (naive, stable) = (y_of(case.least_naive()), y_of(case.stable));
        writeln!(
            out,
            r##"<g><title>{name}: naive {}, stable {}</title><path d="M{x:.1} {naive:.1}V{stable:.1}" stroke="#cccccc" stroke-width="0.6"/><path d="M{x:.1} {:.1}l4.5 7.8h-9z" fill="#d95f02" fill-opacity="0.75"/><circle cx="{x:.1}" cy="{stable:.1}" r="3.6" fill="#1f5fa8" fill-opacity="0.75"/></g>"##,
            short(case.least_naive()),
            short(case.stable),
            naive - 5.2
        )?;
    }
    let legend = TOP + HEIGHT + 58.0;
    let middle = LEFT + WIDTH / 2.0;
    writeln!(
        out,
        r##"<text x="{middle}" y="{}" text-anchor="middle">condition: roundings of the result for one of each input</text>"##,
        TOP + HEIGHT + 36.0
    )?;
    writeln!(
        out,
        r##"<path d="M{LEFT} {:.1}l4.5 7.8h-9z" fill="#d95f02"/><text x="{}" y="{legend}">naive form, at its best on any adapter</text>
<circle cx="{}" cy="{:.1}" r="3.6" fill="#1f5fa8"/><text x="{}" y="{legend}">stable form, at its worst</text>
<text x="{}" y="{}">error in roundings, 2⁻²⁴ of the result; at the left end conditions of 0.1 and less</text>
</svg>"##,
        legend - 9.0,
        LEFT + 10.0,
        LEFT + 290.0,
        legend - 4.0,
        LEFT + 300.0,
        LEFT - 4.0,
        legend + 20.0
    )
}

/// Where errors lie that the condition explains.
fn explained(out: &mut impl Write) -> Written {
    let mut path = String::new();
    for step in 0..=50 {
        let (from, to) = (f64::from(CONDITIONS.0), f64::from(CONDITIONS.1));
        let condition = 10_f64.powf(from + (to - from) * f64::from(step) / 50.0);
        let command = if step == 0 { 'M' } else { 'L' };
        write!(path, "{command}{:.1} {:.1}", x_of(condition), y_of(1.0 + condition))?;
    }
    writeln!(out, r##"<path d="{path}" fill="none" stroke="#666666" stroke-dasharray="5 4"/>"##)?;
    let (x, y) = (x_of(1e6), y_of(3e4));
    writeln!(out, r##"<text x="{x:.1}" y="{y:.1}" fill="#444444">what the condition explains</text>"##)
}

fn axis(power: i32) -> String {
    const SUPERSCRIPT: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |digit: char| match digit.to_digit(10) {
        Some(digit) => SUPERSCRIPT[digit as usize],
        None => '⁻',
    };
    format!("10{}", power.to_string().chars().map(raised).collect::<String>())
}
