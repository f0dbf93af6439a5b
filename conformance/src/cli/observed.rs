//! What tests of the commands wait for, so that no test depends on how fast the machine is.
//!
//! `LIGHTMETER_EVENTS=2` has a command write its events as JSON lines to descriptor 2, `{"event":"advanced","told":…}`.
//! `LIGHTMETER_HOLD=advanced:3@0` has it hold at the third `advanced` until descriptor 0 gives a byte or ends.
//! `LIGHTMETER_CLOCK=renderer` stops the clock that limits are measured by: for the renderer of a gate, time passes when it says so
//! (`gate/src/process/clock.rs`); for anything else there is no limit.
//! None of them changes a result.

use serde::Serialize;
use std::fs::File;
use std::io::{Read, Write};
use std::sync::{LazyLock, Mutex, PoisonError};

pub(crate) const EVENTS: &str = "LIGHTMETER_EVENTS";
pub(crate) const HOLD: &str = "LIGHTMETER_HOLD";
const CLOCK: &str = "LIGHTMETER_CLOCK";

/// An event as a line.
#[derive(Serialize)]
struct Line<'a, T> {
    event: &'a str,
    told: T,
}

/// Where a command holds.
struct Hold {
    event: String,
    /// How many events of that name are still to come, with the one that it holds at.
    left: u64,
    bytes: Box<dyn Read + Send>,
}

/// What the variables ask for.
struct Observed {
    events: Box<dyn Write + Send>,
    hold: Option<Hold>,
}

static OBSERVED: LazyLock<Option<Mutex<Observed>>> = LazyLock::new(|| {
    let events: Box<dyn Write + Send> = match std::env::var(EVENTS).ok()?.as_str() {
        // It may be a socket, which cannot be opened once more.
        "2" => Box::new(std::io::stderr()),
        number => Box::new(File::options().write(true).open(descriptor(number)).ok()?),
    };
    Some(Mutex::new(Observed { events, hold: std::env::var(HOLD).ok().and_then(|asked| hold(&asked)) }))
});

fn descriptor(number: &str) -> String {
    format!("/dev/fd/{number}")
}

/// Reads `EVENT:NUMBER@DESCRIPTOR`.
fn hold(asked: &str) -> Option<Hold> {
    let (place, number) = asked.split_once('@')?;
    let (event, left) = place.split_once(':')?;
    let bytes: Box<dyn Read + Send> = match number {
        "0" => Box::new(std::io::stdin()),
        _ => Box::new(File::open(descriptor(number)).ok()?),
    };
    let left = left.parse().ok().filter(|&left| left > 0)?;
    Some(Hold { event: event.into(), left, bytes })
}

/// Writes an event, and holds where that is asked for. Where nobody listens it does nothing.
pub(crate) fn happens(event: &str, told: impl Serialize) {
    let Some(observed) = &*OBSERVED else { return };
    let mut observed = observed.lock().unwrap_or_else(PoisonError::into_inner);
    if let Ok(line) = serde_json::to_string(&Line { event, told }) {
        // Whoever does not read events any more does not wait for them.
        let _ = observed.events.write_all((line + "\n").as_bytes());
    }
    let Some(hold) = observed.hold.as_mut().filter(|hold| hold.event == event) else { return };
    hold.left -= 1;
    if hold.left == 0
        && let Some(mut hold) = observed.hold.take()
    {
        drop(observed);
        let _ = hold.bytes.read(&mut [0]);
    }
}

/// Whether limits go by the time that a renderer tells.
pub(crate) fn is_time_told() -> bool {
    std::env::var(CLOCK).is_ok_and(|clock| clock == "renderer")
}
