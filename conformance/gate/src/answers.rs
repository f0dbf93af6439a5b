//! Answers as files: the first of each case, and that further files answer the same.

use super::answer::{self, Line, Unread};
use super::columns::Columns;
use super::error::ProcessError;
use super::expectations::Expectations;
use super::formula_skips::{FormulaSkip, FormulaSkips, SkippedTwice};
use super::given::{Asks, Declared, Given, given, word};
use super::hello::{self, Hello};
use super::pack::PackError;
use super::picture;
use super::plan::{CasePlace, GatePlan};
use super::problems::note;
use super::words::clipped;
use lightmeter_catalogue::cases::Spec;
use lightmeter_catalogue::select::CaseRef;
use lightmeter_catalogue::special::Probe;
use lightmeter_document::by_case::Problems;
use lightmeter_document::by_case::{RendererUse, SourcePlace};
use lightmeter_document::event::Stop;
use lightmeter_document::report::Identity;
use lightmeter_engine::device::DeviceError;
use lightmeter_engine::renderer::{AskedPixels, AskedRenderer, AskedScene};
use lightmeter_engine::rows::Rows;
use lightmeter_judge::blend_unit::pixel::Units;
use lightmeter_judge::cases::{Answers, Unanswered};
use lightmeter_judge::image::file::StoredImage;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The name of a folder's answers.
pub const ANSWERS: &str = "answers.jsonl";
/// What is expected in the place of a file that cannot be read.
const EXPECTED: &str = "expected a file of JSON lines, or a folder with answers.jsonl";
/// Components of a pixel.
const COMPONENTS: usize = 4;
/// Lines that are read at once.
const LINES: usize = 1 << 14;

/// A file of answers, or that of a folder.
pub struct AnswerFile {
    /// The file.
    pub path: PathBuf,
    stream: BufReader<File>,
    /// Where images lie.
    folder: PathBuf,
    /// Lines that were read.
    number: u64,
    /// The first line, where it is an answer.
    first: Vec<(u64, Vec<u8>)>,
    /// The number of its first line that is not blank.
    first_number: u64,
    /// Who answers, where the first line says so.
    pub hello: Option<Hello>,
}

impl AnswerFile {
    /// Opens it and reads who answers.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn open(answers: &Path) -> Result<Self, PackError> {
        let path = if answers.is_dir() { answers.join(ANSWERS) } else { answers.to_owned() };
        let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        let file = lightmeter_files::read::open(&path)
            .map_err(|error| PackError::Read { path: path.clone(), message: format!("{error}; {EXPECTED}") })?;
        let stream = BufReader::with_capacity(1 << 20, file);
        let mut opened = Self { path, stream, folder, number: 0, first: vec![], first_number: 1, hello: None };
        if let Some(Ok(line)) = opened.next()? {
            opened.first_number = opened.number;
            match answer::read(&line) {
                Ok(Line::Hello(hello)) => opened.hello = Some(*hello),
                Err(message) if hello::is_one(&line) => {
                    return Err(PackError::Manifest {
                        path: opened.path,
                        message: format!("line {}: the renderer {message}", opened.number),
                    });
                }
                _ => opened.first.push((opened.number, line)),
            }
        }
        Ok(opened)
    }

    /// The pack that it answers, where it says so.
    fn pack(&self) -> Option<&str> {
        self.hello.as_ref().and_then(|hello| hello.pack.as_deref())
    }

    /// The next line that is not blank, or that it is too long.
    fn next(&mut self) -> Result<Option<Result<Vec<u8>, Unread>>, PackError> {
        let mut line = vec![];
        loop {
            self.number += 1;
            return match answer::next(&mut self.stream, &mut line) {
                Ok(false) => Ok(None),
                Ok(true) if line.iter().all(u8::is_ascii_whitespace) => continue,
                Ok(true) => Ok(Some(Ok(line))),
                Err(error @ Unread::TooLong) => Ok(Some(Err(error))),
                Err(Unread::Io(error)) => Err(PackError::Read { path: self.path.clone(), message: error.to_string() }),
            };
        }
    }
}

/// What a file answers to the cases of a formula.
struct Column {
    words: Vec<u32>,
    is_answered: Vec<bool>,
    /// Cases without a value.
    others: HashMap<usize, Unanswered>,
}

