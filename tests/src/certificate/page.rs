//! The certificate as a page.

use super::{CASES, EXCEPTIONS, FormulaFinding, PER_CONDITION, WELL, WELL_CONDITIONED, Worst};
use std::fmt::Write as _;

/// The command that makes it.
const COMMAND: &str = "./x certificate > docs/certificate.md";

/// Findings by the first two segments of the id, so that blend states come by their equation.
#[must_use]
pub fn groups(findings: &[FormulaFinding]) -> Vec<FormulaFinding> {
    let mut groups: Vec<FormulaFinding> = vec![];
    for finding in findings {
        let end = finding.id.match_indices('/').nth(1).map_or(finding.id.len(), |(at, _)| at);
        let id = &finding.id[..end];
        match groups.iter_mut().find(|group| group.id == id) {
            Some(group) => group.merge(finding),
            None => groups.push(FormulaFinding { id: id.into(), ..finding.clone() }),
        }
    }
    groups
}

/// The page of a certificate of [`CASES`] random cases a formula.
#[must_use]
pub fn page(findings: &[FormulaFinding]) -> String {
    let mut all = FormulaFinding::default();
    findings.iter().for_each(|finding| all.merge(finding));
    let mut held = FormulaFinding::default();
    findings.iter().filter(|finding| finding.by_steps == 0).for_each(|finding| held.merge(finding));
    let mut page = head(&all, &held);
    page.push_str(&table(&groups(findings)));
    page.push_str(&exceptions(findings));
    page.push_str(&choices(&all));
    page
}

/// `held` is what was found of the formulas without an exception.
fn head(all: &FormulaFinding, held: &FormulaFinding) -> String {
    let mut page = String::from("# The certificate of the reference\n\n");
    let _ = write!(
        page,
        "Every formula in f64 and every interval of legal values against exact values of at least {} digits. Made by\n\n\
         ```\n{COMMAND}\n```\n\n\
         {} formulas, {} cases: {CASES} random ones each (fewer of states that are separate for alpha), every named hard case with those a few ULP away, \
         and edges, in which one number or one whole vector stands at an end of its domain, at 0, ±1, 1e±30, the least \
         subnormal, or beside another, or against it.\n\n",
        all.digits.unwrap_or(0),
        grouped(all.formulas),
        grouped(all.cases),
    );
    let _ = write!(
        page,
        "Of the {} formulas without an exception:\n\n| what | largest | where |\n|---|---|---|\n\
         | relative error, condition at most {WELL_CONDITIONED}; {WELL:e} is allowed | {} | {} |\n\
         | error over condition × {PER_CONDITION:e}, elsewhere; 1 is allowed | {} | {} |\n\
         | error over what the roundings of its steps come to; 1 is allowed | {} | {} |\n\n",
        grouped(held.formulas),
        exponential(held.well.figure),
        held.well.at,
        fraction(held.ill.figure),
        held.ill.at,
        fraction(held.of_steps.figure),
        held.of_steps.at,
    );
    let _ = write!(
        page,
        "* {} values were compared. {} outputs have no exact value, and the reference gives none; to {} more a step without \
         a value leads (or one beyond e^(2²⁴)), where the reference comes to a number: max(NaN, 0) is 0. On the way to {} \
         the reference exceeds what f64 holds. {} values lie below f64's normal range and are held by their steps alone.\n\
         * {} intervals hold the exact value, all of those that promise anything; {} permit any value.\n\
         * {} values err by more than their condition allows, and by no more than the roundings of their steps: the \
         exceptions below.\n\
         * {} values that the reference has as 0 are told from 0 by none of the exact value's digits, and are taken as right.\n\
         * Cases in which the reference chose otherwise than is right: {}.\n\n",
        grouped(all.compared),
        grouped(all.no_value),
        grouped(all.past_no_value),
        grouped(all.beyond_f64),
        grouped(all.subnormal),
        grouped(all.intervals),
        grouped(all.open),
        grouped(all.by_steps),
        grouped(all.zeros),
        grouped(all.ties.len() as u64),
    );
    page
}

fn table(groups: &[FormulaFinding]) -> String {
    let mut page = String::from(
        "## By formula\n\n\
         *Error*: the largest relative one where the condition is at most 100. *Of condition*: the largest over condition × \
         1e-15, elsewhere. *Of steps*: the largest over the roundings of the steps. A dash: none of that kind errs at all. A \
         star: some values are among the exceptions below.\n\n\
         | formula | formulas | cases | error | of condition | of steps | the largest error's case | no value | intervals | open |\n\
         |---|--:|--:|--:|--:|--:|---|--:|--:|--:|\n",
    );
    for group in groups {
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            if group.by_steps > 0 { format!("{} *", group.id) } else { group.id.clone() },
            grouped(group.formulas),
            grouped(group.cases),
            exponential(group.well.figure),
            fraction(group.ill.figure),
            fraction(group.of_steps.figure),
            group.well.at,
            grouped(group.no_value + group.past_no_value + group.beyond_f64),
            grouped(group.intervals),
            grouped(group.open),
        );
    }
    page
}

fn exceptions(findings: &[FormulaFinding]) -> String {
    let mut page = String::from(
        "\n## Exceptions\n\n\
         Where a formula as it is published loses more than its condition says. Each is granted by name and asserted to be \
         needed still; the roundings of the steps bound these values too.\n\n\
         | formulas | values | largest relative error | its case | why |\n|---|--:|--:|---|---|\n",
    );
    for exception in &EXCEPTIONS {
        let covered = |finding: &&FormulaFinding| finding.by_steps > 0 && (exception.covers)(&finding.id);
        let mut all = FormulaFinding::default();
        findings.iter().filter(covered).for_each(|finding| all.merge(finding));
        let mut names: Vec<String> = groups(&findings.iter().filter(covered).cloned().collect::<Vec<_>>())
            .into_iter()
            .map(|group| if group.formulas > 1 { format!("{} ({})", group.id, group.formulas) } else { group.id })
            .collect();
        names.sort();
        let Worst { figure, at } = &all.by_steps_worst;
        let _ = writeln!(
            page,
            "| {} | {} | {} | {at} | {} |",
            names.join(", "),
            grouped(all.by_steps),
            exponential(*figure),
            exception.reason
        );
    }
    page
}

fn choices(all: &FormulaFinding) -> String {
    let list = |cases: &[String]| cases.iter().fold(String::new(), |list, case| list + "* " + case + "\n");
    format!(
        "\n## Choices\n\nCases in which the reference chose otherwise than is right, within the roundings of what it compared: \
         {}.\n\n{}\nCases in which 115 digits do not tell two numbers apart, which are then taken as equal: {}.\n\n{}",
        all.ties.len(),
        list(&all.ties),
        all.undecided.len(),
        list(&all.undecided)
    )
    .replace("\n\n\n", "\n\n")
}

fn exponential(x: f64) -> String {
    if x > 0.0 { format!("{x:.1e}") } else { "–".into() }
}

fn fraction(x: f64) -> String {
    if x > 0.0 { format!("{x:.3}") } else { "–".into() }
}

/// 1,234,567.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
