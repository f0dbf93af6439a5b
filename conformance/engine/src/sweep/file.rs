//! A sweep's file: what is swept, how far it came, and what was found. It is the result, and while a sweep runs its checkpoint.
//!
//! A file is trusted where its checksum holds and its counts add up to the blocks that it says are done.

use super::description::{differences, span};
use super::span::Span;
use lightmeter_catalogue::select::Shard;
use lightmeter_document::Document as _;
use lightmeter_document::sweep::{Description, SCHEMA, Statistics, SweepDocument};
use lightmeter_files::read;
use std::collections::BTreeMap;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};

/// What is wrong with a sweep's file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentError {
    /// It cannot be read.
    #[error("cannot read {}: {message}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's message.
        message: String,
    },
    /// It cannot be written.
    #[error("cannot write {}: {message}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The system's message.
        message: String,
    },
    /// It is not what was written.
    #[error("{} is damaged, or no result of `lightmeter sweep`: {message}; if it is one, delete it to start again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// It is of another sweep.
    #[error("{} is of another sweep: {}; give another --checkpoint, or delete it to start again", path.display(), differences.join("; "))]
    Another {
        /// The file.
        path: PathBuf,
        /// What differs.
        differences: Vec<String>,
    },
    /// Results that make no whole.
    #[error("{0}")]
    NoWhole(String),
}

/// A sweep of which nothing is done.
#[must_use]
pub fn begun(sweep: Description, shard: Shard) -> SweepDocument {
    let blocks = span(&sweep).blocks_of(shard);
    SweepDocument {
        schema: SCHEMA.into(),
        command: None,
        version: Some(env!("CARGO_PKG_VERSION").into()),
        made_at: None,
        sweep,
        shard: name_of(shard),
        done: 0,
        blocks,
        seconds: 0.0,
        statistics: Statistics::default(),
        checksum: String::new(),
    }
}

/// Which part of its sweep a document is.
///
/// # Panics
/// Never of one that was read, whose shard was checked.
#[must_use]
pub fn shard(document: &SweepDocument) -> Shard {
    shard_of(&document.shard).expect("a document is made with a shard")
}

/// Reads a file's text.
///
/// # Errors
/// What is wrong with it.
pub fn parse(text: &str) -> Result<SweepDocument, String> {
    let document = SweepDocument::read(text).map_err(|error| error.to_string())?;
    problem(&document).map_or(Ok(document), Err)
}

/// What does not add up.
fn problem(document: &SweepDocument) -> Option<String> {
    let Some(shard) = shard_of(&document.shard) else {
        return Some(format!("`{}` is no shard", document.shard));
    };
    let span = span(&document.sweep);
    let is_cut_so = (1..=1 << 32).contains(&span.inputs) && span == Span::of(span.inputs);
    if !is_cut_so || document.blocks != span.blocks_of(shard) || document.done > document.blocks {
        return Some(format!(
            "{} of {} blocks cannot be done of {} inputs",
            document.done, document.blocks, span.inputs
        ));
    }
    if document.statistics.inputs != span.inputs_of(shard, document.done) {
        let (done, inputs) = (document.done, span.inputs_of(shard, document.done));
        return Some(format!("{done} blocks have {inputs} inputs, and it counts {}", document.statistics.inputs));
    }
    document.statistics.problem()
}

/// Reads a file.
///
/// # Errors
/// Where it cannot be read, or is not what was written.
pub fn read(path: &Path) -> Result<SweepDocument, DocumentError> {
    let bytes = read::bytes(path, read::MOST_TEXT)
        .map_err(|error| DocumentError::Unreadable { path: path.into(), message: error.to_string() })?;
    let text = String::from_utf8(bytes).map_err(|_| "not UTF-8".to_owned());
    text.and_then(|text| parse(&text)).map_err(|message| DocumentError::Damaged { path: path.into(), message })
}

