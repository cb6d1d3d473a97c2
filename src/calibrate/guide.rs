//! A start that a recording shows: nobody knows how a machine was let go, but its swing is measured.
//!
//! Where loads keep the joints in contact, the platform swings in their play for seconds, and how far a
//! journal leans, on average too, depends on that swing. While a log's first rows rest, a damper between
//! the simulated and the measured velocity of the platform, `f = D (v_measured − v)`, lets the model
//! forget its own swing and take up the recorded one: coupling a model to a signal of what it models
//! makes both move alike (Pecora and Carroll, *Synchronization in chaotic systems*, Phys. Rev. Lett. 64,
//! 1990). Velocities alone are coupled, so that a model whose pose is wrong by more than the play is not
//! pushed about.

use super::lens::{Lens, TRIM};
use super::replica;
use crate::engine::{Halt, StepControl};
use crate::measure::filter::ZeroPhase;
use crate::measure::log::{Channel, Log};
use crate::mechanism::{Load, Mechanism, Situation};
use crate::scenario::Sensors;
use nalgebra::{SMatrix, SVector, Vector3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Swing in Hz that is forgotten fastest, critically damped: light platforms in play of 0.1 mm swing at
/// 30–60 Hz.
const SWING: f64 = 40.0;

/// Share of the time over which the coupling is taken back.
const FADE: f64 = 0.15;

/// Time in s over which a swing is seen, after the coupling: most of what is seen of it before it dies
/// away. Below the corner in Hz the model may be wrong for other reasons.
const SEEN: f64 = 0.6;
const CORNER: f64 = 25.0;

/// Corrections of the measured velocity: so many, each a half sine of so long (s), the last one ending
/// with the coupling; two of them a quarter of a swing apart are any amplitude and phase.
const PULSES: usize = 2;
const PULSE: f64 = 0.012;
const APART: f64 = 0.25 / SWING;

/// Size of a correction (m/s, m/s, rad/s) by which the others are counted: a micrometre within a pulse.
const SIZES: [f64; 3] = [1e-4, 1e-4, 3e-3];

/// What keeps corrections that do nothing at nothing: far below what one size does.
const RIDGE: f64 = 1e-3;

/// Share of its squares that a guided start has to leave of those of a release to be the better one.
const SLACK: f64 = 0.95;

/// Corrections as multiples of their sizes: along x, y and φ of each pulse.
type Corrections = SVector<f64, { 3 * PULSES }>;

#[derive(Debug)]
struct Guide {
    /// Time between two velocities in s.
    interval: f64,
    /// Measured velocities of the output (m/s, m/s, rad/s).
    velocities: Arc<Vec<Vector3<f64>>>,
    /// N·s/m, N·s/m, N·m·s.
    damping: Vector3<f64>,
    corrections: Corrections,
}

/// Velocities of the output in a log's first rows, which no residual counts.
fn velocities(log: &Log) -> Option<Arc<Vec<Vector3<f64>>>> {
    let lens = Lens::new(log)?;
    let rows = ((TRIM / log.interval).ceil() as usize + 2).min(log.samples);
    Some(Arc::new((0..rows).map(|row| lens.motion(row)[1]).collect()))
}

fn couple(
    machine: &Mechanism,
    log: &Log,
    velocities: &Arc<Vec<Vector3<f64>>>,
    corrections: Corrections,
) -> Mechanism {
    let mut machine = machine.clone();
    let body = &machine.bodies[machine.output];
    let damping = Vector3::new(body.mass, body.mass, body.inertia) * (2.0 * TAU * SWING);
    let velocities = Arc::clone(velocities);
    let guide = Guide { interval: log.interval, velocities, damping, corrections };
    machine.loads.push(Arc::new(guide));
    machine
}

/// The machine with its output coupled to a log's first rows, if the log has a pose.
pub fn guided(machine: &Mechanism, log: &Log) -> Mechanism {
    match velocities(log) {
        Some(velocities) => couple(machine, log, &velocities, Corrections::zeros()),
        None => machine.clone(),
    }
}

/// How well starts meet the swing that a log shows.
struct Judge<'a> {
    log: Log,
    sensors: &'a Sensors,
    control: StepControl,
}

impl<'a> Judge<'a> {
    fn new(log: &Log, sensors: &'a Sensors, control: StepControl) -> Self {
        let rows = (((TRIM + SEEN) / log.interval) as usize).min(log.samples);
        Self { log: log.part(0..rows), sensors, control }
    }

    /// What is not met, each in units of noise.
    fn look(&self, machine: &Mechanism) -> Result<Vec<f64>, Halt> {
        let seen = replica::simulate(machine, self.sensors, self.control, &self.log, 0)?;
        Ok(swing(&self.log, &seen, self.sensors))
    }
}

fn norm(residual: &[f64]) -> f64 {
    residual.iter().map(|v| v * v).sum()
}

