//! The law of Gonthier, McPhee, Lange and Piedboeuf.

use super::kind::{BY_RESTITUTION, LawKind, Losses};
use super::loss::Loss;

/// `F = K δⁿ (1 + h δ̇/δ̇⁻)`, `h = (1 − e²)/e`: an approximate root of `h (1 + e) = ln((1 + h)/(1 − h e))`, which is exact
/// for a free mass and any n.
pub(super) static KIND: LawKind = LawKind {
    name: "gonthier",
    summary: "Hertz with a hysteresis after the exact impact of a free mass, in an approximation for all e",
    equation: "K d^n (1 + h rate/impact_speed), h = (1 - e^2)/e",
    source: "Y. Gonthier, J. McPhee, C. Lange, J.-C. Piedboeuf, Multibody Syst. Dyn. 11 (2004) 209-233",
    validity: "all e by its authors; what is returned is less than asked by up to 0.035, most at e = 0.8",
    parameters: BY_RESTITUTION,
    losses: Losses::Restitution,
    build: |given| given.power(Loss::Restitution(factor(given.restitution()))),
};

/// h in the approximation of the paper.
fn factor(e: f64) -> f64 {
    (1.0 - e * e) / e
}
