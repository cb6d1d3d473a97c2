//! Whether a machine rattles: found out, not assumed.

use super::replica::Simulator;
use crate::engine::Halt;
use crate::measure::log::{Channel, Log};
use crate::mechanism::Mechanism;
use crate::scenario::Sensors;
use rayon::prelude::*;

/// Simulations that a floor and a bias are taken from where replicas differ: the mean of six misses
/// the true one by 40 % of a replica's own scatter, and time grows with their number.
pub const REPLICAS: usize = 6;

/// Root mean square of the difference of two replicas, as a share of the sensor's noise, above which
/// they differ by more than sensors see: a tenth of the noise's variance.
pub const SEEN: f64 = 0.3;

/// What stands for the noise of sensors that declare none: a good tracker's micrometre, ten
/// microradians, a hundredth of a newton.
const EXACT: [f64; 3] = [1e-6, 1e-5, 1e-2];

/// What two replicas of a machine say of its rattle.
#[derive(Clone, Debug)]
pub struct Rattle {
    /// Whether they differ by more than sensors see.
    pub chaotic: bool,
    /// How many replicas a calibration or a prediction takes.
    pub replicas: usize,
    /// Their largest difference of all channels: root mean square, in units of the sensor's noise.
    pub difference: f64,
    /// The channel of that difference.
    pub channel: Channel,
    /// The noiseless logs of both.
    pub logs: Vec<Log>,
}

/// Simulates two replicas of a machine along a log, and decides by their difference.
///
/// # Errors
/// A run that broke down.
pub fn look(simulator: &Simulator, mechanism: &Mechanism, log: &Log) -> Result<Rattle, Halt> {
    let simulated = |replica| simulator.record(mechanism, log, replica);
    let logs = (0..2u64).into_par_iter().map(simulated).collect::<Result<Vec<_>, _>>()?;
    let (channel, difference) = difference(&logs[0], &logs[1], &simulator.sensors);
    let chaotic = difference > SEEN;
    let replicas = if chaotic { REPLICAS } else { 1 };
    Ok(Rattle { chaotic, replicas, difference, channel, logs })
}

/// The largest difference of two logs of all channels, root mean square in units of the sensor's noise,
/// and its channel.
pub fn difference(a: &Log, b: &Log, sensors: &Sensors) -> (Channel, f64) {
    let differences = a.channels().filter_map(|channel| {
        let noise = noise(sensors, channel)?;
        let [a, b] = [a.get(channel)?, b.get(channel)?];
        let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        Some((channel, (squares / a.len() as f64).sqrt() / noise))
    });
    // A machine without any channel has nothing that could differ.
    differences.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((Channel::Force(0), 0.0))
}

/// Share of a swing that is left two seconds later of three where it dies at all: with loaded joints it
/// dies within one to two.
const LASTING: f64 = 0.5;

/// Whether a swing, what two starts of one machine differ by, is still seen in the last third of their
/// logs and has hardly fallen since the first: it dies where joints stay loaded, and stays where they
/// rattle.
pub fn swing_lasts(a: &Log, b: &Log, sensors: &Sensors) -> bool {
    let third = |k: usize| {
        let rows = || k * a.samples / 3..(k + 1) * a.samples / 3;
        difference(&a.part(rows()), &b.part(rows()), sensors).1
    };
    let last = third(2);
    last > SEEN && last > LASTING * third(0)
}

/// Standard deviation of a channel's noise in its unit; none of commands, which are known. Rounding to
/// steps of h is noise of `h/√12`.
pub fn noise(sensors: &Sensors, channel: Channel) -> Option<f64> {
    let (declared, exact) = match channel {
        Channel::Command(_) => return None,
        Channel::Length(_) => (sensors.length_resolution / 12f64.sqrt(), EXACT[0]),
        Channel::Pose(2) => (sensors.angle_std, EXACT[1]),
        Channel::Pose(_) => (sensors.pose_std, EXACT[0]),
        Channel::Force(_) => (sensors.force_std, EXACT[2]),
    };
    Some(if declared > 0.0 { declared } else { exact })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A log of 3 s whose `x` swings at 40 Hz with this amplitude in m over time in s.
    fn swinging(amplitude: impl Fn(f64) -> f64) -> Log {
        let x = (0..3000).map(|i| f64::from(i) * 1e-3);
        let x = x.map(|t| amplitude(t) * (TAU * 40.0 * t).sin()).collect();
        Log::new("swing.csv", 0.0, 1e-3, vec![(Channel::Pose(0), x)])
    }

    #[test]
    fn a_swing_that_dies_is_told_from_one_that_lasts() {
        let sensors = Sensors { pose_std: 1e-6, ..Sensors::default() };
        let still = swinging(|_| 0.0);
        // As dies, hardly seen, not yet dead, and driven for ever.
        for (log, lasts) in [
            (swinging(|t| 1e-4 * (-3.0 * t).exp()), false),
            (swinging(|_| 2e-7), false),
            (swinging(|t| 1e-4 * (-t).exp()), false),
            (swinging(|_| 1e-5), true),
        ] {
            assert_eq!(swing_lasts(&log, &still, &sensors), lasts);
        }
    }
}
