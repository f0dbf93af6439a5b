//! A sweep's file: what is swept, how far it came, and what was found. It is the result, and while a sweep runs its checkpoint.
//!
//! A file is trusted where its checksum holds and its counts add up to the blocks that it says are done.

use super::plan::{Over, Plan};
use super::span::Span;
use super::statistics::{Exact, Statistics};
use crate::arithmetic::Profile;
use crate::select::Shard;
use crate::subject::Identity;
use lightmeter_gpu::Shaders;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};

/// The schema of a sweep's file.
pub const SCHEMA: &str = "lightmeter.sweep/1";

/// What is swept, on what, by which rules: files of the same sweep have the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// The formula's id.
    pub formula: String,
    /// What is free.
    pub over: String,
    /// The least float.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub from: Option<Exact>,
    /// The greatest.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub to: Option<Exact>,
    /// The other inputs by name.
    pub fixed: Vec<(String, Exact)>,
    /// The output.
    pub output: String,
    /// What errors are counted in: `ULP` or `step`.
    pub unit: String,
    /// The stage.
    pub stage: String,
    /// The adapter.
    pub adapter: Adapter,
    /// The accuracy rules.
    pub profile: String,
    /// A hash of the shader's text; of the version, where the embedded implementation is swept.
    pub shader: String,
    /// All inputs.
    pub inputs: u64,
    /// Inputs of a block.
    pub block: u64,
}

/// How the adapter is named.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adapter {
    /// The short name.
    pub name: String,
    /// The device as the driver names it.
    pub device: String,
    /// `vulkan`, `gl` or `embedded`.
    pub backend: String,
    /// The driver and its version.
    pub driver: String,
}

impl From<&Identity> for Adapter {
    fn from(identity: &Identity) -> Self {
        let Identity { name, device, backend, driver } = identity.clone();
        Self { name, device, backend: backend.into(), driver }
    }
}

impl Description {
    /// What a plan sweeps on an adapter.
    #[must_use]
    pub fn new(plan: &Plan<'_>, adapter: &Identity, profile: &Profile, shaders: &Shaders) -> Self {
        let (from, to, unit, file) = match plan.over {
            Over::Number { from, to, .. } => {
                (Some(Exact(from)), Some(Exact(to)), "ULP", format!("{}.wgsl", plan.member.spec.family()))
            }
            Over::Bytes => (None, None, "step", super::blend::FILE.into()),
        };
        let text = if adapter.backend == "embedded" { adapter.driver.clone() } else { shaders.source(&file) };
        let Span { inputs, block } = plan.span();
        Self {
            formula: plan.member.spec.id.clone(),
            over: plan.over_name(),
            from,
            to,
            fixed: plan.fixed(),
            output: plan.output_name(),
            unit: unit.into(),
            stage: plan.stage.name().into(),
            adapter: adapter.into(),
            profile: profile.name.into(),
            shader: hash(text.as_bytes()),
            inputs,
            block,
        }
    }

    /// Whether it is over the inputs of a plan, to the last bit.
    #[must_use]
    pub fn is_over_inputs_of(&self, plan: &Plan<'_>) -> bool {
        let bits = |x: Option<Exact>| x.map(|Exact(x)| x.to_bits());
        let ends = match plan.over {
            Over::Number { from, to, .. } => [Some(from), Some(to)].map(|x| x.map(f32::to_bits)),
            Over::Bytes => [None, None],
        };
        let fixed = plan.fixed();
        let pairs = || self.fixed.iter().zip(&fixed);
        [bits(self.from), bits(self.to)] == ends
            && (&self.over, &self.output) == (&plan.over_name(), &plan.output_name())
            && self.fixed.len() == fixed.len()
            && pairs().all(|((name, mine), (other, theirs))| name == other && mine.0.to_bits() == theirs.0.to_bits())
    }

    /// Its inputs as options of the command line.
    #[must_use]
    pub fn options(&self) -> String {
        let (Some(Exact(from)), Some(Exact(to))) = (self.from, self.to) else { return String::new() };
        let fixed: String = self.fixed.iter().map(|(name, Exact(x))| format!(" --set {name}={x}")).collect();
        format!(" --over {} --from {from} --to {to}{fixed} --output {}", self.over, self.output)
    }

