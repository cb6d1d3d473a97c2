//! The progress bars: how far a command has come, and how long the rest will take.

use crate::measure::shown::shown;
use crate::study::Watch;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, stderr};
use std::sync::Once;
use std::time::Duration;

/// The resolution of the bar of a run.
const TICKS: f64 = 1000.0;

/// A bar on standard error, or nothing if that is no terminal or the user wants quiet.
fn bar(length: u64, template: &str, quiet: bool) -> ProgressBar {
    let bar = if quiet || !stderr().is_terminal() {
        ProgressBar::hidden()
    } else {
        ProgressBar::new(length)
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// The bar of one run: simulated time.
#[derive(Debug)]
pub(in crate::cli) struct Progress {
    bar: ProgressBar,
    duration: f64,
    unit: &'static str,
    ticks: u64,
}

impl Progress {
    /// A bar for a run of `duration` s.
    pub fn new(duration: f64, quiet: bool) -> Self {
        Self::counted(duration, "s simulated", quiet)
    }

    /// A bar that counts to `duration` in another unit.
    pub fn counted(duration: f64, unit: &'static str, quiet: bool) -> Self {
        let bar = bar(TICKS as u64, "{bar:40} {msg}, {eta} left", quiet);
        Self { bar, duration, unit, ticks: 0 }
    }

    /// Does work of so many seconds of simulated time and shows how far it has come; what would take too long is ended
    /// where nobody said yes.
    pub fn during<T>(duration: f64, yes: bool, quiet: bool, work: impl FnOnce(&Watch) -> T) -> T {
        Self::new(duration, quiet).watched(yes, work)
    }

    /// Does work that counts to what the bar counts to.
    pub fn watched<T>(&mut self, yes: bool, work: impl FnOnce(&Watch) -> T) -> T {
        let duration = self.duration;
        let result = work(&Watch::new(duration, yes, &mut |come| self.reached(come)));
        self.clear();
        result
    }

    /// The run has reached `t` s.
    pub fn reached(&mut self, t: f64) {
        let ticks = (TICKS * t / self.duration) as u64;
        if ticks > self.ticks {
            self.ticks = ticks;
            self.bar.set_message(format!("{t:.3} of {} {}", self.duration, self.unit));
            self.bar.set_position(ticks);
        }
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

/// A line that says what is being done, where nobody knows how much there will be, or no more than the most.
#[derive(Debug)]
pub(in crate::cli) struct Spinner {
    bar: ProgressBar,
}

impl Spinner {
    /// Does some work and shows what it tells.
    pub fn during<T>(quiet: bool, work: impl FnOnce(&(dyn Fn(&str) + Sync)) -> T) -> T {
        let spinner = Self::new(quiet);
        let result = work(&|what| spinner.tell(what));
        spinner.clear();
        result
    }

    /// A line without a word yet.
    pub fn new(quiet: bool) -> Self {
        Self::ticking(bar(0, "{spinner} {elapsed} {wide_msg}", quiet))
    }

    fn ticking(bar: ProgressBar) -> Self {
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar }
    }

    /// What is being done now.
    pub fn tell(&self, what: &str) {
        self.bar.set_message(shown(what).into_owned());
    }

    /// Does something else with the terminal, and shows the line again below it.
    pub fn aside<T>(&self, work: impl FnOnce() -> T) -> T {
        self.bar.suspend(work)
    }

    /// Removes the line.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

/// The bar of many runs.
#[derive(Debug)]
pub(in crate::cli) struct RunsProgress {
    bar: ProgressBar,
    started: Once,
}

impl RunsProgress {
    /// A bar that does not know yet how many runs there will be.
    pub fn new(quiet: bool) -> Self {
        let bar = bar(0, "{bar:40} {pos} of {len} runs, {per_sec}, {eta} left", quiet);
        Self { bar, started: Once::new() }
    }

    /// `finished` of `runs` are there. What is there at the first call was made earlier and says
    /// nothing of the speed.
    pub fn finished(&self, finished: usize, runs: usize) {
        self.bar.set_position(finished as u64);
        self.started.call_once(|| {
            self.bar.set_length(runs as u64);
            self.bar.reset_eta();
        });
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
