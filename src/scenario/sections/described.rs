//! The sections of a file that describes its mechanism itself: `[ground]`, `[[body]]`, `[[joint]]`,
//! `[[drive]]`, `[[spring]]`, `[[stop]]`, `[[output]]`, `[[sensor]]`.

use super::{FilmKind, Law, Sampled, Term1};
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

/// A joint between two bodies, or a body and the ground.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Joint {
    /// `kind = "revolute"`: a journal in a bearing ring.
    Revolute(Revolute),
    /// `kind = "prismatic"`: a slider on an axis.
    Prismatic(Prismatic),
    /// `kind = "fixed"`: two bodies that move as one.
    Fixed(Fixed),
}

impl Joint {
    pub(in crate::scenario) const KINDS: [&'static str; 3] = ["revolute", "prismatic", "fixed"];

    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Joint::Revolute(joint) => &joint.name,
            Joint::Prismatic(joint) => &joint.name,
            Joint::Fixed(joint) => &joint.name,
        }
    }

    /// The keys of its two points and what they say, the carrying one first.
    pub fn points(&self) -> [(&'static str, &str); 2] {
        match self {
            Joint::Revolute(joint) => [("ring", &joint.ring), ("journal", &joint.journal)],
            Joint::Prismatic(joint) => [("base", &joint.base), ("slider", &joint.slider)],
            Joint::Fixed(joint) => [("base", &joint.base), ("part", &joint.part)],
        }
    }
}

/// A revolute joint. Its coordinate is the angle of the journal's body less that of the ring's.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Revolute {
    /// Its name.
    pub name: String,
    /// Centre of the bearing ring, `body.point`.
    pub ring: String,
    /// Centre of the journal, `body.point`.
    pub journal: String,
    /// Radial clearance, m. Default that of `[joints]`; ideal where neither gives one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// Inner radius of the ring, m. Default that of `[joints]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bearing_radius: Option<f64>,
    /// Coulomb friction coefficient. Default that of `[joints]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Contact law. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<Law>,
    /// Stiffness K, N/m^1.5. Default that of `[contact]`, or from E, ν and the radii.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Coefficient of restitution. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Damping in the law's unit. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<f64>,
    /// Damping at full depth, N s/m. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub c_max: Option<f64>,
    /// Penetration at which the damping is full, m. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub d_max: Option<f64>,
    /// Oil between journal and ring. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub film: Option<FilmKind>,
    /// Wear coefficient of the ring, 1/Pa. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wear_coefficient: Option<f64>,
    /// What the ring is wider by than its clearance, m, in directions at equal angles round it from the x axis of its
    /// body on; a periodic cubic spline between them. Default none: a circle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<Vec<f64>>,
}

/// A prismatic joint. Its coordinate is the distance along the axis from base to slider.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Prismatic {
    /// Its name.
    pub name: String,
    /// Point on the axis, `body.point`.
    pub base: String,
    /// Direction of the axis in the base's axes, rad. Default 0.
    pub axis: f64,
    /// Angle that the slider's axes keep against the base's, rad. Default `axis`: the slider's x axis lies
    /// along it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Point of the slider that moves along the axis, `body.point`.
    pub slider: String,
    /// Shortest and longest length, m, that the motion may ask for. Default none: nothing is checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Gap, m, between the slider and each of two guides along the axis, where both are centred. Default none: the joint
    /// is ideal. With it the slider is a block of `length` and `height` about its point, and its corners hit the guides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// Length of the slider along the axis, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Its height across the axis, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Radius, m, with which its corners are rounded: what the stiffness is of. Default 1e-3: a broken edge.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corner_radius: Option<f64>,
    /// Coulomb friction coefficient at the guides. Default 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Contact law at the guides. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<Law>,
    /// Stiffness K of a corner, N/m^1.5. Default that of `[contact]`, or from E, ν and the corner's radius.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Coefficient of restitution. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Damping in the law's unit. Default that of `[contact]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<f64>,
}

impl Prismatic {
    /// The clearance in m, of a joint that has one.
    pub fn play(&self) -> Option<f64> {
        self.clearance.filter(|clearance| *clearance > 0.0)
    }
}

/// Two bodies that move as one: a point of each at the same place.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Fixed {
    /// Its name.
    pub name: String,
    /// Point of the first body, `body.point`.
    pub base: String,
    /// Point of the second, `body.point`.
    pub part: String,
    /// Angle of the second body's axes against the first's, rad. Default 0.
    pub angle: f64,
}

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
