//! Lighting with mistakes: one model of a lit surface whose every step can be wrong, arranged as each formula of the family has
//! it. Without a mistake it computes what the formula does (a test holds that).

mod model;
mod shade;

use super::row::InputRow;
use lightmeter_catalogue::cases::Spec;
use lightmeter_reference::Real;
pub(super) use model::Twist;
use model::right;

/// Whether the formula has these steps, and each makes a difference to it.
pub(super) fn concerns(spec: &Spec, twists: &[Twist]) -> bool {
    right(&spec.id).is_some_and(|mut model| twists.iter().all(|&twist| model.twist(twist)))
}

/// The formula with these steps wrong; `None` where it is not of this family's model.
pub(super) fn evaluate<R: Real>(spec: &Spec, twists: &[Twist], numbers: &[R], out: &mut [R]) -> Option<()> {
    let mut model = right(&spec.id)?;
    for &twist in twists {
        model.twist(twist);
    }
    model.evaluate(&InputRow::new(spec, numbers), out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::agrees_with_formulas;

    #[test]
    fn without_a_mistake_the_model_is_the_formula() {
        let seen =
            agrees_with_formulas(|spec| right(&spec.id).is_some(), |spec, row, out| evaluate(spec, &[], row, out));
        assert!(seen > 20 * 256, "{seen}");
    }
}
