//! Instructions for each item of the workloads, counted by valgrind and held against the record, `benches/instructions.json`.
//!
//! The program runs itself under callgrind, which counts the instructions from one call of `between_workloads` to the next: a
//! round, then two rounds. Their difference is a round, without what counting costs. Nothing is timed, so that the load of the
//! machine is nothing to it.
//!
//! Counts are the compiler's, and for `f32` and memory the C library's. Where either is not the record's, nothing is compared, and
//! that is said. glibc chooses among its functions by the processor, and is told to take those that all have.

#![expect(clippy::print_stdout, reason = "the counts are what it is for")]

#[path = "../../conformance/benches/workload/mod.rs"]
mod workload;

use anyhow::{Context as _, bail};
use clap::Parser;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Instructions for each item of the processor's workloads, against the record.
#[derive(Debug, Parser)]
#[command(after_help = "Exit codes: 0 within the record · 1 outside · 2 bad usage or input · \
    3 valgrind is not here, or the record is another compiler's: nothing was compared")]
struct Cli {
    /// Write the record anew
    #[arg(long)]
    update: bool,
    /// Do the work that is counted
    #[arg(long, hide = true)]
    work: bool,
}

/// How far a count may be from the record's, either way. Counts of one program differ by 0.01 % at most (where a hash table's
/// seed is drawn), and by 0.1 % when it is built in another folder, with other features, or after a change elsewhere in the
/// same crates; twenty times that leaves room for a compiler that inlines otherwise.
const ALLOWANCE: f64 = 0.02;

/// What is committed.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Record {
    schema: String,
    made_by: MadeBy,
    /// Instructions for an item, by workload.
    instructions: BTreeMap<String, f64>,
}

const SCHEMA: &str = "lightmeter.instructions/1";

/// What decides on the instructions besides the source.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MadeBy {
    rustc: String,
    target: String,
    libc: String,
    /// The C compiler, which CORE-MATH is built by.
    cc: String,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    match cli.run() {
        Ok(code) => code.into(),
        Err(error) => {
            eprintln!("error: {error:#}");
            2.into()
        }
    }
}

impl Cli {
    fn run(&self) -> anyhow::Result<u8> {
        workload::on_one_thread();
        if self.work {
            work();
            return Ok(0);
        }
        if cfg!(not(debug_assertions)) {
            bail!("the record is of the profile that tests are built by: run it by ./x instructions");
        }
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../conformance/benches/instructions.json");
        let made_by = MadeBy::here()?;
        let Some(counts) = count()? else {
            eprintln!("instructions: NOT COUNTED: valgrind is not here (Debian: apt-get install valgrind)");
            return Ok(3);
        };
        if self.update {
            let record = Record { schema: SCHEMA.into(), made_by, instructions: counts };
            let json = serde_json::to_string_pretty(&record)? + "\n";
            std::fs::write(&path, json).with_context(|| format!("cannot write {}", path.display()))?;
            println!("{} counts recorded", record.instructions.len());
            return Ok(0);
        }
        let json = std::fs::read_to_string(&path)
            .with_context(|| format!("cannot read {}; ./x instructions --update writes it", path.display()))?;
        let record: Record = serde_json::from_str(&json).with_context(|| path.display().to_string())?;
        Ok(report(&record, &made_by, &counts))
    }
}

/// Prints every count beside the record's, then what is wrong. The exit code: 1 where something is, 3 where nothing can be compared.
fn report(record: &Record, made_by: &MadeBy, counts: &BTreeMap<String, f64>) -> u8 {
    println!("{:<50} {:<12} {:>10} {:>10}", "instructions of", "for a", "here", "record");
    for work in workload::all() {
        let count = counts.get(&work.name).copied().unwrap_or(f64::NAN);
        let beside = record.instructions.get(&work.name).map_or("none".into(), |was| {
            let percent = 100.0 * (count / was - 1.0);
            format!("{was:>10.1} {percent:>+7.2} %")
        });
        println!("{:<50} {:<12} {count:>10.1} {beside:>10}", work.name, work.item);
    }
    if record.made_by != *made_by {
        println!("instructions: NOT COMPARED: the record is of {}, these counts of {made_by}", record.made_by);
        println!("instructions: ./x instructions --update records these");
        return 3;
    }
    let problems = problems(&record.instructions, counts);
    for problem in &problems {
        println!("instructions: {problem}");
    }
    if problems.is_empty() {
        println!("instructions: {} workloads are within {:.0} % of the record", counts.len(), 100.0 * ALLOWANCE);
    } else {
        println!("instructions: where that is as it should be, ./x instructions --update renews the record");
    }
    u8::from(!problems.is_empty())
}

