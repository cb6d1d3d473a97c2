//! Friction between journal and bearing, as shares of the normal force over the sliding speed; one law remembers how far
//! its bristles have bent.

use super::After;

/// Coulomb friction, smoothed around rest: `F_t = μ F_N tanh(v_t/v_s)`.
///
/// [`Friction`] has an example.
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
///
/// ```
/// use freeplay::contact::{CoulombFriction, Friction};
///
/// let friction = Friction::from(CoulombFriction { coefficient: 0.1, velocity: 1e-3 });
/// assert!((friction.force(50.0, 0.1) - 5.0).abs() < 1e-9, "µ F far above 1 mm/s");
/// assert!(friction.force(50.0, -1e-4) < 0.0, "against the sliding, however slow");
/// assert!((friction.with_coefficient(0.2).force(50.0, 0.1) - 10.0).abs() < 1e-9);
/// ```
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
    /// Bristles, which hold at rest: `F_N (σ₀ z + σ₁ e^(−(v/v_s)²) ż)`, `ż = v − σ₀ |v| z/g`, with Stribeck's
    /// `g = μ + (μ_s − μ) e^(−(v/v_f)²)`, σ₀ = μ/d and σ₁ = μ/v_s, so that fast changes near rest meet the slope of
    /// [`CoulombFriction`] (C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky, IEEE Trans. Autom. Control 40 (1995)
    /// 419–425; the fading of σ₁: H. Olsson et al., European J. of Control 4 (1998) 176–195).
    LuGre {
        /// μ of sliding.
        coefficient: f64,
        /// Static over sliding friction, μ_s/μ.
        ratio: f64,
        /// v_s in m/s.
        velocity: f64,
        /// v_f in m/s.
        fall: f64,
        /// d in m: how far bristles bend before the surfaces slide.
        presliding: f64,
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
            // As it has long slid like that.
            Friction::LuGre { coefficient, ratio, velocity, fall, .. } => {
                return Friction::Stribeck { coefficient, ratio, velocity, fall }
                    .force(normal_force, sliding);
            }
        };
        (coefficient * share * normal_force).copysign(sliding)
    }

    /// Whether the force depends on how the surfaces have slid before.
    pub fn remembers(&self) -> bool {
        matches!(self, Friction::LuGre { .. })
    }

    /// The same force of a law that remembers, in a contact with this penetration in m.
    pub fn force_after(
        &self,
        memory: After,
        penetration: f64,
        normal_force: f64,
        sliding: f64,
    ) -> f64 {
        let Friction::LuGre { coefficient, velocity, presliding, .. } = *self else {
            return self.force(normal_force, sliding);
        };
        let bent = self.bent(memory, penetration, sliding);
        let most = self.most_bent(sliding);
        let bending = sliding - sliding.abs() * bent / most;
        let damping = (-(sliding / velocity).powi(2)).exp() * bending / velocity;
        coefficient * normal_force * (bent / presliding + damping)
    }

    /// How far bristles have bent in m: `dz/ds = 1 − z/(± g/σ₀)` solved exactly over what the surfaces have slid since, at
    /// the mean of both speeds, as long as they have touched. They stand upright in flight.
    pub(super) fn bent(&self, memory: After, penetration: f64, sliding: f64) -> f64 {
        if penetration <= 0.0 || !self.remembers() {
            return 0.0;
        }
        let touch = memory.touch;
        let slid = 0.5 * (touch.sliding + sliding) * memory.touching(penetration);
        let end = self.most_bent(sliding).copysign(slid);
        touch.bent + (touch.bent - end) * (-(slid / end)).exp_m1()
    }

    /// z of bristles that have long slid at a speed, in m.
    fn most_bent(&self, sliding: f64) -> f64 {
        match *self {
            Friction::LuGre { ratio, fall, presliding, .. } => {
                presliding * (1.0 + (ratio - 1.0) * (-(sliding / fall).powi(2)).exp())
            }
            _ => 0.0,
        }
    }

    /// The coefficient μ of sliding.
    pub fn coefficient(&self) -> f64 {
        match *self {
            Friction::Coulomb(CoulombFriction { coefficient, .. })
            | Friction::Threlfall { coefficient, .. }
            | Friction::BengisuAkay { coefficient, .. }
            | Friction::Ambrosio { coefficient, .. }
            | Friction::Stribeck { coefficient, .. }
            | Friction::LuGre { coefficient, .. } => coefficient,
        }
    }

    /// The same law with the coefficient μ of sliding, and that of rest in proportion.
    pub fn with_coefficient(mut self, mu: f64) -> Self {
        match &mut self {
            Friction::Coulomb(CoulombFriction { coefficient, .. })
            | Friction::Threlfall { coefficient, .. }
            | Friction::BengisuAkay { coefficient, .. }
            | Friction::Ambrosio { coefficient, .. }
            | Friction::Stribeck { coefficient, .. }
            | Friction::LuGre { coefficient, .. } => *coefficient = mu,
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::Touch;
    use super::*;

    const MU: f64 = 0.2;
    const V: f64 = 1e-3;

    const LUGRE: Friction =
        Friction::LuGre { coefficient: MU, ratio: 1.5, velocity: V, fall: 1e-2, presliding: 1e-6 };

    /// Bristles that are bent by 0.1 µm push back like a spring; those of surfaces that have slid far carry the law's full
    /// friction, whatever steps they were followed in.
    #[test]
    fn bristles_hold_first_and_slide_then() {
        let rest = Touch::begin(1e-6, 0.0);
        let slow = 1e-4;
        let force = LUGRE.force_after(rest.after(1e-3), 1e-6, 50.0, slow);
        // Half of the way at the mean speed; d grows with the static friction.
        let bent = 1.5e-6 * (-(-0.5 * slow * 1e-3 / 1.5e-6f64).exp_m1());
        let damped = MU * 50.0 * (slow - slow * bent / 1.5e-6) / V * (-0.01f64).exp();
        let expected = MU * 50.0 * bent / 1e-6 + damped;
        assert!((force / expected - 1.0).abs() < 1e-3, "{force} {expected}");
        for steps in [10, 1000] {
            let (mut touch, h) = (rest, 1e-3 / f64::from(steps));
            for _ in 0..steps {
                let after = touch.after(h);
                touch.bent = LUGRE.bent(after, 1e-6, 0.05);
                touch.sliding = 0.05;
            }
            let force = LUGRE.force_after(touch.after(0.0), 1e-6, 50.0, 0.05);
            assert!((force / LUGRE.force(50.0, 0.05) - 1.0).abs() < 1e-9, "{force}");
        }
        assert_eq!(LUGRE.bent(rest.after(1.0), -1e-9, 1.0), 0.0);
    }

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
