//! Scenes that a renderer is asked to draw: one image of each, with nothing of how it came about.

use super::verdict::{JudgedScene, told, worst};
use crate::again::digest_of;
use crate::device::DeviceError;
use crate::expected::expect;
use crate::options::Options;
use crate::renderer::{AskedRenderer, AskedScene};
use crate::subject::Subject;
use crate::turn::not_asked;
use lightmeter_catalogue::scene::Loaded;
use lightmeter_catalogue::scene::select::{Chosen, pixel_id, scene_id};
use lightmeter_document::Number;
use lightmeter_document::by_case::{CaseCounts, CaseTotals, FailedAnswer};
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::{Diagnosis, Failure, Group, ImageUse, Report, Totals};
use lightmeter_judge::cases::{Unanswered, ending};
use lightmeter_judge::formula::unjudged;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_judge::image::judge::Judged;
use std::collections::BTreeMap;
use std::time::Instant;

/// The stage of such images in reports.
const STAGE: &str = "answer";

/// Has a renderer draw a scene.
pub(crate) fn ask(
    renderer: &mut dyn AskedRenderer,
    id: &str,
    loaded: &Loaded,
) -> Result<Result<StoredImage, Unanswered>, DeviceError> {
    renderer.image(AskedScene { id, title: &loaded.title, frame: &loaded.frame })
}

/// Judges the image that a renderer draws of a scene; what stands for it, and whether it failed.
pub(crate) fn run_scene(
    loaded: &Loaded,
    chosen: &Chosen,
    subject: &mut Subject,
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<(u32, bool), DeviceError> {
    let (id, frame) = (scene_id(chosen.place), &loaded.frame);
    let Some(renderer) = subject.asked_mut() else { unreachable!("only such a renderer draws here") };
    if let Some(reason) = renderer.lacks(&id).or_else(|| renderer.lacks_frame(frame)) {
        report.groups.push(not_asked(id, STAGE, 1, reason, subject));
        return Ok((0, false));
    }
    let clock = Instant::now();
    let image = ask(renderer, &id, loaded)?;
    report.timing.devices += clock.elapsed().as_secs_f64();
    let digest = digest_of(&image);
    let clock = Instant::now();
    let mut scene = Scene { id, loaded, chosen, subject, options, report };
    let has_failed = match image {
        Ok(image) => scene.judge(&image),
        Err(why) => scene.refuse(&why),
    };
    if let Some(group) = report.groups.last_mut() {
        group.seconds = clock.elapsed().as_secs_f64();
    }
    observer.see(&Event::Advanced(1));
    Ok((digest, has_failed))
}

struct Scene<'a> {
    id: String,
    loaded: &'a Loaded,
    chosen: &'a Chosen,
    subject: &'a Subject,
    options: &'a Options,
    report: &'a mut Report,
}

