//! Times in turns: everything that is compared is measured in each turn, so that what else the machine does falls upon all
//! alike, and a ratio is of two times of the same turn. What is measured in a turn is the least of a few readings.

use super::ended::{BenchError, unless_stopped};
use lightmeter_document::bench::{Rank, Time};
use lightmeter_document::event::Stop;
use lightmeter_gpu::{ClockReading, GpuError};

/// Something that is timed, and how much of it at once.
pub struct Entry<'a> {
    /// The clock, as reports name it.
    clock: &'static str,
    /// Seconds of so much work at once.
    run: Box<dyn FnMut(u32) -> Result<ClockReading, GpuError> + 'a>,
    /// Units, in which times are given, of one of that.
    units: f64,
    /// The most at once.
    most: u32,
    /// How much at once.
    amount: u32,
}

/// The seconds of a unit in each turn; `None` where a reading could not be true.
pub type Laps = Vec<Option<f64>>;

/// How long, and how often.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Turns.
    pub turns: usize,
    /// Readings of a turn, of which the least counts.
    pub readings: usize,
    /// Seconds of a measurement, at least.
    pub seconds: f64,
}

impl<'a> Entry<'a> {
    /// Something that `run` times: an amount of it at once, `most` at most, each of a number of units.
    pub fn new(
        clock: &'static str,
        units: f64,
        most: u32,
        run: impl FnMut(u32) -> Result<ClockReading, GpuError> + 'a,
    ) -> Self {
        Self { clock, run: Box::new(run), units, most, amount: 1 }
    }

    /// Runs it until a measurement is long enough, so that it is warm, too.
    fn calibrate(&mut self, seconds: f64) -> Result<(), GpuError> {
        // The first time may compile.
        (self.run)(1)?;
        loop {
            let taken = (self.run)(self.amount)?.seconds();
            if self.amount >= self.most || taken.is_some_and(|taken| taken >= seconds) {
                return Ok(());
            }
            // Straight to the goal once the reading means something; what cannot be read is doubled.
            let factor = taken.map_or(2.0, |taken| (1.2 * seconds / taken).clamp(2.0, 16.0));
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "positive, and cut off at most"
            )]
            let next = (f64::from(self.amount) * factor).min(f64::from(self.most)) as u32;
            self.amount = next;
        }
    }

    /// The least of some readings: what else the machine does can only make one longer.
    fn lap(&mut self, readings: usize) -> Result<Option<f64>, GpuError> {
        let mut least: Option<f64> = None;
        for _ in 0..readings {
            if let Some(seconds) = (self.run)(self.amount)?.seconds() {
                least = Some(least.map_or(seconds, |least| least.min(seconds)));
            }
        }
        Ok(least.map(|seconds| seconds / (f64::from(self.amount) * self.units)))
    }

    /// The clock, as reports name it.
    #[must_use]
    pub const fn clock(&self) -> &'static str {
        self.clock
    }
}

/// Measures all in turns, forwards and backwards by turns: the laps of each.
///
/// # Errors
/// Where a device fails, or somebody stops it: laps of a part of the turns are none.
pub fn measure(entries: &mut [Entry<'_>], effort: Effort, stop: &Stop) -> Result<Vec<Laps>, BenchError> {
    for entry in entries.iter_mut() {
        unless_stopped(stop)?;
        entry.calibrate(effort.seconds)?;
    }
    let mut laps: Vec<Laps> = vec![vec![]; entries.len()];
    for turn in 0..effort.turns {
        let mut order: Vec<usize> = (0..entries.len()).collect();
        if turn % 2 == 1 {
            order.reverse();
        }
        for k in order {
            unless_stopped(stop)?;
            laps[k].push(entries[k].lap(effort.readings)?);
        }
    }
    Ok(laps)
}

/// The time that laps tell beside those of a baseline; `None` where no turn has both.
///
/// The ratio is the median of the turns' ratios. Its spread goes from the least of them to the greatest: whatever their
/// distribution, its median lies within with a probability of 1 − 2/2ⁿ (99.9 % for 11 turns, 93.8 % for 5).
#[must_use]
pub fn time(clock: &'static str, own: &Laps, baseline: Option<&Laps>) -> Option<Time> {
    let mut kept: Vec<f64> = own.iter().flatten().copied().collect();
    if kept.is_empty() {
        return None;
    }
    kept.sort_by(f64::total_cmp);
    let (ratio, spread, verdict) = match baseline {
        None => (1.0, [1.0, 1.0], Rank::Baseline),
        Some(baseline) => {
            let (ratio, spread) = ratio(own, baseline)?;
            (ratio, spread, standing(spread))
        }
    };
    Some(Time {
        clock: clock.into(),
        ns: 1e9 * median(&kept),
        quartiles_ns: [1e9 * kept[kept.len() / 4], 1e9 * kept[kept.len() - 1 - kept.len() / 4]],
        ratio,
        spread,
        verdict,
        turns: kept.len(),
        rejected: own.len() - kept.len(),
        note: None,
    })
}

/// What is left of each turn when something else's time in it is taken off; nothing where that is not above 0.
#[must_use]
pub fn net(own: &Laps, idle: &Laps) -> Laps {
    own.iter().zip(idle).map(|(own, idle)| Some((*own)? - (*idle)?).filter(|net| *net > 0.0)).collect()
}

/// The median part of the whole that is left; 0 where any turn has nothing left.
#[must_use]
pub fn share(net: &Laps, whole: &Laps) -> f64 {
    let shares = net.iter().zip(whole).filter(|(_, whole)| whole.is_some());
    let mut shares: Vec<f64> = shares.map(|(net, whole)| net.unwrap_or(0.0) / whole.unwrap_or(1.0)).collect();
    shares.sort_by(f64::total_cmp);
    if shares.first().is_none_or(|least| *least <= 0.0) { 0.0 } else { median(&shares) }
}

/// Why there is no time.
#[must_use]
pub fn reason(own: &Laps) -> &'static str {
    if own.iter().all(Option::is_none) {
        "every reading of the clock was one that cannot be true"
    } else {
        "no turn has a reading of it and of the baseline that can be true"
    }
}