/// Whether a log shows another swing than the machine has when it is let go as it is said to have been.
///
/// # Errors
/// A run that broke down.
pub fn swings_otherwise(
    machine: &Mechanism,
    log: &Log,
    sensors: &Sensors,
    control: StepControl,
) -> Result<bool, Halt> {
    let judge = Judge::new(log, sensors, control);
    let (released, guided) =
        rayon::join(|| judge.look(machine), || judge.look(&guided(machine, log)));
    Ok(norm(&guided?) < SLACK * norm(&released?))
}

/// The machine with the start that a log shows best: as it was let go, guided, or guided by velocities
/// that are corrected by what the swing is seen to be afterwards (one step of Gauss and Newton).
///
/// # Errors
/// A run that broke down.
pub fn start_as_seen(
    machine: Mechanism,
    log: &Log,
    sensors: &Sensors,
    control: StepControl,
) -> Result<Mechanism, Halt> {
    let Some(velocities) = velocities(log) else { return Ok(machine) };
    let judge = Judge::new(log, sensors, control);
    let with = |corrections| couple(&machine, log, &velocities, corrections);
    let unit = |i: usize| Corrections::from_fn(|k, _| if k == i { 1.0 } else { 0.0 });
    let tried: Vec<Mechanism> = [machine.clone(), with(Corrections::zeros())]
        .into_iter()
        .chain((0..3 * PULSES).map(|i| with(unit(i))))
        .collect();
    let looks = tried.par_iter().map(|machine| judge.look(machine));
    let seen = looks.collect::<Result<Vec<Vec<f64>>, Halt>>()?;
    let (released, base) = (&seen[0], &seen[1]);
    if norm(released) < norm(base) {
        return Ok(machine);
    }
    let columns: Vec<Vec<f64>> = seen[2..]
        .iter()
        .map(|moved| moved.iter().zip(base).map(|(moved, base)| moved - base).collect())
        .collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let normal = SMatrix::<f64, { 3 * PULSES }, { 3 * PULSES }>::from_fn(|r, c| {
        dot(&columns[r], &columns[c]) + f64::from(u8::from(r == c)) * RIDGE
    });
    let rhs = Corrections::from_fn(|r, _| -dot(&columns[r], base));
    if let Some(factor) = normal.cholesky() {
        let corrected = with(factor.solve(&rhs));
        if norm(&judge.look(&corrected)?) < norm(base) {
            return Ok(corrected);
        }
    }
    Ok(tried[1].clone())
}

/// What a log's pose shows of a swing that a simulated one does not, after the coupling, in units of its
/// sensors' noise.
fn swing(log: &Log, simulated: &Log, sensors: &Sensors) -> Vec<f64> {
    let filter = ZeroPhase::butterworth(4, CORNER, log.interval);
    let from = (TRIM / log.interval).round() as usize;
    let channels = (0..3).filter_map(|k| {
        let channel = Channel::Pose(k);
        let noise = if k == 2 { sensors.angle_std } else { sensors.pose_std };
        let difference: Vec<f64> =
            log.get(channel)?.iter().zip(simulated.get(channel)?).map(|(a, b)| a - b).collect();
        let slow = filter.apply(&difference);
        // An exact sensor's micrometre and ten microradians.
        let unit = if noise > 0.0 { noise } else { [1e-6, 1e-6, 1e-5][k] };
        let fast = difference.into_iter().zip(slow).skip(from);
        Some(fast.map(move |(whole, slow)| (whole - slow) / unit).collect::<Vec<_>>())
    });
    channels.flatten().collect()
}

impl Load for Guide {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        if !(0.0..TRIM).contains(&at.t) {
            return;
        }
        let (place, share) = ((at.t / self.interval) as usize, (at.t / self.interval).fract());
        let [Some(before), Some(after)] = [place, place + 1].map(|i| self.velocities.get(i)) else {
            return;
        };
        let left = ((TRIM - at.t) / (FADE * TRIM)).min(1.0);
        let weight = 0.5 - 0.5 * (PI * left).cos();
        let mut velocity = before.lerp(after, share);
        for pulse in 0..PULSES {
            let end = TRIM * (1.0 - FADE) - pulse as f64 * APART;
            let phase = (at.t - (end - PULSE)) / PULSE;
            if (0.0..1.0).contains(&phase) {
                let correction = self.corrections.fixed_rows::<3>(3 * pulse);
                let size = Vector3::from(SIZES).component_mul(&correction);
                velocity += size * (PI * phase).sin();
            }
        }
        let twist = at.mechanism.output_state(at.states).twist;
        let force = self.damping.component_mul(&(velocity - twist)) * weight;
        at.push_output(force.xy(), force.z, wrenches);
    }

    fn longest_step(&self, _mechanism: &Mechanism) -> Option<f64> {
        Some(1.0 / (2.0 * TAU * SWING))
    }
}
