//! Coordinates and poses as sensors and commands show them, as commands and motions of a machine.

use super::law::ServoLaw;
use super::simulate::deviation;
use super::sources::partner;
use crate::calibrate::sensed::recorded::view::{View, effort_sensor};
use crate::measure::filter::derivative;
use crate::mechanism::motion::{Motion, PathPoint};
use crate::mechanism::{Command, Commands, Drive, JointIndex, Mechanism, Reads, TrackerFrame};
use nalgebra::{UnitComplex, Vector2, Vector3};

/// A coordinate in m or rad, its rate and its acceleration, each at every row.
pub type MeasuredCoordinate = [Vec<f64>; 3];

/// Coordinate, rate and acceleration that the sensor of a joint shows at each row.
pub fn coordinate(
    view: &View,
    mechanism: &Mechanism,
    joint: JointIndex,
    sensor: usize,
) -> MeasuredCoordinate {
    let mut position = shown(view, mechanism, sensor);
    if let Some(drive) = mechanism.actuators.iter().position(|drive| drive.joint == joint) {
        behind(view, mechanism, drive, &mut position);
    }
    derived(position, view.interval)
}

/// Coordinate, rate and acceleration that a drive is told at each row, less what it yields: a servo's error e follows
/// from its effort, `k_p e + k_d ė = F`, which is zero where nobody measured it.
pub fn commanded(view: &View, mechanism: &Mechanism, drive: usize) -> MeasuredCoordinate {
    let mut commands = vec![Command::default(); mechanism.actuators.len()];
    let mut told = |row: usize| {
        mechanism.commands.at(row as f64 * view.interval, &mut commands);
        commands[drive].position
    };
    let mut position: Vec<f64> = (0..view.samples()).map(&mut told).collect();
    let effort = effort_sensor(mechanism, drive).filter(|sensor| view.smooth(*sensor).is_some());
    if let (Some(sensor), Drive::Servo { stiffness, damping }) =
        (effort, mechanism.actuators[drive].drive)
    {
        let effort = shown(view, mechanism, sensor);
        // The exact answer of e to an effort that stays as it is between two rows.
        let decay = (-stiffness / damping * view.interval).exp();
        let mut error = effort.first().map_or(0.0, |first| first / stiffness);
        for (position, effort) in position.iter_mut().zip(effort) {
            error = effort / stiffness + (error - effort / stiffness) * decay;
            *position -= error;
        }
    }
    behind(view, mechanism, drive, &mut position);
    derived(position, view.interval)
}

/// Takes from the coordinate of a drive's end what lies between it and its joint: the encoder sits at the drive's end of
/// what gives way. Where the effort is unknown, that is, too.
fn behind(view: &View, mechanism: &Mechanism, drive: usize, position: &mut [f64]) {
    let Some(link) = mechanism.actuators[drive].transmission else { return };
    let Some((effort, noise)) = effort(view, mechanism, drive) else { return };
    position.iter_mut().zip(effort).for_each(|(q, force)| *q -= link.pressed(force, noise));
}

/// Effort of a drive at each row in N or N·m, and its noise: as it was measured, or as a servo makes it of what its encoder shows.
fn effort(view: &View, mechanism: &Mechanism, drive: usize) -> Option<(Vec<f64>, f64)> {
    if let Some(sensor) = effort_sensor(mechanism, drive)
        && let Some(measured) = view.smooth(sensor)
    {
        return Some((measured.to_vec(), deviation(&mechanism.sensors[sensor], measured)));
    }
    let law = ServoLaw::of(view, mechanism, drive, |sensor| view.smooth(sensor))?;
    let mut commands = vec![Command::default(); mechanism.actuators.len()];
    let mut asked = |row: usize| {
        mechanism.commands.at(row as f64 * view.interval, &mut commands);
        law.effort(commands[drive], row)
    };
    let effort = (0..view.samples()).map(&mut asked).collect();
    Some((effort, law.noise))
}

/// What a sensor looked at, smoothed, at each row.
fn shown(view: &View, mechanism: &Mechanism, sensor: usize) -> Vec<f64> {
    let errors = &mechanism.sensors[sensor];
    let read = view.smooth(sensor).unwrap_or_default();
    (0..read.len()).map(|row| view.shown(errors, read, row)).collect()
}

