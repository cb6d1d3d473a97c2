//! What a declared drive stage lacks: terms of its force, one after another, as long as data that they
//! were not fitted to say so.

mod candidates;
mod judge;
mod reported;

use super::calibration::{Found, Ranked};
use crate::calibrate::result::CalibrateError;
use crate::calibrate::sensed::held::paired::Ratio;
use crate::identify::stage::{Recording, Samples, cascade, first_length, stage};
use crate::identify::{Missing, Recorded};
use crate::scenario::Scenario;
use crate::simulate::started;
use candidates::{Candidate, candidates, declared, terms_of};
use judge::{CERTAIN, Judge, WORTH, by_form, squares};
use reported::{LAG, found};
use std::sync::Arc;

/// What speaks against a rig beforehand.
pub(super) fn ready(rig: &Scenario) -> Vec<String> {
    let mut wrong = Vec::new();
    if cascade(rig).is_none() {
        let help =
            "write mode = \"sampled\": calibrate takes a drive stage by its sampled controller";
        wrong.push(rig.problem("drive.mode", "is not \"sampled\"", help).to_string());
    }
    for (i, effect) in rig.effects.iter().enumerate() {
        if terms_of(effect).is_none() {
            let help = "take it out, or use `freeplay predict`";
            let message =
                format!("\"{}\" is not what calibrate knows of a drive stage", effect.kind.name);
            wrong.push(rig.problem(&format!("effect.{i}.kind"), message, help).to_string());
        }
    }
    wrong
}

/// Searches for what the declared stage lacks.
///
/// # Errors
/// A recording that does not tell the terms apart.
pub(super) fn search(
    rig: &Scenario,
    runs: &[Recorded],
    without: &[&str],
    tell: &dyn Fn(&str),
) -> Result<Found, CalibrateError> {
    let unfit = || {
        let name = runs.first().map_or("", |run| run.path.as_str());
        let message = "mass and viscous friction cannot be told apart, or come out negative";
        let help = "does the stage move, and is it the one that the rig declares?";
        CalibrateError::Input(vec![format!("{name}: {message}; {help}")])
    };
    let cascade = cascade(rig).ok_or_else(unfit)?;
    let mut all = runs.iter().map(|run| Recording::of(run.log.clone(), cascade));
    let judge = Judge { data: all.next().ok_or_else(unfit)?, held: all.collect() };
    let mut terms = declared(rig);
    let mut left = judge.left(&terms).ok_or_else(unfit)?;
    let (mut ranking, mut added): (Vec<Ranked>, Vec<(&str, String)>) = (Vec::new(), Vec::new());
    for round in 1.. {
        tell(&format!("round {round}: looking for what is left"));
        let mut tried: Vec<(f64, Ratio, Candidate, Vec<f64>)> = Vec::new();
        for candidate in by_form(&judge, candidates(&terms, without)) {
            let Some(after) = judge.left(&candidate.terms) else { continue };
            let score = 1.0 - squares(&after) / squares(&left);
            tried.push((score, Ratio::of(&after, &left), candidate, after));
        }
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        let certain = |ratio: &Ratio| {
            let half = (ratio.ci95[1] / ratio.mean).ln();
            ratio.mean.ln() + CERTAIN * half < 0.0 && ratio.mean < 1.0 - WORTH
        };
        // The best, or one with fewer terms that is as good: an offset rather than two frictions.
        let best = tried.iter().position(|(score, ratio, ..)| *score > 0.0 && certain(ratio));
        let as_good = |i: &usize| {
            let (score, ratio, _, after) = &tried[*i];
            let behind = best.map(|best| Ratio::of(after, &tried[best].3));
            let near = behind.is_some_and(|b| b.ci95[0] <= 1.0 || b.mean < 1.0 + WORTH);
            *score > 0.0 && certain(ratio) && (near || best == Some(*i))
        };
        let taken = (0..tried.len()).filter(as_good).min_by_key(|i| tried[*i].2.terms.len());
        ranking.extend(tried.iter().enumerate().map(|(i, (score, ratio, candidate, _))| Ranked {
            kind: candidate.kind,
            joint: (candidate.kind != "air-drag").then_some("P1"),
            what: candidate.what.clone(),
            validation_score: score.clamp(0.0, 1.0),
            kept: taken == Some(i),
            round,
            ratio: ratio.mean,
            ratio_ci95: ratio.ci95,
        }));
        let Some(taken) = taken else { break };
        let (score, ratio, candidate, after) = tried.swap_remove(taken);
        let evidence = format!(
            "({}) removes {:.1} % of the variance of what was left on data that it was not fitted to; the \
             error of a stretch falls to {:.3} of itself (95 %: {:.3} to {:.3})",
            candidate.what,
            100.0 * score,
            ratio.mean,
            ratio.ci95[0],
            ratio.ci95[1]
        );
        added.push((candidate.kind, evidence));
        (terms, left) = (candidate.terms, after);
    }
    tell("simulating the closed loop without each");
    let dropped = judge.drop_idle(&mut terms, &declared(rig))?;
    added.retain(|(kind, _)| !dropped.contains(kind));
    for ranked in &mut ranking {
        ranked.kept &= !dropped.contains(&ranked.kind);
    }
    let model = judge.fit(judge.data.motion.rows(), &terms).ok_or_else(unfit)?;
    let mut found = found(rig, &judge, &model, ranking, added);
    // Numbers that are not certainly better than the declared ones stay as declared.
    let fitted = judge.simulated(|run| stage(&model, run))?;
    let as_declared = judge.simulated(|run| {
        let start = [first_length(&run.log), 0.0];
        started(rig, start, Arc::new(Samples::of(&run.log)))
            .map_err(|problem| Missing::Wrong(problem.to_string()))
    })?;
    let effects = found.added.iter().any(|name| name != LAG);
    if !effects && Ratio::of(&as_declared, &fitted).ci95[0] <= 1.0 {
        found.scenario = rig.clone();
        found.added.clear();
    }
    Ok(found)
}
