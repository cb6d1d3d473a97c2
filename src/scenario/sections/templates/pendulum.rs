//! `kind = "pendulum"`: one arm on one revolute joint.

use super::{Inertia, Numbers, Template};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An arm that swings about the joint A1, released at the start. Nothing moves it but gravity;
/// `[motion]` and `[drive]` have no meaning. The defaults are the arm of Kaheman et al., *The
/// Experimental Multi-Arm Pendulum on a Cart*, 2022.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Pendulum {
    /// Mass, kg. Default 0.147584572.
    pub mass: f64,
    /// Inertia about the centre of mass, kg m². Default 1.09118505e-4.
    pub inertia: f64,
    /// Distance of the centre of mass from the pivot, m. Default 0.147754901.
    pub length: f64,
    /// Angle at the start against the upward vertical, rad; π hangs. Default 1.5: near the
    /// horizontal.
    pub angle: f64,
    /// Rate at the start, rad/s. Default 0: released.
    pub rate: f64,
}

impl Default for Pendulum {
    fn default() -> Self {
        Pendulum {
            mass: 0.147_584_572,
            inertia: 1.091_185_05e-4,
            length: 0.147_754_901,
            angle: 1.5,
            rate: 0.0,
        }
    }
}

impl Template for Pendulum {
    fn revolutes(&self) -> &'static [&'static str] {
        &["A1"]
    }

    fn lengths(&self) -> Numbers {
        vec![("length", self.length)]
    }

    fn masses(&self) -> Numbers {
        vec![("mass", self.mass)]
    }

    fn inertia(&self) -> Option<Inertia> {
        Some(("inertia", self.inertia, "kg m²"))
    }

    fn angles(&self) -> Numbers {
        vec![("angle", self.angle)]
    }

    fn sections(&self) -> &'static [&'static str] {
        &["columns"]
    }
}
