//! Results as JUnit XML: of a run a suite for each adapter, and a test for each group and stage; of a gate a test for each formula and scene.

use super::Level;
use super::against::Against;
use super::text;
use crate::gate::{GateStyle, sentence, told, whole};
use lightmeter_document::gate::GateReport;
use lightmeter_document::run::{Group, Report};
use quick_junit::{NonSuccessKind, Report as Document, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::time::Duration;

/// The document.
///
/// # Errors
/// Where it cannot be written as XML.
pub fn to_string(report: &Report) -> Result<String, SerializeError> {
    let mut document = Document::new("lightmeter");
    for adapter in &report.adapters {
        let mut suite = TestSuite::new(adapter.name.as_str());
        for group in report.groups.iter().filter(|group| group.adapter == adapter.name) {
            let mut case = TestCase::new(format!("{} ({})", group.id, group.place()), status(group, report));
            case.set_classname(group.id.replace('/', ".")).set_time(Duration::from_secs_f64(group.seconds));
            suite.add_test_case(case);
        }
        for deviation in report.deviations.iter().filter(|deviation| deviation.adapter == adapter.name) {
            let mut status = TestCaseStatus::success();
            if !deviation.still_needed {
                status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_message("unexpected pass: the deviation is no longer needed");
            }
            suite.add_test_case(TestCase::new(format!("deviation/{}", deviation.name), status));
        }
        document.add_test_suite(suite);
    }
    let against = Against::of_run(report).lines();
    if !against.is_empty() {
        let mut suite = TestSuite::new("compared");
        for (title, what) in against {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_message(what);
            suite.add_test_case(TestCase::new(title, status));
        }
        document.add_test_suite(suite);
    }
    if let Some(interrupted) = &report.interrupted {
        let mut suite = TestSuite::new("interrupted");
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_message(format!("{} was under way: {}", interrupted.under_way, interrupted.message));
        suite.add_test_case(TestCase::new("interrupted", status));
        document.add_test_suite(suite);
    }
    document.to_string()
}

fn status(group: &Group, report: &Report) -> TestCaseStatus {
    if let Some(reason) = group.skip_reason.as_deref() {
        let mut status = TestCaseStatus::skipped();
        status.set_message(reason);
        return status;
    }
    if group.totals.failed == 0 && group.problem.is_none() {
        return TestCaseStatus::success();
    }
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    let mut message = format!("{} of {} verdicts failed", group.totals.failed, group.totals.verdicts);
    for more in group.explanation.iter().chain(&group.problem) {
        message += &format!("; {more}");
    }
    status.set_message(message);
    let mut description = String::new();
    let of_group = |id: &str| id.strip_prefix(&group.id).is_some_and(|rest| rest.starts_with('/'));
    for failure in report
        .failures
        .iter()
        .filter(|f| f.adapter == group.adapter && f.stage == group.stage && f.target == group.target && of_group(&f.id))
    {
        // Writing to a string does not fail.
        let _ = text::failure(failure, Level::Verbose, &mut description);
    }
    for (shader, place) in
        report.shader.iter().flat_map(|shader| shader.places(&group.id).map(move |place| (shader, place)))
    {
        description += &format!("{}\n", text::made_at(shader, place));
    }
    status.set_description(description);
    status
}

/// A gate's result: a test for each formula and scene.
///
/// # Errors
/// Where it cannot be written as XML.
pub fn of_gate(report: &GateReport) -> Result<String, SerializeError> {
    let mut document = Document::new("lightmeter gate");
    let mut suite = TestSuite::new(format!("{} {}", report.renderer.name, report.renderer.version));
    for group in &report.groups {
        let mut status = TestCaseStatus::success();
        if group.is_failed() {
            status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_message(sentence(group));
            let mut description = String::new();
            // Writing to a string does not fail.
            let _ = told(group, &report.failures, &GateStyle::default(), &mut description);
            status.set_description(description);
        } else if group.asked == group.skipped {
            status = TestCaseStatus::skipped();
            status.set_message(group.reason.clone().unwrap_or_default());
        }
        let mut case = TestCase::new(group.name(), status);
        case.set_classname(group.id.split('/').next().unwrap_or_default());
        if let Some(source) = &group.source {
            case.extra.insert("file".into(), source.file.as_str().into());
            case.extra.extend(source.line.map(|line| ("line".into(), line.to_string().into())));
        }
        suite.add_test_case(case);
    }
    if !report.warnings.is_empty() {
        suite.set_system_out(report.warnings.join("\n"));
    }
    for (title, what) in whole(report) {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_message(what);
        suite.add_test_case(TestCase::new(title, status));
    }
    document.add_test_suite(suite);
    document.to_string()
}
