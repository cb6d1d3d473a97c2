//! Joints between two bodies: revolute ones with or without clearance, and prismatic ones.

use crate::contact::{Clearance, Contact, RingShape};
use crate::mechanism::{Attachment, BodyState};
use nalgebra::{UnitComplex, Vector2};
use std::f64::consts::TAU;

/// How a revolute joint holds its two bodies together.
///
/// [`Revolute`] has an example.
#[derive(Clone, Debug)]
pub enum Bearing {
    /// The two centres coincide exactly.
    Ideal,
    /// The journal moves freely inside the ring and hits it under a force law.
    Clearance(Clearance),
    /// The same geometry, left to the contacts of the physics engine.
    Native {
        /// Inner radius of the bearing ring in m.
        bearing_radius: f64,
        /// Radius of the journal in m.
        journal_radius: f64,
        /// Coefficient of friction μ.
        friction: f64,
    },
}

/// How the physics engine's own contacts behave, in all joints that are left to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NativeContacts {
    /// Share of its normal speed that a journal keeps when it hits after a flight.
    pub restitution: f64,
    /// Natural frequency f of a lasting contact in Hz: it gives way like a spring of `m (2πf)²`,
    /// m the mass that the two bodies oppose to it.
    pub frequency: f64,
    /// Damping ratio of that spring.
    pub damping_ratio: f64,
    /// Sweeps of the solver over all joints and contacts in each step.
    pub iterations: usize,
    /// Whether a journal that would arrive within the step is stopped at the ring at once, whatever
    /// the spring. The physics engine's way; the force of such a stop is `m v/dt`.
    pub predictive: bool,
}

impl Default for NativeContacts {
    /// As the physics engine has them for its moving bodies.
    fn default() -> Self {
        Self {
            restitution: 0.0,
            frequency: 30.0,
            damping_ratio: 10.0,
            iterations: 1,
            predictive: true,
        }
    }
}

/// A revolute joint: a bearing ring on one body, a journal on another. Its coordinate is the angle of
/// the journal's body less that of the ring's.
///
/// ```
/// use freeplay::mechanism::{Attachment, Bearing, Body, BodyState, Mechanism, Revolute};
/// use nalgebra::Vector2;
///
/// // An arm that hangs from the ground by its upper end.
/// let hanging = BodyState { position: Vector2::new(0.0, -0.5), ..BodyState::ground() };
/// let mut mechanism = Mechanism::free(vec![Body::new("arm", 1.0, 0.02, hanging)]);
/// mechanism.revolutes.push(Revolute {
///     name: "A".to_owned(),
///     ring: Attachment { body: None, point: Vector2::zeros() },
///     journal: Attachment { body: Some(0), point: Vector2::new(0.0, 0.5) },
///     bearing: Bearing::Ideal,
///     out_of_round: None,
/// });
/// assert_eq!(mechanism.freedoms(&[hanging]).free, 1);
/// ```
#[derive(Clone, Debug)]
pub struct Revolute {
    /// Name, such as `A1`.
    pub name: String,
    /// Centre of the bearing ring.
    pub ring: Attachment,
    /// Centre of the journal.
    pub journal: Attachment,
    /// What the joint does.
    pub bearing: Bearing,
    /// How its ring departs from a circle, if it does; [`Bearing::Clearance`] alone looks at it.
    pub out_of_round: Option<RingShape>,
}

/// A prismatic joint: a slider that moves along an axis of its base, both keeping the angle between
/// them. Its coordinate is the distance along the axis from the base's attachment point to the
/// slider's.
///
/// ```
/// use freeplay::mechanism::{Attachment, Body, BodyState, JointIndex, Mechanism, Prismatic};
/// use nalgebra::{UnitComplex, Vector2};
///
/// let start = BodyState { position: Vector2::new(0.3, 0.0), ..BodyState::ground() };
/// let mut mechanism = Mechanism::free(vec![Body::new("carriage", 2.0, 0.1, start)]);
/// mechanism.prismatics.push(Prismatic {
///     name: "X".to_owned(),
///     base: Attachment { body: None, point: Vector2::zeros() },
///     slider: Attachment { body: Some(0), point: Vector2::zeros() },
///     axes: [UnitComplex::identity(); 2],
///     play: false,
/// });
/// assert!((mechanism.start_coordinate(JointIndex::Prismatic(0)) - 0.3).abs() < 1e-12);
/// assert_eq!(mechanism.freedoms(&[start]).free, 1);
/// ```
#[derive(Clone, Debug)]
pub struct Prismatic {
    /// Name, such as `P1`.
    pub name: String,
    /// The body that carries the axis, and the point from which the length counts.
    pub base: Attachment,
    /// The body that slides, and the point to which the length counts.
    pub slider: Attachment,
    /// Direction of the axis in the axes of the base's body and of the slider's body. The two directions
    /// coincide in the world: that is the angle that the joint keeps.
    pub axes: [UnitComplex<f64>; 2],
    /// Whether nothing holds it but the contacts of the slider's corners with two guides, which are among the
    /// [revolute joints](crate::mechanism::Mechanism::revolutes) as [corners](Revolute::is_corner).
    pub play: bool,
}

