//! Columns: the inputs and the outputs of a formula as arrays of NumPy's format, a file each, with a row for each case.
//!
//! A pack has `columns/FORMULA/INPUT.npy`, answers to it `columns/FORMULA/OUTPUT.npy`. The rows stand in the order in which the pack counts
//! its cases; a number is a row of its own, a vector or a matrix a row of its components. Rows are read as they are judged, so that no file
//! is in memory.

use super::error::PackError;
use super::picture::decode::is_nested;
use super::plan::GatePlan;
use lightmeter_catalogue::cases::{Output, Spec};
use rayon::prelude::*;
use std::collections::HashMap;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The folder of the columns, in a pack and among answers.
pub(super) const FOLDER: &str = "columns";
/// Rows that are drawn, or read, at once.
const ROWS: usize = 1 << 14;
/// Bytes of a file's header, at most.
const MOST_HEADER: u64 = 1 << 16;

/// The names of a formula's columns in a pack, in the order of its inputs.
pub(super) fn names(spec: &Spec) -> impl Iterator<Item = String> {
    spec.inputs.iter().map(|input| format!("{FOLDER}/{}/{}.npy", spec.id, input.name))
}

/// Writes the inputs of a formula of a plan, each into a stream of its own.
///
/// # Errors
/// Where a stream fails.
pub(super) fn write(plan: &GatePlan, formula: usize, streams: &mut [impl Write]) -> std::io::Result<()> {
    use npyz::WriterBuilder as _;
    let (spec, count) = (&plan.member(formula).spec, plan.formulas[formula].count());
    let components: Vec<usize> = spec.inputs.iter().map(|input| input.shape.components()).collect();
    let begin = |(stream, &components): (_, &usize)| {
        let shape: Vec<u64> = [count, components].into_iter().map(|n| n as u64).collect();
        let shape = &shape[..if components == 1 { 1 } else { 2 }];
        npyz::WriteOptions::<f32>::new().default_dtype().shape(shape).writer(stream).begin_nd()
    };
    let mut columns = streams.iter_mut().zip(&components).map(begin).collect::<std::io::Result<Vec<_>>>()?;
    for first in (0..count).step_by(ROWS) {
        let places: Vec<usize> = (first..count.min(first + ROWS)).collect();
        let rows: Vec<Vec<f32>> = places.par_iter().map_init(|| plan.rows(formula), |row, &place| row(place)).collect();
        let mut start = 0;
        for (column, &components) in columns.iter_mut().zip(&components) {
            rows.iter().try_for_each(|row| column.extend(row[start..start + components].iter().copied()))?;
            start += components;
        }
    }
    columns.into_iter().try_for_each(npyz::NpyWriter::finish)
}

/// An output of a formula, in a file.
struct ColumnFile {
    path: PathBuf,
    file: File,
    /// Where its numbers begin.
    start: u64,
    /// Whether they are f64, not f32.
    is_wide: bool,
    components: usize,
    /// The rows that are in memory, from this one.
    first: usize,
    rows: Vec<u32>,
}

impl ColumnFile {
    /// Opens the column of an output and holds its header and its length against what is expected.
    fn open(path: PathBuf, output: &Output, count: usize) -> Result<Self, PackError> {
        let failed = |error: &dyn std::fmt::Display| PackError::Read { path: path.clone(), message: error.to_string() };
        let refused = |message: String| PackError::Manifest { path: path.clone(), message };
        let mut file = lightmeter_files::read::open(&path).map_err(|error| failed(&error))?;
        let mut header = vec![];
        (&mut file).take(MOST_HEADER).read_to_end(&mut header).map_err(|error| failed(&error))?;
        if is_nested(&header) {
            return Err(refused("its header nests brackets; expected that of an array of numbers".into()));
        }
        let mut rest = header.as_slice();
        let array = npyz::NpyFile::new(&mut rest).map_err(|error| {
            refused(format!("it is no array: {error}; expected one of <f4 or <f8, as numpy.save writes it"))
        })?;
        let components = output.shape.components();
        // A column of the shape (n, 1) is told, since elsewhere NumPy stretches it to a matrix: f * color would be one.
        let shape = [count as u64, components as u64];
        let expected = &shape[..if components == 1 { 1 } else { 2 }];
        if array.shape() != expected {
            let fix = if array.shape() == shape { ", as of f[:, 0]" } else { "" };
            return Err(refused(format!("its shape is {:?}; expected {expected:?}{fix}", array.shape())));
        }
        if array.order() != npyz::Order::C && components > 1 {
            return Err(refused("it is in Fortran's order; expected C's, as of numpy.ascontiguousarray".into()));
        }
        let is_wide = match array.dtype() {
            npyz::DType::Plain(kind) if kind.to_string() == "<f4" => false,
            npyz::DType::Plain(kind) if kind.to_string() == "<f8" => true,
            other => return Err(refused(format!("its numbers are {}; expected <f4 or <f8", other.descr()))),
        };
        drop(array);
        let start = (header.len() - rest.len()) as u64;
        let bytes = file.metadata().map_err(|error| failed(&error))?.len();
        let expected = start + (count * components * if is_wide { 8 } else { 4 }) as u64;
        if bytes != expected {
            return Err(refused(format!("it has {bytes} bytes; expected {expected} for its shape")));
        }
        Ok(Self { path, file, start, is_wide, components, first: 0, rows: vec![] })
    }

