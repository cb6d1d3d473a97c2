//! Effects that residuals hardly see without a simulation.

use super::other_laws::other_laws;
use super::round::Tried;
use super::search::Search;
use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::residuals::problem::{Segment, Stopped};
use crate::calibrate::sensed::thresholds::{
    BEYOND_HITS, CLEARLY, GAIN_PER_VALUE, MOMENT, NEAR, NOISE,
};
use crate::calibrate::sensed::values::model::{Model, price};
use crate::calibrate::sensed::values::stepped::{StepLength, Stepped, Variants, linear_step};
use crate::calibrate::sensed::values::trajectory::{Far, followed, shorter};
use crate::calibrate::sensed::values::whole::Whole;
use crate::effects::Setting;
use nalgebra::DVector;
use rayon::prelude::*;

/// How far from its neutral value an effect that only simulations show is tried, in steps of its parameters: a
/// joint's clearance of 0.05 mm more.
const AWAY: f64 = 10.0;

/// First seconds of a run that simulations show effects on: a swing whose frequency is off by a few hundredths is still
/// in phase, and a machine has come up to speed.
const SECONDS: f64 = 0.5;

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
            heard(tried, model, there, *gain);
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
    /// takes a [moment](MOMENT). None of a machine that something holds where these leave no more than noise.
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
        let is_noise = left.norm_squared() < NOISE[0] * left.len() as f64;
        if !falls && is_noise {
            return Ok(Vec::new());
        }
        let Some(starts) = whole.by_start(own, &left) else { return Ok(Vec::new()) };
        (self.tell)("simulating every effect for a moment");
        let stepped = self.stepped(model, &whole, (&starts, &left), StepLength::Hair);
        let mut kept: Vec<Setting> = stepped.into_iter().map(|(_, start)| start).collect();
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

    /// Models with one more effect that shows later in a run, where what hits make of a hair is no measure of what acts. Candidates
    /// are simulated as far from neutral as changes residuals by all that the model leaves of them above noise; those that
    /// take up nearly as much as the best are models, with values fitted over all of the run where these leave more than noise.
    /// The best one comes first.
    pub(super) fn over_all(
        &self,
        model: &Model,
        tried: &mut Vec<Tried>,
    ) -> Result<Vec<Model>, Stopped> {
        let own = &model.fit.effects;
        if self.is_spent() || self.problem.falls(own)? {
            return Ok(Vec::new());
        }
        let Some(ShowingPart { on, baseline, over }) = self.shown(model)? else {
            return Ok(Vec::new());
        };
        (self.tell)("simulating more of a run with every effect");
        let whole = Whole::of(self.problem, own, &on, || Ok(baseline))?;
        let Some(left) = whole.look(own) else { return Ok(Vec::new()) };
        let kept = self.stepped(model, &whole, (&[], &left), over);
        if self.problem.is_worn_out() {
            return Ok(Vec::new());
        }
        let most = kept.first().map_or(0.0, |(gain, _)| *gain);
        let near = kept.into_iter().filter(|(gain, _)| *gain >= NEAR * most);
        let near: Vec<Setting> = near.map(|(_, start)| start).collect();
        // Values near the best ones: fits over the first half second would lead away from them.
        let whole = Whole::of(self.problem, own, &self.split.on, || Ok(model.baseline.clone()))?;
        let fitted = |start: &Setting| {
            let effects = [own.as_slice(), std::slice::from_ref(start)].concat();
            let mut there = self.at(&effects, &[]).ok().flatten()?;
            there.fit.told = match self.is_noise(&there) {
                true => whole.covariance(&effects),
                false => {
                    let (effects, covariance) = whole.closest(&effects)?;
                    there = self.at(&effects, &[]).ok().flatten()?;
                    Some(covariance)
                }
            };
            Some(there)
        };
        let mut found: Vec<Model> = near.par_iter().filter_map(fitted).collect();
        found.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        for there in &found {
            heard(tried, model, there, model.cost() - there.cost());
        }
        Ok(found)
    }

    /// As much of the runs that values are fitted to, from their beginning on, as shows [clearly](CLEARLY) what a model lacks, or all of
    /// it; none where simulations do not tell it from what hits make of a hair.
    fn shown(&self, model: &Model) -> Result<Option<ShowingPart>, Stopped> {
        let (on, own) = (&self.split.on, &model.fit.effects);
        let longest = on.iter().map(|segment| self.problem.runs[segment.run].recording.duration());
        let longest = longest.fold(0.0, f64::max);
        let mut seconds = 2.0 * SECONDS;
        loop {
            let whole = seconds >= longest;
            let part = on.iter().map(|all| shorter(self.problem, all, (!whole).then_some(seconds)));
            let part: Vec<Segment> = part.collect();
            let baseline = match whole {
                true => model.baseline.clone(),
                false => Baseline::of(self.problem, own, &[], &part)?,
            };
            let seen = |replica| baseline.white_of(self.problem, own, &part, replica);
            let others = (1..baseline.replicas).filter_map(seen);
            let rough = seen(0).map_or(0.0, |first| {
                others.map(|other| (other - &first).norm()).fold(0.0, f64::max)
            });
            let look = baseline.simulated_white(self.problem, own, &part)?;
            let Some(left) = look else { return Ok(None) };
            let missing = left.norm_squared() - left.len() as f64;
            let told = missing > BEYOND_HITS * rough.powi(2);
            if told && (missing > CLEARLY || whole && missing > price(model)) {
                let over = StepLength::Change { change: missing.sqrt(), rough };
                return Ok(Some(ShowingPart { on: part, baseline, over }));
            }
            if whole {
                return Ok(None);
            }
            seconds *= 2.0;
        }
    }

    /// Candidates beside a model that simulations some way along one linear step of their values say most for, beside what other
    /// coordinates to let the machine go from make up for, by which `starts` are the derivatives of what is `left`, and what they
    /// take off it.
    fn stepped(
        &self,
        model: &Model,
        whole: &Whole,
        (starts, left): (&[DVector<f64>], &DVector<f64>),
        over: StepLength,
    ) -> Vec<(f64, Setting)> {
        let own = &model.fit.effects;
        let fresh = |candidate: &&Setting| {
            candidate.kind.scan.is_none() && !own.iter().any(|effect| effect.is(candidate))
        };
        let mut all: Vec<Vec<&Setting>> = Vec::new();
        for candidate in self.candidates.iter().filter(fresh) {
            match all.iter_mut().find(|variants| variants[0].is(candidate)) {
                Some(variants) => variants.push(candidate),
                None => all.push(vec![candidate]),
            }
        }
        let look =
            |effect: &Setting| whole.look(&[own.as_slice(), std::slice::from_ref(effect)].concat());
        // Variants of one effect are one candidate.
        let stepped = |variants: &Vec<&Setting>| {
            let seen = Variants::new(&look);
            let one = |candidate: &&Setting| {
                let with = |values: &[f64]| seen.look(&candidate.with(values));
                linear_step(&with, (&self.problem.declared, candidate), starts, left, over)
            };
            let paid =
                |step: &Stepped| step.gain - GAIN_PER_VALUE * step.to.values().count() as f64;
            variants.iter().filter_map(one).max_by(|a, b| paid(a).total_cmp(&paid(b)))
        };
        let steps: Vec<Stepped> = all.par_iter().filter_map(stepped).collect();
        let mut tried: Vec<(f64, Setting)> = steps
            .par_iter()
            .filter(|step| step.gain > price(model))
            .filter_map(|step| step.tried(whole, own, starts, left))
            .filter(|(gain, _)| *gain > price(model))
            .collect();
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        tried.truncate(FITTED);
        tried
    }
}

/// Says of the last effect of a simulated model what it gains over one without it.
fn heard(tried: &mut Vec<Tried>, model: &Model, there: &Model, gain: f64) {
    let Some(effect) = there.fit.effects.last().cloned() else { return };
    match tried.iter_mut().find(|tried| tried.effect.is(&effect)) {
        Some(tried) => tried.gains(gain, model),
        None => tried.push(Tried::simulated(effect, gain, model)),
    }
}

/// What shows what a model lacks.
struct ShowingPart {
    on: Vec<Segment>,
    /// The model's there.
    baseline: Baseline,
    /// How far values of candidates are moved.
    over: StepLength,
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
        let start = search.stepped(&declared, &whole, (&[], &left), StepLength::Hair).remove(0).1;
        let value = start.values().next().unwrap().1;
        assert!((0.6..1.5).contains(&(value / compliance)), "{value} of {compliance} rad/Nm");
    }
}
