//! The law of Liu, Zhang and Yang for cylindrical joints.

use super::conformal::{dissipative, line_stiffness};
use super::kind::{CONFORMAL, LawKind, Losses};
use super::spring::ElasticForce;

/// `F = ½ π E* L δ √(δ/(2 (ΔR + δ)))`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Winkler {
    /// `π E* L` in N/m.
    stiffness: f64,
    /// ΔR in m.
    radial: f64,
}

impl ElasticForce for Winkler {
    fn force(&self, penetration: f64) -> f64 {
        let width = (penetration / (2.0 * (self.radial + penetration))).sqrt();
        0.5 * self.stiffness * penetration * width
    }
}

/// See [`Winkler`].
pub(super) static KIND: LawKind = LawKind {
    name: "liu",
    summary: "a journal on an elastic bed, by Liu et al.: it knows clearance and depth alike, so that it holds for small \
              clearances, too",
    equation: "1/2 pi E* L d sqrt(d/(2 (dR + d)))",
    source: "C. Liu, K. Zhang, R. Yang, Mech. Mach. Theory 42 (2007) 183-197",
    validity: "any clearance, contacts up to a large part of the circumference, by its authors",
    parameters: CONFORMAL,
    losses: Losses::Restitution,
    build: |given| {
        let spring = Winkler { stiffness: line_stiffness(given), radial: given.radial() };
        dissipative(given, spring)
    },
};
