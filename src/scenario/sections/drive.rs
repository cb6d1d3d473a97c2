//! `[drive]`: the prismatic actuators.

use serde::{Deserialize, Serialize};

/// How the actuators follow the commanded lengths.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Drive {
    /// Kind of drive. Default `prescribed`: what the paper's ADAMS motions do.
    pub mode: DriveMode,
    /// Position gain k_p of the servo, N/m. Default 5e5: assumed; 10 N of load move it by 20 µm,
    /// far less than the default clearance. Unused by `prescribed`.
    pub stiffness: f64,
    /// Velocity gain k_d of the servo, N s/m. Default 300: assumed, with `stiffness`. Unused by
    /// `prescribed`.
    pub damping: f64,
}

impl Default for Drive {
    fn default() -> Self {
        Drive { mode: DriveMode::Prescribed, stiffness: 5e5, damping: 300.0 }
    }
}

/// A kind of drive by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DriveMode {
    /// The length follows the command exactly; the force is the reaction.
    Prescribed,
    /// F = k_p (q_cmd − q) + k_d (q̇_cmd − q̇).
    Servo,
}