/// What a file answers.
#[derive(Default)]
struct Contents {
    /// By the formula's place in the plan, once one of its cases is answered.
    formulas: HashMap<usize, Column>,
    /// By the blend state's place in the plan, and the target.
    states: HashMap<(usize, TargetFormat), Column>,
    /// By the special value's place in the plan.
    probes: HashMap<usize, Given>,
    scenes: HashMap<usize, Given>,
    /// What is answered by arrays.
    columns: Columns,
    /// Formulas, and rows of them, that are skipped.
    skips: FormulaSkips,
    /// Where images lie.
    folder: PathBuf,
}

/// A renderer whose answers lie in files. The answers of one file are in memory at a time: some 4 bytes for each output of a case.
pub struct FileRenderer {
    plan: Arc<GatePlan>,
    declared: Declared,
    files: VecDeque<AnswerFile>,
    /// Whether there is more than one, so that lines are told with their file.
    are_many: bool,
    contents: Contents,
    problems: Problems,
    /// The files that do not say which pack they answer.
    of_any_pack: Vec<PathBuf>,
    stop: Stop,
}

impl FileRenderer {
    /// Reads the first file of answers to a plan. Who answers is what it says.
    ///
    /// # Errors
    /// Where the file cannot be read.
    ///
    /// # Panics
    /// Where there is no file.
    pub fn read(
        plan: impl Into<Arc<GatePlan>>,
        files: Vec<AnswerFile>,
        expectations: &Expectations,
        stop: Stop,
    ) -> Result<Self, FilesError> {
        let plan = plan.into();
        // Answers that do not say what they are to are to all that the pack has.
        let targets = || plan.targets.iter().map(|target| target.name().to_owned()).collect();
        let everything = || Hello { targets: targets(), special: plan.choice.special, ..Hello::everything() };
        let hello = files[0].hello.clone().unwrap_or_else(everything);
        let are_many = files.len() > 1;
        let mut declared = Declared::new(hello)?;
        declared.skips.extend(expectations.skips_of(&declared.hello.renderer, &declared.hello.version));
        let mut renderer = Self {
            plan,
            declared,
            files: files.into(),
            are_many,
            contents: Contents::default(),
            problems: Problems::default(),
            of_any_pack: vec![],
            stop,
        };
        renderer.read_next()?;
        Ok(renderer)
    }

    /// What the first file says of who answers.
    #[must_use]
    pub const fn hello(&self) -> &Hello {
        &self.declared.hello
    }

    /// How the renderer is named in reports.
    #[must_use]
    pub fn identity(&self) -> Identity {
        self.declared.identity()
    }

    /// Reads the next file.
    fn read_next(&mut self) -> Result<(), PackError> {
        let Some(mut file) = self.files.pop_front() else { return Ok(()) };
        self.is_of_this_pack(&file)?;
        let columns = Columns::open(&file.folder, &self.plan)?;
        self.says_its_pack(&file, &columns)?;
        if file.pack().is_none() {
            self.of_any_pack.push(file.path.clone());
        }
        for formula in columns.formulas() {
            let id = &self.plan.member(formula).spec.id;
            if self.declared.lacks(id).is_some() {
                note(&mut self.problems, "unknown", || format!("`{id}` is not among what the renderer declares"));
            }
        }
        self.contents = Contents { columns, folder: file.folder.clone(), ..Contents::default() };
        let source = self.are_many.then(|| file.path.display().to_string());
        let told =
            |number: u64| source.as_ref().map_or_else(|| format!("line {number}"), |of| format!("{of}, line {number}"));
        if let Some(which) = file.hello.as_ref().and_then(|hello| self.declared.hello.difference(hello)) {
            let what = format!("{}: another hello than that of the first file: {which}", told(file.first_number));
            note(&mut self.problems, "malformed", || what);
        }
        let mut lines = std::mem::take(&mut file.first);
        loop {
            let next = file.next()?;
            let is_over = next.is_none() || self.stop.is_set();
            match next {
                Some(Ok(line)) => lines.push((file.number, line)),
                Some(Err(error)) => note(&mut self.problems, "oversized", || format!("{}: {error}", told(file.number))),
                None => {}
            }
            if lines.len() == LINES || is_over {
                self.take(&lines, &told);
                lines.clear();
            }
            if is_over {
                return Ok(());
            }
        }
    }

    /// Refuses answers that are to another pack, as they say.
    fn is_of_this_pack(&self, file: &AnswerFile) -> Result<(), PackError> {
        let own = self.plan.pack();
        let Some(other) = file.pack().filter(|&said| said != own) else { return Ok(()) };
        let message = format!("its hello says that it answers the pack `{}`; this pack is `{own}`", clipped(other));
        Err(PackError::Manifest { path: file.path.clone(), message })
    }

