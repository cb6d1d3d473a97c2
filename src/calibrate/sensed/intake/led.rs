//! Where the commands of a recording lead the declared machine without play, and whether it can be there.

use super::mistaken::{FollowedColumns, about, rms};
use crate::calibrate::sensed::motion::start;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::thresholds::{ASTRAY, FACTORS};
use crate::calibrate::sensed::windows::plausible::scaled_by;
use crate::measure::log::LogError;
use crate::mechanism::{Drive, Evaluation, Imposed, JointIndex, Mechanism, Reads, Sensor, Tracker};
use crate::scenario::Scenario;

/// Rows at which places are held against each other: a motion of seconds has some turning points.
const LOOKS: usize = 200;

/// Angle in rad by which a body is turned otherwise than anything undeclared turns it: offsets and clearances are thousandths of a
/// machine's size.
const OFF: f64 = 0.015;

/// What speaks against the commands of the first row: another unit than the machine can be in, or no pose that has them.
pub(super) fn commands(
    rig: &Scenario,
    machine: &Mechanism,
    recording: &Recording,
) -> Vec<LogError> {
    let told = |sensor: &Sensor| matches!(sensor.reads, Reads::Command(_));
    let columns: Vec<usize> = (0..machine.sensors.len())
        .filter(|&i| told(&machine.sensors[i]) && recording.get(i).is_some())
        .collect();
    if columns.is_empty() {
        return Vec::new();
    }
    let Err(problem) = start::machine(rig, &[], recording) else { return Vec::new() };
    let scaled = |factor: f64| {
        let column = |i: usize| {
            let factor = if columns.contains(&i) { factor } else { 1.0 };
            recording.get(i).map(|values| values.iter().map(|value| factor * value).collect())
        };
        recording.with((0..machine.sensors.len()).map(column).collect())
    };
    let fits = |factor: &&f64| start::machine(rig, &[], &scaled(**factor)).is_ok();
    let first = |i: usize| {
        let sensor = &machine.sensors[i];
        let value = recording.get(i).and_then(|values| values.first()).copied().unwrap_or_default();
        format!("`{}` starts with {value} {}", sensor.column, sensor.unit(machine))
    };
    let error =
        |message: String, help: String| LogError { place: recording.path.clone(), message, help };
    let Some(factor) = FACTORS.iter().find(fits) else {
        let all: Vec<String> = columns.iter().map(|i| first(*i)).collect();
        let message = format!("no pose of the machine has its first commands: {}", all.join(", "));
        return vec![error(message, format!("is this the rig of that recording? {problem}"))];
    };
    let scaled = |i: usize| {
        let message = format!("column {}, where the machine cannot be", first(i));
        error(message, format!("it can with {}", scaled_by(rig, machine, i, *factor).1))
    };
    columns.into_iter().map(scaled).collect()
}

/// What sensors of places and of joints without drives show beside what commands make of them, each about its mean; none where
/// commands do not determine where the machine is.
pub(super) fn places(
    rig: &Scenario,
    machine: &Mechanism,
    recording: &Recording,
) -> Option<FollowedColumns> {
    let held = |drive: &crate::mechanism::Actuator| {
        matches!(drive.drive, Drive::Servo { .. } | Drive::Prescribed)
    };
    let built = start::machine(rig, &[], recording).ok()?;
    let states: Vec<_> = built.bodies.iter().map(|body| body.start).collect();
    if !built.actuators.iter().all(held) || !built.freedoms(&states).loose.is_empty() {
        return None;
    }
    let ideal = built.without_clearance();
    let mut tracker = Tracker::new(ideal.clone(), Imposed::Drives, states, 0.0).ok()?;
    let of = |sensor: &Sensor| match sensor.reads {
        Reads::Position(joint @ JointIndex::Revolute(_)) => {
            machine.actuators.iter().all(|drive| drive.joint != joint)
        }
        _ => sensor.tracks(),
    };
    let sensors: Vec<usize> = (0..machine.sensors.len())
        .filter(|&i| of(&machine.sensors[i]) && recording.get(i).is_some())
        .collect();
    let now = Evaluation::new(&ideal);
    let mut series = vec![[Vec::new(), Vec::new()]; sensors.len()];
    for row in (0..recording.samples).step_by((recording.samples / LOOKS).max(1)) {
        tracker.advance(row as f64 * recording.interval).ok()?;
        for (&i, [read, like]) in sensors.iter().zip(&mut series) {
            read.push(recording.get(i)?[row]);
            like.push(ideal.sensors[i].reading(&ideal, tracker.states(), tracker.angles(), &now));
        }
    }
    let pair = |(i, [read, like]): (usize, [Vec<f64>; 2])| Some((i, [about(&read), about(&like)]));
    Some(FollowedColumns::of(sensors.into_iter().zip(series).map(pair)))
}

/// Angles that move otherwise than commands lead the machine, by more than half their motion and than anything undeclared could be:
/// they are of another machine. Where points are shown hangs on how their tracker stands as well, which may be anyhow.
pub(super) fn astray(
    machine: &Mechanism,
    recording: &Recording,
    places: &FollowedColumns,
) -> Vec<LogError> {
    let one = |(sensor, series): (&Option<usize>, &Option<[Vec<f64>; 2]>)| {
        let (sensor, [read, like]) = (&machine.sensors[(*sensor)?], series.as_ref()?);
        let missed = rms(read.iter().zip(like).map(|(read, like)| read - like));
        let turns = sensor.unit(machine) == "rad";
        (turns && missed > OFF && missed > ASTRAY * rms(like.iter().copied())).then(|| LogError {
            place: recording.path.clone(),
            message: format!(
                "column `{}` is {missed:.2e} rad (rms) from where the commands lead the declared machine",
                sensor.column
            ),
            help: "is this the rig of that recording, are columns exchanged?".to_owned(),
        })
    };
    places.sensors.iter().zip(&places.series).filter_map(one).collect()
}
