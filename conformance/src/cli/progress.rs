//! How far long work has come, on standard error where that is a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lightmeter::document::event::{Event, Observer};
use lightmeter::files::lines;
use lightmeter::report::live::Live;
use std::io::Write as _;

/// A bar for work that is counted in these units.
pub(crate) struct Bar {
    pub(crate) bar: ProgressBar,
    /// Tells what fails as soon as it is judged, and where.
    live: Option<(Live, Stream)>,
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
        let template = format!("{{bar:30}} {{human_pos}}/{{human_len}} {unit}  {{elapsed}}  {{msg}}");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        Self { bar, live: None }
    }

    /// The same, that tells what fails as soon as it is judged.
    pub(crate) fn live(self, stream: Stream) -> Self {
        Self { live: Some((Live::default(), stream)), ..self }
    }
}

impl Observer for Bar {
    fn see(&mut self, event: &Event<'_>) {
        match event {
            Event::Begun(work) => self.bar.set_length(*work),
            Event::Group(id) => self.bar.set_message((*id).to_owned()),
            Event::Advanced(work) => self.bar.inc(*work),
            Event::Judged { .. } => {
                let Some((live, stream)) = &mut self.live else { return };
                let text = lines(&live.text(event)).into_owned();
                if text.is_empty() {
                    return;
                }
                // Whoever does not read them any more reads the result's exit code.
                let _ = self.bar.suspend(|| match stream {
                    Stream::Output => std::io::stdout().lock().write_all(text.as_bytes()),
                    Stream::Error => std::io::stderr().lock().write_all(text.as_bytes()),
                });
            }
        }
    }
}
