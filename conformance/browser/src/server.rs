//! The server that hands work to pages: by http on the machine itself, and by https to other machines.

use crate::http::{Answers, Asked, Connections, Reply};
use crate::play::{PlayReply, PlayedShader};
use crate::session::{BrowserHello, PROTOCOL, Session, Superseded};
use crate::tls::certified;
use hyper::Method;
use hyper::header::{HOST, HeaderMap, HeaderName, ORIGIN};
use lightmeter_gpu::HostError;
use serde::Serialize;
use std::collections::{HashMap, VecDeque};
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long a page is kept waiting for work before it asks again.
const LONG_POLL: Duration = Duration::from_secs(15);
/// How long a page is kept waiting for what becomes of a shader.
const PLAY: Duration = Duration::from_secs(120);
/// Bytes of an answer, at most.
const ANSWER_MOST: usize = 1 << 28;
/// Bytes of what a page says of itself or of an error, at most.
const WORDS_MOST: usize = 1 << 16;
/// Sessions at once, at most.
const SESSIONS_MOST: usize = 64;

/// The page's files, by their names.
const FILES: [(&str, &str, &str); 7] = [
    ("", "text/html; charset=utf-8", include_str!("page/index.html")),
    ("style.css", "text/css", include_str!("page/style.css")),
    ("page.js", "text/javascript", include_str!("page/page.js")),
    ("playground.js", "text/javascript", include_str!("page/playground.js")),
    ("examples.js", "text/javascript", include_str!("page/examples.js")),
    ("executor.js", "text/javascript", include_str!("page/executor.js")),
    ("cbor.js", "text/javascript", include_str!("page/cbor.js")),
];

/// Nothing but the server's own files, and no requests to anybody else.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src blob: data:; base-uri 'none'; form-action 'none'; \
                      frame-ancestors 'none'";
/// A report has its style and script within, by their hashes, as its own policy says.
const REPORT_POLICY: &str = "frame-ancestors 'none'";

/// Why there is no server.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServerError {
    /// The address stands for all addresses of the machine, and a certificate is made for one.
    #[error(
        "{0} is no address that a browser can open. Name the one by which the other machine reaches this one, as 192.168.1.20:8443, \
         or 127.0.0.1 for this machine alone"
    )]
    Unspecified(IpAddr),
    /// The address cannot be bound.
    #[error("cannot listen at {0}: {1}")]
    Bind(SocketAddr, String),
    /// TLS cannot be had.
    #[error("cannot serve https at {0}: {1}")]
    Tls(SocketAddr, String),
    /// The system gives no random numbers.
    #[error("no random numbers are to be had for the address's token: {0}")]
    Random(String),
}

/// Where pages find the server.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Access {
    /// The address.
    pub address: SocketAddr,
    /// What the path begins with, so that nobody else finds the page.
    pub token: String,
    /// SHA-256 of the certificate, as browsers show it, where the server speaks https.
    pub fingerprint: Option<String>,
}

impl Access {
    /// The page's address.
    #[must_use]
    pub fn url(&self) -> String {
        format!("{}/{}/", self.origin(&self.hosts()[0]), self.token)
    }

    /// What a browser may call the server in the header `Host`. It leaves out the port that goes without saying.
    pub(crate) fn hosts(&self) -> Vec<String> {
        let (scheme_port, port) = (if self.fingerprint.is_some() { 443 } else { 80 }, self.address.port());
        let full = self.address.to_string();
        let mut hosts = vec![full.clone()];
        if self.address.ip().is_loopback() {
            hosts.push(format!("localhost:{port}"));
        }
        if port == scheme_port {
            let bare = |host: &String| host.strip_suffix(&format!(":{port}")).map(str::to_owned);
            hosts.extend(hosts.iter().filter_map(bare).collect::<Vec<_>>());
        }
        hosts
    }

