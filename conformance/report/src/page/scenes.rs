//! The page on the built-in scenes: what each shows, which the caller hands over, and what a run found.

use lightmeter_document::Document as _;
use lightmeter_document::report::{EffectsCost, Group, Report};
use lightmeter_scene::effects::Effects;
use std::fmt::{Result, Write};
use std::ops::Deref;

/// Pictures side by side on the contact sheet.
pub const COLUMNS: usize = 6;

/// A run that scenes were judged in.
#[derive(Clone, Debug)]
pub struct SceneRun(Report);

impl Deref for SceneRun {
    type Target = Report;

    fn deref(&self) -> &Report {
        &self.0
    }
}

impl SceneRun {
    /// Reads a run's JSON.
    ///
    /// # Errors
    /// Where it is not the JSON of a run, or has no scene.
    pub fn read(json: &str) -> std::result::Result<Self, String> {
        let run = Self(Report::read(json).map_err(|error| error.to_string())?);
        if run.groups.iter().any(|group| group.image.is_some()) {
            Ok(run)
        } else {
            Err("it has no scene; make it by `lightmeter run 'scene/*' --adapter all --timing --format json`".into())
        }
    }

    fn group(&self, scene: &str, adapter: &str, stage: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.id == scene && group.adapter == adapter && group.stage == stage)
    }
}

/// A scene as the page tells it.
#[derive(Clone, Debug)]
pub struct ToldScene {
    /// Its name.
    pub name: String,
    /// What it is for.
    pub shows: String,
    /// Every effect that one of its draws calls for.
    pub effects: Effects,
}

/// The page in Markdown.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(run: &SceneRun, scenes: &[ToldScene], picture: Option<&str>, out: &mut impl Write) -> Result {
    writeln!(out, "# Scenes\n")?;
    writeln!(out, "Made by `./x run 'scene/*' --adapter all --timing --format json --out RUN.json` and")?;
    writeln!(
        out,
        "`./x page scenes RUN.json --out docs/scenes.md`. Each scene is a file in `conformance/catalogue/scenes/`.\n"
    )?;
    if let Some(picture) = picture {
        writeln!(out, "![Every scene by the reference, in the order of the table, {COLUMNS} in a row]({picture})\n")?;
    }
    for adapter in &run.adapters {
        writeln!(out, "* **{}**: {}, {}", adapter.name, adapter.device, adapter.driver)?;
    }
    writeln!(out, "\n## What each shows\n\n| scene | shows | called for |\n|---|---|---|")?;
    for ToldScene { name, shows, effects } in scenes {
        writeln!(out, "| {name} | {} | {effects} |", linked(shows))?;
    }
    judged(run, scenes, out)?;
    costs(run, scenes, out)
}

fn judged(run: &SceneRun, scenes: &[ToldScene], out: &mut impl Write) -> Result {
    writeln!(out, "\n## What a run found\n")?;
    writeln!(
        out,
        "Pixels outside what is legal, and the share of marked ones: those of which several outcomes are legal that"
    )?;
    writeln!(
        out,
        "differ by more than twice the widest of them. Positions are snapped to 1/256 pixel by llvmpipe, and to no"
    )?;
    writeln!(out, "coarser than 1/16 by any other.\n")?;
    table(run, scenes, "image", "skipped", out, |group| {
        let image = group.image.as_ref()?;
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        let share = 100.0 * image.marked as f64 / group.totals.cases.max(1) as f64;
        Some(format!("{} failed, {share:.3} % marked", group.totals.failed))
    })
}

/// A row for each scene, a column for each adapter; `lacking` where there is nothing to say.
fn table(
    run: &SceneRun,
    scenes: &[ToldScene],
    stage: &str,
    lacking: &str,
    out: &mut impl Write,
    cell: impl Fn(&Group) -> Option<String>,
) -> Result {
    write!(out, "| scene |")?;
    for adapter in &run.adapters {
        write!(out, " {} |", adapter.name)?;
    }
    writeln!(out, "\n|---|{}", "---:|".repeat(run.adapters.len()))?;
    for scene in scenes {
        write!(out, "| {} |", scene.name)?;
        for adapter in &run.adapters {
            let found = run.group(&format!("scene/{}", scene.name), &adapter.name, stage);
            write!(out, " {} |", found.and_then(&cell).as_deref().unwrap_or(lacking))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn costs(run: &SceneRun, scenes: &[ToldScene], out: &mut impl Write) -> Result {
    let costs = || run.groups.iter().filter_map(|group| group.image.as_ref()?.cost);
    if costs().next().is_none() {
        return Ok(());
    }
    writeln!(out, "\n## What effects cost that are not called for\n")?;
    writeln!(
        out,
        "Time of one drawing by the shaders that are composed of the effects called for, against the shader that has"
    )?;
    writeln!(
        out,
        "all of them behind uniform switches with the same ones on: medians of turns in one run, and the median of"
    )?;
    writeln!(out, "their ratio.\n")?;
    table(run, scenes, "image-full", "—", out, |group| {
        let EffectsCost { composed_ms, full_ms, ratio, .. } = group.image.as_ref()?.cost?;
        Some(format!("{composed_ms:.2} ms, {full_ms:.2} ms: {ratio:.2} ×"))
    })
}

/// The words, with each `ruling N` leading to what it says.
fn linked(words: &str) -> String {
    let mut parts = words.split("ruling ");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let number: String = part.chars().take_while(char::is_ascii_digit).collect();
        let rest = &part[number.len()..];
        if number.is_empty() {
            out += &format!("ruling {rest}");
        } else {
            out += &format!("[ruling {number}](rulings.md#ruling-{number}){rest}");
        }
    }
    out
}
