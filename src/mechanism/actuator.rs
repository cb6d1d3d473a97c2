//! Drives of joints and what they are told.

use super::{Cascade, JointIndex, ReadingError, Transmission};
use std::fmt::Debug;
use std::sync::Arc;

/// How a joint is driven. Of a prismatic joint coordinates are lengths in m and efforts forces in N, of
/// a revolute one angles in rad and torques in N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// The coordinate follows the command exactly; the drive's effort is the reaction.
    Prescribed,
    /// `F = k_p (q_cmd − q) + k_d (q̇_cmd − q̇)`.
    Servo {
        /// Stiffness k_p in N/m or N·m/rad.
        stiffness: f64,
        /// Damping k_d in N·s/m or N·m·s/rad.
        damping: f64,
    },
    /// A controller that is computed at instants and held in between.
    Sampled(Cascade),
    /// The command is the effort itself.
    Effort,
}

/// A drive on a joint.
#[derive(Clone, Debug)]
pub struct Actuator {
    /// Name of the joint.
    pub name: String,
    /// The joint.
    pub joint: JointIndex,
    /// What the drive does; the command with the same index is what it follows.
    pub drive: Drive,
    /// How the joint's true coordinate differs from what encoder and drive read, in sum.
    pub reading_errors: Vec<Arc<dyn ReadingError>>,
    /// What gives between drive and joint, if anything does; a [`Drive::Servo`] alone feels it.
    pub transmission: Option<Transmission>,
}

impl Actuator {
    /// A drive that reads right and is rigidly connected.
    pub fn new(name: &str, joint: JointIndex, drive: Drive) -> Self {
        let reading_errors = Vec::new();
        Self { name: name.to_owned(), joint, drive, reading_errors, transmission: None }
    }
}

/// Command of one drive at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Coordinate q in m or rad; of a [`Drive::Effort`] the effort in N or N·m.
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