    /// What a browser calls a page of one of these hosts in the header `Origin`.
    fn origin(&self, host: &str) -> String {
        format!("{}://{host}", if self.fingerprint.is_some() { "https" } else { "http" })
    }
}

/// A server at an address of its own.
#[derive(Debug)]
pub struct Server {
    shared: Arc<Shared>,
    _connections: Connections,
}

#[derive(Debug)]
struct Shared {
    access: Access,
    sessions: Mutex<Sessions>,
    arrived: Condvar,
}

#[derive(Debug, Default)]
struct Sessions {
    all: HashMap<String, Arc<Session>>,
    waiting: VecDeque<Arc<Session>>,
}

/// The part of a hello that all versions of the protocol have.
#[derive(serde::Deserialize)]
struct Spoken {
    #[serde(default)]
    protocol: u32,
}

impl Reply {
    fn new(status: u16, kind: &'static str, body: impl Into<Vec<u8>>) -> Self {
        Self { status, kind, body: body.into(), policy: POLICY }
    }

    fn refused(status: u16, why: &str) -> Self {
        Self::new(status, "text/plain; charset=utf-8", why)
    }

    fn taken() -> Self {
        Self::new(200, "text/plain; charset=utf-8", "taken")
    }

    fn json(value: &impl Serialize) -> Self {
        Self::new(200, "application/json", serde_json::to_vec(value).unwrap_or_default())
    }
}

impl From<Superseded> for Reply {
    fn from(_: Superseded) -> Self {
        Self::refused(409, "another page has this session")
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Random digits that nobody guesses.
fn token() -> Result<String, ServerError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| ServerError::Random(error.to_string()))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

impl Server {
    /// Listens at an address; port 0 is any that is free. Where other machines reach the address, the server speaks https, with a certificate of its own.
    ///
    /// # Errors
    /// Where the address is none that a browser can open, or cannot be bound.
    pub fn start(address: SocketAddr) -> Result<Self, ServerError> {
        if address.ip().is_unspecified() {
            return Err(ServerError::Unspecified(address.ip()));
        }
        let listener = TcpListener::bind(address).map_err(|error| ServerError::Bind(address, error.to_string()))?;
        let bound = listener.local_addr().unwrap_or(address);
        let is_own = address.ip().is_loopback();
        let tls = if is_own { None } else { Some(certified(address.ip())) };
        let tls = tls.transpose().map_err(|error| ServerError::Tls(address, error))?;
        let (tls, fingerprint) = tls.unzip();
        let access = Access { address: bound, token: token()?, fingerprint };
        let shared = Arc::new(Shared { access, sessions: Mutex::default(), arrived: Condvar::new() });
        let connections = Connections::take(listener, tls, shared.clone());
        let connections = connections.map_err(|error| ServerError::Bind(address, error.to_string()))?;
        Ok(Self { shared, _connections: connections })
    }

    /// Where pages find it.
    #[must_use]
    pub fn access(&self) -> &Access {
        &self.shared.access
    }

