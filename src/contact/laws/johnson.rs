//! Johnson's law of a journal in a bearing.

use super::conformal::{line_stiffness, logarithmic};
use super::kind::{CONFORMAL, LawKind, Losses};

/// `δ = F/(π E* L) (ln(4 π E* L ΔR/F) − 1)`, so `D = 4 π E* L ΔR/e`.
pub(super) static KIND: LawKind = LawKind {
    name: "johnson",
    summary: "line contact of cylinders of nearly the same radius, by Johnson",
    equation: "d = F/(pi E* L) (ln(4 pi E* L dR/F) - 1), solved for F",
    source: "K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, sections 4.2 and 5.6; in the form of C. M. Pereira, A. L. Ramalho, J. A. Ambrosio, Nonlinear Dyn. 63 (2011) 681-697",
    validity: "the formula ends where E* L dR is no longer large against F: small clearances; beyond the depth where its compliance has halved it is continued along its tangent",
    parameters: CONFORMAL,
    losses: Losses::Restitution,
    build: |given| logarithmic(given, 4.0 * line_stiffness(given) * given.radial() / 1f64.exp()),
};
