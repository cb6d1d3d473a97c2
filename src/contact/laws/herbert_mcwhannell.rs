//! Herbert and McWhannell's law.

use super::kind::{BY_RESTITUTION, LawKind, Losses};
use super::loss::Loss;

/// `F = K δⁿ (1 + h δ̇/δ̇⁻)`, `h = 6 (1 − e)/((2e − 1)² + 3)`.
pub(super) static KIND: LawKind = LawKind {
    name: "herbert-mcwhannell",
    summary: "Hertz with a hysteresis whose factor corrects Hunt and Crossley's for larger losses",
    equation: "K d^n (1 + h rate/impact_speed), h = 6 (1 - e)/((2 e - 1)^2 + 3)",
    source: "R. G. Herbert, D. C. McWhannell, J. Eng. Ind. 99 (1977) 513-518",
    validity: "e near 1; below about 0.8 it returns more than it is asked for",
    parameters: BY_RESTITUTION,
    losses: Losses::Restitution,
    build: |given| given.power(Loss::Restitution(factor(given.restitution()))),
};

/// h of the paper, in the form of the review by Machado et al., Mech. Mach. Theory 53 (2012) 99–121.
fn factor(e: f64) -> f64 {
    6.0 * (1.0 - e) / ((2.0 * e - 1.0).powi(2) + 3.0)
}
