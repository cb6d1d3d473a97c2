//! Dubowsky and Freudenstein's law of a pin in a bearing.

use super::conformal::{line_stiffness, logarithmic};
use super::kind::{CONFORMAL, LawKind, Losses};

/// `δ = F/(π E* L) (ln(π E* L³ ΔR/(F R_i R_j)) + 1)`, so `D = e π E* L³ ΔR/(R_i R_j)`.
pub(super) static KIND: LawKind = LawKind {
    name: "dubowsky-freudenstein",
    summary: "line contact of a pin in a bearing, by Dubowsky and Freudenstein",
    equation: "d = F/(pi E* L) (ln(pi E* L^3 dR/(F Ri Rj)) + 1), solved for F",
    source: "S. Dubowsky, F. Freudenstein, J. Eng. Ind. 93 (1971) 305-309; exponent 3 of L as in P. Flores et al., Kinematics and Dynamics of Multibody Systems with Imperfect Joints, Springer, 2008, chapter 3",
    validity: "contacts narrow against the radii; beyond the depth where the formula's compliance has halved it is continued along its tangent",
    parameters: CONFORMAL,
    losses: Losses::Restitution,
    build: |given| {
        let [i, j] = [given.bearing_radius, given.journal_radius];
        let shape = given.length().powi(2) * given.radial() / (i * j);
        logarithmic(given, 1f64.exp() * line_stiffness(given) * shape)
    },
};
