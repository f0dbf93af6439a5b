//! The server that hands work to pages, on the machine itself alone.

use crate::session::{BrowserHello, Session, Superseded};
use lightmeter_gpu::HostError;
use serde::Serialize;
use std::collections::{HashMap, VecDeque};
use std::io::Read as _;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tiny_http::{Header, Method, Request, Response};

/// How long a page is kept waiting for work before it asks again.
const LONG_POLL: Duration = Duration::from_secs(15);
/// Bytes of an answer, at most.
const ANSWER_MOST: u64 = 1 << 28;
/// Bytes of what a page says of itself or of an error, at most.
const WORDS_MOST: u64 = 1 << 16;
/// Sessions at once, at most.
const SESSIONS_MOST: usize = 64;
/// Requests that are answered side by side, but for those that wait for work.
const WORKERS: usize = 4;

/// The page's files, by their names.
const FILES: [(&str, &str, &str); 5] = [
    ("", "text/html; charset=utf-8", include_str!("page/index.html")),
    ("style.css", "text/css", include_str!("page/style.css")),
    ("page.js", "text/javascript", include_str!("page/page.js")),
    ("executor.js", "text/javascript", include_str!("page/executor.js")),
    ("cbor.js", "text/javascript", include_str!("page/cbor.js")),
];

/// Nothing but the server's own files, and no requests to anybody else.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; \
                      frame-ancestors 'none'";
/// A report has its style and script within, by their hashes, as its own policy says.
const REPORT_POLICY: &str = "frame-ancestors 'none'";

/// Why there is no server.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServerError {
    /// The address is not the machine's own.
    #[error(
        "other machines reach {0}. Browsers give WebGPU to https pages alone there, and this server speaks http. Listen at 127.0.0.1, and \
         bring it to a phone by `adb reverse tcp:PORT tcp:PORT`, or to another machine by `ssh -R PORT:127.0.0.1:PORT`"
    )]
    NotLoopback(IpAddr),
    /// The address cannot be bound.
    #[error("cannot listen at {0}: {1}")]
    Bind(SocketAddr, String),
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
}

impl Access {
    /// The page's address.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.token)
    }
}

/// A server at an address of its own.
#[derive(Debug)]
pub struct Server {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    access: Access,
    http: HttpServer,
    sessions: Mutex<Sessions>,
    arrived: Condvar,
}

/// tiny_http's server, which has no `Debug`.
struct HttpServer(tiny_http::Server);

impl std::fmt::Debug for HttpServer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("HttpServer")
    }
}

#[derive(Debug, Default)]
struct Sessions {
    all: HashMap<String, Arc<Session>>,
    waiting: VecDeque<Arc<Session>>,
}

/// An answer to a request: a status, a type and a body.
struct Reply {
    status: u16,
    kind: &'static str,
    body: Vec<u8>,
    policy: &'static str,
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
    /// Listens at an address of the machine itself; port 0 is any that is free.
    ///
    /// # Errors
    /// Where the address is one that others reach, or cannot be bound.
    pub fn start(address: SocketAddr) -> Result<Self, ServerError> {
        if !address.ip().is_loopback() {
            return Err(ServerError::NotLoopback(address.ip()));
        }
        let http = tiny_http::Server::http(address).map_err(|error| ServerError::Bind(address, error.to_string()))?;
        let bound = http.server_addr().to_ip().unwrap_or(address);
        let shared = Arc::new(Shared {
            access: Access { address: bound, token: token()? },
            http: HttpServer(http),
            sessions: Mutex::default(),
            arrived: Condvar::new(),
        });
        let worker = |_| {
            let shared = shared.clone();
            std::thread::spawn(move || shared.work())
        };
        Ok(Self { workers: (0..WORKERS).map(worker).collect(), shared })
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
        for _ in 0..WORKERS {
            self.shared.http.0.unblock();
        }
        for worker in self.workers.drain(..) {
            // A worker that panicked has said so.
            let _ = worker.join();
        }
    }
}

impl Shared {
    fn work(self: Arc<Self>) {
        while let Ok(request) = self.http.0.recv() {
            // What waits for work must not keep the others waiting.
            if request.url().contains("/next?") {
                let shared = self.clone();
                std::thread::spawn(move || shared.handle(request));
            } else {
                self.handle(request);
            }
        }
    }

    fn handle(&self, mut request: Request) {
        let reply = self.refusal(&request).unwrap_or_else(|| self.reply(&mut request));
        let header = |name: &str, value: &str| Header::from_bytes(name, value).expect("a header of ASCII");
        let response = Response::from_data(reply.body)
            .with_status_code(reply.status)
            .with_header(header("Content-Type", reply.kind))
            .with_header(header("Content-Security-Policy", reply.policy))
            .with_header(header("X-Content-Type-Options", "nosniff"))
            .with_header(header("Referrer-Policy", "no-referrer"))
            .with_header(header("Cache-Control", "no-store"));
        // A page that is gone does not hear the answer.
        let _ = request.respond(response);
    }

