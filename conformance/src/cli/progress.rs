//! How far long work has come, on standard error where that is a terminal.

use super::observed::happens;
use super::terminal;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lightmeter::browser::{PageGroup, PageState, Session};
use lightmeter::document::event::{Event, Observer, Stop};
use lightmeter::files::lines;
use lightmeter::report::Level;
use lightmeter::report::live::Live;
use std::sync::Arc;

/// A bar for work that is counted in these units.
pub(crate) struct Bar {
    pub(crate) bar: ProgressBar,
    /// Tells what fails as soon as it is judged, and where.
    live: Option<(Live, Stream)>,
    /// Set to stop at the first failure.
    fail_fast: Option<Stop>,
    failed: u64,
    /// The browser that is judged, whose page shows how far the work has come.
    session: Option<Arc<Session>>,
    /// Whether nothing was told yet.
    is_silent: bool,
}

/// Where results are told while work goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stream {
    /// Standard output, where results are text for people.
    Output,
    /// Standard error, where they are for programs, or go to a file.
    Error,
}

impl Bar {
    pub(crate) fn new(length: Option<u64>, unit: &str) -> Self {
        let bar = ProgressBar::with_draw_target(length, ProgressDrawTarget::stderr());
        let template =
            format!("{{bar:24}} {{percent:>3}} % of {{human_len}} {unit}, {{eta}} left  {{prefix}}{{wide_msg}}");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        Self { bar, live: None, fail_fast: None, failed: 0, session: None, is_silent: true }
    }

    /// The same, that tells what fails as soon as it is judged.
    pub(crate) fn live(self, stream: Stream) -> Self {
        Self { live: Some((Live::new(terminal::level()), stream)), ..self }
    }

    /// The same, that shows a browser's page how far the work has come.
    pub(crate) fn shown_to(self, session: Option<Arc<Session>>) -> Self {
        Self { session, ..self }
    }

    /// The same, that ends the work once something fails.
    pub(crate) fn fail_fast(self, stop: Option<Stop>) -> Self {
        Self { fail_fast: stop, ..self }
    }
}

impl Observer for Bar {
    fn see(&mut self, event: &Event<'_>) {
        happens(event.name(), event);
        if let Some(session) = &self.session {
            let picture = session.show(pictures(event));
            session.tell(|told| note(told, event, picture));
        }
        match event {
            Event::Begun(work) => self.bar.set_length(*work),
            Event::Group(id) => self.bar.set_message((*id).to_owned()),
            Event::Advanced(work) => self.bar.inc(*work),
            Event::Judged { group, is_scouted, .. } => {
                let is_failed = group.is_failed();
                if is_failed && !is_scouted {
                    self.failed += 1;
                    let groups = if self.failed == 1 { "group fails" } else { "groups fail" };
                    self.bar.set_prefix(format!("{} {groups}  ", self.failed));
                }
                if let Some(stop) = self.fail_fast.as_ref().filter(|_| is_failed) {
                    stop.at_first_failure();
                }
                let Some((live, stream)) = &mut self.live else { return };
                let text = lines(&live.text(event)).into_owned();
                if text.is_empty() {
                    return;
                }
                // An empty line parts a failure from what stands above it, and here nothing does.
                let is_first = std::mem::take(&mut self.is_silent) && terminal::level() == Level::Quiet;
                let text = if is_first { text.trim_start_matches('\n') } else { &text };
                // Whoever does not read them any more reads the result's exit code.
                let _ = self.bar.suspend(|| match stream {
                    Stream::Output => terminal::write(text, &mut std::io::stdout().lock()),
                    Stream::Error => terminal::write(text, &mut std::io::stderr().lock()),
                });
            }
        }
    }
}

/// Reference, result and error map of an image that failed, as files. What cannot be read is not shown: the report has it.
fn pictures(event: &Event<'_>) -> Vec<Vec<u8>> {
    let Event::Judged { group, is_scouted: false, .. } = event else { return vec![] };
    let files = group.image.iter().flat_map(|image| &image.files);
    let pictures: Vec<Vec<u8>> = files.filter_map(|file| std::fs::read(file).ok()).collect();
    if pictures.len() == 3 { pictures } else { vec![] }
}

/// Notes for a page what is seen of a run.
fn note(told: &mut PageState, event: &Event<'_>, picture: Option<usize>) {
    match event {
        Event::Begun(work) => told.of = *work,
        Event::Group(id) => told.says = format!("{id} is judged."),
        Event::Advanced(work) => told.done += work,
        Event::Judged { is_scouted: true, .. } => {}
        Event::Judged { group, .. } => {
            let target = group.target.iter().map(|target| format!(", {target}"));
            let stage = std::iter::once(group.stage.to_string()).chain(target).collect();
            let failed = group.totals.failed;
            told.failed += u64::from(group.is_failed());
            told.groups.push(PageGroup {
                id: group.id.clone(),
                stage,
                verdicts: group.totals.verdicts,
                failed,
                why: group.cause().or_else(|| group.problem()).or_else(|| group.reasons().next()),
                picture,
            });
        }
    }
}
