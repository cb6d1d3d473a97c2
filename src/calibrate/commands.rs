//! The commands of a log, as functions of time.

use crate::measure::log::{Channel, Log};
use crate::measure::spline::CubicSpline;
use crate::mechanism::{Command, Commands};

/// Commanded lengths of a log, interpolated by cubic splines; before and after the log they rest.
#[derive(Clone, Debug)]
pub struct LoggedCommands {
    splines: Vec<CubicSpline>,
}

impl LoggedCommands {
    /// The commands of a log, or the first channel that is missing. Time counts from the first row.
    pub fn new(log: &Log, prismatics: usize) -> Result<Self, Channel> {
        let t: Vec<f64> = (0..log.samples).map(|i| i as f64 * log.interval).collect();
        let spline = |i| {
            let channel = Channel::Command(i);
            log.get(channel).map(|values| CubicSpline::natural(&t, values)).ok_or(channel)
        };
        Ok(Self { splines: (0..prismatics).map(spline).collect::<Result<_, _>>()? })
    }
}

impl Commands for LoggedCommands {
    fn at(&self, t: f64, commands: &mut [Command]) {
        for (command, spline) in commands.iter_mut().zip(&self.splines) {
            let [length, rate, acceleration] = spline.at(t);
            *command = Command { length, rate, acceleration };
        }
    }
}
