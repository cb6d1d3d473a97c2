//! `[drive]`: the prismatic actuators.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the actuators follow the commanded lengths.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// `[drive.sampled]`: the controller of `mode = "sampled"`. Default: that of the EMPS benchmark.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampled: Option<Sampled>,
}

impl Drive {
    /// The sampled controller: as given, or that of the EMPS.
    pub fn sampled(&self) -> Sampled {
        self.sampled.clone().unwrap_or_default()
    }
}

/// A sampled cascade of a position and a velocity loop; its equations stand at
/// [`Cascade`](crate::mechanism::Cascade). The defaults are the drive of the EMPS benchmark (Janot,
/// Gautier, Brunot 2019).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Sampled {
    /// Gain K_P of the position loop, 1/s. Default 160.18.
    pub position_gain: f64,
    /// Gain K_V of the velocity loop, V/(m/s). Default 243.45.
    pub velocity_gain: f64,
    /// Time between two samples, s. Default 1e-3.
    pub interval: f64,
    /// Largest output either way, V. Default 10.
    pub limit: f64,
    /// Force for each volt, N/V. Default 35.15065188248547.
    pub force_gain: f64,
    /// Lag of the force behind the output, s. Default 0: nothing is declared of it.
    pub lag: f64,
}

impl Default for Sampled {
    fn default() -> Self {
        Sampled {
            position_gain: 160.18,
            velocity_gain: 243.45,
            interval: 1e-3,
            limit: 10.0,
            force_gain: 35.150_651_882_485_47,
            lag: 0.0,
        }
    }
}

impl Default for Drive {
    fn default() -> Self {
        Drive { mode: DriveMode::Prescribed, stiffness: 5e5, damping: 300.0, sampled: None }
    }
}

/// A kind of drive by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DriveMode {
    /// The length follows the command exactly; the force is the reaction.
    Prescribed,
    /// F = k_p (q_cmd − q) + k_d (q̇_cmd − q̇).
    Servo,
    /// A controller that is computed at instants and held in between.
    Sampled,
}
