//! One run of the study, boiled down to numbers.

use super::items::{COUNT, Item, JUMP};
use crate::engine::Instant;
use crate::scenario::Scenario;
use crate::simulate::{IdealInstant, Machine, measured_until};
use crate::study::Watch;
use crate::study::compare::{Forces, SAMPLE_INTERVAL, quantile};
use nalgebra::Vector3;
use std::collections::VecDeque;
use std::ops::Range;

/// Rows in a mean of the forces: 10 ms, long against a hit and short against a motion.
const SMOOTHING: usize = 100;

/// The measured quantities of one run, in the order of [`Item`].
pub type PaperValues = [f64; COUNT];

/// Channels of the signals: a_x and a_y, then φ'', then the actuator forces.
const LINEAR: Range<usize> = 0..2;
const ANGULAR: Range<usize> = 2..3;
const FORCES: usize = 3;

/// What a run came to.
#[derive(Clone, Debug)]
pub struct PaperMeasured {
    /// The measured quantities.
    pub values: PaperValues,
    /// What it saw of its own faults, in words.
    pub faults: Vec<String>,
}

/// Runs a machine and measures it. `watch` sees how much time was simulated, in s, and may
/// end it. `None` if the run broke down or was ended.
pub fn measure(scenario: &Scenario, machine: &mut Machine, watch: &Watch) -> Option<PaperMeasured> {
    let settle = scenario.simulation.settle();
    let mut probe = PaperProbe::default();
    let mut told = 0.0;
    let s = measured_until(scenario, machine, watch.stop(), &mut |mechanism, instant, ideal| {
        if instant.t >= settle {
            probe.row(instant, mechanism.output, ideal);
        }
        if instant.t - told > 0.02 {
            watch.come(instant.t - told);
            told = instant.t;
        }
    });
    let left = machine.schedule.duration - told;
    if s.halted.is_some() {
        watch.spared(left)
    } else {
        watch.come(left)
    }
    if s.halted.is_some() || s.interrupted {
        return None;
    }

    let mut values = [f64::NAN; COUNT];
    let force_share = |deviation: f64| deviation / probe.ideal.rms(FORCES..probe.ideal.count());
    let contact_forces = probe.contact_forces.sorted();
    for (item, value) in [
        (Item::PeakAcceleration, s.peak_platform_acceleration_m_s2),
        (Item::AccelerationDeviation, s.rms_acceleration_deviation_m_s2),
        (Item::AngularDeviation, (probe.angular_squares / probe.real.rows as f64).sqrt()),
        (Item::PeakActuatorForce, s.peak_actuator_force),
        (Item::ActuatorDeviation, s.rms_actuator_force_deviation),
        (Item::PeakContactForce, s.peak_contact_force),
        (Item::ContactForce99, quantile(&contact_forces, 0.99)),
        (Item::ContactFraction, s.contact_fraction),
        (Item::Impacts, s.impacts_per_s),
        (Item::PathError, s.rms_path_error_m),
        (Item::AccelerationJump, probe.real.jump(LINEAR)),
        (Item::AngularJump, probe.real.jump(ANGULAR)),
        (Item::ForceJump, probe.real.jump(FORCES..probe.real.count())),
        (Item::IdealForceJump, probe.ideal.jump(FORCES..probe.ideal.count())),
        (Item::ForceShare, force_share(s.rms_actuator_force_deviation)),
        (Item::SmoothForceShare, force_share(probe.smooth.rms())),
        (Item::IdealPeakAcceleration, s.ideal_peak_platform_acceleration_m_s2),
        (Item::IdealPeakActuatorForce, s.ideal_peak_actuator_force),
    ] {
        values[item as usize] = value;
    }
    Some(PaperMeasured { values, faults: s.watched.faults })
}

/// What a summary does not gather.
#[derive(Debug, Default)]
struct PaperProbe {
    real: Signals,
    ideal: Signals,
    angular_squares: f64,
    smooth: Smooth,
    contact_forces: Forces,
}

impl PaperProbe {
    fn row(&mut self, instant: &Instant, output: usize, ideal: &IdealInstant) {
        let now = instant.evaluation;
        let acceleration = &now.accelerations[output];
        self.angular_squares += (acceleration.z - ideal.acceleration.z).powi(2);
        self.real.push(channels(acceleration, &now.drive_forces));
        self.ideal.push(channels(&ideal.acceleration, ideal.drive_forces));
        let deviations = now.drive_forces.iter().zip(ideal.drive_forces);
        self.smooth.push(deviations.map(|(force, ideal)| force - ideal).collect());
        self.contact_forces.row(now.contacts.iter().map(|contact| contact.normal_force));
    }
}

