//! A headless Chromium of its own, for machines without a screen.

use crate::server::{Server, ServerError};
use crate::session::Session;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Names that Chromium and its relatives are installed under.
const NAMES: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// WebGPU without a screen, by SwiftShader where there is no GPU; nothing is asked of the network, and nothing is slowed down because nobody looks.
const ARGUMENTS: [&str; 14] = [
    "--headless=new",
    "--enable-unsafe-webgpu",
    "--enable-unsafe-swiftshader",
    "--use-angle=swiftshader",
    "--use-webgpu-adapter=swiftshader",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-default-apps",
    "--disable-background-timer-throttling",
    "--disable-renderer-backgrounding",
    "--no-first-run",
    "--mute-audio",
];

/// How long Chromium may take until its page says hello.
const PATIENCE: Duration = Duration::from_secs(60);
/// How often it is looked at whether Chromium still runs.
const LOOK: Duration = Duration::from_millis(200);

/// Why there is no Chromium.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ChromiumError {
    /// None is installed.
    #[error("no Chromium is here; expected one of {} on the PATH, or its path in CHROMIUM. On Debian: apt-get install chromium", NAMES.join(", "))]
    Missing,
    /// It does not start.
    #[error("{} does not start: {source}", path.display())]
    Start {
        /// The program.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// Its page does not say hello.
    #[error("{} {why}. Its page, run by hand, says more: {} --headless=new --enable-unsafe-webgpu --dump-dom URL", path.display(), path.display())]
    Silent {
        /// The program.
        path: PathBuf,
        /// What happened.
        why: String,
    },
    /// There is no server for its page.
    #[error(transparent)]
    Server(#[from] ServerError),
}

/// A Chromium that runs, which ends with this.
#[derive(Debug)]
pub(crate) struct RunningChromium {
    is_over: Arc<AtomicBool>,
    watch: Option<JoinHandle<()>>,
}

/// A running process, which ends with this.
#[derive(Debug)]
struct Process {
    path: PathBuf,
    child: Child,
    /// Its profile, which is deleted after.
    _profile: tempfile::TempDir,
}

impl RunningChromium {
    /// Starts one and the server of its page, and waits until its page says hello.
    ///
    /// # Errors
    /// Where none is installed, it does not start, or its page does not say hello.
    pub(crate) fn start() -> Result<(Server, Arc<Session>, Self), ChromiumError> {
        let server = Server::start(SocketAddr::from((Ipv4Addr::LOCALHOST, 0)))?;
        let mut process = Process::start(&server.access().url())?;
        let until = Instant::now() + PATIENCE;
        let session = loop {
            if let Some(session) = server.next_browser(LOOK) {
                break session;
            }
            let silent = |why: String| ChromiumError::Silent { path: process.path.clone(), why };
            if let Ok(Some(status)) = process.child.try_wait() {
                return Err(silent(format!("ended at once with {status}")));
            }
            if Instant::now() > until {
                return Err(silent(format!("gave no WebGPU within {} s", PATIENCE.as_secs())));
            }
        };
        let is_over = Arc::new(AtomicBool::new(false));
        let watch = std::thread::spawn({
            let (is_over, session) = (is_over.clone(), session.clone());
            move || process.watch(&is_over, &session)
        });
        Ok((server, session, Self { is_over, watch: Some(watch) }))
    }
}

impl Drop for RunningChromium {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if let Some(watch) = self.watch.take() {
            // A watch that panicked has said so.
            let _ = watch.join();
        }
    }
}

impl Process {
    fn start(url: &str) -> Result<Self, ChromiumError> {
        let path = chromium_program().ok_or(ChromiumError::Missing)?;
        let failed = |source| ChromiumError::Start { path: path.clone(), source };
        let profile = tempfile::Builder::new().prefix("lightmeter-chromium-").tempdir().map_err(failed)?;
        let mut command = Command::new(&path);
        command.args(ARGUMENTS).arg(format!("--user-data-dir={}", profile.path().display()));
        if is_root() {
            // Chromium refuses to start its sandbox as root.
            command.arg("--no-sandbox");
        }
        command.arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let child = command.spawn().map_err(failed)?;
        Ok(Self { path, child, _profile: profile })
    }

    /// Ends the session where the process ends before it.
    fn watch(mut self, is_over: &AtomicBool, session: &Session) {
        while !is_over.load(Ordering::Relaxed) {
            if let Ok(Some(status)) = self.child.try_wait() {
                session.end(&format!("Chromium ended with {status}"));
                return;
            }
            std::thread::sleep(LOOK);
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The program that is started: the one that CHROMIUM names, or the first that is on the PATH. `None` where none is installed.
#[must_use]
pub fn chromium_program() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CHROMIUM").filter(|path| !path.is_empty()) {
        return Some(named.into());
    }
    let folders: Vec<PathBuf> =
        std::env::var_os("PATH").map(|path| std::env::split_paths(&path).collect()).unwrap_or_default();
    let found = |name: &&str| folders.iter().map(|folder| folder.join(name)).find(|path| path.is_file());
    NAMES.iter().find_map(found)
}

#[cfg(unix)]
fn is_root() -> bool {
    rustix::process::geteuid().is_root()
}

#[cfg(not(unix))]
const fn is_root() -> bool {
    false
}
