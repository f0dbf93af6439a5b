//! The catalogue of mistakes, and what is looked up in it.

use super::fault::Fault;
use super::table;
use lightmeter_catalogue::cases::Spec;
use std::sync::LazyLock;

/// Every mistake, in the order of tables.
#[must_use]
pub fn faults() -> &'static [&'static Fault] {
    static ALL: LazyLock<Vec<&'static Fault>> = LazyLock::new(|| table::all().collect());
    &ALL
}

/// Those that concern a formula.
pub fn concerning(spec: &Spec) -> impl Iterator<Item = &'static Fault> {
    faults().iter().copied().filter(|fault| fault.concerns(spec))
}

impl Fault {
    /// The mistake of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        faults().iter().copied().find(|fault| fault.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::formulas;
    use lightmeter_catalogue::cases::FAMILIES;
    use lightmeter_catalogue::select::Member;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_each_fault_concerns_a_formula() {
        assert!(faults().len() >= 60, "{}", faults().len());
        let names: BTreeSet<&str> = faults().iter().map(|fault| fault.name).collect();
        let sentences: BTreeSet<&str> = faults().iter().map(|fault| fault.says).collect();
        assert_eq!((names.len(), sentences.len()), (faults().len(), faults().len()));
        for fault in faults() {
            assert!(formulas().iter().any(|member| fault.concerns(&member.spec)), "{} concerns nothing", fault.name);
            // A way that never comes first is a way that is never taken.
            for way in fault.ways {
                let taken = |member: &Member| fault.steps(&member.spec).is_some_and(|steps| std::ptr::eq(steps, *way));
                assert!(formulas().iter().any(taken), "{}: {way:?} fits nothing", fault.name);
            }
        }
    }

    #[test]
    fn no_family_is_without_faults() {
        for family in FAMILIES {
            let count = faults().iter().filter(|fault| {
                formulas().iter().any(|member| member.spec.family() == family && fault.concerns(&member.spec))
            });
            assert!(count.count() >= 5, "{family}");
        }
    }
}
