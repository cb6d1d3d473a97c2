//! The whole way: from a rig and its logs to a verdict, a calibrated model and its errors.

use crate::calibrate::rounds::left::{LegsLeft, is_noise, left};
use crate::calibrate::rounds::search::{LegsFound, search};
use crate::calibrate::rounds::unnamed::describe;
use crate::calibrate::rounds::way::{LegsRound, Way};
use crate::calibrate::sensed::unnamed::DescribedEfforts;
use crate::calibrate::values::errors::{self, ChannelError};
use crate::calibrate::values::fit::LegsFit;
use crate::calibrate::values::least_squares::values;
use crate::calibrate::values::model::{LegsCase, LegsRun, LegsSegment, SearchError};
use crate::calibrate::values::normal::{inverse_normal, pull};
use crate::calibrate::values::settle::{FitData, Settled};
use crate::effects::{Scan, Setting, UNNAMED};
use crate::measure::log::Log;
use crate::measure::student::NORMAL95;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Simulations that a calibration takes at most ([`LegsCase::simulated`]): what two slow cores do in two minutes, at
/// 0.6 s for a run of three seconds each.
pub const MOST: f64 = 400.0;

/// What a calibration comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Named effects bring the residual down to noise.
    Explained,
    /// The declared model does so by itself.
    NothingMissing,
    /// Something remains that no effect with a name explains.
    Unexplained,
}

impl Verdict {
    /// As reports spell it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Explained => "explained",
            Self::NothingMissing => "nothing-missing",
            Self::Unexplained => "unexplained",
        }
    }
}

/// A fitted value.
#[derive(Clone, Debug)]
pub struct ValueEstimate {
    /// Name of the parameter.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub std: f64,
}

impl ValueEstimate {
    /// The interval that holds the true value 95 times in 100.
    pub fn ci95(&self) -> [f64; 2] {
        [self.value - NORMAL95 * self.std, self.value + NORMAL95 * self.std]
    }
}

/// A calibration.
#[derive(Debug)]
pub struct LegsOutcome {
    /// What it comes to.
    pub verdict: Verdict,
    /// The effects that were found, each with its estimates.
    pub effects: Vec<(Setting, Vec<ValueEstimate>)>,
    /// What was described where nothing could be named.
    pub described: Option<DescribedEfforts>,
    /// What is left of the residuals under the declared and under the calibrated model.
    pub before: Vec<LegsLeft>,
    /// The same under the named effects alone.
    pub after: Vec<LegsLeft>,
    /// Round by round.
    pub rounds: Vec<LegsRound>,
    /// Errors, run by run and channel by channel.
    pub errors: Vec<ChannelError>,
    /// What the calibrated model predicts, run by run.
    pub predictions: Vec<Log>,
    /// What the declared model predicts, run by run.
    pub declared: Vec<Log>,
    /// Simulations that it took, in runs like the recorded ones ([`LegsCase::simulated`]).
    pub simulations: usize,
}