    /// The next browser that opens the page; `None` where none does in time.
    #[must_use]
    pub fn next_browser(&self, patience: Duration) -> Option<Arc<Session>> {
        let until = Instant::now() + patience;
        let mut sessions = locked(&self.shared.sessions);
        loop {
            if let Some(session) = sessions.waiting.pop_front() {
                return Some(session);
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return None;
            }
            sessions = self.shared.arrived.wait_timeout(sessions, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        for session in locked(&self.shared.sessions).all.values() {
            session.end("the server has ended");
        }
    }
}

impl Answers for Shared {
    fn refusal(&self, head: &HeaderMap) -> Option<Reply> {
        let value =
            |name: HeaderName| head.get(name).map(|value| String::from_utf8_lossy(value.as_bytes()).into_owned());
        let hosts = self.access.hosts();
        if !hosts.contains(&value(HOST).unwrap_or_default()) {
            return Some(Reply::refused(421, "the Host header is not this server's address"));
        }
        let is_own = |origin: &String| hosts.iter().any(|host| *origin == self.access.origin(host));
        if value(ORIGIN).is_some_and(|origin| !is_own(&origin)) {
            return Some(Reply::refused(403, "another page's requests are refused"));
        }
        None
    }

    fn most_bytes(&self, asked: &Asked) -> usize {
        let is_result =
            asked.path == format!("/{}/answer", self.access.token) && asked.query().get("kind") == Some(&"done");
        if is_result { ANSWER_MOST } else { WORDS_MOST }
    }

    fn reply(&self, asked: &Asked) -> Reply {
        let prefix = format!("/{}/", self.access.token);
        let Some(name) = asked.path.strip_prefix(&prefix) else {
            return Reply::refused(
                404,
                "there is nothing here: open the address that lightmeter printed, with its token",
            );
        };
        let query = asked.query();
        let replied = match (&asked.method, name) {
            (&Method::GET, "report.html" | "report.json") => self.report(name, &query),
            (&Method::GET, "picture.png") => self.picture(&query),
            (&Method::GET, "next") => self.next(&query),
            (&Method::GET, "state") => self.state(&query),
            (&Method::GET, _) => match FILES.iter().find(|(file, ..)| *file == name) {
                Some((_, kind, text)) => Ok(Reply::new(200, kind, *text)),
                None => Err(Reply::refused(404, "there is no such file")),
            },
            (&Method::POST, "hello") => self.hello(&asked.body),
            (&Method::POST, "answer") => self.answer(&asked.body, &query),
            (&Method::POST, "bye") => self.bye(&query),
            (&Method::POST, "lost") => self.lost(&asked.body, &query),
            (&Method::POST, "play") => self.play(&asked.body, &query),
            _ => Err(Reply::refused(405, "expected GET of a file, or POST of hello, answer, play, lost or bye")),
        };
        replied.unwrap_or_else(|reply| reply)
    }

    fn refused(&self, status: u16, why: &str) -> Reply {
        Reply::refused(status, why)
    }
}

impl Shared {
    fn report(&self, name: &str, query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, _) = self.session(query)?;
        let (text, kind) = if name == "report.html" {
            (session.page(), "text/html; charset=utf-8")
        } else {
            (session.json(), "application/json")
        };
        let text = text.ok_or_else(|| Reply::refused(404, "there is no report yet"))?;
        Ok(Reply { policy: REPORT_POLICY, ..Reply::new(200, kind, text) })
    }

    fn picture(&self, query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, _) = self.session(query)?;
        let number = usize::try_from(number(query, "number")?).unwrap_or(usize::MAX);
        let png = session.picture(number).ok_or_else(|| Reply::refused(404, "there is no such picture"))?;
        Ok(Reply::new(200, "image/png", png))
    }

    fn hello(&self, body: &[u8]) -> Result<Reply, Reply> {
        let no_hello = |error: serde_json::Error| Reply::refused(400, &format!("not a hello: {error}"));
        // The version comes first: another one's hello may have other fields.
        let Spoken { protocol: spoken } = serde_json::from_slice(body).map_err(no_hello)?;
        if spoken != PROTOCOL {
            return Err(Reply::refused(
                400,
                &format!(
                    "this page speaks version {spoken} of the protocol, and lightmeter version {PROTOCOL}: load the page again"
                ),
            ));
        }
        let hello: BrowserHello = serde_json::from_slice(body).map_err(no_hello)?;
        let mut sessions = locked(&self.sessions);
        sessions.all.retain(|_, session| !session.is_gone());
        let known = hello.session.as_ref().and_then(|id| sessions.all.get(id)).cloned();
        let known = known.filter(|known| known.hello().abilities == hello.abilities && !known.has_ended());
        let session = match known {
            Some(session) => session,
            None if sessions.all.len() >= SESSIONS_MOST => {
                return Err(Reply::refused(503, "there are too many sessions"));
            }
            None => {
                let id = token().map_err(|error| Reply::refused(500, &error.to_string()))?;
                let session = Arc::new(Session::new(id.clone(), hello));
                sessions.all.insert(id, session.clone());
                sessions.waiting.push_back(session.clone());
                self.arrived.notify_all();
                session
            }
        };
        Ok(Reply::json(&serde_json::json!({ "session": session.id, "page": session.take_over() })))
    }

