//! A renderer in a process of its own, which speaks JSON lines on its standard input and output.
//!
//! The command line starts it by a process of its own that ends all that descends from it (`lightmeter start-renderer`). Besides, it is in a
//! process group of its own and has a mark in its environment, by which it is ended with its children where that process is not there. What it was asked and has not answered is
//! known at every moment: where it ends, hangs or floods, it is killed and started again, and asked what is open one case at a
//! time until the one that it fails at is found; that case fails, and the rest goes on.

mod clock;
mod columns;
mod family;
mod framing;
mod queue;
mod running;
mod session;

use super::error::ProcessError;
use super::expectations::Expectations;
use super::given::{Asks, Declared, Given, pixel, put, word};
use super::hello::Hello;
use super::{frame, pack, picture};
use lightmeter_catalogue::special::Probe;
use lightmeter_document::Document as _;
use lightmeter_document::by_case::{RendererUse, SourcePlace};
use lightmeter_document::event::Stop;
use lightmeter_document::protocol::SceneRequest;
use lightmeter_document::report::Identity;
use lightmeter_engine::device::DeviceError;
use lightmeter_engine::renderer::{AskedPixels, AskedRenderer, AskedScene};
use lightmeter_engine::rows::Rows;
use lightmeter_judge::blend_unit::pixel::Units;
use lightmeter_judge::cases::{Answers, Unanswered};
use lightmeter_judge::image::file::StoredImage;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;
use session::{Question, Session};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, SystemTime};

/// How long things may take.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// From the start to the hello.
    pub start: Duration,
    /// A case of a formula.
    pub case: Duration,
    /// A scene.
    pub scene: Duration,
    /// All together; `None` for as long as it takes.
    pub total: Option<Duration>,
}

impl Default for Limits {
    fn default() -> Self {
        let seconds = Duration::from_secs;
        Self { start: seconds(60), case: seconds(10), scene: seconds(60), total: None }
    }
}

/// How a renderer is asked.
#[derive(Clone, Debug)]
pub struct Asking {
    /// What starts it, by `sh -c`.
    pub command: String,
    /// What it is started by, so that nothing of it outlives this process; `None` for a shell alone.
    pub starter: Option<Starter>,
    /// Where it writes images.
    pub folder: PathBuf,
    /// How long things may take.
    pub limits: Limits,
    /// How often all is asked. Of one run, what failed is asked once more.
    pub runs: u64,
    /// Whether to stop, which a signal says.
    pub stop: Stop,
    /// For tests: no time passes for `limits` but what the renderer's output says has passed.
    pub is_time_told: bool,
}

/// The program that a renderer is started by: `lightmeter start-renderer`.
#[derive(Clone, Debug)]
pub struct Starter {
    /// The binary.
    pub program: PathBuf,
    /// MiB of address space that each process of the renderer may have; `None` for as much as there is.
    pub memory: Option<u64>,
}

impl Starter {
    /// What starts a command.
    fn arguments(&self, command: &str) -> Vec<String> {
        let memory = self.memory.map(|memory| vec!["--memory".to_owned(), memory.to_string()]).unwrap_or_default();
        let own = ["start-renderer".to_owned(), "--parent".to_owned(), std::process::id().to_string()];
        [&own[..], &memory, &["--".to_owned(), command.to_owned()]].concat()
    }
}

/// A renderer in a process of its own.
pub struct ProcessRenderer {
    declared: Declared,
    runs: u64,
    folder: PathBuf,
    session: Mutex<Session>,
}

impl ProcessRenderer {
    /// Starts it and hears its hello.
    ///
    /// # Errors
    /// Where it cannot be started, or says nothing of itself that can be read.
    pub fn start(asking: Asking) -> Result<Self, ProcessError> {
        let (runs, folder) = (asking.runs, asking.folder.clone());
        let mut session = Session::new(asking);
        session.start()?;
        let declared = Declared::new(session.hello().clone())?;
        session.skips = declared.skips.clone();
        Ok(Self { declared, runs, folder, session: Mutex::new(session) })
    }

    /// What it said of itself.
    #[must_use]
    pub const fn hello(&self) -> &Hello {
        &self.declared.hello
    }

    /// How it is named in reports.
    #[must_use]
    pub fn identity(&self) -> Identity {
        self.declared.identity()
    }

    /// Some of its cases are known to fail, to end it, or to be skipped.
    pub fn expect(&mut self, expectations: &Expectations) {
        let Hello { renderer, version, .. } = self.declared.hello.clone();
        let session = self.session();
        session.expected = expectations.of(&renderer, &version);
        session.skips.extend(expectations.skips_of(&renderer, &version));
    }

