//! When the next journal reaches its ring, and how far a step may reach into that contact.

use crate::contact::{Clearance, Contact};
use crate::mechanism::{Bearing, BodyState, Mechanism};

/// Share of the tolerance that a step may miss of the push of a contact which begins inside it.
///
/// Behind its onset the force is `K (v τ)^n`, which no polynomial follows: of the push `F(τ) τ/m` that a step
/// takes up in the reach τ it misses a fixed part. Found on the paper's machine: half as much costs a tenth more
/// evaluations for the same error, twice as much has steps refused.
const PART: f64 = 30.0;

/// When a journal reaches its ring, if nothing accelerated any of the two until then.
#[derive(Clone, Copy, Debug)]
pub struct Onset {
    /// Time until then in s.
    pub time: f64,
    /// Speed at which it then closes in, in m/s.
    pub speed: f64,
    /// Index of the joint.
    joint: usize,
}

/// The next onset of contact of all journals in flight.
pub fn next_onset(
    mechanism: &Mechanism,
    states: &[BodyState],
    contacts: &[Contact],
) -> Option<Onset> {
    let mut next: Option<Onset> = None;
    for (joint, (revolute, contact)) in mechanism.revolutes.iter().zip(contacts).enumerate() {
        if !matches!(revolute.bearing, Bearing::Clearance(_)) || contact.penetration > 0.0 {
            continue;
        }
        if revolute.is_corner() {
            let time = -contact.penetration / contact.rate.max(0.0);
            if next.is_none_or(|next| time < next.time) {
                next = Some(Onset { time, speed: contact.rate, joint });
            }
            continue;
        }
        let (ring, journal) = (revolute.ring.frame(states), revolute.journal.frame(states));
        let (e, v) = (contact.eccentricity, journal.velocity - ring.velocity);
        // `|e + v τ| = c`, c that of a ring out of round in the direction of e.
        let gap = -contact.penetration;
        let distance = e.norm();
        let rest = gap * (gap + 2.0 * distance);
        let along = e.dot(&v);
        let root = (along * along + v.norm_squared() * rest).sqrt();
        // A journal at rest in the middle never arrives: x/0 = ∞.
        let time = rest / (root + along);
        if next.is_none_or(|next| time < next.time) {
            next = Some(Onset { time, speed: root / (distance + gap), joint });
        }
    }
    next
}

impl Onset {
    /// How long in s a step may go on after the onset so that what it misses of the contact's push is the
    /// `tolerance` (m/s): τ from `F(v τ, v) τ/m = tolerance` times a constant.
    pub fn reach(&self, mechanism: &Mechanism, tolerance: f64) -> f64 {
        let joint = &mechanism.revolutes[self.joint];
        let Bearing::Clearance(Clearance { law, .. }) = &joint.bearing else {
            return f64::INFINITY;
        };
        let wanted = PART * tolerance * mechanism.joint_mass(joint);
        let push = |reach: f64| law.normal_force(self.speed * reach, self.speed) * reach;
        // The push grows with τ^2.5 under Hertz's law and no slower than τ under any: few rounds do.
        let mut reach = 1e-6;
        for _ in 0..4 {
            let ratio = wanted / push(reach);
            if !(ratio.is_finite() && ratio > 0.0) {
                break;
            }
            reach *= ratio.powf(0.4);
        }
        reach
    }
}
