//! A bearing ring that is not a circle.

use super::{Clearance, Contact, Frame};
use nalgebra::{UnitComplex, Vector2, Vector3};

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

    /// Forces in the joint, as [`Clearance::forces`] has them for a round ring; `turned` is the rotation
    /// of the ring's body.
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
        contact.normal_force = steepness * clearance.law.normal_force(penetration, rate);
        let to_journal = normal * clearance.journal_radius;
        let arms = [eccentricity + to_journal, to_journal];
        let to_surface = arms.map(|arm| arm.dot(&normal));
        let wrenches = clearance.press(&mut contact, [bearing, journal], normal, to_surface, arms);
        (contact, Some(wrenches))
    }
}
