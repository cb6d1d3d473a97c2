//! What the laws of a journal in line contact with its bearing have in common.

use super::damped::Damped;
use super::kind::Given;
use super::loss::Loss;
use super::spring::{ElasticForce, Logarithmic};
use crate::contact::ForceLaw;
use std::f64::consts::PI;
use std::sync::Arc;

/// An elastic conformal law with the damping that such laws are commonly given, Lankarani and Nikravesh's `1 + 3 (1 −
/// e²)/4 δ̇/δ̇⁻` (as C. M. Pereira, J. Ambrósio, A. Ramalho, Multibody Syst. Dyn. 35 (2015), have it).
pub(super) fn dissipative<S: ElasticForce>(given: &Given, spring: S) -> Arc<dyn ForceLaw> {
    let e = given.restitution.unwrap_or(1.0);
    let loss = if e == 1.0 { Loss::None } else { Loss::Restitution(0.75 * (1.0 - e * e)) };
    Arc::new(Damped { spring, loss })
}

/// `δ = F/(π E* L) ln(D/F)` with the force D in N of a law.
pub(super) fn logarithmic(given: &Given, scale: f64) -> Arc<dyn ForceLaw> {
    let compliance = 1.0 / line_stiffness(given);
    dissipative(given, Logarithmic { compliance, scale })
}

/// `π E* L` in N/m: 1/(h_i + h_j) times the length in the laws that have `h = (1 − ν²)/(π E)`.
pub(super) fn line_stiffness(given: &Given) -> f64 {
    PI * given.modulus() * given.length()
}
