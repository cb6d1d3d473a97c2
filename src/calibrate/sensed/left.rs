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
    /// The mean square up to which that is noise on that run.
    pub limit: f64,
    /// Its largest coefficient in units of noise, on any run.
    pub largest: f64,
    /// Whether that is noise, on each run.
    pub noise: bool,
}

impl Search<'_> {
    /// What is left of a model's residuals, on the run where most is: what a model leaves of the run that it was
    /// fitted to it does not explain either.
    pub fn left(&self, model: &Model) -> Vec<Left> {
        let [on, hold] = [false, true].map(|held| self.left_on(model, held));
        let above = |left: &Left| left.mean_square / left.limit;
        let worse = |(on, hold): (Left, Left)| Left {
            largest: on.largest.max(hold.largest),
            noise: on.noise && hold.noise,
            ..if above(&on) > above(&hold) { on } else { hold }
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
        let chance = |k: usize| squares_up_to(draws.iter().map(|d| mean_square(d, &places, k)));
        let of = |(k, name): (usize, &Name)| {
            let own = fit.white.iter().zip(&places).filter(|(_, (c, _))| *c == k);
            let largest = own.map(|(value, _)| value.abs()).fold(0.0, f64::max);
            let mean_square = mean_square(&fit.white, &places, k);
            let limit = NOISE[usize::from(!held)].max(chance(k));
            let noise = mean_square < limit && largest < LARGEST;
            Left { residual: name.kind, of: name.of.clone(), mean_square, limit, largest, noise }
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

/// The mean square up to which chance leads, out of those of draws of noise: where journals lean under forces no larger than
/// a sensor's noise they spread over a multiple, and their logarithms are nearer to normal than they are.
fn squares_up_to(draws: impl Iterator<Item = f64>) -> f64 {
    // A channel without noise has a mean square of zero.
    up_to(&draws.map(|square| square.max(f64::MIN_POSITIVE).ln()).collect::<Vec<_>>()).exp()
}

/// The value up to which chance leads, out of those of draws of noise: rattles are scattered far more than normal numbers.
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

#[cfg(test)]
mod tests {
    use super::squares_up_to;

    /// Mean squares of sixteen draws of two residuals of one machine: one of journals that lean under next to no force, of
    /// which another draw was 2.6 and a third 3.5, and one of normal noise.
    #[test]
    fn noise_that_spreads_is_given_room() {
        let leaning = [
            0.40, 0.65, 2.69, 0.57, 0.76, 1.33, 0.73, 0.79, 1.11, 0.57, 1.03, 0.91, 0.72, 2.24,
            0.63, 0.91,
        ];
        let normal = [
            1.01, 0.86, 1.01, 1.00, 1.19, 1.01, 1.12, 1.00, 1.03, 1.11, 0.92, 0.95, 1.11, 1.03,
            0.85, 0.92,
        ];
        let [leaning, normal] = [leaning, normal].map(|draws| squares_up_to(draws.into_iter()));
        assert!((3.5..4.5).contains(&leaning), "{leaning}");
        assert!((1.2..1.35).contains(&normal), "{normal}");
        assert!(squares_up_to([0.0; 16].into_iter()) < 1e-300);
    }
}
