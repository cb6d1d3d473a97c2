//! The machine where a recording begins.

use super::estimate::position_sensor;
use super::recording::Recording;
use super::simulate::{deviation, record};
use crate::calibrate::least_squares::{Best, Effort, Free, least_squares};
use crate::calibrate::outcome::inverse_normal;
use crate::effects::Setting;
use crate::engine::{Halt, Schedule, StepControl, run};
use crate::measure::spline::CubicSpline;
use crate::mechanism::{
    Actuator, BodyState, Command, Commands, Drive, Idle, JointIndex, Load, Mechanism, Reads,
    Sensor, Situation,
};
use crate::model::recorded;
use crate::scenario::{Problem, Scenario};
use nalgebra::{DMatrix, DVector, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Time in s for which a driven machine was held at its first command before a recording begins.
pub const LEAD: f64 = 0.25;

/// Time in s for which a free machine is held by the angles of its joints before it is let go: journals settle
/// in some hundredths of a second.
const HELD: f64 = 0.1;

/// Natural frequency in Hz of what holds it: the weight of a machine of some decimetres bends it by
/// `g/(l ω²)`, a hundred-thousandth of a radian, and contacts take shorter steps.
const HOLD: f64 = 300.0;

/// Time in s over which the first coordinates of a free machine are taken, that fall away from rest with the
/// square of time: short beside its swing, and enough rows to average a sensor's steps.
const FIRST: f64 = 0.012;

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
struct Recorded(Vec<Told>);

impl Commands for Recorded {
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
    Arc::new(Recorded((0..mechanism.actuators.len()).map(told).collect()))
}

/// The column of a recording that holds what a drive was told.
pub(super) fn told_by<'a>(
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

/// Coordinates at the first row of joints that no drive moves and that are measured, by sensor.
fn free_coordinates(mechanism: &Mechanism, recording: &Recording) -> Vec<(JointIndex, f64)> {
    let rows = ((FIRST / recording.interval) as usize + 1).clamp(1, recording.samples);
    let first = |values: &[f64]| from_rest(&values[..rows]);
    let sensors = mechanism.sensors.iter().enumerate();
    let found = sensors.filter_map(|(i, sensor)| {
        let Reads::Position(joint) = sensor.reads else { return None };
        let driven = mechanism.actuators.iter().any(|drive| drive.joint == joint);
        let value = (first(recording.get(i)?) - sensor.offset) / sensor.scale;
        (!driven).then_some((joint, value))
    });
    found.collect()
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
fn placed(mechanism: &mut Mechanism, recording: &Recording) {
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
    let commands = std::mem::replace(&mut mechanism.commands, Arc::new(Fixed(first)));
    // What cannot be closed there stays where it is told to be.
    let starts: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
    if mechanism.close(0.0).is_err() {
        mechanism.bodies.iter_mut().zip(starts).for_each(|(body, start)| body.start = start);
    }
    mechanism.commands = commands;
}

/// Commands that stay.
#[derive(Debug)]
struct Fixed(Vec<Command>);

impl Commands for Fixed {
    fn at(&self, _: f64, commands: &mut [Command]) {
        commands.copy_from_slice(&self.0);
    }
}

/// A recorded machine with these effects, closed at its first row, and the joints that hold it there beside its
/// drives.
struct Closed {
    mechanism: Mechanism,
    held: Vec<(JointIndex, f64)>,
}

fn closed(
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
        for (joint, measured) in free_coordinates(mechanism, recording) {
            let drive = Actuator::new("", joint, Drive::Prescribed);
            mechanism.actuators.push(drive);
            if mechanism.freedoms(&starts).overdriven.is_empty() {
                let value = known.and_then(|known| known.get(held.len()).copied());
                held.push((joint, value.unwrap_or(measured)));
            } else {
                mechanism.actuators.pop();
            }
        }
        let count = mechanism.actuators.len() - held.len();
        mechanism.commands = Arc::new(Holding {
            drives: Arc::clone(&mechanism.commands),
            count,
            held: held.iter().map(|(_, value)| *value).collect(),
        });
    })?;
    Ok(Closed { mechanism, held })
}

