//! `summary.json`: the main figures of a run, gathered row by row in constant memory.

use super::provenance::Provenance;
use super::watched::Watched;
use crate::engine::{Instant, Work};
use crate::mechanism::{Bearing, JointIndex, Mechanism};
use crate::model::{Ideal, IdealInstant, Machine, radial_clearance};
use crate::scenario::{Law, Scenario};
use serde::Serialize;

/// The main figures of a run. Peaks, means and fractions leave out the first `settle_s` seconds; all
/// of them are NaN (`null` in JSON) if a run ended before.
///
/// [`Recorder`] has an example.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Program, versions, scenario.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Contact law.
    pub law: Law,
    /// Kind of the drives; "none" without any, "mixed" where they differ.
    pub drive: &'static str,
    /// Fixed step asked for in s, if it is fixed.
    pub step_s: Option<f64>,
    /// Velocity error allowed for one step in m/s, if the step follows it.
    pub tolerance_m_s: Option<f64>,
    /// Why the run stopped early, if it did.
    pub halted: Option<String>,
    /// Whether it was told to stop before its end.
    pub interrupted: bool,
    /// Time reached in s.
    pub simulated_s: f64,
    /// Start left out of the figures below, in s.
    pub settle_s: f64,
    /// Largest normal force in any joint in N, over all steps.
    #[serde(rename = "peak_contact_force_N")]
    pub peak_contact_force: f64,
    /// Largest |(a_x, a_y)| of the output body in m/s², over all steps.
    pub peak_platform_acceleration_m_s2: f64,
    /// Largest |F| of any drive of a prismatic joint in N, over all steps.
    #[serde(rename = "peak_actuator_force_N")]
    pub peak_actuator_force: f64,
    /// Largest torque of a drive of a revolute joint in N·m, over all steps; none without such drives.
    #[serde(rename = "peak_actuator_torque_Nm", skip_serializing_if = "Option::is_none")]
    pub peak_actuator_torque: Option<f64>,
    /// The same of the ideal machine, over all rows and, where these are far apart, between them.
    #[serde(rename = "ideal_peak_actuator_torque_Nm", skip_serializing_if = "Option::is_none")]
    pub ideal_peak_actuator_torque: Option<f64>,
    /// The same of the ideal machine, over all rows and, where these are far apart, between them.
    pub ideal_peak_platform_acceleration_m_s2: f64,
    /// The same of the ideal machine, over all rows and, where these are far apart, between them.
    #[serde(rename = "ideal_peak_actuator_force_N")]
    pub ideal_peak_actuator_force: f64,
    /// Root mean square over the rows of the distance from the ideal position, in m.
    pub rms_path_error_m: f64,
    /// Largest such distance of a row in m.
    pub max_path_error_m: f64,
    /// Root mean square over the rows of |(a_x, a_y) − ideal| in m/s².
    pub rms_acceleration_deviation_m_s2: f64,
    /// Root mean square over the rows and the drives of F − ideal, in N.
    #[serde(rename = "rms_actuator_force_deviation_N")]
    pub rms_actuator_force_deviation: f64,
    /// The same of the drives of revolute joints, in N·m; none without such drives.
    #[serde(rename = "rms_actuator_torque_deviation_Nm", skip_serializing_if = "Option::is_none")]
    pub rms_actuator_torque_deviation: Option<f64>,
    /// Share of time that a joint spends in contact, mean of all joints.
    pub contact_fraction: f64,
    /// Contacts begun in all joints.
    pub impacts: u64,
    /// Contacts begun per second.
    pub impacts_per_s: f64,
    /// Largest |e| − c of a row in any joint, in m; zero if no row saw a penetration.
    pub largest_penetration_m: f64,
    /// Largest Lyapunov exponent in 1/s, from one pair of runs a hair apart over the first 0.2 s; none
    /// where no joint has clearance under a law, and where nobody looked.
    pub lyapunov_exponent_1_s: Option<f64>,
    /// Time in s until which the run's own error at the output body, with what chaos makes of it,
    /// stays below 1 µm; none if it does so for the first 0.2 s, or where there is no exponent.
    pub predictability_horizon_s: Option<f64>,
    /// Steps of the physics engine, from the very start.
    pub steps: u64,
    /// Shortest step in s.
    pub smallest_step_s: f64,
    /// Longest step in s.
    pub largest_step_s: f64,
    /// Largest velocity error of a step in m/s by its own estimate; `null` for fixed steps.
    pub step_error_m_s: Option<f64>,
    /// Time that simulating took in s, writing the time series included.
    pub wall_s: f64,
    /// The same per simulated second.
    pub wall_s_per_simulated_s: f64,
    /// What the run saw of its own errors.
    pub watched: Watched,
    /// Joint by joint, in the order of the columns.
    pub joints: Vec<JointSummary>,
    /// What stands beside this file.
    pub files: Vec<String>,
}

