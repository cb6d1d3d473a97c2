//! The trials of `calibrate --self-test`, one by one, as rows of its table.

use crate::error::Failure;
use crate::work::detached;
use freeplay::calibrate::sensed::self_test::{TriedTrial, rates, run, trials};
use pyo3::prelude::*;
use std::sync::atomic::AtomicBool;

/// The trials that a seed draws, as JSON each.
#[pyfunction]
fn self_test_trials(
    seed: u64,
    count: usize,
    machines: Vec<String>,
    hidden: Vec<String>,
) -> Vec<(u64, String)> {
    let all = trials(seed, count, &machines, &hidden).into_iter();
    all.map(|trial| (trial.seed, serde_json::to_string(&trial).unwrap_or_default())).collect()
}

/// Hides, calibrates, judges: the row of a trial, as JSON.
#[pyfunction]
fn self_test_trial(py: Python<'_>, trial: &str, version: &str) -> PyResult<String> {
    detached(py, &AtomicBool::new(false), || {
        let trial = serde_json::from_str(trial);
        let trial = trial.map_err(|error| Failure::Input(format!("trial: {error}")))?;
        Ok(serde_json::to_string(&run(&trial, version, &|_| {})).unwrap_or_default())
    })
}

/// What all rows come to, in words.
#[pyfunction]
fn self_test_rates(py: Python<'_>, rows: Vec<String>) -> PyResult<String> {
    let rows: Result<Vec<TriedTrial>, _> =
        rows.iter().map(|row| serde_json::from_str(row)).collect();
    let rows = rows.map_err(|error| Failure::Input(format!("rows: {error}")).exception(py))?;
    Ok(rates(&rows))
}

pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(self_test_trials, module)?)?;
    module.add_function(wrap_pyfunction!(self_test_trial, module)?)?;
    module.add_function(wrap_pyfunction!(self_test_rates, module)?)
}
