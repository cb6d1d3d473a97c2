//! Drives of joints.

use crate::mechanism::{Cascade, JointIndex, ReadingError, Transmission};
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
///
/// ```
/// use freeplay::mechanism::{Actuator, Attachment, Body, BodyState, Command, Commands, Drive, Dynamics, Evaluation};
/// use freeplay::mechanism::{JointIndex, Mechanism, Prismatic};
/// use nalgebra::{UnitComplex, Vector2};
/// use std::sync::Arc;
///
/// /// A constant force of 4 N.
/// #[derive(Debug)]
/// struct Push;
///
/// impl Commands for Push {
///     fn at(&self, _t: f64, commands: &mut [Command]) {
///         commands.fill(Command { position: 4.0, ..Command::default() });
///     }
/// }
///
/// let mut mechanism = Mechanism::free(vec![Body::new("carriage", 2.0, 0.1, BodyState::ground())]);
/// let [base, slider] = [None, Some(0)].map(|body| Attachment { body, point: Vector2::zeros() });
/// let axes = [UnitComplex::identity(); 2];
/// mechanism.prismatics.push(Prismatic { name: "X".to_owned(), base, slider, axes, play: false });
/// mechanism.actuators.push(Actuator::new("X", JointIndex::Prismatic(0), Drive::Effort));
/// mechanism.commands = Arc::new(Push);
/// let states = [BodyState::ground()];
/// let (mut dynamics, mut now) = (Dynamics::new(&mechanism), Evaluation::new(&mechanism));
/// dynamics.forces(&mechanism, 0.0, &states, &mut now);
/// dynamics.accelerations(&mechanism, &states, &mut now);
/// assert!((now.drive_forces[0] - 4.0).abs() < 1e-12 && (now.accelerations[0].x - 2.0).abs() < 1e-12);
/// ```
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