impl Summary {
    /// Whether no joint has clearance.
    pub fn without_play(&self) -> bool {
        self.joints.iter().all(|joint| joint.clearance_m.is_none())
    }

    /// Largest effort of the drives and that of the ideal machine's, each with its unit: forces of prismatic
    /// joints, torques of revolute ones.
    pub fn drive_peaks(&self) -> Vec<(f64, f64, &'static str)> {
        let torque = self.peak_actuator_torque.zip(self.ideal_peak_actuator_torque);
        let torque = torque.map(|(peak, ideal)| (peak, ideal, "N m"));
        let force = (self.peak_actuator_force, self.ideal_peak_actuator_force, "N");
        let pushes = self.drive != "none" && (torque.is_none() || force.0 > 0.0);
        pushes.then_some(force).into_iter().chain(torque).collect()
    }

    /// Whether the run got past the start that is left out, so that there are figures at all.
    pub fn has_figures(&self) -> bool {
        self.impacts_per_s.is_finite()
    }
}

/// One joint's share of a [`Summary`].
#[derive(Clone, Debug, Serialize)]
pub struct JointSummary {
    /// Name.
    pub joint: String,
    /// Radial clearance in m; none of an ideal joint.
    pub clearance_m: Option<f64>,
    /// Largest normal force in N, over all steps.
    #[serde(rename = "peak_force_N")]
    pub peak_force: f64,
    /// Share of time in contact.
    pub contact_fraction: f64,
    /// Contacts begun.
    pub impacts: u64,
    /// Largest |e| of a row in m.
    pub max_eccentricity_m: f64,
    /// Normal force times sliding distance in J, which wear is in proportion to (Archard); none of an ideal joint, of
    /// native contacts, and of a run that broke down.
    #[serde(rename = "wear_J", skip_serializing_if = "Option::is_none")]
    pub wear: Option<f64>,
}

/// Gathers a [`Summary`].
///
/// ```
/// use freeplay::prelude::*;
///
/// let sets = ["simulation.duration=0.02", "simulation.settle=0"].map(str::to_owned);
/// let scenario = Scenario::load(None, &sets)?;
/// let mut machine = assemble(&scenario)?;
/// let mut recorder = Recorder::new(&machine.mechanism, scenario.simulation.settle());
/// let work = run(&machine.mechanism, machine.control, machine.schedule, &mut |instant| {
///     recorder.row(&machine.mechanism, instant, &machine.ideal.at(instant.t));
/// })?;
/// let summary = recorder.finish(&scenario, &machine, &work, 0.0, None, Vec::new());
/// assert_eq!((summary.simulated_s, summary.joints.len()), (0.02, 6));
/// assert!(summary.rms_path_error_m < 2e-3, "of the size of the clearance");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Recorder {
    settle: f64,
    /// Time of the first row after the start that is left out, and of the last row, in s.
    span: Option<[f64; 2]>,
    rows: u64,
    rows_without_ideal: u64,
    /// Sums over the rows of squared deviations: position, acceleration, drive forces, drive torques.
    squares: [f64; 4],
    peak_acceleration: f64,
    peak_drive_force: f64,
    peak_drive_torque: f64,
    /// Of acceleration, drive forces, drive torques.
    ideal_peaks: [f64; 3],
    max_path_error: f64,
    joints: Vec<JointRecord>,
    /// What journals had rubbed at the first row counted, J.
    rubbed: Vec<Vec<f64>>,
}

/// Longest time in s between two looks at the machine without clearance: ten rows by default.
const LONGEST_LOOK: f64 = 5e-3;

#[derive(Clone, Debug)]
struct JointRecord {
    name: String,
    clearance: Option<f64>,
    peak: f64,
    max_eccentricity: f64,
    /// Impacts and time in contact at the first row counted, and at the last.
    impacts: [u64; 2],
    contact_time: [f64; 2],
}

