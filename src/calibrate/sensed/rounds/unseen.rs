//! Effects that residuals hardly see without a simulation.

use super::other_laws::other_laws;
use super::round::Tried;
use super::search::Search;
use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::residuals::problem::{Segment, Stopped};
use crate::calibrate::sensed::thresholds::{MOMENT, NEAR};
use crate::calibrate::sensed::values::linear::{remains, stepped_along};
use crate::calibrate::sensed::values::model::{Model, price};
use crate::calibrate::sensed::values::trajectory::{Far, followed, shorter};
use crate::calibrate::sensed::values::whole::Whole;
use crate::calibrate::values::least_squares::free;
use crate::calibrate::values::least_squares::{Free, ResidualAt, derivative};
use crate::effects::Setting;
use crate::mechanism::Mechanism;
use nalgebra::DVector;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// How far from its neutral value an effect that only simulations show is tried, in steps of its parameters: a
/// joint's clearance of 0.05 mm more.
const AWAY: f64 = 10.0;

/// First seconds of a run that simulations show effects on: a swing whose frequency is off by a few hundredths is still
/// in phase, and a machine has come up to speed.
const SECONDS: f64 = 0.5;

/// How often a step that keeps less than half of what it promises is halved: a long one of what hardly acts promises much.
const HALVED: i32 = 3;

/// How often one is doubled as long as that takes more off: what gives way acts the less by a hair the stiffer it is as declared.
const DOUBLED: i32 = 4;

/// Candidates that are fitted to whole simulations, of those that take most off some way along one step of all their values.
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
        if self.problem.is_worn_out() {
            return Ok(Vec::new());
        }
        let own = &model.fit.effects;
        let paid = self.paid(model)?;
        // What cannot be simulated is no model.
        let fitted = |effects: &[Setting], far| -> Result<Option<(f64, Model)>, Stopped> {
            let Some(there) = self.fitted(effects, far).ok().flatten() else { return Ok(None) };
            Ok(Some((paid - self.paid(&there)?, there)))
        };
        let mut found = Vec::new();
        for start in self.promising(model)? {
            if self.problem.is_worn_out() {
                break;
            }
            found.extend(fitted(&[own.as_slice(), &[start]].concat(), Far::First)?);
        }
        let most = found.iter().map(|(gain, _)| *gain).fold(0.0, f64::max);
        for (gain, there) in &mut found {
            if *gain >= NEAR * most
                && !self.problem.is_worn_out()
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
    /// machine that nothing holds and that does as it was let go adds up what acts on it over the whole run, or as much of it as
    /// takes a [moment](MOMENT).
    fn promising(&self, model: &Model) -> Result<Vec<Setting>, Stopped> {
        let own = &model.fit.effects;
        let falls = self.problem.falls(own)?;
        let before = self.problem.work();
        let far = followed(self.problem, own, &self.split.on)?.pop().flatten();
        // That took two replicas of two runs, about as much as values of one candidate do on one.
        let all = (self.problem.work() - before) * self.candidates.len() as u64;
        let runs = self.problem.runs.iter();
        let longest = runs.map(|run| run.recording.duration()).fold(0.0, f64::max);
        let seconds = match all > MOMENT {
            _ if !falls => Some(SECONDS),
            true => {
                let affordable = longest * MOMENT as f64 / all as f64;
                Some(far.unwrap_or(longest).min(affordable.max(SECONDS)))
            }
            false => far,
        };
        // What hits lose shows where the motion after them can be followed.
        let follows = falls || far.is_none();
        let on = self.split.on.iter();
        let first: Vec<Segment> =
            on.map(|segment| shorter(self.problem, segment, seconds)).collect();
        let baseline = || Baseline::of(self.problem, own, &[], &first);
        let whole = Whole::of(self.problem, own, &first, baseline)?;
        let Some(left) = whole.look(own) else { return Ok(Vec::new()) };
        let Some(starts) = whole.by_start(own, &left) else { return Ok(Vec::new()) };
        (self.tell)("simulating every effect for a moment");
        let mut kept = self.stepped(model, &whole, (&starts, &left));
        if follows && !self.problem.is_worn_out() {
            kept.extend(other_laws(
                &whole,
                &self.problem.declared,
                own,
                (&starts, &left),
                price(model),
            ));
        }
        Ok(kept)
    }

    /// Candidates beside a model that simulations some way along one linear step of their values say most for, beside what other
    /// coordinates to let the machine go from make up for, by which `starts` are the derivatives of what is `left`.
    fn stepped(
        &self,
        model: &Model,
        whole: &Whole,
        (starts, left): (&[DVector<f64>], &DVector<f64>),
    ) -> Vec<Setting> {
        let own = &model.fit.effects;
        let fresh = |candidate: &&Setting| {
            candidate.kind.scan.is_none() && !own.iter().any(|effect| effect.is(candidate))
        };
        let candidates: Vec<&Setting> = self.candidates.iter().filter(fresh).collect();
        let stepped = |candidate: &&Setting| {
            let with =
                |values: &[f64]| whole.look(&[own.as_slice(), &[candidate.with(values)]].concat());
            linear_step(&with, (&self.problem.declared, candidate), starts, left)
        };
        let mut steps: Vec<Stepped> = candidates
            .par_iter()
            .filter_map(stepped)
            .filter(|step| step.gain > price(model))
            .collect();
        steps.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        // Variants of one effect are one candidate.
        let mut apart: Vec<Stepped> = Vec::new();
        for step in steps {
            if !apart.iter().any(|known| known.to.is(&step.to)) {
                apart.push(step);
            }
        }
        let mut tried: Vec<(f64, Setting)> = apart
            .par_iter()
            .filter_map(|step| step.tried(whole, own, starts, left))
            .filter(|(gain, _)| *gain > price(model))
            .collect();
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        tried.into_iter().take(FITTED).map(|(_, start)| start).collect()
    }
}

