//! One revolute joint: an arm that swings about a point of the ground.
//!
//! Angles are those of the arm, from the pivot to its centre of mass, against the upward vertical: π
//! hangs, and `(m a² + I) θ̈ = m a g sin θ`.

use super::{Attachment, Bearing, Body, BodyState, Mechanism, Revolute};
use nalgebra::{UnitComplex, Vector2, Vector3};

/// The arm of a pendulum.
///
/// ```
/// use freeplay::mechanism::Bearing;
/// use freeplay::mechanism::pendulum::{Arm, angle, build};
/// use nalgebra::Vector2;
///
/// let arm = Arm { mass: 1.0, inertia: 0.01, length: 0.3 };
/// assert!((arm.about_pivot() - 0.1).abs() < 1e-12);
/// let pendulum = build(arm, Bearing::Ideal, [0.4, 2.0], Vector2::new(0.0, -9.81));
/// let [at, rate] = angle(&pendulum.bodies[0].start, 0.0);
/// assert!((at - 0.4).abs() < 1e-12 && (rate - 2.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// m in kg.
    pub mass: f64,
    /// I about the centre of mass in kg·m².
    pub inertia: f64,
    /// a from the pivot to the centre of mass in m.
    pub length: f64,
}

impl Arm {
    /// Moment of inertia about the pivot in kg·m², `J = m a² + I`.
    pub fn about_pivot(&self) -> f64 {
        self.mass * self.length * self.length + self.inertia
    }

    /// State at an angle in rad and a rate in rad/s about a resting pivot.
    pub fn state(&self, [angle, rate]: [f64; 2]) -> BodyState {
        // The arm's own y axis points from the pivot to the centre of mass.
        let rotation = UnitComplex::new(angle);
        let along = rotation * Vector2::new(0.0, self.length);
        let velocity = Vector2::new(-along.y, along.x) * rate;
        BodyState { position: along, rotation, twist: Vector3::new(velocity.x, velocity.y, rate) }
    }
}

/// Angle in rad within half a turn of `near`, and rate in rad/s of an arm in that state.
pub fn angle(state: &BodyState, near: f64) -> [f64; 2] {
    let turn = (UnitComplex::new(-near) * state.rotation).angle();
    [near + turn, state.twist.z]
}

/// Builds the pendulum: the joint `A1` at the origin, released at an angle in rad with a rate in
/// rad/s. With clearance the journal starts in the middle of its ring, which the ground carries.
pub fn build(arm: Arm, bearing: Bearing, start: [f64; 2], gravity: Vector2<f64>) -> Mechanism {
    let body =
        Body { angle: start[0], ..Body::new("arm", arm.mass, arm.inertia, arm.state(start)) };
    Mechanism {
        revolutes: vec![Revolute {
            name: "A1".to_owned(),
            ring: Attachment { body: None, point: Vector2::zeros() },
            journal: Attachment { body: Some(0), point: Vector2::new(0.0, -arm.length) },
            bearing,
            out_of_round: None,
        }],
        gravity,
        ..Mechanism::free(vec![body])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::{Dynamics, Evaluation};

    #[test]
    fn accelerates_as_its_equation_says() {
        let arm = Arm { mass: 0.15, inertia: 2e-4, length: 0.14 };
        for start in [[2.0, 1.5], [4.0, -3.0], [3.2, 0.0]] {
            let mechanism = build(arm, Bearing::Ideal, start, Vector2::new(0.0, -9.81));
            let states = vec![mechanism.bodies[0].start];
            let mut now = Evaluation::new(&mechanism);
            let mut dynamics = Dynamics::new(&mechanism);
            dynamics.forces(&mechanism, 0.0, &states, &mut now);
            dynamics.accelerations(&mechanism, &states, &mut now);
            let expected = arm.mass * arm.length * 9.81 * start[0].sin() / arm.about_pivot();
            assert!((now.accelerations[0].z - expected).abs() < 1e-9, "{start:?}");
            let read = angle(&states[0], 3.0);
            assert!((read[0] - start[0]).abs() < 1e-14 && read[1] == start[1]);
        }
    }
}
