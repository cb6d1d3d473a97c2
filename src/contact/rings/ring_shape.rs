//! A bearing ring that is not a circle, and a guide, which is none at all; how journals slide on rings of any shape.

use crate::contact::clearance::sliding;
use crate::contact::{After, Clearance, Contact, Frame, OutOfRound, RingTable, circle_in_ring};
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Directions on each side of a force in which the place is sought where a journal rests, and steps of Newton's method
/// from the best one: a wide place is seen by several of them, and ten degrees away each step squares the error.
const SCANNED: i32 = 16;
const NEWTON: usize = 4;

/// How the clearance departs from its mean with the direction θ of the eccentricity in the axes of the ring's body:
/// `c(θ) = c + g(θ)`.
///
/// ```
/// use freeplay::contact::{OutOfRound, RingShape, RingTable};
/// use std::f64::consts::FRAC_PI_2;
///
/// // Oval by 10 µm, wide along x: as a wave, and as a table of it.
/// let wave = RingShape::from(OutOfRound { amplitude: 1e-5, lobes: 2.0, direction: 0.0 });
/// let samples: Vec<f64> = (0..64).map(|i| wave.widening(f64::from(i) * FRAC_PI_2 / 16.0)).collect();
/// let table = RingShape::from(RingTable::new(&samples).unwrap());
/// assert!((wave.widening(FRAC_PI_2) + 1e-5).abs() < 1e-12);
/// assert!((table.widening(0.3) - wave.widening(0.3)).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum RingShape {
    /// One harmonic.
    Wave(OutOfRound),
    /// Any shape.
    Table(RingTable),
    /// No ring but a straight guide: the clearance is that along this unit vector in the axes of the body, and what
    /// touches is a point, a corner of a slider.
    Guide(Vector2<f64>),
}

impl From<OutOfRound> for RingShape {
    fn from(wave: OutOfRound) -> Self {
        RingShape::Wave(wave)
    }
}

impl From<RingTable> for RingShape {
    fn from(table: RingTable) -> Self {
        RingShape::Table(table)
    }
}

impl RingShape {
    /// g in m, and its first two derivatives by θ (rad).
    fn at(&self, theta: f64) -> [f64; 3] {
        match self {
            RingShape::Wave(wave) => wave.at(theta),
            RingShape::Table(table) => table.at(theta),
            // Nobody asks for the outline of a guide.
            RingShape::Guide(_) => [0.0; 3],
        }
    }

    /// Whether it is a straight guide.
    pub fn is_guide(&self) -> bool {
        matches!(self, RingShape::Guide(_))
    }

    /// g in m in the direction `theta` (rad).
    pub fn widening(&self, theta: f64) -> f64 {
        self.at(theta)[0]
    }

    /// By how much in m the ring is narrower than its mean clearance where it is narrowest.
    pub fn narrowing(&self) -> f64 {
        match self {
            RingShape::Wave(wave) => wave.amplitude,
            RingShape::Table(table) => table.narrowing(),
            RingShape::Guide(_) => 0.0,
        }
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
            let ([wider, slope, bend], (sin, cos)) = (self.at(theta), (theta - pressed).sin_cos());
            let first = slope * cos - distance(wider) * sin;
            let second = (bend - distance(wider)) * cos - 2.0 * slope * sin;
            let next = theta - first / second.min(-f64::MIN_POSITIVE);
            // Past a corner the tangent says nothing.
            if along(next) < along(theta) {
                break;
            }
            theta = next;
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
        let place = self.place(clearance, turned, bearing, journal);
        let RingPlace { between, penetration, gradient, .. } = place;
        let swept = Vector2::new(-between.y, between.x) * bearing.spin;
        let rate = gradient.dot(&(journal.velocity - bearing.velocity - swept));
        // Along a guide a slider goes as it likes.
        let eccentricity =
            if self.is_guide() { gradient * between.dot(&gradient) } else { between };
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
        let arms = place.arms(normal);
        let to_surface = arms.map(|arm| arm.dot(&normal));
        let wrenches =
            clearance.press(memory, &mut contact, [bearing, journal], normal, to_surface, arms);
        (contact, Some(wrenches))
    }

    /// Outward normal where the journal touches, and how fast it slides there in m/s, see [`sliding`].
    fn slide(
        &self,
        clearance: &Clearance,
        turned: UnitComplex<f64>,
        [bearing, journal]: [&Frame; 2],
    ) -> (Vector2<f64>, f64) {
        let place = self.place(clearance, turned, bearing, journal);
        let normal = place.gradient.normalize();
        let to_surface = place.arms(normal).map(|arm| arm.dot(&normal));
        (normal, sliding([bearing, journal], normal, to_surface))
    }

    /// Where the journal is.
    fn place(
        &self,
        clearance: &Clearance,
        turned: UnitComplex<f64>,
        bearing: &Frame,
        journal: &Frame,
    ) -> RingPlace {
        let between = journal.centre - bearing.centre;
        if let RingShape::Guide(normal) = self {
            let gradient = turned * normal;
            let penetration = between.dot(&gradient) - clearance.radial();
            return RingPlace { between, penetration, gradient, radius: 0.0 };
        }
        let distance = between.norm();
        let n = if distance > 0.0 { between / distance } else { Vector2::x() };
        let own = turned.inverse() * n;
        let [wider, slope, _] = self.at(own.y.atan2(own.x));
        let penetration = distance - (clearance.radial() + wider);
        let inclination = if distance > 0.0 { slope / distance } else { 0.0 };
        let gradient = n - Vector2::new(-n.y, n.x) * inclination;
        RingPlace { between, penetration, gradient, radius: clearance.journal_radius }
    }
}

impl Clearance {
    /// Outward normal where the journal touches the ring, of this shape if it is not a circle (its body turned so far),
    /// and how fast in m/s the journal slides there along the normal turned by +90°.
    pub fn slide(
        &self,
        shape: Option<(&RingShape, UnitComplex<f64>)>,
        bearing: &Frame,
        journal: &Frame,
    ) -> (Vector2<f64>, f64) {
        if let Some((shape, turned)) = shape {
            return shape.slide(self, turned, [bearing, journal]);
        }
        let (penetration, normal) = circle_in_ring(journal.centre - bearing.centre, self.radial());
        let to_surface = self.to_surface(penetration);
        (normal, sliding([bearing, journal], normal, to_surface))
    }
}

/// Where a journal is in a ring that is not a circle, or a corner between guides, and the gradient of the penetration.
struct RingPlace {
    /// From the centre of the ring to that of the journal, in m.
    between: Vector2<f64>,
    /// In m.
    penetration: f64,
    gradient: Vector2<f64>,
    /// Of the journal in m; none of a corner.
    radius: f64,
}

impl RingPlace {
    /// From the centre of ring and journal to where they touch, in m.
    fn arms(&self, normal: Vector2<f64>) -> [Vector2<f64>; 2] {
        let to_journal = normal * self.radius;
        [self.between + to_journal, to_journal]
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
            let ring = RingShape::from(OutOfRound { amplitude, lobes, direction: 0.4 });
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
