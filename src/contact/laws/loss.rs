//! What laws add to their elastic force.

/// What a contact adds to its elastic force S(δ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loss {
    /// Nothing.
    None,
    /// `c δ̇`, c in N·s/m.
    Viscous(f64),
    /// `α S δ̇`, α in s/m: a hysteresis that does not ask how the hit began.
    Hysteresis(f64),
    /// `h S δ̇/δ̇⁻`, h without unit, δ̇⁻ the impact speed: what is returned does not depend on it.
    Restitution(f64),
    /// `STEP(δ, 0, 0, d_max, c_max) δ̇`: what [`HertzStep`](crate::contact::HertzStep) has, which is kept from pulling.
    Step {
        /// Damping in N·s/m, reached at `d_max`.
        c_max: f64,
        /// Penetration in m.
        d_max: f64,
    },
}
