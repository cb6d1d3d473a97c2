//! Lankarani and Nikravesh's law.

use super::kind::{BY_RESTITUTION, LawKind, Losses};
use super::loss::Loss;

/// `F = K δⁿ (1 + h δ̇/δ̇⁻)`, `h = 3 (1 − e²)/4`: the loss of an impact set equal to the work of a hysteresis that follows the
/// elastic path both ways.
pub(super) static KIND: LawKind = LawKind {
    name: "lankarani-nikravesh",
    summary: "Hertz with a hysteresis that loses what an impact with restitution e loses, if little is lost",
    equation: "K d^n (1 + h rate/impact_speed), h = 3 (1 - e^2)/4",
    source: "H. M. Lankarani, P. E. Nikravesh, J. Mech. Des. 112 (1990) 369-376",
    validity: "e near 1, above about 0.9 by its authors; below it returns more than it is asked for",
    parameters: BY_RESTITUTION,
    losses: Losses::Restitution,
    build: |given| given.power(Loss::Restitution(factor(given.restitution()))),
};

/// h of the paper.
fn factor(e: f64) -> f64 {
    0.75 * (1.0 - e * e)
}