impl Recorder {
    /// An empty record that leaves out the first `settle` s.
    pub fn new(mechanism: &Mechanism, settle: f64) -> Self {
        let joints = mechanism.revolutes.iter().map(|joint| JointRecord {
            name: joint.name.clone(),
            clearance: radial_clearance(&joint.bearing),
            peak: f64::NAN,
            max_eccentricity: f64::NAN,
            impacts: [0; 2],
            contact_time: [0.0; 2],
        });
        Self {
            // Rows meant to stand at the end of the start may fall a rounding error before it.
            settle: settle * (1.0 - 1e-9),
            span: None,
            rows: 0,
            rows_without_ideal: 0,
            squares: [0.0; 4],
            // f64::max takes the other value for a NaN: the first one counted.
            peak_acceleration: f64::NAN,
            peak_drive_force: f64::NAN,
            peak_drive_torque: f64::NAN,
            ideal_peaks: [f64::NAN; 3],
            max_path_error: f64::NAN,
            joints: joints.collect(),
            rubbed: Vec::new(),
        }
    }

    /// Takes the next row.
    pub fn row(&mut self, mechanism: &Mechanism, instant: &Instant, ideal: &IdealInstant) {
        if instant.t < self.settle {
            return;
        }
        let now = instant.evaluation;
        let first = self.span.is_none();
        if first {
            self.rubbed = instant.rubbed.map(<[_]>::to_vec).unwrap_or_default();
        }
        let start = self.span.map_or(instant.t, |[start, _]| start);
        self.span = Some([start, instant.t]);

        let states = instant.states;
        let acceleration = mechanism.output_acceleration(states, &now.accelerations);
        let acceleration = (acceleration - ideal.acceleration).xy();
        let path_error = (mechanism.output_state(states).position - ideal.position).norm();
        let turns = |i: usize| matches!(mechanism.actuators[i].joint, JointIndex::Revolute(_));
        let deviation = |of_revolute: bool| {
            let drives = (0..now.drive_forces.len()).filter(|&i| turns(i) == of_revolute);
            let square = |i: usize| (now.drive_forces[i] - ideal.drive_forces[i]).powi(2);
            let count = drives.clone().count().max(1) as f64;
            drives.map(square).sum::<f64>() / count
        };
        let deviations = [
            path_error * path_error,
            acceleration.norm_squared(),
            deviation(false),
            deviation(true),
        ];
        for (sum, square) in self.squares.iter_mut().zip(deviations) {
            *sum += square;
        }
        self.rows += 1;
        let known = ideal.position.sum() + ideal.acceleration.sum();
        let known = known + ideal.drive_forces.iter().sum::<f64>();
        self.rows_without_ideal += u64::from(!known.is_finite());
        self.max_path_error = self.max_path_error.max(path_error);
        self.ideal_peaks(mechanism, ideal);

        for ((joint, contact), tally) in
            self.joints.iter_mut().zip(&now.contacts).zip(instant.tallies)
        {
            let side = usize::from(!first);
            joint.impacts[side..].fill(tally.impacts);
            joint.contact_time[side..].fill(tally.contact_time);
            joint.max_eccentricity = joint.max_eccentricity.max(contact.eccentricity.norm());
        }
        // The peaks of a row go back to the row before, which must have been counted too; before
        // the first row of all there is nothing.
        if !first || instant.t == 0.0 {
            self.peak_acceleration = self.peak_acceleration.max(instant.peaks.acceleration);
            self.peak_drive_force = self.peak_drive_force.max(instant.peaks.drive_force);
            self.peak_drive_torque = self.peak_drive_torque.max(instant.peaks.drive_torque);
            for (joint, tally) in self.joints.iter_mut().zip(instant.tallies) {
                joint.peak = joint.peak.max(tally.peak);
            }
        }
    }

