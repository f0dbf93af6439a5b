//! Functions that compute the same, each in an arithmetic of its own: what they give for the same rows of numbers, and how long
//! they take, in turns.

use super::Bench;
use super::ended::{BenchError, unless_stopped};
use super::errors::Gathered;
use super::turns::{self, Entry, Laps};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::bench::{BenchRow, Errors};
use lightmeter_gpu::{Clock, ClockReading, Gpu, GpuError, Kernel, RepeatPipeline, Rung, Shaders};
use lightmeter_judge::{Outcome, judge};
use lightmeter_subject_gpu::kernel;
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;

/// Rows that a processor evaluates at once, and those that a device does in turn.
const TIMED_ROWS: usize = 1024;
/// The most workgroups at once.
const MOST_GROUPS: u32 = 1 << 14;

/// The least part of a time that is told after reading the inputs is taken off.
const LEAST_SHARE: f64 = 0.2;

/// Rows of inputs, and the formula that each is of.
pub(super) struct Sample<'a> {
    of: Vec<&'a Member>,
    inputs: Vec<f32>,
    /// The first of them are random; the others hard, or near a hard one.
    random: usize,
    stride: usize,
}

impl<'a> Sample<'a> {
    /// Random rows of members, which share inputs, in turn, and every hard case of theirs with those near it.
    pub(super) fn new(members: &[&'a Member], cases: u64, seed: u64) -> Self {
        let stride = members[0].spec.input_len();
        let (mut of, mut inputs) = (vec![], vec![]);
        let count = members.len() as u64;
        for k in 0..cases {
            let member = members[usize::try_from(k % count).unwrap_or_default()];
            member.inputs(CaseRef::Random(k / count), seed, &mut inputs);
            of.push(member);
        }
        let random = of.len();
        for &member in members {
            for place in 0..member.spec.hard.len() {
                let near = (0..member.near()).map(|k| CaseRef::Near(place, k));
                for case in std::iter::once(CaseRef::Hard(place)).chain(near) {
                    member.inputs(case, seed, &mut inputs);
                    of.push(member);
                }
            }
        }
        Self { of, inputs, random, stride }
    }

    /// The rows, each with the formula that it belongs to.
    pub(super) fn rows(&self) -> impl Iterator<Item = (&'a Member, &[f32])> {
        self.of.iter().copied().zip(self.inputs.chunks_exact(self.stride))
    }

    /// Random rows.
    pub(super) const fn random(&self) -> usize {
        self.random
    }

    /// Hard rows.
    pub(super) fn hard(&self) -> usize {
        self.of.len() - self.random
    }

    /// As shaders are handed them: selectors first.
    fn selected(&self) -> Vec<f32> {
        let mut selected = vec![];
        for (member, row) in self.rows() {
            selected.extend(member.spec.selectors.iter().map(|&code| f32::from_bits(code)));
            selected.extend_from_slice(row);
        }
        selected
    }

    /// What a formula gives for each row: the row's own, or another that takes the same inputs.
    fn evaluated<T: Copy + Send>(
        &self,
        formula: Option<&Member>,
        blank: T,
        evaluate: impl Fn(&Member, &[f32], &mut [T]) + Sync,
    ) -> Vec<T> {
        let outputs = formula.unwrap_or(self.of[0]).spec.output_len();
        let mut out = vec![blank; outputs * self.of.len()];
        out.par_chunks_mut(outputs)
            .zip(self.inputs.par_chunks(self.stride))
            .zip(&self.of)
            .for_each(|((out, row), of)| evaluate(formula.unwrap_or(of), row, out));
        out
    }

    fn references(&self, formula: Option<&Member>) -> Vec<f64> {
        self.evaluated(formula, 0.0, |member, row, out| member.formula.reference(row, out))
    }

    fn intervals(&self, formula: Option<&Member>, profile: &Profile) -> Vec<Accept> {
        self.evaluated(formula, Accept::ANY, |member, row, out| {
            member.formula.interval(row, profile, out);
        })
    }
}

/// A function in an arithmetic.
#[derive(Clone)]
pub(super) struct Contender<'a> {
    /// The row's name.
    pub(super) name: String,
    /// What it is.
    pub(super) what: String,
    /// Its formula, where that is another than the rows'.
    pub(super) formula: Option<&'a Member>,
    /// What evaluates it.
    pub(super) on: On,
    /// Why it is not there.
    pub(super) unavailable: Option<String>,
}

