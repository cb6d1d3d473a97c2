//! The progress bar: simulated time, and how long the rest will take.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, stderr};

/// The bar's resolution.
const TICKS: f64 = 1000.0;

/// A bar on standard error, or nothing if that is no terminal or the user wants quiet.
#[derive(Debug)]
pub(super) struct Progress {
    bar: ProgressBar,
    duration: f64,
    ticks: u64,
}

impl Progress {
    /// A bar for a run of `duration` s.
    pub fn new(duration: f64, quiet: bool) -> Self {
        let bar = if quiet || !stderr().is_terminal() {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(TICKS as u64)
        };
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {msg}, {eta} left") {
            bar.set_style(style);
        }
        Self { bar, duration, ticks: 0 }
    }

    /// The run has reached `t` s.
    pub fn reached(&mut self, t: f64) {
        let ticks = (TICKS * t / self.duration) as u64;
        if ticks > self.ticks {
            self.ticks = ticks;
            self.bar.set_message(format!("{t:.3} of {} s simulated", self.duration));
            self.bar.set_position(ticks);
        }
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
