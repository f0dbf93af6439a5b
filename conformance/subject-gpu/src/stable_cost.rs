//! What stable forms cost beside naive ones.

use super::kernel::kernel;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::report::Cost;
use lightmeter_gpu::{Clock, Gpu, GpuError, RepeatPipeline, Rung, Shaders};
use std::collections::BTreeMap;

/// Turns that a cost is the median of.
const TURNS: usize = 15;
/// Workgroups of a turn: some four million evaluations.
const GROUPS: u32 = 2048;
/// Random cases that are evaluated in turn.
const COST_ROWS: u64 = 1024;

/// Measures a stable form against its naive ones, in turns.
pub(super) fn stable_costs(
    member: &Member,
    rivals: &BTreeMap<&'static str, Member>,
    (gpu, adapter): (&Gpu, &str),
    shaders: &Shaders,
    seed: u64,
) -> Result<Vec<Cost>, GpuError> {
    let mut rows = vec![];
    for k in 0..COST_ROWS {
        member.inputs(CaseRef::Random(k), seed, &mut rows);
    }
    let kernel_of = |member: &Member| Ok(kernel(shaders, member)?.expect("arithmetic has a shader function"));
    let own = kernel_of(member)?;
    let Ok(idle) = RepeatPipeline::idle(gpu, &own, &rows)? else { return Ok(vec![]) };
    let Ok(stable) = RepeatPipeline::new(gpu, shaders, &own, Rung::F32, &rows)? else { return Ok(vec![]) };
    let clock = Clock::wall(None);
    let time = |pipeline: &RepeatPipeline| {
        let reading = pipeline.time(gpu, &clock, GROUPS)?;
        let seconds = reading.seconds().expect("the clock on the wall goes forward");
        Ok::<_, GpuError>(seconds / (f64::from(GROUPS) * f64::from(RepeatPipeline::EVALUATIONS)))
    };
    let mut costs = vec![];
    for (id, rival) in rivals {
        let rival = kernel_of(rival)?;
        let Ok(naive) = RepeatPipeline::new(gpu, shaders, &rival, Rung::F32, &rows)? else { continue };
        for warm in [&idle, &stable, &naive] {
            time(warm)?;
        }
        let turns: Vec<[f64; 3]> =
            (0..TURNS).map(|_| Ok([time(&idle)?, time(&stable)?, time(&naive)?])).collect::<Result<_, GpuError>>()?;
        let sorted = |of: &dyn Fn(&[f64; 3]) -> f64| {
            let mut all: Vec<f64> = turns.iter().map(of).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let median_ns = |of: &dyn Fn(&[f64; 3]) -> f64| sorted(of)[TURNS / 2] * 1e9;
        let ratios = sorted(&|[_, stable, naive]| stable / naive);
        costs.push(Cost {
            formula: member.spec.id.clone(),
            naive: (*id).into(),
            adapter: adapter.to_owned(),
            stable_ns: median_ns(&|[idle, stable, _]| stable - idle),
            naive_ns: median_ns(&|[idle, _, naive]| naive - idle),
            idle_ns: median_ns(&|[idle, ..]| *idle),
            ratio: ratios[TURNS / 2],
            quartiles: [ratios[TURNS / 4], ratios[TURNS - 1 - TURNS / 4]],
        });
    }
    Ok(costs)
}
