//! How time grows with the number of cases.

use super::contest::timed;
use super::ended::BenchError;
use super::turns::{self, Effort, Entry};
use super::{Bench, fit};
use lightmeter_catalogue::select::catalogue;
use lightmeter_document::bench::{Scaling, ScalingPoint};
use lightmeter_gpu::RepeatPipeline;

/// The formula that is evaluated.
const FORMULA: &str = "lighting/blinn";
/// The most workgroups at once.
const MOST: u32 = 1 << 13;

/// Time against the number of evaluations in one submission.
pub(super) fn cases(bench: &Bench<'_>) -> Result<Vec<Scaling>, BenchError> {
    let Some(gpu) = bench.gpu else { return Ok(vec![]) };
    let catalogue = catalogue();
    let Some(member) = catalogue.iter().find(|member| member.spec.id == FORMULA) else { return Ok(vec![]) };
    let Some(pipeline) = timed(bench, gpu, member)? else { return Ok(vec![]) };
    let (clock, pipeline) = (&bench.clock, &pipeline);
    let most = if bench.setting.quick { MOST / 8 } else { MOST };
    let steps: Vec<u32> = std::iter::successors(Some(1), |&step| (step < most).then_some(step * 4)).collect();
    let mut entries: Vec<Entry<'_>> = steps
        .iter()
        .map(|&groups| Entry::new(clock.kind().name(), 1.0, 1, move |_| pipeline.time(gpu, clock, groups)))
        .collect();
    let laps = turns::measure(&mut entries, Effort { seconds: 0.0, ..bench.setting.effort }, bench.stop)?;
    drop(entries);
    let points: Vec<ScalingPoint> = steps
        .iter()
        .zip(&laps)
        .filter_map(|(&groups, laps)| {
            let time = turns::time(bench.clock.kind().name(), laps, None)?;
            let work = u64::from(groups) * u64::from(RepeatPipeline::EVALUATIONS);
            Some(ScalingPoint { work, ns: time.ns, quartiles_ns: time.quartiles_ns })
        })
        .collect();
    Ok(vec![Scaling {
        id: "cases".into(),
        what: format!("{FORMULA} in f32, by the number of evaluations in a dispatch"),
        unit: "evaluations".into(),
        clock: bench.clock.kind().name().into(),
        fit: fit::fit(&points),
        points,
        unavailable: vec![],
    }])
}
