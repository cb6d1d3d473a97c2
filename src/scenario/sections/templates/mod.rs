//! The kinds of `[mechanism]`: machines by a few numbers, each in its file with its keys and what is known of it before it is
//! put together. What bodies and joints a kind stands for is said in `model/templates/`.

mod double_pendulum;
mod drive_stage;
mod five_bar;
mod four_bar;
mod pendulum;
mod slider_crank;
mod three_rpr;
mod three_rrr;

pub use double_pendulum::DoublePendulum;
pub use drive_stage::DriveStage;
pub use five_bar::FiveBar;
pub use four_bar::FourBar;
pub use pendulum::Pendulum;
pub use slider_crank::SliderCrank;
pub use three_rpr::ThreeRpr;
pub use three_rrr::ThreeRrr;

use super::{JointLine, JointMotion, JointPath, Motion};
use std::f64::consts::TAU;

/// Keys under `[mechanism]` and their values.
pub type Numbers = Vec<(&'static str, f64)>;

/// A key under `[mechanism]` that inertias are made of, its value and its unit.
pub type Inertia = (&'static str, f64, &'static str);

/// Inertia in kg m² of a thin uniform triangular plate of this mass (kg) and side (m) about its centre: m s²/12.
fn triangle_inertia(mass: f64, side: f64) -> f64 {
    mass * side.powi(2) / 12.0
}

/// What is known of a kind of machine without putting it together.
pub trait Template {
    /// Names of the revolute joints, in the order of lists that hold a value for each.
    fn revolutes(&self) -> &'static [&'static str];

    /// Lengths in m, which have to be above 0.
    fn lengths(&self) -> Numbers {
        Vec::new()
    }

    /// All that is given in m, whose size is that of a machine.
    fn distances(&self) -> Numbers {
        self.lengths()
    }

    /// Masses in kg, which have to be above 0.
    fn masses(&self) -> Numbers {
        Vec::new()
    }

    /// An inertia, or what inertias are made of, if a file gives one; it has to be above 0.
    fn inertia(&self) -> Option<Inertia> {
        None
    }

    /// An inertia that follows from others where a file gives none, by the key that it follows from most: it has to be a number
    /// above 0 as well.
    fn derived_inertia(&self) -> Option<Inertia> {
        None
    }

    /// Angles in rad at which bodies start.
    fn angles(&self) -> Numbers {
        Vec::new()
    }

    /// The sections beside those of every machine that it has a use for; with `columns` the template makes `[[sensor]]`s of
    /// these.
    fn sections(&self) -> &'static [&'static str] {
        &["motion", "drive"]
    }

    /// Whether the motion is that of a crank's angle, the coordinate of the joint O.
    fn has_crank(&self) -> bool {
        false
    }

    /// The motion where none is asked for: of cranks a turn a second.
    fn default_motion(&self) -> Motion {
        if !self.has_crank() {
            return Motion::default();
        }
        let path = JointPath::Line(JointLine { start: None, velocity: TAU });
        Motion::Joints(vec![JointMotion { joint: "O".to_owned(), path }])
    }
}
