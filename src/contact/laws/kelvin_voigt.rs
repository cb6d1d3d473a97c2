//! The linear spring and damper of Kelvin and Voigt.

use super::damped::Damped;
use super::kind::{
    LawKind, LawParameter, LawRange, Losses, POISSON_RATIO, STIFFNESS, STIFFNESS_FORM,
    YOUNGS_MODULUS,
};
use super::loss::Loss;
use super::spring::PowerSpring;
use std::sync::Arc;

/// Depth in m at which the linear spring has taken up as much work as Hertz', where no stiffness is given: that of
/// a hit of 0.1 kg at 0.1 m/s.
const EQUAL_WORK: f64 = 1e-5;

/// Damping c in N·s/m where none is given: returns 0.73 of the speed of a 0.1 kg journal under the default
/// stiffness.
const DAMPING: f64 = 243.0;

/// `F = K δ + c δ̇`, at least zero. A free mass m leaves when the force is zero, with the share
/// `exp(−β (π − arctan(2 β √(1 − β²)/(2 β² − 1)))/√(1 − β²))`, `β = c/(2 √(K m))`, of its speed.
pub(super) static KIND: LawKind = LawKind {
    name: "kelvin-voigt",
    summary: "a linear spring and a linear damper side by side; the force jumps when surfaces touch",
    equation: "max(0, K d + damping rate)",
    source: "W. Goldsmith, Impact, Edward Arnold, 1960, chapter 1; cut at zero as in T. Schwager, T. Poschel, \
             Granular Matter 9 (2007) 465-469",
    validity: "light damping, where the jump of damping times impact speed is small against the peak force",
    parameters: &[
        YOUNGS_MODULUS,
        POISSON_RATIO,
        STIFFNESS_FORM,
        LawParameter {
            unit: "N/m",
            about: "stiffness K of the linear spring, in place of the one that takes up as much work as Hertz' at \
                    10 um",
            ..STIFFNESS
        },
        LawParameter {
            name: "damping",
            unit: "N s/m",
            about: "damping c",
            range: LawRange::NotNegative,
            default: "243",
        },
    ],
    losses: Losses::Damping,
    build: |given| {
        // ½ k d² = K d^2.5/2.5.
        let stiffness = given.stiffness.unwrap_or_else(|| 0.8 * given.hertz() * EQUAL_WORK.sqrt());
        let loss = Loss::Viscous(given.damping.unwrap_or(DAMPING));
        Arc::new(Damped { spring: PowerSpring { stiffness, exponent: 1.0 }, loss })
    },
};
