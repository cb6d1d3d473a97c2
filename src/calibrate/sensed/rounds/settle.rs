//! Models whose values agree with simulations of themselves.

use super::round::{Round, Tried};
use super::search::Search;
use super::words::{name, names};
use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::residuals::problem::{Segment, Stopped};
use crate::calibrate::sensed::thresholds::TWINS;
use crate::calibrate::sensed::values::errors::{are_met, of_run};
use crate::calibrate::sensed::values::fit::Fit;
use crate::calibrate::sensed::values::model::{Model, price};
use crate::calibrate::sensed::values::trajectory::{Far, fitted, followed, predicted, shorter};
use crate::calibrate::sensed::values::whole::Whole;
use crate::calibrate::values::least_squares::{free, values, with_values};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};

/// A change of a value, in its standard deviations, that is none.
const SETTLED: f64 = 0.3;

/// A change above which passes are held against the ones before: what looks make of a worn joint's clearance, by which way its journal
/// leans, turned round at each pass, by three fifths of the last one.
const FAR: f64 = 10.0 * SETTLED;

/// Most of what a pass moves values by that they are moved: passes that bring half of what is missing bring all of it so.
const MOST: f64 = 2.0;

impl Search<'_> {
    /// Fits the values of a model, simulating it anew each time: what a look is wrong by depends on them.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub fn settle(&self, effects: &[Setting], times: usize) -> Result<Option<Model>, Stopped> {
        self.settle_within(effects, times, f64::INFINITY)
    }

    /// The same, given up where as much again as the last pass brought would leave its misfit above `enough`: each brings less
    /// than the one before.
    pub(in crate::calibrate::sensed) fn settle_within(
        &self,
        effects: &[Setting],
        times: usize,
        enough: f64,
    ) -> Result<Option<Model>, Stopped> {
        let segments = [self.split.on.as_slice(), &self.split.hold].concat();
        let mut effects = effects.to_vec();
        let mut settled: Option<Model> = None;
        let mut last: Option<(DVector<f64>, f64)> = None;
        for _ in 0..times.max(1) {
            let deviations = settled.as_ref().map(|model| model.fit.deviations());
            let deviations = deviations.unwrap_or_default();
            let baseline = match Baseline::of(self.problem, &effects, &deviations, &segments) {
                Ok(baseline) => baseline,
                // What cannot be simulated is no model; what was so far may be one.
                Err(_) if !effects.is_empty() => break,
                Err(stopped) => return Err(stopped),
            };
            let steps = if effects.is_empty() { 0 } else { 6 };
            let target = self.target(&baseline, false);
            let Some(fit) = target.fit(&effects, steps) else { break };
            let fit = target.settled(fit);
            let Some(held) = self.target(&baseline, true).look(&fit.effects) else { break };
            let moved = moved(&effects, &fit);
            let change = moved.amax();
            let far = !baseline.rattles && change > FAR;
            let share = last.filter(|_| far).map_or(1.0, |last| share(&last, &moved));
            effects = part_way(&effects, &fit.effects, share);
            last = Some((moved, share));
            let own = self.noisiness(&baseline, &self.split.hold);
            let noise = own + baseline.lost(&self.split.hold);
            let (rattles, known) = (baseline.rattles, !deviations.is_empty());
            let model = Model { fit, held: held.chi2, misfit: held.chi2 + noise, baseline };
            // Two replicas of joints that lift off now and then may happen to be alike, and know nothing of it.
            let rattled = |before: &Model| before.baseline.rattles || rattles;
            let brought = settled.as_ref().map(|before| before.misfit - model.misfit);
            let hopeless = brought.is_some_and(|brought| model.misfit - brought > enough);
            let worse = settled
                .as_ref()
                .is_some_and(|before| rattled(before) && before.misfit < model.misfit);
            if !worse {
                settled = Some(model);
            }
            // Where joints rattle the second pass knows how far values may be off.
            if hopeless || change < SETTLED && (!rattles || known) {
                break;
            }
        }
        Ok(settled)
    }

    /// What models pay on segments for their noise, as logarithms of its determinant: where none rattles it is that of the
    /// sensors, the same for all.
    pub(in crate::calibrate::sensed) fn noisiness(
        &self,
        baseline: &Baseline,
        segments: &[Segment],
    ) -> f64 {
        if self.problem.replicas > 1 { baseline.log_determinant(segments) } else { 0.0 }
    }

    /// A model that begins with the recorded swing in place of one that leaves no more than noise beside a swing that it has
    /// lost: its values are known better, and so is how its journals lean.
    pub(super) fn swinging_as_seen(&self, model: Model) -> Result<Model, Stopped> {
        let effects = &model.fit.effects;
        if model.baseline.rattles || !model.baseline.has_lost_the_swing() {
            return Ok(model);
        }
        (self.tell)("looking at how it swings at first");
        if self.problem.see_swing(effects)?
            && let Some(swinging) = self.at(effects, &[])?
        {
            let swinging = self.refined(swinging, Far::All)?;
            if self.is_noise(&swinging) {
                return Ok(swinging);
            }
        }
        self.problem.forget_swing();
        Ok(model)
    }

    /// The model with values from whole simulations, where these can be followed to their end and that is better.
    pub(in crate::calibrate::sensed) fn refined(
        &self,
        model: Model,
        far: Far,
    ) -> Result<Model, Stopped> {
        if model.fit.effects.is_empty() || self.is_lost(&model)? {
            return Ok(model);
        }
        (self.tell)(&format!("fitting whole simulations with {}", names(&model.fit.effects)));
        let refined = self.fitted(&model.fit.effects, far)?;
        Ok(refined.filter(|refined| refined.misfit < model.misfit).unwrap_or(model))
    }

    /// Whether a model's joints rattle, so that no simulation of it can be followed to the end.
    pub(super) fn is_lost(&self, model: &Model) -> Result<bool, Stopped> {
        let followed = || followed(self.problem, &model.fit.effects, &self.split.on);
        Ok(model.baseline.rattles && followed()?.last() != Some(&None))
    }

    /// A model with values from whole simulations, from these on; none where it cannot be. Simulations say how well they are
    /// known, too: looks may hardly depend on them.
    pub(in crate::calibrate::sensed) fn fitted(
        &self,
        effects: &[Setting],
        far: Far,
    ) -> Result<Option<Model>, Stopped> {
        let values = match fitted(self.problem, effects, &self.split.on, far) {
            Ok(values) => values,
            Err(_) if !effects.is_empty() => return Ok(None),
            Err(stopped) => return Err(stopped),
        };
        let mut model = self.at(&values, &[])?;
        if let Some(model) = &mut model {
            model.fit.told = self.over_whole(model, |whole, effects| {
                let told = whole.falls() || !model.baseline.rattles;
                told.then(|| whole.covariance(effects)).flatten()
            })?;
        }
        Ok(model)
    }

    /// What whole simulations of a model say, over as much of the runs that values are fitted to as they can be followed.
    pub(super) fn over_whole<T>(
        &self,
        Model { fit, baseline, .. }: &Model,
        said: impl FnOnce(&Whole, &[Setting]) -> T,
    ) -> Result<T, Stopped> {
        let length = followed(self.problem, &fit.effects, &self.split.on)?.pop().flatten();
        let on = self.split.on.iter();
        let on: Vec<_> = on.map(|segment| shorter(self.problem, segment, length)).collect();
        let whole = Whole::of(self.problem, &fit.effects, &on, || Ok(baseline.clone()))?;
        Ok(said(&whole, &fit.effects))
    }

    /// A model whose values whole simulations tell at the [closest](Whole::closest) ones; none where they do not tell any, or cannot
    /// be followed, or where it leaves more than noise with these.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn closest(
        &self,
        model: &Model,
    ) -> Result<Option<Model>, Stopped> {
        if model.fit.told.is_none() || self.problem.is_worn_out() || self.is_lost(model)? {
            return Ok(None);
        }
        (self.tell)(&format!("fitting whole simulations with {}", names(&model.fit.effects)));
        self.as_told(self.over_whole(model, |whole, effects| whole.closest(effects))?)
    }

    /// The same from the best of other values [around](Whole::around) its own.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(super) fn elsewhere(&self, model: &Model) -> Result<Option<Model>, Stopped> {
        if self.problem.is_worn_out() {
            return Ok(None);
        }
        (self.tell)(&format!("looking at other values of {}", names(&model.fit.effects)));
        let closest = |whole: &Whole, effects: &[Setting]| whole.closest(&whole.around(effects)?);
        self.as_told(self.over_whole(model, closest)?)
    }

    /// A model whose values whole simulations tell that well; none where it leaves more than noise.
    fn as_told(
        &self,
        closest: Option<(Vec<Setting>, DMatrix<f64>)>,
    ) -> Result<Option<Model>, Stopped> {
        let Some((effects, covariance)) = closest else { return Ok(None) };
        let mut closest = self.at(&effects, &[])?;
        if let Some(closest) = &mut closest {
            closest.fit.told = Some(covariance);
        }
        Ok(closest.filter(|closest| self.is_noise(closest)))
    }

    /// A model whose predictions of the runs that values are fitted to are met, and the round that led to it, in place of
    /// one that leaves no more than noise, and whose predictions miss: what residuals do not see may still lead whole
    /// simulations astray. None where these are met already, and where no such model is found.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn predicting(
        &self,
        model: &Model,
    ) -> Result<Option<(Model, Option<Round>)>, Stopped> {
        let on = &self.split.on;
        if !self.misses(model, on)? {
            return Ok(None);
        }
        let effects = &model.fit.effects;
        let mut closer: Option<Model> = None;
        if !effects.is_empty() && !model.baseline.rattles {
            (self.tell)(&format!("fitting whole simulations with {}", names(effects)));
            let fitted = self.fitted(effects, Far::All).ok().flatten();
            closer = fitted.filter(|closer| self.is_noise(closer));
        }
        let met = |closer: &Option<Model>| match closer {
            Some(closer) => Ok(!self.misses(closer, on)?),
            None => Ok::<_, Stopped>(false),
        };
        let mut is_met = met(&closer)?;
        // Looks may hardly depend on what predictions do.
        if !effects.is_empty() && !is_met {
            closer = self.foretold(closer.as_ref().unwrap_or(model))?.or(closer);
            is_met = met(&closer)?;
        }
        if is_met {
            return Ok(closer.map(|closer| (closer, None)));
        }
        let mut round = Round::default();
        let found = self.unseen(closer.as_ref().unwrap_or(model), &mut round.tried)?;
        for found in found.into_iter().filter(|found| self.is_noise(found)) {
            if !self.misses(&found, on)? {
                round.added = found.fit.effects.last().cloned();
                round.as_good = twins(&round, TWINS[usize::from(found.baseline.rattles)]);
                return Ok(Some((found, Some(round))));
            }
        }
        Ok(None)
    }

    /// A model whose joints rattle with values from predictions; none where these leave more than noise, or where simulations
    /// are too many already.
    pub(super) fn foretold(&self, model: &Model) -> Result<Option<Model>, Stopped> {
        if self.problem.is_worn_out() {
            return Ok(None);
        }
        (self.tell)(&format!("fitting predictions with {}", names(&model.fit.effects)));
        let predicted = predicted(self.problem, &model.fit.effects, &self.split.on);
        let Ok(effects) = predicted else { return Ok(None) };
        let foretold = self.at(&effects, &model.fit.deviations()).ok().flatten();
        Ok(foretold.filter(|foretold| self.is_noise(foretold)))
    }

    /// Whether a model's predictions miss a run of these segments.
    pub(in crate::calibrate::sensed) fn misses(
        &self,
        model: &Model,
        segments: &[Segment],
    ) -> Result<bool, Stopped> {
        let (problem, effects) = (self.problem, &model.fit.effects);
        let starts = problem.let_go(effects)?;
        let replicas = 0..problem.replicas;
        let clean = problem.simulated_about(effects, &model.fit.deviations(), &starts, replicas)?;
        Ok(segments.iter().any(|segment| {
            let (clean, run) = (&clean[segment.run], &problem.runs[segment.run]);
            let errors = of_run(&problem.declared, &run.recording, "calibration", clean, clean);
            !are_met(&problem.declared, &errors, clean)
        }))
    }

    /// The model with exactly these values, but for `deviations` of its replicas; none where it cannot be.
    pub(in crate::calibrate::sensed) fn at(
        &self,
        effects: &[Setting],
        deviations: &[f64],
    ) -> Result<Option<Model>, Stopped> {
        let segments = [self.split.on.as_slice(), &self.split.hold].concat();
        let baseline = match Baseline::of(self.problem, effects, deviations, &segments) {
            Ok(baseline) => baseline,
            // What cannot be simulated is no model.
            Err(_) if !effects.is_empty() => return Ok(None),
            Err(stopped) => return Err(stopped),
        };
        let on = self.target(&baseline, false);
        let Some(mut fit) = on.look(effects) else { return Ok(None) };
        fit.jacobian = on.jacobian(&fit);
        let Some(held) = self.target(&baseline, true).look(effects) else { return Ok(None) };
        let own = self.noisiness(&baseline, &self.split.hold);
        let misfit = held.chi2 + own + baseline.lost(&self.split.hold);
        Ok(Some(Model { fit, held: held.chi2, misfit, baseline }))
    }

    /// The model without effects that it does not need.
    pub(in crate::calibrate::sensed) fn needed(&self, mut model: Model) -> Result<Model, Stopped> {
        let mut i = 0;
        while model.fit.effects.len() > 1 && i < model.fit.effects.len() {
            let mut fewer = model.fit.effects.clone();
            let dropped = fewer.remove(i);
            (self.tell)(&format!("simulating without {}", name(&dropped)));
            // Looks move values that only simulations tell away from where these have put them.
            let simpler = [self.settle(&fewer, 2)?, self.at(&fewer, &[])?].into_iter().flatten();
            match simpler.min_by(|a, b| a.cost().total_cmp(&b.cost())) {
                Some(simpler) if simpler.cost() < model.cost() + price(&model) => model = simpler,
                _ => i += 1,
            }
        }
        Ok(model)
    }
}

