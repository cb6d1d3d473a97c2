//! The machine where a recording begins.

use super::sources::{CoordinateSource, sources};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::position_sensor;
use crate::effects::Setting;
use crate::engine::{Halt, Schedule, StepControl, run};
use crate::measure::spline::CubicSpline;
use crate::mechanism::{
    Actuator, BodyState, Command, Commands, Drive, Idle, JointIndex, Load, Mechanism, Reads,
    Sensor, Situation,
};
use crate::model::recorded;
use crate::scenario::{Problem, Scenario};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Time in s for which a driven machine was held at its first command before a recording begins.
pub const LEAD: f64 = 0.25;

/// Time in s over which the first coordinates of a free machine are taken, that fall away from rest with the
/// square of time: short beside its swing, and enough rows to average a sensor's steps.
const FIRST: f64 = 0.012;

/// Why a machine cannot be put where a recording begins.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The machine cannot be.
    #[error("{0}")]
    Model(#[from] Problem),
    /// It breaks down while it is held.
    #[error("{0}")]
    Halted(#[from] Halt),
}

/// What a recording says that a drive was told.
#[derive(Debug)]
enum Told {
    /// A command between whose rows it goes along a cubic spline; it rests before them and after them.
    Smooth(CubicSpline),
    /// What a sampled controller saw, held from row to row: its command, and what was added to its output in V.
    Held { command: Vec<f64>, added: Vec<f64>, interval: f64 },
    /// Nothing.
    Nothing,
}

/// The value at time `t` (s) of samples that are held over `interval` s.
fn held_at(samples: &[f64], interval: f64, t: f64) -> Option<f64> {
    let row = (t / interval).round().max(0.0) as usize;
    samples.get(row.min(samples.len().saturating_sub(1))).copied()
}

/// Commands of a recording.
#[derive(Debug)]
struct RecordedCommands(Vec<Told>);

impl Commands for RecordedCommands {
    fn at(&self, t: f64, commands: &mut [Command]) {
        for (told, to) in self.0.iter().zip(commands) {
            match told {
                Told::Smooth(spline) => {
                    // The last row may be reached a rounding error late.
                    let end = spline.end();
                    let t = if t > end && t < end * (1.0 + 1e-9) { end } else { t };
                    let [position, rate, acceleration] = spline.at(t);
                    *to = Command { position, rate, acceleration };
                }
                Told::Held { command, interval, .. } => {
                    let position = held_at(command, *interval, t).unwrap_or_default();
                    *to = Command { position, ..Command::default() };
                }
                Told::Nothing => {}
            }
        }
    }

    fn added(&self, index: usize, t: f64) -> f64 {
        match self.0.get(index) {
            Some(Told::Held { added, interval, .. }) => {
                held_at(added, *interval, t).unwrap_or_default()
            }
            _ => 0.0,
        }
    }
}

/// Commands of a recording for a machine with these drives.
pub fn commands(mechanism: &Mechanism, recording: &Recording) -> Arc<dyn Commands> {
    if mechanism.actuators.is_empty() {
        return Arc::new(Idle);
    }
    let interval = recording.interval;
    let t: Vec<f64> = (0..recording.samples).map(|i| i as f64 * interval).collect();
    let told = |drive: usize| {
        let Some(command) = told_by(mechanism, recording, Reads::Command(drive)) else {
            return Told::Nothing;
        };
        if let Drive::Sampled(_) = mechanism.actuators[drive].drive {
            let added = told_by(mechanism, recording, Reads::Added(drive));
            let added = added.unwrap_or_default().to_vec();
            return Told::Held { command: command.to_vec(), added, interval };
        }
        Told::Smooth(CubicSpline::natural(&t, command))
    };
    Arc::new(RecordedCommands((0..mechanism.actuators.len()).map(told).collect()))
}

/// The column of a recording that holds what a drive was told.
pub(in crate::calibrate::sensed) fn told_by<'a>(
    mechanism: &Mechanism,
    recording: &'a Recording,
    what: Reads,
) -> Option<&'a [f64]> {
    let same = |reads: &Reads| match (reads, what) {
        (Reads::Command(a), Reads::Command(b)) | (Reads::Added(a), Reads::Added(b)) => *a == b,
        _ => false,
    };
    let mut sensors = mechanism.sensors.iter();
    recording.get(sensors.position(|sensor| same(&sensor.reads))?)
}

/// A joint that no drive moves and that is held at a coordinate.
pub(super) struct HeldJoint {
    /// The joint.
    pub joint: JointIndex,
    /// The coordinate in m or rad.
    pub value: f64,
    /// The sensor that shows it.
    pub sensor: usize,
}

