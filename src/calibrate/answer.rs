//! The one way in: a rig and recordings of any machine, and the folder of what it lacks.
//!
//! Every machine is calibrated by its sensors ([`sensed`]), instruments and noise among what may be wrong. A 3-RPR whose
//! twelve columns are all there is tried by the method that was made for it first, which follows rattling joints and pairs of
//! effects further, but holds its instruments for right: what it finds missing is found by both.

use super::measured::recording;
use super::results::outcome::Verdict;
use super::results::report::{EffectReport, LegsReport};
use super::results::result::{self, CalibrateError, refuse};
use super::sensed::ways::by_residuals;
use super::values::errors::{ChannelError, worst};
use super::{plausibility, sensed};
use crate::effects::{Kind, named};
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
    /// By that of a 3-RPR, and by its sensors, if these can be read so.
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
    let mut own = result::made(*own, without, tell)?;
    let complete = own.report.verdict == Verdict::NothingMissing;
    let Some(by_sensors) = by_sensors.filter(|_| !complete) else {
        return Ok(own.written(folder)?.into());
    };
    let sensed::prepare::Prepared { rig, recordings, .. } = *by_sensors;
    // A model that breaks down there takes nothing from what was found.
    let Ok(mut other) = by_residuals(rig, recordings, without, tell) else {
        return Ok(own.written(folder)?.into());
    };
    let (seconds, runs) = (own.report.wall_s, own.report.simulations);
    own.report.wall_s += other.report.wall_s;
    own.report.simulations += other.report.simulations;
    other.report.wall_s += seconds;
    other.report.simulations += runs;
    let LegsReport { verdict, effects, errors, .. } = &own.report;
    let first = Weighed::new(*verdict, effects, errors, 0);
    let sensed::report::Report { verdict, effects, errors, noises, .. } = &other.report;
    match Weighed::new(*verdict, effects, errors, noises.len()).goes_before(&first) {
        true => Ok(other.written(folder)?.into()),
        false => Ok(own.written(folder)?.into()),
    }
}

/// What of an answer the choice between two rests on.
struct Weighed {
    verdict: Verdict,
    /// How many effects it needs.
    effects: usize,
    /// Whether instruments alone are wrong, their noise among it.
    instruments: bool,
    /// Largest error on data not fitted to, in floors.
    missed: f64,
}

impl Weighed {
    fn new(
        verdict: Verdict,
        effects: &[EffectReport],
        errors: &[ChannelError],
        noises: usize,
    ) -> Self {
        let shown = |effect: &EffectReport| named(effect.kind).is_some_and(Kind::is_instrument);
        Self {
            verdict,
            effects: effects.len(),
            instruments: effects.iter().all(shown) && effects.len() + noises > 0,
            missed: worst(errors).map_or(0.0, |error| error.after / error.floor),
        }
    }

    /// Whether what all sensors say goes before what the method of a 3-RPR found, which holds its instruments for right: it
    /// understands what that one does not, or with fewer effects, or blames instruments alone.
    fn goes_before(&self, own: &Self) -> bool {
        match (own.verdict, self.verdict) {
            (Verdict::Unexplained, Verdict::Unexplained) => self.missed < own.missed,
            (Verdict::Unexplained, _) => true,
            (_, Verdict::Unexplained) => false,
            // Less than that method sees is no simpler answer.
            _ => self.instruments || (self.effects > 0 && self.effects < own.effects),
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(verdict: Verdict, effects: usize, instruments: bool, missed: f64) -> Weighed {
        Weighed { verdict, effects, instruments, missed }
    }

    #[test]
    fn instruments_go_before_the_machine_and_few_effects_before_many() {
        let [wear, anchors] = [1, 3].map(|n| answer(Verdict::Explained, n, false, 1.1));
        let nothing = answer(Verdict::Unexplained, 0, false, 9.0);
        let camera = answer(Verdict::Explained, 1, true, 1.1);
        let noise = answer(Verdict::NothingMissing, 0, true, 1.0);
        for found in [&camera, &noise] {
            for own in [&wear, &anchors, &nothing] {
                assert!(found.goes_before(own));
            }
        }
        assert!(wear.goes_before(&anchors) && wear.goes_before(&nothing));
        // What both methods explain by one effect each, and what only the first one sees, is the first one's.
        let blind = answer(Verdict::NothingMissing, 0, false, 1.0);
        assert!(
            !wear.goes_before(&wear) && !anchors.goes_before(&wear) && !blind.goes_before(&wear)
        );
        assert!(!nothing.goes_before(&wear));
        let nearer = answer(Verdict::Unexplained, 1, false, 2.0);
        assert!(nearer.goes_before(&nothing) && !nothing.goes_before(&nearer));
    }
}
