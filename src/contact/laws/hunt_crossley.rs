//! Hunt and Crossley's law.

use super::kind::{
    EXPONENT, LawKind, LawParameter, LawRange, Losses, POISSON_RATIO, STIFFNESS, STIFFNESS_FORM,
    YOUNGS_MODULUS,
};
use super::loss::Loss;

/// α in s/m where none is given: e = 0.73 at 0.1 m/s by the authors' `e = 1 − α v`. Their steel has 0.08–0.32 s/m,
/// bronze 0.1–0.5.
const DAMPING: f64 = 2.7;

/// `F = K δⁿ (1 + (3/2) α δ̇)`: no impact speed enters, so that hits return less the harder they are, `e ≈ 1 − α v`
/// for small losses.
pub(super) static KIND: LawKind = LawKind {
    name: "hunt-crossley",
    summary: "Hertz with a damping that grows with the elastic force; slow hits return more than hard ones",
    equation: "K d^n (1 + 3/2 damping rate), e = 1 - damping impact_speed for small losses",
    source: "K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440-445",
    validity: "damping times impact speed well below 1",
    parameters: &[
        YOUNGS_MODULUS,
        POISSON_RATIO,
        STIFFNESS_FORM,
        STIFFNESS,
        EXPONENT,
        LawParameter {
            name: "damping",
            unit: "s/m",
            about: "alpha: the share of the speed that a hit loses, per m/s",
            range: LawRange::NotNegative,
            default: "2.7",
        },
    ],
    losses: Losses::Damping,
    build: |given| given.power(Loss::Hysteresis(1.5 * given.damping.unwrap_or(DAMPING))),
};
