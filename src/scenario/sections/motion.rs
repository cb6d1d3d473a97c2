//! `[motion]`: the commanded path of the platform.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

use serde::{Deserialize, Serialize};

/// The angle of the default motions, rad: far from φ = 0 and φ = π, where base and platform
/// triangle are parallel and the 3-RPR is singular at every position.
const SAFE_PHI: f64 = FRAC_PI_6;

/// The commanded motion, by its `kind` (default `circle`, the assumed reading of the paper's
/// "trajectory with a constant velocity"). The defaults of each kind stay within the default
/// machine's stroke, near the origin, and away from its singularities.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
    /// `kind = "table"`: a path from a CSV file.
    Table(Table),
}

impl Motion {
    pub(in crate::scenario) const KINDS: [&'static str; 5] =
        ["circle", "line", "quintic", "multisine", "table"];
}

impl Default for Motion {
    fn default() -> Self {
        Motion::Circle(Circle::default())
    }
}

/// (x, y) = center + radius · [cos, sin](2π t/period + phase), φ constant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Table {
    /// The CSV file as written in the scenario; [`Scenario::resolve`](crate::scenario::Scenario::resolve)
    /// gives its place. No default: an empty name is refused.
    pub file: String,
}
