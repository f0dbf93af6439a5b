//! Prints the certificate of the reference as a page, and whatever does not hold to standard error.

#![expect(clippy::print_stdout, reason = "the page is what it is for")]

use lightmeter_tests::certificate::{CASES, certify, page, problems};
use std::process::ExitCode;

fn main() -> ExitCode {
    let findings = certify(CASES);
    let problems = problems(&findings);
    print!("{}", page(&findings));
    for problem in &problems {
        eprintln!("{problem}");
    }
    if problems.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
