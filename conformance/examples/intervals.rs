//! What the intervals of formulas take, on all cores: the least that judging can take, since every answer is held against one.
//!
//! ```text
//! cargo run --example intervals -- 'lighting/*' fog --cases 1000000
//! ```
//!
//! `--digest` tells whether two builds agree: it is the same where each input and each end of an interval has the same
//! bits, apart from the sign of 0.
//!
//! Inputs are drawn as a gate draws them, and timed apart. `lightmeter gate PACK ANSWERS` of the same cases does both, and reads, judges and
//! counts besides.

#![expect(clippy::print_stdout, reason = "the times are what it is for")]

use anyhow::ensure;
use clap::Parser;
use lightmeter::arithmetic::Accept;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::cases::mix;
use lightmeter::filter::Filter;
use lightmeter::select::{CaseRef, Member, Shard, catalogue, select};
use rayon::prelude::*;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Cases that are in memory at once, as in a run.
const CHUNK: usize = 1 << 16;
/// Cases of a task.
const TASK: usize = 1 << 10;

/// The seconds that the intervals of formulas take.
#[derive(Debug, Parser)]
struct Cli {
    /// Globs of formulas
    filter: Vec<String>,
    /// Random cases of each formula
    #[arg(long, default_value_t = 256)]
    cases: u64,
    /// Print a number that follows from the bits of all inputs and intervals
    #[arg(long)]
    digest: bool,
}

/// Takes bits into a digest.
const fn mixed(digest: u64, bits: u64) -> u64 {
    mix(digest.rotate_left(5) ^ bits)
}

/// What follows from the bits of rows of inputs and of their intervals.
fn digest(member: &Member, rows: &[f32]) -> u64 {
    let mut out = [Accept::ANY; 16];
    let out = &mut out[..member.spec.output_len()];
    rows.chunks_exact(member.spec.input_len()).fold(0, |digest, inputs| {
        let digest = inputs.iter().fold(digest, |digest, x| mixed(digest, x.to_bits().into()));
        member.formula.promised_interval(member.spec.kind, inputs, &WGSL, out);
        out.iter()
            .flat_map(|legal| [legal.low(), legal.high()])
            .fold(digest, |digest, x| mixed(digest, (x + 0.0).to_bits()))
    })
}

/// Adds what a chunk of cases takes: to draw its inputs, which are returned, and to evaluate these as intervals.
fn time(member: &Member, chunk: &[CaseRef], took: &mut [Duration; 2]) -> Vec<Vec<f32>> {
    let begun = Instant::now();
    let rows: Vec<Vec<f32>> = chunk
        .par_chunks(TASK)
        .map(|cases| {
            let (draws, mut rows) = (member.draws(1), Vec::with_capacity(cases.len() * member.spec.input_len()));
            cases.iter().for_each(|&case| draws.inputs(case, &mut rows));
            rows
        })
        .collect();
    took[0] += begun.elapsed();
    let begun = Instant::now();
    rows.par_iter().for_each(|rows| {
        let stride = member.spec.input_len();
        let mut out = vec![Accept::ANY; rows.len() / stride * member.spec.output_len()];
        member.formula.intervals(black_box(rows), stride, &WGSL, &mut out);
        black_box(&out);
    });
    took[1] += begun.elapsed();
    rows
}

fn main() -> anyhow::Result<()> {
    let cli = Cli::parse();
    let members = catalogue();
    let (mut took, mut count, mut all) = ([Duration::ZERO; 2], 0, 0);
    for selected in select(&members, &Filter::new(&cli.filter)?, cli.cases, Shard::WHOLE) {
        let cases: Vec<CaseRef> = selected.cases().collect();
        count += cases.len();
        let member = &members[selected.member];
        for chunk in cases.chunks(CHUNK) {
            let rows = time(member, chunk, &mut took);
            if cli.digest {
                let digests: Vec<u64> = rows.par_iter().map(|rows| digest(member, rows)).collect();
                all = digests.into_iter().fold(all, mixed);
            }
        }
    }
    ensure!(count > 0, "no case matches; expected globs of formulas, such as 'lighting/*' fog");
    let [drawn, evaluated] = took.map(|took| took.as_secs_f64());
    println!("{count} cases: inputs drawn in {drawn:.2} s, intervals in {evaluated:.2} s");
    if cli.digest {
        println!("digest of inputs and intervals: {all:016x}");
    }
    Ok(())
}
