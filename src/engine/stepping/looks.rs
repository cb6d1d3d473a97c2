//! Where a way of stepping looked inside a step.

use crate::contact::Contact;

/// Normal forces of all joints at instants inside the last step.
#[derive(Debug, Default)]
pub(in crate::engine) struct Looks {
    /// When, in s, and the force of each joint in N.
    looks: Vec<(f64, Vec<f64>)>,
}

impl Looks {
    /// So many looks at so many joints, none of them taken yet.
    pub fn new(looks: usize, joints: usize) -> Self {
        Self { looks: vec![(f64::NEG_INFINITY, vec![0.0; joints]); looks] }
    }

    /// The `k`-th look, at `t` (s).
    #[inline]
    pub fn set(&mut self, k: usize, t: f64, contacts: &[Contact]) {
        let (at, forces) = &mut self.looks[k];
        *at = t;
        for (force, contact) in forces.iter_mut().zip(contacts) {
            *force = contact.normal_force;
        }
    }

    /// No look was needed in the last step: nothing touches.
    pub fn none(&mut self) {
        for (at, _) in &mut self.looks {
            *at = f64::NEG_INFINITY;
        }
    }

    /// Looks taken after `from` (s), and until `to`.
    pub fn within(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, &[f64])> {
        let looks = self.looks.iter().filter(move |(at, _)| *at > from && *at <= to);
        looks.map(|(at, forces)| (*at, &forces[..]))
    }
}
