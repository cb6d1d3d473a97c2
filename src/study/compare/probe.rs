//! One run of a comparison, boiled down to numbers.

use super::plan::SAMPLE_INTERVAL;
use super::quantities::COUNT;
use crate::engine::Instant;
use crate::mechanism::JointIndex;
use crate::scenario::Scenario;
use crate::simulate::{Machine, Summary, measured_until};
use crate::study::Watch;
use nalgebra::Vector2;

/// Rows in a mean of the acceleration: 10 ms, long against a hit and short against a motion.
const SMOOTHING: usize = 100;

/// What a run came to.
#[derive(Clone, Debug)]
pub struct CompareMeasured {
    /// The compared quantities, in their order; NaN where a law or a machine has none.
    pub values: [f64; COUNT],
    /// Steps per simulated second.
    pub steps_per_s: f64,
    /// Time of computing in s per simulated second.
    pub cost: f64,
    /// Why it stopped early, if it did.
    pub halted: Option<String>,
    /// What it saw of its own faults, in words.
    pub faults: Vec<String>,
    /// Contact forces in N of all joints that touch, at rows after the start that is left out ([`Forces`]).
    pub forces: Vec<f64>,
}

/// Runs a machine and measures it; `watch` sees how much time was simulated, in s, and may end it.
pub fn measure(scenario: &Scenario, machine: &mut Machine, watch: &Watch) -> CompareMeasured {
    let settle = scenario.simulation.settle();
    let mut probe = CompareProbe::default();
    let mut told = 0.0;
    let summary =
        measured_until(scenario, machine, watch.stop(), &mut |mechanism, instant, ideal| {
            if instant.t >= settle {
                let platform = mechanism.output_state(instant.states).twist.xy();
                probe.row(instant, platform - ideal.velocity);
            }
            if instant.t - told > 0.01 {
                watch.come(instant.t - told);
                told = instant.t;
            }
        });
    let left = machine.schedule.duration - told;
    if summary.halted.is_some() {
        watch.spared(left)
    } else {
        watch.come(left)
    }
    probe.finish(summary, machine)
}

/// What a summary does not gather.
#[derive(Debug, Default)]
struct CompareProbe {
    rows: usize,
    /// Difference of the platform's velocity from the ideal one, [`SMOOTHING`] rows ago at most.
    velocity: Vector2<f64>,
    /// Sum and number of squared 10 ms means of the acceleration's deviation.
    smooth: (f64, usize),
    /// Energy taken by the contacts up to the first and the last row, J.
    energy: [f64; 2],
    forces: Forces,
}

impl CompareProbe {
    fn row(&mut self, instant: &Instant, velocity: Vector2<f64>) {
        let energy = instant.tallies.iter().map(|tally| tally.energy).sum();
        if self.rows == 0 {
            self.energy[0] = energy;
        }
        self.energy[1] = energy;
        if self.rows.is_multiple_of(SMOOTHING) {
            if self.rows > 0 {
                let span = SMOOTHING as f64 * SAMPLE_INTERVAL;
                self.smooth.0 += ((velocity - self.velocity) / span).norm_squared();
                self.smooth.1 += 1;
            }
            self.velocity = velocity;
        }
        self.rows += 1;
        self.forces.row(instant.evaluation.contacts.iter().map(|contact| contact.normal_force));
    }

    fn finish(self, s: Summary, machine: &Machine) -> CompareMeasured {
        let forces = self.forces.sorted();
        let clearance = s.joints.iter().any(|joint| joint.clearance_m.is_some());
        // An ideal joint transmits forces, but nothing in it touches or gives way.
        let contact = |value: f64| if clearance { value } else { f64::NAN };
        // Only drives of prismatic joints have forces; torques are not compared.
        let mut actuators = machine.mechanism.actuators.iter();
        let pushes = actuators.any(|a| matches!(a.joint, JointIndex::Prismatic(_)));
        let force = |value: f64| if pushes { value } else { f64::NAN };
        let values = [
            s.rms_path_error_m,
            s.max_path_error_m,
            (self.smooth.0 / self.smooth.1 as f64).sqrt(),
            s.rms_acceleration_deviation_m_s2,
            s.peak_platform_acceleration_m_s2,
            force(s.rms_actuator_force_deviation),
            force(s.peak_actuator_force),
            contact(quantile(&forces, 0.5)),
            contact(quantile(&forces, 0.95)),
            contact(quantile(&forces, 0.99)),
            contact(s.peak_contact_force),
            contact(s.largest_penetration_m),
            contact(s.contact_fraction),
            contact(s.impacts_per_s),
            contact((self.energy[1] - self.energy[0]) / (s.simulated_s - s.settle_s)),
        ];
        let steps_per_s = s.steps as f64 / s.simulated_s;
        let cost = s.wall_s_per_simulated_s;
        let (halted, faults) = (s.halted, s.watched.faults);
        CompareMeasured { values, steps_per_s, cost, halted, faults, forces }
    }
}

/// Contact forces of all joints that touch, row by row, as many as fit: of every row until [`MOST_FORCES`] are
/// there, then of every 2nd row, every 4th, …
#[derive(Debug)]
pub struct Forces {
    /// Each with its row.
    kept: Vec<(usize, f64)>,
    /// One row in so many is kept.
    stride: usize,
    rows: usize,
}

/// Most contact forces kept of a run, 2 MB while it lasts and 1 MB after it: those of the paper's machine for 1.5 s at
/// least. Their 99 % quantile then has a thousand above it.
const MOST_FORCES: usize = 1 << 17;

impl Default for Forces {
    fn default() -> Self {
        Self { kept: Vec::new(), stride: 1, rows: 0 }
    }
}

impl Forces {
    /// Takes the forces of the joints at the next row, in N.
    pub fn row(&mut self, forces: impl Iterator<Item = f64>) {
        let row = self.rows;
        if row.is_multiple_of(self.stride) {
            self.kept.extend(forces.filter(|force| *force > 0.0).map(|force| (row, force)));
        }
        while self.kept.len() > MOST_FORCES {
            self.stride *= 2;
            self.kept.retain(|(row, _)| row.is_multiple_of(self.stride));
        }
        self.rows += 1;
    }

    /// The forces kept, in N, smallest first.
    pub fn sorted(self) -> Vec<f64> {
        let mut forces: Vec<f64> = self.kept.into_iter().map(|(_, force)| force).collect();
        forces.sort_by(f64::total_cmp);
        forces
    }
}

/// The value below which a share of the sorted values lies; NaN of none.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// They were all kept: half a megabyte for each simulated second of each run.
    #[test]
    fn forces_of_a_long_run_are_thinned_row_by_row() {
        let mut forces = Forces::default();
        let rows = 3 * MOST_FORCES;
        for row in 0..rows {
            // Two joints that touch, one at ten times the force of the other, and one that does not.
            let share = row as f64 / rows as f64;
            forces.row([1.0 + share, 0.0, 10.0 + share].into_iter());
        }
        let sorted = forces.sorted();
        assert!(sorted.len() <= MOST_FORCES && 2 * sorted.len() > MOST_FORCES, "{}", sorted.len());
        for (share, expected) in [(0.25, 1.5), (0.75, 10.5), (0.99, 10.98)] {
            assert!((quantile(&sorted, share) - expected).abs() < 1e-3, "{share}");
        }
    }
}
