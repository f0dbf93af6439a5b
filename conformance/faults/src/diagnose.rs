//! Which mistake a renderer made, from its answers: of whole answers, or of each output by itself.

use super::evidence::is_inside;
use super::explanation::{FormulaDiagnosis, TriedMistake};
use super::trial::diagnose_places;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::cases::Spec;
use lightmeter_catalogue::select::Member;
use lightmeter_document::report::PartDiagnosis;
use lightmeter_judge::diagnose::Answered;
use std::ops::Range;

/// Tries what the catalogue knows as explanations of a renderer's answers to one formula.
///
/// An explanation must explain nearly all failing cases, contradict nearly no passing one, and beat chance. Ranked by their
/// evidence. Pairs, parameters, and mistakes with a parameter are tried where no single
/// mistake explains every failing case.
#[must_use]
pub fn diagnose(member: &Member, rows: &[Answered<'_>], profile: &Profile) -> FormulaDiagnosis {
    let spec = &member.spec;
    let fits = |row: &&Answered<'_>| row.inputs.len() == spec.input_len() && row.values.len() == spec.output_len();
    let rows: Vec<Answered<'_>> = rows.iter().filter(fits).copied().collect();
    let mut found = diagnose_places(member, &rows, profile, 0..spec.output_len());
    if found.failing > 0 && found.explanations.is_empty() {
        (found.parts, found.diagnosis.parts) = by_parts(member, &rows, profile).into_iter().unzip();
    }
    found
}

/// Places of outputs, and what explains the numbers there.
type ExplainedPlaces = (Range<usize>, Vec<TriedMistake>);

/// What explains the colour, the alpha and each other output by itself, where more than one of them is wrong and one at least is explained.
fn by_parts(member: &Member, rows: &[Answered<'_>], profile: &Profile) -> Vec<(ExplainedPlaces, PartDiagnosis)> {
    let of_part = |(name, places): (String, Range<usize>)| {
        let rows: Vec<Answered<'_>> = rows.iter().map(|row| at_places(row, &places)).collect();
        let found = diagnose_places(member, &rows, profile, places.clone());
        (found.failing > 0).then(|| ((places, found.explanations), PartDiagnosis::new(name, found.diagnosis)))
    };
    let parts: Vec<_> = parts_of(&member.spec).into_iter().filter_map(of_part).collect();
    let tells = parts.len() > 1 && parts.iter().any(|(_, part)| !part.explanations.is_empty());
    if tells { parts } else { vec![] }
}

/// The outputs that are diagnosed by themselves, by name, with their places: each output, and of a colour with an alpha the two.
fn parts_of(spec: &Spec) -> Vec<(String, Range<usize>)> {
    let mut parts = vec![];
    let mut start = 0;
    for output in spec.outputs {
        let end = start + output.shape.components();
        let alpha = end - start == 4 && output.unit == "color";
        let colors = if alpha { start..end - 1 } else { start..end };
        parts.push((output.name.to_owned(), colors));
        if alpha {
            parts.push((spec.output_name(end - 1), end - 1..end));
        }
        start = end;
    }
    parts
}

/// Some places of an answer, which is wrong where one of them is.
fn at_places<'a>(row: &Answered<'a>, places: &Range<usize>) -> Answered<'a> {
    let (values, legal) = (&row.values[places.clone()], &row.legal[places.clone()]);
    let is_wrong = !is_inside(values, legal);
    Answered { values, legal, reference: &row.reference[places.clone()], is_wrong, ..*row }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::{Fault, formulas};
    use crate::variation::Variation;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::cases::Stage;
    use lightmeter_catalogue::select::CaseRef;
    use lightmeter_judge::devices::Known;
    use lightmeter_judge::formula::evaluated;
    use lightmeter_judge::kept::KeptRow;
    use lightmeter_judge::{Outcome, judge};

    /// The diagnosis of an implementation of a formula, of 256 cases.
    fn diagnosis(id: &str, implementation: impl Fn(&Member, &[f32], &mut [f32])) -> (FormulaDiagnosis, Vec<Vec<f32>>) {
        let member = formulas().iter().find(|member| member.spec.id == id).expect(id);
        let kept = |k| {
            let (mut row, mut out) = (vec![], vec![0.0; member.spec.output_len()]);
            member.inputs(CaseRef::Random(k), 1, &mut row);
            implementation(member, &row, &mut out);
            evaluated(member, row, out, (Stage::Compute, &Known::default(), &WGSL))
        };
        let kept: Vec<KeptRow> = (0..256).map(kept).collect();
        let rows = kept.iter().zip(0..).map(|(row, k)| row.answers(CaseRef::Random(k), is_wrong(row)));
        let found = diagnose(member, &rows.collect::<Vec<_>>(), &WGSL);
        (found, kept.into_iter().map(|row| row.inputs).collect())
    }

    fn is_wrong(row: &KeptRow) -> bool {
        let KeptRow { values, reference, legal, .. } = row;
        let fails = |k: usize| judge(values[k].to_bits(), reference[k], &legal[k]).outcome == Outcome::Fail;
        (0..values.len()).any(fails)
    }

    fn making(names: &'static [&'static str]) -> impl Fn(&Member, &[f32], &mut [f32]) {
        let faults: Vec<&'static Fault> = names.iter().map(|name| Fault::by_name(name).expect(name)).collect();
        move |member, inputs, out| Variation::new(member, &faults).expect("they fit").evaluate(inputs, out)
    }

    #[test]
    fn two_mistakes_that_undo_each_other_explain_nothing() {
        // A few ULP off, as a power of −1 is: nearly what the square root of a light attenuated twice comes to.
        let (found, _) = diagnosis("attenuation/linear", |_, inputs, out| {
            let right = (1.0 / inputs[0]).to_bits();
            out[0] = f32::from_bits(right + inputs[0].to_bits() % 11 - 5);
        });
        assert!(found.failing > 50 && found.explanations.is_empty(), "{}", found.diagnosis);
    }

    #[test]
    fn a_mistake_after_a_step_is_made_of_one_in_its_place() {
        let (found, _) =
            diagnosis("vector/normal-inverse-transpose", making(&["normal-normalised", "normals-by-modelview"]));
        let mut faults = found.explanations.first().expect("it is explained").faults.clone();
        faults.sort_unstable();
        assert_eq!(faults, ["normal-normalised", "normals-by-modelview"], "{}", found.diagnosis);
    }

    #[test]
    fn a_mistake_is_told_in_a_sentence() {
        let (found, inputs) = diagnosis("fog/exp", making(&["fog-radial"]));
        let n = found.failing;
        assert!(n > 100, "{n}");
        assert_eq!(
            found.diagnosis.to_string(),
            format!("{n} of {n} failing cases are explained by: fog uses radial distance (fog-radial)")
        );
        assert_eq!(found.failing + found.passing, inputs.len());
    }

    #[test]
    fn two_mistakes_are_told_together() {
        let (found, _) = diagnosis("fog/exp2-opengl", making(&["fog-radial", "red-and-blue-swapped"]));
        assert_eq!(found.explanations[0].faults, ["fog-radial", "red-and-blue-swapped"], "{}", found.diagnosis);
    }

    #[test]
    fn what_follows_from_a_step_is_told_in_the_words_of_the_trade() {
        for (id, name, says) in [
            (
                "lighting/blinn",
                "diffuse-term-without-light-color",
                "the diffuse term is not multiplied by the light's colour",
            ),
            (
                "lighting/blinn",
                "highlight-with-light-color-twice",
                "the highlight is multiplied by the light's colour twice",
            ),
            (
                "lighting/phong",
                "r-dot-v-of-normal-for-view-vector",
                "the cosine r·v is computed with the normal in the place of the view vector",
            ),
        ] {
            let fault = Fault::by_name(name).expect(name);
            assert!(fault.is_generated && fault.says == says, "{}", fault.says);
            let (found, _) = diagnosis(id, |member, inputs, out| {
                Variation::new(member, &[fault]).expect("it concerns it").evaluate(inputs, out);
            });
            assert_eq!(found.explanations[0].faults, [name], "{}", found.diagnosis);
        }
    }

    #[test]
    fn a_wrong_alpha_hides_no_cause_of_a_wrong_color() {
        let (found, _) = diagnosis("lighting/blinn", |member, inputs, out| {
            making(&["specular-times-incidence"])(member, inputs, out);
            // Nothing that the catalogue knows.
            out[3] = 0.25 + 0.5 * inputs[0] * inputs[4];
        });
        let parts = &found.diagnosis.parts;
        assert!(found.explanations.is_empty(), "{}", found.diagnosis);
        assert_eq!(found.diagnosis.mistakes(), ["specular-times-incidence"], "{}", found.diagnosis);
        let names: Vec<(&str, bool)> = parts.iter().map(|part| (&*part.name, part.explanations.is_empty())).collect();
        assert_eq!(names, [("color", false), ("color.a", true)], "{}", found.diagnosis);
        let (found, _) = diagnosis("lighting/blinn", |member, inputs, out| {
            making(&["specular-times-incidence", "alpha-summed"])(member, inputs, out);
        });
        assert_eq!(found.explanations[0].faults, ["specular-times-incidence", "alpha-summed"], "{}", found.diagnosis);
    }

    #[test]
    fn a_wrong_parameter_is_told_with_its_factor() {
        for (id, name, factor, says) in [
            ("lighting/phong", "shininess", 2.5, "as if shininess were 2.50 times what was asked"),
            ("fog/linear", "dmax", 1.02, "as if dmax were 2.0 % larger"),
            ("lighting/point-blinn", "kq", 0.3, "as if kq were 0.300 times what was asked"),
        ] {
            let (found, _) = diagnosis(id, |member, inputs, out| {
                let mut row = inputs.to_vec();
                row[member.spec.place(name).expect(name)].iter_mut().for_each(|x| *x *= factor);
                member.formula.embedded(&row, out);
            });
            assert!(found.diagnosis.to_string().ends_with(says), "{}", found.diagnosis.to_string());
        }
    }

    #[test]
    fn outputs_in_another_order_are_told() {
        let (found, _) = diagnosis("fog/exp", |member, inputs, out| {
            member.formula.embedded(inputs, out);
            out.rotate_left(1);
        });
        assert!(
            found.diagnosis.to_string().ends_with("in the order color, f; expected f, color"),
            "{}",
            found.diagnosis.to_string()
        );
    }

    #[test]
    fn a_mistake_and_a_wrong_parameter_are_told_together() {
        let (found, _) = diagnosis("fog/exp", |member, inputs, out| {
            let mut row = inputs.to_vec();
            row[member.spec.place("density").expect("density")].iter_mut().for_each(|x| *x *= 1.7);
            making(&["fog-radial"])(member, &row, out);
        });
        let n = found.failing;
        // |p| and the density are only seen as a product.
        let says = |which: &str| {
            format!("fog uses radial distance, and as if {which} (nothing tells which) were 1.70 times what was asked")
        };
        let told = ["density or p", "p or density"]
            .map(says)
            .map(|says| format!("{n} of {n} failing cases are explained by: {says} (fog-radial)"));
        assert!(told.contains(&found.diagnosis.to_string()), "{}", found.diagnosis.to_string());
    }

    #[test]
    fn parameters_that_nothing_tells_apart_are_told_together() {
        let (found, _) = diagnosis("lighting/diffuse-toward", |member, inputs, out| {
            member.formula.embedded(inputs, out);
            out.iter_mut().for_each(|x| *x *= 3.0);
        });
        assert!(
            found.diagnosis.to_string().contains("(nothing tells which) were 3.00 times"),
            "{}",
            found.diagnosis.to_string()
        );
    }

    #[test]
    fn a_naive_form_is_told_and_no_number_is_explained_by_what_leaves_all_open() {
        let member = formulas().iter().find(|member| member.spec.id == "lighting/blinn-stable").expect("it is there");
        let naive = formulas().iter().find(|member| member.spec.id == "lighting/blinn").expect("it is there");
        let diagnosis = |answer: &dyn Fn(&[f32], &mut [f32])| {
            let kept = |place| {
                let (mut row, mut out) = (vec![], vec![0.0; member.spec.output_len()]);
                member.inputs(CaseRef::Hard(place), 1, &mut row);
                answer(&row, &mut out);
                evaluated(member, row, out, (Stage::Compute, &Known::default(), &WGSL))
            };
            let kept: Vec<KeptRow> = (0..member.spec.hard.len()).map(kept).collect();
            let rows = kept.iter().enumerate().map(|(place, row)| row.answers(CaseRef::Hard(place), is_wrong(row)));
            diagnose(member, &rows.collect::<Vec<_>>(), &WGSL)
        };
        let found = diagnosis(&|row, out| naive.formula.embedded(row, out));
        assert!(found.failing > 1 && found.explanations[0].faults == ["naive-form"], "{}", found.diagnosis.to_string());
        let found = diagnosis(&|_, out| out.fill(f32::INFINITY));
        assert!(found.failing > 1 && found.explanations.is_empty(), "{}", found.diagnosis.to_string());
    }

    #[test]
    fn what_is_wrong_in_a_part_of_the_cases_is_no_mistake_of_the_catalogue() {
        for (id, input, component, bound, factor) in [
            ("lighting/spot", "p", 0, 4.0, 0.999),
            ("lighting/spot", "p", 2, -4.0, 0.9985),
            ("lighting/two-lights", "shininess", 0, 40.0, 1.01),
            ("fog/exp", "density", 0, 0.5, 0.9),
        ] {
            let (found, _) = diagnosis(id, |member, inputs, out| {
                member.formula.embedded(inputs, out);
                if inputs[member.spec.place(input).expect(input).start + component] > bound {
                    out.iter_mut().for_each(|x| *x *= factor);
                }
            });
            assert!(
                found.failing > 8 && found.explanations.is_empty(),
                "{id}: {} of {}",
                found.diagnosis,
                found.failing
            );
            let says = format!("{id}: {}", found.diagnosis);
            assert!(says.contains(" have ") && says.contains(input), "{says}");
        }
    }

    #[test]
    fn two_that_explain_most_are_told_apart_by_a_case() {
        let member = formulas().iter().find(|member| member.spec.id == "color/srgb-encode").expect("it is there");
        let mut told = 0;
        for fault in crate::concerned::concerning(member) {
            let names: &'static [&'static str] = Box::leak(Box::new([fault.name]));
            let (found, inputs) = diagnosis(&member.spec.id, making(names));
            let Some(case) = found.diagnosis.telling.as_ref().map(|telling| telling.case.clone()) else { continue };
            told += 1;
            let told = found.diagnosis.to_string();
            let (_, next) = told.split_once("; ").expect("it is told");
            assert!(
                next.starts_with(&format!("{case} tells it from the next best: ")),
                "{}",
                found.diagnosis.to_string()
            );
            // The next best gives another value there.
            let number: usize = case.rsplit('/').next().and_then(|k| k.parse().ok()).expect("a random case");
            let next = found.explanations.iter().find(|other| next.ends_with(&other.says)).expect("it is one of them");
            let next = Box::leak(next.faults.clone().into_boxed_slice());
            let answer = |names| {
                let mut out = vec![0.0; member.spec.output_len()];
                making(names)(member, &inputs[number], &mut out);
                out
            };
            assert_ne!(answer(names), answer(next), "{case}");
        }
        assert!(told > 0, "no two mistakes explain nearly the same");
    }

    #[test]
    fn what_nothing_explains_is_said_to_be_so() {
        let (found, _) = diagnosis("lighting/blinn", |_, inputs, out| {
            out.iter_mut().zip(inputs).for_each(|(out, x)| *out = (x * 1000.0).sin() * 7.0);
        });
        assert_eq!((found.explanations.len(), found.failing), (0, 256));
        assert!(
            found.diagnosis.to_string().starts_with("nothing in the catalogue explains the 256 failing cases"),
            "{}",
            found.diagnosis.to_string()
        );
    }

    #[test]
    fn answers_that_are_no_numbers_or_too_short_are_borne() {
        let (found, _) = diagnosis("lighting/spot", |_, _, out| out.fill(f32::NAN));
        assert!(found.failing == 256 && found.explanations.is_empty(), "{}", found.diagnosis.to_string());
        let member = formulas().iter().find(|member| member.spec.id == "fog/exp").expect("fog/exp");
        let short = KeptRow { inputs: vec![1.0], values: vec![], reference: vec![], legal: vec![] };
        let short = [short.answers(CaseRef::Hard(0), true)];
        assert_eq!(diagnose(member, &short, &WGSL).diagnosis.to_string(), "nothing fails");
        assert_eq!(diagnose(member, &[], &WGSL).diagnosis.to_string(), "nothing fails");
    }
}
