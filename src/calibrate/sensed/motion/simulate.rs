//! What the sensors of a machine would have recorded.

use super::start::told_by;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::position_sensor;
use crate::engine::{Halt, LONGEST_STEP, Schedule, StepControl, run_while};
use crate::measure::filter::ZeroPhase;
use crate::measure::spline::CubicSpline;
use crate::mechanism::{Drive, Mechanism, Reads, Sensor};
use nalgebra::Vector2;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal, StandardUniform};
use std::ops::ControlFlow;
use std::sync::atomic::AtomicBool;

/// Longest time between two samples of a simulation in s: a fine grid for the sensors' low-passes.
const FINE: f64 = 2.5e-4;

/// Speed in m/s by which starts of replicas differ: far below what any sensor sees, and after some e-foldings of a
/// rattling machine its rattle is another.
const SPREAD: f64 = 1e-6;

/// Each replica's tolerance as a share of the one before: other steps, other errors. Joints that lift off now and
/// then have forgotten how they started, and what happens then hangs on the last hair before.
const FINER: f64 = 0.9;

/// Noiseless samples of each sensor at the rows of `like`, of those that it has: the machine starts at its epoch
/// before the first row. `replica` chooses the hair by which the start and the steps differ
/// from another's.
///
/// # Errors
/// A run that broke down.
pub fn record(
    machine: &Mechanism,
    control: StepControl,
    like: &Recording,
    replica: u64,
) -> Result<Recording, Halt> {
    Ok(record_counting(machine, control, like, replica, u64::MAX)?.0)
}

/// The same, and the steps of bodies that it took, which are to be no more than `most`.
///
/// # Errors
/// As [`record`], and more steps than that.
pub fn record_counting(
    machine: &Mechanism,
    control: StepControl,
    like: &Recording,
    replica: u64,
    most: u64,
) -> Result<(Recording, u64), Halt> {
    let control = control.with_tolerance_times(FINER.powi(replica as i32));
    let mut machine = machine.clone();
    let mut random = ChaCha8Rng::seed_from_u64(replica);
    let direction: Vector2<f64> = Vector2::from_fn(|_, _| StandardNormal.sample(&mut random));
    let output = machine.output;
    machine.bodies[output].start.twist += (direction * SPREAD).push(0.0);
    let longest = machine.longest_servo_step().map_or(LONGEST_STEP, |s| s.min(LONGEST_STEP));
    let fine = fine_rows(like.interval, longest);
    let interval = like.interval / fine as f64;
    let lead = (-machine.epoch / interval).round() as usize;
    machine.epoch = -(lead as f64) * interval;
    let rows = lead + (like.samples - 1) * fine;
    let schedule = Schedule { duration: rows as f64 * interval, interval };
    let machine = &machine;
    let commands = |i: usize| machine.sensors[i].tells();
    let read: Vec<usize> =
        (0..machine.sensors.len()).filter(|&i| like.get(i).is_some() && !commands(i)).collect();
    let mut columns: Vec<Vec<f64>> = read.iter().map(|_| Vec::with_capacity(rows + 1)).collect();
    let bodies = machine.bodies.len() as u64;
    let mut beyond = None;
    let work = run_while(machine, control, schedule, &AtomicBool::new(false), &mut |instant| {
        if instant.steps.saturating_mul(bodies) > most {
            beyond = Some(instant.t);
            return ControlFlow::Break(());
        }
        for (&i, column) in read.iter().zip(&mut columns) {
            let sensor = &machine.sensors[i];
            let (states, angles) = (instant.states, instant.angles);
            column.push(match sensor.reads {
                // A controller makes its output of this.
                Reads::Output(drive) => machine.encoder(drive, instant.evaluation),
                _ => sensor.reading(machine, states, angles, instant.evaluation),
            });
        }
        ControlFlow::Continue(())
    })?;
    if let Some(t) = beyond {
        let what = format!("{} steps", work.steps);
        let cause = "which is more than this model is worth".to_owned();
        return Err(Halt { t, what, cause, work: work.into() });
    }
    let command = |i| like.get(i).filter(|_| commands(i)).map(<[f64]>::to_vec);
    let mut recorded: Vec<Option<Vec<f64>>> = (0..machine.sensors.len()).map(command).collect();
    for (&i, column) in read.iter().zip(columns) {
        let sensor = &machine.sensors[i];
        recorded[i] = Some(match sensor.reads {
            Reads::Output(drive) => {
                let read: Vec<f64> = column[lead..].iter().step_by(fine).copied().collect();
                let outputs = outputs(machine, like, drive, &read);
                outputs.into_iter().map(|value| sensor.scale * value + sensor.offset).collect()
            }
            _ => shown(sensor, column, interval, lead, fine),
        });
    }
    Ok((like.with(recorded), work.steps * bodies))
}

/// What the sampled controller of a drive asks of it (N or N·m) at the rows of a recording where it reads these
/// coordinates; nothing of other drives and without commands.
pub(in crate::calibrate::sensed) fn outputs(
    machine: &Mechanism,
    recording: &Recording,
    drive: usize,
    read: &[f64],
) -> Vec<f64> {
    let commands = told_by(machine, recording, Reads::Command(drive));
    let added = told_by(machine, recording, Reads::Added(drive));
    match (machine.actuators[drive].drive, commands) {
        (Drive::Sampled(cascade), Some(commands)) => cascade.outputs(commands, read, added),
        _ => vec![0.0; read.len()],
    }
}

