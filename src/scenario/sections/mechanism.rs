//! `[mechanism]`: which machine, and its bodies.

use super::{Circle, Described, Joint, JointLine, JointMotion, JointPath, Motion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The machine, by its `kind`, the only key of a scenario without a default: a file that does not
/// say what it describes is more likely a mistake than a 3-RPR.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind")]
pub enum Mechanism {
    /// `kind = "3rpr"`: the planar parallel manipulator with three legs, each R-P-R.
    #[serde(rename = "3rpr")]
    ThreeRpr(ThreeRpr),
    /// `kind = "drive-stage"`: one load on one driven prismatic joint.
    #[serde(rename = "drive-stage")]
    DriveStage(DriveStage),
    /// `kind = "pendulum"`: one arm on one revolute joint.
    #[serde(rename = "pendulum")]
    Pendulum(Pendulum),
    /// `kind = "slider-crank"`: crank, rod and slider.
    #[serde(rename = "slider-crank")]
    SliderCrank(SliderCrank),
    /// `kind = "four-bar"`: crank, coupler and rocker.
    #[serde(rename = "four-bar")]
    FourBar(FourBar),
    /// `kind = "five-bar"`: two cranks that carry a point by two rods.
    #[serde(rename = "five-bar")]
    FiveBar(FiveBar),
    /// `kind = "3rrr"`: the planar parallel manipulator with three driven cranks.
    #[serde(rename = "3rrr")]
    ThreeRrr(ThreeRrr),
    /// `kind = "double-pendulum"`: an arm on an arm.
    #[serde(rename = "double-pendulum")]
    DoublePendulum(DoublePendulum),
    /// No kind: the file describes its bodies and joints itself.
    #[serde(skip)]
    Described(Box<Described>),
}

impl Mechanism {
    /// All kinds.
    pub const KINDS: [&'static str; 8] = [
        "3rpr",
        "drive-stage",
        "pendulum",
        "slider-crank",
        "four-bar",
        "five-bar",
        "3rrr",
        "double-pendulum",
    ];

    /// Names of the revolute joints, in the order of lists that hold a value for each.
    pub fn revolute_names(&self) -> Vec<&str> {
        let names: &[&str] = match self {
            Mechanism::ThreeRpr(_) => &["A1", "A2", "A3", "C1", "C2", "C3"],
            Mechanism::DriveStage(_) => &[],
            Mechanism::Pendulum(_) => &["A1"],
            Mechanism::SliderCrank(_) => &["O", "A", "B"],
            Mechanism::FourBar(_) => &["O", "A", "B", "D"],
            Mechanism::FiveBar(_) => &["O1", "O2", "A1", "A2", "E"],
            Mechanism::ThreeRrr(_) => &["O1", "O2", "O3", "A1", "A2", "A3", "C1", "C2", "C3"],
            Mechanism::DoublePendulum(_) => &["O", "A"],
            Mechanism::Described(described) => {
                let revolute = |joint: &&Joint| matches!(joint, Joint::Revolute(_));
                return described.joints.iter().filter(revolute).map(Joint::name).collect();
            }
        };
        names.to_vec()
    }

    /// Whether the motion is that of a crank's angle, the coordinate of the joint O.
    pub(in crate::scenario) fn has_crank(&self) -> bool {
        matches!(self, Mechanism::SliderCrank(_) | Mechanism::FourBar(_))
    }

    /// The motion where none is asked for: of cranks a turn a second, of a five-bar's end a circle of 30 mm
    /// that begins at `end`.
    pub(in crate::scenario) fn default_motion(&self) -> Motion {
        match self {
            Mechanism::FiveBar(machine) => {
                let [x, y] = machine.end;
                let radius = 0.03;
                Motion::Circle(Circle {
                    radius,
                    center: [x - radius, y],
                    phi: 0.0,
                    ..Circle::default()
                })
            }
            _ if self.has_crank() => {
                let path = JointPath::Line(JointLine { start: None, velocity: TAU });
                Motion::Joints(vec![JointMotion { joint: "O".to_owned(), path }])
            }
            _ => Motion::default(),
        }
    }

    /// Whether the file describes its mechanism itself.
    pub fn described(&self) -> Option<&Described> {
        match self {
            Mechanism::Described(described) => Some(described),
            _ => None,
        }
    }

    /// Whether its recordings are read by `[[sensor]]`s: its file's own, or those that the template makes of
    /// `[columns]`.
    pub fn has_sensors(&self) -> bool {
        matches!(self, Mechanism::Described(_) | Mechanism::Pendulum(_) | Mechanism::DriveStage(_))
    }

    /// The sections beside those of every machine that this one has a use for.
    pub(crate) fn uses(&self, section: &str) -> bool {
        match section {
            "legs" => matches!(self, Mechanism::ThreeRpr(_)),
            "motion" | "drive" => {
                !matches!(self, Mechanism::Pendulum(_) | Mechanism::DoublePendulum(_))
            }
            "sensors" => matches!(self, Mechanism::ThreeRpr(_)),
            "columns" => matches!(
                self,
                Mechanism::DriveStage(_) | Mechanism::Pendulum(_) | Mechanism::Described(_)
            ),
            _ => true,
        }
    }
}

/// A load that slides along the x axis on the joint P1, horizontal unless gravity says otherwise. Its
/// length is the x of `[motion]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DriveStage {
    /// Moved mass, kg. Default 95.1089: that of the EMPS benchmark (Janot, Gautier, Brunot 2019),
    /// the drive's inertia included.
    pub mass: f64,
}

