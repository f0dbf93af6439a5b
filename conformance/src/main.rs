//! scratch
use lightmeter::*;
fn main() {
    let adapters = lightmeter_gpu::adapters();
    for a in &adapters { println!("{} | {} | {} | {}", a.name, a.device, a.backend, a.driver); }
    let args: Vec<String> = std::env::args().skip(1).collect();
    let want = &args[0];
    let mut subjects: Vec<_> = adapters.iter().filter(|a| want == "all" || &a.name == want).map(|a| subject::Subject::open(a).unwrap()).collect();
    if want == "cpu" { subjects.push(subject::Subject::embedded()); }
    let options = run::Options { filter: filter::Filter::new(&args[2..]).unwrap(), cases: args[1].parse().unwrap(), seed: 1, shard: select::Shard::WHOLE, profile: &arithmetic::profile::WGSL, shaders: lightmeter_gpu::Shaders::built_in().unwrap(), rerun: String::new() };
    let report = match run::run(&mut subjects, &options, &mut run::Silent) { Ok(r) => r, Err(e) => { println!("{e}"); return } };
    for g in &report.groups { println!("{:38} {:12} {:14} cases {:7} verdicts {:8} failed {:6} skip {} ind {} ulp {:.2} margin {:.3} {:.2}s {:?} {:?}", g.id, g.adapter, g.stage, g.totals.cases, g.totals.verdicts, g.totals.failed, g.totals.skipped, g.totals.indeterminate, g.error_ulp_max.0, g.margin_max.0, g.seconds, g.worst, g.problem.as_deref().or(g.skip_reason)); }
    for f in report.failures.iter().take(30) { println!("{}", serde_json::to_string(f).unwrap()); }
    println!("{:?} {:?} {}", report.totals, report.timing, report.seconds);
}