fn derived(position: Vec<f64>, interval: f64) -> MeasuredCoordinate {
    let rate = derivative(&position, interval);
    let acceleration = derivative(&rate, interval);
    [position, rate, acceleration]
}

/// The pose that sensors of x, y and angle show, in the world's axes.
pub fn pose(view: &View, mechanism: &Mechanism, sensors: [usize; 3]) -> MeasuredPose {
    let [x, y, angle] = sensors;
    let [x, y] = point(view, mechanism, [x, y]);
    let columns =
        [x, y, turned(view, mechanism, angle)].map(|column| derived(column, view.interval));
    MeasuredPose { interval: view.interval, columns }
}

/// Angle, rate and acceleration of a body, or one of the coordinates of a point, as the sensor of it shows at each row.
pub fn placed(view: &View, mechanism: &Mechanism, sensor: usize) -> MeasuredCoordinate {
    let other = || partner(mechanism, sensor, |other| view.smooth(other).is_some());
    let column = match mechanism.sensors[sensor].reads {
        Reads::X(_) => other().map(|y| point(view, mechanism, [sensor, y])[0].clone()),
        Reads::Y(_) => other().map(|x| point(view, mechanism, [x, sensor])[1].clone()),
        _ => None,
    };
    derived(column.unwrap_or_else(|| turned(view, mechanism, sensor)), view.interval)
}

/// Coordinates of a point in the world that the sensors of x and y show.
fn point(view: &View, mechanism: &Mechanism, sensors: [usize; 2]) -> [Vec<f64>; 2] {
    let [x, y] = sensors.map(|sensor| shown(view, mechanism, sensor));
    let frames = &mechanism.sensors[sensors[0]].frames;
    let places = x.iter().zip(&y).map(|(x, y)| {
        frames.iter().rev().fold(Vector2::new(*x, *y), |point, frame| of_world(frame, point))
    });
    let (x, y) = places.map(|point| (point.x, point.y)).unzip();
    [x, y]
}

/// Angle of a body in the world that a sensor shows.
fn turned(view: &View, mechanism: &Mechanism, sensor: usize) -> Vec<f64> {
    let turned: f64 = mechanism.sensors[sensor].frames.iter().map(|f| f.rotation).sum();
    shown(view, mechanism, sensor).iter().map(|angle| angle - turned).collect()
}

/// The point of the world that a tracker's frame shows at `point` (m).
fn of_world(frame: &TrackerFrame, point: Vector2<f64>) -> Vector2<f64> {
    UnitComplex::new(-frame.rotation) * (point - frame.shift) / frame.scale
}

/// Position, rate and acceleration of each row, between rows on straight lines.
fn between(columns: &MeasuredCoordinate, place: f64) -> [f64; 3] {
    let last = columns[0].len().saturating_sub(1);
    let i = (place.max(0.0) as usize).min(last);
    let (next, share) = ((i + 1).min(last), (place.max(0.0) - i as f64).min(1.0));
    columns.each_ref().map(|c| c[i] + (c[next] - c[i]) * share)
}

/// Measured coordinates as commands.
#[derive(Debug)]
pub struct MeasuredCommands {
    pub interval: f64,
    pub columns: Vec<MeasuredCoordinate>,
}

impl Commands for MeasuredCommands {
    fn at(&self, t: f64, commands: &mut [Command]) {
        for (command, columns) in commands.iter_mut().zip(&self.columns) {
            let [position, rate, acceleration] = between(columns, t / self.interval);
            *command = Command { position, rate, acceleration };
        }
    }
}

/// A measured pose as a motion.
#[derive(Debug)]
pub struct MeasuredPose {
    pub interval: f64,
    pub columns: [MeasuredCoordinate; 3],
}

impl Motion for MeasuredPose {
    fn at(&self, t: f64) -> PathPoint {
        let now = self.columns.each_ref().map(|columns| between(columns, t / self.interval));
        let of = |k: usize| Vector3::from(now.map(|values| values[k]));
        PathPoint { pose: of(0), rate: of(1), acceleration: of(2) }
    }
}
