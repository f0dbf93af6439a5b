//! Errors in roundings, condition numbers, and what they say together: whether a case is ill-conditioned or a form unstable.

use lightmeter_arithmetic::Accept;
use lightmeter_catalogue::cases::{AnyFormula, Size, Spec};
use lightmeter_catalogue::select::Member;
use lightmeter_document::Number;
use lightmeter_document::show::{Conditioning, FormStanding};

/// A rounding to nearest of a number near 1, at most.
pub const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// The error of a result in roundings.
#[must_use]
pub fn roundings(values: &[f64], exact: &[f64], size: Size) -> f64 {
    let off = norm(values.iter().zip(exact).map(|(value, exact)| value - exact));
    if off.is_nan() {
        return f64::INFINITY;
    }
    if off == 0.0 { 0.0 } else { off / (ROUNDING * size_of(exact, size)) }
}

/// What a formula's errors are measured relative to: the measure that its claim of stability names; without a claim, at least 1 for
/// colours, because a colour is a fraction of full brightness, and the result's own size otherwise.
#[must_use]
pub fn size(spec: &Spec) -> Size {
    let is_color = spec.outputs.iter().all(|output| output.unit == "color");
    spec.stable.map_or(if is_color { Size::Unit } else { Size::Own }, |stable| stable.size)
}

fn size_of(exact: &[f64], size: Size) -> f64 {
    let own = norm(exact.iter().copied());
    match size {
        Size::Own => own,
        Size::Unit => own.max(1.0),
    }
}

/// √Σx², without overflow or underflow for what an f32 can hold.
fn norm(of: impl Iterator<Item = f64>) -> f64 {
    of.map(|x| x * x).sum::<f64>().sqrt()
}

/// How many roundings of a result come of one rounding of each input: Σᵢ |xᵢ|·|∂y/∂xᵢ| over the result's size.
#[must_use]
pub fn condition(formula: &dyn AnyFormula, inputs: &[f32], size: Size) -> f64 {
    let by_input = formula.derivatives(inputs);
    let moved: f64 = inputs
        .iter()
        .zip(&by_input)
        .filter(|(x, _)| **x != 0.0)
        .map(|(&x, outputs)| f64::from(x).abs() * norm(outputs.iter().map(|output| output.slope)))
        .sum();
    let values: Vec<f64> =
        by_input.first().map(|outputs| outputs.iter().map(|y| y.value).collect()).unwrap_or_default();
    if moved == 0.0 { 0.0 } else { moved / size_of(&values, size) }
}

/// Ten bits are lost by the inputs' own rounding.
pub const ILL_CONDITIONED: f64 = 1024.0;

/// How far the legal values of a form reach, in roundings, over what its condition explains: beyond this the form is to blame.
/// Of random cases of published formulas less than 1 in 500 are called unstable (a test holds that), most of them forward
/// differences, which are.
pub const UNSTABLE: f64 = 256.0;

/// How well a formula can be computed at a case, and how well it promises to, by its legal values in force; `near` are inputs a few ULP away.
#[must_use]
pub fn conditioning(member: &Member, inputs: &[f32], legal: &[Accept], near: &[Vec<f32>]) -> Conditioning {
    let size = size(&member.spec);
    let mut exact = vec![0.0; member.spec.output_len()];
    member.formula.reference(inputs, &mut exact);
    let condition = condition(member.formula.as_ref(), inputs, size);
    let farthest = exact
        .iter()
        .zip(legal)
        .map(|(x, legal)| if legal.is_any() { f64::INFINITY } else { (x - legal.low()).max(legal.high() - x) });
    let farthest = norm(farthest);
    let reach = if farthest == 0.0 { 0.0 } else { farthest / (ROUNDING * size_of(&exact, size)) };
    let is_number = exact.iter().all(|x| x.is_finite());
    // Derivatives do not show jumps, so nearby inputs are evaluated too: a change of a few ULP in each input should move the result by
    // at most some tens of roundings times the condition.
    let jumps = near.iter().any(|row| {
        let mut there = vec![0.0; exact.len()];
        member.formula.reference(row, &mut there);
        roundings(&there, &exact, size) > UNSTABLE * (1.0 + condition)
    });
    let standing = if !is_number || !condition.is_finite() || jumps {
        FormStanding::Singular
    } else if reach.is_nan() || reach.is_infinite() {
        FormStanding::NothingPromised
    } else if reach > UNSTABLE * (1.0 + condition) {
        FormStanding::Unstable
    } else if condition > ILL_CONDITIONED {
        FormStanding::IllConditioned
    } else {
        FormStanding::Stable
    };
    Conditioning { condition: Number(condition), reach: Number(reach), standing }
}

/// The same in a line.
#[must_use]
pub fn text(of: &Conditioning) -> String {
    let rounded = |x: Number| {
        if x.0 >= 1e5 {
            format!("{:.1e}", x.0)
        } else if x.0 < 10.0 {
            format!("{:.2}", x.0)
        } else {
            format!("{:.0}", x.0)
        }
    };
    let (condition, reach) = (rounded(of.condition), rounded(of.reach));
    let times = rounded(Number(of.reach.0 / (1.0 + of.condition.0)));
    let moves = format!("a rounding of each input moves the result by {condition} of its own");
    match of.standing {
        FormStanding::Stable => format!("{moves}; legal values reach {reach}: stable"),
        FormStanding::IllConditioned => {
            format!(
                "{moves}; legal values reach {reach}: ill-conditioned: with inputs that were rounded no method can do better"
            )
        }
        FormStanding::Unstable => {
            format!(
                "{moves}; legal values reach {reach}, {times} times what that explains: unstable, the fault of the form"
            )
        }
        FormStanding::NothingPromised => format!("{moves}; yet anything is legal: the fault of the form"),
        FormStanding::Singular => "there is no value here, or the least change of an input makes another of it".into(),
    }
}
