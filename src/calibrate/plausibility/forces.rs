//! Forces of a log held against those of the declared model and of the servos' own law: another order of magnitude
//! is another unit, another sign or another leg's force a mix-up.

use crate::calibrate::measured::mistaken::{Mistake, mistakes, rms};
use crate::calibrate::sensed::thresholds::ERROR_CORNER;
use crate::measure::filter::ZeroPhase;
use crate::measure::log::{Channel, Log, LogError};
use crate::scenario::{Drive, DriveMode};

/// Low-passed forces beyond these multiples of the declared model's are in another unit. Downwards
/// nothing physical leads so far; upwards friction might, so that the servo's own law has to agree.
const SMALL: f64 = 1.0 / 100.0;
const LARGE: f64 = 200.0;

/// So many times the force that the servo's law gives is no force in N: gains may be wrong, but not so.
const BEYOND_LAW: f64 = 30.0;

/// Forces with the wrong sign, or of another leg: of servos, whose law says what they should be.
pub fn mixed_up(path: &str, log: &Log, drive: &Drive) -> Vec<LogError> {
    let filter = ZeroPhase::butterworth(4, ERROR_CORNER, log.interval);
    let leg = |leg: usize| {
        let (force, law) = (log.get(Channel::Force(leg))?, servo(log, drive, leg)?);
        Some([filter.apply(force), filter.apply(&law)])
    };
    let legs: Vec<Option<[Vec<f64>; 2]>> = (0..3).map(leg).collect();
    let name = |leg: usize| Channel::Force(leg);
    // Another unit is another order of magnitude than the model's.
    let found = mistakes(&legs, &[]).into_iter().filter_map(|mistake| {
        let (message, help) = match mistake {
            Mistake::Sign(i) => (
                format!("column `{}` has the opposite sign of what its drive's law gives", name(i)),
                "a force is positive where it lengthens the leg; a command and a length that are \
                 exchanged look alike",
            ),
            Mistake::Exchanged(i, j) => (
                format!(
                    "columns `{}` and `{}` each hold what the other's drive gives",
                    name(i),
                    name(j)
                ),
                "exchange the two columns",
            ),
            Mistake::Unit(..) => return None,
        };
        Some(LogError { place: path.to_owned(), message, help: help.to_owned() })
    });
    found.collect()
}

/// Forces of another order of magnitude than the declared model's, whose noiseless log is given.
pub fn forces(path: &str, log: &Log, declared: &Log, drive: &Drive) -> Vec<LogError> {
    let filter = ZeroPhase::butterworth(4, ERROR_CORNER, log.interval);
    let size = |values: &[f64]| rms(filter.apply(values).iter().copied());
    let mut found = Vec::new();
    for leg in 0..3 {
        let channel = Channel::Force(leg);
        let (Some(measured), Some(expected)) = (log.get(channel), declared.get(channel)) else {
            continue;
        };
        let (measured, expected) = (size(measured), size(expected));
        let by_law = servo(log, drive, leg).map(|force| size(&force));
        let unit = if measured < SMALL * expected {
            Some(("kN", 1e3))
        } else if measured > LARGE * expected
            && by_law.is_none_or(|by_law| measured > BEYOND_LAW * by_law)
        {
            Some(("mN", 1e-3))
        } else {
            None
        };
        if let Some((unit, factor)) = unit {
            found.push(LogError {
                place: path.to_owned(),
                message: format!(
                    "column `{channel}` is of the order of {measured:.1e}, where the declared model \
                     takes {expected:.1e} N: is it in {unit}?"
                ),
                help: format!("write it in N: multiply by {factor}"),
            });
        }
    }
    if found.is_empty() {
        found.extend(stiffness(path, log, drive, &size));
    }
    found
}

/// A servo's stiffness in another unit: forces are what the machine takes, and each of them far from what the declared
/// servo makes of its command and length.
fn stiffness(
    path: &str,
    log: &Log,
    drive: &Drive,
    size: &dyn Fn(&[f64]) -> f64,
) -> Option<LogError> {
    let times = |leg: usize| {
        let (force, law) = (log.get(Channel::Force(leg))?, servo(log, drive, leg)?);
        Some(size(force) / size(&law))
    };
    let times: Vec<f64> = (0..3).filter_map(times).collect();
    let least = times.iter().copied().fold(f64::INFINITY, f64::min);
    let most = times.iter().copied().fold(0.0, f64::max);
    let beyond = least > BEYOND_LAW || most < 1.0 / BEYOND_LAW;
    (beyond && !times.is_empty()).then(|| LogError {
        place: path.to_owned(),
        message: format!(
            "forces are {least:.2e} to {most:.2e} times what the declared servo makes of commands and lengths"
        ),
        help: format!("is drive.stiffness = {:e} in N/m, and drive.damping in N s/m?", drive.stiffness),
    })
}

/// The force of a servo in N by its own law, `k_p (q_cmd − q)`; its damping is small where motion is slow.
fn servo(log: &Log, drive: &Drive, leg: usize) -> Option<Vec<f64>> {
    if drive.mode != DriveMode::Servo {
        return None;
    }
    let (command, length) = (log.get(Channel::Command(leg))?, log.get(Channel::Length(leg))?);
    Some(command.iter().zip(length).map(|(c, q)| drive.stiffness * (c - q)).collect())
}
