//! What reports say of windows: by how much predictions miss over each horizon.

use super::score::Horizon;
use crate::calibrate::values::errors::ChannelError;
use serde::Serialize;

/// What a report says of windows.
#[derive(Clone, Debug, Serialize)]
pub struct Windows {
    /// What the errors are.
    pub note: &'static str,
    /// Lengths in s of the windows that values were fitted to.
    pub fitted_s: Vec<f64>,
    /// Errors by horizons.
    pub horizons: Vec<HorizonErrors>,
    /// Zeros that belong to runs, found in their first seconds.
    pub run_zeros: Vec<RunZero>,
    /// What drives gave, by column.
    pub inputs: Vec<String>,
    /// What is to be known of recordings.
    pub remarks: Vec<String>,
    /// Effects that were fitted and are not certain.
    pub left_out: Vec<String>,
}

/// Errors of one run over windows of one length.
#[derive(Clone, Debug, Serialize)]
pub struct HorizonErrors {
    /// File of the run.
    pub run: String,
    /// `calibration`, `validation` or `prediction`.
    pub role: &'static str,
    /// The windows.
    #[serde(flatten)]
    pub horizon: Horizon,
    /// How many were predicted.
    pub windows: usize,
    /// By column.
    pub errors: Vec<ChannelError>,
}

/// The zero of a sensor in a run.
#[derive(Clone, Debug, Serialize)]
pub struct RunZero {
    /// File of the run.
    pub run: String,
    /// Column.
    pub sensor: String,
    /// What it shows beside what the model says, in its unit.
    pub offset: f64,
    /// Standard deviation.
    pub std: f64,
}
