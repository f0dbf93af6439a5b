//! A pixel of a scene: each intermediate result by the reference, what is legal, and what adapters give.

use super::super::options::Choice;
use lightmeter::arithmetic::Profile;
use lightmeter::blend_unit::pixel::Units;
use lightmeter::device::{Code, Picture};
use lightmeter::document::show::{PixelPlace, SCHEMA, SeenIntermediate, ShowDocument, ShownIntermediate, ShownPixel};
use lightmeter::document::{Document as _, Number};
use lightmeter::filter::Filter;
use lightmeter::image::expect::Expectation;
use lightmeter::image::file::StoredImage;
use lightmeter::image::{self, LegalPixel};
use lightmeter::scene::Loaded;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::{builtin, pixel_of, scene_id};
use lightmeter::subject::Subject;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::{effects, named};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use std::fmt::Write as _;

/// One row: an intermediate result, or the colour.
struct Row {
    what: &'static str,
    reference: Units,
    /// By adapter, or by the profile's promise where there is none: what is legal, and what came out.
    seen: Vec<(String, LegalPixel, Option<Units>)>,
}

/// The scene and the pixel of an id such as `scene/teapot/12-340`.
pub(super) fn find(id: &str, size: Option<u32>) -> anyhow::Result<Option<(Loaded, usize)>> {
    for place in 0..SCENES.len() {
        let scene = scene_id(place);
        if id != scene && !id.starts_with(&format!("{scene}/")) {
            continue;
        }
        let loaded = builtin(place, size)?;
        let target = loaded.frame.target;
        let Some(pixel) = pixel_of(id, &scene, &loaded.frame) else {
            anyhow::bail!(
                "`{id}` is no pixel of {scene}, which has {} × {}: a pixel is {scene}/X-Y, as {scene}/0-0",
                target.width,
                target.height
            );
        };
        return Ok(Some((loaded, pixel)));
    }
    Ok(None)
}

fn rows(frame: &Frame, pixel: usize, profile: &Profile, subjects: &[Subject], code: &Code) -> anyhow::Result<Vec<Row>> {
    let width = frame.target.width as usize;
    let stages = Intermediate::ALL.map(Some).into_iter().chain([None]);
    stages
        .map(|stage| {
            let format = stage.map_or(frame.target.format, |_| TargetFormat::Rgba32Float);
            let reference = StoredImage::unrounded(&render::<f64>(frame, None, stage), format).pixels[pixel];
            let legal = |profile: &Profile| {
                let expectation = Expectation::new(frame, None, stage, profile);
                expectation.pixel(pixel % width, pixel / width)
            };
            let mut seen = vec![];
            for subject in subjects {
                let image = drawn(subject, code, frame, stage)?;
                let legal = legal(&subject.known.profile(profile));
                seen.push((subject.identity.name.clone(), legal, image.map(|image| image.pixels[pixel])));
            }
            if seen.is_empty() {
                seen.push((profile.name.to_owned(), legal(profile), None));
            }
            Ok(Row { what: stage.map_or("color", Intermediate::name), reference, seen })
        })
        .collect()
}

fn drawn(
    subject: &Subject,
    code: &Code,
    frame: &Frame,
    stage: Option<Intermediate>,
) -> anyhow::Result<Option<StoredImage>> {
    let (sets, picture) = match stage {
        Some(stage) => (named(frame), Picture::Intermediate(stage)),
        None => (effects(frame), Picture::Composed),
    };
    Ok(image::drawn::drawn(subject, code, frame, &sets, picture)?.ok())
}

/// Everything about a pixel, as text or JSON.
pub(super) fn show(
    id: &str,
    (loaded, pixel): &(Loaded, usize),
    choice: &Choice,
    subjects: &[Subject],
    as_json: bool,
) -> anyhow::Result<String> {
    let frame = &loaded.frame;
    let rows = rows(frame, *pixel, choice.profile, subjects, &choice.code(&Filter::default(), true)?)?;
    let width = frame.target.width as usize;
    if as_json {
        let shown = ShownPixel {
            schema: SCHEMA.into(),
            id: id.to_owned(),
            title: loaded.title.clone(),
            target: frame.target.format.name().into(),
            pixel: PixelPlace { x: pixel % width, y: pixel / width },
            stages: rows.iter().map(intermediate).collect(),
        };
        return Ok(ShowDocument::Pixel(shown).to_json()?);
    }
    let mut text = format!("{id}\n  {}\n  {}\n", loaded.title, loaded.shows);
    let units = if frame.target.format.is_unorm() { "steps from 0 to 255" } else { "values" };
    writeln!(text, "  colors in {units} of {}, the rest as numbers in eye space\n", frame.target.format.name())?;
    for row in &rows {
        writeln!(text, "{:<10} {}", row.what, four(row.reference))?;
        for (name, legal, value) in &row.seen {
            let marked = if legal.is_marked { "  several outcomes are legal" } else { "" };
            writeln!(text, "  {name:<12} from {}{marked}", four(legal.low))?;
            writeln!(text, "  {:<12} to   {}", "", four(legal.high))?;
            if let Some(value) = value {
                let inside = (0..4).all(|k| legal.low[k] <= value[k] && value[k] <= legal.high[k]);
                writeln!(text, "  {:<12} {} gives {}", "", if inside { "✓" } else { "✗" }, four(*value))?;
            }
        }
    }
    Ok(text)
}

fn intermediate(row: &Row) -> ShownIntermediate {
    let numbers = |units: Units| units.map(Number);
    let seen = row.seen.iter().map(|(name, legal, value)| SeenIntermediate {
        adapter: name.clone(),
        low: numbers(legal.low),
        high: numbers(legal.high),
        marked: legal.is_marked,
        value: value.map(numbers),
    });
    ShownIntermediate { stage: row.what.into(), reference: numbers(row.reference), seen: seen.collect() }
}

fn four(units: Units) -> String {
    let number = |x: f64| if x.is_finite() { format!("{x:>12.7}") } else { format!("{:>12}", Number(x).to_string()) };
    units.map(number).join(" ")
}
