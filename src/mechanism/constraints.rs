//! Rigid joints of bodies that hang together, and the accelerations that meet them all.
//!
//! By Gauss' principle,
//!
//! `a = M⁻¹ (f + Jᵀ λ)`, `(J M⁻¹ Jᵀ) λ = −bias − J M⁻¹ f`
//!
//! (e.g. Featherstone, *Rigid Body Dynamics Algorithms*, 2008, §3.2).

use super::rows::Row;
use super::{Bearing, Mechanism};
use nalgebra::Vector3;

/// A rigid joint by its place among those of its kind.
#[derive(Clone, Copy, Debug)]
pub(super) enum RigidJoint {
    Prismatic(usize),
    Revolute(usize),
}

/// The rows of one group and the workspace that solving for their forces needs.
#[derive(Clone, Debug, Default)]
pub(super) struct Constraints {
    /// What the accelerations have to meet.
    pub rows: Vec<Row>,
    /// J M⁻¹ of each row.
    weighted: Vec<[Vector3<f64>; 2]>,
    matrix: Vec<f64>,
    /// λ of each row.
    pub multipliers: Vec<f64>,
}

impl Constraints {
    /// Turns free accelerations into those that meet the rows; leaves λ in `multipliers`.
    pub fn solve(&mut self, inverse_masses: &[Vector3<f64>], accelerations: &mut [Vector3<f64>]) {
        let n = self.rows.len();
        self.matrix.clear();
        self.matrix.resize(n * n, 0.0);
        self.multipliers.clear();
        self.weighted.clear();
        for (i, row) in self.rows.iter().enumerate() {
            let mut rhs = -row.bias;
            let mut weighted = [Vector3::zeros(); 2];
            for ((body, jacobian), weighted) in
                row.bodies.iter().zip(&row.jacobians).zip(&mut weighted)
            {
                if let Some(body) = *body {
                    rhs -= jacobian.dot(&accelerations[body]);
                    *weighted = jacobian.component_mul(&inverse_masses[body]);
                }
            }
            for (entry, other) in self.matrix[i * n..=i * n + i].iter_mut().zip(&self.rows) {
                if other.bodies == row.bodies {
                    *entry =
                        weighted[0].dot(&other.jacobians[0]) + weighted[1].dot(&other.jacobians[1]);
                    continue;
                }
                for (body, weighted) in row.bodies.iter().zip(&weighted) {
                    for (other_body, jacobian) in other.bodies.iter().zip(&other.jacobians) {
                        if body.is_some() && body == other_body {
                            *entry += weighted.dot(jacobian);
                        }
                    }
                }
            }
            self.weighted.push(weighted);
            self.multipliers.push(rhs);
        }
        solve_in_place(&mut self.matrix, &mut self.multipliers);
        for ((row, weighted), &lambda) in
            self.rows.iter().zip(&self.weighted).zip(&self.multipliers)
        {
            for (body, weighted) in row.bodies.iter().zip(weighted) {
                if let Some(body) = *body {
                    accelerations[body] += weighted * lambda;
                }
            }
        }
    }
}

/// Cholesky solution of a symmetric positive definite system given by its lower triangle (row
/// major); the right-hand side becomes the solution. In place because it runs several times a step
/// on systems of two or three rows, where an allocation would cost more than the solution.
fn solve_in_place(a: &mut [f64], b: &mut [f64]) {
    let n = b.len();
    for j in 0..n {
        for k in 0..j {
            a[j * n + j] -= a[j * n + k] * a[j * n + k];
        }
        let pivot = a[j * n + j].sqrt();
        a[j * n + j] = pivot;
        for i in j + 1..n {
            for k in 0..j {
                a[i * n + j] -= a[i * n + k] * a[j * n + k];
            }
            a[i * n + j] /= pivot;
        }
        for k in 0..j {
            b[j] -= a[j * n + k] * b[k];
        }
        b[j] /= pivot;
    }
    for j in (0..n).rev() {
        for i in j + 1..n {
            b[j] -= a[i * n + j] * b[i];
        }
        b[j] /= a[j * n + j];
    }
}

/// The rigid joints, grouped by the bodies that they connect. The ground connects nothing: it does
/// not move.
pub(super) fn groups(mechanism: &Mechanism) -> Vec<Vec<RigidJoint>> {
    let prismatics = mechanism.prismatics.iter().enumerate();
    let revolutes = mechanism.revolutes.iter().enumerate();
    let joints =
        prismatics.map(|(i, j)| (RigidJoint::Prismatic(i), [j.cylinder.body, j.rod.body])).chain(
            revolutes
                .filter(|(_, j)| matches!(j.bearing, Bearing::Ideal))
                .map(|(i, j)| (RigidJoint::Revolute(i), [j.ring.body, j.journal.body])),
        );
    let mut groups: Vec<(Vec<usize>, Vec<RigidJoint>)> = Vec::new();
    for (joint, bodies) in joints {
        let bodies: Vec<usize> = bodies.into_iter().flatten().collect();
        let (touching, mut rest): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|(members, _)| members.iter().any(|m| bodies.contains(m)));
        let mut merged = (Vec::new(), Vec::new());
        for (members, joints) in touching {
            merged.0.extend(members);
            merged.1.extend(joints);
        }
        merged.0.extend(bodies);
        merged.1.push(joint);
        rest.push(merged);
        groups = rest;
    }
    groups.into_iter().map(|(_, joints)| joints).collect()
}
