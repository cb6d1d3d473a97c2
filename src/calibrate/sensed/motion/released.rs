//! Where a machine was let go: one that drives hold rests at its first commands; where one that nothing holds began to
//! fall is fitted to what its sensors show.

use super::simulate::{deviation, record};
use super::start::{CalmedBodies, Closed, LEAD, closed, placed, release, still};
use super::swinging::{OutputKicks, kicked, kicks_as_seen};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::position_sensor;
use crate::calibrate::values::least_squares::{Best, FitEffort, Free, least_squares};
use crate::calibrate::values::normal::inverse_normal;
use crate::effects::Setting;
use crate::engine::{Halt, Schedule, StepControl, run_while};
use crate::mechanism::{Actuator, Drive, JointIndex, Mechanism};
use crate::scenario::{Problem, Scenario};
use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Time in s for which a free machine is held by the angles of its joints before it is let go, at most: journals whose swing
/// is damped settle in some hundredths of a second. Undamped they went on for more than a tenth, and from which place they were
/// let go hung on the last millionth of a radian.
const HELD: f64 = 1.0;

/// It is let go as soon as no body moves farther (m) between two looks (s): what creeps to its place has ten times as far to go
/// still, a thousandth of what the finest sensors see. Stopped ten times sooner, a pendulum seemed to be dragged by 3e-6 N.
const AT_REST: (f64, f64) = (5e-10, 5e-3);

/// Tolerance in m/s with which it is held, at most: errors of steps move a journal at rest by less than that then. With 1e-4 they
/// never let one rest.
const HOLDING: f64 = 1e-5;

/// Natural frequency in Hz of what holds it: the weight of a machine of some decimetres bends it by
/// `g/(l ω²)`, a hundred-thousandth of a radian, and contacts take shorter steps.
const HOLD: f64 = 300.0;

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
    /// The same at rest shortly before the first row, where it is kicked from there on to swing as was recorded.
    pub at_rest: Option<Mechanism>,
    /// Their covariance, as far as the recording leaves them open; none where nothing was fitted.
    covariance: Option<DMatrix<f64>>,
}

impl Released {
    /// One from these coordinates, without a covariance.
    fn from(machine: Mechanism, coordinates: Vec<f64>) -> Self {
        Self { machine, coordinates, at_rest: None, covariance: None }
    }

    /// The machine at rest under its first commands, shortly before the first row, without a swing; none of one that begins
    /// at the first row.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn still(&self, control: StepControl) -> Result<Option<Mechanism>, Halt> {
        match &self.at_rest {
            Some(machine) => Ok(Some(machine.clone())),
            None => still(&self.machine, control),
        }
    }

    /// The same with the swing that a recording shows, where it is another than that with which it is let go.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn swinging_as(self, recording: &Recording, control: StepControl) -> Result<Self, Halt> {
        let Some(still) = self.still(control)? else { return Ok(self) };
        let recorded = |machine: &Mechanism, like: &Recording| record(machine, control, like, 0);
        match kicks_as_seen(&self.machine, &still, recording, &recorded)? {
            Some(kicks) => self.with_kicks(&kicks, control),
            None => Ok(self),
        }
    }

    /// The same with a swing by these kicks, where it rests before the first row.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn with_kicks(self, kicks: &OutputKicks, control: StepControl) -> Result<Self, Halt> {
        let Some(still) = self.still(control)? else { return Ok(self) };
        Ok(Self { machine: kicked(&still, kicks), at_rest: Some(still), ..self })
    }

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
        return Ok(Released::from(mechanism, Vec::new()));
    }
    let joints = held.iter().map(|(joint, _)| *joint).collect();
    let falling = Falling { rig, effects, recording, joints, control };
    let mut values: Vec<f64> = held.iter().map(|(_, value)| *value).collect();
    let free = unbounded(values.len());
    let mut seconds = SEEN;
    let mut covariance = None;
    loop {
        let look = |values: &[f64]| falling.missed(values, seconds);
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
        seconds *= LONGER;
    }
    Ok(Released { covariance, ..Released::from(falling.let_go(&values)?, values) })
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
    let held = closed(rig, effects, recording, None)?.held;
    let joints = held.iter().map(|(joint, _)| *joint).collect();
    let falling = Falling { rig, effects, recording, joints, control };
    let look = |values: &[f64]| falling.missed(values, recording.duration());
    let free = unbounded(coordinates.len());
    let best = least_squares(&look, &free, coordinates.to_vec(), EFFORT, None);
    let (Some(best), Some(before)) = (best, look(&known.coordinates)) else { return Ok(known) };
    if best.residual.norm_squared() >= before.norm_squared() {
        return Ok(known);
    }
    let machine = falling.let_go(&best.values)?;
    Ok(Released { covariance: uncertainty(&best), ..Released::from(machine, best.values) })
}

/// A machine with these effects that nothing holds where a recording begins.
struct Falling<'a> {
    rig: &'a Scenario,
    effects: &'a [Setting],
    recording: &'a Recording,
    /// The joints whose coordinates say where it was let go.
    joints: Vec<JointIndex>,
    control: StepControl,
}