/// What was simulated in a round and gained no less than what was added, but for `chance`.
fn twins(round: &Round, chance: f64) -> Vec<Setting> {
    let added = |tried: &&Tried| round.added.as_ref().is_some_and(|own| own.is(&tried.effect));
    let simulated = || round.tried.iter().filter(|tried| tried.simulated);
    let gain = simulated().find(added).map_or(f64::INFINITY, |tried| tried.gain);
    let near = simulated().filter(|tried| !added(tried) && tried.gain > gain - chance);
    near.map(|tried| tried.effect.clone()).collect()
}

/// Changes of values by a fit, in their standard deviations, each by itself.
fn moved(before: &[Setting], fit: &Fit) -> DVector<f64> {
    let Some(jacobian) = &fit.jacobian else { return DVector::zeros(1) };
    let sizes = jacobian.column_iter().map(|column| column.norm());
    let pairs = values(before).into_iter().zip(values(&fit.effects)).zip(sizes);
    DVector::from_iterator(
        jacobian.ncols(),
        pairs.map(|((before, after), size)| (after - before) * size),
    )
}

/// The share `ω` of what a pass moves values by, `d`, that leads where further ones would, if what they move them by hangs on the values
/// as a straight line does along the last one, which went by `ω′ d′`: `ω = −ω′ d′·(d − d′) / |d − d′|²`; [at most](MOST) some. (Aitken's
/// Δ² process, for vectors by Irons and Tuck, Int. J. Numer. Meth. Eng. 1, 1969.)
fn share((before, share): &(DVector<f64>, f64), moved: &DVector<f64>) -> f64 {
    if before.len() != moved.len() {
        return 1.0;
    }
    let turned = moved - before;
    let whole = -share * before.dot(&turned) / turned.norm_squared();
    if whole.is_finite() && whole > 0.0 { whole.min(MOST) } else { 1.0 }
}