/// A candidate and one linear step of its values.
struct Stepped {
    /// Drop of the sum of squares that it promises.
    gain: f64,
    /// Before it.
    from: Setting,
    /// After it.
    to: Setting,
}

impl Stepped {
    /// What a simulation some way along the step takes off the sum of squares of what is `left` beside `own` effects, less what
    /// other coordinates to let the machine go from make up for, by which `starts` are the derivatives; and the candidate there.
    /// None where such a machine cannot be.
    fn tried(
        &self,
        whole: &Whole,
        own: &[Setting],
        starts: &[DVector<f64>],
        left: &DVector<f64>,
    ) -> Option<(f64, Setting)> {
        let before = remains(starts, left)?;
        let gain = |times: f64| {
            let there = self.times(times);
            let seen = whole.look(&[own, std::slice::from_ref(&there)].concat())?;
            Some((before - remains(starts, &seen)?, there))
        };
        let kept = |tried: &(f64, Setting)| tried.0 > 0.5 * self.gain;
        let first = gain(1.0);
        let Some(mut best) = first.clone().filter(kept) else {
            let shorter = (1..=HALVED).filter_map(|halved| gain(0.5f64.powi(halved)));
            return first.into_iter().chain(shorter).max_by(|a, b| a.0.total_cmp(&b.0));
        };
        for doubled in 1..=DOUBLED {
            let more = gain(2.0f64.powi(doubled)).filter(|more| more.0 > best.0);
            let Some(more) = more else { break };
            best = more;
        }
        Some(best)
    }

    /// The candidate so many times along the step, as far as its values make sense.
    fn times(&self, times: f64) -> Setting {
        let bounds = free(std::slice::from_ref(&self.from)).into_iter().map(|free| free.bounds);
        let ends = self.from.values().zip(self.to.values()).zip(bounds);
        let values =
            ends.map(
                |(((_, from), (_, to)), [low, high])| {
                    if from == to { from } else { (from + times * (to - from)).clamp(low, high) }
                },
            );
        self.from.with(&values.collect::<Vec<f64>>())
    }
}

