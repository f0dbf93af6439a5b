//! A browser that somebody opened a page in, for as long as a command needs it.

use crate::server::Server;
use crate::session::{BrowserHello, Session};
use lightmeter_gpu::{Abilities, Host, HostError, Ticket, WorkPiece};
use std::sync::Arc;

/// A browser's session with the server of its page, which ends with this.
#[derive(Debug)]
pub struct Visitor {
    session: Arc<Session>,
    /// Ends last: until then the page finds it.
    _server: Server,
}

impl Visitor {
    /// The browser of a session, and the server that it is of.
    #[must_use]
    pub fn new(session: Arc<Session>, server: Server) -> Self {
        session.tell(|told| told.says = "This GPU computes what the command in the terminal asks.".into());
        Self { session, _server: server }
    }

    /// What its page said of itself.
    #[must_use]
    pub fn hello(&self) -> &BrowserHello {
        self.session.hello()
    }
}

impl Drop for Visitor {
    fn drop(&mut self) {
        self.session.tell_the_end("The command has ended. The terminal has its result.".into(), None);
    }
}

impl Host for Visitor {
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
