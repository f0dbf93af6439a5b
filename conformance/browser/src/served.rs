//! A browser with the server of its page, for as long as a command needs it.

use crate::chromium::{ChromiumError, RunningChromium};
use crate::server::Server;
use crate::session::{BrowserHello, Session};
use lightmeter_gpu::{Abilities, Host, HostError, Ticket, WorkPiece};
use std::sync::Arc;

/// A browser that answers, with the server of its page. The server ends with this, and so does a Chromium that was started for it.
#[derive(Debug)]
pub struct ServedBrowser {
    session: Arc<Session>,
    chromium: Option<RunningChromium>,
    /// Ends last: until then the page finds it.
    _server: Server,
}

impl ServedBrowser {
    /// A browser that somebody opened the page in.
    #[must_use]
    pub fn opened(session: Arc<Session>, server: Server) -> Self {
        session.tell(|told| told.says = "This GPU computes what the command in the terminal asks.".into());
        Self { session, chromium: None, _server: server }
    }

    /// A headless Chromium, which is started for it.
    ///
    /// # Errors
    /// Where none is installed, it does not start, or its page does not say hello.
    pub fn chromium() -> Result<Self, ChromiumError> {
        let (server, session, chromium) = RunningChromium::start()?;
        Ok(Self { session, chromium: Some(chromium), _server: server })
    }

    /// What its page said of itself.
    #[must_use]
    pub fn hello(&self) -> &BrowserHello {
        self.session.hello()
    }
}

impl Drop for ServedBrowser {
    fn drop(&mut self) {
        // Nobody looks at the page of a headless browser.
        if self.chromium.is_none() {
            self.session.tell_the_end("The command has ended. The terminal has its result.".into(), None);
        }
    }
}

impl Host for ServedBrowser {
    fn abilities(&self) -> Abilities {
        self.session.abilities()
    }

    fn send(&self, piece: &WorkPiece<'_>) -> Ticket {
        self.session.send(piece)
    }

    fn wait(&self, ticket: Ticket) -> Result<Vec<u8>, HostError> {
        self.session.wait(ticket)
    }

    fn forget(&self, ticket: Ticket) {
        self.session.forget(ticket);
    }
}
