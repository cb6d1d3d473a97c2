//! `kind = "slider-crank"`: crank, rod and slider.

use super::{Numbers, Template};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A crank about O on the ground, a rod from its pin A to the pin B of a slider that moves along a line
/// through the ground's point S. Links are slender uniform bars of one mass per length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SliderCrank {
    /// Length of the crank, m. Default 0.05.
    pub crank: f64,
    /// Length of the rod, m. Default 0.12.
    pub rod: f64,
    /// Height of the slider's line above O, m. Default 0: a central slider-crank.
    pub offset: f64,
    /// Mass of the crank, kg. Default 0.3.
    pub crank_mass: f64,
    /// Mass of the rod, kg. Default 0.21.
    pub rod_mass: f64,
    /// Mass of the slider, kg. Default 0.14.
    pub slider_mass: f64,
    /// Angle of the crank at the start, rad. Default 0.5: away from the dead points.
    pub angle: f64,
}

impl Default for SliderCrank {
    fn default() -> Self {
        // The example that the literature on clearance uses most (Flores and co-workers), its values
        // as usually quoted.
        SliderCrank {
            crank: 0.05,
            rod: 0.12,
            offset: 0.0,
            crank_mass: 0.3,
            rod_mass: 0.21,
            slider_mass: 0.14,
            angle: 0.5,
        }
    }
}

impl Template for SliderCrank {
    fn revolutes(&self) -> &'static [&'static str] {
        &["O", "A", "B"]
    }

    fn lengths(&self) -> Numbers {
        vec![("crank", self.crank), ("rod", self.rod)]
    }

    fn distances(&self) -> Numbers {
        vec![("crank", self.crank), ("rod", self.rod), ("offset", self.offset)]
    }

    fn masses(&self) -> Numbers {
        vec![
            ("crank_mass", self.crank_mass),
            ("rod_mass", self.rod_mass),
            ("slider_mass", self.slider_mass),
        ]
    }

    fn angles(&self) -> Numbers {
        vec![("angle", self.angle)]
    }

    fn has_crank(&self) -> bool {
        true
    }
}
