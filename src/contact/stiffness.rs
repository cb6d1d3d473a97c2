//! Hertz stiffness of two round bodies, paper eq. 5, in its two readings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Elastic constants of one body.
///
/// [`hertz_stiffness`] has an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus E in Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio ν, dimensionless.
    pub poisson_ratio: f64,
}

/// Which radius enters the stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StiffnessForm {
    /// `R_i + R_j`, as the paper prints it: two convex bodies.
    Printed,
    /// `R_i − R_j`: a journal inside a bearing. Grows without bound as the clearance vanishes.
    Conformal,
}

/// Stiffness K in N/m^1.5 of a journal in a bearing of the same material (paper eq. 5):
///
/// `K = 4 / (3π (h_i + h_j)) · √(R_i R_j / (R_i ± R_j))`, `h = (1 − ν²)/(π E)`,
///
/// with `+` as printed and `−` in the conformal reading. Radii in m.
///
/// ```
/// use freeplay::contact::{Material, StiffnessForm, hertz_stiffness};
///
/// let aluminium = Material { youngs_modulus: 73e9, poisson_ratio: 0.3 };
/// let [printed, conformal] =
///     [StiffnessForm::Printed, StiffnessForm::Conformal].map(|form| hertz_stiffness(form, aluminium, 10e-3, 9.5e-3));
/// // √((R_i + R_j)/(R_i − R_j)) = √39.
/// assert!((conformal / printed - 39f64.sqrt()).abs() < 1e-9);
/// ```
pub fn hertz_stiffness(
    form: StiffnessForm,
    material: Material,
    bearing_radius: f64,
    journal_radius: f64,
) -> f64 {
    use std::f64::consts::PI;
    let nu = material.poisson_ratio;
    let h = (1.0 - nu * nu) / (PI * material.youngs_modulus);
    let sum = match form {
        StiffnessForm::Printed => bearing_radius + journal_radius,
        StiffnessForm::Conformal => bearing_radius - journal_radius,
    };
    4.0 / (3.0 * PI * 2.0 * h) * (bearing_radius * journal_radius / sum).sqrt()
}

/// Stiffness K in N/m^1.5 of a corner rounded with `radius` (m) on a flat guide of the same material: Hertz' for a ball
/// on a plane, `4/3 E* √R`, as between two balls of twice the radius.
pub fn corner_stiffness(material: Material, radius: f64) -> f64 {
    hertz_stiffness(StiffnessForm::Printed, material, 2.0 * radius, 2.0 * radius)
}

/// `K δⁿ` in N, K in N/mⁿ, δ > 0 in m.
#[inline]
pub fn power_force(stiffness: f64, exponent: f64, penetration: f64) -> f64 {
    // δ√δ costs a tenth of a general power, and 1.5 is what almost everybody uses.
    if exponent == 1.5 {
        stiffness * penetration * penetration.sqrt()
    } else {
        stiffness * penetration.powf(exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: Material = Material { youngs_modulus: 73e9, poisson_ratio: 0.3 };

    #[test]
    fn printed_form_gives_the_papers_stiffness() {
        let k = hertz_stiffness(StiffnessForm::Printed, PAPER, 10e-3, 9.5e-3);
        assert!((k / 3.7327999e9 - 1.0).abs() < 1e-7, "{k}");
    }

    #[test]
    fn a_corner_is_a_ball_on_a_plane() {
        let modulus = PAPER.youngs_modulus / (2.0 * (1.0 - 0.3f64.powi(2)));
        let expected = 4.0 / 3.0 * modulus * 1e-3f64.sqrt();
        assert!((corner_stiffness(PAPER, 1e-3) / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn conformal_form_grows_as_the_clearance_vanishes() {
        let k = |c: f64| hertz_stiffness(StiffnessForm::Conformal, PAPER, 10e-3, 10e-3 - c);
        assert!(k(5e-4) > 3.7e9);
        // K² ∝ 1/c where c is small.
        let ratio = (k(1e-8) / k(1e-6)).powi(2);
        assert!((ratio / 100.0 - 1.0).abs() < 1e-3, "{ratio}");
    }
}
