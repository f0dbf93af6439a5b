//! What a group of blend states has come to on one subject and target: rows, verdicts, stores, failures.

use super::asked::asked;
use super::chunk::UnitChunk;
use super::draw::draw;
use crate::again;
use crate::device::DeviceError;
use crate::options::Options;
use crate::piece::{Piece, Pixels};
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::cases::{Kind, Stage};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::Number;
use lightmeter_document::by_case::FailedAnswer;
use lightmeter_document::report::{
    BlendState, Diagnosis, Failure, Group, GroupSample, Report, SampledRows, SampledStores, SpecialUse, StoresOfState,
    Tiers, Totals,
};
use lightmeter_judge::blend_unit::expect::ExpectedPixel;
use lightmeter_judge::blend_unit::pixel::{self, Units};
use lightmeter_judge::blend_unit::policy;
use lightmeter_judge::blend_unit::store::{StoreCounts, problems, store_of};
use lightmeter_judge::blend_unit::tally::{DrawnState, FailingPixel, UnitTally, diagnose};
use lightmeter_judge::cases::{CaseTally, Unanswered};
use lightmeter_judge::formula::{bits_in_hex, by_name, units, unjudged};
use lightmeter_judge::packed::{BadSample, ReadRows, packed, unpacked};
use lightmeter_judge::sample::{Sample, row_number};
use lightmeter_judge::tally::{KEPT_FAILURES, Tally};
use lightmeter_judge::{Outcome, worse};
use lightmeter_scene::blend::Route;
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::time::Instant;

/// What stands for the pixels of a piece, the `number`-th that was drawn.
fn digests(pixels: &[Units], number: usize, drawn: &Pixels) -> Vec<u32> {
    let of_pixel = |(place, pixel): (usize, &Units)| match drawn.unanswered.get(&(number, place)) {
        Some(why) => again::number(why),
        None => again::digest_of_values(pixel.iter().copied()),
    };
    pixels.iter().enumerate().map(of_pixel).collect()
}

/// How reports call where a subject blends.
fn stage(subject: &Subject) -> &'static str {
    if subject.asked().is_some() { Stage::Answer.name() } else { Stage::FixedFunction.name() }
}

/// Failing pixels of a group on a target that are asked once more.
const MOST_AGAIN: usize = 1024;
/// Failing pixels of a group that faults are tried on.
const SAMPLES: usize = 1024;

/// Failing pixels, by the place of formula and route, and the case.
pub(crate) type PixelSample = Sample<(usize, CaseRef), FailingPixel>;

/// The number of the piece that was drawn, the place of the case in it, and the case's id.
type PixelPlace = (usize, usize, String);

/// A failing pixel that is reported.
#[derive(Clone)]
struct KeptPixel {
    /// The state's place among the group's.
    of: usize,
    route: Route,
    inputs: Vec<f32>,
    pixel: Units,
    expected: ExpectedPixel,
}

/// What a group has come to on one subject and target.
pub(super) struct UnitStanding {
    pub(super) target: TargetFormat,
    /// Why nothing is drawn.
    lacks: Option<&'static str>,
    /// Verdicts.
    verdicts: Tally<PixelPlace, KeptPixel>,
    /// Pieces that were drawn.
    pieces: usize,
    tiers: Tiers,
    /// What values say of how they are stored; its states are those of the rows.
    stores: SampledStores,
    /// Some of the failing pixels, by the place of formula and route, and the case.
    samples: PixelSample,
    rows: Vec<BlendState>,
    special: Vec<SpecialUse>,
    /// The same counted by cases, where that is asked for.
    cases: CaseTally,
    /// Components that fail as is expected.
    expected: u64,
    /// What was left of each case in turn, where all is asked again.
    pub(super) digests: Vec<u32>,
    /// What was left of cases that failed: the first of them.
    pub(super) failing: Vec<(usize, CaseRef, u32)>,
    skipped: u64,
    seconds: f64,
    seconds_warm: Option<f64>,
}