impl Scene<'_> {
    fn group(&self) -> Group {
        Group {
            target: Some(self.loaded.frame.target.format.name().into()),
            ..Group::new(self.id.clone(), self.subject.identity.name.clone(), STAGE)
        }
    }

    /// Notes at the expectations whether the scene failed; 1 where that was expected.
    fn expected(&mut self, has_failed: bool, found: Option<&Diagnosis>) -> u64 {
        let on = [STAGE, self.loaded.frame.target.format.name()];
        u64::from(expect(self.report, self.options, &self.id, &on, has_failed, found))
    }

    /// The state of the scene's one case, where it did not pass.
    fn not_passed(&self, state: &str) -> BTreeMap<String, Vec<String>> {
        BTreeMap::from([(state.to_owned(), vec![ending("scene", &self.id)])])
    }

    /// Adds a scene without an image to the report; whether it counts as a failure.
    fn refuse(&mut self, why: &Unanswered) -> bool {
        let mut counts =
            CaseCounts { totals: CaseTotals { asked: 1, ..CaseTotals::default() }, ..CaseCounts::default() };
        let mut totals = Totals { cases: 1, ..Totals::default() };
        let has_failed = matches!(why, Unanswered::Unjudged(_) | Unanswered::Broken(_));
        match why {
            Unanswered::Skipped(reason) | Unanswered::Undeclared(reason) => {
                (counts.totals.skipped, totals.skipped) = (1, 1);
                counts.totals.undeclared = u64::from(matches!(why, Unanswered::Undeclared(_)));
                counts.reason = Some(reason.clone());
                counts.not_passed = self.not_passed("skipped");
            }
            Unanswered::Missing | Unanswered::Unasked => {
                counts.totals.missing = 1;
                counts.not_passed = self.not_passed("missing");
            }
            Unanswered::Unjudged(message) | Unanswered::Broken(message) => {
                (counts.totals.failed, counts.totals.unjudged) = (1, 1);
                counts.totals.broken = u64::from(matches!(why, Unanswered::Broken(_)));
                counts.totals.expected_failures = self.expected(true, None);
                counts.not_passed = self.not_passed("failed");
                counts.smallest = Some(self.id.clone());
                let failure = unjudged(self.id.clone(), message, STAGE, &self.subject.identity.name);
                let target = Some(self.loaded.frame.target.format.name().into());
                self.report.failures.push(Failure { target, ..failure });
            }
        }
        self.report.groups.push(Group { totals, by_case: Some(counts), ..self.group() });
        has_failed
    }

    /// Adds the verdicts on an image to the report; whether it failed.
    fn judge(&mut self, image: &StoredImage) -> bool {
        let profile = self.subject.known.profile(self.options.profile);
        let mut scene = JudgedScene::new(self.loaded, self.chosen);
        scene.expect(&profile);
        let judged = scene.judged(image, &profile);
        let verdicts = &judged.verdicts;
        let has_failed = verdicts.totals.failed > 0;
        let bias = if has_failed { None } else { scene.bias(image, &profile) };
        let problem = verdicts.problem().or(bias.and_then(|bias| told(&bias)));
        let found = self
            .options
            .diagnose
            .filter(|_| has_failed)
            .map(|diagnose| diagnose.image(&self.loaded.frame, image, scene.expected(&profile), &profile));
        let is_expected = self.expected(has_failed, found.as_ref()) > 0;
        let mut counts = scene.counts(has_failed, is_expected);
        if !has_failed {
            counts.error_passing = Number(verdicts.error_max);
        }
        if has_failed {
            let failure = self.failure(&scene, image, &judged, &profile);
            counts.smallest = Some(failure.id.clone());
            self.report.failures.push(failure);
        }
        let (mut files, mut hashes, mut pixels) = (vec![], vec![], vec![]);
        if has_failed {
            (files, hashes) = scene.write_files(self.options, &self.subject.identity.name, STAGE, image, &profile);
            pixels = scene.told_pixels(image, &judged, &profile);
        }
        let mut totals = Totals { cases: 1, failed_groups: u64::from(problem.is_some()), ..verdicts.totals };
        if counts.totals.expected_failures > 0 {
            totals.expected_failures += std::mem::take(&mut totals.failed);
        }
        let margin = worst(&judged).or(judged.worst()).map_or(0.0, |worst| worst.margin);
        self.report.groups.push(Group {
            totals,
            error_ulp_max: Number(verdicts.error_max),
            margin_max: Number(margin),
            worst: Some(self.id.clone()),
            diagnosis: found,
            problems: problem.into_iter().collect(),
            image: Some(ImageUse {
                width: image.width,
                height: image.pixels.len() / image.width,
                marked: scene.expected(&profile).iter().filter(|pixel| pixel.is_marked).count() as u64,
                differs_from_composed: None,
                cost: None,
                bias,
                wrong: judged.pixels().len() as u64,
                departs_in: None,
                show: None,
                files,
                hashes,
                pixels,
            }),
            by_case: Some(counts),
            ..self.group()
        });
        has_failed
    }

    /// The worst pixel of a wrong image, with all of its components.
    fn failure(
        &self,
        scene: &JudgedScene<'_>,
        image: &StoredImage,
        judged: &Judged,
        profile: &lightmeter_arithmetic::Profile,
    ) -> Failure {
        let pixel = worst(judged).map_or(0, |worst| worst.pixel);
        let legal = &scene.expected(profile)[pixel];
        let Totals { failed, verdicts, .. } = judged.verdicts.totals;
        let (reference, value) = (scene.reference(pixel), image.pixels[pixel]);
        let problem = format!("{failed} of {verdicts} components of pixels are outside of what is legal");
        let id = pixel_id(&self.id, image.width, pixel);
        let k = worst(judged).map_or(0, |worst| worst.component);
        Failure {
            target: Some(self.loaded.frame.target.format.name().into()),
            output: ["r", "g", "b", "a"][k].into(),
            reference: Number(reference[k]),
            interval: [Number(legal.low[k]), Number(legal.high[k])],
            value: Number(value[k]),
            error_ulp: Number(judged.verdicts.error_max),
            answer: Some(FailedAnswer {
                inputs: vec![],
                outputs: ["r", "g", "b", "a"].map(String::from).to_vec(),
                reference: reference.map(Number).to_vec(),
                interval: (0..4).map(|k| [Number(legal.low[k]), Number(legal.high[k])]).collect(),
                value: value.map(Number).to_vec(),
                problem: Some(problem),
            }),
            ..Failure::new(id, self.subject.identity.name.clone(), STAGE)
        }
    }
}
