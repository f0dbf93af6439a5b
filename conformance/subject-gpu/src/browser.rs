//! Browsers as subjects.

use crate::on_gpu;
use lightmeter_browser::{BrowserHello, ServedBrowser, Session};
use lightmeter_document::report::Identity;
use lightmeter_engine::subject::Subject;
use lightmeter_gpu::{Gpu, Host};
use lightmeter_judge::devices::Known;
use std::sync::Arc;

/// A browser that opened the page as a subject.
#[must_use]
pub fn of_session(name: String, session: Arc<Session>) -> Subject {
    let hello = session.hello().clone();
    of_host(name, &hello, session)
}

/// The same, whose page is served as long as the subject lives.
#[must_use]
pub fn of_served(name: String, browser: ServedBrowser) -> Subject {
    let hello = browser.hello().clone();
    of_host(name, &hello, Arc::new(browser))
}

fn of_host(name: String, hello: &BrowserHello, host: Arc<dyn Host>) -> Subject {
    let (device, driver) = (hello.device(), hello.driver());
    // A browser tells neither the driver nor its version, so no deviation is granted, no record of special values holds, and a rasteriser has the
    // 4 subpixel bits that are promised.
    on_gpu(Identity { name, device, backend: "webgpu".into(), driver }, Known::default(), Gpu::hosted(host))
}
