//! `kind = "four-bar"`: crank, coupler and rocker.

use super::{Inertia, Numbers, Template};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A crank about O and a rocker about D on the ground, both joined by a coupler from A to B. Links are
/// slender uniform bars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FourBar {
    /// Distance of O and D, along x, m. Default 0.2.
    pub ground: f64,
    /// Length of the crank, m. Default 0.06: with the others a crank-rocker.
    pub crank: f64,
    /// Length of the coupler, m. Default 0.18.
    pub coupler: f64,
    /// Length of the rocker, m. Default 0.13.
    pub rocker: f64,
    /// Mass of a link for each metre, kg/m. Default 1.5: about a steel bar of 20 mm by 10 mm.
    pub linear_density: f64,
    /// Angle of the crank at the start, rad. Default 0.8.
    pub angle: f64,
    /// Whether coupler and rocker meet on the other side of the line from A to D. Default false.
    pub crossed: bool,
}

impl Default for FourBar {
    fn default() -> Self {
        FourBar {
            ground: 0.2,
            crank: 0.06,
            coupler: 0.18,
            rocker: 0.13,
            linear_density: 1.5,
            angle: 0.8,
            crossed: false,
        }
    }
}

impl Template for FourBar {
    fn revolutes(&self) -> &'static [&'static str] {
        &["O", "A", "B", "D"]
    }

    fn lengths(&self) -> Numbers {
        vec![
            ("ground", self.ground),
            ("crank", self.crank),
            ("coupler", self.coupler),
            ("rocker", self.rocker),
        ]
    }

    fn inertia(&self) -> Option<Inertia> {
        Some(("linear_density", self.linear_density, "kg/m"))
    }

    fn angles(&self) -> Numbers {
        vec![("angle", self.angle)]
    }

    fn has_crank(&self) -> bool {
        true
    }
}
