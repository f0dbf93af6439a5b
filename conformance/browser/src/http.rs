//! Connections: HTTP, by TLS or without, and the requests that come by them.

use http_body_util::{BodyExt as _, Full, LengthLimitError, Limited};
use hyper::body::{Body as _, Bytes, Incoming};
use hyper::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderMap, REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use hyper::header::{HeaderName, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use std::collections::HashMap;
use std::convert::Infallible;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::Semaphore;
use tokio::task::spawn_blocking;
use tokio::time::{sleep, timeout};
use tokio_rustls::TlsAcceptor;

/// How long a connection may take until it is encrypted, and a request until its head is there.
const HANDSHAKE: Duration = Duration::from_secs(10);
/// Connections at once, at most; a browser opens six.
const CONNECTIONS_MOST: usize = 256;
/// How long the server waits after it could not take a connection.
const PAUSE: Duration = Duration::from_millis(100);
/// How long the end waits for answers that are under way.
const GOODBYE: Duration = Duration::from_millis(200);

/// An answer to a request: a status, a type and a body.
pub(crate) struct Reply {
    pub(crate) status: u16,
    pub(crate) kind: &'static str,
    pub(crate) body: Vec<u8>,
    pub(crate) policy: &'static str,
}

/// A request whose body was read.
pub(crate) struct Asked {
    pub(crate) method: Method,
    /// The path without what follows `?`.
    pub(crate) path: String,
    query: String,
    pub(crate) body: Bytes,
}

impl Asked {
    /// What follows `?`.
    pub(crate) fn query(&self) -> HashMap<&str, &str> {
        self.query.split('&').filter_map(|part| part.split_once('=')).collect()
    }
}

/// What answers requests.
pub(crate) trait Answers: Send + Sync + 'static {
    /// Why a request is refused before its body is read.
    fn refusal(&self, head: &HeaderMap) -> Option<Reply>;

    /// The bytes that a request's body may have.
    fn most_bytes(&self, asked: &Asked) -> usize;

    /// The answer; it may take its time.
    fn reply(&self, asked: &Asked) -> Reply;

    /// The answer to a body that is too long, or ends early.
    fn refused(&self, status: u16, why: &str) -> Reply;
}

/// Takes connections until it is dropped.
#[derive(Debug)]
pub(crate) struct Connections(Option<Runtime>);

impl Connections {
    /// Takes connections of a listener, encrypted where there is an acceptor.
    ///
    /// # Errors
    /// Where the system gives no threads.
    pub(crate) fn take(
        listener: TcpListener,
        tls: Option<TlsAcceptor>,
        answers: Arc<impl Answers>,
    ) -> io::Result<Self> {
        listener.set_nonblocking(true)?;
        let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build()?;
        let listener = {
            let _entered = runtime.enter();
            tokio::net::TcpListener::from_std(listener)?
        };
        runtime.spawn(accept(listener, tls, answers));
        Ok(Self(Some(runtime)))
    }
}

impl Drop for Connections {
    fn drop(&mut self) {
        if let Some(runtime) = self.0.take() {
            // What is answered now is still sent; a page that does not read it does not keep the program.
            std::thread::sleep(GOODBYE);
            runtime.shutdown_background();
        }
    }
}

/// Takes connections for ever.
async fn accept(listener: tokio::net::TcpListener, tls: Option<TlsAcceptor>, answers: Arc<impl Answers>) {
    let places = Arc::new(Semaphore::new(CONNECTIONS_MOST));
    loop {
        let Ok(place) = places.clone().acquire_owned().await else { return };
        let taken: io::Result<(TcpStream, SocketAddr)> = listener.accept().await;
        let Ok((stream, _)) = taken else {
            sleep(PAUSE).await;
            continue;
        };
        let (tls, answers) = (tls.clone(), answers.clone());
        tokio::spawn(async move {
            connection(stream, tls, answers).await;
            drop(place);
        });
    }
}

/// Answers what comes by a connection. What goes wrong with it ends it, and the browser tries anew.
async fn connection(stream: TcpStream, tls: Option<TlsAcceptor>, answers: Arc<impl Answers>) {
    let _ = stream.set_nodelay(true);
    let service = service_fn(move |request| answer(answers.clone(), request));
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new()).header_read_timeout(HANDSHAKE);
    let _ = match tls {
        None => http.serve_connection(TokioIo::new(stream), service).await,
        Some(tls) => match timeout(HANDSHAKE, tls.accept(stream)).await {
            Ok(Ok(stream)) => http.serve_connection(TokioIo::new(stream), service).await,
            _ => return,
        },
    };
}

async fn answer(answers: Arc<impl Answers>, request: Request<Incoming>) -> Result<Response<Full<Bytes>>, Infallible> {
    let reply = match answers.refusal(request.headers()) {
        Some(refusal) => refusal,
        None => match read(&*answers, request).await {
            Err(refusal) => refusal,
            Ok(asked) => {
                let by = answers.clone();
                let replied = spawn_blocking(move || by.reply(&asked)).await;
                replied.unwrap_or_else(|_| answers.refused(500, "the answer ended by a panic, which the terminal has"))
            }
        },
    };
    Ok(response(reply))
}

/// A request with its body, which must not be longer than it may be.
async fn read(answers: &impl Answers, request: Request<Incoming>) -> Result<Asked, Reply> {
    let (head, body) = request.into_parts();
    let (path, query) = (head.uri.path().to_owned(), head.uri.query().unwrap_or_default().to_owned());
    let asked = Asked { method: head.method, path, query, body: Bytes::new() };
    let most = answers.most_bytes(&asked);
    let too_long = || answers.refused(413, &format!("at most {most} bytes are taken"));
    if body.size_hint().lower() > most as u64 {
        return Err(too_long());
    }
    match Limited::new(body, most).collect().await {
        Ok(body) => Ok(Asked { body: body.to_bytes(), ..asked }),
        Err(error) if error.is::<LengthLimitError>() => Err(too_long()),
        Err(error) => Err(answers.refused(400, &format!("the body ends early: {error}"))),
    }
}

fn response(reply: Reply) -> Response<Full<Bytes>> {
    let mut response = Response::new(Full::new(Bytes::from(reply.body)));
    *response.status_mut() = StatusCode::from_u16(reply.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
    let mut header = |name: HeaderName, value: &'static str| {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    };
    header(CONTENT_TYPE, reply.kind);
    header(CONTENT_SECURITY_POLICY, reply.policy);
    header(X_CONTENT_TYPE_OPTIONS, "nosniff");
    header(REFERRER_POLICY, "no-referrer");
    header(CACHE_CONTROL, "no-store");
    response
}
