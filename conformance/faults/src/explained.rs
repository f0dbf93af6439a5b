//! What explains a failing case without its renderer: the formula's steps, the mistake, and the output's course along an input.

use super::fault::Fault;
use super::seen::SeenStep;
use super::variation::Variation;
use lightmeter_arithmetic::{Accept, Profile, Trace, trace};
use lightmeter_catalogue::cases::{Domain, Kind};
use lightmeter_catalogue::select::{CaseRef, Member, catalogue};
use lightmeter_document::explained::{
    CoursePoint, Explained, HeldNumber, MistakenStep, OutputCourse, ShownMistake, ShownStep,
};
use lightmeter_document::report::{Failure, Group, Report};
use lightmeter_document::{Number, Word};
use lightmeter_judge::formula::{by_name, units};
use std::collections::{BTreeMap, HashSet};

/// Points of a course.
const POINTS: u32 = 97;
/// The most cases that are explained.
const MOST: usize = 500;
/// The most formulas that pass of which a case is explained.
const MOST_PASSING: usize = 24;

/// What explains the first failing case of each formula on each adapter, and the worst case of those that pass.
#[must_use]
pub fn explain(report: &Report, profile: &Profile) -> Vec<Explained> {
    let mut explained = explain_failures(&report.failures, &report.groups, profile);
    explained.extend(explain_worst(&report.groups, profile));
    explained
}

fn explain_failures(failures: &[Failure], groups: &[Group], profile: &Profile) -> Vec<Explained> {
    let catalogue = catalogue();
    let (mut explained, mut seen) = (vec![], HashSet::new());
    for failure in failures {
        let is_its = |member: &&Member| {
            failure.id.strip_prefix(&member.spec.id).is_some_and(|rest| rest.starts_with('/'))
                || member.case(&failure.id).is_some()
        };
        let Some(member) = catalogue.iter().find(is_its) else { continue };
        if explained.len() == MOST || !seen.insert((member.spec.id.clone(), &failure.adapter)) {
            continue;
        }
        let Some(inputs) = inputs_of(failure, member) else { continue };
        let is_group = |group: &&Group| {
            group.adapter == failure.adapter && group.stage == failure.stage && group.has_case(&failure.id)
        };
        let mistakes = groups.iter().find(is_group).map_or_else(Vec::new, Group::mistakes);
        explained.push(explained_case(&failure.id, member, &inputs, &failure.output, &mistakes, profile));
    }
    explained
}

/// What explains the case that comes nearest to what is illegal, of each formula that passes; nothing where there are more of them than anyone
/// looks at one by one.
fn explain_worst(groups: &[Group], profile: &Profile) -> Vec<Explained> {
    let failing: HashSet<&str> =
        groups.iter().filter(|group| group.totals.failed > 0).map(|group| group.id.as_str()).collect();
    let mut formulas: Vec<&Group> = vec![];
    for group in groups.iter().filter(|group| !failing.contains(group.id.as_str())) {
        match formulas.iter_mut().find(|worst| worst.id == group.id) {
            Some(worst) if worst.margin_max.0 < group.margin_max.0 => *worst = group,
            Some(_) => {}
            None => formulas.push(group),
        }
    }
    if formulas.len() > MOST_PASSING {
        return vec![];
    }
    let catalogue = catalogue();
    let explained = |group: &Group| {
        let (id, answer) = (group.worst.as_ref()?, group.worst_answer.as_ref()?);
        let member = catalogue.iter().find(|member| member.spec.id == group.id)?;
        let inputs = row(&answer.inputs);
        if inputs.len() != member.spec.input_len() {
            return None;
        }
        let explained = explained_case(id, member, &inputs, &answer.output, &[], profile);
        let inputs = by_name(member, &inputs, |x| serde_json::to_value(Number(x.into())).unwrap_or_default());
        Some(Explained { inputs, units: units(member), ..explained })
    };
    formulas.into_iter().filter_map(explained).collect()
}

/// The row of a failing case.
fn inputs_of(failure: &Failure, member: &Member) -> Option<Vec<f32>> {
    let mut row = vec![];
    if let Some(answer) = &failure.answer {
        row = self::row(&answer.inputs);
    } else {
        for input in member.spec.inputs {
            let value = failure.inputs_hex.get(input.name)?;
            let numbers = value.as_array().map_or(std::slice::from_ref(value), Vec::as_slice);
            for number in numbers {
                let bits = u32::from_str_radix(number.as_str()?.strip_prefix("0x")?, 16).ok()?;
                row.push(f32::from_bits(bits));
            }
        }
    }
    (row.len() == member.spec.input_len()).then_some(row)
}

