//! Fits of values over windows, one length after another, and what they say.

use super::bench::Bench;
use super::eliminate::gain;
use super::sought::Sought;
use super::window::{Window, cut};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::thresholds::{COVERED, HORIZONS, PHASE, WINDOWS};
use nalgebra::{DMatrix, DVector};

/// Fits of one bench.
#[derive(Clone)]
pub struct WindowFits<'a> {
    bench: &'a Bench,
    priors: Vec<Vec<[f64; 2]>>,
    scales: Vec<f64>,
    /// Lengths in s of the windows that were fitted.
    pub lengths: Vec<f64>,
    zeros: Vec<Vec<f64>>,
    /// As of [`Fitted`](super::shooting::WindowsFitted), of the last fit.
    pub covariance: DMatrix<f64>,
    /// See there.
    pub information: DMatrix<f64>,
    squares: f64,
    /// Whether errors of predictions are made least, zeros staying where they were found.
    pub predicts: bool,
    tell: &'a (dyn Fn(&str) + Sync),
}

impl<'a> WindowFits<'a> {
    /// Nothing found yet; `priors` are those of zeros, run by run.
    pub fn new(
        bench: &'a Bench,
        priors: Vec<Vec<[f64; 2]>>,
        tell: &'a (dyn Fn(&str) + Sync),
    ) -> Self {
        Self {
            bench,
            priors,
            scales: bench.motion().iter().map(|motion| 1e-3 * motion).collect(),
            lengths: Vec::new(),
            zeros: Vec::new(),
            covariance: DMatrix::zeros(0, 0),
            information: DMatrix::zeros(0, 0),
            squares: f64::INFINITY,
            predicts: false,
            tell,
        }
    }

    fn windows(&self, length: f64) -> Vec<Window> {
        let total: f64 = self.bench.runs.iter().map(Recording::duration).sum();
        let step = length * (total / COVERED).max(1.0);
        let runs = self.bench.runs.iter().enumerate();
        runs.flat_map(|(i, run)| {
            cut(i, run, &self.bench.sensors, [length, step], [0.0, f64::INFINITY])
        })
        .collect()
    }

    /// Values that fit windows of these lengths, one after another, as long as the model keeps the phase.
    pub fn stages(
        &mut self,
        sought: &Sought,
        mut values: Vec<f64>,
        lengths: &[f64],
    ) -> Option<Vec<f64>> {
        let motion = self.bench.motion();
        let mut done = false;
        for &length in lengths {
            let windows = self.windows(length);
            if windows.is_empty() {
                break;
            }
            (self.tell)(&format!("fitting windows of {length} s"));
            let mut priors = self.priors.clone();
            for (run, zeros) in self.zeros.iter().enumerate() {
                for (prior, zero) in priors[run].iter_mut().zip(zeros) {
                    // Where it goes on from; its prior is as wide as before.
                    prior[0] = *zero;
                    if self.predicts {
                        prior[1] = 0.0;
                    }
                }
            }
            let machines = |values: &[f64]| self.bench.machines(&sought.settings(values));
            let seconds = if self.predicts { first_part(length) } else { 0.3 * length };
            let head = (seconds / windows[0].rows.interval).round() as usize;
            let fit = |values: Vec<f64>, scales: Vec<f64>| {
                self.bench.fit(
                    &machines,
                    &windows,
                    &sought.values,
                    values,
                    &priors,
                    scales,
                    head,
                    self.predicts,
                )
            };
            let Some(fitted) = fit(values.clone(), self.scales.clone()) else { break };
            let rows: f64 = windows.iter().map(|w| (w.rows.count + 1) as f64).sum();
            let missed = (fitted.squares / (rows * motion.len() as f64)).sqrt();
            values = fitted.values;
            self.zeros = fitted.zeros;
            self.covariance = fitted.covariance;
            self.information = fitted.information;
            self.squares = fitted.squares;
            if lengths.len() > 1 {
                self.lengths.push(length);
            }
            done = true;
            let share = missed * self.scales[0] / motion[0];
            (self.tell)(&format!(
                "windows of {length} s: {:.2} % of the motion is missed",
                100.0 * share
            ));
            if length > WINDOWS[0] && share > PHASE {
                break;
            }
        }
        done.then_some(values)
    }

    /// Which friction the dry pivots of a model have, one pivot after another: the sign of the rate, or bristles.
    /// Both have one value; that is taken which leaves less.
    pub fn held_or_sliding(
        &mut self,
        mut model: Sought,
        mut values: Vec<f64>,
        length: f64,
        without: &[&str],
    ) -> (Sought, Vec<f64>) {
        for index in 0..model.effects.len() {
            if without.contains(&"bristle-friction") {
                break;
            }
            let other = model.with_bristles(index, &values, &self.bench.mechanism);
            let Some(other) = other else { continue };
            let mut beside = self.clone();
            let found = beside.stages(&other, other.start.clone(), &[length]);
            if let Some(found) = found.filter(|_| beside.squares < self.squares) {
                (*self, model, values) = (beside, other, found);
            }
        }
        (model, values)
    }

    /// Zeros of the runs that were fitted, and their standard deviations.
    pub fn zeros_known(&self) -> Vec<Vec<[f64; 2]>> {
        let n = self.bench.sensors.len();
        let first = self.covariance.nrows().saturating_sub(n * self.zeros.len());
        let zero = |run: usize, i: usize| [self.zeros[run][i], self.deviation(first + run * n + i)];
        (0..self.zeros.len()).map(|run| (0..n).map(|i| zero(run, i)).collect()).collect()
    }

    pub fn deviation(&self, k: usize) -> f64 {
        self.covariance[(k, k)].max(0.0).sqrt()
    }

    /// What each effect's change from what is declared takes off, as windows vary: `θᵀ C⁻¹ θ`.
    pub fn gains(&self, sought: &Sought, values: &[f64]) -> Vec<(usize, f64)> {
        let change = self.change(sought, values);
        let effects = (0..sought.effects.len()).filter(|&i| !sought.of(i).is_empty());
        effects.map(|i| (i, gain(&self.covariance, &change, &sought.of(i)))).collect()
    }

    /// By how much values differ from what is declared; zeros of runs are no change.
    fn change(&self, sought: &Sought, values: &[f64]) -> DVector<f64> {
        DVector::from_fn(self.covariance.nrows(), |k, _| {
            sought.values.get(k).map_or(0.0, |value| values[k] - value.prior[0])
        })
    }
}

/// The first part in s of windows of some `length` s that starts are fitted to where predictions are judged.
fn first_part(length: f64) -> f64 {
    let judged = HORIZONS.iter().filter(|[window, _]| *window <= length);
    let longest = judged.max_by(|a, b| a[0].total_cmp(&b[0]));
    longest.map_or(0.3 * length, |[_, first]| *first)
}
