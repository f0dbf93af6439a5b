//! The catalogue of mistakes, and what is looked up in it.

use super::fault::Fault;
use super::table;
use std::sync::LazyLock;

/// Every mistake, in the order of tables.
#[must_use]
pub fn faults() -> &'static [&'static Fault] {
    static ALL: LazyLock<Vec<&'static Fault>> = LazyLock::new(|| table::all().collect());
    &ALL
}

impl Fault {
    /// The mistake of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        faults().iter().copied().find(|fault| fault.name == name)
    }
}
