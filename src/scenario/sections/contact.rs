//! `[contact]`: the force between a journal and its bearing.

use crate::contact::StiffnessForm;
use serde::{Deserialize, Serialize};

/// Contact law and its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Contact {
    /// Which law. Default `hertz-step`: the paper's.
    pub law: Law,
    /// Young's modulus E of both surfaces, Pa. Default 73e9: the paper.
    pub youngs_modulus: f64,
    /// Poisson's ratio ν of both surfaces, dimensionless. Default 0.3: the paper.
    pub poisson_ratio: f64,
    /// Exponent n of the penetration in F = K δⁿ + …, dimensionless. Default 1.5: Hertz, the paper.
    pub exponent: f64,
    /// Damping C_max at full depth, N s/m. Default 500: assumed (not in the paper); returns 0.73
    /// of the speed of a 0.1 kg journal that hits at 0.1 m/s.
    pub c_max: f64,
    /// Penetration d_max at which the damping reaches `c_max`, m. Default 1e-5: assumed, with
    /// `c_max`.
    pub d_max: f64,
    /// Whether the force is kept from pulling while the surfaces part. Default true: ADAMS' own
    /// IMPACT function, which the paper used, never pulls; `false` is the formula as printed.
    pub clip: bool,
    /// How K follows from the radii. Default `printed`: as in the paper.
    pub stiffness_form: StiffnessForm,
    /// Stiffness K, N/m^1.5 (N/mⁿ for another exponent), in place of the one from E, ν and the
    /// radii. Default none: computed for each joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Sliding speed v_s at which friction is near its full value, m/s: μ F tanh(v/v_s).
    /// Default 1e-3: assumed; slow against the sliding speeds of a rattling journal.
    pub friction_velocity: f64,
}

impl Default for Contact {
    fn default() -> Self {
        Contact {
            law: Law::HertzStep,
            youngs_modulus: 73e9,
            poisson_ratio: 0.3,
            exponent: 1.5,
            c_max: 500.0,
            d_max: 1e-5,
            clip: true,
            stiffness_form: StiffnessForm::Printed,
            stiffness: None,
            friction_velocity: 1e-3,
        }
    }
}

/// A contact law by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Hertzian stiffness with a damping that steps in over `d_max` (paper, eqs. 3–6).
    HertzStep,
    /// The rigid contact of the physics engine itself.
    Native,
    /// No clearance: ideal revolute joints.
    Ideal,
}
