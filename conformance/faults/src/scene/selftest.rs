//! Every mistake of a renderer in every scene that shows it: whether it is caught, and told by its name.

use super::{SCENE_FAULTS, Trial, draw, fails};
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::{builtin, scene_id};
use lightmeter_document::event::Stop;
use lightmeter_document::selftest::{SceneRecord, SceneRow};
use lightmeter_judge::image::expect;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_reference::render::render;
use rayon::prelude::*;
use std::fmt::{Result, Write};

/// Writes it for people.
///
/// # Errors
/// Where the writer fails.
pub fn text(record: &SceneRecord, out: &mut impl Write) -> Result {
    let [caught, named] = record.counts();
    let judged = record.judged.map(|judged| format!(" in the {judged} of {} that were judged", SCENES.len()));
    let (judged, mistakes) = (judged.unwrap_or_default(), record.rows.len());
    writeln!(out, "scenes: {mistakes} mistakes{judged}, caught {caught} times, told by name first {named} times")?;
    for row in &record.rows {
        let mark = match (row.is_caught(), record.judged) {
            (true, _) => '✓',
            (false, None) => '✗',
            // Another scene may catch it.
            (false, Some(_)) => '·',
        };
        let [caught, named] = [row.caught.len(), row.named.len()];
        writeln!(out, "{mark} {:<28} caught in {caught:>2} scenes, named in {named:>2}: {}", row.fault, row.says)?;
    }
    for alarm in &record.alarms {
        writeln!(out, "FALSE ALARM: {alarm} fails and nothing is wrong")?;
    }
    Ok(())
}

/// What the scenes catch, drawn with `size` pixels on their longer side; and the scenes in which nothing is wrong and
/// something fails all the same. A scene that is under way when it is told to stop is left out.
///
/// # Errors
/// Where a scene is refused, which a test rules out.
pub fn selftest(
    size: u32,
    profile: &Profile,
    stop: &Stop,
    progress: &mut impl FnMut(&str),
) -> std::result::Result<SceneRecord, lightmeter_catalogue::scene::SceneError> {
    let mut rows: Vec<SceneRow> = SCENE_FAULTS
        .iter()
        .map(|fault| SceneRow {
            fault: fault.name.into(),
            says: fault.says.into(),
            caught: vec![],
            named: vec![],
            others: vec![],
        })
        .collect();
    let mut alarms = vec![];
    for place in 0..SCENES.len() {
        if stop.is_set() {
            return Ok(SceneRecord { rows, alarms, judged: Some(place) });
        }
        let id = scene_id(place);
        progress(&id);
        let frame = builtin(place, Some(size))?.frame;
        let expected = expect(&frame, None, None, profile);
        let reference = StoredImage::unrounded(&render::<f64>(&frame, None, None), frame.target.format);
        let is_alarm = fails(&draw::<f32>(&frame, &[]), &reference, &expected);
        let found: Vec<Option<std::result::Result<(), String>>> = SCENE_FAULTS
            .par_iter()
            .map(|fault| {
                if stop.is_set() {
                    return None;
                }
                let image = draw::<f32>(&frame, &[fault]);
                if !fails(&image, &reference, &expected) {
                    return None;
                }
                let diagnosis = Trial::new(&frame, &image, &expected, profile).diagnose();
                let is_named = diagnosis.explanations.first().is_some_and(|first| {
                    // Two mistakes that draw the same cannot be told apart there.
                    first.faults.iter().any(|own| own.name == fault.name) && first.faults.len() == 1
                        || draw::<f32>(&frame, &first.faults) == image
                });
                Some(if is_named { Ok(()) } else { Err(diagnosis.diagnosis.to_string()) })
            })
            .collect();
        if stop.is_set() {
            return Ok(SceneRecord { rows, alarms, judged: Some(place) });
        }
        alarms.extend(is_alarm.then(|| id.clone()));
        for (row, found) in rows.iter_mut().zip(found) {
            match found {
                None => continue,
                Some(Ok(())) => row.named.push(id.clone()),
                Some(Err(sentence)) => row.others.push(format!("{id}: {sentence}")),
            }
            row.caught.push(id.clone());
        }
    }
    Ok(SceneRecord { rows, alarms, judged: None })
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn every_mistake_is_caught_and_nearly_all_are_named() {
        let record = selftest(40, &WGSL, &Stop::default(), &mut |_| {}).expect("the scenes load");
        assert!(record.alarms.is_empty(), "{:?}", record.alarms);
        let rows = &record.rows;
        let survivors: Vec<&str> = rows.iter().filter(|row| !row.is_caught()).map(|row| row.fault.as_str()).collect();
        assert!(survivors.is_empty(), "{survivors:?}");
        let [caught, named] = record.counts();
        let others: Vec<&String> = rows.iter().flat_map(|row| &row.others).collect();
        assert!(100 * named >= 95 * caught, "{named} of {caught}: {others:#?}");
    }
}