/// What evaluates a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum On {
    /// The device, in an arithmetic of the ladder.
    Device(Rung),
    /// The device, by the shader that is measured beside the suite's own.
    Own,
    /// One core of this processor.
    Processor(Arithmetic),
}

/// An arithmetic of the suite's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arithmetic {
    F32,
    F64,
    Accept,
}

impl Arithmetic {
    pub(super) const ALL: [Self; 3] = [Self::F32, Self::F64, Self::Accept];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::F32 => "cpu-f32",
            Self::F64 => "cpu-f64",
            Self::Accept => "cpu-accept",
        }
    }

    pub(super) const fn what(self) -> &'static str {
        match self {
            Self::F32 => "the reference's formulas in f32, on one core of the processor",
            Self::F64 => "the f64 reference itself, which errors are told against, on one core",
            Self::Accept => "the interval of all legal values, on one core; its error is how far that reaches",
        }
    }
}

impl On {
    /// The rung that a device computes it in.
    const fn rung(self) -> Option<Rung> {
        match self {
            Self::Device(rung) => Some(rung),
            Self::Own => Some(Rung::F32),
            Self::Processor(_) => None,
        }
    }

    /// Whether what it gives is meant to be the formula itself, and must be legal.
    const fn claims_exact(self) -> bool {
        match self {
            Self::Device(rung) => rung.is_exact(),
            Self::Own | Self::Processor(_) => true,
        }
    }
}

/// A contender on a device, compiled.
struct Compiled {
    pipeline: RepeatPipeline,
    values: Vec<f64>,
    milliseconds: f64,
}

