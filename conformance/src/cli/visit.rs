//! A browser that somebody opens a page in: told of, and waited for.

use super::signals::stopped_by_signals;
use super::{NothingToRun, say};
use lightmeter::adapters::{self, AdapterError};
use lightmeter::browser::{Server, Session};
use lightmeter::document::event::Stop;
use lightmeter::subject::Subject;
use std::sync::Arc;
use std::time::Duration;

/// How often it is looked at whether a signal ends the command.
const LOOK: Duration = Duration::from_millis(200);

/// Opens the adapters of those names. For one that is a browser, this prints the address of its page and waits until a browser opens the page.
pub(super) fn opened(names: &[String]) -> anyhow::Result<Vec<Subject>> {
    let stop = stopped_by_signals()?;
    let mut visited = |server: &Server| {
        tell_of(server);
        awaited(server, &stop)
    };
    match adapters::open_with(names, &mut visited) {
        Err(AdapterError::NoBrowser) => Err(NothingToRun("ended before a browser opened the page".into()).into()),
        opened => Ok(opened?),
    }
}

/// Says where the page is.
pub(super) fn tell_of(server: &Server) {
    let access = server.access();
    say(&format!("open this page in the browser whose GPU is to be judged; Ctrl-C ends it\n  {}", access.url()));
    if let Some(fingerprint) = &access.fingerprint {
        say(&format!(
            "The browser warns that it does not know the certificate, since it was made for this run. Compare its SHA-256 fingerprint, \
             which the browser shows with the certificate, and go on by \"Advanced\" where it is this:\n  {fingerprint}"
        ));
    }
}

/// The next browser that opens the page; `None` where a signal ends the wait.
pub(super) fn awaited(server: &Server, stop: &Stop) -> Option<Arc<Session>> {
    loop {
        if let Some(session) = server.next_browser(LOOK) {
            return Some(session);
        }
        if stop.signal().is_some() {
            return None;
        }
    }
}
