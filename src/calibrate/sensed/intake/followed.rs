//! Whether recordings of a machine that follows commands can be what they are said to be: readings of driven joints held
//! against their commands, places against where commands lead the machine, efforts against the law of their servos.

use super::led;
use super::mistaken::{FollowedColumns, Mistake, about, mistakes, rms};
use crate::calibrate::sensed::motion::start::told_by;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::{effort_sensor, position_sensor};
use crate::calibrate::sensed::thresholds::ERROR_CORNER;
use crate::calibrate::sensed::thresholds::FACTORS;
use crate::calibrate::sensed::values::errors::mean;
use crate::calibrate::sensed::windows::plausible::scaled_by;
use crate::measure::filter::ZeroPhase;
use crate::measure::log::LogError;
use crate::mechanism::{Drive, Mechanism, Reads, Sensor};
use crate::scenario::Scenario;

/// Share of its command's motion below which a reading stands still: far below what any drive gives.
const STILL: f64 = 1e-3;

/// What speaks against a recording of a rig's machine.
pub fn wrong(rig: &Scenario, machine: &Mechanism, recording: &Recording) -> Vec<LogError> {
    let commands = led::commands(rig, machine, recording);
    if !commands.is_empty() {
        return commands;
    }
    let readings = readings(machine, recording);
    let mut found = still(machine, recording, &readings);
    found.extend(dead(machine, recording));
    // Of places nothing is known where readings are wrong, of efforts where either are.
    if found.is_empty() {
        found = mistaken(rig, machine, recording, &readings, "the command");
    }
    if found.is_empty()
        && let Some(places) = led::places(rig, machine, recording)
    {
        found = mistaken(rig, machine, recording, &places, "the commands' own motion");
        if found.is_empty() {
            found = led::astray(machine, recording, &places);
        }
    }
    if found.is_empty() {
        let efforts = efforts(machine, recording);
        found = mistaken(rig, machine, recording, &efforts, "the servo's law");
    }
    found
}

/// Readings of driven joints beside their commands, each about its mean: a zero is an instrument's own affair.
fn readings(machine: &Mechanism, recording: &Recording) -> FollowedColumns {
    let of = |(index, drive): (usize, &crate::mechanism::Actuator)| {
        let follows = matches!(drive.drive, Drive::Servo { .. } | Drive::Prescribed);
        let sensor = position_sensor(machine, drive.joint).filter(|_| follows)?;
        let command = told_by(machine, recording, Reads::Command(index))?;
        Some((sensor, [about(recording.get(sensor)?), about(command)]))
    };
    FollowedColumns::of(machine.actuators.iter().enumerate().map(of))
}

/// Efforts of servos beside `k_p (q_cmd − q)`; their damping is small where motion is slow.
fn efforts(machine: &Mechanism, recording: &Recording) -> FollowedColumns {
    let slow = slow(recording);
    let of = |(index, drive): (usize, &crate::mechanism::Actuator)| {
        let Drive::Servo { stiffness, .. } = drive.drive else { return None };
        let sensor = effort_sensor(machine, index)?;
        let command = told_by(machine, recording, Reads::Command(index))?;
        let read = recording.get(position_sensor(machine, drive.joint)?)?;
        let law: Vec<f64> = command.iter().zip(read).map(|(c, q)| stiffness * (c - q)).collect();
        Some((sensor, [slow(recording.get(sensor)?), slow(&law)]))
    };
    FollowedColumns::of(machine.actuators.iter().enumerate().map(of))
}

/// What speaks against efforts and accelerations of a recording beside those that simulations of the machine predict.
pub(in crate::calibrate::sensed) fn unlike(
    rig: &Scenario,
    machine: &Mechanism,
    recording: &Recording,
    simulated: &[Recording],
) -> Vec<LogError> {
    let slow = slow(recording);
    let expected = mean(simulated, machine.sensors.len());
    let of = |(i, sensor): (usize, &Sensor)| {
        matches!(sensor.reads, Reads::Effort(_) | Reads::Acceleration(..)).then_some(())?;
        Some((i, [slow(recording.get(i)?), slow(expected.get(i)?)]))
    };
    let columns = FollowedColumns::of(machine.sensors.iter().enumerate().map(of));
    mistaken(rig, machine, recording, &columns, "the simulated machine")
}