fn channels(acceleration: &Vector3<f64>, forces: &[f64]) -> Vec<f64> {
    acceleration.iter().chain(forces).copied().collect()
}

/// Signals that are sampled together, and how they change within [`JUMP`].
#[derive(Debug, Default)]
struct Signals {
    rows: usize,
    channels: Vec<ProbeChannel>,
    /// The samples of the last [`JUMP`].
    recent: VecDeque<Vec<f64>>,
}

#[derive(Clone, Copy, Debug, Default)]
struct ProbeChannel {
    sum: f64,
    squares: f64,
    /// Sum of squared changes.
    changes: f64,
}

impl Signals {
    fn push(&mut self, sample: Vec<f64>) {
        self.rows += 1;
        self.channels.resize(sample.len(), ProbeChannel::default());
        for (channel, value) in self.channels.iter_mut().zip(&sample) {
            channel.sum += value;
            channel.squares += value * value;
        }
        if self.recent.len() == (JUMP / SAMPLE_INTERVAL).round() as usize
            && let Some(before) = self.recent.pop_front()
        {
            for ((channel, value), before) in self.channels.iter_mut().zip(&sample).zip(before) {
                channel.changes += (value - before).powi(2);
            }
        }
        self.recent.push_back(sample);
    }

    fn count(&self) -> usize {
        self.channels.len()
    }

    /// Root mean square change within [`JUMP`], over √2 times the standard deviation, of a vector of
    /// channels.
    fn jump(&self, vector: Range<usize>) -> f64 {
        let rows = self.rows as f64;
        let changes = (self.rows - self.recent.len()) as f64;
        let vector = || self.channels.get(vector.clone()).into_iter().flatten();
        let variance: f64 = vector().map(|c| c.squares / rows - (c.sum / rows).powi(2)).sum();
        let change: f64 = vector().map(|c| c.changes / changes).sum();
        (change / (2.0 * variance)).sqrt()
    }

    /// Root mean square over the rows and a range of channels.
    fn rms(&self, range: Range<usize>) -> f64 {
        let squares: f64 =
            self.channels.get(range.clone()).into_iter().flatten().map(|c| c.squares).sum();
        (squares / (self.rows * range.len()) as f64).sqrt()
    }
}

/// Means of signals over [`SMOOTHING`] rows, and the sum of their squares.
#[derive(Debug, Default)]
struct Smooth {
    sums: Vec<f64>,
    rows: usize,
    squares: f64,
    means: usize,
}

impl Smooth {
    fn push(&mut self, sample: Vec<f64>) {
        self.sums.resize(sample.len(), 0.0);
        for (sum, value) in self.sums.iter_mut().zip(sample) {
            *sum += value;
        }
        self.rows += 1;
        if self.rows.is_multiple_of(SMOOTHING) {
            for sum in &mut self.sums {
                self.squares += (*sum / SMOOTHING as f64).powi(2);
                self.means += 1;
                *sum = 0.0;
            }
        }
    }

    /// Root mean square over all means and signals; NaN if there was no time for one.
    fn rms(&self) -> f64 {
        (self.squares / self.means as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_slow_sine_does_not_jump_and_noise_does() {
        let (mut sine, mut noise) = (Signals::default(), Signals::default());
        let mut state = 1u64;
        for k in 0..10_000 {
            let t = f64::from(k) * SAMPLE_INTERVAL;
            sine.push(vec![0.0, 0.0, 0.0, 5.0 + (TAU * t).sin()]);
            // Numerical Recipes' quick generator.
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223) % (1 << 32);
            noise.push(vec![state as f64 / f64::from(u32::MAX)]);
        }
        // |sin(ωt + ωτ) − sin ωt| has the rms 2 sin(ωτ/2)/√2; over √2 times 1/√2 that is √2 sin(ωτ/2).
        let expected = 2f64.sqrt() * (0.5 * TAU * JUMP).sin();
        assert!((sine.jump(3..4) / expected - 1.0).abs() < 1e-3);
        assert!((noise.jump(0..1) - 1.0).abs() < 0.03);
        assert!((sine.rms(3..4) - 25.5f64.sqrt()).abs() < 1e-3);
    }

    #[test]
    fn smoothing_takes_out_what_is_fast() {
        let mut smooth = Smooth::default();
        assert!(smooth.rms().is_nan());
        for k in 0..SMOOTHING * 3 + 7 {
            smooth.push(vec![2.0 + if k % 2 == 0 { 1.0 } else { -1.0 }]);
        }
        assert!((smooth.rms() - 2.0).abs() < 1e-12);
    }
}
