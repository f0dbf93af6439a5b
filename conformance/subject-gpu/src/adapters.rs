//! Adapters by the names that users give them, opened as subjects.

use super::browser;
use super::open_device;
use lightmeter_browser::{ChromiumError, ServedBrowser, Server, ServerError, Session};
use lightmeter_catalogue::nearest::did_you_mean;
use lightmeter_engine::device::DeviceError;
use lightmeter_engine::subject::Subject;
use lightmeter_gpu::{Adapter, native_adapters};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;

/// The name of the embedded implementation, which needs no driver.
pub const EMBEDDED: &str = "cpu";
/// The name of a headless Chromium, which is started for it.
pub const CHROMIUM: &str = "chromium";
/// The name of whatever browser opens the page that is served for it, at an address of this machine; `browser@ADDRESS:PORT` serves it at another one.
pub const BROWSER: &str = "browser";
/// The name that stands for every adapter there is; a browser is none.
pub const ALL: &str = "all";

/// What the Vulkan loader reads the places of drivers from, in place of its own.
const DRIVER_VARIABLES: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// Why an adapter cannot be judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AdapterError {
    /// There is no driver.
    #[error(
        "{0}. `./x run` and `./x test` install lavapipe, a driver that needs no GPU; the embedded implementation needs none: \
         `--adapter cpu`, in tests LIGHTMETER_ADAPTER=cpu"
    )]
    NoDriver(String),
    /// No adapter has that name.
    #[error("no adapter `{name}`{meant} There are {there}, cpu, chromium, browser and all")]
    Unknown {
        /// What was asked for.
        name: String,
        /// The end of the sentence, with names that are near.
        meant: String,
        /// What there is.
        there: String,
    },
    /// There is no Chromium, or it gives no WebGPU.
    #[error(transparent)]
    Chromium(#[from] ChromiumError),
    /// What follows `browser@` is no address.
    #[error("`{0}` names no address; expected browser, or browser@ADDRESS:PORT as browser@192.168.1.20:8443")]
    Address(String),
    /// The page cannot be served.
    #[error(transparent)]
    Server(#[from] ServerError),
    /// No browser opened the page.
    #[error("no browser opened the page")]
    NoBrowser,
    /// The driver gave no device, or the device failed.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl AdapterError {
    fn no_driver() -> Self {
        Self::NoDriver("no Vulkan or OpenGL driver is here".into())
    }
}

/// The adapters of those names, opened, each once; without any, lavapipe or the first there is.
///
/// # Errors
/// Where there is no driver, no adapter of a name, or an adapter that gives no device. A browser is waited for by [`open_with`] alone.
pub fn open(asked: &[String]) -> Result<Vec<Subject>, AdapterError> {
    open_with(asked, &mut |_| None)
}

/// The same. `visited` is handed the server of a page, tells somebody where it is, and gives the browser that opens it.
///
/// # Errors
/// As [`open`], and where no browser opens the page.
pub fn open_with(
    asked: &[String],
    visited: &mut dyn FnMut(&Server) -> Option<Arc<Session>>,
) -> Result<Vec<Subject>, AdapterError> {
    if asked.is_empty() {
        return Ok(vec![open_device(&first()?)?]);
    }
    let needs_none = asked.iter().all(|name| needs_no_driver(name));
    let mut found = if needs_none { vec![] } else { native_adapters() };
    let known = |found: &[Adapter], name: &String| needs_no_driver(name) || found.iter().any(|a| a.name == *name);
    if !asked.iter().all(|name| known(&found, name)) {
        found = lightmeter_gpu::adapters();
    }
    let mut subjects = vec![];
    for name in asked {
        match name.as_str() {
            EMBEDDED => subjects.push(Subject::embedded()),
            CHROMIUM => subjects.push(browser::of_served(CHROMIUM.into(), ServedBrowser::chromium()?)),
            ALL => {
                drivers_named(&found)?;
                if found.is_empty() {
                    return Err(AdapterError::no_driver());
                }
                for adapter in &found {
                    subjects.push(open_device(adapter)?);
                }
            }
            name => match address(name) {
                Some(address) => subjects.push(visitor(name, address?, visited)?),
                None => subjects.push(open_device(named(&found, name)?)?),
            },
        }
    }
    let mut seen = std::collections::HashSet::new();
    subjects.retain(|subject| seen.insert(subject.identity.name.clone()));
    Ok(subjects)
}

/// Whether adapters of those names can be asked for; none stands for the one that is judged without any. No device is opened.
///
/// # Errors
/// Where there is no adapter of a name, or no driver.
pub fn known(asked: &[String]) -> Result<(), AdapterError> {
    let mut found = None;
    for name in asked.iter().filter(|name| *name != ALL && !needs_no_driver(name)) {
        named(found.get_or_insert_with(lightmeter_gpu::adapters), name)?;
    }
    Ok(())
}

/// Whether an adapter of that name is none of this machine's drivers.
#[must_use]
pub fn needs_no_driver(name: &str) -> bool {
    [EMBEDDED, CHROMIUM].contains(&name) || address(name).is_some()
}

/// Where the page of a browser is served; `None` where the name is not a browser's.
fn address(name: &str) -> Option<Result<SocketAddr, AdapterError>> {
    let rest = name.strip_prefix(BROWSER)?;
    if rest.is_empty() {
        return Some(Ok(SocketAddr::from((Ipv4Addr::LOCALHOST, 0))));
    }
    let parsed = rest.strip_prefix('@')?.parse();
    Some(parsed.map_err(|_| AdapterError::Address(name.into())))
}

/// The browser that opens a page, as a subject.
fn visitor(
    name: &str,
    address: SocketAddr,
    visited: &mut dyn FnMut(&Server) -> Option<Arc<Session>>,
) -> Result<Subject, AdapterError> {
    let server = Server::start(address)?;
    let session = visited(&server).ok_or(AdapterError::NoBrowser)?;
    Ok(browser::of_served(name.into(), ServedBrowser::opened(session, server)))
}

/// The names of all adapters. No device is opened.
///
/// # Errors
/// Where there is no driver.
pub fn names() -> Result<Vec<String>, AdapterError> {
    let found = lightmeter_gpu::adapters();
    drivers_named(&found)?;
    if found.is_empty() {
        return Err(AdapterError::no_driver());
    }
    Ok(found.into_iter().map(|adapter| adapter.name).collect())
}

/// The adapter that is judged where none is asked for. Where the user names drivers, no other one takes their place.
fn first() -> Result<Adapter, AdapterError> {
    if let Some(adapter) = native_adapters().into_iter().next() {
        return Ok(adapter);
    }
    drivers_named(&[])?;
    lightmeter_gpu::adapters().into_iter().next().ok_or_else(AdapterError::no_driver)
}

/// Whether the Vulkan drivers that the user names, if any, are among the adapters found.
fn drivers_named(found: &[Adapter]) -> Result<(), AdapterError> {
    if found.iter().any(|adapter| adapter.backend == "vulkan") {
        return Ok(());
    }
    for variable in DRIVER_VARIABLES {
        if let Some(value) = std::env::var_os(variable).filter(|value| !value.is_empty()) {
            let value = value.to_string_lossy().into_owned();
            return Err(AdapterError::NoDriver(format!("{variable} names no Vulkan driver that is here: `{value}`")));
        }
    }
    Ok(())
}

fn named<'a>(found: &'a [Adapter], name: &str) -> Result<&'a Adapter, AdapterError> {
    if found.is_empty() {
        let message = format!("adapter `{name}` is not here: no Vulkan or OpenGL driver is");
        return Err(AdapterError::NoDriver(message));
    }
    if let Some(adapter) = found.iter().find(|adapter| adapter.name == name) {
        return Ok(adapter);
    }
    drivers_named(found)?;
    let there: Vec<&str> = found.iter().map(|adapter| adapter.name.as_str()).collect();
    let meant = did_you_mean(name, there.iter().copied());
    Err(AdapterError::Unknown { name: name.into(), meant, there: there.join(", ") })
}
