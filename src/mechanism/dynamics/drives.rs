//! What drives read, what their controllers hold, and the efforts that follow.

use super::Dynamics;
use super::contacts::add;
use crate::mechanism::equations::telescope::Telescope;
use crate::mechanism::{BodyState, Command, Drive, Evaluation, JointIndex, Mechanism, angle_near};
use nalgebra::Vector3;

impl Dynamics {
    /// True coordinate (m or rad, whole turns counted from the last step's end) and rate of the joint of
    /// drive `index`.
    #[inline]
    pub fn coordinate(
        &mut self,
        mechanism: &Mechanism,
        index: usize,
        states: &[BodyState],
    ) -> [f64; 2] {
        match mechanism.actuators[index].joint {
            JointIndex::Prismatic(i) => {
                let state = &mut self.prismatics[i];
                *state = Telescope::on(&self.ways[i], states);
                [state.length, state.length_rate]
            }
            JointIndex::Revolute(i) => {
                let joint = &mechanism.revolutes[i];
                [angle_near(joint.rotation(states), self.angles[index]), joint.spin(states)]
            }
        }
    }

    /// Lets the sampled controllers that are `due` compute what they hold from time `t` (s) on.
    pub fn sample(&mut self, mechanism: &Mechanism, t: f64, states: &[BodyState], due: &[bool]) {
        let mut commands = vec![Command::default(); mechanism.actuators.len()];
        let now = mechanism.epoch + t;
        mechanism.commands.at(now, &mut commands);
        for (i, actuator) in mechanism.actuators.iter().enumerate() {
            if let Drive::Sampled(cascade) = actuator.drive
                && due[i]
            {
                let [position, rate] = self.coordinate(mechanism, i, states);
                let [position, _] = actuator.read(position, rate);
                let added = mechanism.commands.added(i, now);
                cascade.sample(&mut self.held[i], t, &commands[i], position, added);
            }
        }
    }

    /// Adds the efforts of all drives but prescribed ones.
    pub(super) fn drive(
        &mut self,
        mechanism: &Mechanism,
        t: f64,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        match &self.servos {
            None => self.drive_any(mechanism, t, states, out),
            Some(servos) if servos.is_empty() => {}
            Some(servos) => {
                out.command(mechanism);
                for servo in servos {
                    let state = servo.telescope(states);
                    servo.push(&state, out);
                    self.prismatics[servo.joint] = state;
                }
            }
        }
    }

    /// The same of drives of all kinds.
    pub(super) fn drive_any(
        &mut self,
        mechanism: &Mechanism,
        t: f64,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        for (i, actuator) in mechanism.actuators.iter().enumerate() {
            if actuator.drive == Drive::Prescribed {
                continue;
            }
            let [position, rate] = self.coordinate(mechanism, i, states);
            out.coordinates[i] = position;
            let effort = match actuator.drive {
                Drive::Prescribed => continue,
                Drive::Sampled(cascade) => cascade.force(&self.held[i], t),
                Drive::Effort => {
                    out.command(mechanism);
                    out.commands[i].position
                }
                Drive::Servo { stiffness, damping } => {
                    out.command(mechanism);
                    let command = &out.commands[i];
                    let [position, rate] = actuator.read(position, rate);
                    let (error, error_rate) = (command.position - position, command.rate - rate);
                    match &actuator.transmission {
                        None => stiffness * error + damping * error_rate,
                        Some(link) => link.force([stiffness, damping], error, error_rate),
                    }
                }
            };
            out.drive_forces[i] = effort;
            match actuator.joint {
                JointIndex::Prismatic(joint) => {
                    let [on_base, on_slider] = self.prismatics[joint].drive(effort);
                    let joint = &mechanism.prismatics[joint];
                    add(&mut out.wrenches, joint.base.body, on_base);
                    add(&mut out.wrenches, joint.slider.body, on_slider);
                }
                JointIndex::Revolute(joint) => {
                    let joint = &mechanism.revolutes[joint];
                    add(&mut out.wrenches, joint.ring.body, Vector3::new(0.0, 0.0, -effort));
                    add(&mut out.wrenches, joint.journal.body, Vector3::new(0.0, 0.0, effort));
                }
            }
        }
    }
}
