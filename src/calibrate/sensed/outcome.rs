//! The whole way: from a rig and its recordings to a verdict, values with intervals, and errors.

use super::candidates::candidates;
use super::errors::of_run;
use super::events::{Event, search::beside};
use super::fit::Fit;
use super::hypotheses::Round;
use super::left::{Left, is_noise};
use super::limits::{Limit, limits};
use super::noise::{self, OtherNoise};
use super::problem::{Problem, Segment, Split, Stopped};
use super::recording::Recording;
use super::residual::Name;
use super::search::{Found, Search};
use super::settle::Model;
use super::thresholds::{MET, PREDICTING};
use super::unnamed::{Described, describe};
use crate::calibrate::errors::ChannelError;
use crate::calibrate::outcome::{Verdict, inverse_normal, pull};
use crate::calibrate::report::Fitted;
use crate::effects::{Setting, UNNAMED};

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
    let looked = !without.contains(&UNNAMED);
    let mut events = Vec::new();
    if looked {
        tell("looking for what does not last");
        events = beside(problem, &[], &logs)?;
        problem.rig.effects = events.iter().map(Event::setting).collect();
    }
    let split = problem.split();
    let candidates = candidates(&problem.declared, without);
    let names: Vec<Name> = problem.names().unwrap_or_default();
    let search = Search { problem: &*problem, split: &split, candidates, names, tell };
    let Found { mut best, declared, rounds } = search.run()?;
    let Search { candidates, names, .. } = search;
    if looked && events.is_empty() && !best.fit.effects.is_empty() {
        let parts = (candidates.as_slice(), names.as_slice());
        (events, best) = looked_again(problem, &split, parts, best, tell)?;
    }
    // A load may lift joints off that rest in the declared machine: what nobody can predict is no model's fault.
    if problem.replicas == 1 && !best.fit.effects.is_empty() {
        rattle = rattle.max(problem.look_for_rattle(&best.fit.effects)?);
        if problem.replicas > 1 {
            tell("simulating replicas: joints lift off");
            let (candidates, names) = (Vec::new(), names.clone());
            let search = Search { problem: &*problem, split: &split, candidates, names, tell };
            best = search.settle(&best.fit.effects, 2)?.unwrap_or(best);
            best = search.simplified(best)?;
        }
    }
    let search = Search { problem: &*problem, split: &split, candidates, names, tell };
    let (before, after) = (search.left(&declared), search.left(&best));
    tell("predicting");
    let noise = is_noise(&after);
    let limits = limits(&search, &best);
    let described = match noise || without.contains(&UNNAMED) {
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
    let after = described.as_ref().map_or(after, |(_, model)| search.left(model));
    let replicas = if problem.replicas > 1 { PREDICTING } else { 1 };
    let deviations = if noise { best.fit.deviations() } else { Vec::new() };
    let starts = problem.starts(&effects)?;
    let calibrated = problem.simulated_about(&effects, &deviations, &starts, replicas)?;
    // What the declared machine would have done knows of no event either.
    problem.rig.effects.clear();
    let plain = match effects.is_empty() && events.is_empty() {
        true => calibrated.clone(),
        false => problem.simulated(&problem.starts(&[])?, problem.replicas)?,
    };
    let mut errors = Vec::new();
    for index in 0..problem.runs.len() {
        let role = if index == 0 { "calibration" } else { "validation" };
        errors.extend(of_run(&*problem, index, role, &plain[index], &calibrated[index]));
    }
    // A model that misses the run that it was fitted to lacks something.
    let met = errors.iter().all(|error| error.after <= MET * error.floor);
    let nothing = best.fit.effects.is_empty() && events.is_empty();
    let verdict = match (noise && met, nothing) {
        (true, true) => Verdict::NothingMissing,
        (true, false) => Verdict::Explained,
        (false, _) => Verdict::Unexplained,
    };
    let sensors = problem.declared.sensors.len();
    let means = |logs: &[Vec<Recording>]| {
        logs.iter().map(|logs| super::errors::mean(logs, sensors)).collect::<Vec<_>>()
    };
    let mut effects = match (verdict, &described) {
        (Verdict::Explained, _) => estimated(&best, &split.on),
        (_, Some((described, _))) => vec![(described.effect.clone(), Vec::new())],
        (_, None) => Vec::new(),
    };
    effects.extend(events.iter().map(|event| (event.setting(), event.params())));
    Ok(Outcome {
        effects,
        events,
        described: described.map(|(described, _)| described),
        verdict,
        tried: best.fit.effects.clone(),
        before,
        after,
        noises,
        limits,
        rounds,
        errors,
        declared: means(&plain),
        predicted: means(&calibrated),
        rattle,
    })
}

/// What does not last beside the effects of a model, where that leaves more than noise, and the model settled anew.
fn looked_again(
    problem: &mut Problem,
    split: &Split,
    (candidates, names): (&[Setting], &[Name]),
    best: Model,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<(Vec<Event>, Model), Stopped> {
    let (candidates, names) = (candidates.to_vec(), names.to_vec());
    let search = Search { problem: &*problem, split, candidates, names, tell };
    if is_noise(&search.left(&best)) {
        return Ok((Vec::new(), best));
    }
    let Search { candidates, names, .. } = search;
    tell("looking for what does not last beside the effects found");
    let starts = problem.starts(&best.fit.effects)?;
    let simulated = problem.simulated(&starts, problem.replicas)?;
    let events = beside(problem, &best.fit.effects, &simulated)?;
    if events.is_empty() {
        return Ok((events, best));
    }
    problem.rig.effects = events.iter().map(Event::setting).collect();
    let search = Search { problem: &*problem, split, candidates, names, tell };
    Ok((events, search.with_events(best)?))
}

/// Values with standard deviations: `(JᵀJ)⁻¹`, J in units of noise; wider where the fit's own residual is larger
/// than noise, and where rattle pulls values further than noise of one frequency by itself.
fn estimated(model: &Model, on: &[Segment]) -> Vec<Estimated> {
    let Fit { effects, jacobian, chi2, white } = &model.fit;
    let deviations = jacobian.as_ref().and_then(|jacobian| {
        let inverse = inverse_normal(jacobian)?;
        let spare = white.len().saturating_sub(jacobian.ncols()).max(1);
        let pulled = match model.baseline.rattles {
            true => pull(jacobian, &inverse, &model.baseline.draws(on)),
            false => 1.0,
        };
        let factor = (chi2 / spare as f64).max(pulled).max(1.0).sqrt();
        Some(inverse.diagonal().map(|square| square.max(0.0).sqrt() * factor))
    });
    let mut next = 0;
    effects
        .iter()
        .map(|effect| {
            let fitted = effect.values().map(|(name, value)| {
                let std = deviations.as_ref().map_or(f64::NAN, |all| all[next]);
                next += 1;
                (name, Fitted::new(value, std))
            });
            (effect.clone(), fitted.collect())
        })
        .collect()
}
