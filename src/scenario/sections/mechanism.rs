//! `[mechanism]`: which machine, and its bodies.

use serde::{Deserialize, Serialize};

/// The machine, by its `kind`, the only key of a scenario without a default: a file that does not
/// say what it describes is more likely a mistake than a 3-RPR.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
}

impl Mechanism {
    pub(in crate::scenario) const KINDS: [&'static str; 3] = ["3rpr", "drive-stage", "pendulum"];
}

/// A load that slides along the x axis on the joint P1, horizontal unless gravity says otherwise. Its
/// length is the x of `[motion]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ThreeRpr {
    /// Side of the triangle of base anchors A1 A2 A3, m. Default 0.660: the paper.
    pub base_side: f64,
    /// Side of the triangle of platform corners C1 C2 C3, m. Default 0.100: the paper.
    pub platform_side: f64,
    /// Mass of the platform, kg. Default 0.2: the paper.
    pub platform_mass: f64,
    /// Inertia of the platform about its centre, kg m²; see [`ThreeRpr::platform_inertia`].
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