    fn session(&mut self) -> &mut Session {
        // No other thread has it: it is reached through a unique reference alone.
        self.session.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

/// An error that is the suite's own.
fn refused(error: ProcessError) -> DeviceError {
    DeviceError::Refused(Box::new(error))
}

/// Writes what a renderer draws a scene by; the file, and when that was.
fn write_scene(folder: &Path, scene: AskedScene<'_>) -> Result<(PathBuf, SystemTime), ProcessError> {
    let path = folder.join(format!("{}.json", scene.id.replace('/', "-")));
    let failed = |error: std::io::Error| ProcessError::Folder { path: path.clone(), message: error.to_string() };
    let text = frame::document(scene.id, scene.title, scene.frame).to_json().map_err(|error| failed(error.into()))?;
    std::fs::write(&path, text).map_err(failed)?;
    // By the same clock that an image gets its time from.
    let asked = path.metadata().and_then(|metadata| metadata.modified()).map_err(failed)?;
    Ok((path, asked))
}

impl AskedRenderer for ProcessRenderer {
    fn lacks(&self, id: &str) -> Option<String> {
        self.declared.lacks(id)
    }

    fn lacks_frame(&self, frame: &Frame) -> Option<String> {
        self.declared.lacks_frame(frame)
    }

    fn source(&self, id: &str) -> Option<SourcePlace> {
        self.declared.source(id)
    }

    fn values(&mut self, rows: &Rows<'_>, advanced: &mut dyn FnMut(u64)) -> Result<Answers, DeviceError> {
        let mut answers = Answers { words: vec![0; rows.of.len() * rows.outputs], ..Answers::default() };
        let in_columns = self.declared.hello.columns && rows.members.len() == 1;
        let left = if in_columns {
            self.session().columns(rows, &mut answers, advanced)
        } else {
            (0..rows.of.len()).collect()
        };
        let stride = rows.stride();
        let question = |&place: &usize| {
            let member = rows.members[rows.of[place]];
            let id = member.case_id(rows.cases[place]);
            let inputs = &rows.inputs[place * stride..(place + 1) * stride];
            let request = pack::case(&member.spec, &id, inputs).to_string();
            Question { request, id, asks: Asks::Outputs(&member.spec) }
        };
        let given = self.session().all(&left.iter().map(question).collect::<Vec<_>>(), advanced);
        left.into_iter().zip(given).for_each(|(place, given)| put(&mut answers, rows.outputs, place, given));
        Ok(answers)
    }

    fn targets(&self) -> Vec<TargetFormat> {
        self.declared.targets.clone()
    }

    fn pixels(&mut self, asked: &AskedPixels<'_>) -> Result<Vec<Result<Units, Unanswered>>, DeviceError> {
        let spec = &asked.member.spec;
        let questions = asked.rows().map(|(case, inputs)| {
            let id = asked.id(case);
            let request = pack::on_target(spec, &id, inputs, asked.target, asked.program).to_string();
            Question { id, request, asks: Asks::Pixel(spec) }
        });
        let given = self.session().all(&questions.collect::<Vec<_>>(), &mut |_| {});
        Ok(given.into_iter().map(pixel).collect())
    }

    fn asks_special(&self) -> bool {
        self.declared.hello.special
    }

    fn probes(&mut self, probes: &[&'static Probe]) -> Result<Vec<Result<u32, Unanswered>>, DeviceError> {
        let question = |probe: &&'static Probe| Question {
            id: probe.id(),
            request: pack::probe(probe).to_string(),
            asks: Asks::Word(probe),
        };
        let given = self.session().all(&probes.iter().map(question).collect::<Vec<_>>(), &mut |_| {});
        Ok(given.into_iter().map(word).collect())
    }

    fn image(&mut self, scene: AskedScene<'_>) -> Result<Result<StoredImage, Unanswered>, DeviceError> {
        let (path, asked) = write_scene(&self.folder, scene).map_err(refused)?;
        let AskedScene { id, frame, .. } = scene;
        let (width, height) = (frame.target.width, frame.target.height);
        let format = frame.target.format;
        let request =
            SceneRequest { id: id.to_owned(), scene: path.to_string_lossy().into_owned(), width, height, format };
        let question = Question { id: id.to_owned(), request: request.to_string(), asks: Asks::Image };
        let given = self.session().all(&[question], &mut |_| {});
        Ok(match given.into_iter().next() {
            Some(Given::Image(file)) => {
                picture::read(&self.folder, &file, frame, Some(asked)).map_err(Unanswered::Unjudged)
            }
            Some(Given::Nothing(why)) => Err(why),
            Some(Given::Values(_) | Given::Word(_)) | None => {
                unreachable!("each question has an answer of its kind, or the reason why it has none")
            }
        })
    }

    fn begin_again(&mut self) -> Result<(), DeviceError> {
        self.session().begin_again();
        Ok(())
    }

    fn asks_failing_again(&self) -> bool {
        self.runs == 1
    }

    fn is_over(&self) -> bool {
        self.session.lock().unwrap_or_else(std::sync::PoisonError::into_inner).is_over()
    }

    fn used(&mut self) -> RendererUse {
        self.session().end_well()
    }
}
