//! Mistakes that a renderer is known to make, by their names: whether they alone give its wrong answers.

use super::catalogue::{faults, generated};
use super::fault::{Fault, formulas};
use super::scene::SCENE_FAULTS;
use super::variation::Variation;
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::nearest::did_you_mean;
use lightmeter_catalogue::select::Member;
use lightmeter_judge::diagnose::{Answered, Made};
use std::collections::HashMap;
use std::fmt::{self, Debug, Formatter};
use std::sync::{Arc, PoisonError, RwLock};

/// The forms of a formula that have one of the mistakes, or all of them.
type Forms = Arc<[Variation<'static>]>;

/// Mistakes by their names.
pub struct KnownMistakes {
    /// Those of formulas. A mistake of scenes alone is explained by the diagnosis of an image.
    faults: Vec<&'static Fault>,
    /// Of each formula that something failed of, by its id.
    forms: RwLock<HashMap<String, Forms>>,
}

impl KnownMistakes {
    /// The mistakes of some names.
    ///
    /// # Errors
    /// Where there is none of a name.
    pub fn by_names(names: &[String]) -> Result<Self, String> {
        let is_of_scenes = |name: &str| SCENE_FAULTS.iter().any(|fault| fault.name == name);
        let mut known = Self { faults: vec![], forms: RwLock::default() };
        for name in names {
            match Fault::by_name(name) {
                Some(fault) => known.faults.push(fault),
                None if is_of_scenes(name) => {}
                None => {
                    let of_formulas = faults().iter().chain(generated()).map(|fault| fault.name);
                    let meant = did_you_mean(name, of_formulas.chain(SCENE_FAULTS.iter().map(|fault| fault.name)));
                    return Err(format!(
                        "there is no mistake `{name}`{meant} `lightmeter mistakes` lists those that are known"
                    ));
                }
            }
        }
        Ok(known)
    }

    /// The forms of a formula that have one of the mistakes, or all of them.
    fn forms(&self, member: &Member) -> Forms {
        let known = || self.forms.read().unwrap_or_else(PoisonError::into_inner).get(&member.spec.id).cloned();
        if let Some(forms) = known() {
            return forms;
        }
        let member = formulas().iter().find(|one| one.spec.id == member.spec.id);
        let single = self.faults.iter().map(std::slice::from_ref);
        let all = (self.faults.len() > 1).then_some(&self.faults[..]);
        let forms =
            member.map(|member| single.chain(all).filter_map(|faults| Variation::new(member, faults)).collect());
        let forms: Forms = forms.unwrap_or_else(|| Arc::from([]));
        if let Some(member) = member {
            let mut known = self.forms.write().unwrap_or_else(PoisonError::into_inner);
            known.insert(member.spec.id.clone(), Arc::clone(&forms));
        }
        forms
    }
}

impl Debug for KnownMistakes {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.faults.iter().map(|fault| fault.name)).finish()
    }
}

impl Made for KnownMistakes {
    fn explains(&self, member: &Member, answered: &Answered<'_>, profile: &Profile) -> bool {
        self.forms(member).iter().any(|form| gives(form, member, answered, profile))
    }
}

/// Whether a form of a formula may give an answer. Where the accuracy rules leave a wrong number open in it, as they do the power of a negative
/// number, only NaN and infinity count, and only if the form gives one of them in f32 as well.
fn gives(form: &Variation<'_>, member: &Member, answered: &Answered<'_>, profile: &Profile) -> bool {
    let outputs = answered.values.len();
    let (mut legal, mut own) = (vec![Accept::ANY; outputs], vec![0.0_f32; outputs]);
    form.interval(answered.inputs, profile, &mut legal);
    form.evaluate(answered.inputs, &mut own);
    let is_given = |place: usize| {
        let (value, legal) = (answered.values[place], &legal[place]);
        match legal.is_any() && !answered.is_right(place) {
            true => !value.is_finite() && !own[place].is_finite(),
            false => legal.contains(value.into()),
        }
    };
    (0..outputs).filter(|place| !member.missing.contains(place)).all(is_given)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::cases::Stage;
    use lightmeter_catalogue::select::CaseRef;
    use lightmeter_judge::devices::Known;
    use lightmeter_judge::formula::evaluated;
    use lightmeter_judge::kept::KeptRow;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(ToString::to_string).collect()
    }

    /// The wrong answers of an implementation that makes some mistakes.
    fn wrong(id: &str, made: &[&str]) -> (&'static Member, Vec<KeptRow>) {
        let member = formulas().iter().find(|member| member.spec.id == id).expect(id);
        let faults: Vec<&'static Fault> = made.iter().map(|name| Fault::by_name(name).expect(name)).collect();
        let form = Variation::new(member, &faults).expect("they fit");
        let kept = |k| {
            let (mut row, mut out) = (vec![], vec![0.0; member.spec.output_len()]);
            member.inputs(CaseRef::Random(k), 1, &mut row);
            form.evaluate(&row, &mut out);
            evaluated(member, row, out, (Stage::Answer, &Known::default(), &WGSL))
        };
        let rows: Vec<KeptRow> = (0..512).map(kept).collect();
        let is_wrong = |row: &KeptRow| (0..row.values.len()).any(|k| !row.legal[k].contains(row.values[k].into()));
        (member, rows.into_iter().filter(is_wrong).collect())
    }

    /// How many wrong answers of an implementation with mistakes known mistakes explain, and how many there are.
    fn explained(id: &str, made: &[&str], known: &[&str]) -> [usize; 2] {
        let (member, rows) = wrong(id, made);
        let known = KnownMistakes::by_names(&names(known)).expect("they are known");
        let is_explained = |row: &&KeptRow| known.explains(member, &row.answers(CaseRef::Random(0), true), &WGSL);
        [rows.iter().filter(is_explained).count(), rows.len()]
    }

    #[test]
    fn a_mistake_excuses_what_it_gives_and_nothing_else() {
        let id = "lighting/point-blinn";
        let [explained_by_it, all] = explained(id, &["ambient-attenuated"], &["ambient-attenuated"]);
        assert!(explained_by_it == all && all > 200, "{explained_by_it} of {all}");
        let [by_another, all] = explained(id, &["half-vector-as-mean"], &["ambient-attenuated"]);
        assert!(by_another == 0 && all > 50, "another in its place: {by_another} of {all}");
        // Where the other one changes nothing, it is the first alone.
        let both = ["ambient-attenuated", "half-vector-as-mean"];
        let [by_one, all] = explained(id, &both, &["ambient-attenuated"]);
        assert!(by_one + 50 < all, "another beside it: {by_one} of {all}");
        let [explained, all] = explained(id, &both, &both);
        assert_eq!(explained, all);
    }

    #[test]
    fn a_name_that_is_no_mistake_is_refused_with_the_nearest() {
        let error = KnownMistakes::by_names(&names(&["ambient-atenuated"])).expect_err("it is misspelt");
        assert!(error.contains("`ambient-atenuated`; did you mean `ambient-attenuated`"), "{error}");
        for fault in SCENE_FAULTS {
            assert!(KnownMistakes::by_names(&names(&[fault.name])).is_ok(), "{}", fault.name);
        }
    }
}
