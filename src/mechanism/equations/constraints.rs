//! Rigid joints of bodies that hang together, and the accelerations that meet them all.
//!
//! By Gauss' principle,
//!
//! `a = M⁻¹ (f + Jᵀ λ)`, `(J M⁻¹ Jᵀ) λ = −bias − J M⁻¹ f`
//!
//! (e.g. Featherstone, *Rigid Body Dynamics Algorithms*, 2008, §3.2).

use super::rows::Row;
use crate::mechanism::{Bearing, Drive, JointIndex, Mechanism};
use nalgebra::{DMatrix, DVector, Vector3};

/// What holds bodies together rigidly.
#[derive(Clone, Copy, Debug)]
pub(in crate::mechanism) enum Rigid {
    /// A prismatic joint, and the drive that prescribes its length if one does.
    Prismatic(usize),
    /// An ideal revolute joint.
    Revolute(usize),
    /// The prescribed angle of a revolute joint, ideal or not.
    Angle { drive: usize, joint: usize },
    /// A rotor that a joint spins, by its index: no condition but an inertia.
    Rotor(usize),
}

/// A row and which of its two bodies.
type RowEnd = [usize; 2];

/// The rows of one group and the workspace that solving for their forces needs.
#[derive(Clone, Debug, Default)]
pub(in crate::mechanism) struct Constraints {
    /// What the accelerations have to meet.
    pub rows: Vec<Row>,
    /// J M⁻¹ of each row.
    weighted: Vec<[Vector3<f64>; 2]>,
    matrix: Vec<f64>,
    /// The last row so far that acts on each body and at which of its ends, and for each end of a row the one before it.
    last: Vec<Option<RowEnd>>,
    before: Vec<[Option<RowEnd>; 2]>,
    /// λ of each row.
    pub multipliers: Vec<f64>,
    diagonal: Vec<f64>,
    backup: Vec<f64>,
    /// Rank of the rows last solved.
    pub rank: usize,
    /// How far the rows last solved were from having a lower one: their smallest pivot in shares of its
    /// row's diagonal; of rows that depend on each other the smallest eigenvalue that is not zero, in shares
    /// of the largest.
    pub weakest: f64,
    /// Farthest that these rows usually are from a lower rank, as `weakest` says it; 0 where nothing is known.
    pub usual: f64,
}

impl Constraints {
    /// Turns free accelerations into those that meet the rows; leaves λ in `multipliers`.
    pub fn solve(&mut self, inverse_masses: &[Vector3<f64>], accelerations: &mut [Vector3<f64>]) {
        let n = self.rows.len();
        self.matrix.clear();
        self.matrix.resize(n * n, 0.0);
        self.multipliers.clear();
        self.weighted.clear();
        self.last.clear();
        self.last.resize(inverse_masses.len(), None);
        self.before.clear();
        self.before.resize(n, [None; 2]);
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
            for (side, (body, weighted)) in row.bodies.iter().zip(&weighted).enumerate() {
                let Some(body) = *body else { continue };
                self.before[i][side] = self.last[body].replace([i, side]);
                // This row and all before that act on the body.
                let mut other = self.last[body];
                while let Some([j, end]) = other {
                    self.matrix[j * n + i] += weighted.dot(&self.rows[j].jacobians[end]);
                    other = self.before[j][end];
                }
            }
            self.matrix[i * n + i] += row.softness;
            self.weighted.push(weighted);
            self.multipliers.push(rhs);
        }
        self.solve_system();
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

    /// λ from the upper triangle in `matrix` and the right-hand side in `multipliers`, in place. Rows that
    /// depend on each other (a parallelogram's, or those of any loop in a singular pose) have no unique λ:
    /// then the smallest one, each row measured by its own diagonal.
    fn solve_system(&mut self) {
        let n = self.multipliers.len();
        self.diagonal.clear();
        self.diagonal.extend((0..n).map(|i| self.matrix[i * n + i]));
        self.backup.clone_from(&self.multipliers);
        let zero = DEPENDENT.max(SINGULAR * self.usual);
        let solved =
            factorise_and_solve(&mut self.matrix, &mut self.multipliers, &self.diagonal, zero);
        if let Some(weakest) = solved {
            (self.rank, self.weakest) = (n, weakest);
            return;
        }
        let entry = |i: usize, j: usize| {
            let mut sum = 0.0;
            let (a, b) = (&self.rows[i], &self.rows[j]);
            for (body, weighted) in a.bodies.iter().zip(&self.weighted[i]) {
                for (other, jacobian) in b.bodies.iter().zip(&b.jacobians) {
                    if body.is_some() && body == other {
                        sum += weighted.dot(jacobian);
                    }
                }
            }
            if i == j { sum + a.softness } else { sum }
        };
        (self.multipliers, self.rank, self.weakest) =
            smallest_solution(n, entry, &self.backup, zero);
    }
}

/// Share of a row's own diagonal below which its pivot is rounding: rows that depend on the ones before
/// leave 1e-16 to 1e-14 of it, rows that differ by a microradian leave 1e-12.
const DEPENDENT: f64 = 1e-13;

