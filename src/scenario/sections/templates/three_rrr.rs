//! `kind = "3rrr"`: the planar parallel manipulator with three driven cranks.

use super::{Inertia, Numbers, Template, triangle_inertia};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Three legs of a driven crank and a rod each carry a platform: cranks about O1 O2 O3, pins A1 A2 A3,
/// platform corners C1 C2 C3. Links are slender uniform bars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ThreeRrr {
    /// Side of the triangle of base anchors O1 O2 O3, m. Default 0.66.
    pub base_side: f64,
    /// Side of the triangle of platform corners, m. Default 0.1.
    pub platform_side: f64,
    /// Length of the cranks, m. Default 0.2.
    pub crank: f64,
    /// Length of the rods, m. Default 0.25.
    pub rod: f64,
    /// Mass of the platform, kg; its inertia is that of a thin uniform triangular plate. Default 0.2.
    pub platform_mass: f64,
    /// Mass of a link for each metre, kg/m. Default 0.7.
    pub linear_density: f64,
}

impl Default for ThreeRrr {
    fn default() -> Self {
        ThreeRrr {
            base_side: 0.66,
            platform_side: 0.1,
            crank: 0.2,
            rod: 0.25,
            platform_mass: 0.2,
            linear_density: 0.7,
        }
    }
}

impl ThreeRrr {
    /// Inertia about the platform's centre, kg m²: that of a thin uniform triangular plate, m s²/12.
    pub fn platform_inertia(&self) -> f64 {
        triangle_inertia(self.platform_mass, self.platform_side)
    }
}

impl Template for ThreeRrr {
    fn revolutes(&self) -> &'static [&'static str] {
        &["O1", "O2", "O3", "A1", "A2", "A3", "C1", "C2", "C3"]
    }

    fn lengths(&self) -> Numbers {
        vec![
            ("base_side", self.base_side),
            ("platform_side", self.platform_side),
            ("crank", self.crank),
            ("rod", self.rod),
        ]
    }

    fn masses(&self) -> Numbers {
        vec![("platform_mass", self.platform_mass)]
    }

    fn inertia(&self) -> Option<Inertia> {
        Some(("linear_density", self.linear_density, "kg/m"))
    }

    fn derived_inertia(&self) -> Option<Inertia> {
        Some(("platform_side", self.platform_inertia(), "kg m²"))
    }
}
