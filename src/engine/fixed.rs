//! Stepping at a fixed step: leapfrog, second order in time.

use super::leapfrog::Leapfrog;
use super::run::{Stepper, equal_step};
use super::world::{Target, World};
use crate::mechanism::{Bearing, BodyState, Command, Dynamics, Evaluation, Mechanism};
use nalgebra::Vector3;

/// Steps of equal length under the forces of the present state.
pub(super) struct Fixed {
    step: f64,
    world: World,
    leapfrog: Leapfrog,
    dynamics: Dynamics,
    now: Evaluation,
    targets: Vec<Command>,
    wrenches: Vec<Vector3<f64>>,
    /// Ideal joints close loops, which one sweep of rapier's solver does not: it is handed the
    /// joint forces with the others, and has only the drift to correct.
    loops: bool,
}

impl Fixed {
    /// Steps of at most `step` s.
    pub fn new(mechanism: &Mechanism, step: f64) -> Self {
        let world = World::new(mechanism, false);
        Self {
            step,
            leapfrog: Leapfrog::new(world.handles.clone(), &world.physics().bodies),
            world,
            dynamics: Dynamics::new(mechanism),
            now: Evaluation::new(mechanism),
            targets: vec![Command::default(); mechanism.prismatics.len()],
            wrenches: vec![Vector3::zeros(); mechanism.bodies.len()],
            loops: mechanism.revolutes.iter().any(|j| matches!(j.bearing, Bearing::Ideal)),
        }
    }
}

impl Stepper for Fixed {
    fn synchronise(&mut self, mechanism: &Mechanism, t: f64) {
        let states = self.leapfrog.states();
        self.dynamics.forces(mechanism, t, states, &mut self.now);
        self.dynamics.accelerations(mechanism, states, &mut self.now);
        if self.loops {
            self.dynamics.replace_wrenches(&mut self.now);
        }
    }

    fn states(&self) -> &[BodyState] {
        self.leapfrog.states()
    }

    fn evaluation(&self) -> &Evaluation {
        &self.now
    }

    fn advance(&mut self, mechanism: &Mechanism, t: f64, until: f64) -> f64 {
        let (dt, reached) = equal_step(self.step, t, until);
        let kick = self.leapfrog.kick();
        for (i, wrench) in self.wrenches.iter_mut().enumerate() {
            *wrench = self.now.wrenches[i] * kick;
        }
        mechanism.commands.at(reached, &mut self.targets);
        let (states, now) = (self.leapfrog.states(), &self.now);
        self.world.step(dt, &self.wrenches, |i| {
            let joint = &mechanism.prismatics[i];
            let turn = joint.cylinder.body.map_or(0.0, |body| {
                (states[body].twist.z + now.accelerations[body].z * (0.5 * dt)) * dt
            });
            Target::new(joint, self.targets[i].length, now.lengths[i], turn)
        });
        self.leapfrog.record(&self.world.physics().bodies, dt);
        reached
    }
}
