//! One run of a comparison, boiled down to numbers.

use super::SAMPLE_INTERVAL;
use super::quantities::COUNT;
use crate::engine::{self, Instant, Work};
use crate::mechanism::JointIndex;
use crate::scenario::Scenario;
use crate::simulate::{Machine, Recorder};
use nalgebra::Vector2;
use std::time::Instant as Clock;

/// Rows in a mean of the acceleration: 10 ms, long against a hit and short against a motion.
const SMOOTHING: usize = 100;

/// What a run came to.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The compared quantities, in their order; NaN where a law or a machine has none.
    pub values: [f64; COUNT],
    /// Steps per simulated second.
    pub steps_per_s: f64,
    /// Time of computing in s per simulated second.
    pub cost: f64,
    /// Why it stopped early, if it did.
    pub halted: Option<String>,
    /// Contact forces in N of all joints that touch, at the rows after the start that is left out.
    pub forces: Vec<f64>,
}

/// Runs a machine and measures it; `progress` is told how much time was simulated since it was told
/// last, in s.
pub fn measure(
    scenario: &Scenario,
    machine: &mut Machine,
    progress: &mut dyn FnMut(f64),
) -> Measured {
    let started = Clock::now();
    let settle = scenario.simulation.settle();
    let mechanism = &machine.mechanism;
    let mut recorder = Recorder::new(mechanism, settle);
    let mut probe = Probe::default();
    let ideal = &mut machine.ideal;
    let mut told = 0.0;
    let ended = engine::run(mechanism, machine.control, machine.schedule, &mut |instant| {
        let ideal = ideal.at(instant.t);
        recorder.row(mechanism, instant, &ideal);
        if instant.t >= settle {
            let platform = mechanism.output_state(instant.states).twist.xy();
            probe.row(instant, platform - ideal.velocity);
        }
        if instant.t - told > 0.01 {
            progress(instant.t - told);
            told = instant.t;
        }
    });
    progress(machine.schedule.duration - told);
    let (work, halted) = match ended {
        Ok(work) => (work, None),
        Err(halt) => (*halt.work, Some(halt.to_string())),
    };
    probe.finish(recorder, scenario, machine, work, started.elapsed().as_secs_f64(), halted)
}

/// What a summary does not gather.
#[derive(Debug, Default)]
struct Probe {
    rows: usize,
    /// Difference of the platform's velocity from the ideal one, [`SMOOTHING`] rows ago at most.
    velocity: Vector2<f64>,
    /// Sum and number of squared 10 ms means of the acceleration's deviation.
    smooth: (f64, usize),
    /// Energy taken by the contacts up to the first and the last row, J.
    energy: [f64; 2],
    forces: Vec<f64>,
}

impl Probe {
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
        let forces = instant.evaluation.contacts.iter().map(|contact| contact.normal_force);
        self.forces.extend(forces.filter(|force| *force > 0.0));
    }

    fn finish(
        mut self,
        recorder: Recorder,
        scenario: &Scenario,
        machine: &Machine,
        work: Work,
        wall: f64,
        halted: Option<String>,
    ) -> Measured {
        let s = recorder.finish(scenario, machine, work, wall, halted, Vec::new());
        self.forces.sort_by(f64::total_cmp);
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
            contact(quantile(&self.forces, 0.5)),
            contact(quantile(&self.forces, 0.95)),
            contact(quantile(&self.forces, 0.99)),
            contact(s.peak_contact_force),
            contact(s.largest_penetration_m),
            contact(s.contact_fraction),
            contact(s.impacts_per_s),
            contact((self.energy[1] - self.energy[0]) / (s.simulated_s - s.settle_s)),
        ];
        let steps_per_s = s.steps as f64 / s.simulated_s;
        let cost = s.wall_s_per_simulated_s;
        Measured { values, steps_per_s, cost, halted: s.halted, forces: self.forces }
    }
}

/// The value below which a share of the sorted values lies; NaN of none.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}
