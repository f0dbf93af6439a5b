//! The one device of each adapter in a process, which all trials on that adapter share.

use lightmeter::adapters;
use lightmeter::document::event::Silent;
use lightmeter::document::report::Report;
use lightmeter::options::Options;
use lightmeter::run::run_selection;
use lightmeter::selection::Selection;
use lightmeter::subject::Subject;
use std::sync::{Mutex, PoisonError};

/// The device of an adapter, opened when the first trial needs it.
pub(super) struct Device {
    /// The adapter's name; `None` for the one that `run` takes.
    pub(super) adapter: Option<String>,
    state: Mutex<State>,
}

enum State {
    Unopened,
    Open {
        subject: Box<Subject>,
        has_drawn: bool,
    },
    /// It cannot be opened, and why.
    Unavailable(String),
}

impl Device {
    pub(super) const fn new(adapter: Option<String>) -> Self {
        Self { adapter, state: Mutex::new(State::Unopened) }
    }

    /// Judges a part of a run on the device. Tables of special values get one that has drawn no scene, as in a run: after some scenes
    /// Mesa 22.3's lavapipe treats subnormals in another way.
    pub(super) fn judge(&self, selection: &Selection, options: &Options) -> Result<Report, String> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if !selection.tables.is_empty() && matches!(*state, State::Open { has_drawn: true, .. }) {
            *state = State::Unopened;
        }
        if let State::Open { has_drawn, .. } = &mut *state {
            *has_drawn |= !selection.scenes.is_empty();
        }
        let subject = state.open(self.adapter.as_ref(), !selection.scenes.is_empty())?;
        let judged = run_selection(selection, std::slice::from_mut(subject), options, &mut Silent);
        let is_lost = match &judged {
            Ok(report) => report.interrupted.is_some(),
            Err(error) => error.is_of_device(),
        };
        if is_lost {
            // The next trial has a fresh device. Closing one that hangs would hang as well.
            std::mem::forget(std::mem::replace(&mut *state, State::Unopened));
        }
        judged.map_err(|error| error.to_string())
    }
}

impl State {
    fn open(&mut self, adapter: Option<&String>, has_drawn: bool) -> Result<&mut Subject, String> {
        if let Self::Unopened = self {
            let asked: Vec<String> = adapter.into_iter().cloned().collect();
            *self = match adapters::open(&asked) {
                Ok(mut subjects) if subjects.len() == 1 => {
                    Self::Open { subject: Box::new(subjects.remove(0)), has_drawn }
                }
                Ok(subjects) => Self::Unavailable(format!("{asked:?} names {} adapters, not one", subjects.len())),
                Err(error) => Self::Unavailable(error.to_string()),
            };
        }
        match self {
            Self::Open { subject, .. } => Ok(subject),
            Self::Unavailable(message) => Err(message.clone()),
            Self::Unopened => unreachable!("it was opened above"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter::subject_gpu::code_of;

    /// On Mesa 22.3's lavapipe 25 results are not as on record where both use one device.
    #[test]
    fn tables_of_special_values_are_right_after_a_scene() {
        if crate::needs::lacks_driver() {
            return;
        }
        let options = Options::new(code_of(None).expect("the built-in shaders are valid"));
        let parts = Selection::of(&options).parts();
        let device = Device::new(None);
        for path in ["special/subnormal", "scene/phong-blinn", "special/subnormal"] {
            let part = parts.iter().find(|part| part.path == path).expect("there is such a part");
            let report = device.judge(&part.selection, &options).expect("the part is judged");
            assert!(report.is_success() && report.totals.passed > 0, "{path}: {:?}", report.totals);
        }
    }
}
