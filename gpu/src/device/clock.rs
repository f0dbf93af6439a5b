//! How long a device works: by its own timestamps, or, where it has none that can be used, by the clock on the wall.

use super::native::Native;
use super::{Gpu, Place};
use crate::error::GpuError;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Seconds that a submission and the wait for its end may take besides what is timed: far more than any driver needs. Mesa 22.3's
/// llvmpipe notes the timestamps around a dispatch both at its end, once a frame was drawn by the same device.
const SLACK: f64 = 0.05;
/// After this many readings their greatest common divisor is taken for the clock's step. All of them are even multiples of the step, and the divisor so
/// twice the step or more, with a probability of about 1 in 2^16.
const READINGS_FOR_GRAIN: u64 = 16;

/// How a clock tells time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClockKind {
    /// The device's timestamps, before the first pass and after the last.
    Timestamps,
    /// The time from a submission until the device is idle.
    Wall,
}

impl ClockKind {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Timestamps => "timestamps",
            Self::Wall => "wall",
        }
    }
}

/// A reading of a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClockReading {
    /// Seconds.
    Seconds(f64),
    /// A reading that cannot be true, and why.
    Rejected(&'static str),
}

impl ClockReading {
    /// The seconds; `None` of what was rejected.
    #[must_use]
    pub const fn seconds(self) -> Option<f64> {
        match self {
            Self::Seconds(seconds) => Some(seconds),
            Self::Rejected(_) => None,
        }
    }

    /// What two timestamps say, in ticks of `period` seconds, of work that took no more than `wall` seconds.
    #[must_use]
    pub fn of_ticks([start, end]: [u64; 2], period: f64, wall: f64) -> Self {
        // Drivers leave 0 where nothing was written.
        if start == 0 || end == 0 {
            return Self::Rejected("a timestamp is 0: it was never written");
        }
        if end < start {
            return Self::Rejected("the end is before the start");
        }
        if end == start {
            return Self::Rejected("no time went by");
        }
        #[expect(clippy::cast_precision_loss, reason = "2^53 ticks of a nanosecond are a hundred days")]
        let seconds = (end - start) as f64 * period;
        // A period that is no number, or negative, fails here as well.
        if !(seconds > 0.0 && seconds <= wall) {
            Self::Rejected("longer than from the submission to its end by the clock on the wall")
        } else if wall > SLACK + 8.0 * seconds {
            Self::Rejected("a small part of what goes by from the submission to its end: not all work is between them")
        } else {
            Self::Seconds(seconds)
        }
    }
}

/// A clock of a device.
#[derive(Debug)]
pub struct Clock {
    kind: ClockKind,
    /// What timestamps are read through, on a device that is here.
    stamps: Option<Stamps>,
    note: Option<String>,
    readings: AtomicU64,
    rejected: AtomicU64,
    /// What all readings so far are multiples of, in nanoseconds; 0 before the first.
    grain_ns: AtomicU64,
}

#[derive(Debug)]
struct Stamps {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    staging: wgpu::Buffer,
    period: f64,
}

/// The timestamps that a measurement's passes write.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span<'a> {
    queries: Option<&'a wgpu::QuerySet>,
    /// Whether the next pass begins it.
    begins: bool,
    /// Whether the next pass ends it.
    ends: bool,
}

impl<'a> Span<'a> {
    /// Nothing is measured.
    pub(super) const NONE: Self = Self { queries: None, begins: false, ends: false };

    const fn of(queries: &'a wgpu::QuerySet) -> Self {
        Self { queries: Some(queries), begins: true, ends: true }
    }

    /// What one of several parts of the work writes.
    pub(super) const fn part(self, is_first: bool, is_last: bool) -> Self {
        Self { queries: self.queries, begins: self.begins && is_first, ends: self.ends && is_last }
    }

