//! `[motion]`: the commanded path of the platform, of another body, of a point, or of joints.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The angle of the default motions, rad: far from φ = 0 and φ = π, where base and platform
/// triangle are parallel and the 3-RPR is singular at every position.
const SAFE_PHI: f64 = FRAC_PI_6;

/// The commanded motion, by its `kind` (default `circle`, the assumed reading of the paper's
/// "trajectory with a constant velocity"). The defaults of each kind stay within the default
/// machine's stroke, near the origin, and away from its singularities.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Motion {
    /// `kind = "circle"`: a circle at constant speed.
    Circle(Circle),
    /// `kind = "line"`: a straight line at constant velocity.
    Line(Line),
    /// `kind = "quintic"`: from pose to pose, at rest at both ends.
    Quintic(Quintic),
    /// `kind = "multisine"`: a sum of sines about a pose.
    Multisine(Multisine),
    /// `kind = "table"`: a path from a CSV file; in a described machine without `body` or `point` the
    /// coordinates of its driven joints.
    Table(Table),
    /// `[[motion]]`: joint by joint, in a described machine.
    #[serde(skip)]
    Joints(Vec<JointMotion>),
    /// No motion: drives hold the coordinates of the start.
    #[serde(skip)]
    Rest,
}

impl Motion {
    pub(in crate::scenario) const KINDS: [&'static str; 5] =
        ["circle", "line", "quintic", "multisine", "table"];
}

/// What a described machine's `[motion]` moves, where it moves no joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum MotionTarget {
    /// `body = "…"`: a body's axes, x, y and φ.
    Body(String),
    /// `point = "body.point"`: x and y.
    Point(String),
}

/// The motion of one joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointMotion {
    /// Name of the joint.
    pub joint: String,
    /// Its coordinate over time.
    #[serde(flatten)]
    pub path: JointPath,
}

/// A coordinate over time, m or rad.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum JointPath {
    /// q = start + velocity · t.
    Line(JointLine),
    /// From rest to rest, as [`Quintic`].
    Quintic(JointQuintic),
    /// q = center + Σ amplitude · sin(2π frequency t + phase).
    Multisine(JointMultisine),
    /// A column of a CSV file.
    Table(JointTable),
}

impl JointPath {
    pub(in crate::scenario) const KINDS: [&'static str; 4] =
        ["line", "quintic", "multisine", "table"];
}

/// A coordinate at constant rate.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct JointLine {
    /// Coordinate at t = 0, m or rad. Default none: that of the bodies' `start`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<f64>,
    /// m/s or rad/s. Default 0: it holds.
    pub velocity: f64,
}

/// A coordinate from rest to rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointQuintic {
    /// First coordinate, m or rad. Default none: that of the bodies' `start`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Last coordinate, m or rad.
    pub to: f64,
    /// Time from first to last, s.
    pub time: f64,
}

/// Sines about a middle.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct JointMultisine {
    /// Middle, m or rad. Default none: that of the bodies' `start`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center: Option<f64>,
    /// The sines.
    pub terms: Vec<Term1>,
}

/// A column of a table over its column `t`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct JointTable {
    /// The CSV file.
    pub file: String,
    /// The column. Default `q_JOINT`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
}

/// One sine of a coordinate or of a force.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Term1 {
    /// Amplitude, in the unit of what it is part of.
    pub amplitude: f64,
    /// Frequency, Hz.
    pub frequency: f64,
    /// Phase at t = 0, rad. Default 0.
    #[serde(default)]
    pub phase: f64,
}

impl Default for Motion {
    fn default() -> Self {
        Motion::Circle(Circle::default())
    }
}

/// (x, y) = center + radius · [cos, sin](2π t/period + phase), φ constant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Circle {
    /// Radius, m. Default 0.050: assumed; uses about half of the stroke.
    pub radius: f64,
    /// Time of one turn, s. Default 1: assumed.
    pub period: f64,
    /// Angle of the platform, rad. Default π/6: assumed, away from the singularity at 0.
    pub phi: f64,
    /// Where on the circle the motion starts, rad from the x axis. Default 0.
    pub phase: f64,
    /// Centre of the circle, m. Default [0, 0]: the centroid of the base.
    pub center: [f64; 2],
}

impl Default for Circle {
    fn default() -> Self {
        Circle { radius: 0.050, period: 1.0, phi: SAFE_PHI, phase: 0.0, center: [0.0, 0.0] }
    }
}

/// (x, y) = start + velocity · t, φ constant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Line {
    /// Position at t = 0, m. Default [-0.05, 0]: with the default velocity the line passes the
    /// origin in the middle of the default duration.
    pub start: [f64; 2],
    /// Velocity, m/s. Default [0.1, 0]: 0.1 m in the default duration of 1 s.
    pub velocity: [f64; 2],
    /// Angle of the platform, rad. Default π/6: as for the circle.
    pub phi: f64,
}

impl Default for Line {
    fn default() -> Self {
        Line { start: [-0.05, 0.0], velocity: [0.1, 0.0], phi: SAFE_PHI }
    }
}

/// pose = from + (to − from) · (10τ³ − 15τ⁴ + 6τ⁵), τ = t/time; holds before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Quintic {
    /// First pose [x, y, φ], m and rad. Default [-0.05, 0, π/6]: as the default line.
    pub from: [f64; 3],
    /// Last pose [x, y, φ], m and rad. Default [0.05, 0, π/6]: as the default line.
    pub to: [f64; 3],
    /// Time from first to last pose, s. Default 1: the default duration.
    pub time: f64,
}

impl Default for Quintic {
    fn default() -> Self {
        Quintic { from: [-0.05, 0.0, SAFE_PHI], to: [0.05, 0.0, SAFE_PHI], time: 1.0 }
    }
}

/// pose = center + Σ amplitude · sin(2π frequency t + phase).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Multisine {
    /// Middle pose [x, y, φ], m and rad. Default [0, 0, π/6]: as the default circle.
    pub center: [f64; 3],
    /// The sines. Default three, one in x, one in y a quarter turn ahead, one in φ: every
    /// actuator moves, and no two directions move alike.
    pub terms: Vec<Term>,
}

impl Default for Multisine {
    fn default() -> Self {
        let term = |amplitude, frequency, phase| Term { amplitude, frequency, phase };
        Multisine {
            center: [0.0, 0.0, SAFE_PHI],
            terms: vec![
                term([0.03, 0.0, 0.0], 1.0, 0.0),
                term([0.0, 0.03, 0.0], 1.5, FRAC_PI_2),
                term([0.0, 0.0, 0.1], 0.7, 0.0),
            ],
        }
    }
}

/// One sine of a [`Multisine`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Term {
    /// Amplitude [x, y, φ], m and rad. Default [0, 0, 0]: only what is named moves.
    pub amplitude: [f64; 3],
    /// Frequency, Hz. Default 1: that of the default circle.
    pub frequency: f64,
    /// Phase at t = 0, rad. Default 0.
    pub phase: f64,
}

impl Default for Term {
    fn default() -> Self {
        Term { amplitude: [0.0; 3], frequency: 1.0, phase: 0.0 }
    }
}

/// A path from a CSV file with the columns `t,x,y,phi`, s, m and rad.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Table {
    /// The CSV file as written in the scenario; [`Scenario::resolve`](crate::scenario::Scenario::resolve)
    /// gives its place. No default: an empty name is refused.
    pub file: String,
}
