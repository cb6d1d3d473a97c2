//! What drives are told.

use std::fmt::Debug;

/// Command of one drive at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Coordinate q in m or rad; of a [`Drive::Effort`](crate::mechanism::Drive::Effort) the effort in N or N·m.
    pub position: f64,
    /// q̇ in m/s or rad/s.
    pub rate: f64,
    /// q̈ in m/s² or rad/s².
    pub acceleration: f64,
}

/// Commands of all drives of a mechanism as functions of time.
pub trait Commands: Debug + Send + Sync {
    /// Writes the command of each drive at time `t` (s).
    fn at(&self, t: f64, commands: &mut [Command]);

    /// What is added at time `t` (s) to the output of the sampled controller of drive `index`, in V.
    fn added(&self, _index: usize, _t: f64) -> f64 {
        0.0
    }
}

/// Commands of a mechanism without drives.
#[derive(Debug)]
pub struct Idle;

impl Commands for Idle {
    fn at(&self, _: f64, _: &mut [Command]) {}
}