    /// Why a request is refused before its path is looked at: it names another host, or comes from another page.
    fn refusal(&self, request: &Request) -> Option<Reply> {
        let value = |name: &str| {
            let named = |header: &&Header| header.field.as_str().as_str().eq_ignore_ascii_case(name);
            request.headers().iter().find(named).map(|header| header.value.as_str().to_owned())
        };
        let port = self.access.address.port();
        let own = [self.access.address.to_string(), format!("localhost:{port}")];
        let host = value("host").unwrap_or_default();
        if !own.contains(&host) {
            return Some(Reply::refused(421, "the Host header is not this server's address"));
        }
        let is_own = |origin: &String| own.iter().any(|own| *origin == format!("http://{own}"));
        if value("origin").is_some_and(|origin| !is_own(&origin)) {
            return Some(Reply::refused(403, "another page's requests are refused"));
        }
        None
    }

    fn reply(&self, request: &mut Request) -> Reply {
        let url = request.url().to_owned();
        let (path, query) = url.split_once('?').unwrap_or((&url, ""));
        let prefix = format!("/{}/", self.access.token);
        let Some(name) = path.strip_prefix(&prefix) else {
            return Reply::refused(
                404,
                "there is nothing here: open the address that lightmeter printed, with its token",
            );
        };
        let query: HashMap<&str, &str> = query.split('&').filter_map(|part| part.split_once('=')).collect();
        match (request.method(), name) {
            (Method::Get, "report.html" | "report.json") => self.report(name, &query).unwrap_or_else(|reply| reply),
            (Method::Get, "next") => self.next(&query).unwrap_or_else(|reply| reply),
            (Method::Get, "state") => self.state(&query).unwrap_or_else(|reply| reply),
            (Method::Get, _) => match FILES.iter().find(|(file, ..)| *file == name) {
                Some((_, kind, text)) => Reply::new(200, kind, *text),
                None => Reply::refused(404, "there is no such file"),
            },
            (Method::Post, "hello") => self.hello(request).unwrap_or_else(|reply| reply),
            (Method::Post, "answer") => self.answer(request, &query).unwrap_or_else(|reply| reply),
            (Method::Post, "bye") => self.bye(&query).unwrap_or_else(|reply| reply),
            (Method::Post, "lost") => self.lost(request, &query).unwrap_or_else(|reply| reply),
            _ => Reply::refused(405, "expected GET of a file, or POST of hello, answer, lost or bye"),
        }
    }

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

    fn hello(&self, request: &mut Request) -> Result<Reply, Reply> {
        let body = body(request, WORDS_MOST)?;
        let hello: BrowserHello =
            serde_json::from_slice(&body).map_err(|error| Reply::refused(400, &format!("not a hello: {error}")))?;
        let mut sessions = locked(&self.sessions);
        let known = hello.session.as_ref().and_then(|id| sessions.all.get(id)).cloned();
        let known = known.filter(|known| known.hello().abilities == hello.abilities);
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
        let status = if pieces.is_empty() { 204 } else { 200 };
        Ok(Reply::new(status, "application/octet-stream", pieces))
    }

    fn answer(&self, request: &mut Request, query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, page) = self.session(query)?;
        let id = number(query, "id")?;
        let is_done = query.get("kind") == Some(&"done");
        let body = body(request, if is_done { ANSWER_MOST } else { WORDS_MOST })?;
        let words = |body: Vec<u8>| String::from_utf8_lossy(&body).into_owned();
        let result = match query.get("kind") {
            Some(&"done") => Ok(body),
            Some(&"refused") => Err(HostError::Refused(words(body))),
            Some(&"failed") => Err(HostError::Failed(words(body))),
            _ => return Err(Reply::refused(400, "expected kind=done, refused or failed")),
        };
        session.answer(page, id, result)?;
        Ok(Reply::taken())
    }

    fn lost(&self, request: &mut Request, query: &HashMap<&str, &str>) -> Result<Reply, Reply> {
        let (session, page) = self.session(query)?;
        let message = body(request, WORDS_MOST)?;
        session.lose(page, &String::from_utf8_lossy(&message))?;
        Ok(Reply::taken())
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
        Ok(Reply::json(&session.told(from)))
    }

    fn session(&self, query: &HashMap<&str, &str>) -> Result<(Arc<Session>, u64), Reply> {
        let found = query.get("session").and_then(|id| locked(&self.sessions).all.get(*id).cloned());
        let session = found.ok_or_else(|| Reply::refused(403, "there is no such session: load the page again"))?;
        Ok((session, number(query, "page")?))
    }
}

/// A request's body, which must not be longer than that.
fn body(request: &mut Request, most: u64) -> Result<Vec<u8>, Reply> {
    let too_long = || Reply::refused(413, &format!("at most {most} bytes are taken"));
    if request.body_length().is_some_and(|bytes| bytes as u64 > most) {
        return Err(too_long());
    }
    let mut body = vec![];
    let read = request.as_reader().take(most + 1).read_to_end(&mut body);
    read.map_err(|error| Reply::refused(400, &format!("the body ends early: {error}")))?;
    if body.len() as u64 > most { Err(too_long()) } else { Ok(body) }
}

fn number(query: &HashMap<&str, &str>, name: &str) -> Result<u64, Reply> {
    let number = query.get(name).and_then(|text| text.parse().ok());
    number.ok_or_else(|| Reply::refused(400, &format!("expected {name}=NUMBER")))
}