impl Prismatic {
    /// The two bodies; the ground has none.
    pub fn bodies(&self) -> [Option<usize>; 2] {
        [self.base.body, self.slider.body]
    }

    /// Attachment points of base and slider from their centres of mass, along and across the axis, in m.
    pub fn points(&self) -> [Vector2<f64>; 2] {
        [self.axes[0].inverse() * self.base.point, self.axes[1].inverse() * self.slider.point]
    }
}

/// A joint by its place among those of its kind.
///
/// [`Prismatic`] has an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointIndex {
    /// Among [`Mechanism::revolutes`](crate::mechanism::Mechanism::revolutes).
    Revolute(usize),
    /// Among [`Mechanism::prismatics`](crate::mechanism::Mechanism::prismatics).
    Prismatic(usize),
}

impl Revolute {
    /// Whether it is no joint of its own but a corner of a slider at its guide: the ring is that, the journal the corner.
    pub fn is_corner(&self) -> bool {
        self.out_of_round.as_ref().is_some_and(RingShape::is_guide)
    }

    /// The two bodies, the ring's first; the ground has none.
    pub fn bodies(&self) -> [Option<usize>; 2] {
        [self.ring.body, self.journal.body]
    }

    /// Rotation of the journal's body against the ring's.
    pub fn rotation(&self, states: &[BodyState]) -> UnitComplex<f64> {
        self.ring.rotation(states).rotation_to(&self.journal.rotation(states))
    }

    /// Where the contact of a journal that touches rubs its ring, as the direction of the surface's normal in the axes of
    /// the ring's body (rad), and the friction power that a coefficient of 1 would have there, `F_N |v_t|` in W. None in
    /// flight, and where no law acts.
    pub fn rubbing(&self, states: &[BodyState], contact: &Contact) -> Option<[f64; 2]> {
        if contact.normal_force <= 0.0 {
            return None;
        }
        let direction = match (&self.bearing, &self.out_of_round) {
            (Bearing::Clearance(_), None) => {
                let own = self.ring.rotation(states).inverse() * contact.eccentricity;
                own.y.atan2(own.x)
            }
            _ => self.sliding(states)?[0],
        };
        Some([direction, contact.rubbing_power()])
    }

    /// That direction (rad), whether the journal touches or not, and how fast it slides there in m/s, positive where it
    /// goes on along the normal turned by +90°. None where no law acts.
    pub fn sliding(&self, states: &[BodyState]) -> Option<[f64; 2]> {
        let Bearing::Clearance(clearance) = &self.bearing else { return None };
        let turned = self.ring.rotation(states);
        let shape = self.out_of_round.as_ref().map(|shape| (shape, turned));
        let (normal, speed) =
            clearance.slide(shape, &self.ring.frame(states), &self.journal.frame(states));
        let own = turned.inverse() * normal;
        Some([own.y.atan2(own.x), speed])
    }

    /// Angular velocity of the journal's body less that of the ring's in rad/s.
    pub fn spin(&self, states: &[BodyState]) -> f64 {
        self.journal.spin(states) - self.ring.spin(states)
    }
}

/// The angle in rad nearest to `near` among those of a rotation, which differ by whole turns.
///
/// ```
/// use freeplay::mechanism::angle_near;
/// use nalgebra::UnitComplex;
/// use std::f64::consts::TAU;
///
/// assert!((angle_near(UnitComplex::new(0.1), 2.0 * TAU) - (2.0 * TAU + 0.1)).abs() < 1e-12, "two turns on");
/// ```
pub fn angle_near(rotation: UnitComplex<f64>, near: f64) -> f64 {
    let angle = rotation.angle();
    angle + TAU * ((near - angle) / TAU).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn angles_go_on_past_half_a_turn() {
        for (angle, near, expected) in
            [(-3.0, 3.0, TAU - 3.0), (3.0, -3.0, 3.0 - TAU), (0.1, 4.0 * PI, 4.0 * PI + 0.1)]
        {
            assert!((angle_near(UnitComplex::new(angle), near) - expected).abs() < 1e-14);
        }
    }
}
