//! The whole way: from a rig and its recordings to a verdict, values with intervals, and errors.

use crate::calibrate::results::verdict::Verdict;
use crate::calibrate::sensed::events::Event;
use crate::calibrate::sensed::events::search::beside;
use crate::calibrate::sensed::intake::followed::unlike;
use crate::calibrate::sensed::intake::noise::{self, OtherNoise};
use crate::calibrate::sensed::judged::left::{Left, is_noise};
use crate::calibrate::sensed::judged::limits::{DetectionLimit, limits};
use crate::calibrate::sensed::judged::unnamed::{DescribedEfforts, describe};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Run, Split, Start, Stopped};
use crate::calibrate::sensed::rounds::rest::Rest;
use crate::calibrate::sensed::rounds::round::Round;
use crate::calibrate::sensed::rounds::search::{Found, Search};
use crate::calibrate::sensed::thresholds::{CLEARED, PREDICTING};
use crate::calibrate::sensed::values::candidates::candidates;
use crate::calibrate::sensed::values::certainty::{Estimated, estimated, uncertain};
use crate::calibrate::sensed::values::errors::{are_met, mean, of_run};
use crate::calibrate::sensed::values::model::Model;
use crate::calibrate::values::errors::{ChannelError, is_worse};
use crate::effects::{Setting, UNNAMED};
use crate::measure::log::LogError;

/// A calibration.
#[derive(Debug)]
pub struct SensedOutcome {
    /// What it comes to.
    pub verdict: Verdict,
    /// The effects that were found; where the verdict is `unexplained`, a table of efforts alone, if there is
    /// one.
    pub effects: Vec<Estimated>,
    /// What does not last.
    pub events: Vec<Event>,
    /// What stands in for what has no name.
    pub described: Option<DescribedEfforts>,
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
    pub limits: Vec<DetectionLimit>,
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
    problem: &mut RigProblem,
    without: &[&str],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<SensedOutcome, Stopped> {
    tell("finding out whether joints rattle");
    let logs = as_declared(problem)?;
    let noises = noise::correct(problem, &logs);
    let mut rattle = problem.rattle(&logs);
    problem.lean_as_noise_allows(&logs);
    let split = problem.split();
    let asked =
        SearchAsked { split: &split, candidates: candidates(&problem.declared, without), tell };
    let unnamed = !without.contains(&UNNAMED);
    let (mut found, events) = searched_with_events(problem, &asked, unnamed, &logs, &mut rattle)?;
    let search = asked.search(problem);
    let before = search.left(&found.declared);
    let rest = borne_out(&search, &mut found)?;
    let Found { best, declared, rounds, .. } = found;
    let after = search.left(&best);
    let noise = is_noise(&after) && rest.is_none();
    let limits = if noise { limits(&search, &best) } else { Vec::new() };
    let mut described = None;
    if !noise && unnamed {
        tell("looking for what the residual depends on");
        described = describe(&search, &declared)?;
    }
    let effects = calibrated(&best, noise, described.as_ref().map(|(described, _)| described));
    let mut after = described.as_ref().map_or(after, |(_, model)| search.left(model));
    let deviations = if noise { best.fit.deviations() } else { Vec::new() };
    tell("predicting");
    let mut predicting = Predicting::of(problem, &effects, &deviations)?;
    let noises = noise::borne_out(problem, noises, &predicting.calibrated);
    let mut errors = of_all(problem, &predicting);
    if !noise && described.is_some() && is_worse(&errors) {
        described = None;
        after.clone_from(&before);
        predicting.calibrated.clone_from(&predicting.declared);
        errors = of_all(problem, &predicting);
    }
    let nothing = best.fit.effects.is_empty() && events.is_empty();
    let verdict = verdict(noise && met(problem, &errors, &predicting), nothing);
    let found = match (verdict, &described) {
        (Verdict::Explained, _) => estimated(&best, &split.on),
        (_, described) => described.iter().map(|(d, _)| (d.effect.clone(), Vec::new())).collect(),
    };
    let acting = events.iter().map(|event| (event.setting(), event.params()));
    let [declared, predicted] = predicting.means(problem);
    Ok(SensedOutcome {
        effects: found.into_iter().chain(acting).collect(),
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
        declared,
        predicted,
        rattle,
    })
}

/// Two simulations of each run as declared, by which efforts and accelerations are what their heads say.
fn as_declared(problem: &RigProblem) -> Result<Vec<Vec<Recording>>, Stopped> {
    let simulated = problem.simulated_as_declared()?;
    let unlike = |(run, logs): (&Run, &Vec<Recording>)| {
        unlike(&problem.rig, &problem.declared, &run.recording, logs)
    };
    let mistaken: Vec<LogError> = problem.runs.iter().zip(&simulated).flat_map(unlike).collect();
    if mistaken.is_empty() { Ok(simulated) } else { Err(Stopped::Mistaken(mistaken)) }
}

/// What a model comes to that predicts the recordings or does not, and adds nothing to the declared one or something.
fn verdict(predicts: bool, nothing: bool) -> Verdict {
    match (predicts, nothing) {
        (true, true) => Verdict::NothingMissing,
        (true, false) => Verdict::Explained,
        (false, _) => Verdict::Unexplained,
    }
}

/// Effects of the calibrated model: those of the best one if it leaves no more than noise, else what stands in for what has
/// no name.
fn calibrated(best: &Model, noise: bool, described: Option<&DescribedEfforts>) -> Vec<Setting> {
    match described {
        _ if noise => best.fit.effects.clone(),
        Some(described) => vec![described.effect.clone()],
        None => Vec::new(),
    }
}

/// Largest mean square of residuals in units of noise.
fn largest(left: &[Left]) -> f64 {
    left.iter().map(|left| left.mean_square).fold(0.0, f64::max)
}

/// What a search is asked.
struct SearchAsked<'a> {
    split: &'a Split,
    candidates: Vec<Setting>,
    tell: &'a (dyn Fn(&str) + Sync),
}

