//! The files of a calibration, whatever way it went.

use super::page;
use super::report::Report;
use crate::calibrate::results::result::{
    self, CALIBRATED_FILE, CalibrateError, REPORT_FILE, publish, to_json,
};
use crate::report::Picture;
use crate::results::{Folder, PAGE_FILE};
use crate::scenario::Scenario;

/// A finished calibration.
pub type SensedCalibration = result::FinishedCalibration<Report>;

/// A calibration before it is written.
#[derive(Debug)]
pub(in crate::calibrate) struct Made {
    /// What it came to.
    pub report: Report,
    pub(super) calibrated: Scenario,
    pub(in crate::calibrate::sensed) files: Vec<(String, String)>,
    pub(super) pictures: Vec<Picture>,
}

impl Made {
    /// Writes everything into a folder.
    ///
    /// # Errors
    /// Files that cannot be written; the folder is left as it was.
    pub fn written(self, folder: Folder) -> Result<SensedCalibration, CalibrateError> {
        written(self.report, &self.calibrated, &self.files, &self.pictures, folder)
    }
}

/// Names of all files of a calibration, `files` by name and text among them.
pub(in crate::calibrate::sensed) fn names_of_files(
    files: &[(String, String)],
    pictures: &[Picture],
) -> Vec<String> {
    let texts = [REPORT_FILE, CALIBRATED_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let written = files.iter().map(|(name, _)| name.clone());
    texts.chain(written).chain(pictures.iter().map(|picture| picture.file.clone())).collect()
}

/// Writes a report, the calibrated model, the page and these files and pictures.
pub(in crate::calibrate::sensed) fn written(
    report: Report,
    calibrated: &Scenario,
    files: &[(String, String)],
    pictures: &[Picture],
    folder: Folder,
) -> Result<SensedCalibration, CalibrateError> {
    let json = to_json(&report);
    let (model, page) = (calibrated.to_toml(), page::page(&report, pictures));
    let mut texts = vec![(REPORT_FILE, &json), (CALIBRATED_FILE, &model), (PAGE_FILE, &page)];
    texts.extend(files.iter().map(|(name, text)| (name.as_str(), text)));
    let folder = publish(folder, &texts, pictures)?;
    Ok(SensedCalibration { report, json, folder })
}
