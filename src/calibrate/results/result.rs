//! A calibration and its folder of results.

use crate::engine::{Halt, StepControl};
use crate::report::Picture;
use crate::results::{Folder, RunError, refused};
use crate::scenario::{Problem, Scenario};
use std::fs;
use std::path::PathBuf;

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

/// A result as JSON.
pub fn to_json<T: serde::Serialize>(result: &T) -> String {
    // No input makes this fail: the types have only names for keys, and NaN becomes null.
    serde_json::to_string_pretty(result).expect("numbers, texts and lists are JSON") + "\n"
}

/// The name of a recording without folders' separators and without `.csv`: what files about it are called after.
pub fn stem_of(name: &str) -> String {
    let path = PathBuf::from(name);
    let bare = match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("csv") => path.with_extension(""),
        _ => path,
    };
    let plain = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    bare.to_string_lossy().chars().map(plain).collect()
}
