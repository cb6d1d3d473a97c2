//! A rig and its recordings, and everything that speaks against them, before anything is simulated or written.

use super::followed;
use super::noise;
use crate::calibrate::results::result::{CalibrateError, refuse};
use crate::calibrate::sensed::held;
use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::windows::bench::{Bench, suits};
use crate::calibrate::sensed::windows::plausible;
use crate::measure::log::LogError;
use crate::mechanism::{Mechanism, Reads};
use crate::scenario::{Law, Problem, Scenario};
use std::path::Path;

/// A rig and recordings that nothing speaks against.
#[derive(Debug)]
pub struct Prepared {
    pub(in crate::calibrate::sensed) rig: Scenario,
    pub(in crate::calibrate) recordings: Vec<Recording>,
    /// How many of them, the first ones, values are fitted to.
    pub(in crate::calibrate::sensed) fits: usize,
    /// How.
    pub(in crate::calibrate::sensed) way: CalibratedAs,
}

/// How a machine is calibrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::calibrate) enum CalibratedAs {
    /// Nothing holds it: by windows.
    Windows,
    /// Sampled controllers hold it: by what they ask of their drives.
    Held,
    /// By residuals in units of noise and simulations.
    Residuals,
}

impl Prepared {
    /// What is to be known of the recordings.
    pub fn remarks(&self) -> Vec<String> {
        self.recordings.iter().flat_map(Recording::remarks).collect()
    }
}

impl CalibratedAs {
    /// The way of a machine.
    pub(in crate::calibrate) fn of(machine: &Mechanism) -> Self {
        if suits(machine) {
            Self::Windows
        } else if held::bench::suits(machine) {
            Self::Held
        } else {
            Self::Residuals
        }
    }
}

/// Reads recordings of a rig whose sensors its file describes, the first `fits` to calibrate on, the others to
/// validate on.
///
/// ```
/// use freeplay::calibrate::sensed::prepare;
/// use freeplay::scenario::Scenario;
/// use std::path::Path;
///
/// // Two recordings of a four-bar: one to calibrate on, one to validate on.
/// let folder = Path::new("assets/rigs-planar/planar-2");
/// let rig = Scenario::load(Some(&folder.join("rig.toml")), &[])?;
/// let [a, b] = ["run-a.csv", "run-b.csv"].map(|name| folder.join(name));
/// assert!(prepare(rig.clone(), &[&a, &b], 1)?.remarks().is_empty(), "each column is of a sensor");
/// assert!(prepare(rig, &[&a, &a], 1).is_err(), "no model is validated on what it was fitted to");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Everything that is wrong with them.
pub fn prepare(rig: Scenario, paths: &[&Path], fits: usize) -> Result<Prepared, CalibrateError> {
    let built: Mechanism = crate::model::parts_of(&rig)?;
    let way = CalibratedAs::of(&built);
    refuse(against_rig(&rig, &built, way, fits))?;
    let mut recordings = read(&rig, &built, way, paths)?;
    called_apart(&mut recordings);
    through_common_sensors(&mut recordings, &built);
    refuse(noise::wrong(&rig, &built, &recordings))?;
    // What the machine cannot be at a recording's first row is told before anything is written.
    if way == CalibratedAs::Windows {
        let bench = Bench::new(&rig, recordings.clone())?;
        refuse(plausible::wrong(&rig, &bench))?;
    } else {
        for recording in &recordings {
            machine(&rig, &[], recording)?;
        }
    }
    Ok(Prepared { rig, recordings, fits, way })
}

/// What speaks against a rig by itself.
pub(in crate::calibrate) fn against_rig(
    rig: &Scenario,
    built: &Mechanism,
    way: CalibratedAs,
    fits: usize,
) -> Vec<String> {
    let mut wrong: Vec<String> = Vec::new();
    if built.sensors.is_empty() {
        return vec![without_sensors(rig).to_string()];
    }
    if way == CalibratedAs::Residuals {
        wrong.extend(native(rig, "calibrate"));
    }
    if way == CalibratedAs::Residuals && !rig.effects.is_empty() {
        let message = format!("holds {} effect(s)", rig.effects.len());
        let help = "calibrate starts from what a rig's maker declares: give it the rig without [[effect]] (`freeplay predict` \
             judges a model with effects)";
        wrong.push(rig.problem("effect", message, help).to_string());
    }
    if way != CalibratedAs::Windows && fits > 1 {
        let message =
            "--data: several runs are fitted together of machines that nothing holds alone";
        wrong.push(format!("{message}; give this one a --data and the others as --validate"));
    }
    wrong
}

