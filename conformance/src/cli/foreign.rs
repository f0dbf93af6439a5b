//! Shaders of others: read and compiled in a process of their own, before they reach this one.
//!
//! A shader can overflow the stack of what parses it, take any memory, or keep a driver's compiler busy for hours. A thread survives none of
//! that. So `--shaders` first has the own binary try them (`lightmeter try-shaders`); what becomes of that process is the message.

use super::Status;
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::files::lines;
use lightmeter_gpu::{ArithmeticPipeline, Kernel, Programmable, Shaders, adapters, vulkan_adapters};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// How long shaders may take to be read and compiled.
const MOST_TIME: Duration = Duration::from_secs(60);
/// Bytes of memory that this may take.
const MOST_MEMORY: u64 = 4 << 30;
/// How often it is looked how much it takes.
const LOOKS: Duration = Duration::from_millis(5);
/// Bytes of a page of memory.
const PAGE: u64 = 4096;

/// Read and compile the shaders of a folder
#[derive(Debug, Args)]
pub(crate) struct Try {
    /// The folder
    folder: PathBuf,
    /// The adapter to compile them on, as `run` names it
    #[arg(long, value_name = "NAME")]
    adapter: Vec<String>,
}

impl Try {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let (shaders, built_in) = (Shaders::from_dir(&self.folder)?, Shaders::built_in()?);
        let is_asked = |name: &str| self.adapter.iter().any(|asked| asked == name || asked == "all");
        // The parent command reports an adapter name that does not exist.
        let found = match self.adapter.is_empty() {
            true => vulkan_adapters().into_iter().take(1).collect(),
            false => adapters().into_iter().filter(|adapter| is_asked(&adapter.name)).collect::<Vec<_>>(),
        };
        for adapter in found {
            let gpu = adapter.open()?;
            for (file, text) in shaders.texts() {
                let before = built_in.texts().find(|(name, _)| *name == file).map_or("", |(_, text)| text);
                for function in changed(before, text) {
                    // What takes other than numbers is part of something that does not, or of a scene.
                    let Ok(kernel) = Kernel::new(&shaders, file, function) else { continue };
                    // An adapter may lack what the stage takes: the command that was asked for says so.
                    let _ = ArithmeticPipeline::new(&gpu, &kernel, Programmable::Compute)?;
                }
            }
        }
        Ok(Status::Success)
    }
}

/// The functions of a file that are not as they were; all of them where what stands above them has changed.
fn changed<'a>(before: &str, text: &'a str) -> Vec<&'a str> {
    let (head_before, before) = functions(before);
    let (head, functions) = functions(text);
    let is_same = |function: &&(&str, &str)| head == head_before && before.contains(function);
    functions.iter().filter(|function| !is_same(function)).map(|(name, _)| *name).collect()
}

/// What stands above the functions of a file, and each function's name with its text, up to the next one. A comment may name what is no
/// function.
fn functions(text: &str) -> (&str, Vec<(&str, &str)>) {
    let is_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let starts: Vec<usize> = text
        .match_indices("fn")
        .map(|(place, _)| place)
        .filter(|&place| !text[..place].ends_with(is_of_name) && text[place + 2..].starts_with(char::is_whitespace))
        .collect();
    let ends = starts.iter().skip(1).copied().chain([text.len()]);
    let functions = starts.iter().zip(ends).map(|(&start, end)| {
        let name = text[start + 2..end].trim_start();
        (name.split(|c| !is_of_name(c)).next().unwrap_or_default(), &text[start..end])
    });
    (&text[..starts.first().copied().unwrap_or(text.len())], functions.collect())
}

/// Has a process of its own try the shaders of a folder.
pub(crate) fn accept(folder: &Path, adapters: &[String]) -> anyhow::Result<()> {
    if !adapters.is_empty() && adapters.iter().all(|name| name == "cpu") {
        bail!("the embedded implementation has no shaders: leave out `--shaders` or `--adapter cpu`");
    }
    let program = std::env::current_exe().context("cannot find the own binary")?;
    let named = adapters.iter().filter(|name| *name != "cpu");
    let mut child = Command::new(program)
        .arg("try-shaders")
        .arg(folder)
        .args(named.flat_map(|name| ["--adapter", name]))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .context("cannot start a process to try the shaders in")?;
    let mut complaint = child.stderr.take().context("it has no standard error")?;
    let listening = std::thread::spawn(move || {
        let mut said = vec![];
        let _ = complaint.by_ref().take(1 << 20).read_to_end(&mut said);
        let _ = std::io::copy(&mut complaint, &mut std::io::sink());
        String::from_utf8_lossy(&said).into_owned()
    });
    let broken = watched(&mut child)?;
    let status = child.wait()?;
    let said = listening.join().unwrap_or_default();
    let said = lines(said.trim()).into_owned();
    if let Some(limit) = broken {
        bail!("the shaders of {} take more than {limit} to be read and compiled", folder.display());
    }
    match status.code() {
        Some(0) => Ok(()),
        Some(_) => bail!("{}", said.trim_start_matches("error: ")),
        None => {
            let last: Vec<&str> = said.lines().filter(|line| !line.trim().is_empty()).collect();
            let last = last[last.len().saturating_sub(3)..].join(" / ");
            bail!(
                "the shaders of {} end the process that reads and compiles them: {status}; it said: {last}",
                folder.display()
            )
        }
    }
}

/// Waits for a process, and kills it beyond a limit; which one that is.
fn watched(child: &mut Child) -> anyhow::Result<Option<String>> {
    let until = Instant::now() + MOST_TIME;
    loop {
        if child.try_wait()?.is_some() {
            return Ok(None);
        }
        let broken = if Instant::now() > until {
            Some(format!("{} s", MOST_TIME.as_secs()))
        } else if memory(child.id()).is_some_and(|bytes| bytes > MOST_MEMORY) {
            Some(format!("{} GiB", MOST_MEMORY >> 30))
        } else {
            None
        };
        if broken.is_some() {
            child.kill()?;
            return Ok(broken);
        }
        std::thread::sleep(LOOKS);
    }
}

/// The bytes of memory that a process takes; `None` where there is no /proc.
fn memory(pid: u32) -> Option<u64> {
    let text = std::fs::read_to_string(format!("/proc/{pid}/statm")).ok()?;
    text.split(' ').nth(1)?.parse::<u64>().ok().map(|pages| pages * PAGE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_that_differ_are_found() {
        let text =
            "const A = 1;\n\nfn one(x: f32) -> f32 {\n    return x;\n}\n\nfn two(x: f32) -> f32 {\n    return A;\n}\n";
        assert_eq!(changed(text, text), Vec::<&str>::new());
        assert_eq!(changed(text, &text.replace("return x", "return -x")), ["one"]);
        assert_eq!(changed(text, &text.replace("A = 1", "A = 2")), ["one", "two"]);
        assert_eq!(changed("", text), ["one", "two"]);
        let indented = text.replace("fn one", "  @must_use\tfn  one").replace("return x", "return -x");
        assert_eq!(changed(text, &indented), ["one", "two"]);
    }
}
