//! Shaders of others: read and compiled in a process of their own, before they reach this one.
//!
//! A shader can overflow the stack of what parses it, take any memory, or keep a driver's compiler busy for hours. A thread survives none of
//! that. So `--shaders` first has the own binary try them (`lightmeter try-shaders`); what becomes of that process is the message.

use super::Status;
use super::observed::is_time_told;
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::adapters as named;
use lightmeter::cases::Kind;
use lightmeter::files::{lines, shown};
use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::{builtin, scene_id};
use lightmeter::select::catalogue;
use lightmeter_gpu::compose::{Composer, Recipe, ShaderForm};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_gpu::{
    ArithmeticPipeline, BlendUnit, DepthUnit, Gpu, Kernel, Programmable, RasterPipeline, Shaders, adapters,
    native_adapters,
};
use lightmeter_scene::effects::effects;
#[cfg(unix)]
use rustix::process::{Resource, Rlimit, setrlimit};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::io::{Read, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How long shaders may take to be read and compiled.
const MOST_TIME: Duration = Duration::from_secs(60);
/// How long a shader may take for a few rows.
const MOST_RUN: Duration = Duration::from_secs(10);
/// Bytes of memory that this may take.
const MOST_MEMORY: u64 = 4 << 30;
/// How often it is looked how much it takes.
const LOOKS: Duration = Duration::from_millis(5);
/// Pixels of the longer side of a scene that is drawn to see whether it can be.
const FEW_PIXELS: u32 = 8;
/// Characters of a line of a message.
const MOST_CHARACTERS: usize = 240;
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
    /// Draw the built-in scenes whose shaders differ, too
    #[arg(long)]
    scenes: bool,
}

impl Try {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        limit_time();
        // If this process is killed, its parent reports the last of these lines as what was being compiled.
        let under_way = |what: &str| drop(writeln!(std::io::stdout(), "{what}"));
        let shaders = Shaders::from_dir_telling(&self.folder, &|file| under_way(&format!("{file} is read")))?;
        let built_in = Shaders::built_in()?;
        let is_asked = |name: &str| self.adapter.iter().any(|asked| asked == name || asked == "all");
        let found = match self.adapter.is_empty() {
            true => native_adapters().into_iter().take(1).collect(),
            false => adapters().into_iter().filter(|adapter| is_asked(&adapter.name)).collect::<Vec<_>>(),
        };
        for adapter in found {
            let gpu = adapter.open()?;
            functions_compile(&gpu, [&built_in, &shaders], &under_way)?;
            fixed_hardware_compiles(&gpu, [&built_in, &shaders], &under_way)?;
            if self.scenes {
                scenes_are_drawn(&gpu, [&built_in, &shaders], &under_way)?;
            }
        }
        Ok(Status::Success)
    }
}

/// Limits the processor's time of a process that reads shaders of others: if it loses the parent that watches it, it ends by itself.
pub(crate) fn limit_time() {
    #[cfg(unix)]
    {
        // Time of the processor is counted on all of its cores.
        let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get() as u64);
        let most = Some(2 * MOST_TIME.as_secs() * cores).filter(|_| !is_time_told());
        let _ = setrlimit(Resource::Cpu, Rlimit { current: most, maximum: most });
    }
}

/// Compiles each function that is not as it was.
fn functions_compile(gpu: &Gpu, [built_in, shaders]: [&Shaders; 2], under_way: &dyn Fn(&str)) -> anyhow::Result<()> {
    for (file, text) in shaders.texts() {
        let before = built_in.texts().find(|(name, _)| *name == file).map_or("", |(_, text)| text);
        // Of a single shader's functions the formula's own call what they need.
        for function in changed(before, text).into_iter().filter(|name| !name.starts_with("user")) {
            under_way(&format!("`{function}` of {file} is compiled"));
            // What takes other than numbers is part of something that does not, or of a scene.
            let Ok(kernel) = Kernel::new(shaders, file, function) else { continue };
            // An adapter may lack what the stage takes: the command that was asked for says so.
            let pipeline = ArithmeticPipeline::new(gpu, &kernel, Programmable::Compute)?;
            // Of a shader as somebody wrote it, it is seen whether it ends.
            if let Ok(pipeline) = pipeline
                && text.contains("fn user")
            {
                under_way(&format!("`{function}` of {file} runs"));
                let ends = ends_in_time();
                let rows: Vec<f32> = [0.0, 0.5, 1.0].iter().flat_map(|&x| vec![x; kernel.inputs]).collect();
                pipeline.submit(gpu, &rows).wait(gpu)?;
                drop(ends);
            }
        }
    }
    Ok(())
}

/// Ends this process where what is returned is not dropped in time: a device that does not come back cannot be asked to stop.
fn ends_in_time() -> Sender<()> {
    let (sender, receiver) = channel::<()>();
    if is_time_told() {
        return sender;
    }
    std::thread::spawn(move || {
        if receiver.recv_timeout(MOST_RUN) == Err(RecvTimeoutError::Timeout) {
            super::say(&format!(
                "error: the shader runs for more than {} s on three rows of inputs; has it a loop that does not end?",
                MOST_RUN.as_secs()
            ));
            std::process::exit(2);
        }
    });
    sender
}

