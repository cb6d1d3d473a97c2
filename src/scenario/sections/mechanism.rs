//! `[mechanism]`: which machine, and its base and platform.

use serde::{Deserialize, Serialize};

/// The machine, by its `kind`, the only key of a scenario without a default: a file that does not
/// say what it describes is more likely a mistake than a 3-RPR.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind")]
pub enum Mechanism {
    /// `kind = "3rpr"`: the planar parallel manipulator with three legs, each R-P-R.
    #[serde(rename = "3rpr")]
    ThreeRpr(ThreeRpr),
}

impl Mechanism {
    pub(in crate::scenario) const KINDS: [&'static str; 1] = ["3rpr"];
}

/// Base and platform of the 3-RPR manipulator: two equilateral triangles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ThreeRpr {
    /// Side of the triangle of base anchors A1 A2 A3, m. Default 0.660: the paper.
    pub base_side: f64,
    /// Side of the triangle of platform corners C1 C2 C3, m. Default 0.100: the paper.
    pub platform_side: f64,
    /// Mass of the platform, kg. Default 0.2: the paper.
    pub platform_mass: f64,
    /// Inertia of the platform about its centre, kg m²; see [`ThreeRpr::platform_inertia`].
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
    /// Inertia about the platform's centre, kg m²: as given, or m·side²/12, that of a thin uniform
    /// triangular plate (the paper gives none).
    pub fn platform_inertia(&self) -> f64 {
        self.platform_inertia.unwrap_or(self.platform_mass * self.platform_side.powi(2) / 12.0)
    }
}