impl SearchAsked<'_> {
    fn search<'b>(&'b self, problem: &'b RigProblem) -> Search<'b> {
        Search::new(problem, self.split, &self.candidates, self.tell)
    }
}

/// What a search finds; a load may lift joints off that rest in the declared machine: what nobody can predict is no
/// model's fault, and is simulated several times then.
fn searched(
    problem: &mut RigProblem,
    asked: &SearchAsked,
    rattle: &mut f64,
) -> Result<Found, Stopped> {
    let mut found = asked.search(problem).run()?;
    let effects = found.best.fit.effects.clone();
    let none = effects.is_empty() && !asked.search(problem).is_noise(&found.best);
    if problem.replicas == 1 && none && problem.falls(&[])? && !problem.is_worn_out() {
        *rattle = rattle.max(problem.look_for_rattle_nearby()?);
        if problem.replicas > 1 {
            (asked.tell)("simulating replicas: where it was let go decides how it falls");
            return asked.search(problem).run();
        }
    }
    if problem.replicas == 1 && !effects.is_empty() {
        *rattle = rattle.max(problem.look_for_rattle(&effects)?);
        if problem.replicas > 1 {
            (asked.tell)("simulating replicas: joints lift off");
            let search = asked.search(problem);
            if found.lifts_off {
                return search.run();
            }
            // What is noise in one simulation explains the recordings, whatever others are like.
            let settled = search.settle(&effects, 2)?;
            let settled =
                settled.filter(|own| search.is_noise(own) || !search.is_noise(&found.best));
            found.best = search.simplified(settled.unwrap_or(found.best))?;
            found.rest = search.rest(&found.best)?;
        }
    }
    Ok(found)
}

/// What a search finds, and what does not last where what has no name is looked for; `declared` are simulations of the
/// declared machine.
fn searched_with_events(
    problem: &mut RigProblem,
    asked: &SearchAsked,
    unnamed: bool,
    declared: &[Vec<Recording>],
    rattle: &mut f64,
) -> Result<(Found, Vec<Event>), Stopped> {
    let found = searched(problem, asked, rattle)?;
    // What is noise as a whole hides nothing that does not last.
    if unnamed && !asked.search(problem).is_noise(&found.best) {
        let acting = what_does_not_last(problem, &found, declared, asked.tell)?;
        if let Some(again) = searched_beside(problem, asked, &acting, &found, rattle)? {
            return Ok((again, acting));
        }
    }
    Ok((found, Vec::new()))
}

