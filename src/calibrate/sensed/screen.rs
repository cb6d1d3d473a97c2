//! Which effects promise most beside a model, before any of them is simulated.

use super::candidates::starts;
use super::fit::Target;
use super::hypotheses::Tried;
use super::linear::{Columns, Step};
use super::search::Search;
use super::settle::Model;
use super::thresholds::{AS_MUCH, CLOSER, GAIN, GAIN_PER_VALUE};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

impl Search<'_> {
    /// The candidates beside a model that promise most on data not used for their fit, the best first.
    pub(super) fn screened(&self, model: &Model) -> Vec<Tried> {
        let (on, hold) = (self.target(&model.baseline, false), self.target(&model.baseline, true));
        let Some(held) = hold.look(&model.fit.effects) else { return Vec::new() };
        let own = model.fit.effects.len();
        let fresh = |candidate: &&Setting| !model.fit.effects.iter().any(|e| e.is(candidate));
        let fresh: Vec<&Setting> = self.candidates.iter().filter(fresh).collect();
        // What the values of the model could make good is no candidate's merit.
        let jacobians = [&on, &hold].map(|target| {
            let fit = target.look(&model.fit.effects)?;
            target.jacobian(&fit)
        });
        let draws = self.draws(model);
        let linear = |candidate: &&Setting| {
            let best = starts(&on, &model.fit, candidate)
                .into_iter()
                .filter_map(|start| self.linear(&on, &hold, model, &jacobians, start))
                .min_by(|a, b| a.left.total_cmp(&b.left))?;
            let gain = held.chi2 - best.left;
            let share = (gain / held.chi2).clamp(0.0, 1.0);
            let chance = match gain > 0.5 * GAIN[0] {
                true => best.columns.chance(&best.step, &draws)?,
                false => 0.0,
            };
            let (effect, fitted, simulated) = (best.effect, false, false);
            Some(Tried { effect, gain, share, fitted, chance, simulated })
        };
        let mut tried: Vec<Tried> =
            fresh.par_iter().filter_map(linear).filter(|tried| tried.gain.is_finite()).collect();
        tried.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let closer: Vec<Tried> = tried
            .iter()
            .take(CLOSER)
            .collect::<Vec<_>>()
            .par_iter()
            .filter_map(|near| {
                let start =
                    [model.fit.effects.as_slice(), std::slice::from_ref(&near.effect)].concat();
                let fit = on.fit(&start, 8)?;
                let there = hold.look(&fit.effects)?;
                let gain = held.chi2 - there.chi2;
                let shrunk = || model.baseline.shrunk(self.problem, &fit.effects, &self.split.hold);
                let gain = if gain > 0.0 { gain - shrunk()? } else { gain };
                let share = (gain / held.chi2).clamp(0.0, 1.0);
                Some(Tried {
                    effect: fit.effects[own].clone(),
                    gain,
                    share,
                    fitted: true,
                    ..(*near).clone()
                })
            })
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

    /// Draws of a model's noise, on the data that values are fitted on and on those that candidates are judged on.
    pub(super) fn draws(&self, model: &Model) -> Vec<[DVector<f64>; 2]> {
        let [on, hold] = [&self.split.on, &self.split.hold].map(|part| model.baseline.draws(part));
        on.into_iter().zip(hold).map(|(on, hold)| [on, hold]).collect()
    }

    /// A candidate's values by one linear step from where it starts, and what they leave on the data that
    /// candidates are judged on; none where there is no such machine.
    fn linear(
        &self,
        on: &Target,
        hold: &Target,
        model: &Model,
        jacobians: &[Option<DMatrix<f64>>; 2],
        start: Setting,
    ) -> Option<Linear> {
        let own: Vec<f64> = start.values().map(|(_, value)| value).collect();
        let free = crate::calibrate::fit::free(std::slice::from_ref(&start));
        let look = |target: &Target, values: &[f64]| {
            let effects = [model.fit.effects.as_slice(), &[start.with(values)]].concat();
            target.look(&effects).map(|fit| fit.white)
        };
        let columns = |target: &Target, base: &DVector<f64>, known: &Option<DMatrix<f64>>| {
            let mut columns: Vec<DVector<f64>> =
                known.iter().flat_map(|j| j.column_iter().map(|c| c.into_owned())).collect();
            for (i, free) in free.iter().enumerate() {
                let mut beside = own.clone();
                let back = own[i] + free.step > free.bounds[1];
                let step = if back { -free.step } else { free.step };
                beside[i] += step;
                columns.push((look(target, &beside)? - base) / step);
            }
            Some(DMatrix::from_columns(&columns))
        };
        let base = look(on, &own)?;
        let base_held = look(hold, &own)?;
        let columns = Columns {
            on: columns(on, &base, &jacobians[0])?,
            hold: columns(hold, &base_held, &jacobians[1])?,
            known: jacobians[0].as_ref().map_or(0, DMatrix::ncols),
        };
        let step = columns.step(&base, &own, &free)?;
        let left = (base_held + &columns.hold * &step.change).norm_squared();
        let change = step.change.iter().skip(columns.known);
        let values: Vec<f64> = own.iter().zip(change).map(|(own, change)| own + change).collect();
        left.is_finite().then(|| Linear { effect: start.with(&values), left, columns, step })
    }
}

/// A candidate's values by one linear step.
struct Linear {
    effect: Setting,
    /// Σ of squares that they leave on data to judge on.
    left: f64,
    columns: Columns,
    step: Step,
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
