//! Windows of recordings, and the start in each that a model fits best.
//!
//! A free machine, or one that efforts alone drive, forgets its start: small errors grow, of a double pendulum
//! by e in a third of a second. So a model is judged by what it predicts over short windows, each from a start
//! that is fitted through the model to the window's first rows (multiple shooting: Bock, *Proc. ICIAM* 1983).

use super::pose::{Coordinates, Pose};
use super::roll::{ReadingTimes, roll};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::mechanism::{Mechanism, Reads};
use nalgebra::{DMatrix, DVector};

/// Time in s between two rows that are compared: a hundredth of a fast swing of 5 Hz.
const LOOK: f64 = 2e-3;

/// Time in s over which readings are smoothed for a first guess of a start, and the degree of that.
const GUESS: f64 = 0.04;

/// Finite differences of coordinates (m, rad) and rates (per s): far above rounding, far below a swing.
const NUDGE: [f64; 2] = [1e-5, 1e-4];

/// Corrections of a start: the third is below 1e-8.
const CORRECTIONS: usize = 4;

/// A stretch of a run.
#[derive(Clone, Debug)]
pub struct Window {
    /// Which run.
    pub run: usize,
    /// Its first row in the recording.
    pub row: usize,
    /// Rows of the recording in one that is compared.
    pub stride: usize,
    /// When readings are compared.
    pub rows: ReadingTimes,
    /// Measured readings, row by row.
    pub measured: Vec<f64>,
}

/// What of a run is compared with readings: the sensors of coordinates, points and angles.
pub fn compared(mechanism: &Mechanism, recordings: &[Recording]) -> Vec<usize> {
    let places = |reads: &Reads| {
        matches!(reads, Reads::Position(_) | Reads::X(_) | Reads::Y(_) | Reads::Angle(..))
    };
    (0..mechanism.sensors.len())
        .filter(|&i| places(&mechanism.sensors[i].reads))
        .filter(|&i| recordings.iter().all(|recording| recording.get(i).is_some()))
        .collect()
}

/// Windows of `length` s every `step` s of a recording, from `from` s after its first row up to `until`.
pub fn cut(
    run: usize,
    recording: &Recording,
    sensors: &[usize],
    [length, step]: [f64; 2],
    [from, until]: [f64; 2],
) -> Vec<Window> {
    let stride = (LOOK / recording.interval).round().max(1.0) as usize;
    let interval = recording.interval * stride as f64;
    let count = (length / interval).round().max(1.0) as usize;
    let step = ((step / interval).round().max(1.0) as usize) * stride;
    let last = recording.samples.min(((until / recording.interval) as usize).saturating_add(1));
    let mut row = (from / recording.interval).round() as usize;
    let mut windows = Vec::new();
    while row + count * stride < last {
        let value = |k: usize, i: usize| recording.get(i).map_or(f64::NAN, |c| c[row + k * stride]);
        let measured =
            (0..=count).flat_map(|k| sensors.iter().map(move |&i| value(k, i))).collect();
        let first = row as f64 * recording.interval;
        windows.push(Window {
            run,
            row,
            stride,
            rows: ReadingTimes { first, interval, count },
            measured,
        });
        row += step;
    }
    windows
}

/// A start: coordinates and rates, and a pose near it.
#[derive(Clone, Debug)]
pub struct WindowStart {
    /// Coordinates, then their rates.
    pub values: Vec<f64>,
    /// A pose on the same branch.
    pub near: Pose,
}

/// A machine that is rolled along a run: zeros are what its sensors show beside what the model says, by place
/// among the compared ones.
#[derive(Clone, Copy, Debug)]
pub struct Shooter<'a> {
    /// With the run's inputs as commands.
    pub mechanism: &'a Mechanism,
    /// What it starts by.
    pub coordinates: &'a Coordinates,
    /// Compared sensors.
    pub sensors: &'a [usize],
    /// What each shows too much in this run.
    pub zeros: &'a [f64],
}

