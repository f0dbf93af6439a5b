//! The server and its sessions, asked as pages ask, and as nobody should.

use crate::server::{Access, Server, ServerError};
use crate::session::{BrowserHello, Session};
use lightmeter_gpu::work::{Resources, Submission};
use lightmeter_gpu::{Host as _, HostError, WorkPiece};
use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

fn server() -> Server {
    Server::start(([127, 0, 0, 1], 0).into()).expect("a port is free")
}

/// The status and the body that a request is answered with. Headers come after those that every request has.
fn ask(server: &Server, line: &str, headers: &str, body: &[u8]) -> (u16, Vec<u8>) {
    let mut stream = TcpStream::connect(server.access().address).expect("the server listens");
    let head = format!("{line} HTTP/1.1\r\nConnection: close\r\nContent-Length: {}\r\n{headers}\r\n", body.len());
    stream.write_all(head.as_bytes()).expect("the server reads");
    // What is refused by its head may be answered before its body was read.
    let _ = stream.write_all(body);
    let mut answer = vec![];
    let _ = stream.read_to_end(&mut answer);
    let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("an answer has a head");
    let status = String::from_utf8_lossy(&answer[..end]).split(' ').nth(1).and_then(|code| code.parse().ok());
    (status.expect("an answer has a status"), answer[end + 4..].to_vec())
}

fn host(server: &Server) -> String {
    format!("Host: {}\r\n", server.access().address)
}

fn path(server: &Server, name: &str) -> String {
    format!("/{}/{name}", server.access().token)
}

const HELLO: &str = r#"{"protocol": 1, "session": null, "vendor": "maker", "architecture": "modern", "model": "", "description": "", "platform": "Linux",
    "browser": "Tester", "version": "1", "abilities": {"is_cpu": true, "most_pixels": 8192, "features": ["float32-blendable"]}}"#;