    /// The machine without clearance at the next row, of time `t` (s), after looks at it since the last one: peaks between
    /// rows that are far apart would be missed.
    pub fn ideal_at<'i>(
        &mut self,
        mechanism: &Mechanism,
        ideal: &'i mut Ideal,
        t: f64,
    ) -> IdealInstant<'i> {
        if ideal.is_kinematic() && t >= self.settle {
            let last = self.span.map_or(self.settle, |[_, last]| last);
            // 1e-9 forgives rounding.
            let looks = ((t - last) / LONGEST_LOOK * (1.0 - 1e-9)).ceil();
            for k in 1..looks as usize {
                let between = ideal.at(last + (t - last) * k as f64 / looks);
                self.ideal_peaks(mechanism, &between);
            }
        }
        ideal.at(t)
    }

    fn ideal_peaks(&mut self, mechanism: &Mechanism, ideal: &IdealInstant) {
        let turns = |i: usize| matches!(mechanism.actuators[i].joint, JointIndex::Revolute(_));
        let largest = |of_revolute: bool| {
            let drives = (0..ideal.drive_forces.len()).filter(|&i| turns(i) == of_revolute);
            drives.fold(0.0f64, |peak, i| peak.max(ideal.drive_forces[i].abs()))
        };
        let now = [ideal.acceleration.xy().norm(), largest(false), largest(true)];
        for (peak, now) in self.ideal_peaks.iter_mut().zip(now) {
            *peak = peak.max(now);
        }
    }

    /// Normal force times sliding distance of each joint in J, in the directions of
    /// [`Work::rubbed`](crate::engine::Work::rubbed), of a run that took `work`; none where nothing is known.
    pub fn rubbed(&self, work: &Work) -> Option<Vec<Vec<f64>>> {
        let joints = work.rubbed.as_ref()?.iter().zip(&self.rubbed);
        let since = |(now, then): (&Vec<f64>, &Vec<f64>)| {
            now.iter().zip(then).map(|(now, then)| now - then).collect()
        };
        self.span.map(|_| joints.map(since).collect())
    }

    /// Time in s that the figures are of.
    pub fn counted(&self) -> f64 {
        self.span.map_or(0.0, |[start, end]| end - start)
    }

    /// The summary of a run that took `work` and `wall` s, `halted` if it broke down, and wrote
    /// `files`.
    pub fn finish(
        self,
        scenario: &Scenario,
        machine: &Machine,
        work: &Work,
        wall: f64,
        halted: Option<String>,
        files: Vec<String>,
    ) -> Summary {
        let time = self.counted();
        let rubbed = self.rubbed(work);
        let rms = |k: usize| (self.squares[k] / self.rows as f64).sqrt();
        let worn = |i: usize| -> Option<f64> {
            let by_law = matches!(machine.mechanism.revolutes[i].bearing, Bearing::Clearance(_));
            Some(rubbed.as_ref().filter(|_| by_law)?[i].iter().sum())
        };
        let joints = self.joints.iter().enumerate();
        let joints: Vec<JointSummary> =
            joints.map(|(i, joint)| joint.summary(time, worn(i))).collect();
        let impacts = joints.iter().map(|joint| joint.impacts).sum();
        let fractions: f64 = joints.iter().map(|joint| joint.contact_fraction).sum();
        let penetration = |joint: &JointRecord| Some(joint.max_eccentricity - joint.clearance?);
        let mut actuators = machine.mechanism.actuators.iter();
        let torques = actuators.any(|a| matches!(a.joint, JointIndex::Revolute(_)));
        Summary {
            provenance: Provenance::of(scenario),
            seed: scenario.seed,
            law: scenario.contact.law,
            drive: machine.drives,
            step_s: machine.control.step(),
            tolerance_m_s: machine.control.tolerance(),
            halted,
            interrupted: work.stopped,
            simulated_s: work.reached,
            settle_s: scenario.simulation.settle(),
            peak_contact_force: joints.iter().map(|j| j.peak_force).fold(f64::NAN, f64::max),
            peak_platform_acceleration_m_s2: self.peak_acceleration,
            peak_actuator_force: self.peak_drive_force,
            ideal_peak_platform_acceleration_m_s2: self.ideal_peaks[0],
            ideal_peak_actuator_force: self.ideal_peaks[1],
            peak_actuator_torque: torques.then_some(self.peak_drive_torque),
            ideal_peak_actuator_torque: torques.then_some(self.ideal_peaks[2]),
            rms_path_error_m: rms(0),
            max_path_error_m: self.max_path_error,
            rms_acceleration_deviation_m_s2: rms(1),
            rms_actuator_force_deviation: rms(2),
            rms_actuator_torque_deviation: torques.then_some(rms(3)),
            contact_fraction: fractions / joints.len() as f64,
            impacts,
            impacts_per_s: impacts as f64 / time,
            largest_penetration_m: self.joints.iter().filter_map(penetration).fold(0.0, f64::max),
            lyapunov_exponent_1_s: None,
            predictability_horizon_s: None,
            steps: work.steps,
            smallest_step_s: work.smallest_step,
            step_error_m_s: work.step_error,
            largest_step_s: work.largest_step,
            wall_s: wall,
            wall_s_per_simulated_s: wall / work.reached,
            watched: Watched::new(work, self.rows_without_ideal),
            joints,
            files,
        }
    }
}

impl JointRecord {
    fn summary(&self, time: f64, wear: Option<f64>) -> JointSummary {
        JointSummary {
            joint: self.name.clone(),
            clearance_m: self.clearance,
            peak_force: self.peak,
            contact_fraction: (self.contact_time[1] - self.contact_time[0]) / time,
            impacts: self.impacts[1] - self.impacts[0],
            max_eccentricity_m: self.max_eccentricity,
            wear,
        }
    }
}
