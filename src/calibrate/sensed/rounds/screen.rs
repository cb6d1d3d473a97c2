//! Which effects promise most beside a model, before any of them is simulated.

use super::round::Tried;
use super::search::Search;
use crate::calibrate::sensed::thresholds::{AS_MUCH, CLOSER, GAIN, GAIN_PER_VALUE, JUDGED};
use crate::calibrate::sensed::values::candidates::{KEPT, starts};
use crate::calibrate::sensed::values::fit::FitTarget;
use crate::calibrate::sensed::values::linear::{Derivatives, LinearStep, step as linear_step};
use crate::calibrate::sensed::values::model::Model;
use crate::calibrate::values::least_squares::derivative;
use crate::calibrate::values::least_squares::free;
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

impl Search<'_> {
    /// The candidates beside a model that promise most on data not used for their fit, the best first.
    pub(in crate::calibrate::sensed) fn screened(&self, model: &Model) -> Vec<Tried> {
        let (on, hold) = (self.target(&model.baseline, false), self.target(&model.baseline, true));
        let Some(held) = hold.look(&model.fit.effects) else { return Vec::new() };
        let fresh = |candidate: &&Setting| !model.fit.effects.iter().any(|e| e.is(candidate));
        let fresh: Vec<&Setting> = self.candidates.iter().filter(fresh).collect();
        // What the values of the model could make good is no candidate's merit.
        let jacobians = [&on, &hold].map(|target| {
            let fit = target.look(&model.fit.effects)?;
            target.jacobian(&fit)
        });
        let draws = self.draws(model);
        let linear = |candidate: &&Setting| {
            let found = starts(&on, &model.fit, candidate, KEPT).into_iter();
            let found = found.filter_map(|start| {
                // At neutral values it is the model as it is.
                let base = start.values().eq(candidate.values()).then_some(&model.fit.white);
                linear(&on, model, base, jacobians[0].as_ref(), start)
            });
            found.min_by(|a, b| a.left.total_cmp(&b.left))
        };
        let mut promising: Vec<Linear> = fresh.par_iter().filter_map(linear).collect();
        promising.sort_by(|a, b| a.left.total_cmp(&b.left));
        promising.truncate(JUDGED);
        let judged = |found: &Linear| {
            let (left, hold) = found.judged(&hold, model, &held.white, jacobians[1].as_ref())?;
            let gain = held.chi2 - left;
            let share = (gain / held.chi2).clamp(0.0, 1.0);
            let columns = Derivatives { on: found.on.clone(), hold, known: found.known };
            let chance = match gain > 0.5 * GAIN[0] {
                true => columns.chance(&found.step, &draws, model.baseline.replicas)?,
                false => 0.0,
            };
            let (effect, fitted, simulated) = (found.effect(), false, false);
            gain.is_finite().then_some(Tried { effect, gain, share, fitted, chance, simulated })
        };
        let mut tried: Vec<Tried> = promising.par_iter().filter_map(judged).collect();
        tried.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let closer: Vec<Tried> = tried
            .par_iter()
            .take(CLOSER)
            .filter_map(|near| self.closer(model, near, held.chi2))
            .collect();
        for better in closer {
            if let Some(known) = tried.iter_mut().find(|t| {
                t.effect.is(&better.effect)
                    && t.effect.values().map(|(n, _)| n).eq(better.effect.values().map(|(n, _)| n))
            }) {
                *known = better;
            }
        }
        let price = |tried: &Tried| GAIN_PER_VALUE * tried.effect.values().count() as f64;
        tried.sort_by(|a, b| (b.gain - price(b)).total_cmp(&(a.gain - price(a))));
        simpler_next(&mut tried);
        tried
    }

    /// A candidate with its values fitted by more than one step beside those of a model that leaves `held` on the data to
    /// judge on, and without what it gains by shrinking noise.
    pub(in crate::calibrate::sensed) fn closer(
        &self,
        model: &Model,
        near: &Tried,
        held: f64,
    ) -> Option<Tried> {
        let start = [model.fit.effects.as_slice(), std::slice::from_ref(&near.effect)].concat();
        let fit = self.target(&model.baseline, false).fit(&start, 8)?;
        let gain = held - self.target(&model.baseline, true).look(&fit.effects)?.chi2;
        let shrunk = || model.baseline.shrunk(self.problem, &fit.effects, &self.split.hold);
        let gain = if gain > 0.0 { gain - shrunk()? } else { gain };
        let share = (gain / held).clamp(0.0, 1.0);
        let effect = fit.effects.last()?.clone();
        Some(Tried { effect, gain, share, fitted: true, ..near.clone() })
    }

    /// Draws of a model's noise, on the data that values are fitted on and on those that candidates are judged on.
    pub(in crate::calibrate::sensed) fn draws(&self, model: &Model) -> Vec<[DVector<f64>; 2]> {
        let [on, hold] = [&self.split.on, &self.split.hold].map(|part| model.baseline.draws(part));
        on.into_iter().zip(hold).map(|(on, hold)| [on, hold]).collect()
    }
}

