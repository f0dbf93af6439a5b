//! The command line: what can be asked for, and the exit codes.

mod adapt;
mod adapters;
mod bench;
mod book;
mod check;
mod clock;
mod comparison;
pub(crate) mod config;
mod contact_sheet;
mod effects;
pub(crate) mod environment;
mod eval;
mod foreign;
mod gate;
mod identify;
mod list;
mod manual;
mod merge;
mod mistakes;
mod observed;
mod options;
mod pack;
mod page;
mod playground;
mod progress;
mod render;
mod result;
mod run;
mod schema;
mod selftest;
mod serve;
mod shader;
mod show;
mod signals;
mod special;
#[cfg(unix)]
mod start;
mod sweep;
mod terminal;
mod values;
mod visit;

use clap::{CommandFactory as _, Parser, Subcommand};
use lightmeter::adapters::AdapterError;
use lightmeter::device::DeviceError;
use lightmeter::files::{can_be_written, lines, whole};
use lightmeter::subject::Subject;
use signal_hook::consts::SIGTERM;
use signals::SIGHUP;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// Tells whether a renderer computes classical lighting, fog and blending right, and how close it comes.
#[derive(Debug, Parser)]
#[command(
    name = "lightmeter",
    version,
    max_term_width = 100,
    after_help = exit_help()
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    shown: terminal::Shown,
    /// Leave out what a `lightmeter.toml` in this folder, or above it, says
    #[arg(long, global = true)]
    no_config: bool,
}

/// The exit codes, and what each means.
const EXIT_CODES: &[(&str, &str)] = &[
    ("0", "all as expected"),
    ("1", "something failed or passed unexpectedly"),
    ("2", "bad usage or input"),
    ("3", "nothing could run"),
    ("4", "the device failed or was lost, or the renderer under test crashed, hung or broke the protocol"),
    ("130", "interrupted by SIGINT, 143 by SIGTERM: what was judged is reported"),
];

fn exit_help() -> String {
    let lines = EXIT_CODES.iter().map(|(code, means)| format!("  {code:<4} {means}"));
    format!("Exit codes:\n{}", lines.collect::<Vec<_>>().join("\n"))
}

/// The commands by what they are for.
const PURPOSES: &[(&str, &[&str])] = &[
    ("Judge", &["check", "run", "serve", "identify", "gate", "pack", "sweep", "special"]),
    ("Look up", &["list", "show", "mistakes", "effects", "eval", "render"]),
    ("Measure", &["bench", "adapters", "selftest"]),
    ("Results", &["merge", "page", "book", "schema", "completions", "man", "help"]),
];

impl Cli {
    /// The command line as clap has it, its commands told by what they are for.
    pub(crate) fn told() -> clap::Command {
        let command = Self::command();
        let about = |name: &str| {
            let found = command.get_subcommands().find(|one| one.get_name() == name);
            let words = found.and_then(|one| one.get_about().map(ToString::to_string));
            words.unwrap_or_else(|| "Print this, or what there is to say of a command".into())
        };
        let mut commands = String::new();
        for (purpose, names) in PURPOSES {
            commands += &format!("{purpose}:\n");
            for name in *names {
                commands += &format!("  {name:<12} {}\n", about(name));
            }
            commands.push('\n');
        }
        let template =
            format!("{{about}}\n\n{{usage-heading}} {{usage}}\n\n{commands}Options:\n{{options}}{{after-help}}");
        command.help_template(template)
    }
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Find the steps of shaders, and what is wrong with them
    Check(check::Check),
    /// Judge an adapter, or shaders of your own on it
    Run(run::Run),
    /// Judge the GPU of a browser
    Serve(serve::Serve),
    /// List the cases as a tree, or the formulas
    List(list::List),
    /// Show a case step by step, or what is known of a name
    Show(show::Show),
    /// Measure what accuracy costs in time
    Bench(bench::Bench),
    /// List what can be run on
    Adapters(adapters::Adapters),
    /// Judge a formula over every float of a range
    Sweep(sweep::Sweep),
    /// Join the results of shards
    Merge(merge::Merge),
    /// Show that the suite catches the mistakes that it knows
    Selftest(selftest::Selftest),
    /// List the mistakes that the diagnosis names
    Mistakes(mistakes::Mistakes),
    /// Judge NaN, infinity, subnormals and signed zero
    Special(special::Special),
    /// Draw a scene, by the reference or by an adapter
    Render(render::Render),
    /// Write cases as files, for a renderer that answers by files
    Pack(pack::Pack),
    /// Judge another renderer, by its files or as a process
    Gate(gate::Gate),
    /// Write a page of the docs from a run's JSON
    Page(page::Page),
    /// Write the book, with a page for each formula
    Book(book::Book),
    /// Tell what a scene calls for, and why
    Effects(effects::Effects),
    /// Print the JSON Schema of a file
    Schema(schema::Schema),
    /// Evaluate formulas: JSON lines in and out
    Eval(eval::Eval),
    /// Print what completes this command's words in a shell
    Completions(manual::Completions),
    /// Write the manual as man pages, one a command
    Man(manual::Man),
    /// Tell which formula a shader computes
    Identify(identify::Identify),
    #[command(hide = true)]
    #[cfg(unix)]
    StartRenderer(start::Start),
    #[command(hide = true)]
    TryShaders(foreign::Try),
    #[command(hide = true)]
    AdaptShader(adapt::Adapt),
    #[command(hide = true)]
    ReviewShaders(check::Worker),
}

