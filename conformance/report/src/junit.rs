//! Results as JUnit XML: a suite for each subject, a test for each group, and a suite of what is wrong with the whole.

use super::Level;
use super::against::wrong;
use super::text::{self, Style, is_told_by, sentence};
use lightmeter_document::report::{Group, Report, ShaderReview, StepVerdict};
use quick_junit::{NonSuccessKind, Report as Document, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::time::Duration;

/// The document.
///
/// # Errors
/// Where it cannot be written as XML.
pub fn to_string(report: &Report) -> Result<String, SerializeError> {
    let mut document = Document::new("lightmeter");
    for adapter in &report.adapters {
        let name = report.renderer.as_ref().map_or_else(
            || adapter.name.clone(),
            |renderer| format!("{} {}", renderer.identity.name, renderer.identity.version),
        );
        let mut suite = TestSuite::new(name);
        for group in report.groups.iter().filter(|group| group.adapter == adapter.name) {
            suite.add_test_case(case(group, report));
        }
        for deviation in report.deviations.iter().filter(|deviation| deviation.adapter == adapter.name) {
            let mut status = TestCaseStatus::success();
            if !deviation.still_needed {
                status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_message("unexpected pass: the deviation is no longer needed");
            }
            suite.add_test_case(TestCase::new(format!("deviation/{}", deviation.name), status));
        }
        let warnings = report.renderer.iter().flat_map(|renderer| renderer.warnings.iter().cloned());
        let said: Vec<String> = warnings.chain(report.notes.iter().map(ToString::to_string)).collect();
        if !said.is_empty() {
            suite.set_system_out(said.join("\n"));
        }
        document.add_test_suite(suite);
    }
    let wrong = wrong(report);
    if !wrong.is_empty() {
        let mut suite = TestSuite::new("whole");
        for (title, what) in wrong {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
            status.set_message(what);
            suite.add_test_case(TestCase::new(title, status));
        }
        document.add_test_suite(suite);
    }
    document.to_string()
}

/// The document of shaders: a suite for each file, a test for each step, and a suite `whole` for notes on all of them.
///
/// # Errors
/// Where it cannot be written as XML.
pub fn of_shaders(shaders: &[ShaderReview], is_strict: bool, notes: &[String]) -> Result<String, SerializeError> {
    let mut document = Document::new("lightmeter");
    for shader in shaders {
        let mut suite = TestSuite::new(shader.file.as_str());
        let refused = shader.refused.iter().map(|own| format!("line {}: {}", own.line, own.says));
        for what in shader.unread.iter().cloned().chain(refused) {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
            status.set_message(what);
            suite.add_test_case(TestCase::new("file", status));
        }
        for step in &shader.steps {
            let mut status = TestCaseStatus::success();
            if step.is_wrong(is_strict) {
                status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_message(format!("{}: {}", step.name, step.says()));
            }
            let mut case = TestCase::new(format!("{} {}", step.line, step.kind), status);
            case.set_classname(shader.file.as_str());
            case.extra.insert("file".into(), shader.file.as_str().into());
            case.extra.insert("line".into(), step.line.to_string().into());
            if step.verdict != StepVerdict::Right && !step.is_wrong(is_strict) {
                case.set_system_out(format!("{}: {}", step.name, step.says()));
            }
            suite.add_test_case(case);
        }
        if !shader.notes.is_empty() {
            suite.set_system_out(shader.notes.join("\n"));
        }
        document.add_test_suite(suite);
    }
    if !notes.is_empty() {
        let mut suite = TestSuite::new("whole");
        suite.set_system_out(notes.join("\n"));
        document.add_test_suite(suite);
    }
    document.to_string()
}

fn case(group: &Group, report: &Report) -> TestCase {
    let is_asked = group.asked().is_some();
    let name = if is_asked { group.name() } else { format!("{} ({})", group.id, group.place()) };
    let mut case = TestCase::new(name, status(group, report));
    case.set_classname(group.id.replace('/', ".")).set_time(Duration::from_secs_f64(group.seconds));
    if let Some(source) = &group.source {
        case.extra.insert("file".into(), source.file.as_str().into());
        case.extra.extend(source.line.map(|line| ("line".into(), line.to_string().into())));
    }
    case
}

fn status(group: &Group, report: &Report) -> TestCaseStatus {
    if !group.is_failed() {
        let skipped = group.asked().filter(|counts| counts.totals.asked == counts.totals.skipped);
        let reason = skipped.map(|counts| counts.reason.clone().unwrap_or_default());
        let Some(reason) = reason.or_else(|| group.skip_reason.as_ref().map(ToString::to_string)) else {
            return TestCaseStatus::success();
        };
        let mut status = TestCaseStatus::skipped();
        status.set_message(reason);
        return status;
    }
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_message(sentence(group));
    let mut description = String::new();
    let failures = report.failures.iter().filter(|failure| is_told_by(group, failure));
    // Writing to a string does not fail.
    if group.asked().is_some() {
        let _ = text::asked(group, &failures.collect::<Vec<_>>(), Style::default(), &mut description);
    } else {
        failures.for_each(|failure| {
            let _ = text::failure(failure, Level::Verbose, &mut description);
        });
    }
    for (shader, place) in
        report.shader.iter().flat_map(|shader| shader.places(&group.id).map(move |place| (shader, place)))
    {
        description += &format!("{}\n", text::made_at(shader, place));
    }
    status.set_description(description);
    status
}
