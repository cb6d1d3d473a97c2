//! Rigid joints as rows of `J a + bias = target` on the accelerations of their two bodies.

use super::{BodyState, Prismatic, Revolute, state_of};
use nalgebra::{Vector2, Vector3};

/// One scalar condition on the accelerations of two bodies:
/// `jacobians[0]·a₁ + jacobians[1]·a₂ + bias = 0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// The two bodies; the ground has none.
    pub bodies: [Option<usize>; 2],
    /// Derivative of the condition's rate by each body's twist.
    pub jacobians: [Vector3<f64>; 2],
    /// What is left of the condition's second derivative at zero acceleration, less its target.
    pub bias: f64,
}

fn row(direction: Vector2<f64>, moment: f64) -> Vector3<f64> {
    Vector3::new(direction.x, direction.y, moment)
}

impl Prismatic {
    /// Length of the joint in m at the given states.
    pub fn length(&self, states: &[BodyState]) -> f64 {
        PrismaticState::new(self, states).length
    }
}

/// Length, its rate, and the rows of one prismatic joint at one state.
///
/// With u the cylinder's axis, n = u turned by +90°, P and Q the two attachment points, d = Q − P,
/// ω the cylinder's angular velocity (`u̇ = ω n`, `ṅ = −ω u`):
///
/// * length `q = d·u`, `q̇ = ḋ·u + ω d·n`, `q̈ = d̈·u + α d·n + 2ω ḋ·n − ω² d·u`
/// * sideways `s = d·n`, `s̈ = d̈·n − α d·u − 2ω ḋ·u − ω² d·n = 0`
/// * angle `α_rod − α_cylinder = 0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrismaticState {
    /// q in m.
    pub length: f64,
    /// q̇ in m/s.
    pub rate: f64,
    /// The length row, without a target: `J a + bias = q̈`. Its force is positive when it extends.
    pub along: Row,
    /// The rows that lock the sideways shift and the angle.
    pub locks: [Row; 2],
}

impl PrismaticState {
    pub fn new(joint: &Prismatic, states: &[BodyState]) -> Self {
        let cylinder = state_of(states, &joint.cylinder);
        let p = cylinder.frame(joint.cylinder.point);
        let q = state_of(states, &joint.rod).frame(joint.rod.point);
        let u = cylinder.rotation * Vector2::x();
        let n = Vector2::new(-u.y, u.x);
        let d = q.centre - p.centre;
        let rate = q.velocity - p.velocity;
        let (du, dn) = (d.dot(&u), d.dot(&n));
        let spin = p.spin;
        // d̈ at zero acceleration: centripetal parts of the two arms.
        let centripetal = p.arm * (p.spin * p.spin) - q.arm * (q.spin * q.spin);
        let bodies = [joint.cylinder.body, joint.rod.body];
        let along = Row {
            bodies,
            jacobians: [row(-u, dn - p.arm.perp(&u)), row(u, q.arm.perp(&u))],
            bias: centripetal.dot(&u) + 2.0 * spin * rate.dot(&n) - spin * spin * du,
        };
        let sideways = Row {
            bodies,
            jacobians: [row(-n, -du - p.arm.perp(&n)), row(n, q.arm.perp(&n))],
            bias: centripetal.dot(&n) - 2.0 * spin * rate.dot(&u) - spin * spin * dn,
        };
        let angle = Row { bodies, jacobians: [-Vector3::z(), Vector3::z()], bias: 0.0 };
        Self { length: du, rate: rate.dot(&u) + spin * dn, along, locks: [sideways, angle] }
    }
}

/// The two rows of an ideal revolute joint: the accelerations of the two centres agree.
pub(super) fn revolute_rows(joint: &Revolute, states: &[BodyState]) -> [Row; 2] {
    let ring = state_of(states, &joint.ring).frame(joint.ring.point);
    let journal = state_of(states, &joint.journal).frame(joint.journal.point);
    let centripetal =
        ring.arm * (ring.spin * ring.spin) - journal.arm * (journal.spin * journal.spin);
    [Vector2::x(), Vector2::y()].map(|e| Row {
        bodies: [joint.ring.body, joint.journal.body],
        jacobians: [row(-e, -ring.arm.perp(&e)), row(e, journal.arm.perp(&e))],
        bias: centripetal.dot(&e),
    })
}