impl Cli {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        terminal::settle(self.shown);
        match self.command {
            Command::Check(check) => check.run(),
            Command::ReviewShaders(worker) => worker.run(),
            Command::Run(run) => run.run(),
            Command::Serve(serve) => serve.run(),
            Command::List(list) => list.run(),
            Command::Show(show) => show.run(),
            Command::Bench(bench) => bench.run(),
            Command::Adapters(adapters) => adapters.run(),
            Command::Sweep(sweep) => sweep.run(),
            Command::Merge(merge) => merge.run(),
            Command::Selftest(selftest) => selftest.run(),
            Command::Mistakes(mistakes) => mistakes.run(),
            Command::Special(special) => special.run(),
            Command::Render(render) => render.run(),
            Command::Pack(pack) => pack.run(),
            Command::Gate(gate) => gate.run(),
            Command::Page(page) => page.run(),
            Command::Book(book) => book.run(),
            Command::Effects(effects) => effects.run(),
            Command::Schema(schema) => schema.run(),
            Command::Eval(eval) => eval.run(),
            Command::Completions(completions) => completions.run(),
            Command::Man(man) => man.run(),
            Command::Identify(identify) => identify.run(),
            #[cfg(unix)]
            Command::StartRenderer(start) => start.run(),
            Command::TryShaders(shaders) => shaders.run(),
            Command::AdaptShader(shader) => shader.run(),
        }
    }
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    /// All as expected.
    Success = 0,
    /// Something failed, or passed unexpectedly.
    Failed = 1,
    /// Bad usage or input.
    BadInput = 2,
    /// Nothing could run.
    Nothing = 3,
    /// The device failed or was lost, or the renderer under test crashed, hung or broke the protocol.
    Device = 4,
    /// SIGHUP ended it before its time.
    HungUp = 129,
    /// SIGINT did.
    Interrupted = 130,
    /// SIGTERM did.
    Terminated = 143,
}

/// Whether devices were left at work.
static IS_ABANDONED: AtomicBool = AtomicBool::new(false);

/// Leaves devices at whatever they are at work on: to close one that hangs or compiles could take minutes. A browser is closed, since it would go on by
/// itself.
pub(crate) fn abandon(subjects: Vec<Subject>) {
    for subject in subjects {
        if subject.identity.backend == "webgpu" {
            drop(subject);
        } else {
            IS_ABANDONED.store(true, Ordering::Relaxed);
            std::mem::forget(subject);
        }
    }
}

/// The end of the process. Where devices were left at work it takes nothing down, since drivers crash whose compilers are taken from under their threads.
pub(crate) fn end(status: Status) -> ExitCode {
    if IS_ABANDONED.load(Ordering::Relaxed) {
        // Whoever does not read any more reads the exit code.
        let _ = std::io::stdout().flush();
        signal_hook::low_level::exit(i32::from(status as u8));
    }
    status.into()
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(status as u8)
    }
}

/// Nothing could run: no adapter, or no case.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct NothingToRun(pub(crate) String);

impl Status {
    /// The status of what a signal ended, as shells have it.
    pub(crate) const fn of_signal(signal: i32) -> Self {
        match signal {
            SIGHUP => Self::HungUp,
            SIGTERM => Self::Terminated,
            _ => Self::Interrupted,
        }
    }

