//! `kind = "3rpr"`: the planar parallel manipulator with three legs, each R-P-R.

use super::{Inertia, Numbers, Template, triangle_inertia};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Base and platform of the 3-RPR manipulator: two equilateral triangles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ThreeRpr {
    /// Side of the triangle of base anchors A1 A2 A3, m. Default 0.660: the paper.
    pub base_side: f64,
    /// Side of the triangle of platform corners C1 C2 C3, m. Default 0.100: the paper.
    pub platform_side: f64,
    /// Mass of the platform, kg. Default 0.2: the paper.
    pub platform_mass: f64,
    /// Inertia of the platform about its centre, kg m². Default m s²/12, of a triangular
    /// plate of mass m and side s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub platform_inertia: Option<f64>,
}

impl Default for ThreeRpr {
    fn default() -> Self {
        ThreeRpr {
            base_side: 0.660,
            platform_side: 0.100,
            platform_mass: 0.2,
            platform_inertia: None,
        }
    }
}

impl ThreeRpr {
    /// Inertia about the platform's centre, kg m²: as given, or that of a thin uniform triangular plate, m s²/12 (the paper gives
    /// none).
    pub fn platform_inertia(&self) -> f64 {
        let plate = || triangle_inertia(self.platform_mass, self.platform_side);
        self.platform_inertia.unwrap_or_else(plate)
    }
}

impl Template for ThreeRpr {
    fn revolutes(&self) -> &'static [&'static str] {
        &["A1", "A2", "A3", "C1", "C2", "C3"]
    }

    fn lengths(&self) -> Numbers {
        vec![("base_side", self.base_side), ("platform_side", self.platform_side)]
    }

    fn masses(&self) -> Numbers {
        vec![("platform_mass", self.platform_mass)]
    }

    fn inertia(&self) -> Option<Inertia> {
        self.platform_inertia.map(|value| ("platform_inertia", value, "kg m²"))
    }

    fn derived_inertia(&self) -> Option<Inertia> {
        let given = self.platform_inertia.is_some();
        (!given).then(|| ("platform_side", self.platform_inertia(), "kg m²"))
    }

    fn sections(&self) -> &'static [&'static str] {
        &["motion", "drive", "legs", "sensors"]
    }
}
