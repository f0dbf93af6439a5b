//! The cheapest row of each group whose largest error is at most a limit: how it is chosen, and how it is written for people.

use super::figures::{digits, error, time};
use super::text::told;
use crate::table::{Align, TextTable};
use lightmeter_document::bench::pareto::refusal;
use lightmeter_document::bench::recommendation::{Advice, Candidate, Inputs, Recommendation, SCHEMA};
use lightmeter_document::bench::{BenchDocument, BenchGroup, BenchRow, Errors};
use lightmeter_document::{Number, worse};
use std::fmt::{Display, Formatter, Result as Written, Write};
use std::str::FromStr;

/// How large an error may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// As it is: `1e-4`.
    Absolute(f64),
    /// In ULP of binary32: `4ulp`.
    Ulp(f64),
    /// In 1/255 of full scale: `0.5/255`, `0.5steps`.
    Steps(f64),
}

/// A limit that cannot be read.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LimitError {
    /// It is no number with a unit.
    #[error("error limit `{0}` is no number with a unit; expected 1e-4 (absolute), 4ulp, 0.5/255 or 0.5steps")]
    Form(String),
    /// No error is so small, or every one is.
    #[error("error limit `{0}` is negative or infinite; expected 0 or more, such as 1e-4, 4ulp or 0.5/255")]
    Range(String),
}

impl FromStr for Limit {
    type Err = LimitError;

    fn from_str(text: &str) -> Result<Self, LimitError> {
        let lower = text.trim().to_ascii_lowercase();
        let with_unit =
            ["ulp", "/255", "steps", "step"].into_iter().find_map(|unit| Some((lower.strip_suffix(unit)?, unit)));
        let (number, unit) = with_unit.unwrap_or((&lower, ""));
        let number: f64 = number.trim_end().parse().map_err(|_| LimitError::Form(text.to_owned()))?;
        match (number, unit) {
            (x, _) if x.is_nan() => Err(LimitError::Form(text.to_owned())),
            (x, _) if x.is_infinite() || x < 0.0 => Err(LimitError::Range(text.to_owned())),
            (x, "") => Ok(Self::Absolute(x)),
            (x, "ulp") => Ok(Self::Ulp(x)),
            (x, _) => Ok(Self::Steps(x)),
        }
    }
}

impl Display for Limit {
    fn fmt(&self, f: &mut Formatter<'_>) -> Written {
        match self {
            Self::Absolute(x) => write!(f, "{}", Number(*x)),
            Self::Ulp(x) => write!(f, "{}ulp", Number(*x)),
            Self::Steps(x) => write!(f, "{}/255", Number(*x)),
        }
    }
}

impl Limit {
    const fn number(self) -> f64 {
        match self {
            Self::Absolute(x) | Self::Ulp(x) | Self::Steps(x) => x,
        }
    }

    /// The largest error in the limit's unit.
    const fn of(self, errors: &Errors) -> f64 {
        match self {
            Self::Absolute(_) => errors.absolute.max.0,
            Self::Ulp(_) => errors.ulp.max.0,
            Self::Steps(_) => errors.steps.max.0,
        }
    }

    /// The unit behind an error.
    const fn unit(self) -> &'static str {
        match self {
            Self::Absolute(_) => "",
            Self::Ulp(_) => " ULP",
            Self::Steps(_) => "/255",
        }
    }
}

/// The cheapest row of each group on each adapter whose largest error on `inputs` is at most `limit`.
#[must_use]
pub fn recommend(document: &BenchDocument, limit: Limit, inputs: Inputs) -> Recommendation {
    let groups = document
        .adapters
        .iter()
        .flat_map(|measured| measured.groups.iter().map(|group| advice(&measured.adapter, group, limit, inputs)));
    let groups = groups.collect();
    let interrupted = document.interrupted.clone();
    Recommendation { schema: SCHEMA.into(), limit: limit.to_string(), inputs, groups, interrupted }
}

fn advice(adapter: &str, group: &BenchGroup, limit: Limit, inputs: Inputs) -> Advice {
    let has_hard = group.rows.iter().any(|row| row.hard.is_some());
    let inputs = if inputs == Inputs::All && !has_hard { Inputs::Random } else { inputs };
    let candidates: Vec<Candidate> = group.rows.iter().filter_map(|row| candidate(row, limit, inputs)).collect();
    let within = || candidates.iter().filter(|one| one.error.0 <= limit.number());
    // Of what is as fast as far as is known, the closest.
    let fastest = within().min_by(|a, b| a.ratio.total_cmp(&b.ratio));
    let ties = within().filter(|one| fastest.is_some_and(|fastest| one.spread[0] <= fastest.spread[1]));
    let chosen = ties.min_by(|a, b| a.error.0.total_cmp(&b.error.0).then(a.ratio.total_cmp(&b.ratio))).cloned();
    // A NaN is as far off as can be.
    let distance = |one: &Candidate| if one.error.0.is_nan() { f64::INFINITY } else { one.error.0 };
    let closest = candidates.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.ns.total_cmp(&b.ns)));
    let closest = closest.filter(|_| chosen.is_none()).cloned();
    let reason = match (&chosen, &closest) {
        (Some(_), _) => None,
        (None, Some(one)) => Some(format!("the closest, {}, errs by {}{}", one.row, error(one.error.0), limit.unit())),
        (None, None) if inputs == Inputs::Hard && !has_hard => Some("it has no hard cases".into()),
        (None, None) => Some("no row was measured that is right in value and runs in a shader".into()),
    };
    let BenchGroup { id, title, unit, .. } = group;
    let (adapter, group, title, unit) = (adapter.to_owned(), id.clone(), title.clone(), unit.clone());
    Advice { adapter, group, title, unit, chosen, closest, reason }
}

