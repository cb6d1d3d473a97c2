//! What files of recorded runs have in common: columns, a constant rate, and what may be wrong with them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where a quantity stands in somebody's file, and how it gets the unit of its channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnSource {
    /// Head of the column.
    pub column: String,
    /// What its numbers are multiplied by: 1 where they are in SI units.
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

impl ColumnSource {
    /// A column whose numbers are multiplied by `scale`.
    pub fn new(column: &str, scale: f64) -> Self {
        Self { column: column.to_owned(), scale }
    }
}

/// What is wrong with a log: where, what, and what would be right.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {message}; {help}")]
pub struct LogError {
    /// File, and line where there is one.
    pub place: String,
    /// What was found.
    pub message: String,
    /// What would be right.
    pub help: String,
}

/// Deviation of a time step from the first, as a share of it, that is rounding in the file.
const JITTER: f64 = 0.05;

/// Most columns of a log, and most bytes of their heads: what has more was never a header.
const WIDEST: [usize; 2] = [1000, 65_536];

/// What is wrong with a header that is none, and what would be right.
pub(crate) fn no_header(heads: &csv::StringRecord) -> Option<(String, String)> {
    let [columns, bytes] = WIDEST;
    (heads.len() > columns || heads.as_slice().len() > bytes).then(|| {
        let message = format!(
            "the header has {} columns in {} characters",
            heads.len(),
            heads.as_slice().chars().count()
        );
        (message, format!("expected at most {columns} columns in {bytes} characters"))
    })
}

/// The step of a time column, or the first row that breaks it and how.
pub(crate) fn constant_step(times: &[f64]) -> Result<f64, (usize, String)> {
    let [first, .., last] = times else {
        return Err((0, format!("the log has {} row(s)", times.len())));
    };
    let mean = (last - first) / (times.len() - 1) as f64;
    // The middle step stands for all: a gap would spoil the mean.
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    for (i, pair) in times.windows(2).enumerate() {
        let [before, now] = [pair[0], pair[1]];
        if now == before {
            return Err((i + 1, format!("t = {now} s is repeated")));
        }
        if now < before {
            return Err((i + 1, format!("time runs backwards, from {before} to {now} s")));
        }
    }
    steps.sort_by(f64::total_cmp);
    let step = steps[steps.len() / 2];
    for (i, pair) in times.windows(2).enumerate() {
        if ((pair[1] - pair[0]) / step - 1.0).abs() > JITTER {
            let message = format!(
                "a step of {:.6} s from t = {} s, where others are {step:.6} s",
                pair[1] - pair[0],
                pair[0]
            );
            return Err((i + 1, message));
        }
    }
    Ok(mean)
}