/// Inputs of a document as a row.
#[expect(clippy::cast_possible_truncation, reason = "inputs are f32, widened")]
fn row(inputs: &[Number]) -> Vec<f32> {
    inputs.iter().map(|x| x.0 as f32).collect()
}

fn explained_case(
    id: &str,
    member: &Member,
    inputs: &[f32],
    output: &str,
    mistakes: &[Word],
    profile: &Profile,
) -> Explained {
    let spec = &member.spec;
    let mut outputs = vec![Trace { value: 0.0, interval: Accept::ANY }; spec.output_len()];
    let ((), steps) = trace::record(|| member.formula.trace(inputs, profile, &mut outputs));
    let faults: Vec<&'static Fault> = mistakes.iter().filter_map(|name| Fault::by_name(name)).collect();
    let variation = if faults.is_empty() { None } else { Variation::new(member, &faults) };
    let place = (0..spec.output_len()).find(|&k| spec.output_name(k) == output).unwrap_or_default();
    Explained {
        id: id.to_owned(),
        formula: spec.text.into(),
        inputs: serde_json::Map::new(),
        units: BTreeMap::new(),
        rules: spec.rules().into_iter().map(|rule| rule.to_string().into()).collect(),
        source: spec.source.into(),
        steps: steps.iter().map(shown_step).collect(),
        mistake: variation.as_ref().map(|variation| shown_mistake(variation, member, inputs, profile)),
        course: best_course(member, inputs, place, variation.as_ref(), profile),
    }
}

/// A step with the component that it is of a vector, `x`, or of a colour, `r`.
#[must_use]
pub fn shown_step(step: &trace::TraceStep) -> ShownStep {
    let letters = if is_colour(step.name) { ["r", "g", "b", "a"] } else { ["x", "y", "z", "w"] };
    ShownStep {
        name: step.name.into(),
        component: step.component.and_then(|place| letters.get(place)).map(|&letter| letter.into()),
        value: Number(step.result.value),
        interval: bounds(&step.result.interval),
    }
}

/// Whether a step of several numbers is a colour: the terms of lighting and blending, and what is made of a colour.
fn is_colour(name: &str) -> bool {
    name.starts_with('C') || name.contains("color") || ["I", "S", "D", "mix", "encoded", "decoded"].contains(&name)
}

fn bounds(interval: &Accept) -> [Number; 2] {
    [Number(interval.low()), Number(interval.high())]
}

/// What a renderer with a mistake gives for a row of inputs.
#[must_use]
pub fn shown_mistake(variation: &Variation<'_>, member: &Member, inputs: &[f32], profile: &Profile) -> ShownMistake {
    let count = member.spec.output_len();
    let (mut value, mut legal) = (vec![0.0_f64; count], vec![Accept::ANY; count]);
    variation.evaluate(inputs, &mut value);
    variation.interval(inputs, profile, &mut legal);
    let output = |k: usize| ShownStep {
        name: member.spec.output_name(k).into(),
        component: None,
        value: Number(value[k]),
        interval: bounds(&legal[k]),
    };
    let step =
        |SeenStep { name, right, made }| MistakenStep { name: name.into(), right: Number(right), made: Number(made) };
    let names: Vec<&str> = variation.faults.iter().map(|fault| fault.name).collect();
    ShownMistake {
        name: names.join(" and ").into(),
        says: variation.says().into(),
        outputs: (0..count).map(output).collect(),
        steps: variation.steps(inputs).into_iter().map(step).collect(),
    }
}

/// The course along the input on which the mistake shows best, or along which the output varies most where there is none.
fn best_course(
    member: &Member,
    inputs: &[f32],
    output: usize,
    variation: Option<&Variation<'_>>,
    profile: &Profile,
) -> Option<OutputCourse> {
    if !matches!(member.spec.kind, Kind::Arithmetic | Kind::Blend(_)) {
        return None;
    }
    let courses = (0..inputs.len()).filter_map(|input| course(member, inputs, (input, output), variation, profile));
    first_best(courses)
}

/// A formula's first output along the input on which it varies most, of a surface that is lit, with the middle of the domain of everything else, or
/// at one of its random cases.
#[must_use]
pub fn typical_course(member: &Member, profile: &Profile) -> Option<OutputCourse> {
    const CASES: u64 = 3;
    let row = |case| {
        let mut row = vec![];
        member.inputs(case, 1, &mut row);
        row
    };
    let mut lit = vec![];
    for input in member.spec.inputs {
        match input.lit() {
            Some(place) => lit.extend_from_slice(place),
            None => input.middle(&mut lit),
        }
    }
    let rows: Vec<Vec<f32>> = std::iter::once(lit).chain((0..CASES).map(|case| row(CaseRef::Random(case)))).collect();
    // The first output, or another where that one does not vary.
    (0..member.spec.output_len())
        .find_map(|output| first_best(rows.iter().filter_map(|row| best_course(member, row, output, None, profile))))
}