/// Compiles what drives the rasteriser, the depth test and the blend unit, where it is not as it was.
fn fixed_hardware_compiles(
    gpu: &Gpu,
    [built_in, shaders]: [&Shaders; 2],
    under_way: &dyn Fn(&str),
) -> anyhow::Result<()> {
    if DepthUnit::source(built_in) != DepthUnit::source(shaders) {
        under_way("depth_unit.wgsl is compiled");
        DepthUnit::new(gpu, shaders)?;
    }
    if BlendUnit::source(built_in) != BlendUnit::source(shaders) {
        under_way("blend_unit.wgsl is compiled");
        BlendUnit::new(gpu, shaders)?;
    }
    if RasterPipeline::source(built_in) != RasterPipeline::source(shaders) {
        let mut kinds = BTreeSet::new();
        for member in catalogue() {
            if let Kind::Raster(kind) = member.spec.kind
                && kinds.insert(format!("{kind:?}"))
            {
                under_way("raster.wgsl is compiled");
                let _ = RasterPipeline::new(gpu, shaders, kind)?;
            }
        }
    }
    Ok(())
}

/// Draws the built-in scenes, of a few pixels each, whose shaders are not as they were.
fn scenes_are_drawn(gpu: &Gpu, [built_in, shaders]: [&Shaders; 2], under_way: &dyn Fn(&str)) -> anyhow::Result<()> {
    let composers = [Composer::new(built_in)?, Composer::new(shaders)?];
    let recipe = Recipe::of(ShaderForm::Composed);
    let mut drawn: BTreeSet<String> = BTreeSet::new();
    for place in 0..SCENES.len() {
        let loaded = builtin(place, Some(FEW_PIXELS))?;
        if SceneRenderer::lacks(gpu, &loaded.frame).is_some() {
            continue;
        }
        let sets = effects(&loaded.frame);
        let mut is_new = false;
        for called in &sets {
            let [before, now] = composers.each_ref().map(|composer| composer.compose(called.effects, recipe, 0));
            let now = now?.source;
            is_new |= before?.source != now && drawn.insert(now);
        }
        if is_new {
            under_way(&format!("{} is drawn", scene_id(place)));
            let renderer = SceneRenderer::new(gpu, shaders, &loaded.frame, &sets, recipe)?;
            SceneRenderer::pixels(gpu, renderer.submit(gpu))?;
        }
    }
    Ok(())
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

/// Has a process of its own try the shaders of a folder, those of scenes where they are to be drawn.
pub(crate) fn accept(folder: &Path, adapters: &[String], has_scenes: bool) -> anyhow::Result<()> {
    if !adapters.is_empty() && adapters.iter().all(|name| name == "cpu") {
        bail!("the embedded implementation has no shaders: leave out `--shaders` or `--adapter cpu`");
    }
    named::known(adapters)?;
    let named = adapters.iter().filter(|name| *name != "cpu");
    let mut given = vec![OsString::from("try-shaders"), folder.into()];
    given
        .extend(named.flat_map(|name| ["--adapter", name]).chain(has_scenes.then_some("--scenes")).map(OsString::from));
    watched_child(&given, folder).map(drop)
}

/// Has the own binary do something with shaders of others in a process that is watched, and gives what it wrote.
pub(crate) fn watched_child(given: &[OsString], of: &Path) -> anyhow::Result<String> {
    let program = std::env::current_exe().context("cannot find the own binary")?;
    let mut child = Command::new(program)
        .args(given)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .context("cannot start a process to try the shaders in")?;
    let complaint = heard(child.stderr.take().context("it has no standard error")?);
    let under_way = heard(child.stdout.take().context("it has no standard output")?);
    let broken = watched(&mut child)?;
    let status = child.wait()?;
    let [said, did] = [complaint, under_way].map(|thread| thread.join().unwrap_or_default());
    let doing = did.lines().next_back().map(|doing| format!(" while {}", shown(doing))).unwrap_or_default();
    let of = of.display();
    if let Some(limit) = broken {
        bail!("the shaders of {of} take more than {limit} to be read and compiled; it ended{doing}");
    }
    match status.code() {
        Some(0) => Ok(did),
        Some(_) => bail!("{}", clipped(&lines(said.trim().trim_start_matches("error: ")))),
        None => {
            let said = lines(said.trim()).into_owned();
            let last: Vec<&str> = said.lines().filter(|line| !line.trim().is_empty()).collect();
            let last = clipped(&last[last.len().saturating_sub(3)..].join(" / "));
            bail!("the shaders of {of} end the process that reads and compiles them{doing}: {status}; it said: {last}")
        }
    }
}

/// What a stream says, its beginning where that is much.
fn heard(mut stream: impl Read + Send + 'static) -> JoinHandle<String> {
    std::thread::spawn(move || {
        let mut said = vec![];
        let _ = stream.by_ref().take(1 << 20).read_to_end(&mut said);
        let _ = std::io::copy(&mut stream, &mut std::io::sink());
        String::from_utf8_lossy(&said).into_owned()
    })
}

/// Lines as long as people read them: a shader may be a single one.
fn clipped(text: &str) -> String {
    let cut = |line: &str| match line.char_indices().nth(MOST_CHARACTERS) {
        Some((end, _)) => format!("{} …", &line[..end]),
        None => line.to_owned(),
    };
    text.lines().map(cut).collect::<Vec<_>>().join("\n")
}

/// Waits for a process, and kills it beyond a limit; which one that is.
fn watched(child: &mut Child) -> anyhow::Result<Option<String>> {
    let until = (!is_time_told()).then(|| Instant::now() + MOST_TIME);
    loop {
        if child.try_wait()?.is_some() {
            return Ok(None);
        }
        let broken = if until.is_some_and(|until| Instant::now() > until) {
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
