//! A named blend mode over every byte of source, destination and source's alpha, by the blend unit on rgba8unorm.
//!
//! A pixel carries three inputs, one in each of its colour components, which share its alpha. Inputs are numbered by alpha, then
//! source, then destination.

use super::plan::SweepPlan;
use super::work::Work;
use crate::blend_unit::draw::draw;
use crate::device::{Code, DeviceError};
use crate::piece::Piece;
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_document::Number;
use lightmeter_document::sweep::{ExactFloat, Statistics, StoreStatistics, SweepInput, SweepVerdict};
use lightmeter_judge::Outcome;
use lightmeter_judge::blend_unit::expect::expect;
use lightmeter_judge::blend_unit::pixel::{self, Units};
use lightmeter_judge::blend_unit::rules::Rules;
use lightmeter_judge::blend_unit::store::{StoreCounts, Stores as _};
use lightmeter_judge::blend_unit::tally::count_tier;
use lightmeter_scene::blend::Route;
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;

const TARGET: TargetFormat = TargetFormat::Rgba8Unorm;
/// Inputs of one alpha, which one piece draws.
const PLANE: u64 = 1 << 16;
/// Inputs of a pixel.
const COMPONENTS: usize = 3;

/// The blend unit at work on a mode.
pub(super) struct BytesWork<'a> {
    subject: &'a mut Subject,
    code: &'a Code,
    program: Program,
    stride: usize,
    profile: &'static Profile,
}

impl<'a> BytesWork<'a> {
    /// The unit of a subject; `Err` says what it lacks.
    pub(super) fn new(
        plan: &SweepPlan<'_>,
        subject: &'a mut Subject,
        code: &'a Code,
        profile: &'static Profile,
    ) -> Result<Self, &'static str> {
        if let Some(reason) = subject.lacks_blending(TARGET) {
            return Err(reason);
        }
        let Kind::Blend(program) = plan.member.spec.kind else { return Err("it is no blend state") };
        Ok(Self { subject, code, program, stride: plan.member.spec.input_len(), profile })
    }

    /// Inputs from one number to another, of one alpha, three to a pixel; the last pixel may repeat its last one.
    fn piece(&self, from: u64, to: u64) -> Piece {
        let mut inputs = vec![];
        for first in (from..to).step_by(COMPONENTS) {
            let bytes: [[u8; 3]; COMPONENTS] =
                std::array::from_fn(|component| bytes((first + component as u64).min(to - 1)));
            let unit = |byte: u8| f32::from(byte) / 255.0;
            inputs.extend(bytes.map(|[_, source, _]| unit(source)));
            inputs.push(unit(bytes[0][0]));
            inputs.extend(bytes.map(|[_, _, destination]| unit(destination)));
        }
        Piece { program: self.program, route: Route::Native, inputs, stride: self.stride }
    }

    fn judge(&self, piece: &Piece, pixels: &[Units], from: u64, to: u64) -> Statistics {
        let mut sum = Statistics::default();
        let mut stored = StoreStatistics::default();
        let mut counts = StoreCounts::default();
        let (_, mask) = self.program.layer(0);
        for (place, (first, pixel)) in (from..to).step_by(COMPONENTS).zip(pixels).enumerate() {
            let case = piece.case(place);
            let expected = expect(self.program, TARGET, &case, &Rules::RIGHT, self.profile);
            let model = self.subject.known.blend_model;
            let predicted = model.map(|model| {
                model.predict(self.program, piece.route, &case, pixel::stored(TARGET.encoding(), case.dst))
            });
            for (component, number) in (first..to).take(COMPONENTS).enumerate() {
                let value = pixel[component];
                let verdict = expected.judge(TARGET, component, value);
                let [alpha, source, destination] = bytes(number);
                #[expect(clippy::cast_possible_truncation, reason = "a whole step")]
                let seen = SweepVerdict {
                    input: SweepInput::Bytes { source, destination, alpha },
                    value: ExactFloat(value as f32),
                    reference: Number(expected.reference[component]),
                    low: Number(expected.low[component]),
                    high: Number(expected.high[component]),
                    error: Number(verdict.error),
                    margin: Number(verdict.margin),
                };
                sum.inputs += 1;
                sum.histogram.count(verdict.error);
                sum.see_error(seen);
                if verdict.error >= 1.0 {
                    sum.see_margin(seen);
                }
                if verdict.outcome == Outcome::Pass {
                    sum.passed += 1;
                } else {
                    sum.failed += 1;
                    sum.see_failure(seen);
                }
                count_tier(&mut stored.tiers, expected.reference[component], value, verdict.outcome);
                if mask.0[component] {
                    counts.count(expected.reference[component], value);
                }
                if let Some(predicted) = predicted {
                    stored.predicted += 1;
                    stored.departing += u64::from(predicted[component].to_bits() != value.to_bits());
                }
            }
        }
        stored.counts = counts;
        sum.stored = Some(stored);
        sum
    }
}

/// Alpha, source and destination of an input.
fn bytes(number: u64) -> [u8; 3] {
    let [.., alpha, source, destination] = number.to_be_bytes();
    [alpha, source, destination]
}

impl Work for BytesWork<'_> {
    type Job = (u64, u64);

    fn start(&mut self, first: u64, count: u64) -> Self::Job {
        (first, first + count)
    }

    fn finish(&mut self, (first, end): Self::Job) -> Result<Statistics, DeviceError> {
        let planes: Vec<(u64, u64)> =
            (first / PLANE..end.div_ceil(PLANE)).map(|k| (first.max(k * PLANE), end.min((k + 1) * PLANE))).collect();
        let pieces: Vec<Piece> = planes.par_iter().map(|&(from, to)| self.piece(from, to)).collect();
        let drawn = draw(self.subject, self.code, TARGET, &pieces.iter().collect::<Vec<_>>(), false)?;
        let of_planes = planes.par_iter().zip(&pieces).zip(&drawn.pieces);
        let parts: Vec<Statistics> =
            of_planes.map(|((&(from, to), piece), pixels)| self.judge(piece, pixels, from, to)).collect();
        let mut sum = Statistics::default();
        parts.into_iter().for_each(|part| sum.add(part));
        Ok(sum)
    }
}