/// The same in shares of what is usual for the rows: within some 0.1 mrad of a singular pose. There the forces
/// grow without limit, and make of the velocities' errors accelerations larger than those that the rows hold
/// back. What is left out at c rad from the pose errs by c³, what rounding makes of it by c⁻²: of 1e-9 to 1e-5, 1e-8 errs
/// least through the singular pose of two four-bars side by side, wherever steps end beside it.
const SINGULAR: f64 = 1e-8;

/// Cholesky solution `A = Uᵀ U` of a symmetric positive definite system given by its upper triangle (row
/// major); the right-hand side becomes the solution. Returns the smallest pivot in shares of its diagonal;
/// none, with nothing of use in a and b, where a row's pivot is not above the share `zero`: it depends on
/// those before it. In place because it runs several times a step on systems of two or three rows, where an
/// allocation would cost more than the solution; row by row because the machine without clearance has twenty, and
/// a processor subtracts neighbours at once.
fn factorise_and_solve(a: &mut [f64], b: &mut [f64], diagonal: &[f64], zero: f64) -> Option<f64> {
    let n = b.len();
    let mut weakest = 1.0f64;
    for j in 0..n {
        let (above, below) = a.split_at_mut((j + 1) * n);
        let row = &mut above[j * n + j..];
        if row[0] <= zero * diagonal[j] {
            return None;
        }
        weakest = weakest.min(row[0] / diagonal[j]);
        let pivot = row[0].sqrt();
        row[0] = pivot;
        for entry in &mut row[1..] {
            *entry /= pivot;
        }
        b[j] /= pivot;
        for (i, other) in (j + 1..n).zip(below.chunks_exact_mut(n)) {
            let right = &row[i - j..];
            // Joints that share no body have nothing to do with each other.
            let factor = right[0];
            if factor == 0.0 {
                continue;
            }
            for (entry, right) in other[i..].iter_mut().zip(right) {
                *entry -= factor * right;
            }
            b[i] -= factor * b[j];
        }
    }
    for j in (0..n).rev() {
        let (known, row) = (&b[j + 1..], &a[j * n + j..(j + 1) * n]);
        let sum = row[1..].iter().zip(known).fold(b[j], |sum, (entry, b)| sum - entry * b);
        b[j] = sum / row[0];
    }
    Some(weakest)
}

/// The smallest λ with `A λ = b` in the sense of least squares, A symmetric and positive semidefinite of
/// any rank: with rows and columns scaled to a diagonal of ones, the pseudo-inverse by eigenvalues, of which
/// those up to the share `zero` of the largest are none. With it the rank, and the smallest of the other
/// eigenvalues in shares of the largest.
fn smallest_solution(
    n: usize,
    entry: impl Fn(usize, usize) -> f64,
    b: &[f64],
    zero: f64,
) -> (Vec<f64>, usize, f64) {
    let scale: Vec<f64> = (0..n).map(|i| entry(i, i).max(f64::MIN_POSITIVE).sqrt()).collect();
    let matrix = DMatrix::from_fn(n, n, |i, j| {
        let (i, j) = (i.max(j), i.min(j));
        entry(i, j) / (scale[i] * scale[j])
    });
    let rhs = DVector::from_fn(n, |i, _| b[i] / scale[i]);
    if rhs.iter().chain(matrix.iter()).any(|x| !x.is_finite()) {
        return (vec![f64::NAN; n], 0, 0.0);
    }
    let eigen = matrix.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let mut along = eigen.eigenvectors.tr_mul(&rhs);
    let (mut rank, mut weakest) = (0, 1.0f64);
    for (component, value) in along.iter_mut().zip(&eigen.eigenvalues) {
        if *value > zero * largest {
            *component /= value;
            (rank, weakest) = (rank + 1, weakest.min(value / largest));
        } else {
            *component = 0.0;
        }
    }
    let solution = eigen.eigenvectors * along;
    (solution.iter().zip(&scale).map(|(x, s)| x / s).collect(), rank, weakest)
}

/// What holds bodies rigidly, grouped by the bodies that it connects. The ground connects nothing: it
/// does not move.
pub(in crate::mechanism) fn groups(mechanism: &Mechanism) -> Vec<Vec<Rigid>> {
    let prismatics = mechanism.prismatics.iter().enumerate().filter(|(_, joint)| !joint.play);
    let revolutes = mechanism.revolutes.iter().enumerate();
    let angles = mechanism.actuators.iter().enumerate().filter_map(|(drive, actuator)| {
        let JointIndex::Revolute(joint) = actuator.joint else { return None };
        let prescribed = actuator.drive == Drive::Prescribed;
        prescribed.then(|| (Rigid::Angle { drive, joint }, mechanism.revolutes[joint].bodies()))
    });
    let rotors = mechanism.rotors.iter().enumerate();
    let rotors =
        rotors.map(|(i, rotor)| (Rigid::Rotor(i), mechanism.revolutes[rotor.joint].bodies()));
    let joints = prismatics
        .map(|(i, joint)| (Rigid::Prismatic(i), joint.bodies()))
        .chain(
            revolutes
                .filter(|(_, joint)| matches!(joint.bearing, Bearing::Ideal))
                .map(|(i, joint)| (Rigid::Revolute(i), joint.bodies())),
        )
        .chain(angles)
        .chain(rotors);
    let mut groups: Vec<(Vec<usize>, Vec<Rigid>)> = Vec::new();
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