    /// For a compute pass.
    pub(super) fn compute(self) -> Option<wgpu::ComputePassTimestampWrites<'a>> {
        let query_set = self.queries.filter(|_| self.begins || self.ends)?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: self.begins.then_some(0),
            end_of_pass_write_index: self.ends.then_some(1),
        })
    }

    /// For a render pass.
    pub(super) fn render(self) -> Option<wgpu::RenderPassTimestampWrites<'a>> {
        let query_set = self.queries.filter(|_| self.begins || self.ends)?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: self.begins.then_some(0),
            end_of_pass_write_index: self.ends.then_some(1),
        })
    }
}

impl Clock {
    /// The device's timestamps where they can be used, else the clock on the wall.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        if !gpu.has_timestamps() {
            return Ok(Self::wall(Some("the adapter lacks the feature TIMESTAMP_QUERY".into())));
        }
        let Place::Here(native) = &gpu.place else {
            return Ok(Self { kind: ClockKind::Timestamps, ..Self::wall(None) });
        };
        let clock = Self { kind: ClockKind::Timestamps, stamps: Some(Stamps::new(native)), ..Self::wall(None) };
        native.check()?;
        Ok(clock)
    }

    /// The clock on the wall, and why it is that.
    #[must_use]
    pub fn wall(note: Option<String>) -> Self {
        let [readings, rejected, grain_ns] = Default::default();
        Self { kind: ClockKind::Wall, stamps: None, note, readings, rejected, grain_ns }
    }

    /// How it tells time.
    #[must_use]
    pub const fn kind(&self) -> ClockKind {
        self.kind
    }

    /// Readings that were taken so far, and how many of them could not be true.
    #[must_use]
    pub fn readings(&self) -> (u64, u64) {
        (self.readings.load(Ordering::Relaxed), self.rejected.load(Ordering::Relaxed))
    }

    /// The steps in which a clock elsewhere tells time, in nanoseconds: what all its readings are multiples of. Browsers round time, so that pages
    /// cannot spy by it. `None` of a clock that is here, and where too few readings were taken to tell.
    #[must_use]
    pub fn grain_ns(&self) -> Option<u64> {
        let grain = self.grain_ns.load(Ordering::Relaxed);
        (grain > 0 && self.readings.load(Ordering::Relaxed) >= READINGS_FOR_GRAIN).then_some(grain)
    }

    /// Why it is the clock on the wall.
    #[must_use]
    pub fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Times the passes that are encoded, in a submission of their own on an idle device.
    pub(super) fn time(
        &self,
        native: &Native,
        encode: impl FnOnce(&mut wgpu::CommandEncoder, Span<'_>),
    ) -> Result<ClockReading, GpuError> {
        let mut encoder = native.device.create_command_encoder(&Default::default());
        encode(&mut encoder, self.stamps.as_ref().map_or(Span::NONE, |stamps| Span::of(&stamps.queries)));
        if let Some(stamps) = &self.stamps {
            encoder.resolve_query_set(&stamps.queries, 0..2, &stamps.resolved, 0);
            encoder.copy_buffer_to_buffer(&stamps.resolved, 0, &stamps.staging, 0, 16);
        }
        let commands = encoder.finish();
        native.wait()?;
        let start = Instant::now();
        native.queue.submit([commands]);
        native.wait()?;
        let wall = start.elapsed().as_secs_f64();
        Ok(self.noted(match &self.stamps {
            None => ClockReading::Seconds(wall),
            Some(stamps) => ClockReading::of_ticks(stamps.read(native)?, stamps.period, wall),
        }))
    }

    /// What a device elsewhere tells of work: two timestamps in nanoseconds, and the seconds that went by on the wall.
    pub(super) fn reading(&self, nanoseconds: [u64; 2], wall: f64) -> ClockReading {
        let told = match self.kind {
            ClockKind::Wall => nanoseconds_of(wall),
            ClockKind::Timestamps => nanoseconds[1].saturating_sub(nanoseconds[0]),
        };
        self.grain_ns.store(common(self.grain_ns.load(Ordering::Relaxed), told), Ordering::Relaxed);
        self.noted(match self.kind {
            ClockKind::Wall => ClockReading::Seconds(wall),
            ClockKind::Timestamps => ClockReading::of_ticks(nanoseconds, 1e-9, wall),
        })
    }

    /// Counts a reading.
    fn noted(&self, reading: ClockReading) -> ClockReading {
        self.readings.fetch_add(1, Ordering::Relaxed);
        self.rejected.fetch_add(u64::from(reading.seconds().is_none()), Ordering::Relaxed);
        reading
    }
}

