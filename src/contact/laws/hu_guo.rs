//! Hu and Guo's law.

use super::kind::{BY_RESTITUTION, LawKind, Losses};
use super::loss::Loss;

/// `F = K δⁿ (1 + h δ̇/δ̇⁻)`, `h = 3 (1 − e)/(2 e)`.
pub(super) static KIND: LawKind = LawKind {
    name: "hu-guo",
    summary: "Hertz with a hysteresis that is exact to first order near e = 1 and grows as 1/e",
    equation: "K d^n (1 + h rate/impact_speed), h = 3 (1 - e)/(2 e)",
    source: "S. Hu, X. Guo, Multibody Syst. Dyn. 35 (2015) 131-151",
    validity: "all e by its authors; what is returned is less than asked by up to 0.035, most at e = 0.2",
    parameters: BY_RESTITUTION,
    losses: Losses::Restitution,
    build: |given| given.power(Loss::Restitution(factor(given.restitution()))),
};

/// h of the paper.
fn factor(e: f64) -> f64 {
    1.5 * (1.0 - e) / e
}