/// What is outside the record. A count that fell is too: the next rise would hide below the old one.
fn problems(record: &BTreeMap<String, f64>, counts: &BTreeMap<String, f64>) -> Vec<String> {
    let mut problems = vec![];
    for (name, count) in counts {
        let Some(was) = record.get(name) else {
            problems.push(format!("{name} is not in the record"));
            continue;
        };
        let change = count - was;
        if change.abs() > ALLOWANCE * was {
            let word = if change > 0.0 { "more" } else { "fewer: the record is stale" };
            let percent = 100.0 * (change / was).abs();
            problems.push(format!("{name} takes {count:.1} instructions for {was:.1}, {percent:.1} % {word}"));
        }
    }
    let gone = record.keys().filter(|name| !counts.contains_key(*name));
    problems.extend(gone.map(|name| format!("{name} is in the record and no workload")));
    problems
}

impl MadeBy {
    fn here() -> anyhow::Result<Self> {
        let about = output(Command::new("rustc").arg("-vV"))?;
        let field = |name: &str| about.lines().find_map(|line| line.strip_prefix(name)).unwrap_or("unknown").trim();
        let version = about.lines().next().unwrap_or("unknown").trim_start_matches("rustc ");
        let first_line = |command: &mut Command| {
            output(command).map_or("unknown".into(), |text| text.lines().next().unwrap_or("unknown").trim().to_owned())
        };
        Ok(Self {
            rustc: version.into(),
            target: field("host:").into(),
            libc: first_line(Command::new("getconf").arg("GNU_LIBC_VERSION")),
            cc: first_line(Command::new("cc").arg("--version")),
        })
    }
}

impl std::fmt::Display for MadeBy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "rustc {}, {}, {}, {}", self.rustc, self.target, self.libc, self.cc)
    }
}

