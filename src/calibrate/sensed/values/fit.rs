//! Values of effects fitted to residuals in units of noise.

use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Segment};
use crate::calibrate::values::draws::difference;
use crate::calibrate::values::instrument::{Replicated, Unpulled, unpulled};
use crate::calibrate::values::least_squares::{self, FitEffort, least_squares};
use crate::calibrate::values::least_squares::{free, values, with_values};
use crate::calibrate::values::normal::inverse_normal;
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};

/// Effects with values, and what they leave.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The effects.
    pub effects: Vec<Setting>,
    /// Σ of squares of the residual in units of noise.
    pub chi2: f64,
    /// The residual.
    pub white: DVector<f64>,
    /// Its derivative by each value in a row, where it was asked for.
    pub jacobian: Option<DMatrix<f64>>,
    /// The covariance of its values where whole simulations tell it: looks may hardly depend on them.
    pub told: Option<DMatrix<f64>>,
}

impl Fit {
    /// Standard deviations of the values as far as sensor noise tells: `(JᵀJ)⁻¹`; none where no derivative is
    /// known.
    pub fn deviations(&self) -> Vec<f64> {
        let some = self.jacobian.as_ref().filter(|jacobian| jacobian.ncols() > 0);
        let inverse = self.told.clone().or_else(|| some.and_then(inverse_normal));
        inverse.map_or_else(Vec::new, |inverse| {
            inverse.diagonal().iter().map(|square| square.max(0.0).sqrt()).collect()
        })
    }
}

/// What is fitted to what.
#[derive(Clone, Copy, Debug)]
pub struct FitTarget<'a> {
    /// The rig and its runs.
    pub problem: &'a RigProblem,
    /// Bias and noise.
    pub baseline: &'a Baseline,
    /// Segments that count.
    pub on: &'a [Segment],
}

impl Replicated for FitTarget<'_> {
    fn replicas(&self) -> usize {
        self.baseline.replicas
    }

    fn white(&self, effects: &[Setting]) -> Option<DVector<f64>> {
        Some(self.look(effects)?.white)
    }

    fn white_of(&self, effects: &[Setting], replica: usize) -> Option<DVector<f64>> {
        self.baseline.white_of(self.problem, effects, self.on, replica)
    }
}

impl FitTarget<'_> {
    /// The residual with these effects; none where such a machine cannot be.
    pub fn look(&self, effects: &[Setting]) -> Option<Fit> {
        let white = self.baseline.white(self.problem, effects, self.on).ok()??;
        let chi2 = white.norm_squared();
        chi2.is_finite().then(|| Fit {
            effects: effects.to_vec(),
            chi2,
            white,
            jacobian: None,
            told: None,
        })
    }

    /// What an effect changes of the residual, as it does beside the declared model; none where there is no such machine.
    pub fn response(&self, effect: &Setting) -> Option<DVector<f64>> {
        let mut all = Vec::new();
        for segment in self.on {
            let key = |effects: &[Setting]| {
                format!("{segment:?} {:?} {effects:?}", self.problem.rig.effects)
            };
            let seen = |effects: &[Setting]| {
                let run = &self.problem.runs[segment.run];
                let machine = machine(&self.problem.rig, effects, &run.recording).ok()?;
                self.problem.coefficients(&run.view, &machine, segment)
            };
            let kept = &self.problem.responses;
            let declared = kept.known_or(key(&[]), || seen(&[]))?;
            let own = std::slice::from_ref(effect);
            let response = kept.known_or(key(own), || Some(difference(&seen(own)?, &declared)))?;
            all.extend(self.baseline.whiten(segment, &response)?.iter());
        }
        Some(DVector::from_vec(all))
    }

    /// Derivative of the residual by each value.
    pub fn jacobian(&self, fit: &Fit) -> Option<DMatrix<f64>> {
        let look = |values: &[f64]| Some(self.look(&with_values(&fit.effects, values))?.white);
        least_squares::jacobian(&look, &free(&fit.effects), &values(&fit.effects), &fit.white)
    }

    /// A fit with values that no rattle pulls, and the derivatives there.
    pub fn settled(&self, fit: Fit) -> Fit {
        if !self.baseline.rattles || fit.effects.is_empty() {
            return Fit { jacobian: self.jacobian(&fit), ..fit };
        }
        let Unpulled { effects, white, jacobian } =
            unpulled(self, &fit.effects, fit.white, fit.jacobian);
        Fit { effects, chi2: white.norm_squared(), white, jacobian, told: fit.told }
    }

    /// Least squares from the given values on, at most `steps` steps; none where the model cannot be at its
    /// start.
    pub fn fit(&self, effects: &[Setting], steps: usize) -> Option<Fit> {
        let look = |values: &[f64]| Some(self.look(&with_values(effects, values))?.white);
        // A drop of a thousandth is none: looks are cheap.
        let effort = FitEffort { steps, enough: 1e-3, secant: false };
        let best = least_squares(&look, &free(effects), values(effects), effort, None)?;
        Some(Fit {
            effects: with_values(effects, &best.values),
            chi2: best.residual.norm_squared(),
            white: best.residual,
            jacobian: best.jacobian,
            told: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Target, named};

    /// What a payload changes is the difference of two looks, as often as it is asked for.
    #[test]
    fn a_response_is_the_difference_of_two_looks() {
        let problem = RigProblem::planar("planar-1");
        let on = problem.split().on;
        let baseline = Baseline::of(&problem, &[], &[], &on).unwrap();
        let target = FitTarget { problem: &problem, baseline: &baseline, on: &on };
        let body = Target::Body("piston".to_owned());
        let payload = Setting::on(named("payload").unwrap(), body, &[("mass_kg", 0.1)]);
        let look = |effects: &[Setting]| target.look(effects).unwrap().white;
        let expected = look(std::slice::from_ref(&payload)) - look(&[]);
        assert!(expected.norm() > 10.0, "{}", expected.norm());
        for _ in 0..2 {
            let off = (target.response(&payload).unwrap() - &expected).norm();
            assert!(off < 1e-9 * expected.norm(), "{off:e}");
        }
    }
}
