//! The one way in: a rig and recordings of any machine, and the folder of what it lacks.

use super::results::report::EffectReport;
use super::results::result::{CalibrateError, FinishedCalibration};
use super::sensed;
use super::values::errors::ChannelError;
use crate::results::Folder;
use std::path::PathBuf;

pub use super::sensed::prepare;

/// What a calibration came to, and where it is written.
#[derive(Debug)]
pub struct Calibrated {
    /// What the rig is called.
    pub name: String,
    /// What it comes to, in a sentence or two.
    pub summary: String,
    /// What the model was given.
    pub effects: Vec<EffectReport>,
    /// Errors by run and column.
    pub errors: Vec<ChannelError>,
    /// Simulations of a run that it took; none of a machine that is calibrated by windows.
    pub simulations: Option<usize>,
    /// Time of computing in s.
    pub wall_s: f64,
    /// The text of `report.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

/// Calibrates a rig and writes everything about it into `folder`. `tell` hears what is being tried.
///
/// # Errors
/// A rig that cannot be simulated, files that cannot be written; the folder is left as it was.
pub fn into_folder(
    prepared: sensed::prepare::Prepared,
    without: &[&str],
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Calibrated, CalibrateError> {
    Ok(sensed::into_folder(prepared, without, folder, tell)?.into())
}

impl From<FinishedCalibration<sensed::report::Report>> for Calibrated {
    fn from(done: FinishedCalibration<sensed::report::Report>) -> Self {
        let FinishedCalibration { report, json, folder } = done;
        Self {
            name: report.provenance.scenario_name,
            summary: report.summary,
            effects: report.effects,
            errors: report.errors,
            simulations: report.windows.is_none().then_some(report.simulations),
            wall_s: report.wall_s,
            json,
            folder,
        }
    }
}