impl UnitStanding {
    pub(super) fn new(target: TargetFormat, lacks: Option<&'static str>) -> Self {
        Self {
            target,
            lacks,
            verdicts: Tally::default(),
            pieces: 0,
            tiers: Tiers::default(),
            stores: SampledStores::default(),
            samples: Sample::new(SAMPLES),
            rows: vec![],
            special: vec![],
            cases: CaseTally::default(),
            expected: 0,
            digests: vec![],
            failing: vec![],
            skipped: 0,
            seconds: 0.0,
            seconds_warm: None,
        }
    }

    pub(super) fn judge(
        &mut self,
        subject: &mut Subject,
        chunk: &UnitChunk<'_>,
        options: &Options,
        members: &[&Member],
        report: &mut Report,
    ) -> Result<(), DeviceError> {
        let reasons = self.reasons(subject, chunk, options)?;
        let live: Vec<usize> = (0..chunk.pieces.len()).filter(|&k| reasons[k].is_none()).collect();
        let pieces: Vec<&Piece> = live.iter().map(|&k| &chunk.pieces[k]).collect();
        let drawn = self.drawn(subject, chunk, &pieces, options, report)?;
        let clock = Instant::now();
        let target = self.target;
        let tallies = self.tallies(subject, &pieces, &drawn, options);
        let mut judged = live.iter().zip(tallies.iter().zip(&drawn.pieces)).enumerate().peekable();
        for (k, reason) in reasons.iter().enumerate() {
            let place = self.row(subject, chunk, k, *reason);
            let row = &mut self.rows[place];
            let Some((number, (_, (tally, pixels)))) = judged.next_if(|(_, (live, _))| **live == k) else {
                self.skipped += chunk.cases[k].len() as u64;
                continue;
            };
            row.cases += tally.verdicts.totals.cases;
            row.failed += tally.verdicts.totals.failed;
            row.error_max = Number(worse(row.error_max.0, tally.verdicts.error_max));
            self.stores.states[place].components.iter_mut().zip(&tally.stores).for_each(|(counts, of)| counts.add(of));
            if target.is_unorm() {
                row.tiers.get_or_insert_default().add(&tally.tiers);
            }
            self.add(subject, (chunk, k), members, tally, pixels, options);
            let unanswered = drawn.unanswered.range((number, 0)..(number + 1, 0));
            let unanswered = unanswered.map(|((_, place), why)| (*place, why)).collect();
            self.count_cases((chunk, k), members, stage(subject), tally, &unanswered, options);
            self.cases.passing(tally.passing);
            if options.runs > 1 || subject.asked().is_some() {
                self.note((chunk, k), members, tally, digests(pixels, number, &drawn), options);
            }
        }
        report.timing.judge += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// Why each piece is not drawn; `None` where it is.
    fn reasons(
        &self,
        subject: &mut Subject,
        chunk: &UnitChunk<'_>,
        options: &Options,
    ) -> Result<Vec<Option<&'static str>>, DeviceError> {
        let lacks = |piece: &Piece| Ok(self.lacks.or(subject.lacks_route(&options.code, piece.route)?));
        chunk.pieces.iter().map(lacks).collect()
    }

