//! Effects that residuals hardly see without a simulation.

use super::baseline::Baseline;
use super::hypotheses::{Tried, price};
use super::linear::step;
use super::problem::{Segment, Stopped};
use super::search::Search;
use super::settle::Model;
use super::thresholds::NEAR;
use super::trajectory::{Far, followed, shorter};
use super::whole::Whole;
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
    /// it, and how a machine that nothing holds falls. The [promising](Self::promising) ones are fitted to whole simulations.
    /// The best one comes first.
    pub(super) fn unseen(
        &self,
        model: &Model,
        tried: &mut Vec<Tried>,
    ) -> Result<Vec<Model>, Stopped> {
        let own = &model.fit.effects;
        let paid = self.paid(model)?;
        // What cannot be simulated is no model.
        let fitted = |effects: &[Setting], far| -> Result<Option<(f64, Model)>, Stopped> {
            let Some(there) = self.fitted(effects, far).ok().flatten() else { return Ok(None) };
            Ok(Some((paid - self.paid(&there)?, there)))
        };
        let mut found = Vec::new();
        for start in self.promising(model)? {
            found.extend(fitted(&[own.as_slice(), &[start]].concat(), Far::First)?);
        }
        let most = found.iter().map(|(gain, _)| *gain).fold(0.0, f64::max);
        for (gain, there) in &mut found {
            if *gain >= NEAR * most
                && let Some(closer) = fitted(&there.fit.effects, Far::All)?
                && closer.0 > *gain
            {
                (*gain, *there) = closer;
            }
        }
        for (gain, there) in &found {
            let Some(effect) = there.fit.effects.last().cloned() else { continue };
            match tried.iter_mut().find(|tried| tried.effect.is(&effect)) {
                Some(tried) => (tried.simulated, tried.gain) = (true, *gain),
                None => tried.push(Tried::simulated(effect, *gain, model)),
            }
        }
        found.retain(|(gain, _)| *gain > price(model));
        found.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        Ok(found.into_iter().map(|(_, model)| model).collect())
    }

    /// What a model costs on runs that it was not fitted to, where only whole simulations tell: by how it falls, if nothing
    /// holds the machine.
    fn paid(&self, model: &Model) -> Result<f64, Stopped> {
        let (hold, effects) = (&self.split.hold, &model.fit.effects);
        let whole = Whole::of(self.problem, effects, hold, || Ok(model.baseline.clone()))?;
        Ok(match whole.falls() {
            true => whole.look(effects).map_or(f64::INFINITY, |left| left.norm_squared()),
            false => model.cost(),
        })
    }

    /// Candidates beside a model that explain most by one linear step, each simulated a hair from neutral for [`SECONDS`]; a
    /// machine that nothing holds and that does as it was let go adds up what acts on it over the whole run.
    fn promising(&self, model: &Model) -> Result<Vec<Setting>, Stopped> {
        let own = &model.fit.effects;
        let seconds = match self.problem.falls(own)? {
            true => followed(self.problem, own, &self.split.on)?.pop().flatten(),
            false => Some(SECONDS),
        };
        let on = self.split.on.iter();
        let first: Vec<Segment> =
            on.map(|segment| shorter(self.problem, segment, seconds)).collect();
        let baseline = || Baseline::of(self.problem, own, &[], &first);
        let whole = Whole::of(self.problem, own, &first, baseline)?;
        let Some(left) = whole.look(own) else { return Ok(Vec::new()) };
        let Some(starts) = whole.by_start(own, &left) else { return Ok(Vec::new()) };
        (self.tell)("simulating every effect for a moment");
        let fresh = |candidate: &&Setting| {
            candidate.kind.scan.is_none() && !own.iter().any(|effect| effect.is(candidate))
        };
        let candidates: Vec<&Setting> = self.candidates.iter().filter(fresh).collect();
        let stepped = |candidate: &&Setting| {
            let with =
                |values: &[f64]| whole.look(&[own.as_slice(), &[candidate.with(values)]].concat());
            linear_step(&with, candidate, &starts, &left)
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

/// Drop of the sum of squares of what is `left` by one linear step of a candidate's values, beyond that by one of the
/// coordinates from which a machine that nothing holds was let go, by which `starts` are the derivatives; and the candidate
/// after it. None where such a machine cannot be.
fn linear_step(
    look: Look,
    candidate: &Setting,
    starts: &[DVector<f64>],
    left: &DVector<f64>,
) -> Option<(f64, Setting)> {
    let names: Vec<&str> = candidate.values().map(|(name, _)| name).collect();
    // Of one with a list of starts the first value is an amplitude, and the others are its first start's.
    let own = match (candidate.kind.starts)(&names).into_iter().next() {
        Some(start) => [&[candidate.values().next()?.1], &start[1..]].concat(),
        None => candidate.values().map(|(_, value)| value).collect(),
    };
    let free = free(std::slice::from_ref(candidate));
    let moving = if (candidate.kind.starts)(&names).is_empty() { own.len() } else { 1 };
    let known = starts.len();
    let mut columns = starts.to_vec();
    for i in 0..moving {
        columns.push(derivative(look, &free, &own, left, i)?);
    }
    let stepped = |columns: &[DVector<f64>], own: &[f64]| {
        if columns.is_empty() {
            return Some((left.norm_squared(), DVector::zeros(0)));
        }
        let columns = DMatrix::from_columns(columns);
        let change = step(&columns, known, left, own, &free[..own.len()])?.change;
        Some(((left + &columns * &change).norm_squared(), change))
    };
    let (alone, _) = stepped(starts, &[])?;
    let (least, change) = stepped(&columns, &own[..moving])?;
    let gain = alone - least;
    let mut values = own;
    let own = change.iter().skip(known);
    values.iter_mut().zip(own).for_each(|(value, change)| *value += change);
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
