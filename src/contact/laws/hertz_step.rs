//! The entry of the default law, [`HertzStep`].

use super::kind::{
    EXPONENT, Given, LawKind, LawParameter, LawRange, Losses, POISSON_RATIO, STIFFNESS,
    STIFFNESS_FORM, YOUNGS_MODULUS,
};
use crate::contact::HertzStep;
use std::sync::Arc;

/// ADAMS' IMPACT function: see [`HertzStep`].
pub static HERTZ_STEP: LawKind = LawKind {
    name: "hertz-step",
    summary: "ADAMS' IMPACT function, the default: Hertz with a damper that fades in with penetration",
    equation: "max(0, K d^n + step(d) rate), step = c_max s^2 (3 - 2 s), s = d/d_max, at most c_max",
    source: "M. H. Varedi-Koulaei, M. Bamdad, eqs. 3-6; MSC.ADAMS, function IMPACT",
    validity: "contacts that are small against the bodies; what is returned depends on the impact speed",
    parameters: &[
        YOUNGS_MODULUS,
        POISSON_RATIO,
        STIFFNESS_FORM,
        STIFFNESS,
        EXPONENT,
        LawParameter {
            name: "c_max",
            unit: "N s/m",
            about: "damping C_max at full depth",
            range: LawRange::NotNegative,
            default: "500",
        },
        LawParameter {
            name: "d_max",
            unit: "m",
            about: "penetration at which the damping is complete",
            range: LawRange::Positive,
            default: "1e-5",
        },
        LawParameter {
            name: "clip",
            unit: "",
            about: "whether the force is kept from pulling while the surfaces part",
            range: LawRange::Choice("true or false"),
            default: "true",
        },
    ],
    losses: Losses::Step,
    build: |given| Arc::new(HertzStep::from(given)),
};

impl From<&Given> for HertzStep {
    fn from(given: &Given) -> Self {
        HertzStep {
            stiffness: given.stiffness(),
            exponent: given.exponent,
            c_max: given.c_max,
            d_max: given.d_max,
            clip: given.clip,
        }
    }
}
