//! The Hertz spring with STEP damping: ADAMS' IMPACT function, equations 4–6 of the source paper.

use super::laws::{Damped, Loss, PowerSpring};
use super::{ForceLaw, power_force, step};
use std::sync::Arc;

/// Hertz spring plus a damper that fades in with penetration (paper eqs. 4 and 6):
///
/// `F_N = K δ^n + STEP(δ, 0, 0, d_max, C_max) δ̇` for δ > 0.
///
/// As printed, `F_N` turns negative while the surfaces part quickly. ADAMS' own IMPACT takes the
/// maximum with zero, and so does this law unless `clip` is false.
///
/// ```
/// use freeplay::contact::{ForceLaw, HertzStep};
///
/// let law = HertzStep { stiffness: 1.6e10, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true };
/// // Surfaces that part at 2 m/s: as printed the law would pull.
/// assert_eq!(law.normal_force(1e-6, -2.0), 0.0);
/// assert!(HertzStep { clip: false, ..law }.normal_force(1e-6, -2.0) < 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzStep {
    /// Stiffness K in N/m^n.
    pub stiffness: f64,
    /// Exponent n of the penetration, 1.5 for Hertz' theory of smooth non-conformal bodies.
    pub exponent: f64,
    /// Damping coefficient C_max in N·s/m, reached at the penetration `d_max`.
    pub c_max: f64,
    /// Penetration d_max in m from which the damping is complete.
    pub d_max: f64,
    /// Never pull: the force is at least zero (ADAMS' IMPACT); `false` is the formula as printed.
    pub clip: bool,
}

impl HertzStep {
    /// The elastic part `K δ^n` in N.
    fn elastic(&self, penetration: f64) -> f64 {
        power_force(self.stiffness, self.exponent, penetration)
    }
}

impl ForceLaw for HertzStep {
    fn normal_force(&self, penetration: f64, rate: f64) -> f64 {
        if penetration <= 0.0 {
            return 0.0;
        }
        let damping = step(penetration, self.d_max, self.c_max);
        let force = self.elastic(penetration) + damping * rate;
        if self.clip { force.max(0.0) } else { force }
    }

    /// Deepest penetration in m of a lossless hit: `½ m v² = K δ^(n+1)/(n+1)`.
    fn deepest_penetration(&self, mass: f64, speed: f64) -> f64 {
        let n1 = self.exponent + 1.0;
        (n1 * mass * speed * speed / (2.0 * self.stiffness)).powf(1.0 / n1)
    }

    /// Duration in s of a lossless Hertzian hit, `T = 2.94 δ_max/v` (K. L. Johnson, *Contact
    /// Mechanics*, 1985, §11.4: 2.94 = 2√π Γ(7/5)/Γ(9/10) for n = 1.5).
    fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        2.9432 * self.deepest_penetration(mass, speed) / speed
    }

    fn stiffness(&self) -> Option<f64> {
        Some(self.stiffness)
    }

    fn resting_penetration(&self, force: f64) -> f64 {
        (force / self.stiffness).powf(1.0 / self.exponent)
    }

    /// Five steps per hit (the leapfrog turns unstable near two); the damper needs `h C/m ≤ 1`
    /// (explicit, unstable from 2).
    fn longest_step(&self, mass: f64, speed: f64) -> f64 {
        let depth = self.deepest_penetration(mass, speed);
        let damping = step(depth, self.d_max, self.c_max);
        let elastic = self.contact_time(mass, speed) / 5.0;
        if damping > 0.0 { elastic.min(mass / damping) } else { elastic }
    }

    fn damped(&self, factor: f64) -> Option<Arc<dyn ForceLaw>> {
        Some(Arc::new(HertzStep { c_max: self.c_max * factor, ..*self }))
    }

    fn losing(&self, loss: Loss) -> Option<Arc<dyn ForceLaw>> {
        let spring = PowerSpring { stiffness: self.stiffness, exponent: self.exponent };
        Some(Arc::new(Damped { spring, loss }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: HertzStep =
        HertzStep { stiffness: 3.7328e9, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true };

    #[test]
    fn clip_decides_whether_a_parting_contact_may_pull() {
        let literal = HertzStep { clip: false, ..LAW };
        assert_eq!(LAW.normal_force(1e-6, -10.0), 0.0);
        assert!(literal.normal_force(1e-6, -10.0) < 0.0);
        assert_eq!(LAW.normal_force(5e-6, 0.1), literal.normal_force(5e-6, 0.1));
        assert_eq!(LAW.normal_force(0.0, 1.0), 0.0);
    }

    #[test]
    fn special_case_of_the_exponent_equals_the_general_power() {
        let general = LAW.stiffness * 7e-6f64.powf(1.5);
        assert!((LAW.normal_force(7e-6, 0.0) / general - 1.0).abs() < 1e-14);
        let linear = HertzStep { exponent: 1.0, ..LAW };
        assert_eq!(linear.normal_force(7e-6, 0.0), LAW.stiffness * 7e-6);
    }

    #[test]
    fn lossless_hit_agrees_with_the_independent_solver() {
        // impact.csv, 0.1 kg, 0.1 m/s, no damping: depth 1.0231217e-5 m, time 3.011487e-4 s.
        assert!((LAW.deepest_penetration(0.1, 0.1) / 1.0231217e-5 - 1.0).abs() < 1e-4);
        assert!((LAW.contact_time(0.1, 0.1) / 3.011487e-4 - 1.0).abs() < 1e-4);
    }
}