/// Lets go of what held joints. Commands stay what effects made of them, which a delay does.
fn release(mechanism: &mut Mechanism, held: usize) {
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

/// A machine that was let go.
#[derive(Clone, Debug)]
pub struct Released {
    /// The machine.
    pub machine: Mechanism,
    /// Coordinates in m or rad, at the first row, of the joints that its drives leave free and that held it there.
    pub coordinates: Vec<f64>,
    /// Their covariance, as far as the recording leaves them open; none where nothing was fitted.
    covariance: Option<DMatrix<f64>>,
}

impl Released {
    /// Whether where it was let go was fitted to a recording.
    pub fn is_fitted(&self) -> bool {
        self.covariance.is_some()
    }

    /// Coordinates as far from those that were fitted as nobody knows them, drawn by a number.
    pub fn drawn(&self, number: u64) -> Vec<f64> {
        let factor = self.covariance.clone().and_then(DMatrix::cholesky);
        let Some(factor) = factor else { return self.coordinates.clone() };
        let mut random = ChaCha8Rng::seed_from_u64(number);
        random.set_stream(STARTS);
        let away =
            DVector::from_fn(self.coordinates.len(), |_, _| StandardNormal.sample(&mut random));
        let away: DVector<f64> = factor.l() * away;
        self.coordinates.iter().zip(&away).map(|(value, away)| value + away).collect()
    }
}

/// Stream of random numbers that starts are drawn from, beside those of effects' values.
const STARTS: u64 = 1;

/// The machine of a rig with these effects as it was let go: a driven one at rest at its first commands, some
/// time before the first row, or, where a sampled controller holds it, where it was at the first row; one that drives
/// leave free after it was held there, at the first row.
///
/// # Errors
/// An effect that the machine cannot take, joints that do not close, a run that breaks down.
pub fn released(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
    control: StepControl,
) -> Result<Released, StartError> {
    let Closed { mut mechanism, held } = closed(rig, effects, recording, None)?;
    if held.is_empty() {
        for body in &mut mechanism.bodies {
            body.start.twist.fill(0.0);
        }
        release(&mut mechanism, 0);
        let sampled = |drive: &Actuator| matches!(drive.drive, Drive::Sampled(_));
        if mechanism.actuators.iter().any(sampled) {
            placed(&mut mechanism, recording);
            mechanism.epoch = 0.0;
        } else {
            mechanism.epoch = -LEAD;
        }
        return Ok(Released { machine: mechanism, coordinates: Vec::new(), covariance: None });
    }
    let joints: Vec<JointIndex> = held.iter().map(|(joint, _)| *joint).collect();
    let missed = |values: &[f64], seconds: f64| {
        missed(rig, effects, recording, &joints, values, seconds, control)
    };
    let mut values: Vec<f64> = held.iter().map(|(_, value)| *value).collect();
    let free = unbounded(values.len());
    let mut seconds = SEEN;
    let mut covariance = None;
    loop {
        let look = |values: &[f64]| missed(values, seconds);
        let Some(best) = least_squares(&look, &free, values.clone(), EFFORT, None) else { break };
        // What a model does not show is no reason to have started elsewhere.
        let shown = mean_square(&best.residual) <= KEPT;
        if shown || seconds == SEEN {
            covariance = uncertainty(&best);
            values = best.values;
        }
        if !shown || seconds >= recording.duration() {
            break;
        }
        seconds *= 2.0;
    }
    let machine = let_go_at(rig, effects, recording, &values, control)?;
    Ok(Released { machine, coordinates: values, covariance })
}

/// The same machine from near `coordinates`, which something else than its start told, where from there it does more of what
/// was recorded than `known`.
///
/// # Errors
/// As of [`released`].
pub fn released_near(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
    (known, coordinates): (Released, &[f64]),
    control: StepControl,
) -> Result<Released, StartError> {
    let joints: Vec<JointIndex> =
        closed(rig, effects, recording, None)?.held.iter().map(|(joint, _)| *joint).collect();
    let seconds = recording.duration();
    let look = |values: &[f64]| missed(rig, effects, recording, &joints, values, seconds, control);
    let free = unbounded(coordinates.len());
    let best = least_squares(&look, &free, coordinates.to_vec(), EFFORT, None);
    let (Some(best), Some(before)) = (best, look(&known.coordinates)) else { return Ok(known) };
    if best.residual.norm_squared() >= before.norm_squared() {
        return Ok(known);
    }
    let machine = let_go_at(rig, effects, recording, &best.values, control)?;
    Ok(Released { machine, covariance: uncertainty(&best), coordinates: best.values })
}

/// By how much the first `seconds` of a recording miss the coordinates of the joints that held a machine with these effects
/// where it was let go at these `values`, in units of noise; none where there is no such machine.
fn missed(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
    joints: &[JointIndex],
    values: &[f64],
    seconds: f64,
    control: StepControl,
) -> Option<DVector<f64>> {
    let part = recording.first(seconds);
    let machine = let_go_at(rig, effects, recording, values, control).ok()?;
    let simulated = record(&machine, control, &part, 0).ok()?;
    let mut left = Vec::new();
    for joint in joints {
        let sensor = position_sensor(&machine, *joint);
        let pair = sensor.and_then(|i| Some((i, part.get(i).zip(simulated.get(i))?)));
        let Some((i, (measured, simulated))) = pair else { continue };
        let unit = deviation(&machine.sensors[i], measured);
        left.extend(measured.iter().zip(simulated).map(|(a, b)| (a - b) / unit));
    }
    Some(DVector::from_vec(left))
}

fn unbounded(count: usize) -> Vec<Free> {
    vec![Free { step: SMALL, bounds: [-f64::MAX, f64::MAX] }; count]
}

/// The covariance of coordinates that were fitted.
fn uncertainty(best: &Best) -> Option<DMatrix<f64>> {
    let inverse = best.jacobian.as_ref().and_then(inverse_normal);
    inverse.map(|inverse| inverse * mean_square(&best.residual).max(1.0))
}

/// The machine of a rig with these effects, let go at its first row with these coordinates (m or rad) of the joints that
/// its drives leave free.
///
/// # Errors
/// As of [`released`].
pub fn let_go_at(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
    coordinates: &[f64],
    control: StepControl,
) -> Result<Mechanism, StartError> {
    let Closed { mechanism, held } = closed(rig, effects, recording, Some(coordinates))?;
    Ok(held_there(mechanism, held.len(), control)?)
}

fn mean_square(left: &DVector<f64>) -> f64 {
    left.norm_squared() / left.len().max(1) as f64
}

/// Time in s from the first row over which the start of a free machine is fitted first: a start that is wrong by fifty
/// steps of an encoder then shows as such, and after a tenth of a second of journals that hit their rings no longer. Twice
/// as long, again and again, follows while the model shows that: many rows average a sensor's steps.
const SEEN: f64 = 0.05;

/// Mean square in units of noise up to which it does: a model that lacks an effect of the size of noise may be
/// right about the start.
const KEPT: f64 = 4.0;

/// Steps of that fit on each length, at most, and the drop of Σ of squares in units of noise that is none: a slow error
/// of a third of a sensor's steps shows only in many rows together, so that their mean square does not tell.
const EFFORT: Effort = Effort { steps: 6, enough: 1.0, secant: true };

/// A small change of a coordinate in m or rad: far above rounding, far below a swing.
pub const SMALL: f64 = 1e-4;

/// A machine that was held at its start by the last `held` of its drives until its journals settled, and let go.
fn held_there(
    mut mechanism: Mechanism,
    held: usize,
    control: StepControl,
) -> Result<Mechanism, Halt> {
    let inertia =
        |body: &crate::mechanism::Body| body.inertia + body.mass * mechanism.size().powi(2);
    let total: f64 = mechanism.bodies.iter().map(inertia).sum();
    let mass: f64 = mechanism.bodies.iter().map(|body| body.mass).sum();
    let mut holding = mechanism.clone();
    holding.epoch = -HELD;
    let first = holding.actuators.len() - held;
    let omega = TAU * HOLD;
    for drive in &mut holding.actuators[first..] {
        let inert = match drive.joint {
            JointIndex::Revolute(_) => total,
            JointIndex::Prismatic(_) => mass,
        };
        drive.drive =
            Drive::Servo { stiffness: inert * omega * omega, damping: 2.0 * inert * omega };
    }
    for body in &mut holding.bodies {
        body.start.twist.fill(0.0);
    }
    let schedule = Schedule { duration: HELD, interval: HELD };
    run(&holding, control, schedule, &mut |instant| {
        for (i, body) in mechanism.bodies.iter_mut().enumerate() {
            (body.start, body.angle) = (instant.states[i], instant.angles[i]);
            body.start.twist.fill(0.0);
        }
    })?;
    release(&mut mechanism, held);
    mechanism.epoch = 0.0;
    Ok(mechanism)
}

/// Swing in Hz that dies fastest while a machine comes to rest, critically damped: light bodies in play of
/// 0.1 mm swing at 30–60 Hz.
pub(super) const SWING: f64 = 40.0;

/// Time in s from rest to the first row.
const SHORT: f64 = 0.03;

/// `f = −D v` on every body.
#[derive(Debug)]
struct Calming;

impl Load for Calming {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let rate = 2.0 * TAU * SWING;
        let bodies = at.mechanism.bodies.iter().zip(at.states);
        for (wrench, (body, state)) in wrenches.iter_mut().zip(bodies) {
            let masses = Vector3::new(body.mass, body.mass, body.inertia);
            *wrench -= masses.component_mul(&state.twist) * rate;
        }
    }

    fn longest_step(&self, _mechanism: &Mechanism) -> Option<f64> {
        Some(1.0 / (2.0 * TAU * SWING))
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
    calmed.loads.push(Arc::new(Calming));
    let mut machine = released.clone();
    run(&calmed, control, Schedule { duration, interval: duration }, &mut |instant| {
        for (i, body) in machine.bodies.iter_mut().enumerate() {
            (body.start, body.angle) = (instant.states[i], instant.angles[i]);
        }
    })?;
    machine.epoch = -SHORT;
    Ok(Some(machine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::parts_of;

    /// Starts are drawn as far apart as their covariance says, and where they were fitted without one.
    #[test]
    fn starts_are_drawn_as_far_apart_as_they_are_open() {
        let covariance = DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 1.0]);
        let rig = include_str!("../../../assets/rigs-planar/planar-4/rig.toml");
        let machine = parts_of(&Scenario::from_text(rig, "rig", &[]).unwrap()).unwrap();
        let mut released =
            Released { machine, coordinates: vec![5.0, -7.0], covariance: Some(covariance) };
        let drawn: Vec<Vec<f64>> = (0..4000).map(|number| released.drawn(number)).collect();
        let product = |i: usize, j: usize| {
            let of =
                |d: &Vec<f64>| (d[i] - released.coordinates[i]) * (d[j] - released.coordinates[j]);
            drawn.iter().map(of).sum::<f64>() / drawn.len() as f64
        };
        assert!((product(0, 0) - 4.0).abs() < 0.4, "{}", product(0, 0));
        assert!((product(0, 1) - 1.0).abs() < 0.2, "{}", product(0, 1));
        assert!((product(1, 1) - 1.0).abs() < 0.1, "{}", product(1, 1));
        released.covariance = None;
        assert_eq!(released.drawn(3), released.coordinates);
    }
}
