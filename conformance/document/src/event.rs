//! What a run tells while it goes on, for whoever listens: it need not end before something is known of it. And how it is told to
//! end before its time.

use crate::report::{Failure, Group, Interrupted};
use serde::Serialize;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What a run has come to.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Event<'a> {
    /// So many cases in all are to be judged.
    Begun(u64),
    /// Work on a group begins.
    Group(&'a str),
    /// So many more cases are done.
    Advanced(u64),
    /// A group was judged, on one adapter in one stage.
    Judged {
        /// Its verdicts.
        group: &'a Group,
        /// Its failures that are reported, the one of the simplest inputs first.
        failures: Vec<&'a Failure>,
        /// Whether these are the first few cases alone, which are judged again with all others.
        is_scouted: bool,
    },
}

impl Event<'_> {
    /// The word that its JSON begins with.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Begun(_) => "begun",
            Self::Group(_) => "group",
            Self::Advanced(_) => "advanced",
            Self::Judged { .. } => "judged",
        }
    }
}

/// Listens to a run.
pub trait Observer {
    /// Is told what the run has come to.
    fn see(&mut self, event: &Event<'_>);
}

/// Nobody listens.
pub struct Silent;

impl Observer for Silent {
    fn see(&mut self, _event: &Event<'_>) {}
}

/// Put in the place of a signal's number where a failure ends the work.
const FIRST_FAILURE: usize = 1 << 16;

/// Set once somebody wants work to end: it then ends as soon as it can, and what was judged is reported.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicUsize>);

impl Stop {
    /// Where the number of a signal is put by its handler; 0 before there is one.
    #[must_use]
    pub fn flag(&self) -> Arc<AtomicUsize> {
        self.0.clone()
    }

    /// The signal that ends the work; `None` as long as it goes on.
    #[must_use]
    pub fn signal(&self) -> Option<i32> {
        let number = self.0.load(Ordering::Relaxed);
        i32::try_from(number).ok().filter(|signal| *signal > 0 && number != FIRST_FAILURE)
    }

    /// Whether to end.
    #[must_use]
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed) != 0
    }

    /// Ends the work since something failed, unless a signal does already.
    pub fn at_first_failure(&self) {
        let _ = self.0.compare_exchange(0, FIRST_FAILURE, Ordering::Relaxed, Ordering::Relaxed);
    }

    /// What a report says of `work` that was ended before its time, such as `the bench`; `None` where it was not.
    #[must_use]
    pub fn interrupted(&self, work: &str, under_way: &str) -> Option<Interrupted> {
        let signal = self.signal();
        let at_first_failure = self.0.load(Ordering::Relaxed) == FIRST_FAILURE;
        let what = match signal {
            Some(_) => "a signal",
            None if at_first_failure => "the first failure",
            None => return None,
        };
        let message = format!("{what} ended {work}");
        Some(Interrupted { under_way: under_way.into(), message, signal, at_first_failure })
    }
}
