//! What a platform is asked to do: pose, velocity and acceleration as exact functions of time.

mod kinds;
mod table;

pub use kinds::{Circle, Line, MultiSine, Quintic, SineTerm, rest_to_rest, sine};
pub use table::{Table, TableError, read_columns};

use nalgebra::Vector3;
use std::fmt::Debug;

/// One point of a motion; each vector is (x, y, φ) or a time derivative of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathPoint {
    /// (m, m, rad).
    pub pose: Vector3<f64>,
    /// (m/s, m/s, rad/s).
    pub rate: Vector3<f64>,
    /// (m/s², m/s², rad/s²).
    pub acceleration: Vector3<f64>,
}

/// A motion of the platform. Derivatives are those of the pose, exactly: the drives follow them.
pub trait Motion: Debug + Send + Sync {
    /// The motion at time `t` in s.
    fn at(&self, t: f64) -> PathPoint;

    /// Time in s up to which somebody has said what to do; endless where a formula does.
    fn known_until(&self) -> f64 {
        f64::INFINITY
    }
}
