//! `[environment]`: what acts on every body.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The surroundings of the machine.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Environment {
    /// Gravity in the plane of motion, m/s². Default [0, 0]: a horizontal table (assumed; the
    /// paper does not say).
    pub gravity: [f64; 2],
}
