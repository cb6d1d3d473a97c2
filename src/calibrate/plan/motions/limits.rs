//! What a planned motion may take of a machine: strokes, speeds, accelerations, forces of its drives, and how near it
//! may come to singular poses.

use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::start::commands;
use crate::calibrate::sensed::view::effort_sensor;
use crate::measure::filter::derivative;
use crate::mechanism::{Command, JointIndex, Mechanism, Reads};
use crate::scenario::{Joint, Scenario};
use serde::Serialize;

/// Gain from a drive's error to the machine's fastest point up to which a motion may go: from there on `check` calls a
/// pose doubtful, because forces and errors grow with it.
pub const GAIN: f64 = 50.0;

/// Farthest coordinate in m or rad: commands are written to nine decimals, and doubles hold these up to there.
const FARTHEST: f64 = 1e6;

/// Numbers that a user gave, drive by drive; none where nothing was given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GivenLimits {
    /// Lowest and highest coordinate, m or rad.
    pub stroke: Option<[f64; 2]>,
    /// m/s or rad/s.
    pub speed: Option<f64>,
    /// m/s² or rad/s².
    pub acceleration: Option<f64>,
    /// N or N·m.
    pub force: Option<f64>,
}

/// Limits of one drive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DriveLimits {
    /// Name of its joint.
    pub joint: String,
    /// Unit of its coordinate.
    pub unit: &'static str,
    /// Lowest and highest coordinate.
    pub stroke: [f64; 2],
    /// Largest rate.
    pub speed: f64,
    /// Largest acceleration.
    pub acceleration: f64,
    /// Largest force (N) or torque (N·m) of the drive; none where nothing limits it.
    pub force: Option<f64>,
    /// Where the stroke is from.
    pub stroke_from: &'static str,
    /// Where speed, acceleration and force are from.
    pub from: &'static str,
}

/// What one drive did in recordings.
#[derive(Clone, Copy, Debug)]
struct Used {
    stroke: [f64; 2],
    speed: f64,
    acceleration: f64,
    force: Option<f64>,
}

/// The limits of each drive: what was given, else what the file declares (ranges of joints), else what the recordings
/// went through. What is wrong, one message a problem, where nothing says.
///
/// # Errors
/// A drive of which nothing says how far or how fast it may go, and limits that leave no motion.
pub fn limits(
    rig: &Scenario,
    mechanism: &Mechanism,
    given: &[GivenLimits],
    recordings: &[Recording],
) -> Result<Vec<DriveLimits>, Vec<String>> {
    let mut wrong = Vec::new();
    let mut found = Vec::new();
    for (drive, given) in given.iter().enumerate() {
        let actuator = &mechanism.actuators[drive];
        let joint = mechanism.joint_name(actuator.joint).to_owned();
        let used = used(mechanism, drive, recordings);
        let declared = range(rig, &joint);
        let (stroke, stroke_from) = match (given.stroke, declared, used) {
            (Some(stroke), ..) => (stroke, "given"),
            (None, Some(range), _) => (range, "range of the joint"),
            (None, None, Some(used)) => (used.stroke, "recordings"),
            (None, None, None) => {
                wrong.push(missing(&joint, "how far", "stroke", "LOW..HIGH"));
                continue;
            }
        };
        let speed = given.speed.or(used.map(|used| used.speed));
        let acceleration = given.acceleration.or(used.map(|used| used.acceleration));
        let (Some(speed), Some(acceleration)) = (speed, acceleration) else {
            let flag = if speed.is_none() { "speed" } else { "acceleration" };
            wrong.push(missing(&joint, "how fast", flag, "NUMBER"));
            continue;
        };
        let all = given.speed.is_some() && given.acceleration.is_some();
        let some = given.speed.is_some() || given.acceleration.is_some() || given.force.is_some();
        let from = match (all, some) {
            (true, _) => "given",
            (false, true) => "given, else recordings",
            (false, false) => "recordings",
        };
        let (unit, _) = units(actuator.joint);
        let force = given.force.or(used.and_then(|used| used.force));
        let limit =
            DriveLimits { joint, unit, stroke, speed, acceleration, force, stroke_from, from };
        wrong.extend(limit.leaves_nothing());
        found.push(limit);
    }
    if wrong.is_empty() { Ok(found) } else { Err(wrong) }
}

