//! What happens between the rows of a run: hits, energy, largest values, whole turns.

use super::stepper::Stepper;
use crate::contact::Contact;
use crate::mechanism::{BodyState, Evaluation, JointIndex, Mechanism, angle_near};
use nalgebra::UnitComplex;

/// What one joint has gone through.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Largest normal force in N since the row before.
    pub peak: f64,
    /// Contacts begun since the start.
    pub impacts: u64,
    /// Time in contact since the start, in s.
    pub contact_time: f64,
    /// Energy that the normal force has taken from the bodies since the start, in J, `∫ F_N δ̇ dt`:
    /// what the contact dissipated and, while it is touching, what it holds as a spring.
    pub energy: f64,
    /// Touching at the present instant.
    pub touching: bool,
}

/// Largest values since the row before, over all steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peaks {
    /// Of the output body's acceleration |(a_x, a_y)| in m/s².
    pub acceleration: f64,
    /// Of the force |F| of a drive of a prismatic joint in N.
    pub drive_force: f64,
    /// Of the torque of a drive of a revolute joint in N·m.
    pub drive_torque: f64,
}

/// Keeps account of what happens between rows.
#[derive(Debug)]
pub(super) struct Watch {
    pub tallies: Vec<Tally>,
    pub peaks: Peaks,
    /// Angle of each body in rad, whole turns counted, when it was looked at last, and its rotation then.
    pub angles: Vec<f64>,
    rotations: Vec<UnitComplex<f64>>,
    /// Contacts at the instant before, and the time in s since then.
    before: Vec<Contact>,
    dt: f64,
}

impl Watch {
    pub fn new(mechanism: &Mechanism) -> Self {
        let joints = mechanism.revolutes.len();
        Self {
            tallies: vec![Tally::default(); joints],
            peaks: Peaks::default(),
            angles: mechanism.bodies.iter().map(|body| body.angle).collect(),
            rotations: mechanism.bodies.iter().map(|body| body.start.rotation).collect(),
            before: vec![Contact::default(); joints],
            dt: 0.0,
        }
    }

    /// Keeps account of energy. An impulse J between the rates a and b takes `J (a + b)/2`, exactly;
    /// for a force that varies over the step this is the trapezoidal rule. A way of stepping that integrates the
    /// work itself knows better.
    pub fn account(&mut self, contacts: &[Contact], stepper: &dyn Stepper) {
        let mean_forces = stepper.mean_forces();
        if let Some(work) = stepper.joint_work() {
            for (tally, work) in self.tallies.iter_mut().zip(work) {
                tally.energy += work;
            }
            return;
        }
        for ((tally, now), before) in self.tallies.iter_mut().zip(contacts).zip(&mut self.before) {
            let [was, is] = [before.normal_force, now.normal_force];
            let force = if mean_forces { is } else { 0.5 * (was + is) };
            tally.energy += force * 0.5 * (before.rate + now.rate) * self.dt;
            *before = *now;
        }
        // A row's instant is looked at twice: the step that ended there counts once.
        self.dt = 0.0;
    }

    pub fn record(
        &mut self,
        mechanism: &Mechanism,
        states: &[BodyState],
        now: &Evaluation,
        stepper: &dyn Stepper,
    ) {
        for (tally, peak) in self.tallies.iter_mut().zip(stepper.peaks_inside()) {
            tally.peak = tally.peak.max(*peak);
        }
        for (tally, brush) in self.tallies.iter_mut().zip(stepper.brushes()) {
            tally.impacts += u64::from(*brush);
        }
        for (tally, contact) in self.tallies.iter_mut().zip(&now.contacts) {
            let touching = contact.normal_force > 0.0;
            tally.peak = tally.peak.max(contact.normal_force);
            tally.impacts += u64::from(touching && !tally.touching);
            tally.touching = touching;
        }
        let acceleration = mechanism.output_acceleration(states, &now.accelerations).xy().norm();
        self.peaks.acceleration = self.peaks.acceleration.max(acceleration);
        for (actuator, effort) in mechanism.actuators.iter().zip(&now.drive_forces) {
            let peak = match actuator.joint {
                JointIndex::Prismatic(_) => &mut self.peaks.drive_force,
                JointIndex::Revolute(_) => &mut self.peaks.drive_torque,
            };
            *peak = peak.max(effort.abs());
        }
        // An arc tangent a step is dear; whole turns are counted as well every quarter of a turn.
        self.look_at_angles(states, |before, now| before.re * now.re + before.im * now.im <= 0.0);
    }

    /// Brings angles up to date, those of bodies for whose rotations then and now it is `due`.
    pub fn look_at_angles(
        &mut self,
        states: &[BodyState],
        due: impl Fn(&UnitComplex<f64>, &UnitComplex<f64>) -> bool,
    ) {
        let angles = self.angles.iter_mut().zip(&mut self.rotations);
        for ((angle, rotation), state) in angles.zip(states) {
            if due(rotation, &state.rotation) {
                *angle = angle_near(state.rotation, *angle);
                *rotation = state.rotation;
            }
        }
    }

    pub fn elapse(&mut self, dt: f64) {
        self.dt = dt;
        for tally in self.tallies.iter_mut().filter(|tally| tally.touching) {
            tally.contact_time += dt;
        }
    }

    /// Called after a row was handed out.
    pub fn new_row(&mut self) {
        self.peaks = Peaks::default();
        for tally in &mut self.tallies {
            tally.peak = 0.0;
        }
    }
}
