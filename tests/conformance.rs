//! The conformance suite, a test for each formula, group of blend states, depth test, table of special values, scene and named
//! deviation: `cargo test conformance`. What it is made of stands in `lightmeter_tests::harness`.

use std::process::ExitCode;

fn main() -> ExitCode {
    lightmeter_tests::harness::main(Some(concat!(env!("CARGO_TARGET_TMPDIR"), "/lightmeter-failures").into()))
}
