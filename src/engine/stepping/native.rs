//! The same mechanism under rapier's own contacts, for comparison.
//!
//! Nothing is corrected here: rapier steps as it always does (semi-implicit Euler), and what it
//! reports are impulses. Forces, accelerations and drive forces of a row are the means over the
//! step that ended there.
//!
//! What its contacts are: a journal that would reach the ring within the step is stopped there at
//! once, by a rigid row (rapier calls such contacts speculative); its force is `m v/dt`, without a
//! limit as the step shrinks. A journal that lies in the ring feels a spring and damper. As the stop
//! leaves a journal an arbitrary share of its speed, which the spring then returns, slow hits lose as
//! much as hard ones, where the contact law lets slow ones go nearly lossless: journals come to rest
//! on their rings, and the share of time in contact is large (impulses above zero are counted, nothing
//! else). A restitution does not help: rapier applies it to the two bodies alone, after all joints, and
//! the next step's joints take most of it back. With
//! [`predictive`](crate::mechanism::NativeContacts::predictive) off a hook drops the rigid rows, and
//! the spring alone has limits like any law.

use super::stepper::{Stepper, even_step};
use crate::engine::physics::world::{MotorTarget, World, joint_advance};
use crate::mechanism::{BodyState, Command, Drive, Dynamics, Evaluation, Mechanism};
use nalgebra::Vector3;

/// Steps of equal length with rapier's contact solver.
pub(in crate::engine) struct NativeSteps {
    step: f64,
    last: f64,
    world: World,
    dynamics: Dynamics,
    states: Vec<BodyState>,
    now: Evaluation,
    targets: Vec<Command>,
}

impl NativeSteps {
    /// Steps of at most `step` s.
    pub fn new(mechanism: &Mechanism, step: f64) -> Self {
        let world = World::new(mechanism, true);
        let mut states = vec![BodyState::ground(); mechanism.bodies.len()];
        world.read(&mut states);
        Self {
            step,
            last: 0.0,
            world,
            dynamics: Dynamics::new(mechanism),
            states,
            now: Evaluation::new(mechanism),
            targets: vec![Command::default(); mechanism.actuators.len()],
        }
    }
}

impl Stepper for NativeSteps {
    fn synchronise(&mut self, mechanism: &Mechanism, t: f64) {
        self.dynamics.forces(mechanism, t, &self.states, &mut self.now);
        if self.last > 0.0 {
            for (i, contact) in self.now.contacts.iter_mut().enumerate() {
                if let Some(impulse) = self.world.joint_impulse(i) {
                    contact.normal_force = impulse / self.last;
                }
            }
            for (i, joint) in mechanism.prismatics.iter().enumerate() {
                self.now.lengths[i] = joint.length(&self.states);
            }
            for (i, actuator) in mechanism.actuators.iter().enumerate() {
                self.now.coordinates[i] = self.dynamics.coordinate(mechanism, i, &self.states)[0];
                if actuator.drive == Drive::Prescribed {
                    self.now.drive_forces[i] = self.world.motor_impulse(i) / self.last;
                }
            }
        } else {
            // Before the first step the ideal joints' accelerations are the only ones there are.
            self.dynamics.accelerations(mechanism, &self.states, &mut self.now);
        }
    }

    fn states(&self) -> &[BodyState] {
        &self.states
    }

    fn evaluation(&self) -> &Evaluation {
        &self.now
    }

    /// Impulses are means over the step: there is nothing to look for inside it.
    fn mean_forces(&self) -> bool {
        true
    }

    fn sample(&mut self, mechanism: &Mechanism, t: f64, due: &[bool]) {
        self.dynamics.sample(mechanism, t, &self.states, due);
        self.dynamics.forces(mechanism, t, &self.states, &mut self.now);
    }

    fn advance(&mut self, mechanism: &Mechanism, t: f64, until: f64) -> f64 {
        self.dynamics.remember(mechanism, t, &self.states);
        let (dt, reached) = even_step(self.step, t, until);
        mechanism.true_commands(reached, &mut self.targets);
        let before: Vec<Vector3<f64>> = self.states.iter().map(|s| s.twist).collect();
        let targets = |i: usize| {
            let length = self.targets[self.dynamics.prescribed(i)?].position;
            Some(MotorTarget { length, side: mechanism.prismatics[i].points()[0].y })
        };
        let advances =
            |i: usize| joint_advance(self.targets[i].position - self.now.coordinates[i], 0.0);
        self.world.step(dt, &self.now.wrenches, None, targets, advances);
        self.world.read(&mut self.states);
        for ((a, state), before) in self.now.accelerations.iter_mut().zip(&self.states).zip(before)
        {
            *a = (state.twist - before) / dt;
        }
        self.last = dt;
        reached
    }
}
