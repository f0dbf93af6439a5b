//! A browser's GPU as a device: a page that runs work, and the server that hands it out.
//!
//! The page knows no formula. It asks the [`Server`] for pieces of work, as `lightmeter_gpu` describes them, runs them by WebGPU and sends
//! back the bytes that come of it. What they mean, and whether they are right, is judged here. docs/browser.md has the protocol.

mod chromium;
mod http;
mod play;
mod served;
mod server;
mod session;
#[cfg(test)]
mod tests;
mod tls;

pub use chromium::{ChromiumError, chromium_program};
pub use play::{PlayedFormula, PlayedLanguage, PlayedPicture, PlayedResult, PlayedShader};
pub use served::ServedBrowser;
pub use server::{Access, Server, ServerError};
pub use session::{BrowserHello, PageGroup, PageState, Session};
