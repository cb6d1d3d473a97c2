//! What a model leaves unexplained.

use super::residual::{Kind, Name};
use super::search::Search;
use super::settle::Model;
use super::thresholds::{CHANCE, LARGEST, NOISE};
use nalgebra::DVector;
use serde::Serialize;

/// How much of a residual stands above noise, on the run where most does.
#[derive(Clone, Debug, Serialize)]
pub struct Left {
    /// Which residual.
    pub residual: Kind,
    /// Of which joint or column.
    pub of: String,
    /// Mean square in units of noise: 1 for noise.
    pub mean_square: f64,
    /// Its largest coefficient in units of noise.
    pub largest: f64,
    /// Whether that is noise, on each run.
    pub noise: bool,
}

impl Search<'_> {
    /// What is left of a model's residuals, on the run where most is: what a model leaves of the run that it was
    /// fitted to it does not explain either.
    pub fn left(&self, model: &Model) -> Vec<Left> {
        let [on, hold] = [false, true].map(|held| self.left_on(model, held));
        let worse = |(on, hold): (Left, Left)| Left {
            mean_square: on.mean_square.max(hold.mean_square),
            largest: on.largest.max(hold.largest),
            noise: on.noise && hold.noise,
            ..hold
        };
        on.into_iter().zip(hold).map(worse).collect()
    }

    fn left_on(&self, model: &Model, held: bool) -> Vec<Left> {
        let Some(fit) = self.target(&model.baseline, held).look(&model.fit.effects) else {
            return Vec::new();
        };
        let segments = if held { &self.split.hold } else { &self.split.on };
        let places = model.baseline.places(self.problem, segments);
        let draws = model.baseline.draws(segments);
        let chance =
            |k: usize| up_to(&draws.iter().map(|d| mean_square(d, &places, k)).collect::<Vec<_>>());
        let of = |(k, name): (usize, &Name)| {
            let own = fit.white.iter().zip(&places).filter(|(_, (c, _))| *c == k);
            let largest = own.map(|(value, _)| value.abs()).fold(0.0, f64::max);
            let mean_square = mean_square(&fit.white, &places, k);
            let limit = NOISE[usize::from(!held)].max(chance(k));
            let noise = mean_square < limit && largest < LARGEST;
            Left { residual: name.kind, of: name.of.clone(), mean_square, largest, noise }
        };
        self.names.iter().enumerate().map(of).collect()
    }
}

/// Mean square of the numbers of residual `k` of a whitened look.
fn mean_square(white: &DVector<f64>, places: &[(usize, f64)], k: usize) -> f64 {
    let own = white.iter().zip(places).filter(|(_, (c, _))| *c == k);
    let (sum, count) = own.fold((0.0, 0.0), |(sum, n), (value, _)| (sum + value * value, n + 1.0));
    sum / f64::max(count, 1.0)
}

/// The value up to which chance leads, out of those of draws of noise: mean squares of journals that lean under forces no
/// larger than a sensor's noise are scattered far more than those of normal numbers, and so are those of rattles.
pub fn up_to(draws: &[f64]) -> f64 {
    let count = draws.len().max(2) as f64;
    let mean = draws.iter().sum::<f64>() / count;
    let spread = draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (count - 1.0);
    mean + CHANCE * spread.sqrt()
}

/// Whether residuals are noise. What cannot be looked at is not.
pub fn is_noise(left: &[Left]) -> bool {
    !left.is_empty() && left.iter().all(|left| left.noise)
}
