//! Forces of a log held against those of the declared model and of the servos' own law: another order of magnitude
//! is another unit, another sign or another leg's force a mix-up.

use crate::measure::filter::ZeroPhase;
use crate::measure::log::{Channel, Log, LogError};
use crate::scenario::{Drive, DriveMode};

/// Low-passed forces beyond these multiples of the declared model's are in another unit. Downwards
/// nothing physical leads so far; upwards friction might, so that the servo's own law has to agree.
const SMALL: f64 = 1.0 / 100.0;
const LARGE: f64 = 200.0;

/// So many times the force that the servo's law gives is no force in N: gains may be wrong, but not so.
const BEYOND_LAW: f64 = 30.0;

/// Corner of that low-pass in Hz: most of a rattle and of a sensor's noise lies above.
const CORNER: f64 = 25.0;

/// A measured force is what a servo's law gives where they differ by less than this share of it: gains of sensors
/// and servos are wrong by a tenth, lags and noise come to a few hundredths.
const BY_LAW: f64 = 0.3;

/// Two forces are exchanged where each misses its own law by so many times what it misses the other's by.
const EXCHANGED: f64 = 3.0;

/// Root mean square.
fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

/// Forces with the wrong sign, or of another leg: of servos, whose law says what they should be.
pub fn mixed_up(path: &str, log: &Log, drive: &Drive) -> Vec<LogError> {
    let filter = ZeroPhase::butterworth(4, CORNER, log.interval);
    let leg = |leg: usize| {
        let (force, law) = (log.get(Channel::Force(leg))?, servo(log, drive, leg)?);
        Some([filter.apply(force), filter.apply(&law)])
    };
    let legs: Vec<Option<[Vec<f64>; 2]>> = (0..3).map(leg).collect();
    // What force `i` misses the law of leg `j` by, as a share of that law.
    let missed = |i: usize, j: usize, sign: f64| {
        let ([force, _], [_, law]) = (legs[i].as_ref()?, legs[j].as_ref()?);
        let apart = force.iter().zip(law).map(|(force, law)| force - sign * law);
        Some(rms(apart) / rms(law.iter().copied()))
    };
    let wrong = |message: String, help: &str| LogError {
        place: path.to_owned(),
        message,
        help: help.to_owned(),
    };
    let mut found = Vec::new();
    for i in 0..3 {
        if missed(i, i, -1.0).is_some_and(|share| share < BY_LAW) {
            let message = format!(
                "column `{}` has the opposite sign of what its drive's law gives",
                Channel::Force(i)
            );
            found.push(wrong(message, "a force is positive where it lengthens the leg"));
        }
        for j in i + 1..3 {
            let exchanged = |a, b| {
                let (other, own) = (missed(a, b, 1.0)?, missed(a, a, 1.0)?);
                Some(other < BY_LAW && own > EXCHANGED * other)
            };
            if exchanged(i, j) == Some(true) && exchanged(j, i) == Some(true) {
                let (a, b) = (Channel::Force(i), Channel::Force(j));
                let message =
                    format!("columns `{a}` and `{b}` each hold what the other's drive gives");
                found.push(wrong(message, "exchange the two columns"));
            }
        }
    }
    found
}

/// Forces of another order of magnitude than the declared model's, whose noiseless log is given.
pub fn forces(path: &str, log: &Log, declared: &Log, drive: &Drive) -> Vec<LogError> {
    let filter = ZeroPhase::butterworth(4, CORNER, log.interval);
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
    found
}

/// The force of a servo in N by its own law, `k_p (q_cmd − q)`; its damping is small where motion is slow.
fn servo(log: &Log, drive: &Drive, leg: usize) -> Option<Vec<f64>> {
    if drive.mode != DriveMode::Servo {
        return None;
    }
    let (command, length) = (log.get(Channel::Command(leg))?, log.get(Channel::Length(leg))?);
    Some(command.iter().zip(length).map(|(c, q)| drive.stiffness * (c - q)).collect())
}
