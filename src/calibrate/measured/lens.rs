//! What a model says about measured signals without being simulated: three residuals of a 3-RPR log,
//! each blind to what the others see.
//!
//! * **Servo** `F − [k_p (q_cmd − q) + k_d d/dt(q_cmd − q)]`: does the drive obey its own law?
//! * **Closure** `q − |PQ|`: do measured pose and measured lengths fit the geometry? Each journal
//!   leans on its ring in the direction of the joint's force, `P = A − (c + δ) R_A/|R_A|` and so at C;
//!   the forces come from the measured actuator forces and the leg's own dynamics, so that what acts
//!   on the platform does not matter here.
//! * **Dynamics** `F − F_inv`: the forces that the measured motion takes, by inverse dynamics of the
//!   machine without clearance at the measured pose; but rods accelerate along their legs as encoders say,
//!   whose journals may float.
//!
//! Everything about the machine is read off its [`Mechanism`], effects included.

use super::measured_dynamics::{MeasuredMachine, PlatformMotion};
use super::spectrum::{Signal, fast_length};
use crate::measure::filter::{ZeroPhase, derivative};
use crate::measure::log::{Channel, Log};
use crate::mechanism::{Command, Drive, Mechanism};
use nalgebra::Vector3;
use std::ops::Range;

/// Noise of slow actuator forces in N, below which it decides at which flank a drive with backlash lies.
const FORCE_NOISE: f64 = 0.1;

/// Corner of the low-pass in Hz that measured pose and forces pass before the inverse dynamics:
/// tracker noise grows with the square of the frequency when differentiated twice.
const CORNER: f64 = 120.0;
/// The same of the forces that say where journals lean: there noise turns directions.
const LEAN_CORNER: f64 = 40.0;
/// Highest frequencies in Hz that are looked at. Dynamics: below the corner. Servo: below the resonance of
/// the drives and the sensors' own filter. Closure: a screw of 5 mm at 0.3 m/s is 60 Hz.
const DYNAMICS_BAND: f64 = 90.0;
const SERVO_BAND: f64 = 100.0;
const CLOSURE_BAND: f64 = 150.0;
/// Rate in Hz at which residuals are computed, at least, and the corner in Hz of the low-pass before it:
/// beyond every band, and half the work of a log at 1 kHz.
const RATE: f64 = 500.0;
const PREFILTER: f64 = 200.0;
/// Left out at both ends in s, where filters see beyond the log.
pub const TRIM: f64 = 0.06;

/// A log prepared for looking at through models.
#[derive(Clone, Debug)]
pub struct Lens {
    interval: f64,
    /// One row in so many is looked at.
    stride: usize,
    /// Rows left out at each end.
    trim: usize,
    forces: Vec<[f64; 3]>,
    smooth_forces: Vec<[f64; 3]>,
    leaning_forces: Vec<[f64; 3]>,
    lengths: Vec<[f64; 3]>,
    rates: Vec<[f64; 3]>,
    smooth_rates: Vec<[f64; 3]>,
    smooth_accelerations: Vec<[f64; 3]>,
    poses: Vec<Vector3<f64>>,
    smooth: Vec<[Vector3<f64>; 3]>,
}

fn triples(columns: [&[f64]; 3]) -> Vec<[f64; 3]> {
    (0..columns[0].len()).map(|i| columns.map(|column| column[i])).collect()
}

