//! The certificate of the reference and of the intervals: it holds, the page is the present one, and each of its checks
//! fails where it should.

use lightmeter::cases::{Formula, Input, Kind, Output, Reader, Spec, Writer, slot};
use lightmeter::select::catalogue;
use lightmeter_reference::Real;
use lightmeter_tests::certificate::{CASES, EXCEPTIONS, FormulaFinding, certify, certify_one, groups, page, problems};
use std::any::type_name;
use std::path::Path;

#[test]
fn the_reference_and_the_intervals_are_certified_and_the_page_says_so() {
    let findings = certify(CASES);
    let problems = problems(&findings);
    let first = &problems[..problems.len().min(20)];
    assert!(problems.is_empty(), "{} do not hold:\n{}", problems.len(), first.join("\n"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/certificate.md");
    let there = std::fs::read_to_string(path).expect("docs/certificate.md is there");
    let here = page(&findings);
    let differ = there.lines().zip(here.lines()).find(|(there, here)| there != here);
    assert!(there == here, "docs/certificate.md is not the present one, see the command in it: {differ:?}");
    assert_eq!(missing(&there), Vec::<String>::new());
}

/// The groups of formulas that a page has no row of, with the star of an exception or without.
fn missing(page: &str) -> Vec<String> {
    let mut groups: Vec<String> = catalogue().iter().map(|member| member.spec.group().into()).collect();
    groups.dedup();
    groups.retain(|group| !["", " *"].iter().any(|star| page.contains(&format!("\n| {group}{star} | "))));
    groups
}

#[test]
fn a_formula_that_is_left_out_is_missed() {
    let findings: Vec<FormulaFinding> = catalogue()
        .iter()
        .map(|member| FormulaFinding { id: member.spec.id.clone(), ..FormulaFinding::default() })
        .collect();
    assert_eq!(missing(&page(&findings)), Vec::<String>::new());
    let rest: Vec<FormulaFinding> = findings.into_iter().filter(|finding| finding.id != "vector/face-normal").collect();
    assert_eq!(missing(&page(&rest)), ["vector/face-normal"]);
    assert_eq!(groups(&rest).len() + 1, missing("").len());
}

/// x, and a departure from it in some arithmetics.
#[derive(Clone, Copy)]
enum Wrong {
    /// Nowhere.
    Nothing,
    /// By 1e-15 of itself in f64, with or without its bound.
    InF64,
    /// In the f64 whose value is reported alone.
    InTheReferenceAlone,
    /// By one part of 2³⁰ in the interval.
    InTheInterval,
    /// On the other side of a condition in f64.
    InAChoice,
    /// x/49·49 ≥ x, which f64 denies of some x.
    InATie,
    /// 0 for 1/0.
    InNoValue,
}

const INPUTS: &[Input] = &[Input::rgb("x")];

impl Formula for Wrong {
    fn spec(&self) -> Spec {
        const OUTPUTS: &[Output] = &[Output::new("y", lightmeter::cases::ValueShape::Scalar, "1")];
        Spec {
            id: "control/wrong".into(),
            text: "y = x",
            source: "",
            function: "",
            kind: Kind::Arithmetic,
            selectors: vec![],
            inputs: INPUTS,
            outputs: OUTPUTS,
            fit: None,
            within: None,
            hard: &[],
            stable: None,
            is_normalised: false,
        }
    }

    fn evaluate<R: Real>(&self, inputs: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        let [x, ..]: [R; 3] = inputs.at(const { slot(INPUTS, "x") });
        let number = R::literal;
        let is = |name: &str| type_name::<R>().contains(name);
        let (f64_alone, f64_too) = (type_name::<R>() == "f64", type_name::<R>() == "f64" || is("Running"));
        let choose = |a: R, b: R| R::if_ge(a, b, || x, || -x);
        out.scalar(match self {
            Self::InF64 if f64_too => x * number(1.0 + 1e-15),
            Self::InTheReferenceAlone if f64_alone => x * number(1.0 + 1e-15),
            Self::InTheInterval if is("Accept") => x * number(1.0 + 2.0_f64.powi(-20)),
            Self::InAChoice if f64_too => choose(number(0.0), number(1.0)),
            Self::InAChoice => choose(number(1.0), number(0.0)),
            Self::InATie => choose(x / number(49.0) * number(49.0), x),
            Self::InNoValue => number(1.0) / (x * number(0.0)),
            _ => x,
        });
    }
}

#[test]
fn whatever_is_wrong_is_found() {
    let broken = |wrong: Wrong| certify_one(wrong, 64).broken;
    assert_eq!(broken(Wrong::Nothing), Vec::<String>::new());
    for (wrong, said) in [
        (Wrong::InF64, "its steps by"),
        (Wrong::InTheReferenceAlone, "with its bound"),
        (Wrong::InTheInterval, "outside Accept"),
        (Wrong::InAChoice, "chooses otherwise"),
    ] {
        let broken = broken(wrong);
        assert!(broken.len() > 50 && broken.iter().any(|problem| problem.contains(said)), "{said}: {broken:?}");
    }
}

#[test]
fn what_cannot_be_compared_is_counted() {
    let tied = certify_one(Wrong::InATie, 256);
    assert!(tied.broken.is_empty() && tied.ties.len() > 5 && tied.undecided.len() > 200, "{tied:?}");
    assert_eq!(tied.compared + tied.ties.len() as u64, tied.cases);
    let none = certify_one(Wrong::InNoValue, 16);
    assert_eq!((none.compared, none.intervals, none.no_value), (0, 0, none.cases));
}

#[test]
fn an_exception_must_be_granted_and_needed() {
    let loses = |id: &str| FormulaFinding { id: id.into(), by_steps: 1, ..FormulaFinding::default() };
    let said = problems(&[loses("vector/reflect"), loses("lighting/two-lights")]);
    assert!(said[0].contains("above condition"), "{said:?}");
    assert_eq!(said.iter().filter(|problem| problem.contains("no longer needed")).count(), EXCEPTIONS.len() - 1);
}