/// A time in whole nanoseconds; a page's clock has rounding errors far below one.
fn nanoseconds_of(seconds: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast saturates")]
    let whole = (seconds * 1e9).round() as u64;
    whole
}

/// The greatest common divisor.
const fn common(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Stamps {
    fn new(native: &Native) -> Self {
        let buffer = |usage| {
            native.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: 16,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            queries: native.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            staging: buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST),
            period: f64::from(native.queue.get_timestamp_period()) * 1e-9,
        }
    }

    fn read(&self, native: &Native) -> Result<[u64; 2], GpuError> {
        let failed = |message: String| GpuError::Device(message);
        self.staging.map_async(wgpu::MapMode::Read, .., |_| {});
        native.wait()?;
        let ticks = {
            let view = self.staging.get_mapped_range(..).map_err(|error| failed(error.to_string()))?;
            let ticks: &[u64] = bytemuck::cast_slice(&view);
            [ticks[0], ticks[1]]
        };
        self.staging.unmap();
        Ok(ticks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_elsewhere_tells_in_what_steps_it_goes() {
        for (kind, grain_ns) in [(ClockKind::Wall, 100_000), (ClockKind::Wall, 5_000), (ClockKind::Timestamps, 65_536)]
        {
            let clock = Clock { kind, ..Clock::wall(None) };
            for k in 0..READINGS_FOR_GRAIN {
                assert_eq!(clock.grain_ns(), None, "too few readings");
                let steps = 7 + k * k;
                #[expect(clippy::cast_precision_loss, reason = "a page's clock counts milliseconds in binary64")]
                let [start, end] = [1_234_567 * grain_ns, (1_234_567 + steps) * grain_ns].map(|ns| ns as f64 / 1e6);
                clock.reading([grain_ns, (1 + steps) * grain_ns], (end - start) / 1e3);
            }
            assert_eq!(clock.grain_ns(), Some(grain_ns), "{kind:?}");
        }
        assert_eq!(Clock::wall(None).grain_ns(), None);
    }

    #[test]
    fn what_cannot_be_true_is_rejected() {
        let nanosecond = 1e-9;
        assert_eq!(
            ClockReading::of_ticks([1_000, 3_000], nanosecond, 0.01),
            ClockReading::Seconds(2_000.0 * nanosecond)
        );
        for ticks in [[0, 5], [5, 0], [0, 0], [7, 5], [u64::MAX, 1], [5, 5]] {
            assert_eq!(ClockReading::of_ticks(ticks, nanosecond, 0.01).seconds(), None, "{ticks:?}");
        }
        // A millisecond of a second.
        assert_eq!(ClockReading::of_ticks([1, 1_000_001], nanosecond, 1.0).seconds(), None);
        assert!(ClockReading::of_ticks([1, 1_000_001], nanosecond, 0.04).seconds().is_some());
        // Two seconds by a device, of one on the wall.
        assert_eq!(ClockReading::of_ticks([1, 2_000_000_001], nanosecond, 1.0).seconds(), None);
        for period in [0.0, -1e-9, f64::NAN, f64::INFINITY] {
            assert_eq!(ClockReading::of_ticks([1, 2], period, 0.01).seconds(), None, "{period}");
        }
    }
}