impl Shooter<'_> {
    /// Readings from a start on.
    pub fn shot(&self, start: &WindowStart, rows: ReadingTimes) -> Option<Vec<f64>> {
        let pose = self.coordinates.pose(self.mechanism, &start.near, &start.values)?;
        let mut shown = roll(self.mechanism, &pose, rows, self.sensors)?;
        for row in shown.chunks_mut(self.sensors.len()) {
            row.iter_mut().zip(self.zeros).for_each(|(value, zero)| *value += zero);
        }
        Some(shown)
    }

    /// Readings, and their derivative by each number of the start.
    pub fn derivative(
        &self,
        start: &WindowStart,
        rows: ReadingTimes,
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let shown = DVector::from_vec(self.shot(start, rows)?);
        let half = start.values.len() / 2;
        let columns = (0..start.values.len())
            .map(|k| {
                let mut beside = start.clone();
                beside.values[k] += NUDGE[k / half];
                let there = DVector::from_vec(self.shot(&beside, rows)?);
                Some((there - &shown) / NUDGE[k / half])
            })
            .collect::<Option<Vec<_>>>()?;
        Some((shown, DMatrix::from_columns(&columns)))
    }

    /// A first guess of a window's start from a start before it: readings and their rates by a cubic through the
    /// first rows, and Newton's method on what the sensors show there.
    pub fn guess(&self, window: &Window, before: &WindowStart) -> Option<WindowStart> {
        let n = self.sensors.len();
        let rows = ((GUESS / window.rows.interval) as usize + 1).clamp(6, window.rows.count + 1);
        let t: Vec<f64> = (0..rows).map(|k| k as f64 * window.rows.interval).collect();
        let basis = DMatrix::from_fn(rows, 4, |k, power| t[k].powi(power as i32));
        let readings = DMatrix::from_fn(rows, n, |k, i| window.measured[k * n + i]);
        let fit = basis.svd(true, true).solve(&readings, 1e-12).ok()?;
        let at = ReadingTimes { count: 0, ..window.rows };
        let half = before.values.len() / 2;
        let mut start = before.clone();
        start.values[half..].fill(0.0);
        let mut slopes = DMatrix::zeros(n, half);
        for _ in 0..CORRECTIONS {
            let (shown, jacobian) = self.derivative(&start, at)?;
            slopes = jacobian.columns(0, half).into_owned();
            let missed = DVector::from_fn(n, |i, _| fit[(0, i)] - shown[i]);
            let svd = slopes.clone().svd(true, true);
            if svd.rank(1e-6 * svd.singular_values.max()) < half {
                return None;
            }
            let step = svd.solve(&missed, 1e-9).ok()?;
            start.values.iter_mut().zip(step.iter()).for_each(|(value, step)| *value += step);
            start.near = self.coordinates.pose(self.mechanism, &start.near, &start.values)?;
            if step.amax() < 1e-9 {
                break;
            }
        }
        let rates = DVector::from_fn(n, |i, _| fit[(1, i)]);
        let rates = slopes.svd(true, true).solve(&rates, 1e-9).ok()?;
        start.values[half..].copy_from_slice(rates.as_slice());
        Some(start)
    }

    /// The start that fits a window's first `rows` intervals best, from one near it on; `scales` are what the
    /// sensors' errors are counted in.
    pub fn fitted(
        &self,
        window: &Window,
        rows: usize,
        mut start: WindowStart,
        scales: &[f64],
    ) -> Option<WindowStart> {
        let n = self.sensors.len();
        let part = ReadingTimes { count: rows.min(window.rows.count), ..window.rows };
        for _ in 0..CORRECTIONS {
            let (mut shown, mut jacobian) = self.derivative(&start, part)?;
            for k in 0..shown.len() {
                shown[k] = (window.measured[k] - shown[k]) / scales[k % n];
                jacobian.row_mut(k).scale_mut(1.0 / scales[k % n]);
            }
            let normal = jacobian.transpose() * &jacobian;
            let step = normal.cholesky()?.solve(&(jacobian.transpose() * shown));
            start.values.iter_mut().zip(step.iter()).for_each(|(value, step)| *value += step);
            if step.amax() < 1e-8 {
                break;
            }
        }
        start.near = self.coordinates.pose(self.mechanism, &start.near, &start.values)?;
        Some(start)
    }
}
