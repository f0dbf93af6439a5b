//! Where a wrong image first departs: its intermediate results, drawn by the same shaders, against their own legal values.

use super::drawn::intermediate;
use crate::device::{Code, DeviceError};
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_document::report::Departure;
use lightmeter_judge::image::LegalPixel;
use lightmeter_judge::image::expect::Expectation;
use lightmeter_scene::effects::{Called, named};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;

/// Pixels that are looked at: the first of those that fail.
const LOOKED_AT: usize = 4096;

/// Compares the intermediate results of failing pixels, in the order in which they come about; `None` where the subject cannot draw them.
///
/// A cutout leaves whole fragments out, by an alpha that may be what is wrong: where the very first result departs, all are compared once
/// more of a frame without cutouts, and if nothing departs there it is the cutout that does.
///
/// # Errors
/// Where a shader is invalid or the device fails.
pub fn departure(
    subject: &Subject,
    code: &Code,
    frame: &Frame,
    sets: &[Called],
    profile: &Profile,
    pixels: &[usize],
) -> Result<Option<Departure>, DeviceError> {
    let pixels = &pixels[..pixels.len().min(LOOKED_AT)];
    let of = pixels.len();
    let first = match first_departing(subject, code, (frame, sets), profile, pixels)? {
        Err(NotDrawn) => return Ok(None),
        Ok(first) => first,
    };
    if first.is_some_and(|(stage, _)| stage == Intermediate::ALL[0])
        && frame.draws.iter().any(|draw| draw.cutout.is_some())
    {
        let mut whole = frame.clone();
        whole.draws.iter_mut().for_each(|draw| draw.cutout = None);
        let sets = named(&whole);
        if let Ok(departing) = first_departing(subject, code, (&whole, &sets), profile, pixels)? {
            let (stage, pixels) = departing.map_or(("cutout", of), |(stage, pixels)| (stage.name(), pixels));
            return Ok(Some(departure_in(stage, pixels, of)));
        }
    }
    let last = if frame.draws.iter().any(|draw| draw.blend.is_some()) { "blend" } else { "store" };
    let (stage, pixels) = first.map_or((last, of), |(stage, pixels)| (stage.name(), pixels));
    Ok(Some(departure_in(stage, pixels, of)))
}

fn departure_in(stage: &'static str, pixels: usize, of: usize) -> Departure {
    Departure { stage: stage.into(), pixels: pixels as u64, of: of as u64 }
}

/// The subject cannot draw intermediate results.
struct NotDrawn;

/// The first intermediate result that departs in any of the pixels, and in how many.
fn first_departing(
    subject: &Subject,
    code: &Code,
    (frame, sets): (&Frame, &[Called]),
    profile: &Profile,
    pixels: &[usize],
) -> Result<Result<Option<(Intermediate, usize)>, NotDrawn>, DeviceError> {
    for stage in Intermediate::ALL {
        let Ok(image) = intermediate(subject, code, frame, sets, stage)? else { return Ok(Err(NotDrawn)) };
        let expectation = Expectation::new(frame, None, Some(stage), profile);
        let legal = expectation.at(pixels);
        let departs = |&(&pixel, legal): &(&usize, &LegalPixel)| {
            let of_pixel = image.pixels[pixel];
            (0..4).any(|k| !(legal.low[k] <= of_pixel[k] && of_pixel[k] <= legal.high[k]) && legal.low[k].is_finite())
        };
        let departing = pixels.iter().zip(&legal).filter(departs).count();
        if departing > 0 {
            return Ok(Ok(Some((stage, departing))));
        }
    }
    Ok(Ok(None))
}
