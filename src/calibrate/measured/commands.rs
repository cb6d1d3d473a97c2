//! The commands of a log, as functions of time.

use crate::measure::log::{Channel, Log};
use crate::measure::spline::CubicSpline;
use crate::mechanism::{Command, Commands};

/// Time in s for which the machine was held at its first command before a log begins.
pub const LEAD: f64 = 0.25;

/// Commanded lengths of a log, interpolated by cubic splines; before and after the log they rest.
#[derive(Clone, Debug)]
pub struct LoggedCommands {
    splines: Vec<CubicSpline>,
    /// Time of the last row in s.
    end: f64,
    interval: f64,
}

/// Share of the time between two rows by which rounding makes a simulation miss the last one: there the
/// commands move still.
const ROUNDING: f64 = 1e-6;

impl LoggedCommands {
    /// The commands of a log, or the first channel that is missing. Time counts from the first row.
    pub fn new(log: &Log, prismatics: usize) -> Result<Self, Channel> {
        let t: Vec<f64> = (0..log.samples).map(|i| i as f64 * log.interval).collect();
        let spline = |i| {
            let channel = Channel::Command(i);
            log.get(channel).map(|values| CubicSpline::natural(&t, values)).ok_or(channel)
        };
        let splines = (0..prismatics).map(spline).collect::<Result<_, _>>()?;
        Ok(Self { splines, end: t.last().copied().unwrap_or(0.0), interval: log.interval })
    }
}

impl Commands for LoggedCommands {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let over = t - self.end;
        let t = if over > 0.0 && over < ROUNDING * self.interval { self.end } else { t };
        for (command, spline) in commands.iter_mut().zip(&self.splines) {
            let [length, rate, acceleration] = spline.at(t);
            *command = Command { position: length, rate, acceleration };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A simulation from −0.03 s on reached the last row a rounding error late: the commands had come to
    /// rest there, and the servo's damping made a force of it.
    #[test]
    fn commands_still_move_at_the_last_row() {
        let channels = (0..3).map(|i| {
            let ramp = (0..3000).map(|row| 0.3 + 1e-5 * f64::from(row)).collect();
            (Channel::Command(i), ramp)
        });
        let log = Log::new("run.csv", 0.0, 1e-3, channels.collect());
        let commands = LoggedCommands::new(&log, 3).expect("commands");
        let rate = |t: f64| {
            let mut all = [Command::default(); 3];
            commands.at(t, &mut all);
            all[0].rate
        };
        let late = -0.03 + 15145.0 * 2e-4;
        assert!(late > 2.999, "{late:e}");
        assert!((rate(late) - 0.01).abs() < 1e-9, "{}", rate(late));
        assert_eq!(rate(3.0), 0.0);
    }
}
