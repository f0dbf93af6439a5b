//! What a run tells while it goes on, for whoever listens: it need not end before something is known of it. And how it is told to
//! end before its time.

use crate::run::{Failure, Group, Interrupted};
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
        i32::try_from(self.0.load(Ordering::Relaxed)).ok().filter(|signal| *signal > 0)
    }

    /// Whether to end.
    #[must_use]
    pub fn is_set(&self) -> bool {
        self.signal().is_some()
    }

    /// What a report says of `work` that a signal ended, such as `the bench`; `None` where no signal did.
    #[must_use]
    pub fn interrupted(&self, work: &str, under_way: &str) -> Option<Interrupted> {
        let signal = self.signal()?;
        let message = format!("a signal ended {work}");
        Some(Interrupted { under_way: under_way.into(), message, signal: Some(signal) })
    }
}
