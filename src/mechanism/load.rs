//! What acts on a mechanism beside gravity, contacts and drives.

use super::{BodyState, Mechanism};
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
