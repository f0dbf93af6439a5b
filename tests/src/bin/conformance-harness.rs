//! The conformance tests as a program, which tests of them start with variables and arguments of their own.

use std::process::ExitCode;

fn main() -> ExitCode {
    lightmeter_tests::harness::main(None)
}
