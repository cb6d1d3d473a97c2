//! A machine of one joint along a recording.

use crate::calibrate::LoggedCommands;
use crate::calibrate::result::CalibrateError;
use crate::identify::arm::{self, PLAN};
use crate::identify::stage::{self, Samples, controller_force, first_length};
use crate::identify::{Missing, Recorded, swings};
use crate::measure::log::{Channel, Log};
use crate::mechanism::{Commands, Drive};
use crate::scenario::{self, Law, Scenario};
use crate::simulate::{drive, started};
use std::path::Path;
use std::sync::Arc;

/// Which machine of one joint it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Machine {
    /// One driven prismatic joint.
    Stage,
    /// One revolute joint.
    Pendulum,
}

impl Machine {
    /// The machine of a scenario; none where it has more joints.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        match scenario.mechanism {
            scenario::Mechanism::DriveStage(_) => Some(Self::Stage),
            scenario::Mechanism::Pendulum(_) => Some(Self::Pendulum),
            _ => None,
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Stage => "drive stage",
            Self::Pendulum => "pendulum",
        }
    }

    /// What a recording has to have to be predicted: what drives the machine, or where it starts.
    fn needed(self) -> &'static [Channel] {
        match self {
            Self::Stage => &[Channel::Command(0)],
            Self::Pendulum => &arm::NEEDED,
        }
    }

    fn known(self) -> &'static [Channel] {
        match self {
            Self::Stage => &stage::KNOWN,
            Self::Pendulum => &arm::NEEDED,
        }
    }
}

/// Shortest recording in s: twice what the start of a pendulum is fitted to.
const SHORTEST: f64 = 0.5;

/// Lowest rate in Hz: twice what errors are looked at up to, with some to spare.
const SLOWEST: f64 = 100.0;

impl From<Missing> for CalibrateError {
    fn from(missing: Missing) -> Self {
        match missing {
            Missing::Halted(halt) => Self::Halted(halt),
            other => Self::Input(vec![other.to_string()]),
        }
    }
}

/// Reads a recording of a machine by its rig's `[columns]`, and makes sure that it can be one run of it.
/// `calibrate` where the parameters are sought too, which takes every channel.
///
/// # Errors
/// What speaks against it.
pub fn read(
    path: &Path,
    rig: &Scenario,
    machine: Machine,
    calibrate: bool,
) -> Result<Recorded, CalibrateError> {
    if rig.contact.law == Law::Native {
        let help = "write law = \"ideal\" or \"hertz-step\": a prediction needs a contact law whose error is known";
        return Err(rig.problem("contact.law", "is \"native\"", help).into());
    }
    let needed = match (machine, calibrate) {
        (Machine::Stage, true) => &stage::NEEDED,
        _ => machine.needed(),
    };
    let recorded = Recorded::read(path, rig, needed, machine.known())?;
    let wrong =
        |message: String| CalibrateError::Input(vec![format!("{}: {message}", recorded.path)]);
    let log = &recorded.log;
    if log.duration() < SHORTEST {
        return Err(wrong(format!(
            "holds {:.3} s; at least {SHORTEST} s are needed: is columns.t in s?",
            log.duration()
        )));
    }
    if log.interval * SLOWEST > 1.0 {
        return Err(wrong(format!(
            "has a sample every {:.4} s; at least {SLOWEST} a second are needed: is columns.t in s?",
            log.interval
        )));
    }
    match machine {
        Machine::Stage => stage::plausible(rig, &recorded)?,
        Machine::Pendulum => arm::plausible(rig, &recorded)?,
    }
    Ok(recorded)
}

/// Simulates a model along a recording: a stage by its recorded reference from its first length, a
/// pendulum from an angle and a rate that are fitted to the first 0.25 s. Without noise; the force of a
/// sampled drive is what its controller asks for, as it is recorded.
///
/// # Errors
/// A model that cannot be simulated.
pub fn along(model: &Scenario, machine: Machine, log: &Log) -> Result<Log, CalibrateError> {
    let channels = match machine {
        Machine::Stage => stage_along(model, log)?,
        Machine::Pendulum => vec![(Channel::Pose(2), pendulum_along(model, log)?)],
    };
    Ok(Log::new(&log.name, log.start, log.interval, channels))
}

fn stage_along(model: &Scenario, log: &Log) -> Result<Vec<(Channel, Vec<f64>)>, CalibrateError> {
    let sampled = match drive(model) {
        Drive::Sampled(cascade) => Some(cascade),
        Drive::Prescribed | Drive::Servo { .. } | Drive::Effort => None,
    };
    let commands: Arc<dyn Commands> = match sampled {
        Some(_) => Arc::new(Samples::of(log)),
        None => Arc::new(LoggedCommands::new(log, 1).map_err(|channel| {
            CalibrateError::Input(vec![format!("{}: no column `{channel}`", log.name)])
        })?),
    };
    let mechanism = started(model, [first_length(log), 0.0], commands)?;
    let rows = stage::simulate(&mechanism, model.step_control(), log)?;
    let lengths: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let forces = match sampled {
        Some(cascade) => controller_force(&cascade, log, &lengths),
        None => rows.iter().map(|row| row[1]).collect(),
    };
    Ok(vec![(Channel::Length(0), lengths), (Channel::Force(0), forces)])
}

/// Nothing is commanded.
#[derive(Debug)]
struct Idle;

impl Commands for Idle {
    fn at(&self, _: f64, _: &mut [crate::mechanism::Command]) {}
}

fn pendulum_along(model: &Scenario, log: &Log) -> Result<Vec<f64>, CalibrateError> {
    let angles = log.get(Channel::Pose(2)).unwrap_or_default();
    // What the model cannot take shows here; later it is built the same way.
    let build = |start: [f64; 2]| started(model, start, Arc::new(Idle));
    let mechanism = build([angles[0], 0.0])?;
    let again = |start: [f64; 2]| build(start).unwrap_or_else(|_| mechanism.clone());
    let control = model.step_control();
    let start = swings::start(&again, control, angles, log.interval, PLAN);
    Ok(swings::angles(&again(start), control, start[0], log.interval, log.samples)?)
}
