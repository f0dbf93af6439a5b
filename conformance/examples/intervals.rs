//! What the intervals of formulas take, on all cores: the least that judging can take, since every answer is held against one.
//!
//! ```text
//! cargo run --example intervals -- 'lighting/*' fog --cases 1000000
//! ```
//!
//! Inputs are drawn as a gate draws them, and timed apart. `lightmeter gate PACK ANSWERS` of the same cases does both, and reads, judges and
//! counts besides.

#![expect(clippy::print_stdout, reason = "the times are what it is for")]

use anyhow::ensure;
use clap::Parser;
use lightmeter::arithmetic::Accept;
use lightmeter::arithmetic::profile::WGSL;
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
}

/// Adds what a chunk of cases takes: to draw its inputs, and to evaluate these as intervals.
fn time(member: &Member, chunk: &[CaseRef], took: &mut [Duration; 2]) {
    let begun = Instant::now();
    let rows: Vec<Vec<f32>> = chunk
        .par_chunks(TASK)
        .map(|cases| {
            let mut rows = Vec::with_capacity(cases.len() * member.spec.input_len());
            cases.iter().for_each(|&case| member.inputs(case, 1, &mut rows));
            rows
        })
        .collect();
    took[0] += begun.elapsed();
    let begun = Instant::now();
    rows.par_iter().for_each(|rows| {
        let mut out = [Accept::ANY; 16];
        let out = &mut out[..member.spec.output_len()];
        for inputs in rows.chunks_exact(member.spec.input_len()) {
            member.formula.interval(black_box(inputs), &WGSL, out);
            black_box(&*out);
        }
    });
    took[1] += begun.elapsed();
}

fn main() -> anyhow::Result<()> {
    let cli = Cli::parse();
    let members = catalogue();
    let (mut took, mut count) = ([Duration::ZERO; 2], 0);
    for selected in select(&members, &Filter::new(&cli.filter)?, cli.cases, Shard::WHOLE) {
        let cases: Vec<CaseRef> = selected.cases().collect();
        count += cases.len();
        cases.chunks(CHUNK).for_each(|chunk| time(&members[selected.member], chunk, &mut took));
    }
    ensure!(count > 0, "no case matches; expected globs of formulas, such as 'lighting/*' fog");
    let [drawn, evaluated] = took.map(|took| took.as_secs_f64());
    println!("{count} cases: inputs drawn in {drawn:.2} s, intervals in {evaluated:.2} s");
    Ok(())
}
