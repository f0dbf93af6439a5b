//! Lighting with mistakes: one model of a lit surface whose every step can be wrong, arranged as each formula of the family has
//! it. Without a mistake it computes what the formula does (a test holds that).

mod model;
mod shade;

use super::row::Row;
use crate::cases::Spec;
use lightmeter_reference::Real;
pub(super) use model::Twist;
use model::right;
pub(super) use shade::smoothstep;

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
    model.evaluate(&Row::new(spec, numbers), out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faults::catalogue::formulas;
    use crate::select::CaseRef;

    #[test]
    fn without_a_mistake_the_model_is_the_formula() {
        let mut seen = 0;
        for member in formulas().iter().filter(|member| right(&member.spec.id).is_some()) {
            for k in 0..256 {
                let mut row = vec![];
                member.inputs(CaseRef::Random(k), 1, &mut row);
                let wide: Vec<f64> = row.iter().map(|&x| x.into()).collect();
                let (mut model, mut formula) =
                    (vec![f64::NAN; member.spec.output_len()], vec![0.0; member.spec.output_len()]);
                evaluate(&member.spec, &[], &wide, &mut model).expect("a model");
                member.formula.reference(&row, &mut formula);
                for (a, b) in model.iter().zip(&formula) {
                    assert!((a - b).abs() <= 1e-9 * b.abs().max(1.0), "{} {k}: {a} for {b}", member.spec.id);
                }
                seen += 1;
            }
        }
        assert!(seen > 20 * 256, "{seen}");
    }
}