    /// Notes what was left of the cases of a piece, or of those that failed, where they are asked again.
    fn note(
        &mut self,
        (chunk, k): (&UnitChunk<'_>, usize),
        members: &[&Member],
        tally: &UnitTally,
        digests: Vec<u32>,
        options: &Options,
    ) {
        if options.runs > 1 {
            self.digests.extend(digests);
            return;
        }
        let of = members.iter().position(|one| one.spec.id == chunk.members[k].spec.id).unwrap_or_default();
        let room = MOST_AGAIN.saturating_sub(self.failing.len());
        let failing = tally.failing.iter().take(room).map(|&(place, _)| (of, chunk.cases[k][place], digests[place]));
        self.failing.extend(failing);
    }

    /// What is left of a chunk that is drawn again, in the order in which it was noted: each with its case.
    pub(super) fn draw_again<'a>(
        &mut self,
        subject: &mut Subject,
        chunk: &UnitChunk<'a>,
        options: &Options,
        report: &mut Report,
    ) -> Result<Vec<(&'a Member, CaseRef, u32)>, DeviceError> {
        let reasons = self.reasons(subject, chunk, options)?;
        let live: Vec<usize> = (0..chunk.pieces.len()).filter(|&k| reasons[k].is_none()).collect();
        let pieces: Vec<&Piece> = live.iter().map(|&k| &chunk.pieces[k]).collect();
        let drawn = self.drawn(subject, chunk, &pieces, options, report)?;
        let of_piece = |(number, (&k, pixels)): (usize, (&usize, &Vec<Units>))| {
            let digests = digests(pixels, number, &drawn);
            let cases = chunk.cases[k].iter().zip(digests);
            cases.map(|(&case, digest)| (chunk.members[k], case, digest)).collect::<Vec<_>>()
        };
        Ok(live.iter().zip(&drawn.pieces).enumerate().flat_map(of_piece).collect())
    }

    /// The pixels of the pieces that can be drawn.
    fn drawn(
        &mut self,
        subject: &mut Subject,
        chunk: &UnitChunk<'_>,
        pieces: &[&Piece],
        options: &Options,
        report: &mut Report,
    ) -> Result<Pixels, DeviceError> {
        let drawn = if pieces.is_empty() {
            Pixels::default()
        } else if let Some(renderer) = subject.asked_mut() {
            asked(renderer, self.target, chunk)?
        } else {
            draw(subject, &options.code, self.target, pieces, options.again)?
        };
        self.seconds += drawn.seconds;
        report.timing.devices += drawn.seconds + drawn.seconds_warm.unwrap_or(0.0);
        if let Some(warm) = drawn.seconds_warm {
            *self.seconds_warm.get_or_insert(0.0) += warm;
        }
        Ok(drawn)
    }

    /// Verdicts on the pixels of each piece.
    fn tallies(&self, subject: &Subject, pieces: &[&Piece], drawn: &Pixels, options: &Options) -> Vec<UnitTally> {
        let (target, known) = (self.target, &subject.known);
        let of_piece = |(number, (piece, pixels)): (usize, (&&Piece, &Vec<Units>))| {
            let state = DrawnState { program: piece.program, route: piece.route, target, profile: options.profile };
            let is_there = |place: &usize| !drawn.unanswered.contains_key(&(number, *place));
            let pixel = |place: usize| (place, piece.case(place), pixels[place]);
            let mut tally = UnitTally::default();
            tally.pixels(state, known, (0..pixels.len()).filter(is_there).map(pixel));
            tally
        };
        pieces.par_iter().zip(&drawn.pieces).enumerate().map(of_piece).collect()
    }

    /// The place of the row of a piece's state, which may have begun in the chunk before.
    fn row(&mut self, subject: &Subject, chunk: &UnitChunk<'_>, k: usize, skip_reason: Option<&'static str>) -> usize {
        let (id, route) = (&chunk.members[k].spec.id, chunk.pieces[k].route.name());
        // A state's routes take turns block by block.
        let known = self.rows.iter().rev().take(2).position(|row| row.id == *id && row.route == route);
        if let Some(back) = known {
            return self.rows.len() - 1 - back;
        }
        self.rows.push(BlendState {
            id: id.clone(),
            adapter: subject.identity.name.clone(),
            target: self.target.name().into(),
            route: route.into(),
            cases: 0,
            failed: 0,
            error_max: Number(0.0),
            tiers: None,
            skip_reason: skip_reason.map(Into::into),
        });
        let components = <[StoreCounts; 4]>::default();
        self.stores.states.push(StoresOfState { id: id.clone(), route: route.into(), components });
        self.rows.len() - 1
    }

