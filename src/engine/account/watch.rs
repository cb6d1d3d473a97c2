//! What happens between the rows of a run: hits, energy, largest values, whole turns.

use super::wear::Rubbing;
use crate::contact::Contact;
use crate::engine::stepping::stepper::Stepper;
use crate::mechanism::{BodyState, JointIndex, Mechanism, angle_near};
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
#[derive(Clone, Debug)]
pub(in crate::engine) struct RunWatch {
    pub tallies: Vec<Tally>,
    pub peaks: Peaks,
    /// Angle of each body in rad, whole turns counted, when it was looked at last, and its rotation then.
    pub angles: Vec<f64>,
    rotations: Vec<UnitComplex<f64>>,
    /// Time in s until which account is kept, contacts then, and the time of the last row.
    pub t: f64,
    before: Vec<Contact>,
    /// Which joints were seen touching since then.
    seen: Vec<bool>,
    row: f64,
    /// Where journals rub, if somebody wants to know.
    rubbing: Option<Rubbing>,
}

impl RunWatch {
    pub fn new(mechanism: &Mechanism, rubbing: Option<Rubbing>) -> Self {
        let joints = mechanism.revolutes.len();
        Self {
            tallies: vec![Tally::default(); joints],
            peaks: Peaks::default(),
            angles: mechanism.bodies.iter().map(|body| body.angle).collect(),
            rotations: mechanism.bodies.iter().map(|body| body.start.rotation).collect(),
            t: 0.0,
            before: vec![Contact::default(); joints],
            seen: vec![false; joints],
            row: f64::NEG_INFINITY,
            rubbing,
        }
    }

    /// Goes on to the present instant of `stepper`, `t` in s: the end of a step.
    pub fn reach(&mut self, mechanism: &Mechanism, t: f64, stepper: &dyn Stepper) {
        self.take(mechanism, t, stepper, true);
    }

    /// Goes on to an instant `t` (s) inside the step that begins where it stands, only to be looked at: where rows
    /// are must not change what is counted, so that hits are those that the step itself saw.
    pub fn look(&mut self, mechanism: &Mechanism, t: f64, stepper: &dyn Stepper) {
        self.take(mechanism, t, stepper, false);
    }

    /// See [`Work::rubbed`](crate::engine::Work::rubbed).
    pub fn rubbed(&self) -> Option<&[Vec<f64>]> {
        self.rubbing.as_ref().map(|rubbing| &rubbing.around[..])
    }

    fn take(&mut self, mechanism: &Mechanism, t: f64, stepper: &dyn Stepper, end: bool) {
        if let Some(rubbing) = &mut self.rubbing {
            rubbing.count(mechanism, stepper, t - self.t);
        }
        let contacts = &stepper.evaluation().contacts;
        self.take_work(t, contacts, stepper);
        for (seen, contact) in self.seen.iter_mut().zip(contacts) {
            *seen = end && contact.normal_force > 0.0;
        }
        for (at, forces) in stepper.looks().into_iter().flat_map(|looks| looks.within(self.t, t)) {
            let new = at > self.row;
            for ((tally, seen), force) in self.tallies.iter_mut().zip(&mut self.seen).zip(forces) {
                *seen |= *force > 0.0;
                if new && *force > tally.peak {
                    tally.peak = *force;
                }
            }
        }
        for ((tally, contact), seen) in self.tallies.iter_mut().zip(contacts).zip(&self.seen) {
            tally.peak = tally.peak.max(contact.normal_force);
            if tally.touching {
                tally.contact_time += t - self.t;
            } else {
                tally.impacts += u64::from(*seen);
            }
            tally.touching = contact.normal_force > 0.0;
        }
        self.take_drives(mechanism, stepper);
        // An arc tangent a step is dear; whole turns are counted as well every quarter of a turn.
        let due = |before: &UnitComplex<f64>, now: &UnitComplex<f64>| {
            before.re * now.re + before.im * now.im <= 0.0
        };
        self.look_at_angles(stepper.states(), due);
        self.t = t;
    }

    /// Keeps account of energy. An impulse J between the rates a and b takes `J (a + b)/2`, exactly;
    /// for a force that varies over the step this is the trapezoidal rule. A way of stepping that integrates the
    /// work itself knows better.
    fn take_work(&mut self, t: f64, contacts: &[Contact], stepper: &dyn Stepper) {
        if let Some(work) = stepper.joint_work() {
            for (tally, work) in self.tallies.iter_mut().zip(work) {
                tally.energy += work;
            }
            return;
        }
        let (mean_forces, dt) = (stepper.mean_forces(), t - self.t);
        for ((tally, now), before) in self.tallies.iter_mut().zip(contacts).zip(&mut self.before) {
            let [was, is] = [before.normal_force, now.normal_force];
            let force = if mean_forces { is } else { 0.5 * (was + is) };
            tally.energy += force * 0.5 * (before.rate + now.rate) * dt;
            *before = *now;
        }
    }

    /// Keeps the largest acceleration and drive forces.
    fn take_drives(&mut self, mechanism: &Mechanism, stepper: &dyn Stepper) {
        let (states, now) = (stepper.states(), stepper.evaluation());
        let acceleration = mechanism.output_acceleration(states, &now.accelerations).xy().norm();
        self.peaks.acceleration = self.peaks.acceleration.max(acceleration);
        for (actuator, effort) in mechanism.actuators.iter().zip(&now.drive_forces) {
            let peak = match actuator.joint {
                JointIndex::Prismatic(_) => &mut self.peaks.drive_force,
                JointIndex::Revolute(_) => &mut self.peaks.drive_torque,
            };
            *peak = peak.max(effort.abs());
        }
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

    /// Called after the row at `t` (s), the present instant of `stepper`, was handed out: the next one's largest
    /// values begin with those of this one.
    pub fn new_row(&mut self, mechanism: &Mechanism, t: f64, stepper: &dyn Stepper) {
        self.row = t;
        self.peaks = Peaks::default();
        self.take_drives(mechanism, stepper);
        for (tally, contact) in self.tallies.iter_mut().zip(&stepper.evaluation().contacts) {
            tally.peak = contact.normal_force;
        }
    }
}