/// Reads a checkpoint of the sweep that is about to be made; `None` where there is no file.
///
/// # Errors
/// Where it cannot be read, is damaged, or is another sweep's.
pub fn resume(path: &Path, sweep: &Description, shard: Shard) -> Result<Option<SweepDocument>, DocumentError> {
    if !path.try_exists().unwrap_or(true) {
        return Ok(None);
    }
    let found = read(path)?;
    let mut differences = differences(&found.sweep, sweep, ["there", "here"]);
    if self::shard(&found) != shard {
        differences.push(format!("shard is {} there and {} here", found.shard, name_of(shard)));
    }
    if differences.is_empty() {
        return Ok(Some(found));
    }
    Err(DocumentError::Another { path: path.into(), differences })
}

/// Writes a document as a file, beside its place first, so that what stands there is whole at any moment.
///
/// # Errors
/// Where it cannot be written.
pub fn write(document: &SweepDocument, path: &Path) -> Result<(), DocumentError> {
    let unwritable = |message: String| DocumentError::Unwritable { path: path.into(), message };
    let text = document.to_json().map_err(|error| unwritable(error.to_string()))?;
    lightmeter_files::whole(path, text.as_bytes()).map_err(|error| unwritable(error.to_string()))
}

/// The results of every shard as one.
///
/// # Errors
/// Where they are not the shards of one sweep, each finished and each once.
pub fn merge(parts: &[(PathBuf, SweepDocument)]) -> Result<SweepDocument, DocumentError> {
    let no_whole = |message: String| Err(DocumentError::NoWhole(message));
    let Some(((first_path, first), rest)) = parts.split_first() else {
        return no_whole("there is nothing to merge; expected the results of each shard".into());
    };
    for (path, part) in parts {
        if !part.is_finished() {
            let (path, done, blocks) = (path.display(), part.done, part.blocks);
            return no_whole(format!(
                "{path} is not finished: {done} of {blocks} blocks; give it as --checkpoint to its command again"
            ));
        }
    }
    let count = shard(first).count;
    for (path, part) in rest {
        let (a, b) = (format!("in {}", first_path.display()), format!("in {}", path.display()));
        let differences = differences(&first.sweep, &part.sweep, [&a, &b]);
        if !differences.is_empty() {
            return no_whole(format!("these are results of different sweeps: {}", differences.join("; ")));
        }
        if shard(part).count != count {
            let (first, part) = (&first.shard, &part.shard);
            return no_whole(format!("shards {first} {a} and {part} {b} overlap: expected all of the same number"));
        }
    }
    let mut whole = begun(first.sweep.clone(), Shard::WHOLE);
    let mut by_index: BTreeMap<u64, &PathBuf> = BTreeMap::new();
    for (path, part) in parts {
        if let Some(other) = by_index.insert(shard(part).index, path) {
            let (a, b, shard) = (other.display(), path.display(), &part.shard);
            return no_whole(format!("{a} and {b} overlap: both are shard {shard}"));
        }
        whole.statistics.add(part.statistics.clone());
        whole.seconds += part.seconds;
    }
    let has_blocks = |index: &u64| span(&first.sweep).blocks_of(Shard { index: *index, count }) > 0;
    let missing: Vec<String> = (0..count.get().min(whole.blocks))
        .filter(|index| !by_index.contains_key(index) && has_blocks(index))
        .map(|index| name_of(Shard { index, count }))
        .collect();
    if !missing.is_empty() {
        return no_whole(format!("there is no result of shard {}", missing.join(", ")));
    }
    whole.done = whole.blocks;
    Ok(whole)
}

/// `I/N`.
#[must_use]
pub fn name_of(shard: Shard) -> String {
    format!("{}/{}", shard.index + 1, shard.count)
}

