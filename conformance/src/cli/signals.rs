//! What ends a command before its work is done.

use super::Status;
use super::observed::happens;
use super::say;
use lightmeter::document::event::Stop;
use lightmeter::document::report::Interrupted;
use signal_hook::consts::{SIGINT, SIGTERM};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
#[cfg(unix)]
use std::{io::Read as _, os::unix::net::UnixStream, sync::atomic::Ordering, time::Duration};

/// A terminal was closed. Windows has no such signal, but results of other systems name it.
pub(crate) const SIGHUP: i32 = 1;

/// The signals that end a program.
pub(crate) const ENDING: &[i32] = if cfg!(unix) { &[SIGINT, SIGTERM, SIGHUP] } else { &[SIGINT, SIGTERM] };

/// How long signals count as the first. `timeout` sends one to its child and one to the child's group, and a terminal sends one to
/// all that it started, which may pass it on.
#[cfg(unix)]
const SAME: Duration = Duration::from_millis(500);

/// Set by the first signal that ends a program: what was judged is then reported. A second one ends this program at once.
pub(crate) fn stopped_by_signals() -> anyhow::Result<Stop> {
    let (stop, ends_at_once) = (Stop::default(), Arc::new(AtomicBool::new(false)));
    for &signal in ENDING {
        signal_hook::flag::register_conditional_shutdown(signal, 128 + signal, ends_at_once.clone())?;
        signal_hook::flag::register_usize(signal, stop.flag(), usize::try_from(signal)?)?;
    }
    after_the_first(ends_at_once)?;
    happens("ready", ());
    Ok(stop)
}

/// Sets a flag a moment after the first signal.
#[cfg(unix)]
fn after_the_first(flag: Arc<AtomicBool>) -> anyhow::Result<()> {
    let (mut hears, tells) = UnixStream::pair()?;
    for &signal in ENDING {
        signal_hook::low_level::pipe::register(signal, tells.try_clone()?)?;
    }
    std::thread::spawn(move || {
        if hears.read_exact(&mut [0]).is_ok() {
            // The handlers before this one have set `stop`.
            happens("signal", ());
            std::thread::sleep(SAME);
            flag.store(true, Ordering::Relaxed);
        }
    });
    Ok(())
}

/// Sets a flag with the first signal.
#[cfg(not(unix))]
fn after_the_first(flag: Arc<AtomicBool>) -> anyhow::Result<()> {
    ENDING.iter().try_for_each(|&signal| signal_hook::flag::register(signal, flag.clone()).map(drop))?;
    Ok(())
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
