//! `kind = "five-bar"`: two cranks that carry a point by two rods.

use super::{Inertia, Numbers, Template};
use crate::scenario::sections::{Circle, Motion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cranks about O1 and O2 on the ground and two rods that meet in E. Links are slender uniform bars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FiveBar {
    /// Distance of O1 and O2, along x about the origin, m. Default 0.1.
    pub ground: f64,
    /// Length of both cranks, m. Default 0.12.
    pub crank: f64,
    /// Length of both rods, m. Default 0.16.
    pub rod: f64,
    /// Mass of a link for each metre, kg/m. Default 1.2.
    pub linear_density: f64,
    /// Where E is at the start, m. Default [0, 0.2].
    pub end: [f64; 2],
}

impl Default for FiveBar {
    fn default() -> Self {
        FiveBar { ground: 0.1, crank: 0.12, rod: 0.16, linear_density: 1.2, end: [0.0, 0.2] }
    }
}

impl Template for FiveBar {
    fn revolutes(&self) -> &'static [&'static str] {
        &["O1", "O2", "A1", "A2", "E"]
    }

    fn lengths(&self) -> Numbers {
        vec![("ground", self.ground), ("crank", self.crank), ("rod", self.rod)]
    }

    fn inertia(&self) -> Option<Inertia> {
        Some(("linear_density", self.linear_density, "kg/m"))
    }

    /// A circle of 30 mm that begins at `end`.
    fn default_motion(&self) -> Motion {
        let ([x, y], radius) = (self.end, 0.03);
        let center = [x - radius, y];
        Motion::Circle(Circle { radius, center, phi: 0.0, ..Circle::default() })
    }
}
