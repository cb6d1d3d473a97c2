//! Inverse and forward kinematics of the machine without clearance (paper eqs. 1–2), and its
//! distance from singularity.

use crate::mechanism::Command;
use crate::mechanism::motion::PathPoint;
use nalgebra::{Matrix3, Rotation2, Vector2, Vector3};
use std::f64::consts::PI;

/// Side lengths of the two triangles.
///
/// ```
/// use freeplay::mechanism::three_rpr::Geometry;
/// use nalgebra::Vector3;
///
/// let paper = Geometry { base_side: 0.66, platform_side: 0.1 };
/// let pose = Vector3::new(0.02, 0.01, 0.5);
/// let lengths = [0, 1, 2].map(|leg| paper.leg(pose, leg).norm());
/// let found = paper.forward(lengths, Vector3::new(0.0, 0.0, 0.4)).unwrap();
/// assert!((found - pose).norm() < 1e-9);
/// assert!(paper.singularity_distance(Vector3::zeros()).abs() < 1e-12, "similar triangles, not turned");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    /// Side of the base triangle A₁A₂A₃ in m.
    pub base_side: f64,
    /// Side L3 of the platform triangle C₁C₂C₃ in m.
    pub platform_side: f64,
}

impl Geometry {
    /// Base anchor A_i in m, `leg` 0…2: at angle 7π/6 + 2π/3·leg around the origin.
    pub fn anchor(&self, leg: usize) -> Vector2<f64> {
        corner(self.base_side, leg)
    }

    /// Platform corner C_i in the platform's axes from its centre C, in m.
    pub fn corner(&self, leg: usize) -> Vector2<f64> {
        corner(self.platform_side, leg)
    }

    /// From A_i to C_i in m, for the platform pose (m, m, rad).
    pub fn leg(&self, pose: Vector3<f64>, leg: usize) -> Vector2<f64> {
        pose.xy() + Rotation2::new(pose.z) * self.corner(leg) - self.anchor(leg)
    }

    /// Length of each leg and its first and second time derivative (paper eqs. 1–2 and their
    /// derivatives): with d = C_i − A_i, `q = |d|`, `q̇ = d·ḋ/q`, `q̈ = (ḋ·ḋ + d·d̈ − q̇²)/q`.
    pub fn inverse(&self, point: &PathPoint) -> [Command; 3] {
        let rotation = Rotation2::new(point.pose.z);
        [0, 1, 2].map(|leg| {
            let arm = rotation * self.corner(leg);
            let normal = Vector2::new(-arm.y, arm.x);
            let (omega, alpha) = (point.rate.z, point.acceleration.z);
            let d = point.pose.xy() + arm - self.anchor(leg);
            let rate = point.rate.xy() + normal * omega;
            let acceleration = point.acceleration.xy() + normal * alpha - arm * (omega * omega);
            let length = d.norm();
            let length_rate = d.dot(&rate) / length;
            Command {
                position: length,
                rate: length_rate,
                acceleration: (rate.norm_squared() + d.dot(&acceleration)
                    - length_rate * length_rate)
                    / length,
            }
        })
    }

    /// The Jacobian ∂q/∂(x, y, φ) (1, 1, m): row i is the leg's direction u and the moment arm
    /// `(C_i − C) × u` about the platform's centre.
    pub fn jacobian(&self, pose: Vector3<f64>) -> Matrix3<f64> {
        let rotation = Rotation2::new(pose.z);
        Matrix3::from_fn(|leg, column| {
            let u = self.leg(pose, leg).normalize();
            match column {
                0 => u.x,
                1 => u.y,
                _ => (rotation * self.corner(leg)).perp(&u),
            }
        })
    }

    /// Signed distance from singularity in m: the moment arm that three legs 120° apart would have
    /// about the point where they come closest to meeting,
    /// `det ∂q/∂(x, y, φ) / (3√3/2)`. It is zero where all three leg lines meet in one point: the
    /// platform can then turn although no actuator moves. Base and platform being similar
    /// triangles, that is so at φ = 0 and φ = π for every x and y.
    pub fn singularity_distance(&self, pose: Vector3<f64>) -> f64 {
        self.jacobian(pose).determinant() / (1.5 * 3f64.sqrt())
    }

