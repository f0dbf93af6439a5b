//! `lightmeter effects`.

use super::Status;
use super::options::Format;
use clap::Args;
use lightmeter::document::Document as _;
use lightmeter::document::effects::{DrawEffects, EffectReason, EffectsDocument, SCHEMA};
use lightmeter::files::lines;
use lightmeter::scene::{Loaded, load};
use lightmeter_scene::effects::{Called, Reason, ReasonSubject, effects};
use lightmeter_scene::frame::Frame;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Print what each draw of a scene calls for and why, light by light, and what it does not.
#[derive(Debug, Args)]
pub(crate) struct Effects {
    /// A scene's file, or the name of a built-in scene
    scene: PathBuf,
    /// How it is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Effects {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let loaded = load::scene(&self.scene)?;
        let called = effects(&loaded.frame);
        let text = match self.format {
            Format::Text => lines(&in_words(&loaded, &called)?).into_owned(),
            Format::Json => document(&loaded, &called).to_json()?,
        };
        self.format.emit(&text, self.out.as_deref())?;
        Ok(Status::Success)
    }
}

fn in_words(loaded: &Loaded, called: &[Called]) -> anyhow::Result<String> {
    let mut text = format!("{}: {}\n{}\n", loaded.name, loaded.title, loaded.shows);
    for (draw, called) in loaded.frame.draws.iter().zip(called) {
        writeln!(text, "\n{}: {}", draw.name, called.effects)?;
        for (heading, is) in [("called for", true), ("not called for", false)] {
            let reasons: Vec<&Reason> = called.reasons.iter().filter(|reason| reason.called == is).collect();
            if !reasons.is_empty() {
                writeln!(text, "  {heading}")?;
            }
            for reason in reasons {
                writeln!(text, "    {:<24} {}", subject(&loaded.frame, reason.subject), reason.why)?;
            }
        }
    }
    Ok(text)
}

fn document(loaded: &Loaded, called: &[Called]) -> EffectsDocument {
    let frame = &loaded.frame;
    let light = |place: usize| frame.lights[place].name.clone();
    let reason = |reason: &Reason| {
        let (effect, light) = match reason.subject {
            ReasonSubject::Effect(effect) => (Some(effect.name().into()), None),
            ReasonSubject::Light(place) => (None, Some(light(place))),
        };
        EffectReason { effect, light, called: reason.called, why: reason.why.clone() }
    };
    let draws = frame.draws.iter().zip(called).map(|(draw, called)| DrawEffects {
        draw: draw.name.clone(),
        effects: called.effects.iter().map(|effect| effect.name().into()).collect(),
        lights: called.lights.iter().map(|&place| light(place)).collect(),
        reasons: called.reasons.iter().map(reason).collect(),
    });
    EffectsDocument {
        schema: SCHEMA.into(),
        scene: loaded.name.clone(),
        title: loaded.title.clone(),
        draws: draws.collect(),
    }
}

fn subject(frame: &Frame, subject: ReasonSubject) -> String {
    match subject {
        ReasonSubject::Effect(effect) => effect.name().to_owned(),
        ReasonSubject::Light(place) => format!("light `{}`", frame.lights[place].name),
    }
}