/// Values that share of the way from one place to another, within bounds.
fn part_way(from: &[Setting], to: &[Setting], share: f64) -> Vec<Setting> {
    let pairs = values(from).into_iter().zip(values(to)).zip(free(to));
    let there = pairs.map(|((from, to), free)| {
        (to + (share - 1.0) * (to - from)).clamp(free.bounds[0], free.bounds[1])
    });
    with_values(to, &there.collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::residuals::problem::RigProblem;
    use crate::effects::{Target, named};

    /// A drag is not what is missing: four passes are made of it, and two where nothing it could bring would be enough.
    #[test]
    fn what_brings_too_little_is_given_up() {
        let problem = RigProblem::planar("planar-1");
        let split = problem.split();
        let search = Search::new(&problem, &split, &[], &|_| {});
        let body = Target::Body("rod".to_owned());
        let drag =
            Setting::on(named("drag").unwrap(), body, &[("force_Ns_m", 0.1), ("torque_Nms", 1e-3)]);
        let simulations = |enough: f64| {
            let before = problem.simulations();
            let settled = search.settle_within(std::slice::from_ref(&drag), 4, enough).unwrap();
            assert!(settled.is_some());
            problem.simulations() - before
        };
        let [all, few] = [f64::INFINITY, f64::NEG_INFINITY].map(simulations);
        assert!(all > few && all.is_multiple_of(few / 2), "{all} simulations, and {few}");
    }

    /// What turns round at each pass by three fifths of the last one, and what brings half of what is missing, is there after two; what
    /// flees is followed no further than twice as far, and what turns from its way is no line.
    #[test]
    fn passes_lead_where_further_ones_would() {
        let of = |before: f64, moved: f64| {
            share(&(DVector::from_vec(vec![before]), 1.0), &DVector::from_vec(vec![moved]))
        };
        let ends = |place: f64, factor: f64| {
            let [first, second] = [-place, -place * factor].map(|away| away * (1.0 - factor));
            place * factor + of(first, second) * second
        };
        for factor in [-0.6, 0.2, 0.5] {
            assert!(ends(1.0, factor).abs() < 1e-12, "{factor}: {}", ends(1.0, factor));
        }
        assert_eq!([of(1.0, 0.9), of(1.0, 1.5)], [MOST, 1.0]);
        let two = |x: f64, y: f64| DVector::from_vec(vec![x, y]);
        assert!((share(&(two(1.0, 0.0), 1.0), &two(0.0, 1.0)) - 0.5).abs() < 1e-12);
        assert_eq!(share(&(two(1.0, 0.0), 1.0), &DVector::zeros(1)), 1.0);
    }

    /// An oil film so stiff that no step is short enough for it is no model, and stops no search.
    #[test]
    fn what_cannot_be_simulated_is_no_model() {
        let problem = RigProblem::planar("planar-1");
        let split = problem.split();
        let search = Search::new(&problem, &split, &[], &|_| {});
        let joint = Target::Joints(vec!["A".to_owned()]);
        let kind = named("lubricant-film").unwrap();
        let film = |damping: f64| Setting::on(kind, joint.clone(), &[("damping_Ns_m", damping)]);
        let stiff = [film(1e15)];
        let starts = problem.let_go(&stiff).unwrap();
        assert!(problem.simulated(&starts, 1).is_err(), "the test rests on it");
        assert!(search.at(&stiff, &[]).unwrap().is_none());
        assert!(search.fitted(&stiff, Far::All).unwrap().is_none());
    }
}