    /// Refuses columns without a word of the pack that they are to: they have no ids that would tell.
    fn says_its_pack(&self, file: &AnswerFile, columns: &Columns) -> Result<(), PackError> {
        if file.pack().is_some() || columns.is_empty() {
            return Ok(());
        }
        let own = self.plan.pack();
        let message =
            format!("its hello does not say which pack it answers; beside columns it has `\"pack\": \"{own}\"`");
        Err(PackError::Manifest { path: file.path.clone(), message })
    }

    /// That files do not say which pack they answer, where some do not: random cases of another pack may have the same ids.
    fn warning(&self) -> Option<String> {
        let files: Vec<String> = self.of_any_pack.iter().map(|path| path.display().to_string()).collect();
        let (of, own) =
            (if self.are_many { format!(" ({})", files.join(", ")) } else { String::new() }, self.plan.pack());
        (!files.is_empty()).then(|| {
            format!(
                "the answers do not say which pack they answer{of}; if it is another one, cases of the same ids are judged by the \
                 wrong inputs: have the first line say `\"pack\": \"{own}\"`, as this pack's manifest does"
            )
        })
    }

    /// Takes lines for answers to cases of the plan. What answers none of them is a problem.
    fn take(&mut self, lines: &[(u64, Vec<u8>)], told: &dyn Fn(u64) -> String) {
        let (plan, declared) = (&self.plan, &self.declared);
        let read: Vec<(u64, Read)> =
            lines.par_iter().map(|(number, line)| (*number, Read::of(line, plan, declared))).collect();
        for (number, read) in read {
            let (place, given) = match read {
                Read::Problem(kind, what) => {
                    note(&mut self.problems, kind, || format!("{}: {what}", told(number)));
                    continue;
                }
                Read::Skips(formula, skip) => {
                    self.skip(formula, skip, &told(number));
                    continue;
                }
                Read::Answer(place, given) => (place, given),
            };
            if !self.contents.put(&self.plan, place, given) {
                let id = self.plan.id(place);
                note(&mut self.problems, "duplicate", || format!("{}: {id} is answered more than once", told(number)));
            }
        }
    }

    /// Notes that cases of a formula are skipped. Columns answer every row, so that their skips must name rows.
    fn skip(&mut self, formula: usize, skip: FormulaSkip, line: &str) {
        let (id, count) = (&self.plan.member(formula).spec.id, self.plan.formulas[formula].count());
        let has_columns = self.contents.columns.has(formula);
        match &skip.rows {
            Some(rows) if rows.iter().any(|&row| row >= count) => {
                note(&mut self.problems, "unknown", || format!("{line}: {id} has {count} rows, counted from 0"));
            }
            Some(_) if !has_columns => {
                note(&mut self.problems, "unknown", || {
                    format!("{line}: {id} has no columns whose rows could be skipped")
                });
            }
            None if has_columns => note(&mut self.problems, "duplicate", || {
                format!("{line}: {id} is answered by columns; a skip of some of its cases names them by `rows`")
            }),
            _ => {
                if let Err(twice) = self.contents.skips.add(formula, skip) {
                    note(&mut self.problems, "duplicate", || match twice {
                        SkippedTwice::Row(row) => {
                            format!(
                                "{line}: row {row} of {id} is skipped more than once; expected each row once in `rows` of all lines"
                            )
                        }
                        SkippedTwice::All => format!("{line}: {id} is skipped more than once; expected one such line"),
                    });
                }
            }
        }
    }
}

