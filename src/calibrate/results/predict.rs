//! A model driven by a recorded log's commands: what it predicts, and by how much it misses.

use super::charts;
use super::predict_page;
use super::predicted::PREDICTED_FILE;
pub use super::predicted::{ERRORS_FILE, Predicted, PredictionReport};
use super::report::RattleReport;
use super::result::{CalibrateError, control, refuse, sensors, to_json};
use crate::calibrate::LoggedCommands;
use crate::calibrate::measured::rattle::{self, Rattle};
use crate::calibrate::measured::recording::LegsRecording;
use crate::calibrate::measured::start::as_seen;
use crate::calibrate::plausibility;
use crate::calibrate::values::errors;
use crate::calibrate::values::model::{LegsCase, released};
use crate::engine::Halt;
use crate::measure::log::{Channel, Log};
use crate::mechanism::Mechanism;
use crate::report::{Picture, Style};
use crate::results::{Folder, PAGE_FILE, RunError, refused};
use crate::scenario::{self, Law, Problem, Scenario};
use crate::simulate::Provenance;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::fs;
use std::sync::Arc;
use std::time::Instant as Clock;

/// Whether a model says that instruments are wrong: then its sensors are asked, one by one, what they show.
pub fn reads_by_instruments(model: &Scenario) -> bool {
    model.effects.iter().any(|effect| effect.kind.is_instrument())
}

/// Makes sure that a model can be driven by a log.
///
/// # Errors
/// Everything that is wrong with them.
pub fn check(model: &Scenario, recording: &LegsRecording) -> Result<(), CalibrateError> {
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

/// Drives a model by a log's commands and writes what it predicts into `folder`. `tell` hears what is
/// being done.
///
/// # Errors
/// A model that cannot be simulated, forces in a wrong unit, files that cannot be written.
pub fn into_folder(
    model: &Scenario,
    recording: &LegsRecording,
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Predicted, CalibrateError> {
    let started = Clock::now();
    let log = complete(model, &recording.log);
    // What errors are counted against is the model's instruments alone.
    let case = LegsCase::new(model.clone(), sensors(model), Vec::new(), control(model));
    let machine = machine(model, &log)?;
    tell("simulating two replicas: does it rattle?");
    let rattle = rattle::look(&case.simulator, &machine, &log)?;
    refuse(plausibility::forces(&recording.path, &recording.log, &rattle.logs[0], &model.drive))?;
    tell("predicting the run");
    let simulate = |machine| simulated(&case, machine, recording, &log, &rattle);
    let after = simulate(machine)?;
    let before = if model.effects.is_empty() {
        None
    } else {
        let mut declared = model.clone();
        declared.effects.clear();
        Some(simulate(self::machine(&declared, &log)?)?)
    };
    let reference = before.as_deref().unwrap_or(&after);
    let mut errors = errors::of_run(&case, &recording.log, "prediction", reference, &after);
    for error in &mut errors {
        if before.is_none() {
            error.before = f64::NAN;
        }
        if model.sensors.is_none() {
            error.floor = f64::NAN;
        }
    }
    tell("drawing and writing");
    let predicted = errors::ensemble(&after).arranged(recording.log.channels());
    let declared = before.as_deref().map(errors::ensemble);
    let mut models = Vec::new();
    if let Some(declared) = &declared {
        models.push(("without effects", declared, Style::Reference));
    }
    models.push(("predicted", &predicted, Style::Solid));
    let pictures = charts::of_run(&recording.log, "prediction", &models).map_err(RunError::from)?;
    let texts = [ERRORS_FILE, PREDICTED_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let prediction = PredictionReport {
        provenance: Provenance::of(model),
        run: recording.log.name.clone(),
        effects: model.effects.iter().map(crate::calibrate::rounds::way::name).collect(),
        errors,
        rattle: RattleReport {
            chaotic: rattle.chaotic,
            difference: rattle.difference,
            channel: rattle.channel.to_string(),
            replicas: rattle.replicas,
        },
        wall_s: started.elapsed().as_secs_f64(),
        files: texts.chain(pictures.iter().map(|picture| picture.file.clone())).collect(),
    };
    written(prediction, &predicted, &pictures, folder)
}

/// Replicas of a machine that a log's commands drive; where joints stay loaded, started as it was seen.
fn simulated(
    case: &LegsCase,
    mut machine: Mechanism,
    recording: &LegsRecording,
    log: &Log,
    rattle: &Rattle,
) -> Result<Vec<Log>, Halt> {
    if !rattle.chaotic {
        machine = as_seen(&case.simulator, machine, &recording.log, None, false)?.machine;
    }
    let replicas = (0..rattle.replicas as u64).into_par_iter();
    replicas.map(|r| case.simulator.record(&machine, log, r)).collect()
}

fn written(
    prediction: PredictionReport,
    predicted: &Log,
    pictures: &[Picture],
    folder: Folder,
) -> Result<Predicted, CalibrateError> {
    let json = to_json(&prediction);
    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    write(ERRORS_FILE, &json)?;
    write(PREDICTED_FILE, &predicted.to_csv())?;
    for picture in pictures {
        write(&picture.file, &picture.svg)?;
    }
    write(PAGE_FILE, &predict_page::page(&prediction, pictures))?;
    let folder = folder.finish().map_err(RunError::from)?;
    Ok(Predicted { prediction, json, folder })
}

/// The log with every column that a simulation fills; those that were not measured hold its start.
fn complete(model: &Scenario, log: &Log) -> Log {
    let start = plausibility::start_pose(model);
    let mut channels: Vec<(Channel, Vec<f64>)> = log
        .channels()
        .map(|channel| (channel, log.get(channel).unwrap_or_default().to_vec()))
        .collect();
    for channel in Channel::all(3) {
        let value = match channel {
            Channel::Pose(k) => start[k],
            Channel::Command(_) | Channel::Length(_) | Channel::Force(_) => 0.0,
        };
        if log.get(channel).is_none() {
            channels.push((channel, vec![value; log.samples]));
        }
    }
    Log::new(&log.name, log.start, log.interval, channels)
}

/// The model at rest at the log's first commands, journals centred, held there before the log begins.
fn machine(model: &Scenario, log: &Log) -> Result<Mechanism, Problem> {
    let commands = LoggedCommands::new(log, 3).map_err(|channel| {
        model.problem("motion", format!("the log has no column `{channel}`"), "add it")
    })?;
    let first = |k| log.get(Channel::Pose(k)).map_or(0.0, |values| values[0]);
    let pose = Vector3::new(first(0), first(1), first(2));
    released(model, pose, &Arc::new(commands), &model.effects)
}