/// The clearest of several courses, of equals the first.
fn first_best(courses: impl Iterator<Item = OutputCourse>) -> Option<OutputCourse> {
    let mut best: Option<(f64, OutputCourse)> = None;
    for course in courses {
        let clarity = clarity(&course);
        if clarity > best.as_ref().map_or(0.0, |(most, _)| *most) {
            best = Some((clarity, course));
        }
    }
    best.map(|(_, course)| course)
}

/// How much of it a course shows: how many of its points tell the mistake, and how far its values vary.
fn clarity(course: &OutputCourse) -> f64 {
    let points = || course.points.iter();
    let tells = |point: &&CoursePoint| {
        let [low, high] = point.interval;
        point.mistaken.is_some_and(|mistaken| !(low.0..=high.0).contains(&mistaken.0))
    };
    let finite = || points().map(|point| point.reference.0).filter(|x| x.is_finite());
    let (least, most) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    // A colour goes straight up with most of the colours that it is made of, and so does anything with what it is a multiple of: that tells
    // little. So does a pole, beside which all else is level.
    let plain = |is_plain: bool| if is_plain { 0.25 } else { 1.0 };
    let weight = plain(course.unit.as_deref() == Some("color"))
        * plain(is_straight(course))
        * evenness(course)
        * smoothness(course);
    let variation = if most > least { weight * ((most - least) / most.abs().max(least.abs())).min(1.0) } else { 0.0 };
    #[expect(clippy::cast_precision_loss, reason = "a hundred points")]
    let telling = points().filter(tells).count() as f64 / f64::from(POINTS);
    if variation > 0.0 || telling > 0.0 { telling + variation } else { 0.0 }
}

/// Whether an output goes along a straight line, as far as is seen.
fn is_straight(course: &OutputCourse) -> bool {
    const SEEN: f64 = 0.01;
    let (Some(first), Some(last)) = (course.points.first(), course.points.last()) else { return true };
    let [from, to] = [first, last].map(|point| point.x.0);
    let share =
        |x: f64| if course.is_logarithmic { (x / from).ln() / (to / from).ln() } else { (x - from) / (to - from) };
    let [a, b] = [first, last].map(|point| point.reference.0);
    let off = |point: &CoursePoint| (point.reference.0 - (a + (b - a) * share(point.x.0))).abs();
    course.points.iter().all(|point| off(point) <= SEEN * (b - a).abs())
}

/// The share of the span of an output's values that nine tenths of them fill.
fn evenness(course: &OutputCourse) -> f64 {
    let mut values: Vec<f64> = course.points.iter().map(|point| point.reference.0).filter(|x| x.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let (Some(least), Some(most)) = (values.first(), values.last()) else { return 0.0 };
    let outer = values.len() / 20;
    let inner = values[values.len() - 1 - outer] - values[outer];
    // A course that is level but for a narrow peak is still one.
    const LEAST: f64 = 0.1;
    if most > least { (inner / (most - least)).max(LEAST) } else { 1.0 }
}

/// 1, or less where one step from a point to the next is most of what an output varies: such a course is two level lines.
fn smoothness(course: &OutputCourse) -> f64 {
    const OF_A_JUMP: f64 = 0.4;
    let finite = || course.points.iter().map(|point| point.reference.0).filter(|x| x.is_finite());
    let values: Vec<f64> = finite().collect();
    let (least, most) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let step = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    if step > 0.5 * (most - least) { OF_A_JUMP } else { 1.0 }
}

/// An output along a number of the inputs; `None` where that is drawn from no range.
#[must_use]
fn course(
    member: &Member,
    inputs: &[f32],
    (input, output): (usize, usize),
    variation: Option<&Variation<'_>>,
    profile: &Profile,
) -> Option<OutputCourse> {
    let spec = &member.spec;
    let at = inputs[input];
    let (from, to, is_logarithmic, unit) = range(member, inputs, input)?;
    let (from, to) = (from.min(at.into()), to.max(at.into()));
    if !(from.is_finite() && to.is_finite() && from < to) || (is_logarithmic && from <= 0.0) {
        return None;
    }
    let count = spec.output_len();
    let (mut reference, mut legal) = (vec![0.0_f64; count], vec![Accept::ANY; count]);
    let mut mistaken = vec![0.0_f64; count];
    let mut row = inputs.to_vec();
    let mut xs: Vec<f64> = (0..POINTS)
        .map(|k| {
            let share = f64::from(k) / f64::from(POINTS - 1);
            if is_logarithmic { from * (to / from).powf(share) } else { from + share * (to - from) }
        })
        .collect();
    xs.push(at.into());
    xs.sort_by(f64::total_cmp);
    let mut point = |x: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "an input is an f32")]
        let x = x as f32;
        row[input] = x;
        member.formula.reference(&row, &mut reference);
        member.formula.interval(&row, profile, &mut legal);
        let mistaken = variation.map(|variation| {
            variation.evaluate(&row, &mut mistaken);
            Number(mistaken[output])
        });
        CoursePoint {
            x: Number(x.into()),
            reference: Number(reference[output]),
            interval: bounds(&legal[output]),
            mistaken,
        }
    };
    Some(OutputCourse {
        input: spec.input_name(input),
        unit: (!unit.is_empty()).then(|| unit.into()),
        output: spec.output_name(output),
        at: Number(at.into()),
        held: held(member, inputs, input),
        is_logarithmic,
        points: xs.into_iter().map(&mut point).collect(),
    })
}