/// Judges and times all contenders of a group. Times on the device are compared with the contender named `baseline`, times on the processor
/// with the processor's own f32. Also returns a description of the rows that errors and times were taken over.
pub(super) fn contest(
    bench: &Bench<'_>,
    sample: &Sample<'_>,
    contenders: &[Contender<'_>],
    baseline: &str,
) -> Result<(Vec<BenchRow>, String), BenchError> {
    let exact = sample.references(None);
    let mut rows: Vec<BenchRow> = contenders.iter().map(blank).collect();
    let (mut compiled, mut idle) = (vec![], None);
    let selected = sample.selected();
    for (contender, row) in contenders.iter().zip(&mut rows) {
        unless_stopped(bench.stop)?;
        let ready = match (contender.on.rung(), &row.unavailable, bench.gpu) {
            (Some(rung), None, Some(gpu)) => {
                let member = contender.formula.unwrap_or(sample.of[0]);
                let shaders = bench.shaders_of(contender);
                match kernel(shaders, member)? {
                    None => Err("no shader function evaluates it: it is fixed hardware's".into()),
                    Some(kernel) => {
                        let timed = &selected[..sample.random.min(TIMED_ROWS) * kernel.inputs];
                        if idle.is_none() {
                            idle = RepeatPipeline::idle(gpu, &kernel, timed)?.ok();
                        }
                        compile((bench, shaders), gpu, &kernel, rung, timed, &selected)?
                    }
                }
            }
            (Some(_), None, None) => Err("the embedded implementation has no shaders".into()),
            _ => {
                compiled.push(None);
                continue;
            }
        };
        match ready {
            Ok(ready) => compiled.push(Some(ready)),
            Err(reason) => {
                row.unavailable = Some(reason);
                compiled.push(None);
            }
        }
    }
    for ((contender, row), compiled) in contenders.iter().zip(&mut rows).zip(&compiled) {
        if row.unavailable.is_none() && bench.setting.judges {
            let values = compiled.as_ref().map(|compiled| compiled.values.as_slice());
            judge_row(bench, row, contender, sample, &exact, values);
            row.compile_ms = compiled.as_ref().map(|compiled| compiled.milliseconds);
        }
    }
    let idle = time_rows(bench, sample, contenders, &compiled, idle.as_ref(), baseline, &mut rows)?;
    Ok((rows, work(sample, idle)))
}

/// What errors and times are over; `idle` is what reading the inputs takes, and whether it is taken off.
fn work(sample: &Sample<'_>, idle: Option<(f64, bool)>) -> String {
    let mut work = format!("{} random rows, and {} hard ones and near them", sample.random(), sample.hard());
    match idle {
        None => {}
        Some((ns, true)) => {
            work += &format!("; reading the inputs and the loop, {ns:.2} ns on the device, are taken off")
        }
        Some((ns, false)) => {
            work += &format!(
                "; reading the inputs and the loop, {ns:.2} ns on the device, are nearly all of it: not taken off"
            );
        }
    }
    work
}

fn blank(contender: &Contender<'_>) -> BenchRow {
    BenchRow {
        name: contender.name.clone(),
        what: contender.what.clone(),
        claims_exact: contender.on.claims_exact(),
        unavailable: contender.unavailable.clone(),
        as_f32: false,
        disqualified: None,
        random: None,
        hard: None,
        rounding: None,
        time: None,
        compile_ms: None,
    }
}

fn compile(
    (bench, shaders): (&Bench<'_>, &Shaders),
    gpu: &Gpu,
    kernel: &Kernel,
    rung: Rung,
    timed: &[f32],
    selected: &[f32],
) -> Result<Result<Compiled, String>, GpuError> {
    let start = Instant::now();
    let pipeline = match RepeatPipeline::new(gpu, shaders, kernel, rung, timed)? {
        Ok(pipeline) => pipeline,
        Err(reason) => return Ok(Err(reason)),
    };
    if !bench.setting.judges {
        return Ok(Ok(Compiled { pipeline, values: vec![], milliseconds: 1e3 * start.elapsed().as_secs_f64() }));
    }
    let words = pipeline.outputs(gpu, selected)?;
    let milliseconds = 1e3 * start.elapsed().as_secs_f64();
    let number = |parts: &[u32]| parts.iter().map(|&bits| f64::from(f32::from_bits(bits))).sum();
    let values = words.chunks_exact(rung.parts()).map(number).collect();
    Ok(Ok(Compiled { pipeline, values, milliseconds }))
}

/// A formula in f32, ready to be timed over random rows; `None` where the adapter has no compute stage.
pub(super) fn timed(bench: &Bench<'_>, gpu: &Gpu, member: &Member) -> Result<Option<RepeatPipeline>, GpuError> {
    let Some(kernel) = kernel(bench.shaders, member)? else { return Ok(None) };
    let rows = Sample::new(&[member], TIMED_ROWS as u64, bench.setting.seed).selected();
    Ok(RepeatPipeline::new(gpu, bench.shaders, &kernel, Rung::F32, &rows)?.ok())
}

/// Errors against the exact values of the rows' formulas, and against those of the contender's own; whether all is legal.
fn judge_row(
    bench: &Bench<'_>,
    row: &mut BenchRow,
    contender: &Contender<'_>,
    sample: &Sample<'_>,
    exact: &[f64],
    values: Option<&[f64]>,
) {
    let own = contender.formula.map(|formula| sample.references(Some(formula)));
    let own_exact = own.as_deref().unwrap_or(exact);
    let legal = sample.intervals(bench.judged_by(contender, sample.of[0]).or(contender.formula), &bench.profile);
    let found: Vec<f64> = match (contender.on, values) {
        (On::Device(_) | On::Own, Some(values)) => values.to_vec(),
        (On::Device(_) | On::Own, None) => return,
        (On::Processor(Arithmetic::F32), _) => {
            let embedded = sample.evaluated(contender.formula, 0.0, |member, row, out: &mut [f32]| {
                member.formula.embedded(row, out);
            });
            embedded.into_iter().map(f64::from).collect()
        }
        (On::Processor(Arithmetic::F64), _) => own_exact.to_vec(),
        (On::Processor(Arithmetic::Accept), _) => legal.iter().zip(own_exact).map(|(l, x)| farthest(l, *x)).collect(),
    };
    let outputs = exact.len() / sample.of.len();
    let split = sample.random * outputs;
    let errors = |found: &[f64], exact: &[f64], legal: &[Accept]| -> Option<Errors> {
        let mut gathered = Gathered::default();
        for (k, ((value, exact), legal)) in found.iter().zip(exact).zip(legal).enumerate() {
            // What a shader does not give is no error.
            if sample.of[0].missing.contains(&(k % outputs)) {
                continue;
            }
            // Where the formula promises nothing of f32, a value of it is no error; of other arithmetics it may be.
            let is_promised = !legal.is_any() || contender.on != On::Processor(Arithmetic::Accept);
            if is_promised { gathered.add(*value, *exact) } else { gathered.skip() }
        }
        gathered.errors()
    };
    row.random = errors(&found[..split], &exact[..split], &legal[..split]);
    row.hard = errors(&found[split..], &exact[split..], &legal[split..]);
    row.rounding = own.as_ref().and_then(|own| errors(&found[..split], &own[..split], &legal[..split]));
    if row.claims_exact {
        row.disqualified = wrong(sample, &found, own_exact, &legal);
    }
}

impl<'a> Bench<'a> {
    /// The shaders that a contender is of.
    fn shaders_of(&self, contender: &Contender<'_>) -> &'a Shaders {
        self.own.filter(|_| contender.on == On::Own).map_or(self.shaders, |own| &own.shaders)
    }

    /// Where a stable form is used in place of a contender's function, the catalogue's own formula for that stable form, against which it
    /// must be judged: the legal values of the published formula may not include the stable form's results.
    fn judged_by<'b>(&self, contender: &Contender<'_>, of: &'b Member) -> Option<&'b Member>
    where
        'a: 'b,
    {
        let spec = &contender.formula.unwrap_or(of).spec;
        let function = match contender.on {
            On::Device(Rung::Stable) => self.shaders.stable_form(spec.function)?,
            _ => return None,
        };
        // Techniques are not in the catalogue; the first of a group may be the stable form of another.
        self.catalogue.iter().chain([of]).find(|member| {
            let own = &member.spec;
            own.function == function && own.inputs == spec.inputs && own.outputs == spec.outputs
        })
    }
}

/// The end of the interval that is farther from a value.
fn farthest(legal: &Accept, exact: f64) -> f64 {
    if legal.high() - exact > exact - legal.low() { legal.high() } else { legal.low() }
}

/// What is not legal, in words.
fn wrong(sample: &Sample<'_>, found: &[f64], exact: &[f64], legal: &[Accept]) -> Option<String> {
    let is_wrong = |k: usize| {
        #[expect(clippy::cast_possible_truncation, reason = "what an f32 is made of it must be legal")]
        let bits = (found[k] as f32).to_bits();
        judge(bits, exact[k], &legal[k]).outcome == Outcome::Fail
    };
    let wrong: Vec<usize> = (0..found.len()).filter(|&k| is_wrong(k)).collect();
    let &first = wrong.first()?;
    let outputs = found.len() / sample.of.len();
    let (member, row) = sample.rows().nth(first / outputs)?;
    Some(format!(
        "{} of {} values are outside what {} permits: {} in place of {} for {row:?}",
        wrong.len(),
        found.len(),
        member.spec.id,
        found[first],
        exact[first],
    ))
}

fn time_rows(
    bench: &Bench<'_>,
    sample: &Sample<'_>,
    contenders: &[Contender<'_>],
    compiled: &[Option<Compiled>],
    idle: Option<&RepeatPipeline>,
    baseline: &str,
    rows: &mut [BenchRow],
) -> Result<Option<(f64, bool)>, BenchError> {
    let clock = &bench.clock;
    let (mut entries, mut places) = (vec![], vec![]);
    if let (Some(gpu), Some(idle)) = (bench.gpu, idle) {
        entries.push(device_entry(gpu, clock, idle));
        places.push(None);
    }
    for (k, contender) in contenders.iter().enumerate() {
        match (contender.on, &compiled[k], bench.gpu) {
            (On::Device(_) | On::Own, Some(compiled), Some(gpu)) => {
                entries.push(device_entry(gpu, clock, &compiled.pipeline))
            }
            (On::Processor(arithmetic), ..) if rows[k].unavailable.is_none() => {
                entries.push(processor_entry(sample, contender.formula, arithmetic, &bench.profile));
            }
            _ => continue,
        }
        places.push(Some(k));
    }
    let mut laps = turns::measure(&mut entries, bench.setting.effort, bench.stop)?;
    let clocks: Vec<&'static str> = entries.iter().map(Entry::clock).collect();
    drop(entries);
    let mut idle_is = None;
    if places.first().is_some_and(Option::is_none) {
        let device: Vec<usize> = (1..laps.len()).filter(|&k| clocks[k] != "processor").collect();
        let net: Vec<Laps> = device.iter().map(|&k| turns::net(&laps[k], &laps[0])).collect();
        // A difference of nearly equal times says nothing.
        let is_told = device.iter().zip(&net).all(|(&k, net)| turns::share(net, &laps[k]) > LEAST_SHARE);
        let ns = turns::time(clocks[0], &laps[0], None).map(|time| time.ns);
        idle_is = ns.map(|ns| (ns, is_told));
        if is_told {
            for (&k, net) in device.iter().zip(net) {
                laps[k] = net;
            }
        }
    }
    let place_of = |name: &str| places.iter().position(|place| place.is_some_and(|k| rows[k].name == name));
    let of_processor = Arithmetic::F32.name();
    let processor = place_of(of_processor).or_else(|| place_of(&format!("{baseline} {of_processor}")));
    let base = place_of(baseline);
    for ((place, own), clock) in places.iter().zip(&laps).zip(&clocks) {
        let Some(k) = *place else { continue };
        // The processor's one core beside all that a device has says more of the machine than of the arithmetic.
        let base = if *clock == "processor" { processor } else { base };
        let against = base.filter(|&base| places[base] != Some(k)).map(|base| &laps[base]);
        rows[k].time = turns::time(clock, own, against);
        if rows[k].time.is_none() {
            rows[k].unavailable = Some(turns::reason(own).into());
        }
    }
    Ok(idle_is)
}

fn device_entry<'a>(gpu: &'a Gpu, clock: &'a Clock, pipeline: &'a RepeatPipeline) -> Entry<'a> {
    let units = f64::from(RepeatPipeline::EVALUATIONS);
    Entry::new(clock.kind().name(), units, MOST_GROUPS, move |groups| pipeline.time(gpu, clock, groups))
}

fn processor_entry<'a>(
    sample: &'a Sample<'_>,
    formula: Option<&'a Member>,
    arithmetic: Arithmetic,
    profile: &'a Profile,
) -> Entry<'a> {
    let count = sample.random.min(TIMED_ROWS);
    let outputs = sample.of[0].spec.output_len();
    #[expect(clippy::cast_precision_loss, reason = "a thousand rows")]
    let units = count as f64;
    Entry::new("processor", units, 1 << 20, move |amount| {
        let (mut f32s, mut f64s, mut intervals) = (vec![0.0; outputs], vec![0.0; outputs], vec![Accept::ANY; outputs]);
        let start = Instant::now();
        for _ in 0..amount {
            for (member, row) in sample.rows().take(count) {
                let (formula, row) = (&formula.unwrap_or(member).formula, black_box(row));
                match arithmetic {
                    Arithmetic::F32 => formula.embedded(row, black_box(&mut f32s)),
                    Arithmetic::F64 => formula.reference(row, black_box(&mut f64s)),
                    Arithmetic::Accept => formula.interval(row, profile, black_box(&mut intervals)),
                }
            }
        }
        Ok(ClockReading::Seconds(start.elapsed().as_secs_f64()))
    })
}
