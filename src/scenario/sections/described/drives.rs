//! Drives of a mechanism that a file describes.

use crate::scenario::sections::{Sampled, Term1};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A drive on a joint.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum JointDrive {
    /// `kind = "prescribed"`: the coordinate follows the motion exactly.
    Prescribed(On),
    /// `kind = "servo"`: a spring and damper between command and coordinate.
    Servo(Servo),
    /// `kind = "sampled"`: a controller that is computed at instants.
    Sampled(SampledDrive),
    /// `kind = "force"`: a force or torque over time.
    Force(Force),
}

impl JointDrive {
    pub(in crate::scenario) const KINDS: [&'static str; 4] =
        ["prescribed", "servo", "sampled", "force"];

    /// Name of its joint.
    pub fn joint(&self) -> &str {
        match self {
            JointDrive::Prescribed(drive) => &drive.joint,
            JointDrive::Servo(drive) => &drive.joint,
            JointDrive::Sampled(drive) => &drive.joint,
            JointDrive::Force(drive) => &drive.joint,
        }
    }

    /// What its columns are called after `q` and `F`: as given, or `_JOINT`.
    pub fn label(&self) -> String {
        let label = match self {
            JointDrive::Prescribed(drive) => &drive.label,
            JointDrive::Servo(drive) => &drive.label,
            JointDrive::Sampled(drive) => &drive.label,
            JointDrive::Force(drive) => &drive.label,
        };
        label.clone().unwrap_or_else(|| format!("_{}", self.joint()))
    }
}

/// A drive without numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct On {
    /// Name of the driven joint.
    pub joint: String,
    /// What its columns are called after `q` and `F`. Default `_JOINT`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

/// F = stiffness (q_cmd − q) + damping (q̇_cmd − q̇).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// Name of the driven joint.
    pub joint: String,
    /// N/m or N m/rad.
    pub stiffness: f64,
    /// N s/m or N m s/rad.
    pub damping: f64,
    /// As of [`On`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

/// The sampled cascade of [`Sampled`] on a joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SampledDrive {
    /// Name of the driven joint.
    pub joint: String,
    /// The controller.
    #[serde(default)]
    pub controller: Sampled,
    /// As of [`On`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

/// A force (N) or torque (N m) over time: a constant, sines, and a column of a table, added up.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Force {
    /// Name of the driven joint.
    pub joint: String,
    /// Constant part, N or N m. Default 0.
    pub value: f64,
    /// Sines, N or N m. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub terms: Vec<Term1>,
    /// CSV file with a column `t` and the one below. Default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Its column. Default `F_JOINT`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// As of [`On`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}
