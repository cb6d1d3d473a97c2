//! What acts on a mechanism beside gravity, contacts and drives.

use super::{BodyState, Drive, Mechanism};
use nalgebra::{Vector2, Vector3};
use std::fmt::Debug;

/// A mechanism at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// Time in s.
    pub t: f64,
    /// What moves.
    pub mechanism: &'a Mechanism,
    /// State of each body.
    pub states: &'a [BodyState],
}

/// A load on the bodies that follows from time and their states.
pub trait Load: Debug + Send + Sync {
    /// Adds the load's wrenches (N, N, N·m about each centre of mass) to those of the bodies.
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]);

    /// The longest step in s (fixed step, explicit) that the load stands on this mechanism, or `None`
    /// where it sets no limit: a damper c on a mass m needs `h c/m ≤ 1` (unstable from 2).
    fn longest_step(&self, _mechanism: &Mechanism) -> Option<f64> {
        None
    }
}

impl Situation<'_> {
    /// Adds a force (N) at the reference point of the output body, and a torque (N·m).
    pub fn push_output(self, force: Vector2<f64>, torque: f64, wrenches: &mut [Vector3<f64>]) {
        let output = self.mechanism.output;
        let arm = self.states[output].rotation * self.mechanism.bodies[output].reference;
        wrenches[output] += Vector3::new(force.x, force.y, torque + arm.perp(&force));
    }

    /// Length (m) and rate (m/s) that prismatic joint `index` really has.
    pub fn length(self, index: usize) -> [f64; 2] {
        let joint = self.mechanism.prismatics[index].telescope(self.states);
        [joint.length, joint.length_rate]
    }

    /// Adds a force (N, positive when it extends) between cylinder and rod of prismatic joint `index`.
    pub fn push_rod(self, index: usize, force: f64, wrenches: &mut [Vector3<f64>]) {
        let joint = &self.mechanism.prismatics[index];
        let pair = joint.telescope(self.states).drive(force);
        for (body, wrench) in [joint.cylinder.body, joint.rod.body].into_iter().zip(pair) {
            if let Some(body) = body {
                wrenches[body] += wrench;
            }
        }
    }
}

impl Mechanism {
    /// The longest step in s that a damper of at most `damping` N·s/m along prismatic joint `index`
    /// stands, or `None` where there is none; a prescribed length does not heed it.
    pub fn rod_damper_step(&self, index: usize, damping: f64) -> Option<f64> {
        let joint = &self.prismatics[index];
        let felt = joint.drive != Drive::Prescribed && damping > 0.0;
        felt.then(|| self.stroke_mass(joint) / damping)
    }
}
