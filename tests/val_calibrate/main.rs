//! What must hold of any good calibration of a 3-RPR, by its sensors, as any machine is calibrated: on the recordings in
//! `assets/rigs`, an independent simulator's, whose hidden effects are written nowhere in this repository, and on recordings
//! with effects that are known.
//!
//! Slow: a calibration takes up to two minutes. Most of those with known effects are ignored unless asked for
//! (`cargo test --release --test val_calibrate -- --ignored`).

#[path = "../cli_common/mod.rs"]
mod cli_common;
mod hidden;
mod rigs;

use serde_json::Value;

/// The largest error on recordings that were not fitted to, in floors, and whose it is.
fn worst(report: &Value) -> (f64, &str) {
    let errors = report["errors"].as_array().unwrap();
    let judged = errors.iter().filter(|error| error["role"] == "validation");
    let ratio = |e: &Value| e["after"].as_f64().unwrap() / e["floor"].as_f64().unwrap();
    judged
        .map(|error| (ratio(error), error["channel"].as_str().unwrap()))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap()
}