/// All numbers of the inputs but the one that changes.
fn held(member: &Member, inputs: &[f32], free: usize) -> Vec<HeldNumber> {
    let spec = &member.spec;
    let units = spec.inputs.iter().flat_map(|input| vec![input.unit; input.shape.components()]);
    let number = |(place, (unit, &value)): (usize, (&'static str, &f32))| HeldNumber {
        name: spec.input_name(place),
        value: Number(value.into()),
        unit: (!unit.is_empty()).then(|| unit.into()),
    };
    units.zip(inputs).enumerate().filter(|(place, _)| *place != free).map(number).collect()
}

/// From where to where a number of the inputs goes, whether by its logarithm, and its unit.
fn range(member: &Member, inputs: &[f32], number: usize) -> Option<(f64, f64, bool, &'static str)> {
    let mut start = 0;
    for input in member.spec.inputs {
        let end = start + input.shape.components();
        if (start..end).contains(&number) {
            let length = || inputs[start..end].iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
            let (from, to, is_logarithmic) = match input.domain {
                Domain::Uniform(low, high) => (low.into(), high.into(), false),
                Domain::LogUniform(low, high) => (low.into(), high.into(), true),
                Domain::Unit => (0.0, 1.0, false),
                Domain::Vector(..) => (-length(), length(), false),
                _ => return None,
            };
            return Some((from, to, is_logarithmic, input.unit));
        }
        start = end;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(value: impl Fn(f64) -> f64) -> OutputCourse {
        let point = |k: u32| {
            let x = f64::from(k) / 96.0;
            let reference = Number(value(x));
            CoursePoint { x: Number(x), reference, interval: [reference; 2], mistaken: None }
        };
        OutputCourse {
            input: "x".into(),
            unit: None,
            output: "f".into(),
            at: Number(0.0),
            held: vec![],
            is_logarithmic: false,
            points: (0..97).map(point).collect(),
        }
    }

    #[test]
    fn a_curve_is_clearer_than_a_line_a_pole_or_a_jump() {
        let curve = clarity(&along(|x| (-4.0 * x).exp()));
        for (what, other) in [
            ("a line", clarity(&along(|x| x))),
            ("a pole", clarity(&along(|x| 1.0 / (x - 0.501)))),
            ("a jump", clarity(&along(|x| if x < 0.5 { 0.75 } else { 0.25 }))),
        ] {
            assert!(other > 0.0 && other < 0.6 * curve, "{what}: {other} beside {curve}");
        }
    }

    #[test]
    fn all_other_numbers_of_the_inputs_are_told() {
        let catalogue = catalogue();
        let member = catalogue.iter().find(|member| member.spec.id == "fog/exp").expect("there is one");
        let told = held(member, &[1.0, 2.0, 3.0, 0.5, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6], 3);
        let names: Vec<&str> = told.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names[..4], ["p.x", "p.y", "p.z", "fog.r"]);
        assert_eq!(told.len(), 9);
    }

    #[test]
    fn components_of_steps_are_of_a_vector_or_of_a_colour() {
        for (name, is_color) in [("CD", true), ("color", true), ("texel·color", true), ("n", false), ("⟨v⟩", false)]
        {
            assert_eq!(is_colour(name), is_color, "{name}");
        }
    }
}