    /// The inputs in blocks.
    #[must_use]
    pub const fn span(&self) -> Span {
        Span { inputs: self.inputs, block: self.block }
    }

    /// What differs in another sweep's: `density: 0.01 there, 0.02 here`.
    #[must_use]
    pub fn differences(&self, other: &Self, [mine, others]: [&str; 2]) -> Vec<String> {
        let (a, b) = (leaves(self), leaves(other));
        let names = a.iter().chain(&b).map(|(name, _)| name.as_str());
        let mut seen: Vec<&str> = vec![];
        for name in names {
            if !seen.contains(&name) {
                seen.push(name);
            }
        }
        let of = |leaves: &[(String, String)], name: &str| {
            leaves.iter().find(|(other, _)| other == name).map_or("nothing".to_owned(), |(_, value)| value.clone())
        };
        seen.into_iter()
            .map(|name| (name, of(&a, name), of(&b, name)))
            .filter(|(_, a, b)| a != b)
            .map(|(name, a, b)| format!("{name} is {a} {mine} and {b} {others}"))
            .collect()
    }
}

/// A description's values by name.
fn leaves(description: &Description) -> Vec<(String, String)> {
    let exact = |Exact(x): Exact| format!("{x} (0x{:08x})", x.to_bits());
    let Description { formula, over, from, to, fixed, output, unit, stage, adapter, profile, shader, inputs, block } =
        description.clone();
    let mut leaves: Vec<(String, String)> = [("formula", formula), ("over", over)].map(|(k, v)| (k.into(), v)).into();
    leaves.extend([("from", from), ("to", to)].into_iter().filter_map(|(name, x)| Some((name.into(), exact(x?)))));
    leaves.extend(fixed.into_iter().map(|(name, x)| (name, exact(x))));
    let rest = [
        ("output", output),
        ("unit", unit),
        ("stage", stage),
        ("adapter", adapter.name),
        ("device", adapter.device),
        ("backend", adapter.backend),
        ("driver", adapter.driver),
        ("profile", profile),
        ("the shader's text", shader),
        ("inputs", inputs.to_string()),
        ("block", block.to_string()),
    ];
    leaves.extend(rest.map(|(name, value)| (name.to_owned(), value)));
    leaves
}

/// A sweep's file.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// [`SCHEMA`].
    pub schema: String,
    /// What is swept.
    pub sweep: Description,
    /// Which part of it, as `2/8`.
    pub shard: String,
    /// Blocks of that part that are done, the first ones.
    pub done: u64,
    /// Blocks of that part.
    pub blocks: u64,
    /// How long that took.
    pub seconds: f64,
    /// What was found.
    pub statistics: Statistics,
    /// A hash of all above.
    #[serde(default)]
    checksum: String,
}

/// What is wrong with a sweep's file.
#[derive(Debug, thiserror::Error)]
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

impl Document {
    /// A sweep of which nothing is done.
    #[must_use]
    pub fn new(sweep: Description, shard: Shard) -> Self {
        let blocks = sweep.span().blocks_of(shard);
        Self {
            schema: SCHEMA.into(),
            sweep,
            shard: name_of(shard),
            done: 0,
            blocks,
            seconds: 0.0,
            statistics: Statistics::default(),
            checksum: String::new(),
        }
    }

    /// Which part of the sweep it is.
    ///
    /// # Panics
    /// Never of one that was read, whose shard was checked.
    #[must_use]
    pub fn shard(&self) -> Shard {
        shard_of(&self.shard).expect("a document is made with a shard")
    }

    /// Whether every block is done.
    #[must_use]
    pub const fn is_finished(&self) -> bool {
        self.done == self.blocks
    }

    /// The file's text.
    ///
    /// # Errors
    /// Where it is no JSON, which cannot be.
    pub fn to_json(&self) -> serde_json::Result<String> {
        let signed = Self { checksum: self.hash()?, ..self.clone() };
        Ok(serde_json::to_string_pretty(&signed)? + "\n")
    }

