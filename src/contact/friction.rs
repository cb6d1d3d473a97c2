//! Friction between journal and bearing: laws without a memory, as shares of the normal force over the sliding
//! speed.

/// Coulomb friction, smoothed around rest: `F_t = μ F_N tanh(v_t/v_s)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoulombFriction {
    /// Coefficient of friction μ, dimensionless.
    pub coefficient: f64,
    /// Sliding speed v_s in m/s at which tanh reaches 0.76 of the full friction.
    pub velocity: f64,
}

impl CoulombFriction {
    /// Force in N along the direction of sliding, to be applied against it.
    ///
    /// `normal_force` in N, `sliding` (relative tangential velocity at the contact point) in m/s.
    pub fn force(&self, normal_force: f64, sliding: f64) -> f64 {
        self.coefficient * normal_force * (sliding / self.velocity).tanh()
    }
}

/// A friction law with its coefficient. Speeds are sliding speeds at the contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// The smoothed law of Coulomb.
    Coulomb(CoulombFriction),
    /// `μ F_N (1 − e^(−3 |v|/v_r))` up to v_r, constant beyond, where it is 0.95 of the full friction (R. J.
    /// Threlfall, Mech. Mach. Theory 13 (1978) 475–483).
    Threlfall {
        /// μ.
        coefficient: f64,
        /// v_r in m/s.
        velocity: f64,
    },
    /// A parabola up to the static friction at v_0, `μ_s F_N (1 − (|v| − v_0)²/v_0²)`, and an exponential fall to
    /// the sliding one beyond, `F_N (μ + (μ_s − μ) e^(−(|v| − v_0)/v_f))` (M. T. Bengisu, A. Akay, J. Sound Vib. 171
    /// (1994) 557–570, with ξ = 1/v_f).
    BengisuAkay {
        /// μ of sliding.
        coefficient: f64,
        /// Static over sliding friction, μ_s/μ.
        ratio: f64,
        /// v_0 in m/s.
        velocity: f64,
        /// v_f in m/s over which static friction falls to that of sliding.
        fall: f64,
    },
    /// Nothing up to v_0, a straight line from there to the full friction at v_1 (J. A. C. Ambrósio, in: Virtual
    /// Nonlinear Multibody Systems, NATO Science Series 103 (2003) 57–81).
    Ambrosio {
        /// μ.
        coefficient: f64,
        /// v_0 in m/s.
        rest: f64,
        /// v_1 in m/s, above v_0.
        velocity: f64,
    },
    /// `F_N (μ + (μ_s − μ) e^(−(v/v_f)²)) tanh(v/v_s)`: static friction that falls with speed (R. Stribeck, Z. VDI
    /// 46 (1902); the exponential of L. C. Bo, D. Pavelescu, Wear 82 (1982) 277–289).
    Stribeck {
        /// μ of sliding.
        coefficient: f64,
        /// Static over sliding friction, μ_s/μ.
        ratio: f64,
        /// v_s in m/s, slow against v_f.
        velocity: f64,
        /// v_f in m/s.
        fall: f64,
    },
}

impl From<CoulombFriction> for Friction {
    fn from(friction: CoulombFriction) -> Self {
        Friction::Coulomb(friction)
    }
}

impl Friction {
    /// Force in N along the direction of sliding, to be applied against it.
    ///
    /// `normal_force` in N, `sliding` (relative tangential velocity at the contact point) in m/s.
    pub fn force(&self, normal_force: f64, sliding: f64) -> f64 {
        let speed = sliding.abs();
        let (coefficient, share) = match *self {
            Friction::Coulomb(coulomb) => return coulomb.force(normal_force, sliding),
            Friction::Threlfall { coefficient, velocity } => {
                (coefficient, -(-3.0 * (speed / velocity).min(1.0)).exp_m1())
            }
            Friction::BengisuAkay { coefficient, ratio, velocity, fall } => {
                let beyond = speed - velocity;
                let share = if beyond < 0.0 {
                    ratio * (1.0 - (beyond / velocity).powi(2))
                } else {
                    1.0 + (ratio - 1.0) * (-beyond / fall).exp()
                };
                (coefficient, share)
            }
            Friction::Ambrosio { coefficient, rest, velocity } => {
                (coefficient, ((speed - rest) / (velocity - rest)).clamp(0.0, 1.0))
            }
            Friction::Stribeck { coefficient, ratio, velocity, fall } => {
                let falling = (ratio - 1.0) * (-(speed / fall).powi(2)).exp();
                (coefficient, (1.0 + falling) * (speed / velocity).tanh())
            }
        };
        (coefficient * share * normal_force).copysign(sliding)
    }

