//! An oil film between the journal and the ring of a revolute joint, as a load.

use crate::contact::Film;
use crate::mechanism::{Bearing, Load, Mechanism, Revolute, Situation};
use nalgebra::{Vector2, Vector3};

/// The film of one revolute joint.
#[derive(Clone, Copy, Debug)]
pub struct OilFilm {
    /// The joint, among the revolute ones.
    pub joint: usize,
    /// Its force.
    pub film: Film,
    /// Radial clearance in m that the film's damping is given for; where there is none, it is given for the clearance that
    /// the joint has. It grows with the inverse cube of that.
    pub clearance: Option<f64>,
}

/// Radial clearance in m; an ideal joint has no gap for a film, and a slider's corner is no bearing.
fn gap(joint: &Revolute) -> Option<f64> {
    match &joint.bearing {
        _ if joint.is_corner() => None,
        Bearing::Ideal => None,
        Bearing::Clearance(clearance) => Some(clearance.radial()),
        Bearing::Native { bearing_radius, journal_radius, .. } => {
            Some(bearing_radius - journal_radius)
        }
    }
}

impl OilFilm {
    /// The film in the gap (m) that the joint has.
    fn in_gap(&self, gap: f64) -> Film {
        let thinner = self.clearance.map_or(1.0, |clearance| (clearance / gap).powi(3));
        Film { damping: self.film.damping * thinner, ..self.film }
    }
}

impl Load for OilFilm {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let joint = &at.mechanism.revolutes[self.joint];
        let Some(clearance) = gap(joint) else { return };
        let (ring, journal) = (joint.ring.frame(at.states), joint.journal.frame(at.states));
        let e = journal.centre - ring.centre;
        let turned = |v: Vector2<f64>| Vector2::new(-v.y, v.x);
        let velocity =
            journal.velocity - ring.velocity - turned(e) * (0.5 * (ring.spin + journal.spin));
        let n = e.try_normalize(0.0).unwrap_or(Vector2::x());
        let t = turned(n);
        let own = Vector2::new(velocity.dot(&n), velocity.dot(&t));
        let [along, across]: [f64; 2] =
            self.in_gap(clearance).force(e.norm() / clearance, own).into();
        let force = n * along + t * across;
        // Through the journal's centre, on both: no moment is made or lost.
        let pushes =
            [(joint.journal.body, journal.arm, force), (joint.ring.body, ring.arm + e, -force)];
        for (body, arm, force) in pushes {
            if let Some(body) = body {
                wrenches[body] += Vector3::new(force.x, force.y, arm.perp(&force));
            }
        }
    }

    /// As long as the film stands where a step may end: in half of what is left of the gap. Shorter steps than those of the
    /// stiffest film win nothing.
    fn longest_step_at(&self, at: Situation) -> Option<f64> {
        let shortest = self.longest_step(at.mechanism)?;
        // Effects, whose damping is given itself, are stepped as they always were.
        if self.clearance.is_none() {
            return Some(shortest);
        }
        let joint = &at.mechanism.revolutes[self.joint];
        let (ring, journal) = (joint.ring.frame(at.states), joint.journal.frame(at.states));
        let clearance = gap(joint)?;
        let ratio = (journal.centre - ring.centre).norm() / clearance;
        let ahead = 0.5 * (1.0 - ratio).max(1.0 - self.film.eccentricity_max);
        let [stiffest, _] = self.in_gap(clearance).full(1.0 - ahead);
        let arrival = ahead * clearance / (journal.velocity - ring.velocity).norm();
        Some((at.mechanism.joint_mass(joint) / stiffest).min(arrival).max(shortest))
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let joint = &mechanism.revolutes[self.joint];
        let [stiffest, _] = self.in_gap(gap(joint)?).full(1.0);
        (stiffest > 0.0).then(|| mechanism.joint_mass(joint) / stiffest)
    }
}
