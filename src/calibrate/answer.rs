//! The one way in: a rig and recordings of any machine, and the folder of what it lacks.
//!
//! Every machine is calibrated by its sensors ([`sensed`]), instruments and noise among what may be wrong. A 3-RPR whose
//! twelve columns are all there is tried by the method that was made for it first, which follows rattling joints and pairs of
//! effects further, but holds its instruments for right: what it finds missing is found by both.

use super::errors::{ChannelError, worst};
use super::outcome::Verdict;
use super::report::{EffectReport, Report};
use super::result::{self, CalibrateError, refuse};
use super::sensed::ways::by_residuals;
use super::{plausibility, recording, sensed};
use crate::effects::{Kind, named};
use crate::scenario::Scenario;
use crate::study::Folder;
use std::path::{Path, PathBuf};

/// A rig and recordings that nothing speaks against, before anything is simulated.
#[derive(Debug)]
pub struct Prepared {
    way: Way,
    /// Files and their columns that no sensor has.
    pub ignored: Vec<(String, Vec<String>)>,
}

/// By which method.
#[derive(Debug)]
enum Way {
    /// By the sensors that there are.
    Sensed(Box<sensed::prepare::Prepared>),
    /// By that of a 3-RPR, and by its sensors, if these can be read so.
    Both(Box<result::Prepared>, Option<Box<sensed::prepare::Prepared>>),
}

/// Reads recordings of a rig, the first `fits` to calibrate on, the others to validate on.
///
/// # Errors
/// Everything that is wrong with them.
pub fn prepare(rig: Scenario, paths: &[&Path], fits: usize) -> Result<Prepared, CalibrateError> {
    let by_sensors = |rig| {
        let way = Way::Sensed(Box::new(sensed::prepare(rig, paths, fits)?));
        Ok(Prepared { way, ignored: Vec::new() })
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
    let way = Way::Both(Box::new(own), sensed::prepare(rig, paths, fits).ok().map(Box::new));
    Ok(Prepared { way, ignored })
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
    prepared: Prepared,
    without: &[&str],
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Calibrated, CalibrateError> {
    let (own, by_sensors) = match prepared.way {
        Way::Sensed(prepared) => {
            return Ok(sensed::into_folder(*prepared, without, folder, tell)?.into());
        }
        Way::Both(own, by_sensors) => (own, by_sensors),
    };
    let mut own = result::made(*own, without, tell)?;
    let complete = own.report.verdict == Verdict::NothingMissing;
    let Some(by_sensors) = by_sensors.filter(|_| !complete) else {
        return Ok(own.written(folder)?.into());
    };
    let sensed::prepare::Prepared { rig, recordings, .. } = *by_sensors;
    let mut other = by_residuals(rig, recordings, without, tell)?;
    let (seconds, runs) = (own.report.wall_s, own.report.simulations);
    own.report.wall_s += other.report.wall_s;
    own.report.simulations += other.report.simulations;
    other.report.wall_s += seconds;
    other.report.simulations += runs;
    match simpler(&own.report, &other.report) {
        true => Ok(other.written(folder)?.into()),
        false => Ok(own.written(folder)?.into()),
    }
}

/// Whether what all sensors say goes before what the method of a 3-RPR found, which holds its instruments for right: it
/// understands what that one does not, or with fewer effects, or blames instruments alone.
fn simpler(own: &Report, other: &sensed::report::Report) -> bool {
    let missed = |errors: &[ChannelError]| worst(errors).map_or(0.0, |e| e.after / e.floor);
    let instruments = || {
        let shown = |effect: &EffectReport| named(effect.kind).is_some_and(Kind::is_instrument);
        other.effects.iter().all(shown) && !(other.effects.is_empty() && other.noises.is_empty())
    };
    match (own.verdict, other.verdict) {
        (Verdict::Unexplained, Verdict::Unexplained) => missed(&other.errors) < missed(&own.errors),
        (Verdict::Unexplained, _) => true,
        (_, Verdict::Unexplained) => false,
        _ => {
            instruments() || (!other.effects.is_empty() && other.effects.len() < own.effects.len())
        }
    }
}

impl From<sensed::written::Calibrated> for Calibrated {
    fn from(done: sensed::written::Calibrated) -> Self {
        let sensed::written::Calibrated { report, json, folder } = done;
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

impl From<result::Calibrated> for Calibrated {
    fn from(done: result::Calibrated) -> Self {
        let result::Calibrated { report, json, folder } = done;
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
