//! The whole way: from a rig and its logs to a verdict, a calibrated model and its errors.

use super::errors::{self, ChannelError};
use super::fit::{self, Fit};
use super::left::{Left, is_noise, left};
use super::model::{Case, Run, SearchError, Segment};
use super::search::{Found, Round, Way, search};
use super::settle::{Question, Settled};
use super::unnamed::{Described, describe};
use crate::effects::{Scan, Setting, UNNAMED};
use crate::measure::log::Log;
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// What a calibration comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Named effects bring the residual down to noise.
    Explained,
    /// The declared model does so by itself.
    NothingMissing,
    /// Something remains that no effect with a name explains.
    Unexplained,
}

/// A fitted value.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Name of the parameter.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub std: f64,
}

impl Estimate {
    /// The interval that holds the true value 95 times in 100.
    pub fn ci95(&self) -> [f64; 2] {
        [self.value - 1.96 * self.std, self.value + 1.96 * self.std]
    }
}

/// A calibration.
#[derive(Debug)]
pub struct Outcome {
    /// What it comes to.
    pub verdict: Verdict,
    /// The effects that were found, each with its estimates.
    pub effects: Vec<(Setting, Vec<Estimate>)>,
    /// What was described where nothing could be named.
    pub described: Option<Described>,
    /// What is left of the residuals under the declared and under the calibrated model.
    pub before: Vec<Left>,
    /// The same under the named effects alone.
    pub after: Vec<Left>,
    /// Round by round.
    pub rounds: Vec<Round>,
    /// Errors, run by run and channel by channel.
    pub errors: Vec<ChannelError>,
    /// What the calibrated model predicts, run by run.
    pub predictions: Vec<Log>,
    /// What the declared model predicts, run by run.
    pub declared: Vec<Log>,
    /// Simulations it took.
    pub simulations: usize,
}

