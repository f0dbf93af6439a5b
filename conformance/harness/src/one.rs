//! One formula, judged within an ordinary test.

use crate::engine::Formulas;
use crate::judging::{Criteria, annotate, complaint};
use crate::values::{FormulaInputs, FormulaOutputs};
use std::sync::Arc;

/// Judges one formula, within an ordinary test.
///
/// # Panics
/// Where the formula fails, with what `lightmeter gate` prints of it: the case, its inputs, and what the function said where it panics
/// itself; and where there is no such formula.
#[track_caller]
pub fn assert_formula<O: Into<FormulaOutputs>>(
    formula: &str,
    function: impl Fn(&FormulaInputs<'_>) -> O + Send + Sync + 'static,
) {
    let engine = Formulas::new("this function", "").with(formula, function);
    let judged = match Criteria::default().begin(Arc::new(engine)) {
        Ok(judged) => judged,
        Err(error) => panic!("{error}"),
    };
    for part in &judged.parts {
        match judged.of(part) {
            Ok(report) => {
                if let Some(complaint) = complaint(&report) {
                    annotate(&report);
                    panic!("{formula} fails\n{complaint}");
                }
            }
            Err(error) => panic!("{error}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    fn fog(inputs: &FormulaInputs<'_>, base: f32) -> (f32, [f32; 3]) {
        let f = base.powf(-inputs.float("density") * inputs.vec3("p")[2].abs()).clamp(0.0, 1.0);
        let ([r, g, b], [x, y, z]) = (inputs.vec3("shaded"), inputs.vec3("fog"));
        (f, [(r, x), (g, y), (b, z)].map(|(shaded, fog)| shaded * f + fog * (1.0 - f)))
    }

    /// What a panic says.
    fn said(assertion: impl FnOnce()) -> String {
        let panic = catch_unwind(AssertUnwindSafe(assertion)).expect_err("it panics");
        panic.downcast::<String>().map_or_else(|_| "not a text".into(), |text| *text)
    }

    #[test]
    fn a_right_formula_passes_and_a_wrong_one_is_told_with_its_mistake() {
        assert_formula("fog/exp", |inputs| fog(inputs, std::f32::consts::E));
        let told = said(|| assert_formula("fog/exp", |inputs| fog(inputs, 2.0)));
        for what in ["fog/exp fails", "fog-base-two", "legal", "density"] {
            assert!(told.contains(what), "no {what} in {told}");
        }
    }

    fn normalize(v: [f32; 3]) -> [f32; 3] {
        let length = dot(v, v).sqrt();
        v.map(|x| if length > 0.0 { x / length } else { 0.0 })
    }

    fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
        a.iter().zip(&b).map(|(a, b)| a * b).sum()
    }

    /// Bugs that renderers have, and the names by which the diagnosis knows them.
    #[test]
    fn five_bugs_are_told_by_their_names() {
        let told = [
            ("fog-base-two", said(|| assert_formula("fog/exp", |x| fog(x, 2.0)))),
            (
                "half-vector-as-mean",
                said(|| {
                    assert_formula("vector/halfway", |x| {
                        let ([a, b, c], [d, e, f]) = (x.vec3("v"), x.vec3("l"));
                        [0.5 * (a + d), 0.5 * (b + e), 0.5 * (c + f)]
                    });
                }),
            ),
            (
                "light-reversed",
                said(|| {
                    assert_formula("vector/toward", |x| {
                        let ([a, b, c], [d, e, f]) = (x.vec3("light"), x.vec3("p"));
                        normalize([d - a, e - b, f - c])
                    });
                }),
            ),
            (
                "attenuation-quadratic-missing",
                said(|| {
                    assert_formula("attenuation/polynomial", |x| 1.0 / (x.float("kc") + x.float("kl") * x.float("d")))
                }),
            ),
            (
                "incidence-unclamped",
                said(|| {
                    assert_formula("lighting/diffuse-toward", |x| {
                        let cosine = dot(x.vec3("n"), x.vec3("l"));
                        let ([a, b, c], [d, e, f]) = (x.vec3("ld"), x.vec3("md"));
                        [a * d * cosine, b * e * cosine, c * f * cosine]
                    });
                }),
            ),
        ];
        for (name, told) in told {
            assert!(told.contains(&format!("({name}")), "no {name} in {told}");
        }
    }

    #[test]
    fn what_there_is_not_is_told_with_what_there_is() {
        let told = said(|| assert_formula("fog/exq", |_| 0.0));
        assert!(told.contains("fog/exq") && told.contains("fog/exp"), "{told}");
        let told = said(|| assert_formula("attenuation/constant", |inputs| inputs.float("k")));
        assert!(told.contains("has no input `k`; its inputs are"), "{told}");
        let told = said(|| assert_formula("fog/exp", |inputs| inputs.float("p")));
        assert!(told.contains("`p` has 3 numbers, and a float has 1"), "{told}");
        // The panic is told with the formula, the case and its inputs.
        let of = ["\u{2717} fog/exp: ", "fog/exp/", "the function panicked: density is too small", "density "];
        let told = said(|| assert_formula("fog/exp", |_| -> f32 { panic!("density is too small") }));
        for what in of {
            assert!(told.contains(what), "no {what} in {told}");
        }
        let told = said(|| assert_formula("fog/exp", |_| [1.0, 2.0]));
        assert!(told.contains("2 numbers; expected 4"), "{told}");
    }
}