impl Falling<'_> {
    fn let_go(&self, values: &[f64]) -> Result<Mechanism, StartError> {
        let_go_at(self.rig, self.effects, self.recording, values, self.control)
    }

    /// By how much it misses what the first `seconds` of the recording show of these joints, in units of noise, let go at
    /// these coordinates; none where there is no such machine.
    fn missed(&self, values: &[f64], seconds: f64) -> Option<DVector<f64>> {
        let part = self.recording.first(seconds);
        let machine = self.let_go(values).ok()?;
        let simulated = record(&machine, self.control, &part, 0).ok()?;
        let mut left = Vec::new();
        for joint in &self.joints {
            let sensor = position_sensor(&machine, *joint);
            let pair = sensor.and_then(|i| Some((i, part.get(i).zip(simulated.get(i))?)));
            let Some((i, (measured, simulated))) = pair else { continue };
            let unit = deviation(&machine.sensors[i], measured);
            left.extend(measured.iter().zip(simulated).map(|(a, b)| (a - b) / unit));
        }
        Some(DVector::from_vec(left))
    }
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
    Ok(held_there(mechanism, held.len(), control)?.0)
}

fn mean_square(left: &DVector<f64>) -> f64 {
    left.norm_squared() / left.len().max(1) as f64
}

/// Time in s from the first row over which the start of a free machine is fitted first: a start that is wrong by fifty
/// steps of an encoder then shows as such, and once journals have hit their rings some times no longer, which those of a small
/// machine do within 0.05 s. [Longer](LONGER) ones follow, again and again, while the model shows that: many rows average a
/// sensor's steps.
const SEEN: f64 = 0.0125;

/// How much longer each of these is than the one before: what a start is off by at its end grows with it, and is still small
/// beside a swing. Fits over twice as long each time take half as long again.
const LONGER: f64 = 4.0;

/// Mean square in units of noise up to which it does: a model that lacks an effect of the size of noise may be
/// right about the start.
const KEPT: f64 = 4.0;

/// Steps of that fit on each length, at most, and the drop of Σ of squares in units of noise that is none: a slow error
/// of a third of a sensor's steps shows only in many rows together, so that their mean square does not tell.
const EFFORT: FitEffort = FitEffort { steps: 6, enough: 1.0, secant: true };

/// A small change of a coordinate in m or rad: far above rounding, far below a swing.
pub const SMALL: f64 = 1e-4;

/// A machine that was held at its start by the last `held` of its drives until its journals settled, and let go, and the time in s
/// for which it was held.
fn held_there(
    mut mechanism: Mechanism,
    held: usize,
    control: StepControl,
) -> Result<(Mechanism, f64), Halt> {
    let inertia =
        |body: &crate::mechanism::Body| body.inertia + body.mass * mechanism.size().powi(2);
    let total: f64 = mechanism.bodies.iter().map(inertia).sum();
    let mass: f64 = mechanism.bodies.iter().map(|body| body.mass).sum();
    let mut holding = mechanism.clone();
    holding.loads.push(Arc::new(CalmedBodies));
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
    let control = match control.tolerance() {
        Some(tolerance) => control.with_tolerance_times((HOLDING / tolerance).min(1.0)),
        None => control,
    };
    let (moved, interval) = AT_REST;
    let schedule = Schedule { duration: HELD, interval };
    let mut began = false;
    let work = run_while(&holding, control, schedule, &AtomicBool::new(false), &mut |instant| {
        let mut rests = std::mem::replace(&mut began, true);
        for (i, body) in mechanism.bodies.iter_mut().enumerate() {
            let state = instant.states[i];
            rests &= (state.position - body.start.position).norm() < moved;
            (body.start, body.angle) = (state, instant.angles[i]);
            body.start.twist.fill(0.0);
        }
        if rests { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    release(&mut mechanism, held);
    mechanism.epoch = 0.0;
    Ok((mechanism, work.reached))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::residuals::problem::RigProblem;
    use crate::model::parts_of;

    /// Held once more, a double pendulum that was let go stays where it is; however coarse steps are, it rests there.
    #[test]
    fn what_is_let_go_has_come_to_rest() {
        let problem = RigProblem::planar("planar-4");
        let recording = &problem.runs[0].recording;
        let Closed { mechanism, held } = closed(&problem.rig, &[], recording, None).unwrap();
        let (held_once, _) = held_there(mechanism.clone(), held.len(), problem.control).unwrap();
        let mut again = mechanism.clone();
        for (body, known) in again.bodies.iter_mut().zip(&held_once.bodies) {
            (body.start, body.angle) = (known.start, known.angle);
        }
        let (held_twice, _) = held_there(again, held.len(), problem.control).unwrap();
        let farthest = |from: &Mechanism| {
            let pairs = held_once.bodies.iter().zip(&from.bodies);
            pairs.map(|(a, b)| (a.start.position - b.start.position).norm()).fold(0.0, f64::max)
        };
        let (moved, settled) = (farthest(&held_twice), farthest(&mechanism));
        assert!(moved < 2e-8 && settled > 1e-5, "{moved:e} m after {settled:e} m");
        let coarse = StepControl::Tolerance(1e-4);
        let (held_coarsely, seconds) = held_there(mechanism.clone(), held.len(), coarse).unwrap();
        let apart = farthest(&held_coarsely);
        assert!(apart < 2e-8 && seconds < 0.5 * HELD, "{apart:e} m, {seconds} s");
    }

    /// Starts are drawn as far apart as their covariance says, and where they were fitted without one.
    #[test]
    fn starts_are_drawn_as_far_apart_as_they_are_open() {
        let covariance = DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 1.0]);
        let rig = include_str!("../../../../assets/rigs-planar/planar-4/rig.toml");
        let machine = parts_of(&Scenario::from_text(rig, "rig", &[]).unwrap()).unwrap();
        let mut released =
            Released { covariance: Some(covariance), ..Released::from(machine, vec![5.0, -7.0]) };
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
