//! When sampled controllers take their samples.

use super::stepping::stepper::meant;
use crate::mechanism::{Actuator, Drive, Mechanism};

/// When controllers take samples: each at multiples of its own interval.
#[derive(Debug)]
pub(super) struct Clock {
    /// Interval in s of each drive's controller, and how many samples it took.
    intervals: Vec<Option<(f64, u64)>>,
    /// The drives whose controllers take a sample now.
    pub due: Vec<bool>,
}

impl Clock {
    pub fn new(mechanism: &Mechanism) -> Self {
        let interval = |actuator: &Actuator| match actuator.drive {
            Drive::Sampled(cascade) => Some((cascade.interval, 0)),
            Drive::Prescribed | Drive::Servo { .. } | Drive::Effort => None,
        };
        let intervals: Vec<_> = mechanism.actuators.iter().map(interval).collect();
        Self { due: vec![false; intervals.len()], intervals }
    }

    /// Finds who takes a sample at `t` (s), and counts it; false if nobody does.
    pub fn due(&mut self, t: f64) -> bool {
        for (due, interval) in self.due.iter_mut().zip(&mut self.intervals) {
            // Rows and samples that mean the same time differ by rounding.
            *due = interval.is_some_and(|(dt, samples)| t >= samples as f64 * dt - 1e-9 * dt);
            if let Some((_, samples)) = interval {
                *samples += u64::from(*due);
            }
        }
        self.due.contains(&true)
    }

    /// The end of steps that may go as far as `until`: there, or at the next sample.
    pub fn end(&self, until: f64) -> f64 {
        self.intervals.iter().flatten().fold(until, |end, &(dt, samples)| {
            let next = meant(samples as f64 * dt);
            // Samples that mean the same time as a row, or as another's, differ from it by rounding.
            if next < end - 1e-9 * dt { next } else { end }
        })
    }
}
