//! The law of Flores, Machado, Silva and Martins.

use super::kind::{BY_RESTITUTION, LawKind, Losses};
use super::loss::Loss;

/// `F = K δⁿ (1 + h δ̇/δ̇⁻)`, `h = 8 (1 − e)/(5 e)`.
pub(super) static KIND: LawKind = LawKind {
    name: "flores",
    summary: "Hertz with a hysteresis for soft materials, for all e",
    equation: "K d^n (1 + h rate/impact_speed), h = 8 (1 - e)/(5 e)",
    source: "P. Flores, M. Machado, M. T. Silva, J. M. Martins, Multibody Syst. Dyn. 25 (2011) 357-375",
    validity: "all e by its authors; what is returned is less than asked by up to 0.045, most at e = 0.25",
    parameters: BY_RESTITUTION,
    losses: Losses::Restitution,
    build: |given| given.power(Loss::Restitution(factor(given.restitution()))),
};

/// The factor h of the damping for a coefficient of restitution e, without unit: `8 (1 − e)/(5 e)`.
pub fn factor(e: f64) -> f64 {
    1.6 * (1.0 - e) / e
}