/// Joints that no drive moves and that are measured, at their coordinates at the first row, by sensor.
fn measured_joints(mechanism: &Mechanism, recording: &Recording) -> Vec<HeldJoint> {
    let sensors = mechanism.sensors.iter().enumerate();
    let found = sensors.filter_map(|(sensor, errors)| {
        let Reads::Position(joint) = errors.reads else { return None };
        let driven = mechanism.actuators.iter().any(|drive| drive.joint == joint);
        let value = first(recording, sensor, errors)?;
        (!driven).then_some(HeldJoint { joint, value, sensor })
    });
    found.collect()
}

/// Joints that only angles and places of bodies show, which turn as far from their start as an angle does; by how much the
/// machine before them moves, that is wrong.
fn seen_joints(mechanism: &Mechanism, recording: &Recording) -> Vec<HeldJoint> {
    let sources = sources(mechanism, recording).unwrap_or_default().into_iter();
    let seen = sources.filter_map(|(joint, source)| {
        let CoordinateSource::Place(sensor) = source else { return None };
        let errors = &mechanism.sensors[sensor];
        let turned = match errors.reads {
            Reads::Angle(Some(body), angle) => {
                first(recording, sensor, errors)? - angle - mechanism.bodies[body].angle
            }
            _ => 0.0,
        };
        Some(HeldJoint { joint, value: mechanism.start_coordinate(joint) + turned, sensor })
    });
    seen.collect()
}

/// What a sensor looked at in the first row, of something that begins at rest.
fn first(recording: &Recording, sensor: usize, errors: &Sensor) -> Option<f64> {
    let rows = ((FIRST / recording.interval) as usize + 1).clamp(1, recording.samples);
    let read = from_rest(&recording.get(sensor)?[..rows]);
    Some((read - errors.offset) / errors.scale)
}

/// The `a` of `a + b k²`, by least squares over samples k = 0, 1, …
fn from_rest(values: &[f64]) -> f64 {
    let [mut n, mut s2, mut s4, mut y, mut y2] = [0.0; 5];
    for (k, value) in values.iter().enumerate() {
        let k2 = (k * k) as f64;
        n += 1.0;
        s2 += k2;
        s4 += k2 * k2;
        y += value;
        y2 += k2 * value;
    }
    let determinant = n * s4 - s2 * s2;
    if determinant > 0.0 { (s4 * y - s2 * y2) / determinant } else { y / n }
}

/// Commands of drives, and of what holds joints at constant coordinates after them.
#[derive(Debug)]
struct Holding {
    drives: Arc<dyn Commands>,
    count: usize,
    held: Vec<f64>,
}

impl Commands for Holding {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let (drives, held) = commands.split_at_mut(self.count.min(commands.len()));
        self.drives.at(t, drives);
        for (command, position) in held.iter_mut().zip(&self.held) {
            *command = Command { position: *position, ..Command::default() };
        }
    }

    fn added(&self, index: usize, t: f64) -> f64 {
        self.drives.added(index, t)
    }
}

/// Puts drives with sampled controllers where their encoders show them at the first row, which need not be where they
/// are told to be; others stay at their commands.
pub(super) fn placed(mechanism: &mut Mechanism, recording: &Recording) {
    let mut first = vec![Command::default(); mechanism.actuators.len()];
    mechanism.commands.at(0.0, &mut first);
    for (drive, first) in mechanism.actuators.iter().zip(&mut first) {
        let sensor = position_sensor(mechanism, drive.joint);
        let read = sensor.and_then(|sensor| Some((sensor, *recording.get(sensor)?.first()?)));
        if let (Drive::Sampled(_), Some((sensor, value))) = (drive.drive, read) {
            let Sensor { offset, scale, .. } = mechanism.sensors[sensor];
            first.position = (value - offset) / scale;
        }
    }
    let commands = std::mem::replace(&mut mechanism.commands, Arc::new(FixedCommands(first)));
    // What cannot be closed there stays where it is told to be.
    let starts: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
    if mechanism.close(0.0).is_err() {
        mechanism.bodies.iter_mut().zip(starts).for_each(|(body, start)| body.start = start);
    }
    mechanism.commands = commands;
}

/// Commands that stay.
#[derive(Debug)]
struct FixedCommands(Vec<Command>);

impl Commands for FixedCommands {
    fn at(&self, _: f64, commands: &mut [Command]) {
        commands.copy_from_slice(&self.0);
    }
}

