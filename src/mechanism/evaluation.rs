//! What is known of a mechanism at one instant beside its state.

use super::{Command, Drive, Mechanism};
use crate::contact::Contact;
use nalgebra::{Vector2, Vector3};

/// Everything that is known of a mechanism at one instant beside its state.
///
/// [`Dynamics`](crate::mechanism::Dynamics) has an example.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// Time in s.
    pub t: f64,
    /// Time for which the commands were asked last.
    commanded: f64,
    /// Command of each drive; once something has asked for them at this time.
    pub commands: Vec<Command>,
    /// Wrench of gravity, contacts and servos on each body, about its centre of mass.
    pub wrenches: Vec<Vector3<f64>>,
    /// Acceleration of each body.
    pub accelerations: Vec<Vector3<f64>>,
    /// Contact in each revolute joint; of an ideal one the size of its force.
    pub contacts: Vec<Contact>,
    /// Force of each revolute joint on its journal's body in N, world directions.
    pub reactions: Vec<Vector2<f64>>,
    /// Length of each prismatic joint in m.
    pub lengths: Vec<f64>,
    /// True coordinate of each driven joint in m or rad.
    pub coordinates: Vec<f64>,
    /// Effort of each drive: force on the slider in N, positive when it lengthens the joint; torque on the
    /// journal's body in N·m, positive counterclockwise.
    pub drive_forces: Vec<f64>,
}

impl Evaluation {
    /// An evaluation of the right size, all zero.
    pub fn new(mechanism: &Mechanism) -> Self {
        let bodies = mechanism.bodies.len();
        let drives = mechanism.actuators.len();
        Self {
            t: 0.0,
            commanded: f64::NAN,
            commands: vec![Command::default(); drives],
            wrenches: vec![Vector3::zeros(); bodies],
            accelerations: vec![Vector3::zeros(); bodies],
            contacts: vec![Contact::default(); mechanism.revolutes.len()],
            reactions: vec![Vector2::zeros(); mechanism.revolutes.len()],
            lengths: vec![0.0; mechanism.prismatics.len()],
            coordinates: vec![0.0; drives],
            drive_forces: vec![0.0; drives],
        }
    }

    /// Takes commands at a share of the way between two instants for those of the present time, unless they
    /// are known: over a step they are as good as straight, and inverse kinematics is dear.
    pub fn command_between(&mut self, before: &[Command], after: &[Command], share: f64) {
        if self.commanded == self.t {
            return;
        }
        let between = |a: f64, b: f64| a + (b - a) * share;
        for ((command, a), b) in self.commands.iter_mut().zip(before).zip(after) {
            *command = Command {
                position: between(a.position, b.position),
                rate: between(a.rate, b.rate),
                acceleration: between(a.acceleration, b.acceleration),
            };
        }
        self.commanded = self.t;
    }

    /// Asks for the commands, unless they are those of this time already: inverse kinematics costs
    /// more than all contacts in flight.
    pub(super) fn command(&mut self, mechanism: &Mechanism) {
        if self.commanded != self.t {
            mechanism.commands.at(mechanism.epoch + self.t, &mut self.commands);
            for (command, actuator) in self.commands.iter_mut().zip(&mechanism.actuators) {
                if actuator.drive == Drive::Prescribed && !actuator.reading_errors.is_empty() {
                    *command = actuator.true_command(*command);
                }
            }
            self.commanded = self.t;
        }
    }
}
