//! The present motion of the drives, as a candidate beside those that are searched: what is planned is never worse.

use super::limits::{DriveLimits, positions};
use super::series::Extremes;
use crate::calibrate::sensed::recording::Recording;
use crate::measure::filter::derivative;
use crate::mechanism::Mechanism;
use std::sync::Arc;

/// What one drive was told, row by row.
#[derive(Debug, PartialEq)]
pub struct ToldRows {
    interval: f64,
    /// Coordinate from the first row's on, rate and acceleration, by differences of rows.
    rows: Vec<[f64; 3]>,
}

impl ToldRows {
    /// Of coordinates (m, rad) every `interval` seconds.
    pub fn new(coordinates: &[f64], interval: f64) -> Self {
        let rate = derivative(coordinates, interval);
        let acceleration = derivative(&rate, interval);
        let first = coordinates.first().copied().unwrap_or_default();
        let all = coordinates.iter().zip(rate).zip(acceleration);
        Self { interval, rows: all.map(|((q, v), a)| [q - first, v, a]).collect() }
    }

    /// At time `t` (s), between rows along their chord; as the last row is from there on.
    fn at(&self, t: f64) -> [f64; 3] {
        let Some(last) = self.rows.last() else { return [0.0; 3] };
        let place = (t / self.interval).max(0.0);
        let row = place as usize;
        match (self.rows.get(row), self.rows.get(row + 1)) {
            (Some(a), Some(b)) => {
                std::array::from_fn(|k| a[k] + (place - row as f64) * (b[k] - a[k]))
            }
            _ => *last,
        }
    }

    /// Lowest and highest of coordinate, rate or acceleration (0, 1, 2), zero among them.
    fn range(&self, k: usize) -> [f64; 2] {
        self.rows.iter().fold([0.0, 0.0], |[low, high], row| [low.min(row[k]), high.max(row[k])])
    }

    fn largest(&self, k: usize) -> f64 {
        let [low, high] = self.range(k);
        high.max(-low)
    }
}

/// The present motion of a drive, or so much of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Present {
    /// What it was told.
    pub rows: Arc<ToldRows>,
    /// Where it begins, m or rad.
    pub start: f64,
    /// Share of its size.
    pub share: f64,
}

impl Present {
    /// `factor` times as large, from another coordinate (m, rad) on.
    pub fn scaled(&self, factor: f64, start: f64) -> Self {
        Self { rows: Arc::clone(&self.rows), start, share: factor * self.share }
    }

    /// Coordinate (m, rad), rate and acceleration at time `t` (s).
    pub fn at(&self, t: f64) -> [f64; 3] {
        let [position, rate, acceleration] = self.rows.at(t).map(|value| self.share * value);
        [self.start + position, rate, acceleration]
    }

    /// Its bounds.
    pub fn extremes(&self) -> Extremes {
        let largest = |k| self.share * self.rows.largest(k);
        let reach = self.rows.range(0).map(|end| self.start + self.share * end);
        Extremes { reach, speed: largest(1), acceleration: largest(2) }
    }
}

/// The present motion of all drives, as large as the limits allow and no larger than it is; none where it is shorter than
/// what is planned, or does not say what all drives were told.
pub fn present(
    mechanism: &Mechanism,
    recording: &Recording,
    limits: &[DriveLimits],
    samples: usize,
) -> Option<Vec<Present>> {
    if recording.samples < samples {
        return None;
    }
    let told = (0..limits.len()).map(|drive| positions(mechanism, drive, recording));
    let told: Vec<Vec<f64>> = told.collect::<Option<_>>()?;
    let rows: Vec<ToldRows> =
        told.iter().map(|q| ToldRows::new(&q[..samples], recording.interval)).collect();
    // One share for all: drives of a closed chain move together.
    let fits = |(rows, limit): (&ToldRows, &DriveLimits)| {
        let [low, high] = rows.range(0);
        let stroke = (limit.stroke[1] - limit.stroke[0]) / (high - low);
        stroke.min(limit.speed / rows.largest(1)).min(limit.acceleration / rows.largest(2))
    };
    let share = rows.iter().zip(limits).map(fits).fold(1.0, f64::min);
    let one = |((rows, limit), told): ((ToldRows, &DriveLimits), &Vec<f64>)| {
        let [low, high] = rows.range(0);
        let room = [limit.stroke[0] - share * low, limit.stroke[1] - share * high];
        let start = told[0].max(room[0]).min(room[1]);
        Present { rows: Arc::new(rows), start, share }
    };
    Some(rows.into_iter().zip(limits).zip(&told).map(one).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_met_and_chords_lie_between() {
        let rows = ToldRows::new(&[0.5, 0.5, 0.75, 1.25], 0.25);
        assert_eq!(rows.at(0.5), [0.25, 1.5, 3.0]);
        assert_eq!(rows.at(0.625)[0], 0.5);
        assert_eq!(rows.at(9.0)[0], 0.75);
        assert_eq!(rows.range(0), [0.0, 0.75]);
    }
}
