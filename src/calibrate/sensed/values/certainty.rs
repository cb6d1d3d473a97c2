//! How well values are known, and which effects may not be there.

use super::fit::Fit;
use super::model::Model;
use crate::calibrate::results::report::Fitted;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Segment};
use crate::calibrate::sensed::thresholds::SURE;
use crate::calibrate::values::normal::{inverse_normal, pull};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};

/// An effect with its estimates by name.
pub type Estimated = (Setting, Vec<(&'static str, Fitted)>);

/// Covariance of the values: `(JᵀJ)⁻¹`, J in units of noise; larger where the fit's own residual is larger
/// than noise, and where noise pulls values further than that of each frequency by itself does: rattle, and journals that
/// lean under forces no larger than a sensor's noise. What whole simulations tell in its place, where values come from these;
/// none where no derivatives are known.
fn covariance(model: &Model, on: &[Segment]) -> Option<DMatrix<f64>> {
    let Fit { jacobian, chi2, white, told, .. } = &model.fit;
    if told.is_some() {
        return told.clone();
    }
    let jacobian = jacobian.as_ref()?;
    let inverse = inverse_normal(jacobian)?;
    let spare = white.len().saturating_sub(jacobian.ncols()).max(1);
    let pulled = pull(jacobian, &inverse, &model.baseline.draws(on));
    let factor = (chi2 / spare as f64).max(pulled).max(1.0);
    Some(inverse * factor)
}

/// An effect of a model of which nobody knows that there is any, if there is one.
pub fn uncertain(problem: &RigProblem, model: &Model, on: &[Segment]) -> Option<Setting> {
    let effects = &model.fit.effects;
    let away = |effect: &Setting| -> Vec<f64> {
        let names: Vec<&'static str> = effect.values().map(|(name, _)| name).collect();
        let neutral =
            Setting::neutral(effect.kind, effect.target.clone(), &names, &problem.declared);
        match neutral {
            Some(neutral) => {
                let pairs = effect.values().zip(neutral.values());
                pairs.map(|((_, own), (_, none))| own - none).collect()
            }
            // Another law of contact is there, however large.
            None => vec![f64::INFINITY; names.len()],
        }
    };
    let away: Vec<Vec<f64>> = effects.iter().map(away).collect();
    within_chance(&away, &covariance(model, on)?).map(|place| effects[place].clone())
}

/// The first effect whose values, of which it is told how far `away` they are from those at which there is nothing of it,
/// are all together no further from these than [`SURE`] standard deviations: aᵀ C⁻¹ a (Wald's test), C being its part of the
/// `covariance` of all values.
fn within_chance(away: &[Vec<f64>], covariance: &DMatrix<f64>) -> Option<usize> {
    let mut first = 0;
    away.iter().position(|away| {
        // What nothing depends on has no variance, and no part in this.
        let told: Vec<usize> =
            (0..away.len()).filter(|i| covariance[(first + i, first + i)] > 0.0).collect();
        let part = DMatrix::from_fn(told.len(), told.len(), |r, c| {
            covariance[(first + told[r], first + told[c])]
        });
        let apart = DVector::from_fn(told.len(), |k, _| away[told[k]]);
        first += away.len();
        let some = away.iter().any(|away| away.is_infinite());
        !some && part.cholesky().is_some_and(|part| apart.dot(&part.solve(&apart)) < SURE * SURE)
    })
}

/// Whether an interval says something of a value: some of what makes sense lies outside.
fn says_something(fitted: &Fitted, [least, largest]: [f64; 2]) -> bool {
    let [low, high] = fitted.ci95;
    low > least || high < largest || fitted.std.is_nan()
}

/// Values with [standard deviations](covariance). Values that nothing depends on, and those of which recordings
/// [say nothing](says_something), are left out.
pub fn estimated(model: &Model, on: &[Segment]) -> Vec<Estimated> {
    // What nothing depends on is not known at all.
    let deviation = |square: f64| if square > 0.0 { square.sqrt() } else { f64::NAN };
    let deviations = covariance(model, on).map(|known| known.diagonal().map(deviation));
    let mut next = 0;
    let effects = model.fit.effects.iter();
    effects
        .map(|effect| {
            let fitted = effect.values().filter_map(|(name, value)| {
                let std = deviations.as_ref().map(|all| all[next]);
                next += 1;
                let fitted = Fitted::new(value, std.unwrap_or(f64::NAN));
                let bounds = effect.kind.parameter(name).map(|parameter| parameter.bounds);
                let told = std.is_none_or(f64::is_finite)
                    && bounds.is_none_or(|bounds| says_something(&fitted, bounds));
                told.then_some((name, fitted))
            });
            (effect.clone(), fitted.collect())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What may be anything says nothing; one end that is known, or no deviation at all, does.
    #[test]
    fn an_interval_that_holds_all_that_makes_sense_says_nothing() {
        let says = |value, std| says_something(&Fitted::new(value, std), [-3.0, 3.0]);
        assert!(!says(0.07, 9e7));
        assert!(says(0.07, 1.0) && says(2.9, 2.0) && says(0.07, f64::NAN));
    }

    #[test]
    fn effects_within_two_standard_deviations_of_nothing_may_not_be_there() {
        let of = |away: &[&[f64]], covariance: &[f64]| {
            let away: Vec<Vec<f64>> = away.iter().map(|own| own.to_vec()).collect();
            let count = away.iter().map(Vec::len).sum();
            within_chance(&away, &DMatrix::from_row_slice(count, count, covariance))
        };
        assert_eq!(of(&[&[3.0], &[-1.9]], &[1.0, 0.0, 0.0, 1.0]), Some(1));
        assert_eq!(of(&[&[3.0], &[-2.1]], &[1.0, 0.0, 0.0, 1.0]), None);
        // Neither of two values that make up for each other is known, and their sum is: 1 + 1 of ±0.2.
        assert_eq!(of(&[&[1.0, 1.0]], &[1.01, -0.99, -0.99, 1.01]), None);
        assert_eq!(of(&[&[1.0, -1.0]], &[1.01, -0.99, -0.99, 1.01]), Some(0));
        // A value without any variance is none that anything depends on.
        assert_eq!(of(&[&[3.0, 50.0]], &[1.0, 0.0, 0.0, 0.0]), None);
    }
}
