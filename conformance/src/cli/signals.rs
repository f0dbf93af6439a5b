//! What ends a command before its work is done.

use super::Status;
use super::say;
use lightmeter::document::event::Stop;
use lightmeter::document::run::Interrupted;
use signal_hook::consts::{SIGINT, SIGTERM};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A terminal was closed. Windows has no such signal, but results of other systems name it.
pub(crate) const SIGHUP: i32 = 1;

/// The signals that end a program.
pub(crate) const ENDING: &[i32] = if cfg!(unix) { &[SIGINT, SIGTERM, SIGHUP] } else { &[SIGINT, SIGTERM] };

/// Set by the first signal that ends a program: what was judged is then reported. The second ends this one at once.
pub(crate) fn stopped_by_signals() -> anyhow::Result<Stop> {
    let (stop, is_second) = (Stop::default(), Arc::new(AtomicBool::new(false)));
    for &signal in ENDING {
        let number = usize::try_from(signal)?;
        signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, is_second.clone())?;
        signal_hook::flag::register(signal, is_second.clone())?;
        signal_hook::flag::register_usize(signal, stop.flag(), number)?;
    }
    Ok(stop)
}

/// Says what ended a command before its time, and how the command ends.
pub(crate) fn status_of(interrupted: &Interrupted) -> Status {
    let Interrupted { under_way, message, signal, at_first_failure } = interrupted;
    if *at_first_failure {
        say(&format!(
            "{message}, as --fail-fast asks: {under_way} was under way, and what comes after it was not judged"
        ));
        return Status::Failed;
    }
    say(&format!("error: {message}\n  {under_way} was under way; what was done before stands in the result"));
    signal.map_or(Status::Device, Status::of_signal)
}
