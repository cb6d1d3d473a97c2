//! A model: effects with values, and what simulations at these say.

use super::fit::Fit;
use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::thresholds::{GAIN, GAIN_PER_VALUE};

/// A model that simulations of itself have been held against.
#[derive(Clone, Debug)]
pub struct Model {
    /// Its effects at their best values.
    pub fit: Fit,
    /// Bias and noise from simulations at (nearly) these values.
    pub baseline: Baseline,
    /// Σ of squares on the data that candidates are judged on.
    pub held: f64,
    /// −2 log likelihood there, but for a constant.
    pub misfit: f64,
}

impl Model {
    /// What the model costs: its misfit and the price of its values.
    pub fn cost(&self) -> f64 {
        let values: usize = self.fit.effects.iter().map(|effect| effect.values().count()).sum();
        self.misfit + GAIN_PER_VALUE * values as f64
    }
}

/// Drop of cost that one more effect has to bring.
pub(in crate::calibrate::sensed) fn price(model: &Model) -> f64 {
    GAIN[usize::from(model.baseline.rattles)]
}
