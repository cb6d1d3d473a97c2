//! Rigid joints as rows of `J a + bias = target` on the accelerations of their two bodies.

use super::telescope::Telescope;
use crate::mechanism::{BodyState, Revolute};
use nalgebra::{Vector2, Vector3};

/// One scalar condition on the accelerations of two bodies:
/// `jacobians[0]·a₁ + jacobians[1]·a₂ + bias = 0`.
#[derive(Clone, Copy, Debug)]
pub(in crate::mechanism) struct Row {
    /// The two bodies; the ground has none.
    pub bodies: [Option<usize>; 2],
    /// Derivative of the condition's rate by each body's twist.
    pub jacobians: [Vector3<f64>; 2],
    /// What is left of the condition's second derivative at zero acceleration, less its target.
    pub bias: f64,
    /// How far it gives way: acceleration for each unit of its force; 0 of what is rigid.
    pub softness: f64,
}

fn row(direction: Vector2<f64>, moment: f64) -> Vector3<f64> {
    Vector3::new(direction.x, direction.y, moment)
}

/// The rows of a prismatic joint between `bodies`: sideways shift and angle locked, then the length
/// row without a target, whose force is positive when it extends. With the names of [`Telescope`]:
///
/// * length `q̈ = d̈·u + α w + 2ω ḋ·n − ω² L`
/// * sideways `s̈ = d̈·n − α L − 2ω ḋ·u − ω² w = 0`
/// * angle `α_slider − α_base = 0`.
pub(in crate::mechanism) fn prismatic_rows(
    joint: &Telescope,
    bodies: [Option<usize>; 2],
) -> [Row; 3] {
    let Telescope { u, n, rate, spin, .. } = *joint;
    let [length, side] = joint.offset;
    [
        Row {
            bodies,
            jacobians: [row(-n, -length), row(n, 0.0)],
            bias: -2.0 * spin * rate.dot(&u) - spin * spin * side,
            softness: 0.0,
        },
        Row { bodies, jacobians: [-Vector3::z(), Vector3::z()], bias: 0.0, softness: 0.0 },
        Row {
            bodies,
            jacobians: [row(-u, side), row(u, 0.0)],
            bias: 2.0 * spin * rate.dot(&n) - spin * spin * length,
            softness: 0.0,
        },
    ]
}

/// The two rows of an ideal revolute joint: the accelerations of the two centres agree.
pub(in crate::mechanism) fn revolute_rows(joint: &Revolute, states: &[BodyState]) -> [Row; 2] {
    let (ring, journal) = (joint.ring.frame(states), joint.journal.frame(states));
    let centripetal =
        ring.arm * (ring.spin * ring.spin) - journal.arm * (journal.spin * journal.spin);
    [Vector2::x(), Vector2::y()].map(|e| Row {
        bodies: [joint.ring.body, joint.journal.body],
        jacobians: [row(-e, -ring.arm.perp(&e)), row(e, journal.arm.perp(&e))],
        bias: centripetal.dot(&e),
        softness: 0.0,
    })
}

/// The row of a revolute joint's angle, `α_journal − α_ring`, without a target; its force is the torque
/// on the journal's body.
pub(in crate::mechanism) fn angle_row(joint: &Revolute) -> Row {
    Row {
        bodies: [joint.ring.body, joint.journal.body],
        jacobians: [-Vector3::z(), Vector3::z()],
        bias: 0.0,
        softness: 0.0,
    }
}
