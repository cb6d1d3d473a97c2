//! What drives are told.

use std::fmt::Debug;

/// Command of one drive at one time.
///
/// [`Commands`] has an example.
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
///
/// ```
/// use freeplay::mechanism::{Command, Commands};
///
/// /// Every drive moves at 0.1 m/s.
/// #[derive(Debug)]
/// struct Ramp;
///
/// impl Commands for Ramp {
///     fn at(&self, t: f64, commands: &mut [Command]) {
///         commands.fill(Command { position: 0.1 * t, rate: 0.1, acceleration: 0.0 });
///     }
/// }
///
/// let mut commands = [Command::default(); 3];
/// Ramp.at(2.0, &mut commands);
/// assert_eq!(commands[2].position, 0.2);
/// ```
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
