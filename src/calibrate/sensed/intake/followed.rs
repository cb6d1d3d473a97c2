//! Whether recordings of a machine that follows commands can be what they are said to be: readings of driven joints held
//! against their commands, efforts against the law of their servos.

use crate::calibrate::measured::mistaken::{Mistake, mistakes, rms};
use crate::calibrate::sensed::motion::start::told_by;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::{effort_sensor, position_sensor};
use crate::calibrate::sensed::thresholds::ERROR_CORNER;
use crate::calibrate::sensed::thresholds::FACTORS;
use crate::calibrate::sensed::windows::plausible::scaled_by;
use crate::measure::filter::ZeroPhase;
use crate::measure::log::LogError;
use crate::mechanism::{Drive, Mechanism, Reads};
use crate::scenario::Scenario;

/// Share of its command's motion below which a reading stands still: far below what any drive gives.
const STILL: f64 = 1e-3;

/// Columns beside what they should be like, drive by drive.
struct FollowedColumns {
    sensors: Vec<Option<usize>>,
    series: Vec<Option<[Vec<f64>; 2]>>,
}

/// What speaks against a recording of a rig's machine.
pub fn wrong(rig: &Scenario, machine: &Mechanism, recording: &Recording) -> Vec<LogError> {
    let readings = readings(machine, recording);
    let mut found = still(machine, recording, &readings);
    // Of efforts nothing is known where readings are wrong.
    if found.is_empty() {
        found = mistaken(rig, machine, recording, &readings, "the command");
    }
    if found.is_empty() {
        let efforts = efforts(machine, recording);
        found = mistaken(rig, machine, recording, &efforts, "the servo's law");
    }
    found
}

/// Readings of driven joints beside their commands, each about its mean: a zero is an instrument's own affair.
fn readings(machine: &Mechanism, recording: &Recording) -> FollowedColumns {
    let about = |values: &[f64]| -> Vec<f64> {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| value - mean).collect()
    };
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
    let nyquist = 0.5 / recording.interval;
    let filter = (ERROR_CORNER < 0.9 * nyquist)
        .then(|| ZeroPhase::butterworth(4, ERROR_CORNER, recording.interval));
    let slow = |values: &[f64]| filter.as_ref().map_or(values.to_vec(), |f| f.apply(values));
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

impl FollowedColumns {
    fn of(drives: impl Iterator<Item = Option<(usize, [Vec<f64>; 2])>>) -> Self {
        let (sensors, series) =
            drives.map(|found| (found.as_ref().map(|(s, _)| *s), found.map(|(_, s)| s))).unzip();
        Self { sensors, series }
    }
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
                "turn its sign: it counts in the direction of its joint's coordinate; a command and an encoder that \
                 are exchanged look alike"
                    .to_owned(),
            ),
            Mistake::Unit(i, factor) => {
                let (_, scale) = scaled_by(rig, machine, sensor(i), factor);
                let message =
                    format!("column `{}` is what {against} says in another unit", head(i));
                (message, format!("it would fit with {scale}"))
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
