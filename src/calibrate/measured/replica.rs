//! A model simulated as a recording was made, through the same sensors.

use crate::engine::{Halt, Instant, LONGEST_STEP, Schedule, StepControl, run};
use crate::measure::filter::ZeroPhase;
use crate::measure::log::{Channel, Log};
use crate::mechanism::Mechanism;
use crate::scenario::Sensors;
use nalgebra::Vector2;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal, StandardUniform};
use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicU64, Ordering};

/// Longest time between two samples of a simulated force in s: a fine grid for the sensors'
/// low-pass.
const FINE: f64 = 2.5e-4;

/// Speed in m/s by which starts of replicas differ: far below what any sensor sees, and after some
/// e-foldings of a rattling machine its rattle is another.
const START_SPREAD: f64 = 1e-6;

/// What machines are simulated with, and how much they were.
#[derive(Debug)]
pub struct Simulator {
    /// Their instruments.
    pub sensors: Sensors,
    /// How to step.
    pub control: StepControl,
    steps: AtomicU64,
}

impl Simulator {
    /// One that has not simulated anything.
    pub fn new(sensors: Sensors, control: StepControl) -> Self {
        Self { sensors, control, steps: AtomicU64::new(0) }
    }

    /// Steps that were simulated so far: what a calibration takes its time for, on any machine and
    /// whatever the number of threads.
    pub fn steps(&self) -> u64 {
        self.steps.load(Ordering::Relaxed)
    }

    /// Runs a machine from its epoch on.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn run(
        &self,
        machine: &Mechanism,
        schedule: Schedule,
        observe: &mut dyn FnMut(&Instant),
    ) -> Result<(), Halt> {
        let run = run(machine, self.control, schedule, observe);
        let work = run.as_ref().unwrap_or_else(|halt| &halt.work);
        self.steps.fetch_add(work.steps, Ordering::Relaxed);
        run.map(|_| ())
    }

    /// What the sensors would have recorded without noise and rounding: one log a replica.
    ///
    /// `mechanism` starts at its epoch before the log's first row; `replica` chooses the hair by which its
    /// output's start differs from another's.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn record(&self, mechanism: &Mechanism, log: &Log, replica: u64) -> Result<Log, Halt> {
        let mut mechanism = mechanism.clone();
        let mut random = ChaCha8Rng::seed_from_u64(replica);
        let direction = Vector2::from_fn(|_, _| sample(&mut random));
        let output = mechanism.output;
        mechanism.bodies[output].start.twist += (direction * START_SPREAD).push(0.0);
        let longest = mechanism.longest_servo_step().map_or(LONGEST_STEP, |s| s.min(LONGEST_STEP));
        let fine = fine_rows(log.interval, longest);
        let interval = log.interval / fine as f64;
        // The log's rows fall on rows of the simulation: the epoch is a whole number of them.
        let lead = (-mechanism.epoch / interval).round() as usize;
        mechanism.epoch = -(lead as f64) * interval;
        let rows = lead + (log.samples - 1) * fine;
        let mechanism = &mechanism;
        let schedule = Schedule { duration: rows as f64 * interval, interval };
        let drives = mechanism.actuators.len();
        let mut forces = vec![Vec::with_capacity(rows + 1); drives];
        let mut lengths = vec![Vec::with_capacity(log.samples); drives];
        let mut poses = [const { Vec::new() }; 3];
        let (mut row, mut phi) = (0, f64::NAN);
        self.run(mechanism, schedule, &mut |instant| {
            let now = instant.evaluation;
            for (force, value) in forces.iter_mut().zip(&now.drive_forces) {
                force.push(*value);
            }
            if row >= lead && (row - lead).is_multiple_of(fine) {
                for (joint, column) in lengths.iter_mut().enumerate() {
                    column.push(mechanism.encoder(joint, now));
                }
                let output = mechanism.output_state(instant.states);
                let angle = output.rotation.angle();
                let turns = if phi.is_nan() { 0.0 } else { ((phi - angle) / TAU).round() };
                phi = angle + turns * TAU;
                for (column, value) in
                    poses.iter_mut().zip([output.position.x, output.position.y, phi])
                {
                    column.push(value);
                }
            }
            row += 1;
        })?;
        // The angle of a log may count whole turns that a rotation does not know.
        if let Some(measured) = log.get(Channel::Pose(2)) {
            let turns = ((measured[0] - poses[2][0]) / PI / 2.0).round() * TAU;
            poses[2].iter_mut().for_each(|phi| *phi += turns);
        }
        let mut channels = Vec::new();
        for i in 0..drives {
            let command = Channel::Command(i);
            channels.push((command, log.get(command).unwrap_or_default().to_vec()));
        }
        channels.extend(lengths.into_iter().enumerate().map(|(i, q)| (Channel::Length(i), q)));
        let corner = self.sensors.force_lowpass;
        let filter = (corner > 0.0 && corner < 0.5 / interval)
            .then(|| ZeroPhase::butterworth(2, corner, interval));
        for (i, force) in forces.into_iter().enumerate() {
            let force = filter.as_ref().map_or(force.clone(), |filter| filter.apply(&force));
            let rows = force.into_iter().skip(lead).step_by(fine).collect();
            channels.push((Channel::Force(i), rows));
        }
        channels.extend(poses.into_iter().enumerate().map(|(i, pose)| (Channel::Pose(i), pose)));
        channels.retain(|(channel, _)| log.get(*channel).is_some());
        Ok(Log::new(&log.name, log.start, log.interval, channels))
    }
}

/// Rows of a simulation in one of a log: on a fine grid, and steps up to the `longest` reach from row to row
/// without slivers. All times in s.
fn fine_rows(interval: f64, longest: f64) -> usize {
    let least = (interval / FINE).ceil().max(1.0) as usize;
    let steps = |rows: &usize| rows * (interval / (*rows as f64 * longest)).ceil() as usize;
    (least..=2 * least).min_by_key(steps).unwrap_or(least)
}

/// The log with the sensors' noise and rounding.
pub fn with_noise(clean: &Log, sensors: &Sensors, seed: u64) -> Log {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let channels = clean.channels().map(|channel| {
        let values = clean.get(channel).unwrap_or_default();
        // Nobody knows where an encoder's steps lie: each draw rounds in its own places.
        let step = sensors.length_resolution;
        let offset = if matches!(channel, Channel::Length(_)) && step > 0.0 {
            let share: f64 = StandardUniform.sample(&mut random);
            share * step
        } else {
            0.0
        };
        let noisy = values.iter().map(|value| match channel {
            Channel::Command(_) => *value,
            Channel::Length(_) if step > 0.0 => ((value + offset) / step).round() * step - offset,
            Channel::Length(_) => *value,
            Channel::Force(_) => value + sensors.force_std * sample(&mut random),
            Channel::Pose(2) => value + sensors.angle_std * sample(&mut random),
            Channel::Pose(_) => value + sensors.pose_std * sample(&mut random),
        });
        (channel, noisy.collect())
    });
    let channels = channels.collect();
    Log::new(&clean.name, clean.start, clean.interval, channels)
}

/// A standard normal number.
fn sample(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_as_far_apart_as_steps_reach() {
        // 1 ms in 8 steps of 125 µs, 5 of 200 µs, 7 of 143 µs; at 4 kHz each row is one.
        for (interval, longest, rows) in
            [(1e-3, 1.26e-4, 4), (1e-3, 2e-4, 5), (1e-3, 1.5e-4, 7), (2.5e-4, 2e-4, 1)]
        {
            assert_eq!(fine_rows(interval, longest), rows, "{longest}");
        }
    }
}
