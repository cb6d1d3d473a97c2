//! What a prediction comes to, and what keeps a 3-RPR's recording from being one.

use super::errors::ChannelError;
use super::plausibility;
use super::recording::Recording;
use super::report::RattleReport;
use super::result::{CalibrateError, refuse};
use crate::scenario::{self, Law, Scenario};
use crate::simulate::Provenance;
use serde::Serialize;
use std::path::PathBuf;

/// The JSON file by which a prediction is known.
pub const ERRORS_FILE: &str = "errors.json";

/// The predicted recording.
pub(super) const PREDICTED_FILE: &str = "predicted.csv";

/// `errors.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Prediction {
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

/// A finished prediction.
#[derive(Debug)]
pub struct Predicted {
    /// What it came to.
    pub prediction: Prediction,
    /// The text of `errors.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

/// Makes sure that a model can be driven by a log.
///
/// # Errors
/// Everything that is wrong with them.
pub fn check(model: &Scenario, recording: &Recording) -> Result<(), CalibrateError> {
    if !matches!(model.mechanism, scenario::Mechanism::ThreeRpr(_)) {
        return refuse(vec![plausibility::without_sensors(model).to_string()]);
    }
    let mut found: Vec<String> = plausibility::recording(model, recording, plausibility::PREDICT)
        .iter()
        .map(ToString::to_string)
        .collect();
    if model.contact.law == Law::Native {
        let help = "write law = \"hertz-step\": predict needs a contact law whose error is known";
        found.push(model.problem("contact.law", "is \"native\"", help).to_string());
    }
    refuse(found)
}