#[test]
fn the_page_is_served_and_what_nobody_should_ask_is_refused() {
    let server = server();
    let own = host(&server);
    let get = |name: &str, headers: &str| ask(&server, &format!("GET {}", path(&server, name)), headers, b"").0;
    let post =
        |name: &str, headers: &str, body: &[u8]| ask(&server, &format!("POST {}", path(&server, name)), headers, body);
    for name in ["", "page.js", "executor.js", "cbor.js", "style.css"] {
        assert_eq!(get(name, &own), 200, "{name}");
    }
    assert_eq!(get("", &format!("Host: localhost:{}\r\n", server.access().address.port())), 200);
    assert_eq!(get("", "Host: example.org\r\n"), 421, "another host");
    assert_eq!(get("", ""), 421, "no host");
    assert_eq!(get("", &format!("{own}Origin: http://example.org\r\n")), 403, "another page");
    assert_eq!(get("", &format!("{own}Origin: http://{}\r\n", server.access().address)), 200);
    assert_eq!(ask(&server, "GET /", &own, b"").0, 404, "no token");
    assert_eq!(ask(&server, &format!("GET /{}/", "0".repeat(32)), &own, b"").0, 404, "a wrong token");
    assert_eq!(get("secret", &own), 404);
    assert_eq!(get("next?session=0&page=1&after=0", &own), 403, "no such session");
    assert_eq!(post("hello", &own, b"rubbish").0, 400);
    assert_eq!(post("hello", &own, &vec![b' '; (1 << 16) + 1]).0, 413);
    let (status, told) = post("hello", &own, br#"{"protocol": 2, "more": "than today"}"#);
    let told = String::from_utf8_lossy(&told).into_owned();
    assert!(status == 400 && told.contains("version 2") && told.contains("load the page again"), "{told}");
    assert_eq!(post("page.js", &own, b"").0, 405);
    assert!(server.next_browser(Duration::ZERO).is_none(), "none of these is a browser");
    assert_eq!(post("hello", &own, HELLO.as_bytes()).0, 200);
    let session = server.next_browser(Duration::ZERO).expect("it said hello");
    assert_eq!(session.hello().device(), "maker modern");
    assert_eq!(session.hello().driver(), "Tester 1 on Linux");
    let of_session = |name: &str, more: &str| format!("{name}?session={}&page=1{more}", session.id);
    assert_eq!(post(&of_session("answer", "&id=1&kind=guessed"), &own, b"").0, 400);
    assert_eq!(post(&of_session("answer", "&id=one&kind=done"), &own, b"").0, 400);
    assert_eq!(post(&of_session("answer", "&id=77&kind=done"), &own, b"").0, 200, "what was never asked is no answer");
}

#[test]
fn an_address_that_stands_for_all_is_refused_with_what_would_be_right() {
    let refused = Server::start(([0, 0, 0, 0], 0).into()).expect_err("no browser opens it");
    assert!(matches!(refused, ServerError::Unspecified(_)), "{refused}");
    assert!(refused.to_string().contains("192.168.1.20:8443"), "{refused}");
}

#[test]
fn a_page_is_called_by_its_scheme_and_without_the_port_that_goes_without_saying() {
    let access = |address: &str, fingerprint: Option<&str>| Access {
        address: address.parse().expect("an address"),
        token: "t".into(),
        fingerprint: fingerprint.map(str::to_owned),
    };
    for (access, url, hosts) in [
        (access("127.0.0.1:8080", None), "http://127.0.0.1:8080/t/", &["127.0.0.1:8080", "localhost:8080"][..]),
        (
            access("127.0.0.1:80", None),
            "http://127.0.0.1:80/t/",
            &["127.0.0.1:80", "localhost:80", "127.0.0.1", "localhost"],
        ),
        (access("192.0.2.5:443", Some("AB")), "https://192.0.2.5:443/t/", &["192.0.2.5:443", "192.0.2.5"]),
        (access("[2001:db8::5]:8443", Some("AB")), "https://[2001:db8::5]:8443/t/", &["[2001:db8::5]:8443"]),
    ] {
        assert_eq!(access.url(), url);
        assert_eq!(access.hosts(), hosts, "{url}");
    }
}

/// A session with a page, and what makes something for its first executor.
fn session() -> (Arc<Session>, u64) {
    let hello: BrowserHello = serde_json::from_str(HELLO).expect("it is a hello");
    let session = Arc::new(Session::new("s".into(), hello));
    let page = session.take_over();
    (session, page)
}

/// The numbers of the pieces that a page is handed.
fn handed(session: &Session, page: u64, after: u64) -> Vec<u64> {
    let bytes = session.after(page, after, Duration::ZERO).expect("the page has the session");
    let (mut ids, mut rest) = (vec![], &bytes[..]);
    while let Some((head, more)) = rest.split_at_checked(12) {
        ids.push(u64::from_le_bytes(head[..8].try_into().expect("8 bytes")));
        let length = u32::from_le_bytes(head[8..].try_into().expect("4 bytes"));
        rest = &more[length as usize..];
    }
    ids
}

#[test]
fn a_page_that_is_loaded_again_is_handed_what_is_kept_and_what_is_open_and_nothing_is_counted_twice() {
    let (session, first) = session();
    let (resources, work) = (Resources::default(), Submission::default());
    let make = |executor| session.send(&WorkPiece::Make { executor, resources: &resources });
    let submit = |executor| session.send(&WorkPiece::Submit { executor, work: &work });
    let [kept, done, open, dropped] = [make(1), submit(1), submit(1), make(2)];
    assert_eq!(handed(&session, first, 0), [1, 2, 3, 4]);
    assert_eq!(handed(&session, first, 4), [0; 0]);
    session.answer(first, kept.0, Ok(vec![])).expect("it is its page");
    session.answer(first, done.0, Ok(vec![1])).expect("it is its page");
    session.answer(first, done.0, Ok(vec![2])).expect("what is told twice is no error");
    session.answer(first, dropped.0, Ok(vec![])).expect("it is its page");
    session.wait(dropped).expect("it was answered");
    session.send(&WorkPiece::Drop { executor: 2 });
    // What is made after its executor was dropped is not kept.
    let late = make(2);
    session.answer(first, late.0, Ok(vec![])).expect("it is its page");
    let second = session.take_over();
    session.answer(first, open.0, Ok(vec![3])).expect_err("another page has the session");
    session.after(first, 0, Duration::ZERO).expect_err("another page has the session");
    // The first executor's resources, the open piece, and that the second is dropped.
    assert_eq!(handed(&session, second, 0), [1, 3, 5]);
    assert_eq!(handed(&session, second, 0), [1, 3], "what a page was told to drop is gone");
    session.answer(second, open.0, Ok(vec![4])).expect("it is its page");
    assert_eq!(session.wait(done), Ok(vec![1]), "the first answer counts");
    assert_eq!(session.wait(open), Ok(vec![4]));
}

#[test]
fn a_piece_at_which_the_device_is_lost_twice_has_failed() {
    let (session, first) = session();
    let work = Submission::default();
    let ticket = session.send(&WorkPiece::Submit { executor: 1, work: &work });
    session.lose(first, "gone").expect("it is its page");
    let second = session.take_over();
    assert_eq!(handed(&session, second, 0), [1], "it is asked again");
    session.lose(second, "gone again").expect("it is its page");
    assert_eq!(session.wait(ticket), Err(HostError::Failed("device lost: gone again".into())));
}

#[test]
fn nobody_waits_for_a_session_that_has_ended() {
    let (session, _) = session();
    let work = Submission::default();
    let ticket = session.send(&WorkPiece::Submit { executor: 1, work: &work });
    session.end("the tab is closed");
    assert_eq!(session.wait(ticket), Err(HostError::Failed("the tab is closed".into())));
}
