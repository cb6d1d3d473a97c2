//! What a model leaves unexplained.

use crate::calibrate::sensed::residuals::residual::{Name, ResidualKind};
use crate::calibrate::sensed::rounds::search::Search;
use crate::calibrate::sensed::thresholds::{LARGEST, NOISE};
use crate::calibrate::sensed::values::by_chance::squares_up_to;
use crate::calibrate::sensed::values::model::Model;
use nalgebra::DVector;
use serde::Serialize;

/// How much of a residual stands above noise, on the run where most does.
#[derive(Clone, Debug, Serialize)]
pub struct Left {
    /// Which residual.
    pub residual: ResidualKind,
    /// Of which joint or column.
    pub of: String,
    /// Mean square in units of noise: 1 for noise.
    pub mean_square: f64,
    /// The mean square up to which that is noise on that run.
    pub limit: f64,
    /// Its largest coefficient in units of noise, on the run where that is farthest above what noise may be.
    pub largest: f64,
    /// The largest coefficient up to which that is noise on that run.
    pub largest_limit: f64,
    /// Whether both are noise, on each run.
    pub noise: bool,
}

impl Search<'_> {
    /// Whether a model leaves nothing but noise.
    pub fn is_noise(&self, model: &Model) -> bool {
        is_noise(&self.left(model))
    }

    /// What is left of a model's residuals, on the run where most is: what a model leaves of the run that it was
    /// fitted to it does not explain either.
    pub fn left(&self, model: &Model) -> Vec<Left> {
        let [on, hold] = [false, true].map(|held| self.left_on(model, held));
        let above = |left: &Left| left.mean_square / left.limit;
        let stands_out = |left: &Left| left.largest / left.largest_limit;
        let worse = |(on, hold): (Left, Left)| {
            let most = if stands_out(&on) > stands_out(&hold) { &on } else { &hold };
            let (largest, largest_limit) = (most.largest, most.largest_limit);
            let noise = on.noise && hold.noise;
            Left {
                largest,
                largest_limit,
                noise,
                ..if above(&on) > above(&hold) { on } else { hold }
            }
        };
        on.into_iter().zip(hold).map(worse).collect()
    }

    /// The same on the runs that values are fitted to, or on those that are held.
    pub(super) fn left_on(&self, model: &Model, held: bool) -> Vec<Left> {
        let Some(fit) = self.target(&model.baseline, held).look(&model.fit.effects) else {
            return Vec::new();
        };
        let segments = if held { &self.split.hold } else { &self.split.on };
        let places = model.baseline.places(self.problem, segments);
        let (draws, replicas) = (model.baseline.draws(segments), model.baseline.replicas);
        let of = |(k, name): (usize, &Name)| {
            let chance = |square: &dyn Fn(&DVector<f64>) -> f64| {
                squares_up_to(draws.iter().map(square), replicas)
            };
            let squares = |white: &DVector<f64>| mean_square(white, &places, k);
            let largest_of = |white: &DVector<f64>| largest(white, &places, k);
            let (mean_square, largest) = (squares(&fit.white), largest_of(&fit.white));
            let limit = NOISE[usize::from(!held)].max(chance(&squares));
            let largest_limit = LARGEST.max(chance(&|draw| largest_of(draw).powi(2)).sqrt());
            let noise = mean_square < limit && largest < largest_limit;
            let (residual, of) = (name.kind, name.of.clone());
            Left { residual, of, mean_square, limit, largest, largest_limit, noise }
        };
        self.names.iter().enumerate().map(of).collect()
    }
}

/// The numbers of residual `k` of a whitened look.
fn numbers_of<'a>(
    white: &'a DVector<f64>,
    places: &'a [(usize, f64)],
    k: usize,
) -> impl Iterator<Item = f64> + 'a {
    white.iter().zip(places).filter(move |(_, (c, _))| *c == k).map(|(value, _)| *value)
}

/// Largest of them.
fn largest(white: &DVector<f64>, places: &[(usize, f64)], k: usize) -> f64 {
    numbers_of(white, places, k).map(f64::abs).fold(0.0, f64::max)
}

/// Their mean square.
fn mean_square(white: &DVector<f64>, places: &[(usize, f64)], k: usize) -> f64 {
    let squares = numbers_of(white, places, k);
    let (sum, count) = squares.fold((0.0, 0.0), |(sum, n), value| (sum + value * value, n + 1.0));
    sum / f64::max(count, 1.0)
}

/// Whether residuals are noise. What cannot be looked at is not.
pub fn is_noise(left: &[Left]) -> bool {
    !left.is_empty() && left.iter().all(|left| left.noise)
}
