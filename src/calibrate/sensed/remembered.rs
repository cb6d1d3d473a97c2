//! Effects that whole motions ask for where residuals do not see them.

use super::baseline::Baseline;
use super::errors::{are_met, of_run};
use super::fit::Target;
use super::hypotheses::{Round, Tried};
use super::limits::ways;
use super::linear::Columns;
use super::problem::Stopped;
use super::rivals::preferred;
use super::search::{Found, Search, names};
use super::settle::Model;
use super::thresholds::{EFFECTS, GAIN, GAIN_PER_VALUE, SIMULATED, TWINS};
use super::whole::{Fitted, Whole};
use crate::calibrate::fit::free;
use crate::effects::Setting;
use nalgebra::DMatrix;
use rayon::prelude::*;

impl Search<'_> {
    /// What was found, with values and further effects from whole motions where predictions miss the recordings by more
    /// than residuals show. Nothing of machines that rattle, which forget, and of a single recording, half of which does
    /// not judge the other.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(super) fn remembered(&self, mut found: Found) -> Result<Found, Stopped> {
        let effects = &found.best.fit.effects;
        if found.best.baseline.rattles || self.problem.runs.len() < 2 || self.predicts(effects)? {
            return Ok(found);
        }
        (self.tell)("following whole motions");
        let whole = Whole::of(self.problem, effects)?;
        let Some(mut now) = whole.fitted(effects) else { return Ok(found) };
        while now.effects.len() < EFFECTS {
            let (round, next) = self.one_more(&whole, &now, &found.best);
            let added = round.added.is_some();
            found.rounds.push(round);
            match next {
                Some(next) if added => now = next,
                _ => break,
            }
        }
        if let Some(model) = self.as_simulated(&now.effects)? {
            found.rest = if self.is_noise(&model) { self.rest(&model) } else { None };
            found.best = model;
        }
        Ok(found)
    }

    /// Whether simulations of a model with these effects meet all recordings.
    fn predicts(&self, effects: &[Setting]) -> Result<bool, Stopped> {
        let problem = self.problem;
        let simulated = problem.simulated(&problem.starts(effects)?, 1)?;
        let met = |(run, own): (&super::problem::Run, &Vec<_>)| {
            let errors = of_run(&problem.declared, &run.recording, "", own, own);
            are_met(&problem.declared, &errors, own)
        };
        Ok(problem.runs.iter().zip(&simulated).all(met))
    }

    /// The best model with one effect more, by whole motions; `known` is one with effects of its own that residuals have
    /// been looked at beside.
    fn one_more(&self, whole: &Whole, now: &Fitted, known: &Model) -> (Round, Option<Fitted>) {
        let mut round = Round::default();
        let mut fitted: Vec<Fitted> = Vec::new();
        for (effect, gain) in self.promising(whole, now, known).into_iter().take(SIMULATED) {
            let effects = [now.effects.as_slice(), std::slice::from_ref(&effect)].concat();
            (self.tell)(&format!("following whole motions with {}", names(&effects)));
            let Some(found) = whole.fitted(&effects) else { continue };
            let share = ((now.held - found.held) / now.held).clamp(0.0, 1.0);
            let effect = found.effects[now.effects.len()].clone();
            let gain = if found.held.is_finite() { now.held - found.held } else { gain };
            round.tried.push(Tried {
                effect,
                gain,
                share,
                fitted: true,
                chance: 0.0,
                simulated: true,
            });
            fitted.push(found);
        }
        round.tried.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        fitted.retain(|found| cost(found) < cost(now) - GAIN[0] && found.held < now.held - GAIN[0]);
        fitted.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        let last = |found: &Fitted| found.effects[now.effects.len()].clone();
        let enough = fitted.first().map_or(0.0, cost) + TWINS[0];
        let near: Vec<Setting> =
            fitted.iter().filter(|found| cost(found) < enough).map(last).collect();
        let Some(won) = preferred(&near) else { return (round, None) };
        round.added = Some(near[won].clone());
        round.as_good =
            near.into_iter().enumerate().filter(|(i, _)| *i != won).map(|(_, e)| e).collect();
        (round, fitted.into_iter().nth(won))
    }

    /// Candidates beside a model by what one linear step of their values takes off the run that values are fitted to, the
    /// best first: of each effect on each target the variant that promises most.
    fn promising(&self, whole: &Whole, now: &Fitted, known: &Model) -> Vec<(Setting, f64)> {
        let Some((white, own)) = whole.at(&now.effects) else { return Vec::new() };
        let own = own.unwrap_or_else(|| DMatrix::zeros(white.len(), 0));
        let gain = |effect: &Setting| {
            let (there, columns) = whole.beside(&now.effects, effect)?;
            let count = own.ncols();
            let mut on = own.clone().resize_horizontally(count + columns.ncols(), 0.0);
            on.columns_mut(count, columns.ncols()).copy_from(&columns);
            let columns = Columns { hold: DMatrix::zeros(0, on.ncols()), on, known: count };
            let values: Vec<f64> = effect.values().map(|(_, value)| value).collect();
            let step = columns.step(&there, &values, &free(std::slice::from_ref(effect)))?;
            let left = (there + &columns.on * &step.change).norm_squared();
            let change = step.change.iter().skip(count).zip(&values).map(|(d, v)| v + d);
            let effect = effect.with(&change.collect::<Vec<f64>>());
            let price = GAIN_PER_VALUE * values.len() as f64;
            left.is_finite().then(|| (effect, white.norm_squared() - left - price))
        };
        let mut found: Vec<(Setting, f64)> =
            self.begun(now, known).par_iter().filter_map(gain).collect();
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut best: Vec<(Setting, f64)> = Vec::new();
        for (effect, gain) in found {
            if !best.iter().any(|(known, _)| known.is(&effect)) && gain > GAIN[0] {
                best.push((effect, gain));
            }
        }
        best
    }

    /// Candidates beside a model at values to begin with: those that residuals ask for, as far as they do, and a step from
    /// neutral.
    fn begun(&self, now: &Fitted, known: &Model) -> Vec<Setting> {
        let fresh = |effect: &Setting| !now.effects.iter().any(|own| own.is(effect));
        let mut begun: Vec<Setting> = Vec::new();
        for tried in self.screened(known) {
            let first = !begun.iter().any(|other| other.is(&tried.effect));
            if first && tried.gain > 0.0 && fresh(&tried.effect) {
                begun.push(tried.effect);
            }
        }
        let steps = self.candidates.iter().filter(|candidate| fresh(candidate));
        begun.extend(steps.flat_map(|candidate| {
            let (name, neutral) = candidate.values().next().unwrap_or(("", 0.0));
            let step = candidate.kind.parameter(name).map_or(0.0, |parameter| parameter.step);
            let ways = ways(candidate, neutral, step);
            ways.into_iter().map(|values| candidate.with(&values)).collect::<Vec<_>>()
        }));
        begun
    }

    /// A model at values from whole motions, with what its own simulations say of its residuals.
    fn as_simulated(&self, effects: &[Setting]) -> Result<Option<Model>, Stopped> {
        let segments = [self.split.on.as_slice(), &self.split.hold].concat();
        let baseline = Baseline::of(self.problem, effects, &[], &segments)?;
        let target: Target = self.target(&baseline, false);
        let Some(mut fit) = target.look(effects) else { return Ok(None) };
        fit.jacobian = target.jacobian(&fit);
        let Some(held) = self.target(&baseline, true).look(effects) else { return Ok(None) };
        let misfit = held.chi2 + baseline.lost(&self.split.hold);
        Ok(Some(Model { fit, held: held.chi2, misfit, baseline }))
    }
}

/// Σ of squares on all runs, and Akaike's price of the values.
fn cost(fitted: &Fitted) -> f64 {
    let values: usize = fitted.effects.iter().map(|effect| effect.values().count()).sum();
    fitted.own + fitted.held + 2.0 * GAIN_PER_VALUE * values as f64
}
