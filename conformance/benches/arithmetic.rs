//! What the processor's side takes, by piece of work: cases drawn and evaluated, values and pixels judged, colours stored.
//! On one thread, in items a second.

mod workload;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn workloads(c: &mut Criterion) {
    workload::on_one_thread();
    for mut work in workload::all() {
        let (group, name) = work.name.rsplit_once('/').expect("a name has a group");
        let mut group = c.benchmark_group(group);
        group.throughput(Throughput::Elements(work.items));
        group.bench_function(format!("{name} of a {}", work.item), |b| b.iter(|| work.round()));
        group.finish();
    }
}

criterion_group!(benches, workloads);
criterion_main!(benches);