    /// The status that an error ends with.
    pub(crate) fn of(error: &anyhow::Error) -> Self {
        if error.downcast_ref::<NothingToRun>().is_some() {
            return Self::Nothing;
        }
        if let Some(lightmeter::gate::error::ProcessError::Start { .. }) = error.downcast_ref() {
            return Self::Device;
        }
        let device = match error.downcast_ref::<AdapterError>() {
            Some(AdapterError::NoDriver(_) | AdapterError::Chromium(_)) => return Self::Nothing,
            Some(AdapterError::Device(error)) => Some(error),
            Some(_) => return Self::BadInput,
            None => error.downcast_ref::<DeviceError>(),
        };
        match device {
            Some(error) if error.is_of_device() => Self::Device,
            Some(DeviceError::NoDevice(_)) => Self::Nothing,
            _ => Self::BadInput,
        }
    }
}

/// The command, but for where its result goes.
pub(crate) fn command() -> String {
    let mut words = vec!["lightmeter".to_owned()];
    // A path need not be UTF-8.
    let mut given = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    while let Some(word) = given.next() {
        if word == "--out" {
            given.next();
        } else if !word.starts_with("--out=") {
            words.push(quoted(&word));
        }
    }
    words.join(" ")
}

/// A word as a shell reads it.
pub(crate) fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:@".contains(c);
    if word.chars().all(is_plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

/// Whether a file that is to be written at the end can be, told before the work. What it holds stays until then.
pub(crate) fn writable(file: Option<&Path>) -> anyhow::Result<()> {
    let Some(path) = file else { return Ok(()) };
    can_be_written(path).map_err(|error| unwritten(path, &error))
}

fn unwritten(path: &Path, error: &std::io::Error) -> anyhow::Error {
    anyhow::anyhow!("cannot write {}: {error}", path.display())
}

/// Prints a message on standard error. That it cannot be printed changes nothing: the exit code still says how the command ended.
pub(crate) fn say(text: &str) {
    let _ = terminal::write(&(lines(text).into_owned() + "\n"), &mut std::io::stderr().lock());
}

/// Shows text for people: in a file as it is, on a terminal wrapped to its width and in colours.
pub(crate) fn show(text: &str, file: Option<&Path>) -> anyhow::Result<()> {
    match file {
        Some(_) => emit(text, file),
        None => emit(&terminal::dressed(text, &std::io::stdout()), None),
    }
}

/// Writes to the file, or to standard output. Whoever does not read that any more has read enough: how the command ends still tells what it
/// found.
pub(crate) fn emit(text: &str, file: Option<&Path>) -> anyhow::Result<()> {
    match file {
        Some(path) => whole(path, text.as_bytes()).map_err(|error| unwritten(path, &error)),
        None => match std::io::stdout().lock().write_all(text.as_bytes()) {
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
            written => Ok(written?),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter::subject_gpu::device_error;
    use lightmeter_gpu::GpuError;

    #[test]
    fn every_command_is_told_under_a_purpose() {
        let told: Vec<&str> = PURPOSES.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        let command = Cli::command();
        let all: Vec<&str> =
            command.get_subcommands().filter(|one| !one.is_hide_set()).map(clap::Command::get_name).collect();
        for name in &all {
            assert!(told.contains(name), "`{name}` is under no purpose");
        }
        assert_eq!(told.len(), all.len() + 1, "`help` besides: {told:?}");
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../x");
        let script = std::fs::read_to_string(script).expect("the entry script is there");
        let cases: Vec<&str> = script.lines().filter(|line| line.starts_with("    ") && line.ends_with(')')).collect();
        for name in &all {
            let is_case = |line: &&str| line.trim_matches([' ', ')']).split(" | ").any(|one| one == *name);
            assert!(cases.iter().any(is_case), "`./x {name}` is unknown");
        }
        Cli::told().debug_assert();
    }

    #[test]
    fn what_went_wrong_decides_how_a_command_ends() {
        let open = GpuError::Open { adapter: "lavapipe".into(), message: "no".into() };
        let shader = GpuError::Shader { file: "fog.wgsl".into(), message: "no".into() };
        for (error, expected) in [
            (GpuError::Device("lost".into()), Status::Device),
            (GpuError::Timeout(60), Status::Device),
            (open, Status::Nothing),
            (shader, Status::BadInput),
        ] {
            let message = error.to_string();
            let error = anyhow::Error::from(device_error(error));
            assert_eq!(Status::of(&error), expected, "{message}");
            assert_eq!(error.to_string(), message);
        }
    }
}
