//! A model of any mechanism that drives hold or joints keep, driven by a recording's commands: what it predicts, and by
//! how much it misses.

use super::charts::{DrawnRun, of_run};
use crate::calibrate::results::predict_page;
use crate::calibrate::results::predicted::{
    ERRORS_FILE, PREDICTED_FILE, Predicted, PredictionReport,
};
use crate::calibrate::results::report::RattleReport;
use crate::calibrate::results::result::{CalibrateError, control, publish, refuse, to_json};
use crate::calibrate::sensed::held;
use crate::calibrate::sensed::intake::followed;
use crate::calibrate::sensed::intake::noise;
use crate::calibrate::sensed::intake::prepare::{native, without_sensors};
use crate::calibrate::sensed::motion::released::released;
use crate::calibrate::sensed::motion::simulate::{apart, record};
use crate::calibrate::sensed::motion::start::StartError;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::thresholds::ERROR_CORNER;
use crate::calibrate::sensed::thresholds::{PREDICTING, SEEN};
use crate::calibrate::sensed::values::errors::{self, mean};
use crate::engine::StepControl;
use crate::mechanism::{Bearing, Mechanism};
use crate::report::Style;
use crate::results::{Folder, PAGE_FILE, RunError};
use crate::scenario::{Scenario, Sensors};
use crate::simulate::Provenance;
use rayon::prelude::*;
use std::path::Path;
use std::time::Instant as Clock;

const CAPTION: &str =
    "Predicted: the model. Without effects: the same model without its [[effect]]s.";

/// A model and a recording that nothing speaks against.
#[derive(Debug)]
pub struct PreparedPrediction {
    provenance: Provenance,
    model: Scenario,
    machine: Mechanism,
    recording: Recording,
}

impl PreparedPrediction {
    /// What is to be known of the recording: late rows, columns that nobody asks for.
    pub fn remarks(&self) -> Vec<String> {
        self.recording.remarks()
    }
}

/// Reads a recording of a described machine.
///
/// # Errors
/// What is wrong with the model or the recording.
pub fn prepare(model: &Scenario, path: &Path) -> Result<PreparedPrediction, CalibrateError> {
    let provenance = Provenance::of(model);
    let mut model = model.clone();
    // A template's columns are known without its instruments' noise.
    if model.sensors.is_none() && model.mechanism.uses("sensors") {
        model.sensors = Some(Sensors::default());
    }
    let mut machine = crate::model::parts_of(&model)?;
    let unknown = machine.sensors.is_empty().then(|| without_sensors(&model).to_string());
    refuse(unknown.into_iter().chain(native(&model, "predict")).collect())?;
    let recording = Recording::read_with_time(path, &machine.sensors, false, model.time_column());
    let recording = recording.map_err(|error| CalibrateError::Input(vec![error.to_string()]))?;
    let columns = model.columns.as_ref();
    let lacking = columns.and_then(|named| recording.lacks(&machine.sensors, named));
    refuse(lacking.into_iter().collect())?;
    refuse(held::plausible::wrong(&model, &machine, &recording))?;
    refuse(recording.too_slow("predict", errors::LOWEST_RATE, ERROR_CORNER).into_iter().collect())?;
    refuse(followed::wrong(&model, &machine, &recording))?;
    noise::measured(&mut machine.sensors, &recording);
    crate::calibrate::sensed::motion::start::machine(&model, &[], &recording)?;
    Ok(PreparedPrediction { provenance, model, machine, recording })
}

impl From<StartError> for CalibrateError {
    fn from(error: StartError) -> Self {
        crate::calibrate::sensed::residuals::problem::Stopped::from(error).into()
    }
}

