//! What joints remember of their hits, and how long a step the dampers of their contacts stand.

use super::Dynamics;
use crate::contact::{After, Contact};
use crate::mechanism::{Bearing, Mechanism};

/// Rate in m/s of a contact that counts as at rest where its damping is looked at: slower than any hit that
/// matters, far above rounding.
const SLOW: f64 = 1e-6;

impl Dynamics {
    /// What revolute joint `i` remembers of its contact at time `t` (s).
    pub(super) fn memory(&self, i: usize, t: f64) -> Option<After> {
        self.touches.get(i).map(|touch| touch.after(t - self.touched))
    }

    /// The longest step in s that the dampers of contacts stand, `contacts` being those of the instant last
    /// remembered; infinite where none touches.
    ///
    /// A damper c on a mass m: the velocity at the end of a step follows from an acceleration that depends on it
    /// by `h c/m` times a third; two such times leave a margin. Longer steps do not see that error: what they
    /// predict has it, too, and a rattle below the tolerance feeds on itself.
    pub fn longest_contact_step(&self, mechanism: &Mechanism, contacts: &[Contact]) -> f64 {
        let joints = mechanism.revolutes.iter().zip(contacts).enumerate();
        let touching = joints.filter(|(_, (_, contact))| contact.penetration > 0.0);
        let steps = touching.filter_map(|(i, (joint, contact))| {
            let Bearing::Clearance(clearance) = &joint.bearing else { return None };
            let Contact { penetration, rate, .. } = *contact;
            let damping = if clearance.law.remembers() {
                let speed = self.touches.get(i)?.after(0.0).impact_speed(penetration, rate);
                clearance.law.damping(penetration, speed)
            } else {
                // Approaching, where a law that never pulls is not cut off.
                let force = |rate| clearance.law.normal_force(penetration, rate);
                let rate = rate.abs().max(SLOW);
                ((force(2.0 * rate) - force(rate)) / rate).max(0.0)
            };
            Some(2.0 * mechanism.joint_mass(joint) / damping)
        });
        steps.fold(f64::INFINITY, f64::min)
    }
}