impl Default for DriveStage {
    fn default() -> Self {
        DriveStage { mass: 95.1089 }
    }
}

/// An arm that swings about the joint A1, released at the start. Nothing moves it but gravity;
/// `[motion]` and `[drive]` have no meaning. The defaults are the arm of Kaheman et al., *The
/// Experimental Multi-Arm Pendulum on a Cart*, 2022.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Pendulum {
    /// Mass, kg. Default 0.147584572.
    pub mass: f64,
    /// Inertia about the centre of mass, kg m². Default 1.09118505e-4.
    pub inertia: f64,
    /// Distance of the centre of mass from the pivot, m. Default 0.147754901.
    pub length: f64,
    /// Angle at the start against the upward vertical, rad; π hangs. Default 1.5: near the
    /// horizontal.
    pub angle: f64,
    /// Rate at the start, rad/s. Default 0: released.
    pub rate: f64,
}

impl Default for Pendulum {
    fn default() -> Self {
        Pendulum {
            mass: 0.147_584_572,
            inertia: 1.091_185_05e-4,
            length: 0.147_754_901,
            angle: 1.5,
            rate: 0.0,
        }
    }
}

/// Base and platform of the 3-RPR manipulator: two equilateral triangles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ThreeRpr {
    /// Side of the triangle of base anchors A1 A2 A3, m. Default 0.660: the paper.
    pub base_side: f64,
    /// Side of the triangle of platform corners C1 C2 C3, m. Default 0.100: the paper.
    pub platform_side: f64,
    /// Mass of the platform, kg. Default 0.2: the paper.
    pub platform_mass: f64,
    /// Inertia of the platform about its centre, kg m². Default m s²/12, of a triangular
    /// plate of mass m and side s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub platform_inertia: Option<f64>,
}

impl Default for ThreeRpr {
    fn default() -> Self {
        ThreeRpr {
            base_side: 0.660,
            platform_side: 0.100,
            platform_mass: 0.2,
            platform_inertia: None,
        }
    }
}

impl ThreeRpr {
    /// Inertia about the platform's centre, kg m²: as given, or m·side²/12, that of a thin uniform
    /// triangular plate (the paper gives none).
    pub fn platform_inertia(&self) -> f64 {
        self.platform_inertia.unwrap_or(self.platform_mass * self.platform_side.powi(2) / 12.0)
    }
}

/// A crank about O on the ground, a rod from its pin A to the pin B of a slider that moves along a line
/// through the ground's point S. Links are slender uniform bars of one mass per length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SliderCrank {
    /// Length of the crank, m. Default 0.05.
    pub crank: f64,
    /// Length of the rod, m. Default 0.12.
    pub rod: f64,
    /// Height of the slider's line above O, m. Default 0: a central slider-crank.
    pub offset: f64,
    /// Mass of the crank, kg. Default 0.3.
    pub crank_mass: f64,
    /// Mass of the rod, kg. Default 0.21.
    pub rod_mass: f64,
    /// Mass of the slider, kg. Default 0.14.
    pub slider_mass: f64,
    /// Angle of the crank at the start, rad. Default 0.5: away from the dead points.
    pub angle: f64,
}