/// What a sensor shows at every `fine`-th of the samples from `lead` on.
fn shown(sensor: &Sensor, mut read: Vec<f64>, interval: f64, lead: usize, fine: usize) -> Vec<f64> {
    if sensor.lowpass > 0.0 && sensor.lowpass < 0.5 / interval {
        read = ZeroPhase::butterworth(2, sensor.lowpass, interval).apply(&read);
    }
    let rows = lead..read.len();
    let late: Vec<f64> = if sensor.delay == 0.0 {
        rows.step_by(fine).map(|row| read[row]).collect()
    } else {
        let t: Vec<f64> = (0..read.len()).map(|row| row as f64 * interval).collect();
        let spline = CubicSpline::natural(&t, &read);
        rows.step_by(fine).map(|row| spline.at((t[row] - sensor.delay).max(0.0))[0]).collect()
    };
    late.into_iter().map(|value| sensor.scale * value + sensor.offset).collect()
}

/// Rows of a simulation in one of a recording: on a fine grid, and steps up to the `longest` reach from row to
/// row without slivers. All times in s.
fn fine_rows(interval: f64, longest: f64) -> usize {
    let least = (interval / FINE).ceil().max(1.0) as usize;
    let steps = |rows: &usize| rows * (interval / (*rows as f64 * longest)).ceil() as usize;
    (least..=2 * least).min_by_key(steps).unwrap_or(least)
}

/// Noise in a sensor's unit where it declares none: a recording holds so many digits of its range.
const EXACT: f64 = 1e-5;

/// Standard deviation of a sensor's noise, rounding to steps of h among it as noise of `h/√12`; where it
/// declares none, a share of the range of `values`.
pub fn deviation(sensor: &Sensor, values: &[f64]) -> f64 {
    let declared = sensor.std.hypot(sensor.resolution / 12f64.sqrt());
    if declared > 0.0 {
        return declared;
    }
    let (low, high) =
        values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
    (EXACT * (high - low)).max(f64::MIN_POSITIVE)
}

/// Root mean square of the difference of two recordings in the column of a sensor, in units of its noise.
fn apart_in(sensors: &[Sensor], i: usize, [a, b]: [&Recording; 2]) -> Option<f64> {
    let (a, b) = (a.get(i)?, b.get(i)?);
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    Some((squares / a.len() as f64).sqrt() / deviation(&sensors[i], a))
}

/// Largest root mean square of the difference of two recordings in a column, in units of its sensor's noise.
pub fn apart(sensors: &[Sensor], a: &Recording, b: &Recording) -> f64 {
    (0..sensors.len()).filter_map(|i| apart_in(sensors, i, [a, b])).fold(0.0, f64::max)
}

/// By how many times noise and what it is apart from another replica a noiseless one of a model misses a recording, in the column
/// where that is most.
pub fn misses_by(sensors: &[Sensor], recording: &Recording, replicas: [&Recording; 2]) -> f64 {
    let of = |i| {
        let missed = apart_in(sensors, i, [replicas[0], recording])?;
        Some(missed / apart_in(sensors, i, replicas)?.hypot(1.0))
    };
    (0..sensors.len()).filter_map(of).fold(0.0, f64::max)
}

/// The recording with the noise of the machine's sensors and what controllers that read them make of it.
pub fn noisy(clean: &Recording, machine: &Mechanism, seed: u64) -> Recording {
    let seen = with_noise(clean, &machine.sensors, seed);
    let column = |(i, sensor): (usize, &Sensor)| {
        let values = seen.get(i)?.to_vec();
        let Reads::Output(drive) = sensor.reads else { return Some(values) };
        let encoder = position_sensor(machine, machine.actuators[drive].joint);
        let pair = encoder.and_then(|i| seen.get(i).zip(clean.get(i)));
        let Some([noisy, exact]) =
            pair.map(|(a, b)| [a, b].map(|read| outputs(machine, clean, drive, read)))
        else {
            return Some(values);
        };
        let more = noisy.iter().zip(&exact).map(|(noisy, exact)| noisy - exact);
        Some(values.iter().zip(more).map(|(value, more)| value + more).collect())
    };
    let columns: Vec<Option<Vec<f64>>> = machine.sensors.iter().enumerate().map(column).collect();
    seen.with(columns)
}

/// The recording with the sensors' noise and rounding; what machines are told is known.
pub fn with_noise(clean: &Recording, sensors: &[Sensor], seed: u64) -> Recording {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let columns = sensors.iter().enumerate().map(|(i, sensor)| {
        let values = clean.get(i)?;
        if sensor.tells() {
            return Some(values.to_vec());
        }
        let Sensor { std, resolution: step, .. } = *sensor;
        // Nobody knows where an encoder's steps lie: each draw rounds in its own places.
        let share: f64 = StandardUniform.sample(&mut random);
        let offset = share * step;
        let noisy = values.iter().map(|value| {
            let noise: f64 = if std > 0.0 { StandardNormal.sample(&mut random) } else { 0.0 };
            let value = value + std * noise;
            if step > 0.0 { ((value + offset) / step).round() * step - offset } else { value }
        });
        Some(noisy.collect())
    });
    clean.with(columns.collect())
}
