//! The whole way: from a rig and its recordings to a verdict, values with intervals, and errors.

use super::candidates::candidates;
use super::errors::{are_met, mean, of_run};
use super::events::{Event, search::beside};
use super::fit::Fit;
use super::hypotheses::Round;
use super::left::{Left, is_noise};
use super::limits::{Limit, limits};
use super::noise::{self, OtherNoise};
use super::problem::{Problem, Segment, Split, Start, Stopped};
use super::recording::Recording;
use super::rivals::Rest;
use super::search::{Found, Search};
use super::settle::Model;
use super::thresholds::{CLEARED, PREDICTING, SURE};
use super::unnamed::{Described, describe};
use crate::calibrate::errors::{ChannelError, is_worse};
use crate::calibrate::outcome::{Verdict, inverse_normal, pull};
use crate::calibrate::report::Fitted;
use crate::effects::{Setting, UNNAMED};
use nalgebra::{DMatrix, DVector};

/// An effect with its estimates by name.
pub type Estimated = (Setting, Vec<(&'static str, Fitted)>);

/// A calibration.
#[derive(Debug)]
pub struct Outcome {
    /// What it comes to.
    pub verdict: Verdict,
    /// The effects that were found; where the verdict is `unexplained`, a table of efforts alone, if there is
    /// one.
    pub effects: Vec<Estimated>,
    /// What does not last.
    pub events: Vec<Event>,
    /// What stands in for what has no name.
    pub described: Option<Described>,
    /// What the search held for the best, whatever the verdict.
    pub tried: Vec<Setting>,
    /// What speaks against that although it leaves no more than noise.
    pub rest: Option<Rest>,
    /// What is left of the residuals under the declared and under the best model.
    pub before: Vec<Left>,
    /// See there.
    pub after: Vec<Left>,
    /// Sensors whose noise is not what is declared.
    pub noises: Vec<OtherNoise>,
    /// How large each other effect would have to be to be seen; none where what is left is not noise.
    pub limits: Vec<Limit>,
    /// Round by round.
    pub rounds: Vec<Round>,
    /// Errors, run by run and column by column.
    pub errors: Vec<ChannelError>,
    /// What the declared and the calibrated model predict, run by run.
    pub declared: Vec<Recording>,
    /// See there.
    pub predicted: Vec<Recording>,
    /// Largest difference of two replicas of the declared machine in units of noise.
    pub rattle: f64,
}

/// Calibrates: fits on the first run, judges on the others; with one run alone, fits on its first half and
/// judges on the second.
///
/// # Errors
/// A rig that cannot be simulated.
pub fn calibrate(
    problem: &mut Problem,
    without: &[&str],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Outcome, Stopped> {
    tell("finding out whether joints rattle");
    let logs = problem.simulated(&problem.let_go(&[])?, 2)?;
    let noises = noise::correct(problem, &logs);
    let mut rattle = problem.rattle(&logs);
    let split = problem.split();
    let asked = Asked { split: &split, candidates: candidates(&problem.declared, without), tell };
    let mut found = searched(problem, &asked, &mut rattle)?;
    let unnamed = !without.contains(&UNNAMED);
    // What is noise as a whole hides nothing that does not last.
    let mut events = Vec::new();
    if unnamed && !asked.search(problem).is_noise(&found.best) {
        let acting = what_does_not_last(problem, &found, &logs, tell)?;
        if let Some(again) = searched_beside(problem, &asked, &acting, &found, &mut rattle)? {
            (found, events) = (again, acting);
        }
    }
    let search = asked.search(problem);
    let before = search.left(&found.declared);
    let rest = borne_out(&search, &mut found)?;
    let Found { best, declared, rounds, .. } = found;
    let after = search.left(&best);
    let noise = is_noise(&after) && rest.is_none();
    let limits = if noise { limits(&search, &best) } else { Vec::new() };
    let mut described = match noise || !unnamed {
        true => None,
        false => {
            tell("looking for what the residual depends on");
            describe(&search, &declared)?
        }
    };
    let effects = match &described {
        _ if noise => best.fit.effects.clone(),
        Some((described, _)) => vec![described.effect.clone()],
        None => Vec::new(),
    };
    let mut after = described.as_ref().map_or(after, |(_, model)| search.left(model));
    let deviations = if noise { best.fit.deviations() } else { Vec::new() };
    tell("predicting");
    let mut predicting = Predicting::of(problem, &effects, &deviations)?;
    let mut errors = of_all(problem, &predicting);
    if !noise && described.is_some() && is_worse(&errors) {
        described = None;
        after.clone_from(&before);
        predicting.calibrated.clone_from(&predicting.declared);
        errors = of_all(problem, &predicting);
    }
    let nothing = best.fit.effects.is_empty() && events.is_empty();
    let verdict = match (noise && met(problem, &errors, &predicting), nothing) {
        (true, true) => Verdict::NothingMissing,
        (true, false) => Verdict::Explained,
        (false, _) => Verdict::Unexplained,
    };
    let mut effects = match (verdict, &described) {
        (Verdict::Explained, _) => estimated(&best, &split.on),
        (_, Some((described, _))) => vec![(described.effect.clone(), Vec::new())],
        (_, None) => Vec::new(),
    };
    effects.extend(events.iter().map(|event| (event.setting(), event.params())));
    let sensors = problem.declared.sensors.len();
    let means = |logs: &[Vec<Recording>]| logs.iter().map(|logs| mean(logs, sensors)).collect();
    Ok(Outcome {
        effects,
        events,
        described: described.map(|(described, _)| described),
        verdict,
        tried: best.fit.effects.clone(),
        rest,
        before,
        after,
        noises,
        limits,
        rounds,
        errors,
        declared: means(&predicting.declared),
        predicted: means(&predicting.calibrated),
        rattle,
    })
}

/// Largest mean square of residuals in units of noise.
fn largest(left: &[Left]) -> f64 {
    left.iter().map(|left| left.mean_square).fold(0.0, f64::max)
}

/// What a search is asked.
struct Asked<'a> {
    split: &'a Split,
    candidates: Vec<Setting>,
    tell: &'a (dyn Fn(&str) + Sync),
}

impl Asked<'_> {
    fn search<'b>(&'b self, problem: &'b Problem) -> Search<'b> {
        Search::new(problem, self.split, &self.candidates, self.tell)
    }
}

/// What a search finds; a load may lift joints off that rest in the declared machine: what nobody can predict is no
/// model's fault, and is simulated several times then.
fn searched(problem: &mut Problem, asked: &Asked, rattle: &mut f64) -> Result<Found, Stopped> {
    let mut found = asked.search(problem).run()?;
    let effects = found.best.fit.effects.clone();
    if problem.replicas == 1 && !effects.is_empty() {
        *rattle = rattle.max(problem.look_for_rattle(&effects)?);
        if problem.replicas > 1 {
            (asked.tell)("simulating replicas: joints lift off");
            let search = asked.search(problem);
            let best = search.settle(&effects, 2)?.unwrap_or(found.best);
            found.best = search.simplified(best)?;
            found.rest = search.rest(&found.best);
        }
    }
    Ok(found)
}

/// What a search finds beside these events, which act on the rig from then on; none, and the rig as it was, where there are
/// none, or where they leave most of what there was, beside the declared and beside the best model: then they are not what
/// acted. An effect that imitates a part of them may leave less without them.
fn searched_beside(
    problem: &mut Problem,
    asked: &Asked,
    events: &[Event],
    before: &Found,
    rattle: &mut f64,
) -> Result<Option<Found>, Stopped> {
    if events.is_empty() {
        return Ok(None);
    }
    let all = |problem: &Problem, found: &Found| {
        let search = asked.search(problem);
        [&found.declared, &found.best].map(|model| search.left(model))
    };
    let without = all(problem, before);
    problem.rig.effects = events.iter().map(Event::setting).collect();
    let again = searched(problem, asked, rattle)?;
    let left = all(problem, &again);
    let mut pairs = left.iter().zip(&without);
    let cleared = pairs.any(|(left, without)| largest(left) < CLEARED * largest(without));
    if is_noise(&left[1]) || cleared {
        return Ok(Some(again));
    }
    problem.rig.effects.clear();
    Ok(None)
}

/// What does not last, beside the declared model, or, where nothing of it shows there, beside what was found.
fn what_does_not_last(
    problem: &Problem,
    found: &Found,
    declared: &[Vec<Recording>],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Vec<Event>, Stopped> {
    tell("looking for what does not last");
    let events = beside(problem, &[], declared)?;
    let effects = &found.best.fit.effects;
    if !events.is_empty() || effects.is_empty() {
        return Ok(events);
    }
    let simulated = problem.simulated(&problem.starts(effects)?, problem.replicas)?;
    beside(problem, effects, &simulated)
}

/// Puts a model that predicts the recordings in the place of what was found where that leaves noise and misses them; and what
/// speaks against it although it leaves no more than noise.
fn borne_out(search: &Search, found: &mut Found) -> Result<Option<Rest>, Stopped> {
    // What no simulation bears out is nothing that the declared model lacks.
    let against = |model: &Model, rest: Option<Rest>| {
        let uncertain = || uncertain(search.problem, model, &search.split.on).map(Rest::Uncertain);
        let named = search.is_noise(model) && !model.fit.effects.is_empty();
        named.then(|| rest.or_else(uncertain)).flatten()
    };
    found.best = search.certain(found.best.clone())?;
    let best = &found.best;
    let rest = against(best, found.rest.take());
    let mut better = match search.is_noise(best) && rest.is_none() {
        true => search.predicting(best)?,
        false => None,
    };
    // How a machine falls shows effects that its accelerations hardly do, and imitate one another in.
    if better.is_none() && !best.fit.effects.is_empty() && search.problem.falls(&[])? {
        let fails = rest.is_some() || !search.is_noise(best) || search.misses(best)?;
        better = if fails { search.predicting(&found.declared)? } else { None };
    }
    let Some((model, round)) = better else { return Ok(rest) };
    found.best = search.certain(model)?;
    found.rounds.extend(round);
    Ok(against(&found.best, None))
}

/// Whether the errors of all runs are met: a model that misses the run that it was fitted to lacks something.
fn met(problem: &Problem, errors: &[ChannelError], predicting: &Predicting) -> bool {
    problem.runs.iter().zip(&predicting.calibrated).all(|(run, calibrated)| {
        let own = errors.iter().filter(|error| error.run == run.recording.name);
        let own: Vec<ChannelError> = own.cloned().collect();
        are_met(&problem.declared, &own, calibrated)
    })
}

/// Errors of all runs of two models, simulated replica by replica.
fn of_all(problem: &Problem, predicting: &Predicting) -> Vec<ChannelError> {
    let Predicting { declared, calibrated } = predicting;
    let of = |index: usize| {
        let role = if index == 0 { "calibration" } else { "validation" };
        let recording = &problem.runs[index].recording;
        of_run(&problem.declared, recording, role, &declared[index], &calibrated[index])
    };
    (0..problem.runs.len()).flat_map(of).collect()
}

/// What the declared and the calibrated model predict, replicas run by run.
struct Predicting {
    declared: Vec<Vec<Recording>>,
    calibrated: Vec<Vec<Recording>>,
}

impl Predicting {
    /// Leaves the rig as it was declared: what the declared machine would have done knows of nothing that does not last.
    fn of(problem: &mut Problem, effects: &[Setting], deviations: &[f64]) -> Result<Self, Stopped> {
        let starts = problem.starts(effects)?;
        // What nobody knows of values and of how a free machine was let go grows as it swings.
        let open = !deviations.is_empty() && starts.iter().any(Start::is_fitted);
        let replicas = if problem.replicas > 1 || open { PREDICTING } else { 1 };
        let calibrated = problem.simulated_about(effects, deviations, &starts, 0..replicas)?;
        let acting = std::mem::take(&mut problem.rig.effects);
        let declared = match effects.is_empty() && acting.is_empty() {
            true => calibrated.clone(),
            false => problem.simulated(&problem.starts(&[])?, problem.replicas)?,
        };
        Ok(Self { declared, calibrated })
    }
}

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
pub(super) fn uncertain(problem: &Problem, model: &Model, on: &[Segment]) -> Option<Setting> {
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

/// Values with [standard deviations](covariance). Values that nothing depends on are left out.
fn estimated(model: &Model, on: &[Segment]) -> Vec<Estimated> {
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
                let told = std.is_none_or(f64::is_finite);
                told.then(|| (name, Fitted::new(value, std.unwrap_or(f64::NAN))))
            });
            (effect.clone(), fitted.collect())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
