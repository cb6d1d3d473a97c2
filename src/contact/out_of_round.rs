//! A bearing ring that is not a circle.

use super::{After, Clearance, Contact, Frame};
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Directions on each side of a force in which the place is sought where a journal rests, and steps of Newton's method
/// from the best one: a wide place is seen by several of them, and ten degrees away each step squares the error.
const SCANNED: i32 = 16;
const NEWTON: usize = 4;

/// A harmonic departure of the clearance from its mean, fixed to the ring's body: with θ the direction
/// of the eccentricity in the body's own axes,
///
/// `c(θ) = c + a cos(n (θ − θ₀))`.
///
/// Two lobes are an oval, three what a three-jaw chuck leaves (roundness as a Fourier series, ISO
/// 12181-1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutOfRound {
    /// Amplitude a in m, smaller than the clearance.
    pub amplitude: f64,
    /// Number n of lobes round the ring.
    pub lobes: f64,
    /// Direction θ₀ in rad of one of the widest places.
    pub direction: f64,
}

impl OutOfRound {
    /// What it adds to the clearance in m, and its derivative in m/rad, in direction `theta` (rad).
    fn at(&self, theta: f64) -> [f64; 2] {
        let (sin, cos) = (self.lobes * (theta - self.direction)).sin_cos();
        [self.amplitude * cos, -self.amplitude * self.lobes * sin]
    }

    /// Eccentricity in m of a journal that rests on the ring `depth` m deep under a force along the unit vector
    /// `along`: there the gradient of the penetration is along the force. `radial` is the mean clearance in m, `turned`
    /// the rotation of the ring's body.
    pub fn resting(
        &self,
        radial: f64,
        depth: f64,
        turned: UnitComplex<f64>,
        along: Vector2<f64>,
    ) -> Vector2<f64> {
        let own = turned.inverse() * along;
        let pressed = own.y.atan2(own.x);
        let distance = |wider: f64| radial + depth + wider;
        let mut theta = pressed;
        // It lies as far along the force as the ring lets it: c cos(θ − pressed) is largest.
        let along = |theta: f64| distance(self.at(theta)[0]) * (theta - pressed).cos();
        for k in 1..=SCANNED {
            for side in [-1.0, 1.0] {
                let there = pressed + side * FRAC_PI_2 * f64::from(k) / f64::from(SCANNED);
                if along(there) > along(theta) {
                    theta = there;
                }
            }
        }
        for _ in 0..NEWTON {
            let ([wider, slope], (sin, cos)) = (self.at(theta), (theta - pressed).sin_cos());
            let first = slope * cos - distance(wider) * sin;
            let bend = -self.lobes.powi(2) * wider;
            let second = (bend - distance(wider)) * cos - 2.0 * slope * sin;
            theta -= first / second.min(-f64::MIN_POSITIVE);
        }
        turned * (UnitComplex::new(theta) * Vector2::new(distance(self.at(theta)[0]), 0.0))
    }

    /// Forces in the joint, as [`Clearance::forces`] has them for a round ring; `turned` is the rotation
    /// of the ring's body, `memory` what a law that remembers has of the joint.
    ///
    /// With δ = |e| − c(θ), the normal force acts along
    ///
    /// `∇δ = n − (c′/|e|) t`, `δ̇ = ∇δ·(ė − ω × e)`
    ///
    /// (t is n turned by +90°, ω the ring's angular velocity), through the journal's centre: the work of
    /// `F_N ∇δ` on both bodies is `−F_N δ̇`, so that an elastic law keeps energy on any ring.
    pub fn forces(
        &self,
        clearance: &Clearance,
        memory: Option<After>,
        turned: UnitComplex<f64>,
        bearing: &Frame,
        journal: &Frame,
    ) -> (Contact, Option<[Vector3<f64>; 2]>) {
        let eccentricity = journal.centre - bearing.centre;
        let distance = eccentricity.norm();
        let n = if distance > 0.0 { eccentricity / distance } else { Vector2::x() };
        let own = turned.inverse() * n;
        let [wider, slope] = self.at(own.y.atan2(own.x));
        let penetration = distance - (clearance.radial() + wider);
        let inclination = if distance > 0.0 { slope / distance } else { 0.0 };
        let gradient = n - Vector2::new(-n.y, n.x) * inclination;
        let swept = Vector2::new(-eccentricity.y, eccentricity.x) * bearing.spin;
        let rate = gradient.dot(&(journal.velocity - bearing.velocity - swept));
        let mut contact = Contact { eccentricity, penetration, rate, ..Contact::default() };
        if penetration <= 0.0 {
            return (contact, None);
        }
        let steepness = gradient.norm();
        let normal = gradient / steepness;
        contact.normal_force = steepness
            * match memory {
                None => clearance.law.normal_force(penetration, rate),
                Some(memory) => clearance.normal_force_after(memory, penetration, rate),
            };
        let to_journal = normal * clearance.journal_radius;
        let arms = [eccentricity + to_journal, to_journal];
        let to_surface = arms.map(|arm| arm.dot(&normal));
        let wrenches = clearance.press(&mut contact, [bearing, journal], normal, to_surface, arms);
        (contact, Some(wrenches))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A journal at rest touches the ring, and the penetration grows fastest along the force: by differences of
    /// `|e| − c(θ)` itself.
    #[test]
    fn a_resting_journal_lies_where_the_ring_faces_the_force() {
        let radial = 1e-4;
        for (amplitude, lobes) in [(1e-5, 2.0), (3e-5, 2.0), (1e-5, 3.0)] {
            let ring = OutOfRound { amplitude, lobes, direction: 0.4 };
            for k in 0..24 {
                let turned = UnitComplex::new(0.7);
                let along = UnitComplex::new(0.26 * f64::from(k)) * Vector2::x();
                let rest = ring.resting(radial, 0.0, turned, along);
                let penetration = |e: Vector2<f64>| {
                    let own = turned.inverse() * e;
                    let theta = own.y.atan2(own.x);
                    e.norm() - radial - amplitude * (lobes * (theta - 0.4)).cos()
                };
                assert!(penetration(rest).abs() < 1e-12, "{rest}");
                let step = 1e-8;
                let rise = |by: Vector2<f64>| penetration(rest + by) - penetration(rest - by);
                let gradient = Vector2::new(rise(Vector2::x() * step), rise(Vector2::y() * step));
                let beside = gradient.normalize().perp(&along);
                assert!(beside.abs() < 1e-4, "lobes {lobes}, amplitude {amplitude}: {beside}");
            }
        }
    }
}