impl Default for SliderCrank {
    fn default() -> Self {
        // The example that the literature on clearance uses most (Flores and co-workers), its values
        // as usually quoted.
        SliderCrank {
            crank: 0.05,
            rod: 0.12,
            offset: 0.0,
            crank_mass: 0.3,
            rod_mass: 0.21,
            slider_mass: 0.14,
            angle: 0.5,
        }
    }
}

/// A crank about O and a rocker about D on the ground, both joined by a coupler from A to B. Links are
/// slender uniform bars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FourBar {
    /// Distance of O and D, along x, m. Default 0.2.
    pub ground: f64,
    /// Length of the crank, m. Default 0.06: with the others a crank-rocker.
    pub crank: f64,
    /// Length of the coupler, m. Default 0.18.
    pub coupler: f64,
    /// Length of the rocker, m. Default 0.13.
    pub rocker: f64,
    /// Mass of a link for each metre, kg/m. Default 1.5: about a steel bar of 20 mm by 10 mm.
    pub linear_density: f64,
    /// Angle of the crank at the start, rad. Default 0.8.
    pub angle: f64,
    /// Whether coupler and rocker meet on the other side of the line from A to D. Default false.
    pub crossed: bool,
}

impl Default for FourBar {
    fn default() -> Self {
        FourBar {
            ground: 0.2,
            crank: 0.06,
            coupler: 0.18,
            rocker: 0.13,
            linear_density: 1.5,
            angle: 0.8,
            crossed: false,
        }
    }
}

/// Cranks about O1 and O2 on the ground and two rods that meet in E. Links are slender uniform bars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FiveBar {
    /// Distance of O1 and O2, along x about the origin, m. Default 0.1.
    pub ground: f64,
    /// Length of both cranks, m. Default 0.12.
    pub crank: f64,
    /// Length of both rods, m. Default 0.16.
    pub rod: f64,
    /// Mass of a link for each metre, kg/m. Default 1.2.
    pub linear_density: f64,
    /// Where E is at the start, m. Default [0, 0.2].
    pub end: [f64; 2],
}

impl Default for FiveBar {
    fn default() -> Self {
        FiveBar { ground: 0.1, crank: 0.12, rod: 0.16, linear_density: 1.2, end: [0.0, 0.2] }
    }
}

/// Three legs of a driven crank and a rod each carry a platform: cranks about O1 O2 O3, pins A1 A2 A3,
/// platform corners C1 C2 C3. Links are slender uniform bars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ThreeRrr {
    /// Side of the triangle of base anchors O1 O2 O3, m. Default 0.66.
    pub base_side: f64,
    /// Side of the triangle of platform corners, m. Default 0.1.
    pub platform_side: f64,
    /// Length of the cranks, m. Default 0.2.
    pub crank: f64,
    /// Length of the rods, m. Default 0.25.
    pub rod: f64,
    /// Mass of the platform, kg; its inertia is that of a thin uniform triangular plate. Default 0.2.
    pub platform_mass: f64,
    /// Mass of a link for each metre, kg/m. Default 0.7.
    pub linear_density: f64,
}

impl Default for ThreeRrr {
    fn default() -> Self {
        ThreeRrr {
            base_side: 0.66,
            platform_side: 0.1,
            crank: 0.2,
            rod: 0.25,
            platform_mass: 0.2,
            linear_density: 0.7,
        }
    }
}

/// An arm about O on the ground and a second one about A at its end, released at the start. Nothing
/// moves them but gravity. Arms are slender uniform bars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DoublePendulum {
    /// Lengths, m. Default [0.2, 0.16].
    pub lengths: [f64; 2],
    /// Masses, kg. Default [0.3, 0.2].
    pub masses: [f64; 2],
    /// Angles at the start against the x axis, rad. Default [-0.75, -0.45].
    pub angles: [f64; 2],
    /// Rates at the start, rad/s. Default [0, 0]: released.
    pub rates: [f64; 2],
}

impl Default for DoublePendulum {
    fn default() -> Self {
        DoublePendulum {
            lengths: [0.2, 0.16],
            masses: [0.3, 0.2],
            angles: [-0.75, -0.45],
            rates: [0.0, 0.0],
        }
    }
}
