//! A drive stage along a recording.

use crate::calibrate::LoggedCommands;
use crate::calibrate::result::CalibrateError;
use crate::identify::stage::{self, Samples, controller_force, first_length};
use crate::identify::{Missing, Recorded};
use crate::measure::log::{Channel, Log};
use crate::mechanism::{Commands, Drive};
use crate::scenario::{Law, Scenario};
use crate::simulate::{drive, started};
use std::path::Path;
use std::sync::Arc;

/// Shortest recording in s: some turns of a working stroke.
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

/// Reads a recording of a stage by its rig's `[columns]`, and makes sure that it can be one run of it.
/// `calibrate` where the parameters are sought too, which takes every channel.
///
/// # Errors
/// What speaks against it.
pub fn read(path: &Path, rig: &Scenario, calibrate: bool) -> Result<Recorded, CalibrateError> {
    if rig.contact.law == Law::Native {
        let help = "write law = \"ideal\" or \"hertz-step\": a prediction needs a contact law whose error is known";
        return Err(rig.problem("contact.law", "is \"native\"", help).into());
    }
    let needed: &[Channel] = if calibrate { &stage::NEEDED } else { &[Channel::Command(0)] };
    let recorded = Recorded::read(path, rig, needed, &stage::KNOWN)?;
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
    stage::plausible(rig, &recorded)?;
    Ok(recorded)
}

/// Simulates a model along a recording, by its reference from its first length. Without noise; the force of a
/// sampled drive is what its controller asks for, as it is recorded.
///
/// # Errors
/// A model that cannot be simulated.
pub fn along(model: &Scenario, log: &Log) -> Result<Log, CalibrateError> {
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
    let channels = vec![(Channel::Length(0), lengths), (Channel::Force(0), forces)];
    Ok(Log::new(&log.name, log.start, log.interval, channels))
}