fn shard_of(text: &str) -> Option<Shard> {
    let (index, count) = text.split_once('/')?;
    let (index, count): (u64, NonZeroU64) = (index.parse().ok()?, count.parse().ok()?);
    (1..=count.get()).contains(&index).then(|| Shard { index: index - 1, count })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Code;
    use crate::subject::Subject;
    use crate::sweep::{Asked, SweepPlan, describe};
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::select::catalogue;
    use lightmeter_document::Number;
    use lightmeter_document::sweep::{ExactFloat, SweepInput, SweepVerdict};

    fn seen(x: f32, error: f64) -> SweepVerdict {
        SweepVerdict {
            input: SweepInput::Float(ExactFloat(x)),
            value: ExactFloat(1.0),
            reference: Number(1.0),
            low: Number(0.5),
            high: Number(2.0),
            error: Number(error),
            margin: Number(error / 8.0),
        }
    }

    /// Five blocks of fog, of which one input fails.
    fn document(shard: Shard) -> SweepDocument {
        let catalogue = catalogue();
        let asked = Asked { from: Some(1.0), to: Some(1.002), ..Asked::default() };
        let plan = SweepPlan::new(&catalogue, "fog/exp", &asked).expect("a plan");
        let sweep = describe(&plan, &Subject::embedded(), &WGSL, &Code::default());
        let mut document = begun(sweep, shard);
        document.done = document.blocks;
        let inputs = span(&document.sweep).inputs_of(shard, document.done);
        document.statistics = Statistics { inputs, passed: inputs - 1, failed: 1, ..Statistics::default() };
        document.statistics.histogram.count_near([inputs - 1, 0, 0]);
        document.statistics.histogram.count(9.0);
        document.statistics.see_error(seen(1.001, 9.0));
        document.statistics.see_failure(seen(1.001, 9.0));
        document
    }

    #[test]
    fn a_file_is_read_back_as_it_was_written() {
        let document = document(Shard::WHOLE);
        let text = document.to_json().expect("JSON");
        let back = parse(&text).expect("it is whole");
        assert_eq!(back.to_json().expect("JSON"), text);
        assert_eq!(back.statistics, document.statistics);
        assert_eq!(back.statistics.worst, Some(seen(1.001, 9.0)));
    }

    #[test]
    fn files_whose_counts_do_not_add_up_are_refused_though_their_checksum_holds() {
        type Change = (&'static str, fn(&mut SweepDocument));
        let change: &[Change] = &[
            ("histogram", |d| d.statistics.histogram.count(1.0)),
            ("verdicts", |d| d.statistics.passed -= 1),
            ("blocks have", |d| d.done -= 1),
            ("cannot be done", |d| d.done += 1),
            ("cannot be done", |d| d.blocks += 1),
            ("cannot be done", |d| d.sweep.block = 0),
            ("`block` is 18446744073709551615; expected", |d| d.sweep.block = u64::MAX),
            ("is no shard", |d| d.shard = "3/2".into()),
        ];
        for (says, change) in change {
            let mut document = document(Shard::WHOLE);
            change(&mut document);
            let message = parse(&document.to_json().expect("JSON")).err().unwrap_or_default();
            assert!(message.contains(says), "{says}: {message}");
        }
    }

    #[test]
    fn a_flipped_bit_is_seen() {
        let text = document(Shard::WHOLE).to_json().expect("JSON");
        for at in (0..text.len()).step_by(7) {
            let mut bytes = text.clone().into_bytes();
            bytes[at] ^= 1;
            // What is read as the same numbers, as with other white space, is no damage.
            let read = String::from_utf8(bytes).ok().and_then(|text| parse(&text).ok());
            let differs = read.is_some_and(|read| read.to_json().expect("JSON") != text);
            assert!(!differs, "byte {at} of {text}");
        }
    }

    #[test]
    fn shards_that_have_no_block_are_not_missed() {
        let count = NonZeroU64::new(8).expect("not 0");
        let parts: Vec<(PathBuf, SweepDocument)> =
            (0..5).map(|index| (PathBuf::from(format!("{index}.json")), document(Shard { index, count }))).collect();
        assert_eq!(span(&parts[0].1.sweep).blocks(), 5);
        let merged = merge(&parts).expect("they are all");
        assert_eq!((merged.statistics.inputs, merged.statistics.failed), (merged.sweep.inputs, 5));
        let missing = merge(&parts[1..]).expect_err("one is missing").to_string();
        assert_eq!(missing, "there is no result of shard 1/8");
    }
}