/// A recorded machine with these effects, closed at its first row, and the joints that hold it there beside its
/// drives.
pub(super) struct Closed {
    /// The machine, its drives first.
    pub mechanism: Mechanism,
    /// Those joints.
    pub held: Vec<HeldJoint>,
}

/// That machine; the joints are held where they are measured or seen, or at these `known` coordinates.
///
/// # Errors
/// An effect that the machine cannot take, joints that do not close.
pub(super) fn closed(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
    known: Option<&[f64]>,
) -> Result<Closed, Problem> {
    let mut scenario = rig.clone();
    let acting = rig.effects.iter().chain(effects).filter(|e| e.acts_in(&recording.name));
    scenario.effects = acting.cloned().collect();
    let mut held = Vec::new();
    let mechanism = recorded(&scenario, &mut |mechanism| {
        mechanism.commands = commands(mechanism, recording);
        mechanism.epoch = 0.0;
        let starts: Vec<_> = mechanism.bodies.iter().map(|body| body.start).collect();
        // Joints that drives leave free start where they are measured, as far as they are independent.
        let mut hold = |mechanism: &mut Mechanism, joint: HeldJoint| {
            let drive = Actuator::new("", joint.joint, Drive::Prescribed);
            mechanism.actuators.push(drive);
            if mechanism.freedoms(&starts).overdriven.is_empty() {
                let value = known.and_then(|known| known.get(held.len()).copied());
                held.push(HeldJoint { value: value.unwrap_or(joint.value), ..joint });
            } else {
                mechanism.actuators.pop();
            }
        };
        for joint in measured_joints(mechanism, recording) {
            hold(mechanism, joint);
        }
        let freedoms = mechanism.freedoms(&starts);
        if freedoms.driven < freedoms.free {
            for joint in seen_joints(mechanism, recording) {
                hold(mechanism, joint);
            }
        }
        let count = mechanism.actuators.len() - held.len();
        mechanism.commands = Arc::new(Holding {
            drives: Arc::clone(&mechanism.commands),
            count,
            held: held.iter().map(|joint| joint.value).collect(),
        });
    })?;
    Ok(Closed { mechanism, held })
}

/// Lets go of what held joints. Commands stay what effects made of them, which a delay does.
pub(super) fn release(mechanism: &mut Mechanism, held: usize) {
    let drives = mechanism.actuators.len() - held;
    mechanism.actuators.truncate(drives);
}

/// The machine of a rig with these effects at the first row of a recording, to be looked at.
///
/// # Errors
/// An effect that the machine cannot take, joints that do not close.
pub fn machine(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
) -> Result<Mechanism, Problem> {
    let Closed { mut mechanism, held } = closed(rig, effects, recording, None)?;
    release(&mut mechanism, held.len());
    Ok(mechanism)
}

/// Swing in Hz that dies fastest while a machine comes to rest, critically damped: light bodies in play of
/// 0.1 mm swing at 30–60 Hz.
pub(super) const SWING: f64 = 40.0;

/// Time in s from rest to the first row.
const SHORT: f64 = 0.03;

/// `f = −D v` on every body, D its mass or moment of inertia times a rate.
#[derive(Debug)]
pub(super) struct CalmedBodies {
    /// The rate in 1/s: twice the angular frequency that is damped critically.
    pub rate: f64,
}

impl Load for CalmedBodies {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let bodies = at.mechanism.bodies.iter().zip(at.states);
        for (wrench, (body, state)) in wrenches.iter_mut().zip(bodies) {
            let masses = Vector3::new(body.mass, body.mass, body.inertia);
            *wrench -= masses.component_mul(&state.twist) * self.rate;
        }
    }

    fn longest_step(&self, _mechanism: &Mechanism) -> Option<f64> {
        Some(1.0 / self.rate)
    }
}

/// A released machine at rest under its first commands, shortly before the first row: its swing is damped away.
/// None of one that begins at the first row.
///
/// # Errors
/// A run that broke down.
pub fn still(released: &Mechanism, control: StepControl) -> Result<Option<Mechanism>, Halt> {
    let duration = -released.epoch - SHORT;
    if duration <= 0.0 {
        return Ok(None);
    }
    let mut calmed = released.clone();
    calmed.loads.push(Arc::new(CalmedBodies { rate: 2.0 * TAU * SWING }));
    let mut machine = released.clone();
    run(&calmed, control, Schedule { duration, interval: duration }, &mut |instant| {
        for (i, body) in machine.bodies.iter_mut().enumerate() {
            (body.start, body.angle) = (instant.states[i], instant.angles[i]);
        }
    })?;
    machine.epoch = -SHORT;
    Ok(Some(machine))
}
