//! Lee and Wang's law.

use super::kind::{BY_RESTITUTION, LawKind, Losses};
use super::loss::Loss;

/// `F = K δⁿ (1 + h δ̇/δ̇⁻)`, `h = 3 (1 − e)/4`.
pub(super) static KIND: LawKind = LawKind {
    name: "lee-wang",
    summary: "Hertz with half the hysteresis of Hunt and Crossley",
    equation: "K d^n (1 + h rate/impact_speed), h = 3 (1 - e)/4",
    source: "T. W. Lee, A. C. Wang, J. Mech. Trans. Autom. Des. 105 (1983) 534-540",
    validity: "hardly damped contacts; it loses half of what it is asked to lose at any e near 1",
    parameters: BY_RESTITUTION,
    losses: Losses::Restitution,
    build: |given| given.power(Loss::Restitution(factor(given.restitution()))),
};

/// h of the paper, in the form of the review by Machado et al., Mech. Mach. Theory 53 (2012) 99–121.
fn factor(e: f64) -> f64 {
    0.75 * (1.0 - e)
}
