//! Values of effects fitted to residuals in units of noise.

use super::baseline::LegsBaseline;
use super::instrument::{Replicated, Unpulled, unpulled};
use super::least_squares::{self, FitEffort, free, least_squares, values, with_values};
use super::model::{LegsCase, LegsSegment};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};

/// Parameters of effects that a fit is free to choose, in a row: effect by effect, value by value.
#[derive(Clone, Debug)]
pub struct LegsFit {
    /// The effects with their values.
    pub effects: Vec<Setting>,
    /// Σ of squares of the residual in units of noise.
    pub chi2: f64,
    /// The residual there.
    pub white: DVector<f64>,
    /// Its derivative by each parameter, if the fit got so far.
    pub jacobian: Option<DMatrix<f64>>,
}

/// What is fitted to what.
#[derive(Clone, Copy, Debug)]
pub struct LegsFitTarget<'a> {
    /// The rig and its runs.
    pub case: &'a LegsCase,
    /// Bias and noise.
    pub baseline: &'a LegsBaseline,
    /// Segments that count.
    pub on: &'a [LegsSegment],
    /// Effects that stay as they are.
    pub fixed: &'a [Setting],
    /// Orthonormal directions in which the residual does not count: what the values of the fixed
    /// effects could make good.
    pub blind: Option<&'a DMatrix<f64>>,
}

impl LegsFitTarget<'_> {
    /// The residual with these effects, or none where such a machine cannot be.
    pub fn look(&self, effects: &[Setting]) -> Option<LegsFit> {
        let together = [self.fixed, effects].concat();
        let mut white = self.case.white(self.baseline, &together, self.on).ok()?;
        if let Some(blind) = self.blind {
            white -= blind * (blind.transpose() * &white);
        }
        let chi2 = white.norm_squared();
        chi2.is_finite().then(|| LegsFit { effects: effects.to_vec(), chi2, white, jacobian: None })
    }
}

impl Replicated for LegsFitTarget<'_> {
    fn replicas(&self) -> usize {
        self.baseline.replicas()
    }

    fn white(&self, effects: &[Setting]) -> Option<DVector<f64>> {
        Some(self.look(effects)?.white)
    }

    fn white_of(&self, effects: &[Setting], replica: usize) -> Option<DVector<f64>> {
        self.case.white_of(self.baseline, effects, self.on, Some(replica)).ok()
    }
}

/// The fit with values that rattle does not pull.
pub fn without_pull(target: &LegsFitTarget, fit: LegsFit) -> LegsFit {
    let Unpulled { effects, white, jacobian } =
        unpulled(target, &fit.effects, fit.white, fit.jacobian);
    LegsFit { effects, chi2: white.norm_squared(), white, jacobian }
}

/// Derivative of the residual by each parameter.
pub fn jacobian(target: &LegsFitTarget, fit: &LegsFit) -> Option<DMatrix<f64>> {
    let look = |values: &[f64]| Some(target.look(&with_values(&fit.effects, values))?.white);
    least_squares::jacobian(&look, &free(&fit.effects), &values(&fit.effects), &fit.white)
}

/// Drop of the sum of squares that is none: looks through a lens are cheap.
const ENOUGH: f64 = 1e-3;

/// Least squares from the given values on, at most `iterations` steps; none where the model cannot be
/// built at its start.
pub fn fit(target: &LegsFitTarget, effects: &[Setting], iterations: usize) -> Option<LegsFit> {
    let look = |values: &[f64]| Some(target.look(&with_values(effects, values))?.white);
    let effort = FitEffort { steps: iterations, enough: ENOUGH, secant: false };
    let best = least_squares(&look, &free(effects), values(effects), effort, None)?;
    Some(LegsFit {
        effects: with_values(effects, &best.values),
        chi2: best.residual.norm_squared(),
        white: best.residual,
        jacobian: best.jacobian,
    })
}
