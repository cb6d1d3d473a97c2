//! By how much a prediction misses a recording, channel by channel, and by how much any would.

use super::model::LegsCase;
use crate::calibrate::measured::replica;
use crate::calibrate::sensed::thresholds::ERROR_CORNER;
use crate::measure::filter::ZeroPhase;
use crate::measure::log::{Channel, Log};
use rayon::prelude::*;
use serde::Serialize;

/// What is left out at both ends of a log in s, as agreed on with whoever reads the errors.
const TRIM: f64 = 0.06;

/// Draws of noise that a floor is taken from: one of each replica that a prediction is the mean of.
const DRAWS: u64 = 2 * crate::calibrate::measured::rattle::REPLICAS as u64;

/// Errors of one channel of one run.
#[derive(Clone, Debug, Serialize)]
pub struct ChannelError {
    /// File of the run.
    pub run: String,
    /// `calibration` or `validation`.
    pub role: &'static str,
    /// Column.
    pub channel: String,
    /// Unit of the following.
    pub unit: &'static str,
    /// Root mean square of log less prediction of the declared model.
    pub before: f64,
    /// The same of the calibrated model.
    pub after: f64,
    /// What sensor noise and the rattle's own unpredictability leave to any model.
    pub floor: f64,
}

/// The errors that a model is judged by: those on data not used for fits, where there are any.
pub fn judged(errors: &[ChannelError]) -> Vec<&ChannelError> {
    let held: Vec<&ChannelError> = errors.iter().filter(|e| e.role == "validation").collect();
    if held.is_empty() { errors.iter().collect() } else { held }
}

/// Share of its floor by which a column may be missed by more than before: what half the noise again makes of it.
const BY_CHANCE: f64 = 0.5;

/// Whether a calibrated model misses what it is judged by by more than the declared one: root mean square over all
/// columns, each in units of its floor, or any one of them by more than chance. Then it is not delivered.
pub fn is_worse(errors: &[ChannelError]) -> bool {
    let judged = judged(errors);
    if judged.iter().any(|error| error.after - error.before > BY_CHANCE * error.floor) {
        return true;
    }
    let sum = |of: fn(&ChannelError) -> f64| -> f64 {
        judged.iter().map(|error| (of(error) / error.floor).powi(2)).sum()
    };
    sum(|error| error.after) > sum(|error| error.before)
}

/// The largest error after calibration in units of its floor, on data not used for fits where there
/// are any, and whose it is.
pub fn worst(errors: &[ChannelError]) -> Option<&ChannelError> {
    let above = |error: &ChannelError| error.after / error.floor;
    judged(errors).into_iter().max_by(|a, b| above(a).total_cmp(&above(b)))
}

/// The mean of several noiseless logs: the best prediction of one whose rattle nobody knows.
pub fn ensemble(logs: &[Log]) -> Log {
    let first = &logs[0];
    let channels = first.channels().map(|channel| {
        let columns: Vec<&[f64]> = logs.iter().filter_map(|log| log.get(channel)).collect();
        let count = columns.len() as f64;
        let rows = 0..first.samples;
        (channel, rows.map(|i| columns.iter().map(|c| c[i]).sum::<f64>() / count).collect())
    });
    let channels = channels.collect();
    Log::new(&first.name, first.start, first.interval, channels)
}

/// Root mean square of the low-passed difference of two logs in a channel, ends left out.
pub fn rms(a: &Log, b: &Log, channel: Channel) -> Option<f64> {
    let difference: Vec<f64> =
        a.get(channel)?.iter().zip(b.get(channel)?).map(|(a, b)| a - b).collect();
    let filtered = ZeroPhase::butterworth(4, ERROR_CORNER, a.interval).apply(&difference);
    let trim = (TRIM / a.interval).round() as usize;
    let inner = filtered.get(trim..filtered.len().checked_sub(trim)?)?;
    let squares: f64 = inner.iter().map(|v| v * v).sum();
    (!inner.is_empty()).then(|| (squares / inner.len() as f64).sqrt())
}

/// What sensor noise and rattle leave in a channel to a perfect model: a replica with noise against
/// the mean of the others.
pub fn floor(case: &LegsCase, clean: &[Log], channel: Channel) -> Option<f64> {
    let squares: Option<Vec<f64>> = (0..DRAWS)
        .into_par_iter()
        .map(|draw| {
            let index = draw as usize % clean.len();
            let noisy = replica::with_noise(&clean[index], &case.simulator.sensors, 5000 + draw);
            let others: Vec<Log> = if clean.len() > 1 {
                let kept = clean.iter().enumerate().filter(|(i, _)| *i != index);
                kept.map(|(_, log)| log.clone()).collect()
            } else {
                clean.to_vec()
            };
            rms(&noisy, &ensemble(&others), channel).map(|rms| rms * rms)
        })
        .collect();
    squares.map(|squares| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

/// Errors of all measured channels of a run: `before` and `after` are noiseless logs of the declared
/// and of the calibrated model.
pub fn of_run(
    case: &LegsCase,
    log: &Log,
    role: &'static str,
    before: &[Log],
    after: &[Log],
) -> Vec<ChannelError> {
    let [before, predicted] = [before, after].map(ensemble);
    log.channels()
        .filter(|channel| !matches!(channel, Channel::Command(_)))
        .filter_map(|channel| {
            Some(ChannelError {
                run: log.name.clone(),
                role,
                channel: channel.to_string(),
                unit: channel.unit(),
                before: rms(log, &before, channel)?,
                after: rms(log, &predicted, channel)?,
                floor: floor(case, after, channel)?,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(role: &'static str, before: f64, after: f64, floor: f64) -> ChannelError {
        let (run, channel) = ("run.csv".to_owned(), "x".to_owned());
        ChannelError { run, role, channel, unit: "m", before, after, floor }
    }

    /// Columns count by their floors, and validation runs alone where there are any.
    #[test]
    fn a_model_is_worse_by_the_runs_that_judge_it() {
        let better = [error("validation", 5.0, 2.0, 1.0), error("validation", 10.0, 11.0, 10.0)];
        assert!(!is_worse(&better));
        let worse = [error("validation", 5.0, 4.0, 100.0), error("validation", 3.0, 36.0, 10.0)];
        assert!(is_worse(&worse));
        let fitted_only = [error("calibration", 9.0, 1.0, 1.0), error("validation", 1.0, 1.1, 1.0)];
        assert!(is_worse(&fitted_only));
        assert!(is_worse(&[error("calibration", 1.0, 1.1, 1.0)]));
        // What one column gains is no excuse for what another one loses.
        let one = [error("validation", 90.0, 9.0, 1.0), error("validation", 1.0, 8.0, 1.0)];
        assert!(is_worse(&one));
    }
}