impl Lens {
    /// Prepares a log that has lengths, forces and pose.
    pub fn new(log: &Log) -> Option<Self> {
        let h = log.interval;
        let stride = (1.0 / (RATE * h)).floor().max(1.0) as usize;
        let filter = ZeroPhase::butterworth(4, CORNER, h);
        let columns = |channel: fn(usize) -> Channel| -> Option<[&[f64]; 3]> {
            Some([log.get(channel(0))?, log.get(channel(1))?, log.get(channel(2))?])
        };
        let (q, f, pose) =
            (columns(Channel::Length)?, columns(Channel::Force)?, columns(Channel::Pose)?);
        let thin = |columns: [&[f64]; 3]| {
            let filter = (stride > 1).then(|| ZeroPhase::butterworth(4, PREFILTER, h));
            columns.map(|c| filter.as_ref().map_or_else(|| c.to_vec(), |filter| filter.apply(c)))
        };
        let (q, f, pose) = (thin(q), thin(f), thin(pose));
        let [q, f, pose] = [&q, &f, &pose].map(|columns| columns.each_ref().map(Vec::as_slice));
        let smooth_f = f.map(|column| filter.apply(column));
        let slow = ZeroPhase::butterworth(4, LEAN_CORNER, h);
        let leaning = f.map(|column| slow.apply(column));
        let smooth = pose.map(|column| filter.apply(column));
        let rate = [0, 1, 2].map(|k| derivative(&smooth[k], h));
        let acceleration = [0, 1, 2].map(|k| derivative(&rate[k], h));
        let smooth_rates = q.map(|column| derivative(&filter.apply(column), h));
        let at = |columns: &[Vec<f64>; 3], i: usize| Vector3::from_fn(|k, _| columns[k][i]);
        Some(Self {
            interval: h,
            stride,
            trim: (TRIM / h).round() as usize,
            forces: triples(f),
            smooth_forces: triples([&smooth_f[0], &smooth_f[1], &smooth_f[2]]),
            leaning_forces: triples([&leaning[0], &leaning[1], &leaning[2]]),
            lengths: triples(q),
            smooth_rates: triples(smooth_rates.each_ref().map(Vec::as_slice)),
            smooth_accelerations: {
                let second = smooth_rates.each_ref().map(|rate| derivative(rate, h));
                triples(second.each_ref().map(Vec::as_slice))
            },
            rates: {
                let rates = q.map(|column| derivative(column, h));
                triples([&rates[0], &rates[1], &rates[2]])
            },
            poses: triples(pose).into_iter().map(Vector3::from).collect(),
            smooth: (0..log.samples)
                .map(|i| [at(&smooth, i), at(&rate, i), at(&acceleration, i)])
                .collect(),
        })
    }

    /// One row in so many is looked at.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// The nine residuals without a value.
    pub fn nothing(&self) -> Vec<Signal> {
        let bands = [SERVO_BAND, CLOSURE_BAND, DYNAMICS_BAND].into_iter();
        bands.flat_map(|band| (0..3).map(move |_| Signal { values: Vec::new(), band })).collect()
    }

    /// Measured pose (m, m, rad) and its rate, smoothed, at a row.
    pub fn motion(&self, row: usize) -> [Vector3<f64>; 2] {
        let [pose, rate, _] = self.smooth[row];
        [pose, rate]
    }

    /// Measured speed of a prismatic joint in m/s at a row.
    pub fn speed(&self, row: usize, leg: usize) -> f64 {
        self.smooth_rates[row][leg]
    }

    /// The rows that residuals can be had of: all but the ends.
    pub fn rows(&self) -> Range<usize> {
        let available = (self.poses.len() - 2 * self.trim) / self.stride;
        self.trim..self.trim + fast_length(available) * self.stride
    }

    /// The nine residuals: servo, closure, dynamics, of each leg in turn.
    pub fn residuals(&self, mechanism: &Mechanism, rows: Range<usize>) -> Vec<Signal> {
        let mut signals = self.nothing();
        let mut machine = MeasuredMachine::new(mechanism);
        let mut commands = [Command::default(); 3];
        for i in rows.step_by(self.stride) {
            let t = i as f64 * self.interval;
            mechanism.commands.at(t, &mut commands);
            let [pose, rate, acceleration] = self.smooth[i];
            let rods = [0, 1, 2].map(|leg| {
                let actuator = &mechanism.actuators[leg];
                let read = Command {
                    position: self.lengths[i][leg],
                    rate: self.smooth_rates[i][leg],
                    acceleration: self.smooth_accelerations[i][leg],
                };
                let truth = actuator.true_command(read).acceleration;
                actuator.transmission.is_none().then_some([read.acceleration, truth])
            });
            let motion = PlatformMotion { pose, rate, acceleration };
            let look = machine.look(t, motion, rods, self.leaning_forces[i]);
            for leg in 0..3 {
                let actuator = &mechanism.actuators[leg];
                let (q, command) = (self.lengths[i][leg], commands[leg]);
                let servo = match actuator.drive {
                    Drive::Servo { stiffness, damping } => {
                        self.forces[i][leg]
                            - stiffness * (command.position - q)
                            - damping * (command.rate - self.rates[i][leg])
                    }
                    Drive::Prescribed | Drive::Sampled(_) | Drive::Effort => 0.0,
                };
                signals[leg].values.push(servo);
                let length = machine.length(leg, self.poses[i], look.leans[leg]);
                let read = actuator.read(length, 0.0)[0];
                let force = self.smooth_forces[i][leg];
                let ahead =
                    actuator.transmission.map_or(0.0, |link| link.pressed(force, FORCE_NOISE));
                signals[3 + leg].values.push(q - read - ahead);
                signals[6 + leg].values.push(self.smooth_forces[i][leg] - look.forces[leg]);
            }
        }
        signals
    }
}
