//! A drive stage along a recording: what a model predicts, and by how much it misses.

use super::charts;
use super::drawn;
use super::noise::floors;
use super::rows::{measured, predicted};
use super::simulated::along;
use crate::calibrate::errors::{ChannelError, rms};
use crate::calibrate::predict::{ERRORS_FILE, PREDICTED_FILE};
use crate::calibrate::result::{CalibrateError, publish, to_json};
use crate::calibrate::way::name;
use crate::identify::Recorded;
use crate::measure::log::Log;
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use crate::study::{Folder, PAGE_FILE, RunError, refused};
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant as Clock;

/// `errors.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Prediction {
    /// Which program made this of which model.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The recording.
    pub run: String,
    /// Names of the model's effects.
    pub effects: Vec<String>,
    /// Errors by channel: `after` of the model, `before` of the model without its effects (null where it
    /// has none).
    pub errors: Vec<ChannelError>,
    /// Columns of the recording that nothing asks for: in `predicted.csv` as they were.
    pub carried_columns: Vec<String>,
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

/// Errors of all measured channels of a recording under a declared model and one with more.
pub(super) fn errors(
    recorded: &Recorded,
    role: &'static str,
    [before, after]: [Option<&Log>; 2],
    floors: &[(crate::measure::log::Channel, f64)],
) -> Vec<ChannelError> {
    let log = &recorded.log;
    let of = |model: Option<&Log>, channel| model.and_then(|m| rms(log, m, channel));
    measured(log)
        .map(|channel| ChannelError {
            run: log.name.clone(),
            role,
            channel: channel.to_string(),
            unit: channel.unit(),
            before: of(before, channel).unwrap_or(f64::NAN),
            after: of(after, channel).unwrap_or(f64::NAN),
            floor: floors.iter().find(|(c, _)| *c == channel).map_or(f64::NAN, |(_, floor)| *floor),
        })
        .collect()
}

/// Drives a model along a recording and writes what it predicts into `folder`. `tell` hears what is being
/// done.
///
/// # Errors
/// A model that cannot be simulated, files that cannot be written.
pub fn predict(
    model: &Scenario,
    recorded: &Recorded,
    folder: Folder,
    tell: &dyn Fn(&str),
) -> Result<Predicted, CalibrateError> {
    let started = Clock::now();
    let log = &recorded.log;
    tell("predicting the run");
    let after = along(model, log)?;
    let before = if model.effects.is_empty() {
        None
    } else {
        let mut declared = model.clone();
        declared.effects.clear();
        Some(along(&declared, log)?)
    };
    tell("what noise leaves to any model");
    let floors = floors(model, log, &after);
    let errors = errors(recorded, "prediction", [before.as_ref(), Some(&after)], &floors);
    tell("drawing and writing");
    let without = before.as_ref().map(|before| ("without effects", before));
    let pictures = charts::of_run(log, "prediction", without, ("predicted", &after))
        .map_err(RunError::from)?;
    let texts = [ERRORS_FILE, PREDICTED_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let prediction = Prediction {
        provenance: Provenance::of(model),
        run: log.name.clone(),
        effects: model.effects.iter().map(name).collect(),
        errors,
        carried_columns: recorded.others.clone(),
        wall_s: started.elapsed().as_secs_f64(),
        files: texts.chain(pictures.iter().map(|picture| picture.file.clone())).collect(),
    };
    let json = to_json(&prediction);
    let rows = predicted(recorded, &after).map_err(refused(PREDICTED_FILE))?;
    let page = drawn::prediction(&prediction, &pictures);
    let texts = [(ERRORS_FILE, &json), (PREDICTED_FILE, &rows), (PAGE_FILE, &page)];
    let folder = publish(folder, &texts, &pictures)?;
    Ok(Predicted { prediction, json, folder })
}
