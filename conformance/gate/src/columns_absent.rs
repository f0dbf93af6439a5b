//! In the place of columns where the feature `scenes` is left out, and with it what reads arrays: a clear error.

use super::error::PackError;
use super::plan::GatePlan;
use lightmeter_catalogue::cases::Spec;
use std::io::Write;
use std::path::Path;

/// The folder of the columns, in a pack and among answers.
pub(super) const FOLDER: &str = "columns";
const ABSENT: &str = "this build reads and writes no arrays; expected one with the feature `scenes`";

/// The names of a formula's columns in a pack: none.
pub(super) fn names(_spec: &Spec) -> impl Iterator<Item = String> {
    std::iter::empty()
}

/// Fails.
pub(super) fn write(_plan: &GatePlan, _formula: usize, _streams: &mut [impl Write]) -> std::io::Result<()> {
    Err(std::io::Error::new(std::io::ErrorKind::Unsupported, ABSENT))
}

/// No columns.
#[derive(Default)]
pub(super) struct Columns;

impl Columns {
    /// Fails where there are some.
    pub(super) fn open(answers: &Path, _plan: &GatePlan) -> Result<Self, PackError> {
        let path = answers.join(FOLDER);
        if path.is_dir() { Err(PackError::Read { path, message: ABSENT.into() }) } else { Ok(Self) }
    }

    /// Always.
    pub(super) const fn is_empty(&self) -> bool {
        true
    }

    /// Never.
    pub(super) const fn has(&self, _formula: usize) -> bool {
        false
    }

    /// None.
    pub(super) fn formulas(&self) -> impl Iterator<Item = usize> {
        std::iter::empty()
    }

    /// None.
    pub(super) const fn of(&mut self, _formula: usize) -> Option<Self> {
        None
    }

    /// Nothing.
    pub(super) const fn read(&mut self, _case: usize, _words: &mut [u32]) -> Result<(), PackError> {
        Ok(())
    }
}