/// Values through the low-pass that errors are looked at through, where the rate allows it.
fn slow(recording: &Recording) -> impl Fn(&[f64]) -> Vec<f64> {
    let nyquist = 0.5 / recording.interval;
    let filter = (ERROR_CORNER < 0.9 * nyquist)
        .then(|| ZeroPhase::butterworth(4, ERROR_CORNER, recording.interval));
    move |values| filter.as_ref().map_or(values.to_vec(), |f| f.apply(values))
}

/// Readings that stand still while their drives are told to move.
fn still(machine: &Mechanism, recording: &Recording, readings: &FollowedColumns) -> Vec<LogError> {
    let size = |values: &[f64]| rms(values.iter().copied());
    let pairs = readings.sensors.iter().zip(&readings.series);
    pairs
        .filter_map(|(sensor, series)| {
            let (sensor, [read, command]) = ((*sensor)?, series.as_ref()?);
            (size(read) < STILL * size(command)).then(|| LogError {
                place: recording.path.clone(),
                message: format!(
                    "column `{}` stands still while its drive is told to move",
                    machine.sensors[sensor].column
                ),
                help: "leave the column out if its sensor was not connected".to_owned(),
            })
        })
        .collect()
}

/// What else would make an effort fit: another stiffness of its servo.
fn softer(machine: &Mechanism, sensor: usize, factor: f64) -> String {
    let Reads::Effort(drive) = machine.sensors[sensor].reads else { return String::new() };
    let Drive::Servo { stiffness, .. } = machine.actuators[drive].drive else {
        return String::new();
    };
    format!(", or with a servo of stiffness {:e} in place of {stiffness:e}", stiffness / factor)
}

/// Columns of sensors whose noise is larger than their steps and that hold one number while drives are told to move:
/// noise alone would change it.
fn dead(machine: &Mechanism, recording: &Recording) -> Vec<LogError> {
    let constant = |values: &[f64]| values.iter().all(|value| *value == values[0]);
    let told = |drive| told_by(machine, recording, Reads::Command(drive));
    let moves = (0..machine.actuators.len()).filter_map(told).any(|command| !constant(command));
    let noisy = |sensor: &Sensor| sensor.std > sensor.resolution && !sensor.tells();
    let sensors = machine.sensors.iter().enumerate().filter(|(_, sensor)| moves && noisy(sensor));
    let found = sensors.filter(|(i, _)| recording.get(*i).is_some_and(constant));
    found
        .map(|(_, sensor)| LogError {
            place: recording.path.clone(),
            message: format!(
                "column `{}` never changes while the commands do, not even by its noise",
                sensor.column
            ),
            help: "is the sensor connected? leave out the columns that were not measured"
                .to_owned(),
        })
        .collect()
}

fn mistaken(
    rig: &Scenario,
    machine: &Mechanism,
    recording: &Recording,
    columns: &FollowedColumns,
    against: &str,
) -> Vec<LogError> {
    let sensor = |place: usize| columns.sensors[place].unwrap_or_default();
    let head = |place: usize| machine.sensors[sensor(place)].column.as_str();
    let found = mistakes(&columns.series, &FACTORS).into_iter().map(|mistake| {
        let (message, help) = match mistake {
            Mistake::Sign(i) => (
                format!("column `{}` has the opposite sign of what {against} says", head(i)),
                match machine.sensors[sensor(i)].reads {
                    Reads::Position(_) | Reads::Effort(_) => {
                        "turn its sign: it counts in the direction of its joint's coordinate; a command and an encoder \
                         that are exchanged look alike"
                    }
                    _ => "turn its sign: it counts along the axes of the world, angles counterclockwise",
                }
                .to_owned(),
            ),
            Mistake::Unit(i, factor) => {
                let (_, scale) = scaled_by(rig, machine, sensor(i), factor);
                let message =
                    format!("column `{}` is what {against} says in another unit", head(i));
                (message, format!("it would fit with {scale}{}", softer(machine, sensor(i), factor)))
            }
            Mistake::Exchanged(i, j) => (
                format!(
                    "columns `{}` and `{}` are each what {against} says of the other's drive",
                    head(i),
                    head(j)
                ),
                "exchange the two columns".to_owned(),
            ),
        };
        LogError { place: recording.path.clone(), message, help }
    });
    found.collect()
}