/// Calibrates: fits on the first run, judges on the others; with one run alone, fits on its first half
/// and judges on the second.
///
/// # Errors
/// A rig that cannot be simulated.
pub fn calibrate(
    case: &LegsCase,
    without: &[&str],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<LegsOutcome, SearchError> {
    let whole = |run: usize| LegsSegment { run, rows: case.runs[run].rows() };
    let (on, hold) = match case.runs.len() {
        1 => {
            let rows = case.runs[0].rows();
            let middle = rows.start + rows.len() / 2;
            let [first, second] = [rows.start..middle, middle..rows.end];
            (vec![LegsSegment { run: 0, rows: first }], vec![LegsSegment { run: 0, rows: second }])
        }
        count => (vec![whole(0)], (1..count).map(whole).collect()),
    };
    let question = FitData { on: &on, hold: &hold, without };
    let simulated = case.simulated();
    let LegsFound { best, declared, certain } = search(case, &question, tell)?;
    let before = left(case, &question, &declared);
    let after = left(case, &question, &best.model);
    let noise = if is_noise(&after) {
        tell("predicting the runs");
        Some(predicted(case, &declared, &best.model)?)
    } else {
        None
    };
    let explained = noise.filter(|prediction| best.model.baseline.rattles || prediction.met());
    let (verdict, described, Way { model: last, rounds, .. }, prediction) = match explained {
        Some(prediction) if best.model.fit.effects.is_empty() => {
            (Verdict::NothingMissing, None, best, prediction)
        }
        Some(prediction) => (Verdict::Explained, None, best, prediction),
        None => {
            tell("describing what has no name");
            let bare = Way { model: declared.clone(), rounds: best.rounds.clone(), certain: true };
            let (way, described) = remaining(case, &question, bare, certain)?;
            tell("predicting the runs");
            let prediction = predicted(case, &declared, &way.model)?;
            if errors::is_worse(&prediction.errors) {
                let rounds = best.rounds.clone();
                let bare = Way { model: declared.clone(), rounds, certain: true };
                let prediction = predicted(case, &declared, &declared)?;
                (Verdict::Unexplained, None, bare, prediction)
            } else {
                (Verdict::Unexplained, described, way, prediction)
            }
        }
    };
    let effects = last.fit.effects.iter().map(canonical).collect();
    let last = Settled { fit: LegsFit { effects, ..last.fit }, ..last };
    let estimates = estimates(&last, &on);
    let TwoPredictions { declared, predicted, errors } = prediction;
    Ok(LegsOutcome {
        verdict,
        effects: last.fit.effects.iter().cloned().zip(estimates).collect(),
        described,
        before,
        after,
        rounds,
        errors,
        predictions: predicted.iter().map(|logs| errors::ensemble(logs)).collect(),
        declared: declared.iter().map(|logs| errors::ensemble(logs)).collect(),
        simulations: (case.simulated() - simulated).round() as usize,
    })
}

/// What two models predict, and by how much they miss.
struct TwoPredictions {
    /// Of the declared model, `[run][replica]`.
    declared: Vec<Vec<Log>>,
    /// The same of the calibrated one.
    predicted: Vec<Vec<Log>>,
    errors: Vec<ChannelError>,
}

/// Errors in floors up to which the prediction of a model whose joints stay loaded may be one of a complete
/// model: of some fifty trials that were right the worst was 1.31. A lens sees no swing: an effect that passes for
/// another there gives the platform another swing, and missed recordings by 3.3 floors.
pub const MET: f64 = 2.0;

impl TwoPredictions {
    /// Whether the calibrated model meets the runs that it is judged by.
    fn met(&self) -> bool {
        errors::judged(&self.errors).iter().all(|error| error.after < MET * error.floor)
    }
}

/// What models predict of all runs.
fn predicted(
    case: &LegsCase,
    declared: &Settled,
    model: &Settled,
) -> Result<TwoPredictions, SearchError> {
    let effects: Vec<Setting> = model.fit.effects.iter().map(canonical).collect();
    let predicted = case.predictions(&effects, &model.baseline)?;
    let declared =
        if effects.is_empty() { predicted.clone() } else { declared.baseline.logs.to_vec() };
    let role = |run: usize| if run == 0 { "calibration" } else { "validation" };
    let errors = case.runs.iter().enumerate().flat_map(|(i, run): (usize, &LegsRun)| {
        errors::of_run(case, &run.log, role(i), &declared[i], &predicted[i])
    });
    let errors = errors.collect();
    Ok(TwoPredictions { declared, predicted, errors })
}

/// The same repeating effects in one of the many ways to write them: the first amplitude is not negative,
/// phases lie between 0 and a whole turn.
pub(in crate::calibrate) fn canonical(effect: &Setting) -> Setting {
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
    case: &LegsCase,
    question: &FitData,
    declared: Way,
    mut certain: Vec<Way>,
) -> Result<(Way, Option<DescribedEfforts>), SearchError> {
    certain.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    certain.truncate(BASES);
    let mut best: Option<(Way, Option<DescribedEfforts>)> = None;
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
/// is larger than noise, and where rattle pulls the values further than noise of one frequency by itself.
fn estimates(model: &Settled, on: &[LegsSegment]) -> Vec<Vec<ValueEstimate>> {
    let count = values(&model.fit.effects).len();
    let mean_square = model.fit.chi2 / (model.fit.white.len().saturating_sub(count).max(1)) as f64;
    let jacobian = model.fit.jacobian.as_ref().filter(|_| count > 0);
    let inverse = jacobian.and_then(inverse_normal);
    // Whole simulations are fitted sample by sample, where there is next to no rattle.
    let through_the_lens = |jacobian: &&DMatrix<f64>, draws: &[DVector<f64>]| {
        model.baseline.rattles && draws[0].len() == jacobian.nrows()
    };
    let draws = model.baseline.draws(on);
    let pull = match (jacobian.filter(|j| through_the_lens(j, &draws)), &inverse) {
        (Some(jacobian), Some(inverse)) => pull(jacobian, inverse, &draws),
        _ => 1.0,
    };
    let factor = mean_square.max(pull).max(1.0).sqrt();
    let deviation = |i: usize| inverse.as_ref().map(|inverse| inverse[(i, i)].max(0.0).sqrt());
    let mut index = 0;
    let mut next = || {
        index += 1;
        deviation(index - 1).unwrap_or(f64::NAN) * factor
    };
    model
        .fit
        .effects
        .iter()
        .map(|effect| {
            effect
                .values()
                .map(|(name, value)| ValueEstimate { name, value, std: next() })
                .collect()
        })
        .collect()
}
