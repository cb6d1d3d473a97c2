//! By how much predictions miss recordings, column by column, and by how much any would.

use serde::Serialize;

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