fn output(command: &mut Command) -> anyhow::Result<String> {
    let output = command.output().with_context(|| format!("cannot run {command:?}"))?;
    if !output.status.success() {
        bail!("{command:?}: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Callgrind writes down what was counted, and begins anew, whenever this is called. It is known by its name.
#[inline(never)]
fn between_workloads(number: usize) {
    std::hint::black_box(number);
}

fn work() {
    for (number, mut work) in workload::all().into_iter().enumerate() {
        // What is done once alone: memory is fetched, features of the processor are asked for.
        work.round();
        between_workloads(number);
        work.round();
        between_workloads(number);
        work.round();
        work.round();
        between_workloads(number);
    }
}

/// The counts by workload; `None` where there is no valgrind.
fn count() -> anyhow::Result<Option<BTreeMap<String, f64>>> {
    if Command::new("valgrind").arg("--version").output().is_err() {
        return Ok(None);
    }
    let folder = Folder::new()?;
    let file = folder.0.join("counts");
    let mut callgrind = Command::new("valgrind");
    callgrind.args(["--tool=callgrind", "--combine-dumps=yes", "--dump-before=*between_workloads*"]);
    callgrind.arg(format!("--callgrind-out-file={}", file.display()));
    callgrind.arg(std::env::current_exe()?).arg("--work");
    // No environment, so that nothing of it is in the counts.
    callgrind.env_clear().envs(std::env::var_os("PATH").map(|path| ("PATH", path)));
    callgrind.env("GLIBC_TUNABLES", GENERIC);
    output(&mut callgrind).context(
        "valgrind cannot run the workloads; where it meets an instruction that it does not know, CORE-MATH was compiled for \
         another processor (.cargo/config.toml), and `cargo clean -p core-math-sys` lets it be compiled anew",
    )?;
    let parts = totals(&std::fs::read_to_string(&file)?)?;
    let workloads = workload::all();
    if parts.len() != 3 * workloads.len() + 1 {
        bail!("{} counts for {} workloads: valgrind did not see where they begin", parts.len(), workloads.len());
    }
    let counts = workloads.iter().zip(parts.chunks(3));
    let of_item = counts.map(|(work, parts)| {
        #[expect(clippy::cast_precision_loss, reason = "counts are far below 2⁵³")]
        let (round, items) = ((parts[2] - parts[1]) as f64, work.items as f64);
        // A tenth of an instruction is enough, and reads well.
        (work.name.clone(), (10.0 * round / items).round() / 10.0)
    });
    Ok(Some(of_item.collect()))
}

/// The functions of glibc for any processor of the target.
const GENERIC: &str =
    "glibc.cpu.hwcaps=-AVX,-AVX2,-AVX_Fast_Unaligned_Load,-AVX512F,-AVX512VL,-FMA,-FMA4,-ERMS,-SSE4_1,-SSE4_2,-SSSE3";

/// The total of each part of callgrind's file, in order.
fn totals(file: &str) -> anyhow::Result<Vec<u64>> {
    let totals = file.lines().filter_map(|line| line.strip_prefix("totals:"));
    totals.map(|total| total.trim().parse().with_context(|| format!("totals of callgrind: {total}"))).collect()
}

/// A folder for the time of a count.
struct Folder(PathBuf);

impl Folder {
    fn new() -> anyhow::Result<Self> {
        let path = std::env::temp_dir().join(format!("lightmeter-instructions-{}", std::process::id()));
        std::fs::create_dir(&path).with_context(|| path.display().to_string())?;
        Ok(Self(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What is left in a temporary folder harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter::cases::FAMILIES;

    fn counts(of: &[(&str, f64)]) -> BTreeMap<String, f64> {
        of.iter().map(|(name, count)| ((*name).to_owned(), *count)).collect()
    }

    #[test]
    fn every_family_has_a_workload_and_no_name_stands_twice() {
        let all = workload::all();
        for family in FAMILIES {
            for what in ["inputs", "reference", "f32", "accept"] {
                let is_it = |name: &str| name.starts_with(&format!("{family}/")) && name.ends_with(&format!("/{what}"));
                assert!(all.iter().any(|work| is_it(&work.name)), "{family} has no workload of {what}");
            }
        }
        let names: std::collections::BTreeSet<&str> = all.iter().map(|work| work.name.as_str()).collect();
        assert_eq!(names.len(), all.len());
    }

    #[test]
    fn the_record_is_of_these_workloads() {
        let record: Record =
            serde_json::from_str(include_str!("../../conformance/benches/instructions.json")).expect("it is valid");
        let recorded: Vec<&String> = record.instructions.keys().collect();
        let names: BTreeMap<String, ()> = workload::all().into_iter().map(|work| (work.name, ())).collect();
        assert_eq!(recorded, names.keys().collect::<Vec<_>>(), "./x instructions --update renews the record");
        assert_eq!(record.schema, SCHEMA);
    }

    /// Counts, and what is to be said of them.
    type Row<'a> = (&'a [(&'a str, f64)], &'a [&'a str]);

    #[test]
    fn what_is_outside_the_record_is_told() {
        let record = counts(&[("a", 1000.0), ("b", 10.0)]);
        let rows: [Row<'_>; 6] = [
            (&[("a", 1000.0), ("b", 10.0)], &[]),
            (&[("a", 1019.0), ("b", 10.1)], &[]),
            (&[("a", 981.0), ("b", 9.9)], &[]),
            (&[("a", 1021.0), ("b", 10.0)], &["a takes 1021.0 instructions for 1000.0, 2.1 % more"]),
            (
                &[("a", 900.0), ("b", 10.0)],
                &["a takes 900.0 instructions for 1000.0, 10.0 % fewer: the record is stale"],
            ),
            (&[("a", 1000.0), ("c", 1.0)], &["c is not in the record", "b is in the record and no workload"]),
        ];
        for (found, expected) in rows {
            assert_eq!(problems(&record, &counts(found)), expected, "{found:?}");
        }
    }

    #[test]
    fn totals_are_read_part_by_part() {
        let file = "version: 1\npart: 1\nsummary: 7\ntotals: 7\n\npart: 2\nfn=(1)\n3 9\ntotals: 12\n";
        assert_eq!(totals(file).expect("two parts"), [7, 12]);
        assert!(totals("totals: many").is_err());
    }
}
