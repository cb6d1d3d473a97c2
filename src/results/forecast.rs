//! What work will cost, judged by its beginning, so that nobody finds out after a day or on a full disk.

use crate::engine::Schedule;
use std::fmt;
use std::time::{Duration, Instant as Clock};

/// Time of computing in s that a run may take unasked: as long as one waits without a plan.
pub const MOST_SECONDS: f64 = 600.0;

/// Size in bytes of the time series that a run may write unasked: what spreadsheets and editors no longer open.
pub const MOST_BYTES: f64 = 1e9;

/// A run is judged by its first two seconds of computing, in which any machine has begun to hit; the size
/// of what it writes by so many rows.
const JUDGED_AFTER: Duration = Duration::from_secs(2);
const JUDGED_ROWS: u64 = 1000;

/// What a whole run will cost.
///
/// ```
/// use freeplay::results::Forecast;
///
/// assert!(Forecast { seconds: Some(1e5), bytes: 0.0 }.is_too_much(), "a day");
/// assert!(!Forecast { seconds: Some(10.0), bytes: 1e6 }.is_too_much());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Time of computing in s, where it is known yet.
    pub seconds: Option<f64>,
    /// Size of the time series in bytes; 0 where none is written.
    pub bytes: f64,
}

impl Forecast {
    /// Whether that is more than anybody wants unasked.
    pub fn is_too_much(self) -> bool {
        self.seconds.is_some_and(|seconds| seconds > MOST_SECONDS) || self.bytes > MOST_BYTES
    }
}

impl fmt::Display for Forecast {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let Some(seconds) = self.seconds {
            let (value, unit) = match seconds {
                s if s < 7200.0 => (s / 60.0, "min"),
                s if s < 172_800.0 => (s / 3600.0, "hours"),
                s => (s / 86_400.0, "days"),
            };
            write!(f, "take about {value:.0} {unit} of computing")?;
            f.write_str(if self.bytes > 0.0 { " and " } else { "" })?;
        }
        match self.bytes {
            0.0 => Ok(()),
            bytes if bytes < 1e8 => write!(f, "write about {:.0} MB", bytes / 1e6),
            bytes => write!(f, "write about {:.1} GB", bytes / 1e9),
        }
    }
}

/// Watches the beginning of a run.
#[derive(Debug)]
pub(crate) struct Beginning {
    /// When the first row came: what is prepared before does not grow with the run.
    started: Option<Clock>,
    schedule: Schedule,
    rows: u64,
    timed: bool,
}

impl Beginning {
    pub fn new(schedule: Schedule) -> Self {
        Self { started: None, schedule, rows: 0, timed: false }
    }

    /// What the run will cost, where that is too much; asked at each row (time `t` in s, so many `bytes`
    /// written).
    pub fn too_much(&mut self, t: f64, bytes: u64) -> Option<Forecast> {
        self.rows += 1;
        let elapsed = self.started.get_or_insert_with(Clock::now).elapsed();
        let time = !self.timed && t > 0.0 && elapsed > JUDGED_AFTER;
        if !time && self.rows != JUDGED_ROWS {
            return None;
        }
        self.timed |= time;
        let share = t / self.schedule.duration;
        let seconds = (elapsed > JUDGED_AFTER).then(|| elapsed.as_secs_f64() / share);
        let rows = self.schedule.intervals() as f64 + 1.0;
        let forecast = Forecast { seconds, bytes: bytes as f64 / self.rows as f64 * rows };
        forecast.is_too_much().then_some(forecast)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_size_follows_from_the_first_rows() {
        let schedule = Schedule { duration: 1e3, interval: 1e-4 };
        let mut beginning = Beginning::new(schedule);
        let told: Vec<Forecast> = (1..=2000)
            .filter_map(|row| beginning.too_much(f64::from(row) * 1e-4, 200 * row as u64))
            .collect();
        assert_eq!(told.len(), 1);
        assert!((told[0].bytes - 2e9).abs() < 1e6);
        assert_eq!(told[0].to_string(), "write about 2.0 GB");
    }

    /// On a busy computer preparing a run took more than the two seconds, and its first row was taken for what they had brought.
    #[test]
    fn the_clock_runs_from_the_first_row() {
        let mut beginning = Beginning::new(Schedule { duration: 20.0, interval: 5e-4 });
        assert_eq!(beginning.started, None, "what is prepared before does not count");
        assert_eq!(beginning.too_much(0.0, 0), None);
        let first = beginning.started.expect("the first row came");
        beginning.started = first.checked_sub(2 * JUDGED_AFTER);
        let told = beginning.too_much(1e-3, 0).and_then(|forecast| forecast.seconds);
        assert!(told.is_some_and(|seconds| seconds >= 4.0 * 20.0 / 1e-3), "{told:?}");
    }

    #[test]
    fn forecasts_read_well() {
        let forecast = Forecast { seconds: Some(1500.0), bytes: 3e7 };
        assert_eq!(forecast.to_string(), "take about 25 min of computing and write about 30 MB");
        assert!(forecast.is_too_much());
        let forecast = Forecast { seconds: Some(9000.0), bytes: 0.0 };
        assert_eq!(forecast.to_string(), "take about 2 hours of computing");
    }
}
