//! A calibration and its folder of results.

use super::outcome::calibrate;
use super::report::{LegsReport, Sources, calibrated};
use super::{charts, page};
use crate::calibrate::measured::rattle::{self, Rattle};
use crate::calibrate::measured::recording::{LegsRecording, stem};
use crate::calibrate::plausibility;
use crate::calibrate::values::model::SearchError;
use crate::calibrate::values::model::{LegsCase, LegsRun};
use crate::engine::{Halt, StepControl};
use crate::measure::log::LogError;
use crate::report::Picture;
use crate::results::{Folder, PAGE_FILE, RunError, refused};
use crate::scenario::{Problem, Scenario, Sensors};
use std::fs;
use std::path::PathBuf;
use std::time::Instant as Clock;

/// The JSON file by which a calibration is known.
pub const REPORT_FILE: &str = "report.json";

/// The rig with what was found.
pub(in crate::calibrate) const CALIBRATED_FILE: &str = "calibrated.toml";

/// Velocity error in m/s of a step where a rig asks for fixed steps: a calibration compares simulations
/// whose hits fall anywhere, and no fixed step suits them all. The default of scenarios.
const TOLERANCE: f64 = 1e-5;

/// Why there is no calibration, or no prediction.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// Wrong input; one message a problem.
    #[error("{}", .0.join("\n"))]
    Input(Vec<String>),
    /// A simulation broke down.
    #[error("{0}")]
    Halted(#[from] Halt),
    /// Results cannot be written.
    #[error(transparent)]
    Files(#[from] RunError),
}

impl From<Problem> for CalibrateError {
    fn from(problem: Problem) -> Self {
        Self::Input(vec![problem.to_string()])
    }
}

impl From<SearchError> for CalibrateError {
    fn from(error: SearchError) -> Self {
        match error {
            SearchError::Model(problem) => problem.into(),
            SearchError::Halted(halt) => halt.into(),
        }
    }
}

impl From<Vec<LogError>> for CalibrateError {
    fn from(errors: Vec<LogError>) -> Self {
        Self::Input(errors.iter().map(LogError::to_string).collect())
    }
}

/// All that is wrong, if anything is.
///
/// # Errors
/// [`CalibrateError::Input`] with these messages, if there are any.
pub fn refuse<E: ToString>(found: Vec<E>) -> Result<(), CalibrateError> {
    if found.is_empty() {
        return Ok(());
    }
    Err(CalibrateError::Input(found.iter().map(ToString::to_string).collect()))
}

/// How simulations of a rig are to be stepped.
pub fn control(rig: &Scenario) -> StepControl {
    match rig.step_control() {
        StepControl::Fixed(_) => StepControl::Tolerance(TOLERANCE),
        tolerance @ (StepControl::Tolerance(_) | StepControl::Direct(_)) => tolerance,
    }
}

/// A rig and runs that nothing speaks against, before anything is simulated.
#[derive(Debug)]
pub struct LegsPrepared {
    case: LegsCase,
    /// Files of the runs as the user called them.
    paths: Vec<String>,
}

/// Makes sure that a rig and its logs (the first to calibrate on, the others to validate on) can be
/// calibrated.
///
/// # Errors
/// Everything that is wrong with them.
pub fn prepare(
    rig: Scenario,
    recordings: Vec<LegsRecording>,
) -> Result<LegsPrepared, CalibrateError> {
    let mut found: Vec<String> = plausibility::rig(&rig).iter().map(Problem::to_string).collect();
    for recording in &recordings {
        let wrong = plausibility::recording(&rig, recording, plausibility::CALIBRATE);
        found.extend(wrong.iter().map(LogError::to_string));
    }
    found.extend(plausibility::twins(&recordings).iter().map(LogError::to_string));
    refuse(found)?;
    let sensors = rig.sensors.clone().unwrap_or_default();
    let (mut runs, mut paths) = (Vec::new(), Vec::new());
    for LegsRecording { path, log } in recordings {
        let run = LegsRun::new(log).map_err(|channel| {
            CalibrateError::Input(vec![format!(
                "{path}:1: no column `{channel}`; calibrate needs it"
            )])
        })?;
        runs.push(run);
        paths.push(path);
    }
    let control = control(&rig);
    Ok(LegsPrepared { case: LegsCase::new(rig, sensors, runs, control), paths })
}

/// A finished calibration and its report, of whichever method.
#[derive(Debug)]
pub struct FinishedCalibration<R> {
    /// What it came to.
    pub report: R,
    /// The text of `report.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

/// A calibration before it is written.
#[derive(Debug)]
pub(in crate::calibrate) struct LegsMade {
    /// What it came to.
    pub report: LegsReport,
    /// Texts by their files' names.
    texts: Vec<(String, String)>,
    pictures: Vec<Picture>,
}

impl LegsMade {
    /// Writes everything into a folder.
    ///
    /// # Errors
    /// Files that cannot be written; the folder is left as it was.
    pub fn written(
        self,
        folder: Folder,
    ) -> Result<FinishedCalibration<LegsReport>, CalibrateError> {
        let Self { report, texts, pictures } = self;
        let json = to_json(&report);
        let mut all = vec![(REPORT_FILE, &json)];
        all.extend(texts.iter().map(|(name, text)| (name.as_str(), text)));
        let folder = publish(folder, &all, &pictures)?;
        Ok(FinishedCalibration { report, json, folder })
    }
}

/// Calibrates a rig. `tell` hears what is being tried.
///
/// # Errors
/// Forces in a wrong unit, a rig that cannot be simulated.
pub(in crate::calibrate) fn made(
    prepared: LegsPrepared,
    without: &[&str],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<LegsMade, CalibrateError> {
    let started = Clock::now();
    tell("simulating replicas of the declared model: does it rattle?");
    let (case, rattle) = case(prepared)?;
    let case = &case;
    let outcome = calibrate(case, without, tell)?;
    tell("drawing and writing");
    let sources = Sources { case, outcome: &outcome, rattle: &rattle, without };
    let mut report = LegsReport::new(sources);
    let charts = charts::draw(case, &outcome)?;
    let predictions: Vec<(String, String)> = outcome
        .predictions
        .iter()
        .zip(&case.runs)
        .map(|(log, run)| {
            let arranged = log.arranged(run.log.channels());
            (format!("predicted-{}.csv", stem(log)), arranged.to_csv())
        })
        .collect();
    let texts = [REPORT_FILE, CALIBRATED_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let predicted = predictions.iter().map(|(name, _)| name.clone());
    let pictures = charts.pictures().map(|picture| picture.file.clone());
    report.files = texts.chain(predicted).chain(pictures).collect();
    report.wall_s = started.elapsed().as_secs_f64();

    let model = calibrated(&case.rig, &outcome).to_toml();
    let page = page::page(case, &outcome, &report, &charts);
    let mut texts = vec![(CALIBRATED_FILE.to_owned(), model), (PAGE_FILE.to_owned(), page)];
    texts.extend(predictions);
    Ok(LegsMade { report, texts, pictures: charts.pictures().cloned().collect() })
}

/// Writes texts and pictures into a folder of results and puts it where it belongs.
///
/// # Errors
/// Files that cannot be written; the folder is left as it was.
pub fn publish<'a>(
    folder: Folder,
    texts: &[(&str, &String)],
    pictures: impl IntoIterator<Item = &'a Picture>,
) -> Result<PathBuf, CalibrateError> {
    let texts = texts.iter().map(|(name, text)| (*name, text.as_str()));
    let pictures = pictures.into_iter().map(|p| (p.file.as_str(), p.svg.as_str()));
    for (name, text) in texts.chain(pictures) {
        fs::write(folder.file(name), text).map_err(refused(name))?;
    }
    Ok(folder.finish().map_err(RunError::from)?)
}

/// Finds out whether the declared machine rattles on any of its runs, makes the case simulate
/// accordingly, and holds the measured forces against the declared ones.
///
/// # Errors
/// Forces in a wrong unit, a rig that cannot be simulated.
pub fn case(prepared: LegsPrepared) -> Result<(LegsCase, Rattle), CalibrateError> {
    let LegsPrepared { mut case, paths } = prepared;
    let machines = case.released(&[])?;
    let mut found = Vec::new();
    let mut worst: Option<Rattle> = None;
    for ((run, machine), path) in case.runs.iter().zip(&machines).zip(paths) {
        let rattle = rattle::look(&case.simulator, machine, &run.log)?;
        found.extend(plausibility::forces(&path, &run.log, &rattle.logs[0], &case.rig.drive));
        if worst.as_ref().is_none_or(|worst| rattle.difference > worst.difference) {
            worst = Some(rattle);
        }
    }
    refuse(found)?;
    let worst = worst.ok_or_else(|| CalibrateError::Input(vec!["no run was given".to_owned()]))?;
    case.chaotic = worst.chaotic;
    Ok((case, worst))
}

/// A result as JSON.
pub fn to_json<T: serde::Serialize>(result: &T) -> String {
    // No input makes this fail: the types have only names for keys, and NaN becomes null.
    serde_json::to_string_pretty(result).expect("numbers, texts and lists are JSON") + "\n"
}

/// The sensors of a model, or ones without any error where it declares none.
pub fn sensors(model: &Scenario) -> Sensors {
    model.sensors.clone().unwrap_or_default()
}