/// Calibrates: fits on the first run, judges on the others; with one run alone, fits on its first half
/// and judges on the second.
///
/// # Errors
/// A rig that cannot be simulated.
pub fn calibrate(
    case: &Case,
    without: &[&str],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Outcome, SearchError> {
    let whole = |run: usize| Segment { run, rows: case.runs[run].rows() };
    let (on, hold) = match case.runs.len() {
        1 => {
            let rows = case.runs[0].rows();
            let middle = rows.start + rows.len() / 2;
            let [first, second] = [rows.start..middle, middle..rows.end];
            (vec![Segment { run: 0, rows: first }], vec![Segment { run: 0, rows: second }])
        }
        count => (vec![whole(0)], (1..count).map(whole).collect()),
    };
    let question = Question { on: &on, hold: &hold, without };
    let Found { best, declared, certain, mut simulations } = search(case, &question, tell)?;
    let before = left(case, &question, &declared);
    let after = left(case, &question, &best.model);
    let (verdict, described, Way { model: last, rounds, .. }) = if !is_noise(&after) {
        tell("describing what has no name");
        let bare = Way { model: declared, rounds: best.rounds.clone(), certain: true };
        let (way, described) = remaining(case, &question, bare, certain)?;
        (Verdict::Unexplained, described, way)
    } else if best.model.fit.effects.is_empty() {
        (Verdict::NothingMissing, None, best)
    } else {
        (Verdict::Explained, None, best)
    };
    let effects = last.fit.effects.iter().map(canonical).collect();
    let last = Settled { fit: Fit { effects, ..last.fit }, ..last };
    let estimates = estimates(&last);
    tell("predicting the runs");
    let declared = case.simulate(&[])?;
    let predicted = case.simulate(&last.fit.effects)?;
    simulations += declared.iter().chain(&predicted).map(Vec::len).sum::<usize>();
    let role = |run: usize| if run == 0 { "calibration" } else { "validation" };
    let errors = case.runs.iter().enumerate().flat_map(|(i, run): (usize, &Run)| {
        errors::of_run(case, &run.log, role(i), &declared[i], &predicted[i])
    });
    Ok(Outcome {
        verdict,
        effects: last.fit.effects.iter().cloned().zip(estimates).collect(),
        described,
        before,
        after,
        rounds,
        errors: errors.collect(),
        predictions: predicted.iter().map(|logs| errors::ensemble(logs)).collect(),
        declared: declared.iter().map(|logs| errors::ensemble(logs)).collect(),
        simulations,
    })
}

/// The same repeating effects in one of the many ways to write them: the first amplitude is not negative,
/// phases lie between 0 and a whole turn.
pub(super) fn canonical(effect: &Setting) -> Setting {
    let Some(Scan { over, phase, .. }) = effect.kind.scan else { return effect.clone() };
    let amplitude = |name: &str| name != over && name != phase;
    let first = effect.values().find(|(name, _)| amplitude(name));
    let turned = first.is_some_and(|(_, value)| value < 0.0);
    let value = |(name, value): (&str, f64)| match name {
        _ if name == phase => (value + if turned { PI } else { 0.0 }).rem_euclid(TAU),
        _ if amplitude(name) && turned => -value,
        _ => value,
    };
    effect.with(&effect.values().map(value).collect::<Vec<f64>>())
}

/// What is certain although something else remains, and a map of that: of all models whose effects are
/// certain, the declared one among them, the one that explains most together with its map.
fn remaining(
    case: &Case,
    question: &Question,
    declared: Way,
    mut certain: Vec<Way>,
) -> Result<(Way, Option<Described>), SearchError> {
    certain.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    certain.truncate(BASES);
    let mut best: Option<(Way, Option<Described>)> = None;
    for way in [declared].into_iter().chain(certain) {
        let described = if question.without.contains(&UNNAMED) {
            None
        } else {
            describe(case, question, &way.model, WORTH_A_MAP)?
        };
        let (described, model) = match described {
            Some((described, model)) => (Some(described), model),
            None => (None, way.model),
        };
        if best.as_ref().is_none_or(|(other, _)| model.misfit < other.model.misfit) {
            best = Some((Way { model, ..way }, described));
        }
    }
    // The declared model is always among them.
    best.ok_or_else(|| case.rig.problem("effect", "cannot be described", "other data").into())
}

/// Models with certain effects that are held against each other, each with a map.
const BASES: usize = 3;

/// Share of what stands above noise on held-out data that a map has to remove: less is chance.
const WORTH_A_MAP: f64 = 0.05;

/// Estimates of each effect's values: `(JᵀJ)⁻¹` in units of noise, wider where the fit's own residual
/// is larger than noise.
fn estimates(model: &Settled) -> Vec<Vec<Estimate>> {
    let count = fit::values(&model.fit.effects).len();
    let mean_square = model.fit.chi2 / (model.fit.white.len().saturating_sub(count).max(1)) as f64;
    let covariance = model.fit.jacobian.as_ref().filter(|_| count > 0).and_then(|jacobian| {
        let scale = jacobian.column_iter().map(|c| c.norm().max(1e-300)).collect::<Vec<_>>();
        let mut normal = jacobian.transpose() * jacobian;
        for r in 0..scale.len() {
            for c in 0..scale.len() {
                normal[(r, c)] /= scale[r] * scale[c];
            }
        }
        let inverse = normal.pseudo_inverse(1e-12).ok()?;
        Some(
            (0..scale.len())
                .map(|i| inverse[(i, i)].max(0.0).sqrt() / scale[i])
                .collect::<Vec<_>>(),
        )
    });
    let mut index = 0;
    let mut next = || {
        index += 1;
        let std = covariance.as_ref().and_then(|c| c.get(index - 1).copied());
        std.unwrap_or(f64::NAN) * mean_square.max(1.0).sqrt()
    };
    model
        .fit
        .effects
        .iter()
        .map(|effect| {
            effect.values().map(|(name, value)| Estimate { name, value, std: next() }).collect()
        })
        .collect()
}