    /// The same law with the coefficient μ of sliding, and that of rest in proportion.
    pub fn with_coefficient(mut self, mu: f64) -> Self {
        match &mut self {
            Friction::Coulomb(CoulombFriction { coefficient, .. })
            | Friction::Threlfall { coefficient, .. }
            | Friction::BengisuAkay { coefficient, .. }
            | Friction::Ambrosio { coefficient, .. }
            | Friction::Stribeck { coefficient, .. } => *coefficient = mu,
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MU: f64 = 0.2;
    const V: f64 = 1e-3;

    fn all() -> [Friction; 5] {
        let (coefficient, velocity, ratio, fall) = (MU, V, 1.5, 1e-2);
        [
            CoulombFriction { coefficient, velocity }.into(),
            Friction::Threlfall { coefficient, velocity },
            Friction::BengisuAkay { coefficient, ratio, velocity, fall },
            Friction::Ambrosio { coefficient, rest: 1e-4, velocity },
            Friction::Stribeck { coefficient, ratio, velocity, fall },
        ]
    }

    #[test]
    fn all_are_odd_continuous_and_coulombs_at_speed() {
        for law in all() {
            assert_eq!(law.force(50.0, 0.0), 0.0, "{law:?}");
            // Threlfall's is 0.95 of it, by its definition.
            let full = law.force(50.0, 1.0) / (50.0 * MU);
            assert!((0.95..=1.0 + 1e-12).contains(&full), "{law:?}: {full}");
            let mut before = 0.0;
            for k in 1..4000 {
                let v = 1e-6 * f64::from(k);
                let force = law.force(50.0, v);
                assert_eq!(law.force(50.0, -v), -force, "{law:?}");
                assert!(force >= 0.0 && (force - before).abs() < 0.04, "{law:?} at {v}");
                before = force;
            }
        }
    }

    #[test]
    fn published_points() {
        let [_, threlfall, bengisu, ambrosio, stribeck] = all();
        assert!((threlfall.force(1.0, V) - MU * (1.0 - (-3f64).exp())).abs() < 1e-15);
        // The static friction at v_0, with a level tangent.
        assert!((bengisu.force(1.0, V) - 0.3).abs() < 1e-15);
        assert!((bengisu.force(1.0, 0.5 * V) - 0.3 * 0.75).abs() < 1e-15);
        assert!((ambrosio.force(1.0, 5.5e-4) - 0.5 * MU).abs() < 1e-15);
        assert_eq!(ambrosio.force(1.0, 9e-5), 0.0);
        let expected = (MU + 0.1 * (-0.25f64).exp()) * 5f64.tanh();
        assert!((stribeck.force(1.0, 5e-3) - expected).abs() < 1e-15);
    }

    #[test]
    fn laws_with_equal_coefficients_lose_their_fall() {
        let stribeck = Friction::Stribeck { coefficient: MU, ratio: 1.0, velocity: V, fall: 1e-2 };
        let coulomb = CoulombFriction { coefficient: MU, velocity: V };
        for v in [1e-4, 2e-3, -0.3] {
            assert!((stribeck.force(7.0, v) - coulomb.force(7.0, v)).abs() < 1e-15);
        }
        let halved = all()[2].with_coefficient(0.1);
        assert!((halved.force(1.0, V) - 0.15).abs() < 1e-15);
    }
}
