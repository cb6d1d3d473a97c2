//! By how much predictions over windows miss a run.

use super::fitting::bench::Bench;
use super::fitting::window::{Window, cut};
use crate::calibrate::sensed::motion::simulate::deviation;
use crate::mechanism::Mechanism;
use nalgebra::DMatrix;
use rayon::prelude::*;
use serde::Serialize;

/// Windows that predictions are judged by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Horizon {
    /// Length in s.
    pub window_s: f64,
    /// The first part, which the start is fitted to through the model, in s; the rest is scored.
    pub fit_s: f64,
    /// Where in the run the first one begins, in s.
    pub from_s: f64,
}

/// What a model predicts of a run.
#[derive(Clone, Debug)]
pub struct Score {
    /// Windows that could be predicted.
    pub windows: usize,
    /// Root mean square error of each compared sensor.
    pub errors: Vec<f64>,
    /// What noise of sensors leaves to any model.
    pub floors: Vec<f64>,
    /// Predicted readings of each compared sensor at the recording's rows; not a number outside windows.
    pub predicted: Vec<Vec<f64>>,
}

/// Predicted readings of a window, and mean squares that noise leaves, where they were asked for.
type Shot = (Vec<f64>, Option<Vec<f64>>);

/// Windows that floors are taken from, at most.
const FLOORS: usize = 16;

/// What a machine predicts of run `run`, side by side from `horizon.from_s` on; scales as of starts.
pub fn score(
    bench: &Bench,
    machine: &Mechanism,
    zeros: &[f64],
    run: usize,
    horizon: Horizon,
) -> Score {
    let Horizon { window_s, fit_s, from_s } = horizon;
    let recording = &bench.runs[run];
    let n = bench.sensors.len();
    let lengths = [window_s, window_s];
    let windows = cut(run, recording, &bench.sensors, lengths, [from_s, f64::INFINITY]);
    let noise: Vec<f64> = bench
        .sensors
        .iter()
        .map(|&i| deviation(&bench.mechanism.sensors[i], recording.get(i).unwrap_or_default()))
        .collect();
    let scales: Vec<f64> = bench.motion();
    let all_zeros: Vec<Vec<f64>> = (0..=run).map(|_| zeros.to_vec()).collect();
    let machines = vec![machine.clone(); run + 1];
    let guesses = bench.starts(&machines, &all_zeros, &windows).unwrap_or_default();
    let shooter = bench.shooter(machine, zeros);
    let head = |window: &Window| (fit_s / window.rows.interval).round() as usize;
    let step = windows.len().div_ceil(FLOORS).max(1);
    let predicted: Vec<Option<Shot>> = windows
        .par_iter()
        .zip(guesses)
        .enumerate()
        .map(|(index, (window, guess))| {
            let start = shooter.fitted(window, head(window), guess, &scales)?;
            let floor = || {
                let (_, derivative) = shooter.derivative(&start, window.rows)?;
                floor(&derivative, head(window), &noise)
            };
            let floor = if index % step == 0 { floor() } else { None };
            Some((shooter.shot(&start, window.rows)?, floor))
        })
        .collect();
    let mut squares = vec![0.0; n];
    let (mut count, mut judged) = (0usize, 0usize);
    let mut floors = vec![0.0; n];
    let mut floored = 0usize;
    let mut columns = vec![vec![f64::NAN; recording.samples]; n];
    for (window, found) in windows.iter().zip(&predicted) {
        let Some((shown, floor)) = found else { continue };
        judged += 1;
        if let Some(floor) = floor {
            floors.iter_mut().zip(floor).for_each(|(sum, own)| *sum += own);
            floored += 1;
        }
        let first = (head(window) + 1) * n;
        for (k, (shown, measured)) in shown.iter().zip(&window.measured).enumerate() {
            if k >= first {
                squares[k % n] += (measured - shown).powi(2);
            }
        }
        count += (shown.len() - first.min(shown.len())) / n.max(1);
        fill(&mut columns, window, shown);
    }
    Score {
        windows: judged,
        errors: squares.iter().map(|s| (s / count as f64).sqrt()).collect(),
        floors: floors.iter().map(|s| (s / floored as f64).sqrt()).collect(),
        predicted: columns,
    }
}

/// Readings of a window at its rows, on straight lines in between.
fn fill(columns: &mut [Vec<f64>], window: &Window, shown: &[f64]) {
    let n = columns.len();
    for (i, column) in columns.iter_mut().enumerate() {
        for k in 0..window.rows.count {
            let [now, next] = [shown[k * n + i], shown[(k + 1) * n + i]];
            for part in 0..window.stride {
                let share = part as f64 / window.stride as f64;
                let row = window.row + k * window.stride + part;
                if let Some(value) = column.get_mut(row) {
                    *value = now + (next - now) * share;
                }
            }
        }
    }
}

/// Mean square that noise of sensors leaves of each after the start was fitted to noisy readings: with J, the
/// derivative by the start, `J (Jₕᵀ Σ⁻¹ Jₕ)⁻¹ Jᵀ + Σ`, h the rows that the start is fitted to.
fn floor(derivative: &DMatrix<f64>, head: usize, noise: &[f64]) -> Option<Vec<f64>> {
    let n = noise.len();
    let first = ((head + 1) * n).min(derivative.nrows());
    let mut fitted = derivative.rows(0, first).into_owned();
    for k in 0..first {
        fitted.row_mut(k).scale_mut(1.0 / noise[k % n]);
    }
    let covariance = (fitted.transpose() * &fitted).try_inverse()?;
    let mut squares = vec![0.0; n];
    for k in first..derivative.nrows() {
        let row = derivative.row(k);
        squares[k % n] += (row * &covariance * row.transpose())[(0, 0)] + noise[k % n].powi(2);
    }
    let rows = ((derivative.nrows() - first) / n) as f64;
    Some(squares.iter().map(|sum| sum / rows).collect())
}