/// A linear step of a candidate's values, whose gain is the drop of the sum of squares of what is `left` beyond that by one of the
/// coordinates from which a machine that nothing holds was let go, by which `starts` are the derivatives. None where such a
/// machine cannot be.
fn linear_step(
    look: ResidualAt,
    (mechanism, candidate): (&Mechanism, &Setting),
    starts: &[DVector<f64>],
    left: &DVector<f64>,
) -> Option<Stepped> {
    let names: Vec<&str> = candidate.values().map(|(name, _)| name).collect();
    let neutral: Vec<f64> = candidate.values().map(|(_, value)| value).collect();
    let free = free(std::slice::from_ref(candidate));
    let alone = remains(starts, left)?;
    let stepped = |columns: &[DVector<f64>], own: &[f64], free: &[Free]| {
        let all = [starts, columns].concat();
        let (least, change) = stepped_along(&all, starts.len(), left, own, free)?;
        let gain = alone - least;
        let change: Vec<f64> = change.iter().skip(starts.len()).copied().collect();
        gain.is_finite().then_some((gain, change))
    };
    // Of one with a list of starts the first value is its size, which begins at nothing; the others are a start's.
    let listed = candidate.starts(mechanism);
    let grows = |start: &[f64]| {
        let look = |size: &[f64]| look(&candidate.sized(start, size[0]));
        derivative(&look, &free[..1], &neutral[..1], left, 0)
    };
    if let (true, [begin, next, ..]) = (turns_round(&names, &listed), listed.as_slice()) {
        let across = &listed[listed.len() / 4];
        let columns = [begin, across].map(|start| grows(start));
        let [Some(first), Some(across)] = columns else { return None };
        let wide = Free { bounds: [-f64::MAX, f64::MAX], ..free[0] };
        let (gain, change) = stepped(&[first, across], &[0.0; 2], &[wide; 2])?;
        let turn = change[1].atan2(change[0]).rem_euclid(TAU) / TAU;
        let angle = begin[1] + turn * listed.len() as f64 * (next[1] - begin[1]);
        let amplitude = neutral[0] + change[0].hypot(change[1]);
        let [from, to] = [neutral[0], amplitude].map(|size| candidate.with(&[size, angle]));
        return Some(Stepped { gain, from, to });
    }
    if let Some(start) = listed.first() {
        let (gain, change) = stepped(&[grows(start)?], &neutral[..1], &free[..1])?;
        let [from, to] = [neutral[0], neutral[0] + change[0]]
            .map(|size| candidate.with(&candidate.sized(start, size)));
        return Some(Stepped { gain, from, to });
    }
    let slope = |i: usize| derivative(look, &free, &neutral, left, i);
    let columns: Vec<_> = (0..neutral.len()).map(slope).collect::<Option<_>>()?;
    let (gain, change) = stepped(&columns, &neutral, &free)?;
    let values: Vec<f64> = neutral.iter().zip(change).map(|(value, by)| value + by).collect();
    Some(Stepped { gain, from: candidate.with(&neutral), to: candidate.with(&values) })
}

/// Whether a list of starts goes once round the period of an angle, their last value, in equal steps: what a quarter of them
/// apart is then is the cosine and the sine of one wave, in which a response is linear.
fn turns_round(names: &[&str], listed: &[Vec<f64>]) -> bool {
    let angle = names.last().is_some_and(|name| name.ends_with("_rad"));
    angle && names.len() == 2 && listed.len() >= 4 && listed.len().is_multiple_of(4)
}

/// An effect some way from its values, for what only simulations show.
pub(super) fn away(effect: &Setting) -> Setting {
    let values = effect.values().map(|(name, value)| {
        let parameter = effect.kind.parameter(name);
        parameter.map_or(value, |p| (value + AWAY * p.step).clamp(p.bounds[0], p.bounds[1]))
    });
    effect.with(&values.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::residuals::problem::RigProblem;
    use crate::effects::{Target, named};
    use crate::mechanism::Drive;

    /// A coupling that gives way twice as much as the servo behind it does by its gain: by a hair of that much less is seen to act,
    /// and one linear step leads to less than half of it.
    #[test]
    fn what_acts_the_less_by_a_hair_is_gone_after() {
        let problem = RigProblem::planar("planar-1");
        let drive = &problem.declared.actuators[0];
        let Drive::Servo { stiffness, .. } = drive.drive else { panic!("{drive:?}") };
        let compliance = 2.0 / stiffness;
        let target = Target::Joints(vec![drive.name.clone()]);
        let kind = named("drive-compliance").unwrap();
        let hidden = Setting::on(kind, target, &[("compliance_rad_Nm", compliance)]);
        let released = problem.let_go(std::slice::from_ref(&hidden)).unwrap();
        let recorded = problem.simulated(&released, 1).unwrap().remove(0).remove(0);
        let problem = problem.recorded_as(recorded);
        let split = problem.split();
        let candidates = [hidden.with(&[0.0])];
        let search = Search::new(&problem, &split, &candidates, &|_| {});
        let declared = search.settle(&[], 1).unwrap().unwrap();
        let first: Vec<Segment> =
            split.on.iter().map(|whole| shorter(&problem, whole, Some(SECONDS))).collect();
        let baseline = || Baseline::of(&problem, &[], &[], &first);
        let whole = Whole::of(&problem, &[], &first, baseline).unwrap();
        let left = whole.look(&[]).unwrap();
        let start = search.stepped(&declared, &whole, (&[], &left)).remove(0);
        let value = start.values().next().unwrap().1;
        assert!((0.6..1.5).contains(&(value / compliance)), "{value} of {compliance} rad/Nm");
    }
}
