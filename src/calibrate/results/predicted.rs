//! What a prediction comes to, by whatever way.

use super::report::RattleReport;
use crate::calibrate::values::errors::ChannelError;
use crate::simulate::Provenance;
use serde::Serialize;
use std::path::PathBuf;

/// The JSON file by which a prediction is known.
pub const ERRORS_FILE: &str = "errors.json";

/// The predicted recording.
pub(in crate::calibrate) const PREDICTED_FILE: &str = "predicted.csv";

/// `errors.json`.
#[derive(Clone, Debug, Serialize)]
pub struct PredictionReport {
    /// Program, versions, model.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The log.
    pub run: String,
    /// Names of the model's effects.
    pub effects: Vec<String>,
    /// Errors by channel: `after` of the model, `before` of the model without its effects (null where it
    /// has none), `floor` null where the model declares no sensors.
    pub errors: Vec<ChannelError>,
    /// Whether the model rattles by more than its sensors see.
    pub rattle: RattleReport,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

/// A finished prediction and its report, of whichever method.
#[derive(Debug)]
pub struct Predicted<R = PredictionReport> {
    /// What it came to.
    pub prediction: R,
    /// The text of `errors.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}
