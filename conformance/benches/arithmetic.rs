//! What the processor's side takes, by piece of work: cases drawn and evaluated, values and pixels judged, colours stored.
//! On one thread, in items a second.

mod workload;

use divan::Bencher;
use divan::counter::ItemsCount;

fn main() {
    workload::on_one_thread();
    divan::main();
}

/// The pieces of work, each with the item that is counted.
fn names() -> Vec<String> {
    workload::all().into_iter().map(|work| format!("{} of a {}", work.name, work.item)).collect()
}

#[divan::bench(args = names())]
fn work(bencher: Bencher<'_, '_>, name: &str) {
    let is_it =
        |work: &workload::Workload| name.strip_prefix(&work.name).is_some_and(|rest| rest.starts_with(" of a "));
    let mut work = workload::all().into_iter().find(is_it).expect("the name is of a piece of work");
    bencher.counter(ItemsCount::new(work.items)).bench_local(|| work.round());
}