/// What a search finds beside these events, which act on the rig from then on; none, and the rig as it was, where there are
/// none, or where they leave most of what there was, beside the declared and beside the best model: then they are not what
/// acted. An effect that imitates a part of them may leave less without them.
fn searched_beside(
    problem: &mut RigProblem,
    asked: &SearchAsked,
    events: &[Event],
    before: &Found,
    rattle: &mut f64,
) -> Result<Option<Found>, Stopped> {
    if events.is_empty() || problem.is_worn_out() {
        return Ok(None);
    }
    let all = |problem: &RigProblem, found: &Found| {
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
    problem: &RigProblem,
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
    let simulated = problem.simulated(&problem.let_go(effects)?, problem.replicas)?;
    beside(problem, effects, &simulated)
}

/// Puts a model that predicts the recordings in the place of what was found where that leaves noise and misses them: those that
/// values are fitted to, then the others; and what speaks against it although it leaves no more than noise.
fn borne_out(search: &Search, found: &mut Found) -> Result<Option<Rest>, Stopped> {
    let mut rest = predicting(search, found)?;
    if matches!(rest, None | Some(Rest::Values(_)))
        && let Some((meeting, round)) = search.meeting_all(&found.best)?
    {
        found.best = meeting;
        found.rounds.extend(round);
        rest = against(search, found, None);
    }
    if rest.is_none()
        && search.is_noise(&found.best)
        && let Some(closest) = search.closest(&found.best)?
    {
        found.best = closest;
        rest = against(search, found, None);
    }
    Ok(rest)
}

/// The same for the recordings that values are fitted to.
fn predicting(search: &Search, found: &mut Found) -> Result<Option<Rest>, Stopped> {
    found.best = search.certain(found.best.clone())?;
    let rest = found.rest.take();
    let rest = against(search, found, rest);
    let best = &found.best;
    let mut better = match search.is_noise(best) && rest.is_none() {
        true => search.predicting(best)?,
        false => None,
    };
    // How a machine falls shows effects that its accelerations hardly do, and imitate one another in.
    let worn_out = search.problem.is_worn_out();
    if better.is_none() && !worn_out && !best.fit.effects.is_empty() && search.problem.falls(&[])? {
        let fails =
            rest.is_some() || !search.is_noise(best) || search.misses(best, &search.split.on)?;
        better = if fails { search.predicting(&found.declared)? } else { None };
    }
    let Some((model, round)) = better else { return Ok(rest) };
    found.best = search.certain(model)?;
    found.rounds.extend(round);
    Ok(against(search, found, None))
}

/// What speaks against a model that was found and leaves no more than noise: what no simulation bears out is nothing that the
/// declared model lacks.
fn against(
    search: &Search,
    Found { best, declared, .. }: &Found,
    rest: Option<Rest>,
) -> Option<Rest> {
    let uncertain = || uncertain(search.problem, best, &search.split.on).map(Rest::Uncertain);
    let rattles = || search.rattles_alone(declared, best).map(Rest::Rattles);
    let named = search.is_noise(best) && !best.fit.effects.is_empty();
    named.then(|| rest.or_else(uncertain).or_else(rattles)).flatten()
}

/// Whether the errors of all runs are met: a model that misses the run that it was fitted to lacks something.
fn met(problem: &RigProblem, errors: &[ChannelError], predicting: &Predicting) -> bool {
    problem.runs.iter().zip(&predicting.calibrated).all(|(run, calibrated)| {
        let own = errors.iter().filter(|error| error.run == run.recording.name);
        let own: Vec<ChannelError> = own.cloned().collect();
        are_met(&problem.declared, &own, calibrated)
    })
}

/// Errors of all runs of two models, simulated replica by replica.
fn of_all(problem: &RigProblem, predicting: &Predicting) -> Vec<ChannelError> {
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
    fn of(
        problem: &mut RigProblem,
        effects: &[Setting],
        deviations: &[f64],
    ) -> Result<Self, Stopped> {
        let starts = problem.let_go(effects)?;
        // What nobody knows of values and of how a free machine was let go grows as it swings.
        let open = !deviations.is_empty() && starts.iter().any(Start::is_fitted);
        let replicas = if problem.replicas > 1 || open { PREDICTING } else { 1 };
        let calibrated = problem.simulated_about(effects, deviations, &starts, 0..replicas)?;
        let acting = std::mem::take(&mut problem.rig.effects);
        let declared = match effects.is_empty() && acting.is_empty() {
            true => calibrated.clone(),
            false => problem.simulated(&problem.let_go(&[])?, problem.replicas)?,
        };
        Ok(Self { declared, calibrated })
    }

    /// Means over replicas, run by run, of the declared and of the calibrated model.
    fn means(&self, problem: &RigProblem) -> [Vec<Recording>; 2] {
        let sensors = problem.declared.sensors.len();
        [&self.declared, &self.calibrated]
            .map(|runs| runs.iter().map(|logs| mean(logs, sensors)).collect())
    }
}
