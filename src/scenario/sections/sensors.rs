//! `[sensors]`: the instruments that made a rig's log.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Errors of the instruments. The section is absent where nothing is measured. Each default is 0,
/// an instrument without that error: an uncertainty nobody declared is not invented.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Sensors {
    /// Standard deviation of the tracked position in x and in y, m, white. Default 0: exact.
    pub pose_std: f64,
    /// Standard deviation of the tracked angle, rad, white. Default 0: exact.
    pub angle_std: f64,
    /// Step of the length encoders, m. Default 0: not rounded.
    pub length_resolution: f64,
    /// Standard deviation of the actuator forces, N, white, added after the low-pass. Default 0:
    /// exact.
    pub force_std: f64,
    /// Corner of the zero-phase low-pass of the force channels, Hz. Default 0: not filtered.
    pub force_lowpass: f64,
}
