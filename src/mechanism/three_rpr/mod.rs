//! The 3-RPR planar parallel manipulator: three legs (revolute, prismatic, revolute) carry a
//! triangular platform.

mod builder;
mod kinematics;
mod reach;

pub use builder::{JointSet, LegBars, build, ideal_states};
pub use kinematics::{Geometry, InverseKinematics};
pub use reach::{Reach, StrokeBreach, reach};

/// Names of the six revolute joints: A at the base, C at the platform.
pub const JOINTS: [&str; 6] = ["A1", "A2", "A3", "C1", "C2", "C3"];
