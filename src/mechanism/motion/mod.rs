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
///
/// ```
/// use freeplay::mechanism::motion::{Circle, Motion, Quintic};
/// use nalgebra::{Vector2, Vector3};
///
/// let circle = Circle { center: Vector2::zeros(), radius: 0.05, period: 2.0, phase: 0.0, phi: 0.0 };
/// assert!((circle.at(0.5).pose - Vector3::new(0.0, 0.05, 0.0)).norm() < 1e-12, "a quarter turn");
/// let across = Quintic { from: Vector3::zeros(), to: Vector3::new(0.1, 0.0, 0.0), time: 1.0 };
/// assert_eq!(across.at(1.0).pose.x, 0.1);
/// assert_eq!(across.at(1.0).rate.x, 0.0, "from rest to rest");
/// ```
pub trait Motion: Debug + Send + Sync {
    /// The motion at time `t` in s.
    fn at(&self, t: f64) -> PathPoint;

    /// The orientation φ in rad that it keeps at all times, if it does.
    fn kept_angle(&self) -> Option<f64> {
        None
    }

    /// Time in s after which the motion shows nothing new, because it begins again or rests; endless where it
    /// always does.
    fn shown_after(&self) -> f64 {
        f64::INFINITY
    }

    /// Time in s of the fastest turn that the motion takes, such as the period of its fastest wave; endless where
    /// it goes straight.
    fn fastest_turn(&self) -> f64 {
        f64::INFINITY
    }

    /// Time in s up to which somebody has said what to do; endless where a formula does.
    fn known_until(&self) -> f64 {
        f64::INFINITY
    }
}

/// Looks at a motion within its fastest turn: extremes of a wave are seen to `(π/500)²/2`, 2e-5 of its amplitude.
const LOOKS_A_TURN: f64 = 500.0;

/// Most looks at a motion: a second of computing. (A day of waves of 1 Hz would take forty times as many.)
const MOST_LOOKS: f64 = 1e6;

/// Instants in s, at least `fewest` intervals of equal length, at which a motion of `duration` s shows what it comes
/// to: until it shows nothing new, and finely against its fastest turn, however long it lasts.
pub fn looks(motion: &dyn Motion, duration: f64, fewest: usize) -> impl Iterator<Item = f64> {
    let span = duration.min(motion.shown_after());
    let needed = (LOOKS_A_TURN * span / motion.fastest_turn()).ceil().min(MOST_LOOKS);
    let count = (needed as usize).max(fewest);
    (0..=count).map(move |k| span * k as f64 / count as f64)
}
