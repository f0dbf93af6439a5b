//! How a result is written, and how the command ends that it is of: the same for `run`, `gate` and `merge`.

use super::options::{ReportFormat, Required};
use super::signals::status_of;
use super::{Status, say};
use lightmeter::document::Document as _;
use lightmeter::document::report::Report;
use lightmeter::files::lines;
use lightmeter::report::{github, html, junit, text};

/// A result in a format.
pub(crate) fn written(report: &Report, format: ReportFormat, style: text::Style) -> anyhow::Result<String> {
    Ok(match format {
        ReportFormat::Json => report.to_json()?,
        ReportFormat::Junit => junit::to_string(report)?,
        ReportFormat::Github => github::annotations(report),
        ReportFormat::Html => html::of_report(report),
        ReportFormat::Text => {
            let mut out = String::new();
            text::write(report, style, &mut out)?;
            lines(&out).into_owned()
        }
    })
}

/// How a command ends with a result. A renderer that broke off, or wrote what is no answer, ends with 4 whatever else is right.
pub(crate) fn status(report: &Report, required: Required) -> Status {
    match &report.interrupted {
        Some(interrupted) if !(interrupted.at_first_failure && report.is_broken()) => return status_of(interrupted),
        _ => {}
    }
    if report.is_broken() {
        return Status::Device;
    }
    if report.is_failed() {
        return Status::Failed;
    }
    if report.has_judged() {
        return required.status(report.coverage());
    }
    let why = match (&report.renderer, report.totals.cases) {
        (Some(_), _) => "the renderer declares or answers none of these cases, or skips them all",
        (None, 0) => "no deviation concerns the adapter",
        (None, _) => "every case was skipped or indeterminate",
    };
    say(&format!("error: nothing was judged: {why}"));
    Status::Nothing
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter::document::report::Interrupted;

    #[test]
    fn a_run_that_a_device_ended_says_so_and_ends_with_4() {
        let mut report = Report::empty(1, "wgsl".into(), vec![], vec![]);
        let interrupted =
            |signal| Some(Interrupted { signal, ..Interrupted::by_device("blend/max", &"the device failed") });
        report.interrupted = interrupted(Some(signal_hook::consts::SIGTERM));
        assert_eq!(status(&report, Required::default()), Status::Terminated);
        report.interrupted = interrupted(None);
        assert_eq!(status(&report, Required::default()), Status::Device);
        let text = written(&report, ReportFormat::Text, text::Style::default()).expect("a string takes it");
        assert!(text.contains("interrupted: ") && text.contains("✗ "), "{text}");
    }
}
