//! What failing cases have in common, where no mistake explains them.

use super::factor::digits;
use lightmeter_catalogue::select::Member;
use lightmeter_judge::diagnose::Answered;
use std::ops::Range;

/// The fewest cases of each kind that an input is held against.
const FEWEST: usize = 8;
/// The share of failing and of passing cases that an input must tell apart.
const APART: f64 = 0.97;
/// The share of the passing cases that lie where all failing ones do, at most.
const FEW: f64 = 0.25;

/// A part of a whole.
#[expect(clippy::cast_precision_loss, reason = "counts of cases are far below 2⁵³")]
pub(super) fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}

/// In words: the outputs that fail, on which side, and where in an input's range.
pub(super) fn in_common(
    member: &Member,
    places: &Range<usize>,
    failing: &[Answered<'_>],
    passing: &[Answered<'_>],
) -> Vec<String> {
    let mut told = vec![];
    let wrong = wrong_numbers(failing);
    if places.len() == member.spec.output_len() {
        if let Some(order) = order_of(member, failing) {
            return vec![order];
        }
        told.extend(outputs_of(member, &wrong));
    }
    told.extend(side_of(&wrong));
    told.extend(range_of(member, failing, passing));
    told
}

/// The order of the outputs in which every failing answer is legal: whoever answers has them in that one.
fn order_of(member: &Member, failing: &[Answered<'_>]) -> Option<String> {
    /// Answers that are legal in another order by chance are fewer.
    const LEAST: usize = 4;
    let outputs = member.spec.outputs;
    let mut starts = vec![0];
    starts.extend(outputs.iter().scan(0, |end, output| {
        *end += output.shape.components();
        Some(*end)
    }));
    let is_legal = |order: &[usize], row: &Answered<'_>| {
        let legal = row.legal;
        let places = order.iter().flat_map(|&output| starts[output]..starts[output + 1]);
        let decided = legal.iter().any(|interval| !interval.contains(f64::INFINITY));
        decided && places.zip(row.values).all(|(place, &value)| legal[place].contains(value.into()))
    };
    let mut orders = orders(outputs.len()).into_iter().filter(|order| !order.is_sorted());
    let found =
        orders.find(|order| failing.len() >= LEAST && failing.iter().all(|row| is_legal(order.as_slice(), row)))?;
    let names = |order: &mut dyn Iterator<Item = usize>| order.map(|k| outputs[k].name).collect::<Vec<_>>().join(", ");
    let (given, expected) = (names(&mut found.into_iter()), names(&mut (0..outputs.len())));
    Some(format!("the outputs are answered in the order {given}; expected {expected}"))
}

/// All orders of a few things.
fn orders(count: usize) -> Vec<Vec<usize>> {
    const MOST: usize = 4;
    if count == 0 || count > MOST {
        return vec![vec![]];
    }
    let with = |order: Vec<usize>| {
        (0..count).map(move |place| {
            let mut order = order.clone();
            order.insert(place, count - 1);
            order
        })
    };
    orders(count - 1).into_iter().flat_map(with).collect()
}

/// A number of an answer that is not legal.
struct WrongNumber {
    place: usize,
    value: f64,
    reference: f64,
}

fn wrong_numbers(failing: &[Answered<'_>]) -> Vec<WrongNumber> {
    let mut wrong = vec![];
    for row in failing {
        for (place, ((&value, legal), &reference)) in row.values.iter().zip(row.legal).zip(row.reference).enumerate() {
            if !legal.contains(value.into()) {
                wrong.push(WrongNumber { place, value: value.into(), reference });
            }
        }
    }
    wrong
}

/// The one output that fails alone, where there are several.
fn outputs_of(member: &Member, wrong: &[WrongNumber]) -> Option<String> {
    let mut start = 0;
    let places = member.spec.outputs.iter().map(|output| {
        let range = start..start + output.shape.components();
        start = range.end;
        (output.name, range)
    });
    let places: Vec<(&str, std::ops::Range<usize>)> = places.collect();
    let holds = |range: &std::ops::Range<usize>| wrong.iter().all(|number| range.contains(&number.place));
    let (name, range) = places.iter().find(|(_, range)| holds(range))?;
    let first = wrong.first()?.place;
    let is_one = range.len() > 1 && wrong.iter().all(|number| number.place == first);
    if is_one {
        return Some(format!("only {} is wrong", member.spec.output_name(first)));
    }
    (places.len() > 1).then(|| format!("only {name} is wrong"))
}

/// On which side of what is right the answers lie, or what all of them are.
fn side_of(wrong: &[WrongNumber]) -> Option<String> {
    let first = wrong.first()?.value;
    if wrong.iter().all(|number| number.value.is_nan()) {
        return Some("each wrong number is NaN".into());
    }
    if wrong.len() > 2 && wrong.iter().all(|number| number.value.to_bits() == first.to_bits()) {
        return Some(format!("each wrong number is {first}"));
    }
    if wrong.iter().all(|number| number.value > number.reference) {
        return Some("each wrong number is too great".into());
    }
    wrong.iter().all(|number| number.value < number.reference).then(|| "each wrong number is too small".into())
}

/// The input on one side of a bound of which nearly all failing cases lie, and on the other nearly all passing ones; or, where
/// there is none, all failing cases, and few passing ones.
fn range_of(member: &Member, failing: &[Answered<'_>], passing: &[Answered<'_>]) -> Option<String> {
    if failing.len() < FEWEST || passing.len() < FEWEST {
        return None;
    }
    let mut best: Option<(f64, String)> = None;
    let mut one_sided: Option<(f64, String)> = None;
    for input in member.spec.inputs {
        let range = member.spec.place(input.name)?;
        for place in range.clone() {
            let of = |rows: &[Answered<'_>]| rows.iter().map(|row| f64::from(row.inputs[place])).collect::<Vec<f64>>();
            let name = member.spec.input_name(place);
            for (beyond, bound, is_above) in one_sided_bounds(&of(failing), &of(passing)) {
                if beyond <= FEW && one_sided.as_ref().is_none_or(|(least, _)| beyond < *least) {
                    let side = if is_above { "at least" } else { "at most" };
                    let percent = digits(beyond * 100.0, 2);
                    let says = format!("all have {name} {side} {}, which {percent} % of the others have", told(bound));
                    one_sided = Some((beyond, says));
                }
            }
            let (apart, bound, is_above) = bound_of(of(failing), of(passing));
            if apart >= APART && best.as_ref().is_none_or(|(least, _)| apart > *least) {
                let side = if is_above { "above" } else { "at most" };
                best = Some((apart, format!("they have {name} {side} {}", told(bound))));
            }
        }
    }
    best.or(one_sided).map(|(_, says)| says)
}

/// A bound in three digits, or in as many as tell it from a whole number.
fn told(bound: f64) -> String {
    let is_whole = |x: f64| x.fract().abs() <= 0.0;
    let told = |count: i32| digits(bound, count);
    let tells = |count: &i32| is_whole(bound) || !told(*count).parse().is_ok_and(is_whole);
    (3..12).find(tells).map_or_else(|| bound.to_string(), told)
}

/// The least and the greatest of the first numbers, each with the share of the second ones that lie on the same side of it.
fn one_sided_bounds(first: &[f64], second: &[f64]) -> [(f64, f64, bool); 2] {
    let least = first.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = first.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let share_of =
        |is_beyond: &dyn Fn(f64) -> bool| share(second.iter().filter(|&&x| is_beyond(x)).count(), second.len());
    [(share_of(&|x| x >= least), least, true), (share_of(&|x| x <= greatest), greatest, false)]
}

/// The bound that tells numbers apart best: the lesser of the shares that lie on their own side of it, and whether the first lie above.
fn bound_of(mut first: Vec<f64>, mut second: Vec<f64>) -> (f64, f64, bool) {
    first.sort_by(f64::total_cmp);
    second.sort_by(f64::total_cmp);
    let above = |sorted: &[f64], bound: f64| {
        let at_most = sorted.partition_point(|x| *x <= bound);
        share(sorted.len() - at_most, sorted.len())
    };
    let mut best = (0.0, 0.0, true);
    for &bound in first.iter().chain(&second) {
        let (a, b) = (above(&first, bound), above(&second, bound));
        for (apart, is_above) in [(a.min(1.0 - b), true), (b.min(1.0 - a), false)] {
            if apart > best.0 {
                best = (apart, bound, is_above);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_tells_numbers_apart() {
        let (apart, bound, is_above) = bound_of(vec![5.0, 6.0, 7.0], vec![1.0, 2.0, 3.0]);
        assert_eq!((apart, bound, is_above), (1.0, 3.0, true));
        let bounds = one_sided_bounds(&[5.0, 6.0], &[1.0, 2.0, 5.5, 7.0]);
        assert_eq!(bounds, [(0.5, 5.0, true), (0.75, 6.0, false)]);
        assert_eq!([0.9996, 1.0, 12.344, 255.0].map(told), ["0.9996", "1.00", "12.3", "255"]);
        let (apart, ..) = bound_of(vec![1.0, 3.0, 5.0], vec![2.0, 4.0, 6.0]);
        assert!(apart < 0.7, "{apart}");
    }
}