    /// Counts the pixels of a piece as cases, and those that are expected to fail.
    fn count_cases(
        &mut self,
        (chunk, k): (&UnitChunk<'_>, usize),
        members: &[&Member],
        stage: &str,
        tally: &UnitTally,
        unanswered: &BTreeMap<usize, &Unanswered>,
        options: &Options,
    ) {
        if !options.counts_cases && options.expected.is_empty() {
            return;
        }
        let (member, piece) = (chunk.members[k], &chunk.pieces[k]);
        let on = [stage, self.target.name()];
        let of = members.iter().position(|one| one.spec.id == member.spec.id).unwrap_or_default();
        let mut failing = tally.failing.iter().peekable();
        for (place, &case) in chunk.cases[k].iter().enumerate() {
            if let Some(why) = unanswered.get(&place) {
                if self.cases.unanswered((of, case), why) {
                    self.cases.expect(&options.expected, &member.case_id(case), &on, true, |_| false);
                }
                continue;
            }
            let failed = failing.next_if(|(failing, _)| *failing == place).map_or(0, |(_, components)| *components);
            let inputs = &piece.inputs[place * piece.stride..(place + 1) * piece.stride];
            self.cases.judged((of, case), inputs, failed > 0, 0.0, (0.0, 0));
            if !options.expected.is_empty()
                && self.cases.expect(&options.expected, &member.case_id(case), &on, failed > 0, |_| false)
            {
                self.expected += failed;
            }
        }
    }

    fn add(
        &mut self,
        subject: &Subject,
        (chunk, k): (&UnitChunk<'_>, usize),
        members: &[&Member],
        tally: &UnitTally,
        pixels: &[Units],
        options: &Options,
    ) {
        let (member, piece, cases) = (chunk.members[k], &chunk.pieces[k], &chunk.cases[k]);
        let id = |place: usize| member.case_id(cases[place]);
        self.tiers.add(&tally.tiers);
        self.stores.components.iter_mut().zip(&tally.stores).for_each(|(counts, of)| counts.add(of));
        self.stores.model = [self.stores.model[0] + tally.model.0, self.stores.model[1] + tally.model.1];
        if self.stores.departure.is_none() {
            self.stores.departure = tally.departure.map(id);
        }
        if piece.program.is_special() {
            let on_record = |name: &str| policy::recorded(subject.known.special_record?.0, name, self.target);
            self.special.extend(cases.iter().zip(pixels).map(|(case, pixel)| {
                let id = member.case_id(*case);
                let name = id.rsplit('/').next().unwrap_or_default();
                SpecialUse {
                    recorded: on_record(name).map(Into::into),
                    id,
                    adapter: subject.identity.name.clone(),
                    target: self.target.name().into(),
                    seen: policy::observed(*pixel),
                }
            }));
        }
        let of = members.iter().position(|one| one.spec.id == member.spec.id).unwrap_or_default();
        let (way, program, route) = (way_of(of, piece.route), piece.program, piece.route);
        let drawn = DrawnState { program, route, target: self.target, profile: options.profile };
        for &(place, _) in &tally.failing {
            let kept = || FailingPixel { drawn, case: piece.case(place), pixel: pixels[place] };
            self.samples.push((way, cases[place]), row_number(number_of(member, piece.route), cases[place]), kept);
        }
        let inputs = |place: usize| piece.inputs[place * piece.stride..(place + 1) * piece.stride].to_vec();
        let number = self.pieces;
        self.pieces += 1;
        let kept = |&place: &usize, &(pixel, expected): &(Units, ExpectedPixel)| KeptPixel {
            of,
            route,
            inputs: inputs(place),
            pixel,
            expected,
        };
        let mut verdicts = tally.verdicts.within(|&place| (number, place, id(place)), kept);
        let hard = cases.iter().filter(|case| matches!(case, CaseRef::Hard(_))).count() as u64;
        let totals = verdicts.totals;
        verdicts.random = (totals.verdicts.saturating_sub(4 * hard), totals.indeterminate.saturating_sub(4 * hard));
        self.verdicts.add(verdicts);
    }

    pub(super) fn finish(self, members: &[&Member], subject: &Subject, options: &Options, report: &mut Report) {
        if self.rows.is_empty() {
            return;
        }
        let group = members[0].spec.group();
        let mut totals = self.verdicts.totals;
        totals.failed -= self.expected;
        totals.expected_failures += self.expected;
        self.cases.note(&mut report.expectations);
        for (&(of, case), why) in &self.cases.refused {
            let id = members[of].case_id(case);
            let refused = unjudged(id, why.message(), stage(subject), &subject.identity.name);
            report.failures.push(Failure { target: Some(self.target.name().into()), ..refused });
        }
        for (name, excused) in &self.verdicts.excused {
            report.excuse(name, &subject.identity.name, *excused);
        }
        let mut problems = problems(&self.special, &self.stores, &subject.known, self.target);
        if problems.is_empty() {
            problems.extend(self.verdicts.problem());
        }
        let is_unorm = self.target.is_unorm() && totals.cases > 0;
        let stage = stage(subject);
        report.groups.push(Group {
            target: Some(self.target.name().into()),
            tiers: is_unorm.then_some(self.tiers),
            store: store_of(&self.stores, &subject.known, self.target).filter(|_| is_unorm),
            totals: Totals {
                cases: totals.cases + self.skipped,
                skipped: self.skipped,
                failed_groups: u64::from(!problems.is_empty()),
                ..totals
            },
            error_ulp_max: Number(self.verdicts.error_max),
            margin_max: Number(self.verdicts.worst.as_ref().map_or(0.0, |(margin, _)| *margin)),
            seconds: self.seconds,
            seconds_warm: self.seconds_warm,
            worst: self.verdicts.worst.as_ref().map(|(_, (.., id))| id.clone()),
            skip_reason: self.lacks.map(Into::into),
            diagnosis: diagnosed(&self.samples),
            sample: options.keeps_samples().then(|| sampled(&self, members)),
            problems,
            by_case: options.counts_cases.then(|| self.cases.told(members, group)),
            ..Group::new(group.into(), subject.identity.name.clone(), stage)
        });
        report.special.extend(self.special);
        // Two routes of a state have the same cases.
        let is_same = |one: &PixelPlace, other: &PixelPlace| one.2 == other.2;
        let told = |((.., id), kept): (PixelPlace, _)| failure(members, id, kept, self.target, subject);
        report.failures.extend(self.verdicts.reported(is_same).take(KEPT_FAILURES).map(told));
        report.blend_states.extend(self.rows);
    }
}

/// The place of a formula with a route.
fn way_of(member: usize, route: Route) -> usize {
    let route = Route::ALL.iter().position(|one| *one == route).unwrap_or_default();
    member * Route::ALL.len() + route
}

/// A number for a formula with a route.
fn number_of(member: &Member, route: Route) -> u64 {
    member.number ^ way_of(0, route) as u64
}

/// What a shard keeps of a group that a blend unit drew.
fn sampled(standing: &UnitStanding, members: &[&Member]) -> GroupSample {
    GroupSample {
        formulas: members.iter().map(|member| member.spec.id.clone()).collect(),
        failing: vec![],
        random: standing.verdicts.random.into(),
        wrong: packed(&standing.samples, |kept| kept.pixel.map(narrow).to_vec()),
        right: SampledRows::default(),
        stores: standing.target.is_unorm().then(|| standing.stores.clone()),
    }
}

/// A component of a pixel as a shard keeps it.
#[expect(clippy::cast_possible_truncation, reason = "a value of a target fits binary32")]
const fn narrow(value: f64) -> f32 {
    value as f32
}

/// A sample of failing pixels that a shard kept, read for a whole of some members.
pub(crate) fn unpacked_pixels(sample: &GroupSample, members: &[&Member]) -> Result<ReadRows, BadSample> {
    let place = |id: &String| members.iter().position(|member| member.spec.id == *id).unwrap_or(usize::MAX);
    let places: Vec<usize> = (sample.formulas.iter().map(place))
        .flat_map(|of| {
            (0..Route::ALL.len()).map(move |route| of.saturating_mul(Route::ALL.len()).saturating_add(route))
        })
        .collect();
    let by_routes = |member: &&'_ Member| Route::ALL.map(|route| number_of(member, route));
    let each: Vec<(&Member, u64)> =
        members.iter().flat_map(|member| by_routes(member).map(|number| (*member, number))).collect();
    unpacked(&sample.wrong, &places, &each, SAMPLES)
}

/// Failing pixels that shards kept, with their cases drawn.
pub(crate) fn with_cases(
    pixels: ReadRows,
    members: &[&Member],
    target: TargetFormat,
    profile: &'static Profile,
    seed: u64,
) -> PixelSample {
    pixels.with(|(way, case), values| {
        let (member, route) = (members[way / Route::ALL.len()], Route::ALL[way % Route::ALL.len()]);
        let Kind::Blend(program) = member.spec.kind else { unreachable!("only blend states are drawn by the unit") };
        let mut inputs = vec![];
        member.inputs(case, seed, &mut inputs);
        FailingPixel {
            drawn: DrawnState { program, route, target, profile },
            case: program.case(&inputs),
            pixel: std::array::from_fn(|k| values[k].into()),
        }
    })
}

/// What explains the failing pixels of a group, by a sample of them.
pub(crate) fn diagnosed(samples: &PixelSample) -> Option<Diagnosis> {
    let pixels: Vec<FailingPixel> = samples.rows().into_iter().map(|(_, kept)| *kept).collect();
    let found = diagnose(&pixels)?;
    Some(Diagnosis { failing: samples.seen, ..found })
}

fn failure(members: &[&Member], id: String, kept: KeptPixel, target: TargetFormat, subject: &Subject) -> Failure {
    let KeptPixel { of, route, inputs, pixel, expected } = kept;
    let member = members[of];
    let verdict = |k: usize| expected.judge(target, k, pixel[k]);
    let k = (0..4).find(|&k| verdict(k).outcome == Outcome::Fail).unwrap_or_default();
    let mut bytes = vec![];
    pixel::write(target, pixel, &mut bytes);
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    let is_asked = subject.asked().is_some();
    Failure {
        rerun: String::new(),
        id,
        adapter: subject.identity.name.clone(),
        stage: stage(subject).into(),
        target: Some(target.name().into()),
        route: Some(route.name().into()),
        sample: None,
        output: format!("color.{}", ["r", "g", "b", "a"][k]),
        inputs: by_name(member, &inputs, |x| serde_json::to_value(Number(x.into())).unwrap_or_default()),
        units: units(member),
        inputs_hex: if is_asked { serde_json::Map::new() } else { by_name(member, &inputs, bits_in_hex) },
        reference: Number(expected.reference[k]),
        interval: [Number(expected.low[k]), Number(expected.high[k])],
        promise: None,
        value: Number(pixel[k]),
        value_hex: format!("pixel bytes {hex}"),
        unwritten: false,
        error_ulp: Number(verdict(k).error),
        answer: is_asked.then(|| FailedAnswer {
            inputs: inputs.iter().map(|&x| Number(x.into())).collect(),
            outputs: ["r", "g", "b", "a"].map(|k| format!("color.{k}")).to_vec(),
            reference: expected.reference.map(Number).to_vec(),
            interval: (0..4).map(|k| [Number(expected.low[k]), Number(expected.high[k])]).collect(),
            value: pixel.map(Number).to_vec(),
            problem: None,
        }),
    }
}