fn missing(joint: &str, what: &str, flag: &str, value: &str) -> String {
    format!(
        "--{flag}: nothing says {what} the drive of {joint} may go; give --{flag} {joint}={value}, or the present \
         recordings with --data"
    )
}

impl DriveLimits {
    /// What is wrong with limits within which nothing moves.
    fn leaves_nothing(&self) -> Option<String> {
        let Self { joint, unit, stroke: [low, high], speed, acceleration, force, .. } = self;
        let none = |what: &str| {
            Some(format!("--{what}: leaves no motion of {joint}; expected a number above 0"))
        };
        if high <= low {
            return Some(format!(
                "--stroke: from {low} to {high} {unit} leaves no motion of {joint} ({}); expected LOW below HIGH",
                self.stroke_from
            ));
        }
        if low.abs().max(high.abs()) > FARTHEST {
            return Some(format!(
                "--stroke: from {low:e} to {high:e} {unit} of {joint} ({}) leaves what commands can say; expected at most \
                 {FARTHEST:e} {unit} either way",
                self.stroke_from
            ));
        }
        let positive = |value: f64| value > 0.0 && value.is_finite();
        match () {
            () if !positive(*speed) => none("speed"),
            () if !positive(*acceleration) => none("acceleration"),
            () if force.is_some_and(|force| !positive(force)) => none("drive-force"),
            () => None,
        }
    }
}

/// Units of a coordinate and of what acts along it.
pub fn units(joint: JointIndex) -> (&'static str, &'static str) {
    match joint {
        JointIndex::Prismatic(_) => ("m", "N"),
        JointIndex::Revolute(_) => ("rad", "N·m"),
    }
}

/// The range that a file declares for a joint.
fn range(rig: &Scenario, joint: &str) -> Option<[f64; 2]> {
    rig.mechanism.described()?.joints.iter().find_map(|of| match of {
        Joint::Prismatic(prismatic) if prismatic.name == joint => prismatic.range,
        _ => None,
    })
}

/// What a drive was told, row by row, in m or rad; none where a recording does not say.
pub fn positions(mechanism: &Mechanism, drive: usize, recording: &Recording) -> Option<Vec<f64>> {
    let told = |sensor: &crate::mechanism::Sensor| matches!(sensor.reads, Reads::Command(of) if of == drive);
    mechanism.sensors.iter().position(told)?;
    let source = commands(mechanism, recording);
    let mut now = vec![Command::default(); mechanism.actuators.len()];
    let rows = (0..recording.samples).map(|row| {
        source.at(row as f64 * recording.interval, &mut now);
        now[drive].position
    });
    Some(rows.collect())
}

fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, f64::max)
}

/// Largest force (N) or torque (N·m) of a drive in a recording; none where nobody measures it, and where it is zero, as in
/// a recording of commands alone.
pub fn measured(mechanism: &Mechanism, drive: usize, recording: &Recording) -> Option<f64> {
    let force = recording.get(effort_sensor(mechanism, drive)?).map(largest);
    force.filter(|force| *force > 0.0)
}

/// What a drive was told in the recordings, and the largest force that was measured of it.
fn used(mechanism: &Mechanism, drive: usize, recordings: &[Recording]) -> Option<Used> {
    let mut all: Option<Used> = None;
    for recording in recordings {
        let position = positions(mechanism, drive, recording)?;
        // Differences of rows, not the spline's curvature: commands are rounded to nine decimals.
        let rate = derivative(&position, recording.interval);
        let acceleration = derivative(&rate, recording.interval);
        let used = Used {
            stroke: position.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| {
                [low.min(*q), high.max(*q)]
            }),
            speed: largest(&rate),
            acceleration: largest(&acceleration),
            force: measured(mechanism, drive, recording),
        };
        let both = |before: Used| Used {
            stroke: [before.stroke[0].min(used.stroke[0]), before.stroke[1].max(used.stroke[1])],
            speed: before.speed.max(used.speed),
            acceleration: before.acceleration.max(used.acceleration),
            force: before
                .force
                .zip(used.force)
                .map(|(a, b)| a.max(b))
                .or(before.force)
                .or(used.force),
        };
        all = Some(all.map_or(used, both));
    }
    all
}
