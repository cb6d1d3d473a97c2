//! Friction between journal and bearing.

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
