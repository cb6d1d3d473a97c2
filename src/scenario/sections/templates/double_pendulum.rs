//! `kind = "double-pendulum"`: an arm on an arm.

use super::{Numbers, Template};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An arm about O on the ground and a second one about A at its end, released at the start. Nothing
/// moves them but gravity. Arms are slender uniform bars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DoublePendulum {
    /// Lengths, m. Default [0.2, 0.16].
    pub lengths: [f64; 2],
    /// Masses, kg. Default [0.3, 0.2].
    pub masses: [f64; 2],
    /// Angles at the start against the x axis, rad. Default [-0.75, -0.45].
    pub angles: [f64; 2],
    /// Rates at the start, rad/s. Default [0, 0]: released.
    pub rates: [f64; 2],
}

impl Default for DoublePendulum {
    fn default() -> Self {
        DoublePendulum {
            lengths: [0.2, 0.16],
            masses: [0.3, 0.2],
            angles: [-0.75, -0.45],
            rates: [0.0, 0.0],
        }
    }
}

impl Template for DoublePendulum {
    fn revolutes(&self) -> &'static [&'static str] {
        &["O", "A"]
    }

    fn lengths(&self) -> Numbers {
        vec![("lengths.0", self.lengths[0]), ("lengths.1", self.lengths[1])]
    }

    fn masses(&self) -> Numbers {
        vec![("masses.0", self.masses[0]), ("masses.1", self.masses[1])]
    }

    fn angles(&self) -> Numbers {
        vec![("angles.0", self.angles[0]), ("angles.1", self.angles[1])]
    }

    fn sections(&self) -> &'static [&'static str] {
        &[]
    }
}
