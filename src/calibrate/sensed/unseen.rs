//! Effects that residuals hardly see without a simulation.

use super::baseline::Baseline;
use super::hypotheses::{Tried, price};
use super::linear::step;
use super::problem::{Segment, Start, Stopped};
use super::search::Search;
use super::settle::Model;
use super::trajectory::shorter;
use crate::calibrate::fit::free;
use crate::calibrate::least_squares::{Look, derivative};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// How far from its neutral value an effect that only simulations show is tried, in steps of its parameters: a
/// joint's clearance of 0.05 mm more.
const AWAY: f64 = 10.0;

/// First seconds of a run that simulations show effects on: a swing whose frequency is off by a few hundredths is still
/// in phase, and a machine has come up to speed.
const SECONDS: f64 = 0.5;

/// Candidates that are fitted to whole simulations, of those that take most off by one step of all their values.
const FITTED: usize = 3;

impl Search<'_> {
    /// Models with one more effect that residuals hardly see without a simulation: how bodies swing in their play shows
    /// it. The [promising](Self::promising) ones are fitted to whole simulations. The best one comes first; none of a
    /// machine whose start has to be fitted, too, which costs more than a simulation.
    pub(super) fn unseen(
        &self,
        model: &Model,
        tried: &mut Vec<Tried>,
    ) -> Result<Vec<Model>, Stopped> {
        let mut found = Vec::new();
        let own = &model.fit.effects;
        if self.problem.starts(own)?.iter().any(Start::is_fitted) {
            return Ok(found);
        }
        for start in self.promising(model)? {
            // What cannot be simulated is no model.
            let there = self.fitted(&[own.as_slice(), &[start]].concat()).ok().flatten();
            let Some(there) = there else { continue };
            let Some(effect) = there.fit.effects.last().cloned() else { continue };
            let gain = model.cost() - there.cost();
            match tried.iter_mut().find(|tried| tried.effect.is(&effect)) {
                Some(tried) => (tried.simulated, tried.gain) = (true, gain),
                None => tried.push(Tried::simulated(effect, gain, model)),
            }
            if gain > price(model) {
                found.push(there);
            }
        }
        found.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        Ok(found)
    }

    /// Candidates beside a model that explain most by one linear step, each simulated a hair from neutral for [`SECONDS`].
    fn promising(&self, model: &Model) -> Result<Vec<Setting>, Stopped> {
        let own = &model.fit.effects;
        let on = self.split.on.iter();
        let first: Vec<Segment> =
            on.map(|segment| shorter(self.problem, segment, Some(SECONDS))).collect();
        let baseline = Baseline::of(self.problem, own, &[], &first)?;
        let look = |effects: &[Setting]| {
            baseline.simulated_white(self.problem, effects, &first).ok().flatten()
        };
        let Some(left) = look(own) else { return Ok(Vec::new()) };
        (self.tell)("simulating every effect for a moment");
        let fresh = |candidate: &&Setting| {
            candidate.kind.scan.is_none() && !own.iter().any(|effect| effect.is(candidate))
        };
        let candidates: Vec<&Setting> = self.candidates.iter().filter(fresh).collect();
        let stepped = |candidate: &&Setting| {
            let with = |values: &[f64]| look(&[own.as_slice(), &[candidate.with(values)]].concat());
            linear_step(&with, candidate, &left)
        };
        let mut steps: Vec<(f64, Setting)> = candidates
            .par_iter()
            .filter_map(stepped)
            .filter(|(gain, _)| *gain > price(model))
            .collect();
        steps.sort_by(|a, b| b.0.total_cmp(&a.0));
        // Variants of one effect are one candidate.
        let mut kept: Vec<Setting> = Vec::new();
        for (_, start) in steps {
            if kept.len() < FITTED && !kept.iter().any(|known| known.is(&start)) {
                kept.push(start);
            }
        }
        Ok(kept)
    }
}

/// Drop of the sum of squares of what is `left` by one linear step of a candidate's values, and the candidate after it;
/// none where such a machine cannot be.
fn linear_step(look: Look, candidate: &Setting, left: &DVector<f64>) -> Option<(f64, Setting)> {
    let names: Vec<&str> = candidate.values().map(|(name, _)| name).collect();
    // Of one with a list of starts the first value is an amplitude, and the others are its first start's.
    let own = match (candidate.kind.starts)(&names).into_iter().next() {
        Some(start) => [&[candidate.values().next()?.1], &start[1..]].concat(),
        None => candidate.values().map(|(_, value)| value).collect(),
    };
    let free = free(std::slice::from_ref(candidate));
    let moving = if (candidate.kind.starts)(&names).is_empty() { own.len() } else { 1 };
    let columns: Vec<DVector<f64>> =
        (0..moving).map(|i| derivative(look, &free, &own, left, i)).collect::<Option<_>>()?;
    let columns = DMatrix::from_columns(&columns);
    let change = step(&columns, 0, left, &own[..moving], &free[..moving])?.change;
    let gain = left.norm_squared() - (left + &columns * &change).norm_squared();
    let mut values = own;
    values.iter_mut().zip(change.iter()).for_each(|(value, change)| *value += change);
    gain.is_finite().then(|| (gain, candidate.with(&values)))
}

/// An effect some way from its values, for what only simulations show.
pub(super) fn away(effect: &Setting) -> Setting {
    let values = effect.values().map(|(name, value)| {
        let parameter = effect.kind.parameter(name);
        parameter.map_or(value, |p| (value + AWAY * p.step).clamp(p.bounds[0], p.bounds[1]))
    });
    effect.with(&values.collect::<Vec<_>>())
}
