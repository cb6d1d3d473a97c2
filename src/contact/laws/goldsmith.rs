//! Goldsmith's law of two cylinders.

use super::conformal::{line_stiffness, logarithmic};
use super::kind::{CONFORMAL, LawKind, Losses};

/// `δ = F/(π E* L) (ln(π E* L³/(F R)) + 1)`, `R = R_i R_j/(R_i + R_j)`, so `D = e π E* L³/R`. The clearance does not enter.
pub(super) static KIND: LawKind = LawKind {
    name: "goldsmith",
    summary: "line contact of two cylinders, by Goldsmith; it does not know the clearance",
    equation: "d = F/(pi E* L) (ln(pi E* L^3/(F R)) + 1), solved for F",
    source: "W. Goldsmith, Impact, Edward Arnold, 1960; in the form of P. Flores, J. Ambrosio, J. C. P. Claro, H. M. Lankarani, Kinematics and Dynamics of Multibody Systems with Imperfect Joints, Springer, 2008, chapter 3, with L^3, which the units ask for",
    validity: "contacts narrow against the radii; it is meant for two convex cylinders",
    parameters: CONFORMAL,
    losses: Losses::Restitution,
    build: |given| {
        let [i, j] = [given.bearing_radius, given.journal_radius];
        let radius = i * j / (i + j);
        logarithmic(given, 1f64.exp() * line_stiffness(given) * given.length().powi(2) / radius)
    },
};
