//! `kind = "drive-stage"`: one load on one driven prismatic joint.

use super::{Numbers, Template};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A load that slides along the x axis on the joint P1, horizontal unless gravity says otherwise. Its
/// length is the x of `[motion]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DriveStage {
    /// Moved mass, kg. Default 95.1089: that of the EMPS benchmark (Janot, Gautier, Brunot 2019),
    /// the drive's inertia included.
    pub mass: f64,
}

impl Default for DriveStage {
    fn default() -> Self {
        DriveStage { mass: 95.1089 }
    }
}

impl Template for DriveStage {
    fn revolutes(&self) -> &'static [&'static str] {
        &[]
    }

    fn masses(&self) -> Numbers {
        vec![("mass", self.mass)]
    }

    fn sections(&self) -> &'static [&'static str] {
        &["motion", "drive", "columns"]
    }
}
