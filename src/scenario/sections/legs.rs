//! `[legs]`: the bars of the three legs, all alike.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A leg: a cylinder at the base and a rod at the platform, solid round bars on one axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Legs {
    /// Density of both bars, kg/m³. Default 2270: the paper.
    pub density: f64,
    /// Length of the cylinder from its pivot, m. Default 0.200: assumed, after the paper's
    /// "motion course amplitude" of 200 mm.
    pub cylinder_length: f64,
    /// Diameter of the cylinder, m. Default 0.020: assumed.
    pub cylinder_diameter: f64,
    /// Length of the rod up to its pivot, m. Default 0.200: assumed; it still reaches the
    /// cylinder at full stroke.
    pub rod_length: f64,
    /// Diameter of the rod, m. Default 0.012: assumed, thinner than the cylinder it slides in.
    pub rod_diameter: f64,
    /// Shortest and longest distance of a leg's two pivots, m. Default [0.2, 0.4]: assumed; from
    /// the rod fully in to its end at the cylinder's mouth.
    pub stroke: [f64; 2],
}

impl Default for Legs {
    fn default() -> Self {
        Legs {
            density: 2270.0,
            cylinder_length: 0.200,
            cylinder_diameter: 0.020,
            rod_length: 0.200,
            rod_diameter: 0.012,
            stroke: [0.2, 0.4],
        }
    }
}
