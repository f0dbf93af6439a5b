//! Compilers that are asked where naga does not read: to SPIR-V, without a shell, with limits of time and memory.

use rustix::process::{Pid, Resource, Rlimit, prlimit};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// How long a compiler may take.
const MOST_TIME: Duration = Duration::from_secs(10);
/// Bytes of memory that it may have.
const MOST_MEMORY: u64 = 2 << 30;
/// Bytes of what it says that are kept.
const MOST_WORDS: usize = 64 << 10;

/// A compiler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compiler {
    Glslang,
    Dxc,
    Slang,
}

/// Those that read HLSL, in the order in which they are asked.
pub(super) const OF_HLSL: [Compiler; 3] = [Compiler::Glslang, Compiler::Dxc, Compiler::Slang];

impl Compiler {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Glslang => "glslangValidator",
            Self::Dxc => "dxc",
            Self::Slang => "slangc",
        }
    }

    /// Whether it is installed.
    pub(super) fn is_there(self) -> bool {
        let folders = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&folders).any(|folder| folder.join(self.name()).is_file())
    }
}

/// What a compiler is given.
pub(super) struct Source<'a> {
    pub(super) text: &'a str,
    /// `frag` or `vert`.
    pub(super) stage: &'a str,
    /// The entry point, of HLSL.
    pub(super) entry: Option<&'a str>,
}

/// SPIR-V with the lines of the text.
///
/// # Errors
/// What the compiler said.
pub(super) fn compiled(compiler: Compiler, source: &Source<'_>) -> Result<Vec<u8>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let input = folder.path().join(format!("shader.{}", source.stage));
    let output = folder.path().join("shader.spv");
    std::fs::write(&input, source.text).map_err(|error| error.to_string())?;
    let mut command = Command::new(compiler.name());
    command.args(arguments(compiler, source)).args(paths(compiler, &input, &output));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().map_err(|error| format!("{} does not start: {error}", compiler.name()))?;
    let said = ended(child, compiler)?;
    std::fs::read(&output).map_err(|_| said)
}

fn arguments(compiler: Compiler, source: &Source<'_>) -> Vec<String> {
    let own = |all: &[&str]| all.iter().map(|own| (*own).to_owned()).collect::<Vec<_>>();
    let entry = source.entry.unwrap_or("main");
    let (dxc, slang) = if source.stage == "vert" { ("vs_6_0", "vertex") } else { ("ps_6_0", "fragment") };
    match compiler {
        Compiler::Glslang => {
            let mut all = own(&[
                "-V",
                "-g",
                "-S",
                source.stage,
                "--auto-map-locations",
                "--auto-map-bindings",
                "--keep-uncalled",
            ]);
            if source.entry.is_some() {
                // Optimised, it has fewer functions and names than its text.
                all.extend(own(&["-D", "-Od", "-e", entry]));
            }
            all
        }
        Compiler::Dxc => own(&["-spirv", "-fspv-debug=line", "-T", dxc, "-E", entry]),
        Compiler::Slang => own(&["-target", "spirv", "-g", "-stage", slang, "-entry", entry]),
    }
}

fn paths(compiler: Compiler, input: &Path, output: &Path) -> Vec<PathBuf> {
    match compiler {
        Compiler::Dxc => vec!["-Fo".into(), output.into(), input.into()],
        Compiler::Glslang | Compiler::Slang => vec!["-o".into(), output.into(), input.into()],
    }
}

/// Waits for a compiler, and gives what it said.
fn ended(mut child: Child, compiler: Compiler) -> Result<String, String> {
    if let Some(pid) = i32::try_from(child.id()).ok().and_then(Pid::from_raw) {
        // Where the limit cannot be set, that of time is left.
        let _ = prlimit(Some(pid), Resource::As, Rlimit { current: Some(MOST_MEMORY), maximum: Some(MOST_MEMORY) });
    }
    let kept = |stream: Option<Box<dyn std::io::Read + Send>>| {
        std::thread::spawn(move || {
            let mut bytes = vec![];
            if let Some(stream) = stream {
                let _ = std::io::Read::read_to_end(&mut std::io::Read::take(stream, MOST_WORDS as u64), &mut bytes);
            }
            String::from_utf8_lossy(&bytes).into_owned()
        })
    };
    let said = kept(child.stdout.take().map(|own| Box::new(own) as _));
    let failed = kept(child.stderr.take().map(|own| Box::new(own) as _));
    let start = Instant::now();
    while matches!(child.try_wait(), Ok(None)) {
        if start.elapsed() > MOST_TIME {
            let _ = child.kill();
            let _ = child.wait();
            return Err(format!("{} took more than {} s", compiler.name(), MOST_TIME.as_secs()));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let words = [said.join().unwrap_or_default(), failed.join().unwrap_or_default()];
    Ok(words.concat())
}
