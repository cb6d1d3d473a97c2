//! The one way in: a rig and recordings of any machine, and the folder of what it lacks.
//!
//! Every machine is calibrated by its sensors ([`sensed`]), instruments and noise among what may be wrong. Where no name explains a
//! 3-RPR whose twelve columns are all there, the method that was made for it looks for a table of forces as well; names are those
//! of the sensors alone.

use super::measured::recording;
use super::results::outcome::Verdict;
use super::results::report::{EffectReport, LegsReport};
use super::results::result::{self, CalibrateError, refuse};
use super::sensed::ways::by_residuals;
use super::values::errors::{ChannelError, worst};
use super::{plausibility, sensed};
use crate::results::Folder;
use crate::scenario::Scenario;
use std::path::{Path, PathBuf};

/// A rig and recordings that nothing speaks against, before anything is simulated.
#[derive(Debug)]
pub struct PreparedRig {
    way: Method,
    /// Files and their columns that no sensor has.
    pub ignored: Vec<(String, Vec<String>)>,
}

/// By which method.
#[derive(Debug)]
enum Method {
    /// By the sensors that there are.
    Sensed(Box<sensed::prepare::Prepared>),
    /// By its sensors, if they can be read so; where they find no name, by that of a 3-RPR as well.
    Both(Box<result::LegsPrepared>, Option<Box<sensed::prepare::Prepared>>),
}

/// Reads recordings of a rig, the first `fits` to calibrate on, the others to validate on.
///
/// ```
/// use freeplay::calibrate::answer::prepare;
/// use freeplay::scenario::Scenario;
/// use std::path::Path;
///
/// // Two recordings of a four-bar: one to calibrate on, one to validate on.
/// let folder = Path::new("assets/rigs-planar/planar-2");
/// let rig = Scenario::load(Some(&folder.join("rig.toml")), &[])?;
/// let [a, b] = ["run-a.csv", "run-b.csv"].map(|name| folder.join(name));
/// assert!(prepare(rig.clone(), &[&a, &b], 1)?.ignored.is_empty(), "each column is of a sensor");
/// assert!(prepare(rig, &[&a, &a], 1).is_err(), "no model is validated on what it was fitted to");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Everything that is wrong with them.
pub fn prepare(rig: Scenario, paths: &[&Path], fits: usize) -> Result<PreparedRig, CalibrateError> {
    let by_sensors = |rig| {
        let way = Method::Sensed(Box::new(sensed::prepare(rig, paths, fits)?));
        Ok(PreparedRig { way, ignored: Vec::new() })
    };
    if rig.mechanism.has_sensors() {
        return by_sensors(rig);
    }
    if fits > 1 {
        let message =
            "--data: this machine takes one run to calibrate on; give the others as --validate";
        return Err(CalibrateError::Input(vec![message.to_owned()]));
    }
    let recordings = recording::read(paths)?;
    if !recordings.iter().all(plausibility::is_complete) {
        refuse(plausibility::incomplete(&rig, &recordings))?;
        return by_sensors(rig);
    }
    let ignored = recordings.iter().map(|one| (one.path.clone(), one.log.ignored().to_vec()));
    let ignored = ignored.filter(|(_, columns)| !columns.is_empty()).collect();
    let own = result::prepare(rig.clone(), recordings)?;
    // The first method has looked at more than this one does.
    let way = Method::Both(Box::new(own), sensed::prepare(rig, paths, fits).ok().map(Box::new));
    Ok(PreparedRig { way, ignored })
}

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
    prepared: PreparedRig,
    without: &[&str],
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Calibrated, CalibrateError> {
    let (own, by_sensors) = match prepared.way {
        Method::Sensed(prepared) => {
            return Ok(sensed::into_folder(*prepared, without, folder, tell)?.into());
        }
        Method::Both(own, by_sensors) => (own, by_sensors),
    };
    // A model that breaks down there takes nothing from what the other method finds.
    let seen = by_sensors.and_then(|prepared| {
        let sensed::prepare::Prepared { rig, recordings, .. } = *prepared;
        by_residuals(rig, recordings, without, tell).ok()
    });
    let Some(mut seen) = seen else {
        return Ok(result::made(*own, without, tell)?.written(folder)?.into());
    };
    if seen.report.verdict != Verdict::Unexplained {
        return Ok(seen.written(folder)?.into());
    }
    let mut own = result::made(*own, without, tell)?;
    let (seconds, runs) = (own.report.wall_s, own.report.simulations);
    own.report.wall_s += seen.report.wall_s;
    own.report.simulations += seen.report.simulations;
    seen.report.wall_s += seconds;
    seen.report.simulations += runs;
    match own.report.verdict == Verdict::Unexplained
        && missed(&own.report.errors) < missed(&seen.report.errors)
    {
        true => Ok(own.written(folder)?.into()),
        false => Ok(seen.written(folder)?.into()),
    }
}

/// Largest error on data not fitted to, in floors.
fn missed(errors: &[ChannelError]) -> f64 {
    worst(errors).map_or(0.0, |error| error.after / error.floor)
}

impl From<result::FinishedCalibration<sensed::report::Report>> for Calibrated {
    fn from(done: result::FinishedCalibration<sensed::report::Report>) -> Self {
        let result::FinishedCalibration { report, json, folder } = done;
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

impl From<result::FinishedCalibration<LegsReport>> for Calibrated {
    fn from(done: result::FinishedCalibration<LegsReport>) -> Self {
        let result::FinishedCalibration { report, json, folder } = done;
        Self {
            name: report.provenance.scenario_name,
            summary: report.summary,
            effects: report.effects,
            errors: report.errors,
            simulations: Some(report.simulations),
            wall_s: report.wall_s,
            json,
            folder,
        }
    }
}