/// The row with its largest error, where it can be taken and was timed and measured on those inputs.
fn candidate(row: &BenchRow, limit: Limit, inputs: Inputs) -> Option<Candidate> {
    if refusal(row).is_some() {
        return None;
    }
    let (random, hard) = (row.random.as_ref().map(|e| limit.of(e)), row.hard.as_ref().map(|e| limit.of(e)));
    let error = match inputs {
        Inputs::Random => random?,
        Inputs::Hard => hard?,
        Inputs::All => worse(random?, hard?),
    };
    let time = row.time.as_ref().filter(|time| time.ns.is_finite())?;
    let (row, what) = (row.name.clone(), row.what.clone());
    Some(Candidate { row, what, ns: time.ns, ratio: time.ratio, spread: time.spread, error: Number(error) })
}

/// Writes it for people.
///
/// # Errors
/// Where the writer fails.
pub fn write(recommendation: &Recommendation, out: &mut impl Write) -> Written {
    let inputs = match recommendation.inputs {
        Inputs::Random => "random inputs",
        Inputs::Hard => "hard cases",
        Inputs::All => "random inputs and hard cases",
    };
    let unit = recommendation.limit.parse().map_or("", Limit::unit);
    writeln!(out, "the cheapest whose largest error on {inputs} is at most {}", recommendation.limit)?;
    if let Some(interrupted) = &recommendation.interrupted {
        told("interrupted: ", &interrupted.to_string(), out)?;
    }
    for of_adapter in recommendation.groups.chunk_by(|a, b| a.adapter == b.adapter) {
        writeln!(out, "\n{}", of_adapter.first().map_or("", |one| &one.adapter))?;
        let (left, right) = (Align::Left, Align::Right);
        let columns = [("", left), ("", left), ("time", right), ("over the baseline", right), ("error", left)];
        let mut table = TextTable::new(&columns);
        for one in of_adapter {
            table.row(match (&one.chosen, &one.reason) {
                (Some(chosen), _) => [
                    one.group.clone(),
                    chosen.row.clone(),
                    time(chosen.ns),
                    format!("{} ×", digits(chosen.ratio)),
                    format!("{}{unit}", error(chosen.error.0)),
                ],
                (None, reason) => {
                    let reason = reason.as_deref().unwrap_or_default();
                    [one.group.clone(), "none".into(), String::new(), String::new(), reason.into()]
                }
            });
        }
        out.write_str(&table.text("  "))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::{document, errors, group, row};
    use super::*;
    use lightmeter_document::Document as _;

    #[test]
    fn limits_are_read_with_their_units() {
        let rows = [
            ("1e-4", Limit::Absolute(1e-4)),
            ("0", Limit::Absolute(0.0)),
            ("4ulp", Limit::Ulp(4.0)),
            (" 4 ULP ", Limit::Ulp(4.0)),
            ("0.5/255", Limit::Steps(0.5)),
            ("0.5steps", Limit::Steps(0.5)),
            ("1 step", Limit::Steps(1.0)),
        ];
        for (text, expected) in rows {
            assert_eq!(text.parse(), Ok(expected), "{text}");
            assert_eq!(expected.to_string().parse(), Ok(expected), "{expected} is read again");
        }
        for text in ["", "ulp", "4ulps", "four", "0.5/256", "1/", "/255", "1e-4 m", "NaN", "nanulp", "1,5", "4 u lp"] {
            let error = text.parse::<Limit>().expect_err(text);
            assert_eq!(error, LimitError::Form(text.into()));
            assert!(error.to_string().contains("expected 1e-4 (absolute), 4ulp, 0.5/255 or 0.5steps"), "{error}");
        }
        for text in ["-1e-4", "-4ulp", "inf", "inf/255", "1e999"] {
            assert_eq!(text.parse::<Limit>(), Err(LimitError::Range(text.into())));
        }
        assert_eq!("hard".parse(), Ok(Inputs::Hard));
        assert!("easy".parse::<Inputs>().expect_err("no such inputs").to_string().contains("random, hard or all"));
    }

    /// A row: its name, nanoseconds, and largest error in ULP on random inputs and on hard cases.
    type Made = (&'static str, f64, f64, Option<f64>);
    /// What a row of the table pins: rows, limit and inputs; the row chosen, or the closest.
    type Choice<'a> = (&'a str, &'a [Made], Limit, Inputs, Option<&'a str>, Option<&'a str>);

    fn with(rows: &[Made]) -> BenchGroup {
        let of = |&(name, ns, random, hard): &Made| {
            let mut row = row(name, ns, ns, random);
            row.hard = hard.map(errors);
            row
        };
        group("technique/made-up", rows.iter().map(of).collect())
    }

    #[test]
    fn the_cheapest_within_the_limit_is_chosen() {
        let ladder = [
            ("coarse", 1.0, 50.0, Some(f64::INFINITY)),
            ("plain", 2.0, 3.0, Some(900.0)),
            ("stable", 3.0, 1.0, Some(2.0)),
        ];
        let plain = [("coarse", 1.0, 50.0, None), ("plain", 2.0, 3.0, None)];
        let rows: [Choice; 10] = [
            ("random alone", &ladder, Limit::Ulp(4.0), Inputs::Random, Some("plain"), None),
            ("the limit itself is within", &ladder, Limit::Ulp(3.0), Inputs::Random, Some("plain"), None),
            ("both must hold", &ladder, Limit::Ulp(4.0), Inputs::All, Some("stable"), None),
            ("a worse hard case counts", &ladder, Limit::Ulp(1.5), Inputs::All, None, Some("stable")),
            ("hard alone", &ladder, Limit::Ulp(1000.0), Inputs::Hard, Some("plain"), None),
            ("the closest miss", &ladder, Limit::Ulp(0.5), Inputs::Random, None, Some("stable")),
            ("no hard cases: random alone", &plain, Limit::Ulp(4.0), Inputs::All, Some("plain"), None),
            ("no hard cases asked for", &plain, Limit::Ulp(4.0), Inputs::Hard, None, None),
            (
                "among ties the closest",
                &[("fast", 1.0, 9.0, None), ("tie", 1.01, 2.0, None)],
                Limit::Ulp(10.0),
                Inputs::All,
                Some("tie"),
                None,
            ),
            ("another unit", &ladder, Limit::Steps(1e6), Inputs::Random, Some("coarse"), None),
        ];
        for (pins, rows, limit, inputs, chosen, closest) in rows {
            let advice = advice("made-up", &with(rows), limit, inputs);
            assert_eq!(advice.chosen.as_ref().map(|one| one.row.as_str()), chosen, "{pins}");
            assert_eq!(advice.closest.as_ref().map(|one| one.row.as_str()), closest, "{pins}");
            assert_eq!(advice.reason.is_none(), chosen.is_some(), "{pins}");
        }
    }

    #[test]
    fn what_cannot_be_taken_is_never_chosen() {
        let mut group = with(&[("cpu-f32", 0.1, 0.0, None), ("a", 1.0, 0.0, None), ("b", 2.0, 0.0, None)]);
        let chosen = |group: &BenchGroup| advice("x", group, Limit::Ulp(1.0), Inputs::All).chosen.map(|one| one.row);
        assert_eq!(chosen(&group).as_deref(), Some("a"), "a rung on the processor is none of a shader");
        group.rows[1].disqualified = Some("another model".into());
        assert_eq!(chosen(&group).as_deref(), Some("b"));
        group.rows[2].unavailable = Some("no such feature".into());
        assert_eq!(chosen(&group), None);
        group.rows[2].unavailable = None;
        group.rows[2].random = Some(errors(f64::NAN));
        assert_eq!(chosen(&group), None, "what is no number is within no limit");
        group.rows[2].random = Some(errors(0.0));
        group.rows[2].time = None;
        assert_eq!(chosen(&group), None, "what was not timed is not known to be cheap");
    }

    #[test]
    fn it_is_written_for_people_and_programs() {
        let document = document();
        let found = recommend(&document, Limit::Ulp(4.0), Inputs::All);
        assert!(
            found.groups.iter().any(|one| one.chosen.is_some()) && found.groups.iter().any(|one| one.chosen.is_none())
        );
        let mut text = String::new();
        write(&found, &mut text).expect("a string takes all");
        let mut lines = text.lines();
        for one in &found.groups {
            let line =
                lines.find(|line| line.split_whitespace().next() == Some(&one.group)).expect("a line each, in order");
            let named = one.chosen.as_ref().or(one.closest.as_ref());
            assert!(named.is_none_or(|row| line.contains(&row.row)), "{line}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= 120));
        let json = found.to_json().expect("it can be written");
        assert_eq!(Recommendation::read(&json).expect("it is read again"), found);
        assert_eq!((found.limit.as_str(), found.inputs), ("4ulp", Inputs::All));
    }
}