    fn next(&self, query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, page) = self.session(query)?;
        let pieces = session.after(page, number(query, "after")?, LONG_POLL)?;
        // 205 is no error, of which a browser's console would tell.
        let status = match (pieces.is_empty(), session.has_ended()) {
            (false, _) => 200,
            (true, false) => 204,
            (true, true) => 205,
        };
        Ok(Reply::new(status, "application/octet-stream", pieces))
    }

    fn answer(&self, body: &[u8], query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, page) = self.session(query)?;
        let id = number(query, "id")?;
        let words = || String::from_utf8_lossy(body).into_owned();
        let result = match query.get("kind") {
            Some(&"done") => Ok(body.to_vec()),
            Some(&"refused") => Err(HostError::Refused(words())),
            Some(&"failed") => Err(HostError::Failed(words())),
            _ => return Err(Reply::refused(400, "expected kind=done, refused or failed")),
        };
        session.answer(page, id, result)?;
        Ok(Reply::taken())
    }

    fn lost(&self, message: &[u8], query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, page) = self.session(query)?;
        session.lose(page, &String::from_utf8_lossy(message))?;
        Ok(Reply::taken())
    }

    /// A shader that was typed into the page; the reply is what becomes of it.
    fn play(&self, body: &[u8], query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, page) = self.session(query)?;
        session.see(page)?;
        if session.told(usize::MAX).playground.is_empty() {
            return Err(Reply::refused(404, "there is no playground: start it by `lightmeter serve --playground`"));
        }
        let shader: PlayedShader =
            serde_json::from_slice(body).map_err(|error| Reply::refused(400, &format!("not a shader: {error}")))?;
        match session.play(shader, PLAY) {
            PlayReply::Done(result) => Ok(Reply::new(200, "application/json", result)),
            PlayReply::Superseded => Ok(Reply::new(204, "application/json", "")),
            PlayReply::Late => Err(Reply::refused(503, "the shader is not judged in time")),
            PlayReply::Over => Err(over()),
        }
    }

    /// A page is closed or loaded again.
    fn bye(&self, query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, page) = self.session(query)?;
        session.leave(page)?;
        Ok(Reply::taken())
    }

    /// What the page is told, with the groups that it does not have yet.
    fn state(&self, query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, page) = self.session(query)?;
        session.see(page)?;
        let from = usize::try_from(number(query, "groups")?).unwrap_or(usize::MAX);
        let mut told = session.told(from);
        if locked(&self.sessions).waiting.iter().any(|waiting| waiting.id == session.id) {
            told.says =
                "Waiting: another browser's page came first. `lightmeter serve --keep` judges all that come.".into();
        }
        Ok(Reply::json(&told))
    }

    fn session(&self, query: &HashMap<&str, &str>) -> Result<(Arc<Session>, u64), Reply> {
        let found = query.get("session").and_then(|id| locked(&self.sessions).all.get(*id).cloned());
        let session = found.ok_or_else(|| Reply::refused(403, "there is no such session: load the page again"))?;
        Ok((session, number(query, "page")?))
    }
}

/// That a session has ended, of which the page may not know.
fn over() -> Reply {
    Reply::refused(
        410,
        "this session has ended: nothing is judged any more. Load the page again, or start lightmeter again",
    )
}

fn number(query: &HashMap<&str, &str>, name: &str) -> Result<u64, Reply> {
    let number = query.get(name).and_then(|text| text.parse().ok());
    number.ok_or_else(|| Reply::refused(400, &format!("expected {name}=NUMBER")))
}
