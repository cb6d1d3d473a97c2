//! The 3-RPR planar parallel manipulator: three legs (revolute, prismatic, revolute) carry a
//! triangular platform. Its geometry, for what knows of this machine; it is put together like any other.

mod kinematics;
mod reach;

pub use kinematics::Geometry;
pub use reach::{Reach, StrokeBreach, reach};