    fn hash(&self) -> serde_json::Result<String> {
        let unsigned = Self { checksum: String::new(), ..self.clone() };
        Ok(hash(serde_json::to_string(&unsigned)?.as_bytes()))
    }

    /// Reads a file's text.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let value: Value = serde_json::from_str(text).map_err(|error| format!("not JSON: {error}"))?;
        if value["schema"] != SCHEMA {
            let schema = value["schema"].as_str().unwrap_or("none").to_owned();
            return Err(format!("its schema is {schema}; expected {SCHEMA}"));
        }
        let document: Self = serde_json::from_value(value).map_err(|error| error.to_string())?;
        if document.hash().ok().as_deref() != Some(&document.checksum) {
            return Err("its checksum does not hold".into());
        }
        document.problem().map_or(Ok(document), Err)
    }

    /// What does not add up.
    fn problem(&self) -> Option<String> {
        let Some(shard) = shard_of(&self.shard) else {
            return Some(format!("`{}` is no shard", self.shard));
        };
        let span = self.sweep.span();
        let is_cut_so = (1..=1 << 32).contains(&span.inputs) && span == Span::of(span.inputs);
        if !is_cut_so || self.blocks != span.blocks_of(shard) || self.done > self.blocks {
            return Some(format!("{} of {} blocks cannot be done of {} inputs", self.done, self.blocks, span.inputs));
        }
        if self.statistics.inputs != span.inputs_of(shard, self.done) {
            let (done, inputs) = (self.done, span.inputs_of(shard, self.done));
            return Some(format!("{done} blocks have {inputs} inputs, and it counts {}", self.statistics.inputs));
        }
        self.statistics.problem()
    }

    /// Reads a file.
    ///
    /// # Errors
    /// Where it cannot be read, or is not what was written.
    pub fn read(path: &Path) -> Result<Self, DocumentError> {
        let bytes = std::fs::read(path)
            .map_err(|error| DocumentError::Unreadable { path: path.into(), message: error.to_string() })?;
        let text = String::from_utf8(bytes).map_err(|_| "not UTF-8".to_owned());
        text.and_then(|text| Self::parse(&text))
            .map_err(|message| DocumentError::Damaged { path: path.into(), message })
    }

    /// Reads a checkpoint of the sweep that is about to be made; `None` where there is no file.
    ///
    /// # Errors
    /// Where it cannot be read, is damaged, or is another sweep's.
    pub fn resume(path: &Path, sweep: &Description, shard: Shard) -> Result<Option<Self>, DocumentError> {
        if !path.try_exists().unwrap_or(true) {
            return Ok(None);
        }
        let found = Self::read(path)?;
        let mut differences = found.sweep.differences(sweep, ["there", "here"]);
        if found.shard() != shard {
            differences.push(format!("shard is {} there and {} here", found.shard, name_of(shard)));
        }
        if differences.is_empty() {
            return Ok(Some(found));
        }
        Err(DocumentError::Another { path: path.into(), differences })
    }

    /// Writes the file beside its place first, so that what stands there is whole at any moment.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), DocumentError> {
        let unwritable = |message: String| DocumentError::Unwritable { path: path.into(), message };
        let mut beside = path.as_os_str().to_owned();
        beside.push(format!(".{}.tmp", std::process::id()));
        let beside = PathBuf::from(beside);
        let text = self.to_json().map_err(|error| unwritable(error.to_string()))?;
        let written = std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, path));
        written.map_err(|error| {
            let _ = std::fs::remove_file(&beside);
            unwritable(error.to_string())
        })
    }

    /// The results of every shard as one.
    ///
    /// # Errors
    /// Where they are not the shards of one sweep, each finished and each once.
    pub fn merge(parts: &[(PathBuf, Self)]) -> Result<Self, DocumentError> {
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
        let count = first.shard().count;
        for (path, part) in rest {
            let (a, b) = (format!("in {}", first_path.display()), format!("in {}", path.display()));
            let differences = first.sweep.differences(&part.sweep, [&a, &b]);
            if !differences.is_empty() {
                return no_whole(format!("these are results of different sweeps: {}", differences.join("; ")));
            }
            if part.shard().count != count {
                let (first, part) = (&first.shard, &part.shard);
                return no_whole(format!("shards {first} {a} and {part} {b} overlap: expected all of the same number"));
            }
        }
        let mut whole = Self::new(first.sweep.clone(), Shard::WHOLE);
        let mut by_index: BTreeMap<u64, &PathBuf> = BTreeMap::new();
        for (path, part) in parts {
            if let Some(other) = by_index.insert(part.shard().index, path) {
                let (a, b, shard) = (other.display(), path.display(), &part.shard);
                return no_whole(format!("{a} and {b} overlap: both are shard {shard}"));
            }
            whole.statistics.add(part.statistics.clone());
            whole.seconds += part.seconds;
        }
        let has_blocks = |index: &u64| first.sweep.span().blocks_of(Shard { index: *index, count }) > 0;
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

/// FNV-1a of 64 bits: against damage and mix-ups, not against forgery.
fn hash(bytes: &[u8]) -> String {
    let hash = bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    format!("fnv1a:{hash:016x}")
}

#[cfg(test)]
mod tests {
    use super::super::statistics::tests::seen;
    use super::*;
    use crate::arithmetic::profile::WGSL;
    use crate::select::catalogue;
    use crate::subject::Subject;
    use crate::sweep::Asked;

    /// Five blocks of fog, of which one input fails.
    fn document(shard: Shard) -> Document {
        let catalogue = catalogue();
        let asked = Asked { from: Some(1.0), to: Some(1.002), ..Asked::default() };
        let plan = Plan::new(&catalogue, "fog/exp", &asked).expect("a plan");
        let shaders = Shaders::built_in().expect("the built-in shaders are valid");
        let sweep = Description::new(&plan, &Subject::embedded().identity, &WGSL, &shaders);
        let mut document = Document::new(sweep, shard);
        document.done = document.blocks;
        let inputs = document.sweep.span().inputs_of(shard, document.done);
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
        let back = Document::parse(&text).expect("it is whole");
        assert_eq!(back.to_json().expect("JSON"), text);
        assert_eq!(back.statistics, document.statistics);
        assert_eq!(back.statistics.worst, Some(seen(1.001, 9.0)));
    }

    #[test]
    fn files_whose_counts_do_not_add_up_are_refused_though_their_checksum_holds() {
        type Change = (&'static str, fn(&mut Document));
        let change: &[Change] = &[
            ("histogram", |d| d.statistics.histogram.count(1.0)),
            ("verdicts", |d| d.statistics.passed -= 1),
            ("blocks have", |d| d.done -= 1),
            ("cannot be done", |d| d.done += 1),
            ("cannot be done", |d| d.blocks += 1),
            ("cannot be done", |d| d.sweep.block = 0),
            ("cannot be done", |d| d.sweep.block = u64::MAX),
            ("is no shard", |d| d.shard = "3/2".into()),
        ];
        for (says, change) in change {
            let mut document = document(Shard::WHOLE);
            change(&mut document);
            let message = Document::parse(&document.to_json().expect("JSON")).err().unwrap_or_default();
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
            let read = String::from_utf8(bytes).ok().and_then(|text| Document::parse(&text).ok());
            let differs = read.is_some_and(|read| read.to_json().expect("JSON") != text);
            assert!(!differs, "byte {at} of {text}");
        }
    }

    #[test]
    fn shards_that_have_no_block_are_not_missed() {
        let count = NonZeroU64::new(8).expect("not 0");
        let parts: Vec<(PathBuf, Document)> =
            (0..5).map(|index| (PathBuf::from(format!("{index}.json")), document(Shard { index, count }))).collect();
        assert_eq!(parts[0].1.sweep.span().blocks(), 5);
        let merged = Document::merge(&parts).expect("they are all");
        assert_eq!((merged.statistics.inputs, merged.statistics.failed), (merged.sweep.inputs, 5));
        let missing = Document::merge(&parts[1..]).expect_err("one is missing").to_string();
        assert_eq!(missing, "there is no result of shard 1/8");
    }
}