/// What is wrong with a rig whose file does not say what recordings of it hold.
pub(in crate::calibrate::sensed) fn without_sensors(rig: &Scenario) -> Problem {
    if rig.mechanism.uses("sensors") {
        let message = "is missing: nobody knows what instruments its recordings are of, and how exact they are";
        let help = "write [sensors] with pose_std, angle_std, force_std, length_resolution and force_lowpass, as in \
                    assets/rigs/rig-1/rig.toml; an instrument whose noise is 0 is given that of the recordings";
        return rig.problem("sensors", message, help);
    }
    let message = "is missing: nobody knows what the columns of a recording are";
    let help = "add a [[sensor]] for each column (a drive stage or a pendulum with a kind takes [columns], too); \
                `freeplay init four-bar --rig` prints a rig that has them";
    rig.problem("sensor", message, help)
}

/// What is wrong with a rig whose contacts are the engine's own, for a command that compares simulations.
pub(in crate::calibrate::sensed) fn native(rig: &Scenario, command: &str) -> Option<String> {
    let help =
        format!("write law = \"hertz-step\": {command} needs a contact law whose error is known");
    (rig.contact.law == Law::Native)
        .then(|| rig.problem("contact.law", "is \"native\"", &help).to_string())
}

/// The recordings, if each can be right by itself and beside the others.
fn read(
    rig: &Scenario,
    built: &Mechanism,
    way: CalibratedAs,
    paths: &[&Path],
) -> Result<Vec<Recording>, CalibrateError> {
    let mut recordings: Vec<Recording> = Vec::new();
    let mut errors: Vec<LogError> = Vec::new();
    let efforts = way == CalibratedAs::Windows;
    for path in paths {
        match Recording::read_with_time(path, &built.sensors, efforts, rig.time_column()) {
            Ok(recording) => {
                let columns = rig.columns.as_ref();
                errors.extend(columns.and_then(|named| recording.lacks(&built.sensors, named)));
                recordings.push(recording);
            }
            Err(error) => errors.push(error),
        }
    }
    let implausible = |recording| held::plausible::wrong(rig, built, recording);
    if errors.is_empty() {
        refuse(recordings.iter().flat_map(implausible).collect())?;
    }
    errors.extend(recordings.iter().filter_map(Recording::wrong));
    errors.extend(recordings.iter().flat_map(|recording| followed::wrong(rig, built, recording)));
    for (i, one) in recordings.iter().enumerate() {
        for other in recordings[..i].iter().filter(|other| one.is_twin_of(other)) {
            errors.push(LogError {
                place: one.path.clone(),
                message: format!("holds the same samples as {}", other.path),
                help: "validate on another run: on the one that was fitted nothing is proved"
                    .to_owned(),
            });
        }
    }
    refuse(errors)?;
    Ok(recordings)
}

/// Files of one name in several folders are called by their paths.
fn called_apart(recordings: &mut [Recording]) {
    let names: Vec<String> = recordings.iter().map(|recording| recording.name.clone()).collect();
    for recording in recordings {
        if names.iter().filter(|name| **name == recording.name).count() > 1 {
            recording.name.clone_from(&recording.path);
        }
    }
}

/// One look serves all runs: it is through the sensors that all of them have.
fn through_common_sensors(recordings: &mut [Recording], built: &Mechanism) {
    let everywhere = |i: usize| recordings.iter().all(|recording| recording.get(i).is_some());
    // What was added to outputs in one run alone is known of the others: nothing was.
    let added = |i: usize| matches!(built.sensors[i].reads, Reads::Added(_));
    let common: Vec<bool> = (0..built.sensors.len()).map(|i| added(i) || everywhere(i)).collect();
    for recording in recordings {
        let columns = common
            .iter()
            .enumerate()
            .map(|(i, common)| recording.get(i).filter(|_| *common).map(<[f64]>::to_vec));
        *recording = recording.with(columns.collect());
    }
}
