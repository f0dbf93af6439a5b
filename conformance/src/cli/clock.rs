//! When a result is made.

use std::time::{SystemTime, UNIX_EPOCH};

/// When a result is made, in UTC: now, or what `SOURCE_DATE_EPOCH` says, by which a result can be made twice alike.
pub(crate) fn now() -> Option<String> {
    let said = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|seconds| seconds.parse().ok());
    let since = || SystemTime::now().duration_since(UNIX_EPOCH).ok();
    said.or_else(|| Some(since()?.as_secs())).map(utc)
}

/// Seconds since 1970 as a date and a time of day, as RFC 3339 writes it.
fn utc(seconds: u64) -> String {
    const YEARS: u64 = 400;
    const DAYS: u64 = 146_097;
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    // Years that begin with March end with the day that not every year has, and the calendar repeats after 400 of them.
    let days = days + 719_468;
    let (era, day) = (days / DAYS, days % DAYS);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (year, month) = (YEARS * era + year + u64::from(month >= 10), if month < 10 { month + 3 } else { month - 9 });
    let (hour, minute, second) = (second / 3_600, second / 60 % 60, second % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_dates_across_leap_days_and_centuries() {
        for (seconds, expected) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (1_709_251_199, "2024-02-29T23:59:59Z"),
            (1_709_251_200, "2024-03-01T00:00:00Z"),
            (1_777_636_800, "2026-05-01T12:00:00Z"),
            (4_107_542_399, "2100-02-28T23:59:59Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ] {
            assert_eq!(utc(seconds), expected);
        }
    }
}
