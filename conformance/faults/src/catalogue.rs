//! The catalogue of mistakes, and what is looked up in it.

use super::fault::Fault;
use super::table;
use std::collections::HashMap;
use std::sync::LazyLock;

/// Every mistake of the tables, in their order.
#[must_use]
pub fn faults() -> &'static [&'static Fault] {
    static ALL: LazyLock<Vec<&'static Fault>> = LazyLock::new(|| table::all().collect());
    &ALL
}

/// Every mistake that follows from the steps and inputs of some formula. Where one is as another, [`concerning`](crate::concerning) has the first.
#[must_use]
pub fn generated() -> &'static [&'static Fault] {
    super::generated::all()
}

/// The place of a mistake in the list of all. Of explanations that are equally good, the one that stands first there is reported first.
pub(super) fn place_of(name: &str) -> Option<usize> {
    static PLACES: LazyLock<HashMap<&'static str, usize>> =
        LazyLock::new(|| faults().iter().chain(generated()).map(|fault| fault.name).zip(0..).collect());
    PLACES.get(name).copied()
}

impl Fault {
    /// The mistake of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        faults().iter().chain(generated()).copied().find(|fault| fault.name == name)
    }
}
