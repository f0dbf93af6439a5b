//! The page on the built-in scenes: a contact sheet, what each shows, and what a run found.

use lightmeter_catalogue::scene::SceneError;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::load;
use lightmeter_catalogue::scene::load::Loaded;
use lightmeter_document::Document as _;
use lightmeter_document::run::{EffectsCost, Group, Report};
use lightmeter_judge::blend_unit::pixel::Units;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::effects;
use lightmeter_scene::target::TargetFormat;
use std::fmt::{Result, Write};
use std::ops::Deref;

/// Pictures side by side.
const COLUMNS: usize = 6;
/// Pixels of a picture's side.
const SIDE: usize = 160;
/// Pixels between pictures.
const GAP: usize = 4;

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
    /// Where it is none, or has no scene.
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

/// The built-in scenes, in their order.
///
/// # Errors
/// Where one is refused, which a test rules out.
pub fn scenes() -> std::result::Result<Vec<Loaded>, SceneError> {
    SCENES.iter().map(|(name, _)| load::builtin(name)).collect()
}

/// Every scene by the reference, side by side and row after row, each shrunk by averaging.
#[must_use]
pub fn contact_sheet(scenes: &[Loaded]) -> StoredImage {
    let rows = scenes.len().div_ceil(COLUMNS);
    let [width, height] = [COLUMNS, rows].map(|count| count * (SIDE + GAP) + GAP);
    let mut sheet = StoredImage {
        width,
        format: TargetFormat::Rgba8Unorm,
        pixels: vec![[24.0, 24.0, 26.0, 255.0]; width * height],
    };
    for (number, loaded) in scenes.iter().enumerate() {
        let image = StoredImage::of(&render::<f64>(&loaded.frame, None, None), loaded.frame.target.format);
        let [left, top] = [number % COLUMNS, number / COLUMNS].map(|place| place * (SIDE + GAP) + GAP);
        for y in 0..SIDE {
            for x in 0..SIDE {
                sheet.pixels[(top + y) * width + left + x] = average(&image, [x, y]);
            }
        }
    }
    sheet
}

/// The mean of the pixels that a pixel of the sheet stands for, in steps from 0 to 255.
fn average(image: &StoredImage, at: [usize; 2]) -> Units {
    let size = [image.width, image.pixels.len() / image.width];
    let span = |axis: usize| {
        at[axis] * size[axis] / SIDE..((at[axis] + 1) * size[axis] / SIDE).max(at[axis] * size[axis] / SIDE + 1)
    };
    let scale = if image.format.is_unorm() { 1.0 } else { 255.0 };
    let (mut sum, mut count) = ([0.0; 4], 0.0);
    for y in span(1) {
        for x in span(0) {
            count += 1.0;
            for (sum, c) in sum.iter_mut().zip(image.pixels[y * image.width + x]) {
                *sum += (c * scale).clamp(0.0, 255.0);
            }
        }
    }
    [sum[0] / count, sum[1] / count, sum[2] / count, 255.0]
}

/// The page in Markdown.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(run: &SceneRun, scenes: &[Loaded], picture: Option<&str>, out: &mut impl Write) -> Result {
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
    for loaded in scenes {
        let all = effects(&loaded.frame)
            .iter()
            .flat_map(|called| called.effects.iter())
            .fold(lightmeter_scene::effects::Effects::NONE, lightmeter_scene::effects::Effects::with);
        writeln!(out, "| {} | {} | {all} |", loaded.name, loaded.shows)?;
    }
    judged(run, scenes, out)?;
    costs(run, scenes, out)
}

fn judged(run: &SceneRun, scenes: &[Loaded], out: &mut impl Write) -> Result {
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
    scenes: &[Loaded],
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
    for loaded in scenes {
        write!(out, "| {} |", loaded.name)?;
        for adapter in &run.adapters {
            let found = run.group(&format!("scene/{}", loaded.name), &adapter.name, stage);
            write!(out, " {} |", found.and_then(&cell).as_deref().unwrap_or(lacking))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn costs(run: &SceneRun, scenes: &[Loaded], out: &mut impl Write) -> Result {
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
