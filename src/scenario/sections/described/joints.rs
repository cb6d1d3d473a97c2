//! Joints of a mechanism that a file describes.

use crate::scenario::sections::{FilmKind, Law};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
