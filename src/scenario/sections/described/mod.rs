//! The sections of a file that describes its mechanism itself: `[ground]`, `[[body]]`, `[[joint]]`,
//! `[[drive]]`, `[[spring]]`, `[[stop]]`, `[[output]]`, `[[sensor]]`.

pub(super) mod drives;
pub(super) mod joints;

use super::{Joint, JointDrive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A point is named `body.point`; the ground's are `ground.point`.
pub const GROUND: &str = "ground";

/// A mechanism as a file describes it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Described {
    /// `[ground]`
    pub ground: Ground,
    /// `[[body]]`
    pub bodies: Vec<Body>,
    /// `[[joint]]`
    pub joints: Vec<Joint>,
    /// `[[drive]]`
    pub drives: Vec<JointDrive>,
    /// `[[spring]]`
    pub springs: Vec<Spring>,
    /// `[[stop]]`
    pub stops: Vec<Stop>,
    /// `[[output]]`
    pub outputs: Vec<Output>,
    /// `[[sensor]]`
    pub sensors: Vec<Sensor>,
}

/// What does not move.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Ground {
    /// Points by name, m. Default none.
    pub points: BTreeMap<String, [f64; 2]>,
}

/// A rigid body.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Body {
    /// Its name; no two are alike, and none is called `ground`.
    pub name: String,
    /// Mass, kg. Default none: that of `shape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Inertia about the centre of mass, kg m². Default none: that of `shape`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia: Option<f64>,
    /// Centre of mass in the body's own axes, m. Default that of `shape`, else [0, 0].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_of_mass: Option<[f64; 2]>,
    /// Points by name in the body's own axes, m.
    pub points: BTreeMap<String, [f64; 2]>,
    /// Origin (m) and angle (rad) of the body's axes at the start: a guess that is moved as little as it
    /// takes to close the joints. Default [0, 0, 0].
    pub start: [f64; 3],
    /// Velocity of that origin (m/s) and angular velocity (rad/s) at the start, as far as joints and drives
    /// leave it free. Default [0, 0, 0]: at rest.
    #[serde(skip_serializing_if = "is_zero")]
    pub velocity: [f64; 3],
    /// A shape with a density, in place of mass, inertia and centre of mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
}

fn is_zero(numbers: &[f64; 3]) -> bool {
    *numbers == [0.0; 3]
}

/// A homogeneous shape.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Shape {
    /// A solid round bar between two points of the body.
    Bar {
        /// Name of the point where it begins.
        from: String,
        /// Name of the point where it ends.
        to: String,
        /// Diameter, m.
        diameter: f64,
        /// Density, kg/m³.
        density: f64,
    },
    /// A round plate about a point of the body.
    Disc {
        /// Name of the point in its centre.
        center: String,
        /// Radius, m.
        radius: f64,
        /// Thickness, m.
        thickness: f64,
        /// Density, kg/m³.
        density: f64,
    },
    /// A flat plate whose corners are points of the body, in order around it.
    Polygon {
        /// Names of the corners.
        corners: Vec<String>,
        /// Thickness, m.
        thickness: f64,
        /// Density, kg/m³.
        density: f64,
    },
}

/// A spring with a damper: between two points, or in a revolute joint.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Spring {
    /// Its two points, `body.point`; or `joint` below.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub between: Option<[String; 2]>,
    /// The joint that it turns or moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<String>,
    /// N/m, in a revolute joint N m/rad. Default 0.
    pub stiffness: f64,
    /// N s/m, in a revolute joint N m s/rad. Default 0.
    pub damping: f64,
    /// Length without force, m. Default 0. Of `between`, and of a prismatic joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_length: Option<f64>,
    /// Angle without torque, rad. Default 0. Of a revolute joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_angle: Option<f64>,
    /// Whether it is a rope: no force while it is slack. Default false.
    pub pull_only: bool,
}

/// End stops of a joint: beyond either end of the range a spring and damper push back, never pull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Name of the joint.
    pub joint: String,
    /// Where the stops stand, m or rad.
    pub range: [f64; 2],
    /// N/m or N m/rad.
    pub stiffness: f64,
    /// N s/m or N m s/rad, reached at the depth below. Default 0.
    #[serde(default)]
    pub damping: f64,
    /// Depth at which the damping is full, m or rad. Default 1e-4: soft at the touch, so that the force
    /// does not jump.
    #[serde(default = "stop_depth")]
    pub depth: f64,
}

fn stop_depth() -> f64 {
    1e-4
}

/// A body or a point whose motion is written.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Output {
    /// The body whose axes are written; or a point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// `body.point`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// What its columns are called after `x`, `y`, `phi`, `vx` … Default `_BODY`, `_BODY.POINT`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

impl Output {
    /// The body or `body.point` that it is of.
    pub fn of(&self) -> &str {
        self.point.as_deref().or(self.body.as_deref()).unwrap_or_default()
    }

    /// What its columns are called after `x`, `y`, `phi`, ….
    pub fn label(&self) -> String {
        self.label.clone().unwrap_or_else(|| format!("_{}", self.of()))
    }
}

/// What a column of a log is a reading of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// The column.
    pub column: String,
    /// What is read.
    pub quantity: Quantity,
    /// Name of the joint, or `body.point`.
    pub of: String,
    /// Direction in world axes of an acceleration, rad. Default 0: along x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<f64>,
    /// What the column's numbers are multiplied by to be in the quantity's SI unit. Default 1.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub scale: f64,
    /// Standard deviation of the white noise, in the quantity's unit. Default 0: exact.
    #[serde(default)]
    pub std: f64,
    /// Rounding step, in the quantity's unit. Default 0: not rounded.
    #[serde(default)]
    pub resolution: f64,
    /// Corner of the zero-phase second-order low-pass, Hz. Default 0: not filtered.
    #[serde(default)]
    pub lowpass: f64,
}

fn one() -> f64 {
    1.0
}

fn is_one(scale: &f64) -> bool {
    *scale == 1.0
}

/// A quantity that a sensor reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Coordinate of a joint: angle or length.
    Position,
    /// Command of a drive.
    Command,
    /// Force or torque of a drive.
    Force,
    /// What a sampled controller asks of its drive at its samples, N or N·m.
    Output,
    /// What is added to the output of a sampled controller, V; recordings without it had nothing added.
    Added,
    /// World coordinate of a point.
    X,
    /// World coordinate of a point.
    Y,
    /// Angle of a point's body.
    Angle,
    /// Acceleration of a point along `axis`, without gravity.
    Acceleration,
}
