//! Qin Zhiying and Lu Qishao's law.

use super::kind::{BY_RESTITUTION, LawKind, Losses};
use super::loss::Loss;

/// `F = K δⁿ (1 + h δ̇/δ̇⁻)`, `h = 3 (1 − e²) e^(2(1−e))/4`: Lankarani and Nikravesh's, corrected by an exponential.
pub(super) static KIND: LawKind = LawKind {
    name: "zhiying-qishao",
    summary: "Lankarani and Nikravesh's law with an exponential correction for larger losses",
    equation: "K d^n (1 + h rate/impact_speed), h = 3 (1 - e^2) exp(2 (1 - e))/4",
    source: "Z. Qin, Q. Lu, J. Dyn. Control 4 (2006) 294-298",
    validity: "e above about 0.3; below it returns more than it is asked for",
    parameters: BY_RESTITUTION,
    losses: Losses::Restitution,
    build: |given| given.power(Loss::Restitution(factor(given.restitution()))),
};

/// h of the paper, in the form of the review by Machado et al., Mech. Mach. Theory 53 (2012) 99–121.
fn factor(e: f64) -> f64 {
    0.75 * (1.0 - e * e) * (2.0 * (1.0 - e)).exp()
}
