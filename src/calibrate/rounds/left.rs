//! What is left of a model's residuals, and whether it is noise.

use crate::calibrate::values::fit::LegsFitTarget;
use crate::calibrate::values::model::LegsCase;
use crate::calibrate::values::settle::{FitData, Settled};
use serde::Serialize;

/// How much of a residual stands above noise, on data not used for fits.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LegsLeft {
    /// Which residual: servo, closure, dynamics.
    pub residual: &'static str,
    /// Mean square in units of noise: 1 for noise.
    pub mean_square: f64,
    /// Its largest coefficient in units of noise.
    pub largest: f64,
    /// Up to where noise reaches.
    pub limit: f64,
}

/// Mean squares and largest coefficients, in units of noise, up to which a residual is noise; with
/// gravity, where nothing is chaotic, and without. Replicas of models that lack nothing stay well
/// below.
const LIMITS: [([f64; 2], f64); 3] = [([1.5, 2.0], 7.0), ([1.25, 1.8], 6.5), ([1.2, 1.45], 6.0)];

const NAMES: [&str; 3] = ["servo", "closure", "dynamics"];

/// What is left of a model's residuals on the held-out segments.
pub fn left(case: &LegsCase, question: &FitData, model: &Settled) -> Vec<LegsLeft> {
    let baseline = &model.baseline;
    let target = LegsFitTarget { case, baseline, on: question.hold, fixed: &[], blind: None };
    let Some(held) = target.look(&model.fit.effects) else { return Vec::new() };
    let places = baseline.places(case, question.hold);
    (0..3)
        .map(|group| {
            let own = held.white.iter().zip(&places).filter(|(_, (c, _))| c / 3 == group);
            let (mut sum, mut count, mut largest) = (0.0, 0.0, 0.0f64);
            for (value, _) in own {
                sum += value * value;
                count += 1.0;
                largest = largest.max(value.abs());
            }
            let limits = LIMITS[group].0;
            let limit = limits[usize::from(baseline.rattles)];
            LegsLeft {
                residual: NAMES[group],
                mean_square: sum / f64::max(count, 1.0),
                largest,
                limit,
            }
        })
        .collect()
}

/// Whether that is noise. What cannot be looked at is not.
pub fn is_noise(left: &[LegsLeft]) -> bool {
    let within = |(left, (_, largest)): (&LegsLeft, ([f64; 2], f64))| {
        left.mean_square < left.limit && left.largest < largest
    };
    !left.is_empty() && left.iter().zip(LIMITS).all(within)
}
