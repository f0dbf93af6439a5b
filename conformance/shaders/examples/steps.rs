//! Prints the steps of files.
#![allow(clippy::print_stdout, missing_docs)]
use lightmeter_shaders::read::ReadOptions;
use std::path::Path;
fn main() {
    let start = std::time::Instant::now();
    let reviewer = lightmeter_shaders::Reviewer::new().unwrap_or_else(|error| panic!("{error}"));
    println!("forms: {:.3} s", start.elapsed().as_secs_f64());
    for file in std::env::args().skip(1) {
        let start = std::time::Instant::now();
        println!("=== {file}");
        match reviewer.review(Path::new(&file), &ReadOptions::default()) {
            Ok(review) => {
                println!("{} read by {}", review.language, review.reader);
                review.notes.iter().for_each(|note| println!("  note: {note}"));
                for step in &review.steps {
                    println!(
                        "{:>4} {:<16} {:?}:{:<26} {}   [{}] also {:?}",
                        step.line, step.kind, step.verdict, step.name, step.sentence, step.code, step.also
                    );
                }
                for sum in &review.sums {
                    println!("  {} = {}  then {:?}", sum.output, sum.terms.join(" + "), sum.then);
                }
            }
            Err(error) => println!("NOT READ: {error}"),
        }
        println!("  {:.3} s", start.elapsed().as_secs_f64());
    }
}