    /// The numbers of a row as words, read with those behind it where they are not at hand.
    fn row(&mut self, row: usize) -> Result<&[u32], PackError> {
        let at_hand = self.first..self.first + self.rows.len() / self.components;
        if !at_hand.contains(&row) {
            self.load(row).map_err(|error| PackError::Read { path: self.path.clone(), message: error.to_string() })?;
        }
        let start = (row - self.first) * self.components;
        Ok(&self.rows[start..start + self.components])
    }

    fn load(&mut self, row: usize) -> std::io::Result<()> {
        let width = if self.is_wide { 8 } else { 4 };
        self.file.seek(SeekFrom::Start(self.start + (row * self.components * width) as u64))?;
        let mut bytes = vec![];
        (&mut self.file).take((ROWS * self.components * width) as u64).read_to_end(&mut bytes)?;
        #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is what is asked for")]
        let wide = |part: &[u8]| (part.try_into().map_or(f64::NAN, f64::from_le_bytes) as f32).to_bits();
        let narrow = |part: &[u8]| part.try_into().map_or(0, u32::from_le_bytes);
        self.rows.clear();
        self.rows.extend(bytes.chunks_exact(width).map(|part| if self.is_wide { wide(part) } else { narrow(part) }));
        self.first = row;
        if self.rows.len() < self.components {
            return Err(std::io::Error::new(std::io::ErrorKind::UnexpectedEof, "it became shorter as it was read"));
        }
        Ok(())
    }
}

/// The columns of answers, by the formula's place in the plan.
#[derive(Default)]
pub(super) struct Columns(HashMap<usize, Vec<ColumnFile>>);

impl Columns {
    /// Opens the columns of a folder of answers; nothing where it has none.
    ///
    /// # Errors
    /// Where a file cannot be read, is missing, or does not fit the plan.
    pub(super) fn open(answers: &Path, plan: &GatePlan) -> Result<Self, PackError> {
        let root = answers.join(FOLDER);
        let mut columns = HashMap::new();
        if !root.is_dir() {
            return Ok(Self(columns));
        }
        let mut found = vec![];
        find(&root, &mut found)?;
        for (folder, files) in found {
            let refused = |message: String| PackError::Manifest { path: folder.clone(), message };
            let id = folder.strip_prefix(&root).unwrap_or(&folder).to_string_lossy().replace('\\', "/");
            let Some(formula) = plan.formula(&id) else {
                return Err(refused(format!("the pack has no formula `{id}`")));
            };
            let (spec, count) = (&plan.member(formula).spec, plan.formulas[formula].count());
            let expected: Vec<String> = spec.outputs.iter().map(|output| format!("{}.npy", output.name)).collect();
            if let Some(other) = files.iter().find(|file| !expected.contains(file)) {
                return Err(refused(format!("`{other}` is no output; expected {}", expected.join(", "))));
            }
            if let Some(missing) = expected.iter().find(|file| !files.contains(file)) {
                return Err(refused(format!("`{missing}` is missing; expected {}", expected.join(", "))));
            }
            let open = |output: &Output| ColumnFile::open(folder.join(format!("{}.npy", output.name)), output, count);
            columns.insert(formula, spec.outputs.iter().map(open).collect::<Result<_, _>>()?);
        }
        Ok(Self(columns))
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a formula is answered by columns.
    pub(super) fn has(&self, formula: usize) -> bool {
        self.0.contains_key(&formula)
    }

    /// The formulas that are answered, by their places.
    pub(super) fn formulas(&self) -> impl Iterator<Item = usize> {
        self.0.keys().copied()
    }

    /// The columns of a formula, in the order of its outputs; `None` where it has none.
    pub(super) fn of(&mut self, formula: usize) -> Option<FormulaColumns<'_>> {
        self.0.get_mut(&formula).map(|columns| FormulaColumns(columns))
    }
}

/// The columns of a formula.
pub(super) struct FormulaColumns<'a>(&'a mut [ColumnFile]);

impl FormulaColumns<'_> {
    /// Puts the answer to a case into words.
    pub(super) fn read(&mut self, case: usize, words: &mut [u32]) -> Result<(), PackError> {
        let mut rest = words;
        for column in &mut *self.0 {
            let (own, after) = rest.split_at_mut(column.components);
            own.copy_from_slice(column.row(case)?);
            rest = after;
        }
        Ok(())
    }
}

/// The folders below one that hold files, with the names of these.
fn find(folder: &Path, found: &mut Vec<(PathBuf, Vec<String>)>) -> Result<(), PackError> {
    let failed = |error: std::io::Error| PackError::Read { path: folder.to_owned(), message: error.to_string() };
    let mut files = vec![];
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        if entry.file_type().map_err(failed)?.is_dir() {
            find(&entry.path(), found)?;
        } else {
            files.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    if !files.is_empty() {
        found.push((folder.to_owned(), files));
    }
    Ok(())
}
