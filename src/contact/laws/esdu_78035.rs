//! The law of the design guide ESDU 78035.

use super::conformal::{line_stiffness, logarithmic};
use super::kind::{CONFORMAL, LawKind, Losses};

/// `δ = F/(π E* L) (ln(4 π E* L ΔR/F) + 1)`, so `D = 4 e π E* L ΔR`.
pub(super) static KIND: LawKind = LawKind {
    name: "esdu-78035",
    summary: "line contact of a pin in a bearing, by the design guide ESDU 78035",
    equation: "d = F/(pi E* L) (ln(4 pi E* L dR/F) + 1), solved for F",
    source: "Engineering Sciences Data Unit, item 78035 (1978); in the form of P. Flores et al., Kinematics and Dynamics of Multibody Systems with Imperfect Joints, Springer, 2008, chapter 3",
    validity: "contacts narrow against the radii; beyond the depth where the formula's compliance has halved it is continued along its tangent",
    parameters: CONFORMAL,
    losses: Losses::Restitution,
    build: |given| logarithmic(given, 4.0 * 1f64.exp() * line_stiffness(given) * given.radial()),
};