/// The median of the turns' ratios, and its spread.
#[must_use]
pub fn ratio(own: &Laps, baseline: &Laps) -> Option<(f64, [f64; 2])> {
    let mut ratios: Vec<f64> =
        own.iter().zip(baseline).filter_map(|(own, baseline)| Some((*own)? / (*baseline)?)).collect();
    if ratios.is_empty() {
        return None;
    }
    ratios.sort_by(f64::total_cmp);
    Some((median(&ratios), [ratios[0], ratios[ratios.len() - 1]]))
}

/// What the spread of a ratio says.
#[must_use]
pub fn standing([low, high]: [f64; 2]) -> Rank {
    if high < 1.0 {
        Rank::Faster
    } else if low > 1.0 {
        Rank::Slower
    } else {
        Rank::Tie
    }
}

/// Of sorted values.
#[must_use]
pub fn median(sorted: &[f64]) -> f64 {
    let n = sorted.len();
    if n % 2 == 1 { sorted[n / 2] } else { 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laps(of: &[f64]) -> Laps {
        of.iter().copied().map(Some).collect()
    }

    #[test]
    fn a_rejected_reading_is_in_no_figure() {
        let own = vec![Some(2.0), None, Some(2.0), Some(1e9)];
        let base = vec![Some(1.0), Some(1.0), Some(1.0), None];
        let time = time("timestamps", &own, Some(&base)).expect("two turns have both");
        assert_eq!((time.rejected, time.turns), (1, 3));
        assert!((time.ratio - 2.0).abs() < 1e-12 && (time.spread[1] - 2.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_taken_off_leaves_the_rest_of_each_turn() {
        let own = vec![Some(3.0), Some(4.0), None, Some(1.0)];
        let idle = vec![Some(1.0), Some(1.0), Some(1.0), Some(2.0)];
        assert_eq!(net(&own, &idle), [Some(2.0), Some(3.0), None, None]);
        assert!((share(&net(&own[..3].to_vec(), &idle), &own[..3].to_vec()) - 0.5 * (2.0 / 3.0 + 0.75)).abs() < 1e-12);
        assert!(share(&net(&own, &idle), &own) == 0.0, "nothing was left in a turn");
    }

    #[test]
    fn where_all_are_rejected_there_is_no_time() {
        assert!(time("timestamps", &vec![None; 5], None).is_none());
        assert!(time("timestamps", &laps(&[1.0]), Some(&vec![None])).is_none());
    }

    #[test]
    fn a_ratio_within_its_spread_of_one_is_a_tie() {
        let base = laps(&[1.0; 7]);
        let verdict = |own: &[f64]| time("wall", &laps(own), Some(&base)).expect("it is measured").verdict;
        assert_eq!(verdict(&[1.1, 1.2, 0.9, 1.3, 0.95, 1.2, 1.1]), Rank::Tie);
        assert_eq!(verdict(&[1.1, 1.2, 1.1, 1.3, 1.05, 1.2, 1.1]), Rank::Slower);
        assert_eq!(verdict(&[0.8, 0.8, 0.8, 0.8, 0.95, 0.9, 0.7]), Rank::Faster);
    }

    #[test]
    fn the_clock_of_each_turn_serves_all() {
        // A machine that is three times slower in every other turn.
        let own = laps(&[2.0, 6.0, 2.0, 6.0, 2.0, 6.0, 2.0]);
        let base = laps(&[1.0, 3.0, 1.0, 3.0, 1.0, 3.0, 1.0]);
        let (ratio, spread) = ratio(&own, &base).expect("all turns have both");
        assert!((ratio - 2.0).abs() < 1e-12 && spread[1] - spread[0] < 1e-12);
    }

    #[test]
    fn work_grows_until_it_takes_long_enough() {
        let mut most_at_once = 0;
        let mut entries = [Entry::new("wall", 1.0, 1 << 20, |amount| {
            most_at_once = most_at_once.max(amount);
            Ok(ClockReading::Seconds(f64::from(amount) * 1e-6))
        })];
        let effort = Effort { turns: 3, readings: 1, seconds: 1e-3 };
        let laps = measure(&mut entries, effort, &Stop::default()).expect("nothing fails");
        assert!(laps[0].iter().all(|lap| (lap.expect("it is read") - 1e-6).abs() < 1e-12));
        drop(entries);
        assert!((1_000..=32_000).contains(&most_at_once), "{most_at_once}");
    }
}