/// Predicts and writes everything about it into `folder`. `tell` hears what is being done.
///
/// # Errors
/// A model that cannot be simulated, files that cannot be written.
pub fn into_folder(
    prepared: &PreparedPrediction,
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Predicted, CalibrateError> {
    let started = Clock::now();
    let PreparedPrediction { provenance, model, machine, recording } = prepared;
    tell("simulating two replicas: does it rattle?");
    let along = Along { model, recording, like: &complete(machine, recording) };
    let (after, difference) = along.predicted(machine)?;
    refuse(followed::unlike(model, machine, recording, &after))?;
    let before = match model.effects.is_empty() {
        true => None,
        false => {
            tell("predicting without effects");
            let mut plain = model.clone();
            plain.effects.clear();
            Some(Along { model: &plain, ..along }.predicted(machine)?.0)
        }
    };
    let reference = before.as_deref().unwrap_or(&after);
    let mut errors = errors::of_run(machine, recording, "prediction", reference, &after);
    if before.is_none() {
        errors.iter_mut().for_each(|error| error.before = f64::NAN);
    }
    tell("drawing and writing");
    let sensors = &machine.sensors;
    let predicted = mean(&after, sensors.len());
    let plain = before.as_deref().map(|logs| mean(logs, sensors.len()));
    let mut models = Vec::new();
    models.extend(plain.as_ref().map(|plain| ("without effects", Style::Reference, plain)));
    models.push(("predicted", Style::Solid, &predicted));
    let drawn = DrawnRun { index: 0, role: "prediction", caption: CAPTION };
    let pictures = of_run(machine, recording, drawn, &models).map_err(RunError::from)?;
    let texts = [ERRORS_FILE, PREDICTED_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let prediction = PredictionReport {
        provenance: provenance.clone(),
        run: recording.name.clone(),
        effects: model.effects.iter().map(ToString::to_string).collect(),
        errors,
        rattle: RattleReport { chaotic: after.len() > 1, difference, replicas: after.len() },
        wall_s: started.elapsed().as_secs_f64(),
        files: texts.chain(pictures.iter().map(|picture| picture.file.clone())).collect(),
    };
    let (json, rows) = (to_json(&prediction), predicted.to_csv(sensors));
    let page = predict_page::page(&prediction, &pictures);
    let texts = [(ERRORS_FILE, &json), (PREDICTED_FILE, &rows), (PAGE_FILE, &page)];
    let folder = publish(folder, &texts, &pictures)?;
    Ok(Predicted { prediction, json, folder })
}

/// The recording with a column for every sensor that measures; those that were not measured hold zeros.
fn complete(machine: &Mechanism, recording: &Recording) -> Recording {
    let column = |i: usize| {
        let known = recording.get(i).map(<[f64]>::to_vec);
        let unknown = || (!machine.sensors[i].tells()).then(|| vec![0.0; recording.samples]);
        known.or_else(unknown)
    };
    recording.with((0..machine.sensors.len()).map(column).collect())
}

/// Whether a machine can do otherwise from a start a hair away: what holds it has play somewhere.
fn may_rattle(machine: &Mechanism) -> bool {
    let ideal = machine.revolutes.iter().all(|joint| matches!(joint.bearing, Bearing::Ideal));
    !ideal || machine.actuators.iter().any(|drive| drive.transmission.is_some())
}

/// A model along a recording.
#[derive(Clone, Copy)]
pub(in crate::calibrate) struct Along<'a> {
    pub model: &'a Scenario,
    pub recording: &'a Recording,
    /// The same with all columns.
    pub like: &'a Recording,
}

impl Along<'_> {
    /// What the model predicts, replica by replica if it rattles, and by how much two of them differ in units of
    /// noise.
    pub fn predicted(&self, machine: &Mechanism) -> Result<(Vec<Recording>, f64), CalibrateError> {
        let Self { model, recording, like } = *self;
        let control: StepControl = control(model);
        let let_go = released(model, &[], recording, control)?;
        let released = &let_go.machine;
        let replicas = |from: &Mechanism, replicas: std::ops::Range<usize>| {
            let each = replicas.into_par_iter();
            each.map(|replica| record(from, control, like, replica as u64))
                .collect::<Result<Vec<Recording>, _>>()
        };
        if !may_rattle(released) {
            return Ok((replicas(released, 0..1)?, 0.0));
        }
        let mut logs = replicas(released, 0..2)?;
        let difference = apart(&machine.sensors, &logs[0], &logs[1]);
        if difference > SEEN {
            logs.extend(replicas(released, 2..PREDICTING)?);
            return Ok((logs, difference));
        }
        // How journals that do not lift off lean hangs on how they swing at first.
        let swinging = let_go.swinging_as(recording, control)?;
        logs = if swinging.at_rest.is_some() { replicas(&swinging.machine, 0..1)? } else { logs };
        logs.truncate(1);
        Ok((logs, difference))
    }
}