    /// Forward kinematics by Newton's method: the pose (m, m, rad) near `guess` whose leg lengths
    /// are `lengths` (m), or `None` if there is none near by or the machine is singular there.
    pub fn forward(&self, lengths: [f64; 3], guess: Vector3<f64>) -> Option<Vector3<f64>> {
        let mut pose = guess;
        for _ in 0..30 {
            let residual = Vector3::from_fn(|leg, _| self.leg(pose, leg).norm() - lengths[leg]);
            if residual.amax() < 1e-14 {
                return Some(pose);
            }
            let mut correction = self.jacobian(pose).lu().solve(&residual)?;
            // A step of half the machine leaves the region that the guess meant.
            let limit = 0.5 * self.base_side;
            if correction.xy().norm() > limit {
                correction *= limit / correction.xy().norm();
            }
            pose -= correction;
        }
        let residual = (0..3).map(|leg| (self.leg(pose, leg).norm() - lengths[leg]).abs());
        (residual.fold(0.0, f64::max) < 1e-12).then_some(pose)
    }
}

fn corner(side: f64, leg: usize) -> Vector2<f64> {
    let angle = 7.0 * PI / 6.0 + 2.0 * PI / 3.0 * leg as f64;
    Vector2::new(angle.cos(), angle.sin()) * (side / 3f64.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::motion::{Motion, MultiSine, SineTerm};

    const PAPER: Geometry = Geometry { base_side: 0.66, platform_side: 0.1 };

    #[test]
    fn lengths_at_the_start_of_the_default_circle() {
        // ideal.csv, first row.
        let pose = Vector3::new(0.05, 0.0, PI / 6.0);
        let point = PathPoint { pose, ..PathPoint::default() };
        let expected = [0.3782082287, 0.2927485581, 0.3317249828];
        for (command, q) in PAPER.inverse(&point).iter().zip(expected) {
            assert!((command.position - q).abs() < 5e-11, "{} {q}", command.position);
        }
    }

    #[test]
    fn derivatives_are_exact() {
        let term = SineTerm { amplitude: [0.03, -0.02, 0.2].into(), frequency: 1.7, phase: 0.4 };
        let motion = MultiSine { center: [0.0, 0.01, 0.6].into(), terms: vec![term] };
        let h = 1e-5;
        for t in [0.0, 0.13, 0.31] {
            let at = |t: f64| PAPER.inverse(&motion.at(t));
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            for leg in 0..3 {
                let rate = (after[leg].position - before[leg].position) / (2.0 * h);
                let acceleration = (after[leg].rate - before[leg].rate) / (2.0 * h);
                assert!((rate - now[leg].rate).abs() < 1e-8);
                assert!((acceleration - now[leg].acceleration).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn forward_inverts_inverse() {
        for pose in [[0.05, 0.0, 0.52], [-0.03, 0.04, 0.9], [0.0, 0.0, 1.5]] {
            let pose = Vector3::from(pose);
            let lengths = PAPER.inverse(&PathPoint { pose, ..PathPoint::default() });
            let lengths = lengths.map(|c| c.position);
            let found = PAPER.forward(lengths, pose + Vector3::new(5e-3, -4e-3, 0.1));
            assert!((found.expect("converges") - pose).norm() < 1e-12);
        }
    }

    #[test]
    fn singular_wherever_the_platform_is_parallel_to_the_base() {
        for (x, y) in [(0.0, 0.0), (0.05, -0.02), (-0.08, 0.03)] {
            for phi in [0.0, PI] {
                assert!(PAPER.singularity_distance([x, y, phi].into()).abs() < 1e-15);
            }
        }
        // Centred: arm = r a sin φ/q with r, a the circumradii.
        let (r, a) = (0.1 / 3f64.sqrt(), 0.66 / 3f64.sqrt());
        let q = (a * a + r * r - 2.0 * a * r * (PI / 6.0).cos()).sqrt();
        let expected = r * a * (PI / 6.0).sin() / q;
        let found = PAPER.singularity_distance([0.0, 0.0, PI / 6.0].into()).abs();
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
}