/// What a line comes to.
enum Read {
    Answer(CasePlace, Given),
    Skips(usize, FormulaSkip),
    Problem(&'static str, String),
}

/// Why files of answers cannot be judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilesError {
    /// A file cannot be read.
    #[error(transparent)]
    File(#[from] PackError),
    /// What the first line declares cannot be read.
    #[error(transparent)]
    Hello(#[from] ProcessError),
}

impl Read {
    fn of(line: &[u8], plan: &GatePlan, declared: &Declared) -> Self {
        let line = match answer::read(line) {
            Ok(line) => line,
            Err(message) => return Self::Problem("malformed", message),
        };
        let Some(id) = line.id() else {
            return Self::Problem("malformed", "a hello, which is said once and first".into());
        };
        if let (None, Some(formula)) = (plan.find(id), plan.formula(id)) {
            let (rows, reason) = match &line {
                Line::Skip(_, reason) => (None, reason),
                Line::SkipRows(_, rows, reason) => (Some(rows.clone()), reason),
                _ => return Self::Problem("unknown", format!("`{id}` is a formula; expected the id of a case")),
            };
            if declared.lacks(id).is_some() {
                return Self::Problem("unknown", format!("`{id}` is not among what the renderer declares"));
            }
            return Self::Skips(formula, FormulaSkip { rows, reason: clipped(reason) });
        }
        let Some(place) = plan.find(id) else {
            return Self::Problem("unknown", format!("no case `{}` was asked for", clipped(id)));
        };
        let lacks = |spec: &Spec| declared.lacks(&spec.id).is_some();
        let (asks, is_declared) = match place {
            CasePlace::Case { formula, .. } => {
                let spec = &plan.member(formula).spec;
                (Asks::Outputs(spec), !lacks(spec))
            }
            CasePlace::Pixel { target, state, .. } => {
                let spec = &plan.state_member(state).spec;
                (Asks::Pixel(spec), !lacks(spec) && declared.targets.contains(&target))
            }
            CasePlace::Probe(probe) => (Asks::Word(plan.probes[probe]), declared.hello.special),
            CasePlace::Scene(_) => (Asks::Image, declared.lacks(&plan.id(place)).is_none()),
        };
        if !is_declared {
            return Self::Problem("unknown", format!("`{id}` is not among what the renderer declares"));
        }
        let id = id.to_owned();
        Self::Answer(place, declared.skips.settled(&id, given(line, asks)))
    }
}

impl Column {
    /// An empty column for `count` cases of `outputs` numbers each.
    fn new(count: usize, outputs: usize) -> Self {
        Self { words: vec![0; count * outputs], is_answered: vec![false; count], others: HashMap::new() }
    }

    /// Stores the answer to a case, or the reason why it has none. Returns whether it is the first answer to that case.
    fn put(&mut self, case: usize, outputs: usize, given: Given) -> bool {
        if std::mem::replace(&mut self.is_answered[case], true) {
            return false;
        }
        match given {
            Given::Values(values) => {
                let row = &mut self.words[case * outputs..(case + 1) * outputs];
                row.iter_mut().zip(values).for_each(|(word, value)| *word = value.to_bits());
            }
            Given::Nothing(why) => drop(self.others.insert(case, why)),
            Given::Word(_) | Given::Image(_) => unreachable!("a formula is answered by values"),
        }
        true
    }

    /// The answer to a case, as words.
    fn get(&self, case: usize, outputs: usize) -> Result<&[u32], Unanswered> {
        if !self.is_answered[case] {
            return Err(Unanswered::Missing);
        }
        let words = &self.words[case * outputs..(case + 1) * outputs];
        self.others.get(&case).map_or(Ok(words), |why| Err(why.clone()))
    }
}

/// Stores the answer to a scene or a special value. Returns whether it is the first.
fn is_first(entry: Entry<'_, usize, Given>, given: Given) -> bool {
    let is_first = matches!(entry, Entry::Vacant(_));
    entry.or_insert(given);
    is_first
}

impl Contents {
    /// Stores an answer. Returns whether it is the first to its case.
    fn put(&mut self, plan: &GatePlan, place: CasePlace, given: Given) -> bool {
        match place {
            CasePlace::Case { formula, .. } if self.columns.has(formula) => false,
            CasePlace::Case { formula, case } => {
                let outputs = plan.member(formula).spec.output_len();
                let blank = || Column::new(plan.formulas[formula].count(), outputs);
                self.formulas.entry(formula).or_insert_with(blank).put(case, outputs, given)
            }
            CasePlace::Pixel { target, state, case } => {
                let blank = || Column::new(plan.states[state].count(), COMPONENTS);
                self.states.entry((state, target)).or_insert_with(blank).put(case, COMPONENTS, given)
            }
            CasePlace::Probe(probe) => is_first(self.probes.entry(probe), given),
            CasePlace::Scene(scene) => is_first(self.scenes.entry(scene), given),
        }
    }
}

impl AskedRenderer for FileRenderer {
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
        let formula = self.plan.formula(&rows.members[0].spec.id);
        if let Some(formula) = formula
            && let Some(mut columns) = self.contents.columns.of(formula)
        {
            for (place, (&case, words)) in
                rows.cases.iter().zip(answers.words.chunks_exact_mut(rows.outputs)).enumerate()
            {
                let Some(row) = self.plan.formulas[formula].place(case) else {
                    answers.unanswered.insert(place, Unanswered::Missing);
                    continue;
                };
                if let Some(reason) = self.contents.skips.of_row(formula, row) {
                    let id = rows.members[rows.of[place]].case_id(case);
                    answers.unanswered.insert(place, self.declared.skips.skipped(&id, reason.to_owned()));
                    continue;
                }
                columns.read(row, words).map_err(|error| DeviceError::Refused(Box::new(error)))?;
            }
            advanced(rows.of.len() as u64);
            return Ok(answers);
        }
        let column = formula.and_then(|formula| Some((formula, self.contents.formulas.get(&formula)?)));
        let skipped = formula.and_then(|formula| self.contents.skips.of_all(formula));
        for (place, (&case, words)) in rows.cases.iter().zip(answers.words.chunks_exact_mut(rows.outputs)).enumerate() {
            let found = column.and_then(|(formula, column)| Some((column, self.plan.formulas[formula].place(case)?)));
            match found.map_or(Err(Unanswered::Missing), |(column, case)| column.get(case, rows.outputs)) {
                Ok(answered) => words.copy_from_slice(answered),
                Err(Unanswered::Missing) if skipped.is_some() => {
                    let reason = skipped.unwrap_or_default().to_owned();
                    let id = rows.members[rows.of[place]].case_id(case);
                    answers.unanswered.insert(place, self.declared.skips.skipped(&id, reason));
                }
                Err(why) => drop(answers.unanswered.insert(place, why)),
            }
        }
        advanced(rows.of.len() as u64);
        Ok(answers)
    }

    fn targets(&self) -> Vec<TargetFormat> {
        let is_declared = |target: &TargetFormat| self.declared.targets.contains(target);
        self.plan.targets.iter().copied().filter(is_declared).collect()
    }

    fn pixels(&mut self, asked: &AskedPixels<'_>) -> Result<Vec<Result<Units, Unanswered>>, DeviceError> {
        let state = self.plan.state(&asked.member.spec.id);
        let column = state.and_then(|state| Some((state, self.contents.states.get(&(state, asked.target))?)));
        let of_case = |&case: &CaseRef| {
            let found = column.and_then(|(state, column)| Some((column, self.plan.states[state].place(case)?)));
            let (column, place) = found.ok_or(Unanswered::Missing)?;
            let words = column.get(place, COMPONENTS)?;
            Ok(std::array::from_fn(|k| f32::from_bits(words[k]).into()))
        };
        Ok(asked.cases.iter().map(of_case).collect())
    }

    fn asks_special(&self) -> bool {
        self.plan.choice.special && self.declared.hello.special
    }

    fn probes(&mut self, probes: &[&'static Probe]) -> Result<Vec<Result<u32, Unanswered>>, DeviceError> {
        let answer = |probe: &&'static Probe| match self.plan.find(&probe.id()) {
            Some(CasePlace::Probe(place)) => {
                self.contents.probes.get(&place).cloned().map_or(Err(Unanswered::Missing), word)
            }
            _ => Err(Unanswered::Missing),
        };
        Ok(probes.iter().map(answer).collect())
    }

    fn image(&mut self, scene: AskedScene<'_>) -> Result<Result<StoredImage, Unanswered>, DeviceError> {
        let place = match self.plan.find(scene.id) {
            Some(CasePlace::Scene(place)) => self.contents.scenes.get(&place),
            _ => None,
        };
        Ok(match place {
            Some(Given::Image(file)) => {
                picture::read(&self.contents.folder, file, scene.frame, None).map_err(Unanswered::Unjudged)
            }
            Some(Given::Nothing(why)) => Err(why.clone()),
            Some(Given::Values(_) | Given::Word(_)) => unreachable!("a scene is answered by an image, or by nothing"),
            None => Err(Unanswered::Missing),
        })
    }

    fn begin_again(&mut self) -> Result<(), DeviceError> {
        self.read_next().map_err(|error| DeviceError::Refused(Box::new(error)))
    }

    fn asks_failing_again(&self) -> bool {
        false
    }

    fn is_over(&self) -> bool {
        self.stop.is_set()
    }

    fn used(&mut self) -> RendererUse {
        let warnings = self.warning().into_iter().collect();
        RendererUse { problems: std::mem::take(&mut self.problems), warnings, ..self.declared.used() }
    }
}