/// A candidate's values by one linear step from where it starts.
struct Linear {
    start: Setting,
    /// Whether these values are neutral.
    neutral: bool,
    /// Its values there.
    own: Vec<f64>,
    /// Derivatives by the model's values and its own on the data that they are fitted on.
    on: DMatrix<f64>,
    /// How many values the model has.
    known: usize,
    step: LinearStep,
    /// Σ of squares that the step leaves there.
    left: f64,
}

/// A candidate beside a model by one linear step from where it starts, of which `base` is left if that is known; none where
/// there is no such machine.
fn linear(
    on: &FitTarget,
    model: &Model,
    base: Option<&DVector<f64>>,
    jacobian: Option<&DMatrix<f64>>,
    start: Setting,
) -> Option<Linear> {
    let own: Vec<f64> = start.values().map(|(_, value)| value).collect();
    let neutral = base.is_some();
    let (base, columns) = columns(on, model, base, jacobian, &start)?;
    let known = jacobian.map_or(0, DMatrix::ncols);
    let free = free(std::slice::from_ref(&start));
    let step = linear_step(&columns, known, &base, &own, &free)?;
    let left = (base + &columns * &step.change).norm_squared();
    left.is_finite().then_some(Linear { start, neutral, own, on: columns, known, step, left })
}

/// What a candidate as it starts leaves beside a model, unless that is `base`, and the derivatives of that by the model's
/// values and its own.
fn columns(
    target: &FitTarget,
    model: &Model,
    base: Option<&DVector<f64>>,
    jacobian: Option<&DMatrix<f64>>,
    start: &Setting,
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let own: Vec<f64> = start.values().map(|(_, value)| value).collect();
    let look = |values: &[f64]| {
        let effects = [model.fit.effects.as_slice(), &[start.with(values)]].concat();
        target.look(&effects).map(|fit| fit.white)
    };
    let base = base.cloned().or_else(|| look(&own))?;
    let free = free(std::slice::from_ref(start));
    let mut columns: Vec<DVector<f64>> =
        jacobian.iter().flat_map(|j| j.column_iter().map(|c| c.into_owned())).collect();
    for i in 0..free.len() {
        columns.push(derivative(&look, &free, &own, &base, i)?);
    }
    Some((base, DMatrix::from_columns(&columns)))
}

impl Linear {
    /// Σ of squares that it leaves on data to judge on, of which the model leaves `held`, and the derivatives there.
    fn judged(
        &self,
        hold: &FitTarget,
        model: &Model,
        held: &DVector<f64>,
        jacobian: Option<&DMatrix<f64>>,
    ) -> Option<(f64, DMatrix<f64>)> {
        let held = self.neutral.then_some(held);
        let (base, columns) = columns(hold, model, held, jacobian, &self.start)?;
        Some(((base + &columns * &self.step.change).norm_squared(), columns))
    }

    /// The candidate after the step.
    fn effect(&self) -> Setting {
        let change = self.step.change.iter().skip(self.known);
        let values: Vec<f64> = self.own.iter().zip(change).map(|(own, by)| own + by).collect();
        self.start.with(&values)
    }
}

/// Puts the variant with the fewest values that leaves no more than [`AS_MUCH`] times what the best one of its
/// effect leaves next to that: looks alone do not tell which is right, and both are simulated.
fn simpler_next(tried: &mut [Tried]) {
    let values = |tried: &Tried| tried.effect.values().count();
    let mut i = 0;
    while i < tried.len() {
        let first = !tried[..i].iter().any(|before| before.effect.is(&tried[i].effect));
        let enough = AS_MUCH * (1.0 - tried[i].share);
        let simpler = (i + 1..tried.len())
            .filter(|&j| first && tried[j].effect.is(&tried[i].effect))
            .filter(|&j| values(&tried[j]) < values(&tried[i]) && 1.0 - tried[j].share <= enough)
            .min_by_key(|&j| values(&tried[j]));
        if let Some(j) = simpler {
            tried[i + 1..=j].rotate_right(1);
        }
        i += 1;
    }
}

#[cfg(test)]
mod tests {
    use crate::calibrate::sensed::residuals::baseline::Baseline;
    use crate::calibrate::sensed::residuals::problem::RigProblem;
    use crate::calibrate::sensed::values::candidates::candidates;

    /// A candidate at neutral values leaves what the model leaves: it is not looked at again.
    #[test]
    fn neutral_candidates_leave_what_the_model_leaves() {
        let problem = RigProblem::planar("planar-3");
        let on = problem.split().on;
        let baseline = Baseline::of(&problem, &[], &[], &on).unwrap();
        let look = |effects: &[_]| baseline.white(&problem, effects, &on).unwrap().unwrap();
        let model = look(&[]);
        let all = candidates(&problem.declared, &[]);
        assert!(all.len() > 60, "{}", all.len());
        for candidate in all {
            let off = (look(std::slice::from_ref(&candidate)) - &model).norm() / model.norm();
            assert!(off < 1e-6, "{candidate}: {off:e}");
        }
    }
}
