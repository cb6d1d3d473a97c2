//! Radzimovsky's law of two cylinders.

use super::conformal::{line_stiffness, logarithmic};
use super::kind::{CONFORMAL, LawKind, Losses};

/// `δ = F/(π E* L) (2/3 + ln(4 R_i/b) + ln(4 R_j/b))` with the width `b = 4 √(F R/(π E* L))` of Hertz' line contact, `R =
/// R_i R_j/ΔR`, so `D = π E* L ΔR e^(2/3)`.
///
/// b is Roark's `1.60 √(p K_D C_E)` with `K_D = 2 R`; reviews print factors of 1.60 or 2.15 beside R.
pub(super) static KIND: LawKind = LawKind {
    name: "radzimovsky",
    summary: "line contact of two cylinders, by Radzimovsky",
    equation: "d = F/(pi E* L) (2/3 + ln(4 Ri/b) + ln(4 Rj/b)), b = 4 sqrt(F R/(pi E* L)), solved for F",
    source: "E. I. Radzimovsky, University of Illinois Engineering Experiment Station Bulletin 408 (1953); in the form of Roark's Formulas for Stress and Strain, chapter on bodies in contact",
    validity: "contacts narrow against the radii; beyond the depth where the formula's compliance has halved it is continued along its tangent",
    parameters: CONFORMAL,
    losses: Losses::Restitution,
    build: |given| {
        logarithmic(given, line_stiffness(given) * given.radial() * (2.0f64 / 3.0).exp())
    },
};
