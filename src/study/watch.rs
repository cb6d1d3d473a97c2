//! A watch on the work of many runs, which ends it where it would take too long.

use crate::results::Forecast;
use crate::results::RunError;
use std::fmt;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::Instant as Clock;

/// Many runs are judged while they have computed for so many seconds: by then some of each kind have begun, and what
/// is ended later has cost more than it saves.
const JUDGED: Range<f64> = 5.0..60.0;

/// Watches work of many runs that counts how far it has come, and ends it where it would take too long.
pub struct Watch<'a> {
    started: Clock,
    all: f64,
    at_any_cost: bool,
    come: Mutex<Come<'a>>,
    stop: AtomicBool,
    too_much: OnceLock<Forecast>,
}

/// How far work has come.
struct Come<'a> {
    /// What is done or spared.
    done: f64,
    /// What runs that broke down have spared.
    spared: f64,
    progress: &'a mut (dyn FnMut(f64) + Send),
}

impl fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("Watch").field("all", &self.all).finish_non_exhaustive()
    }
}

impl<'a> Watch<'a> {
    /// A watch on work that is done when it has come to `all` (s simulated, or cycles); `progress` is told how far it has
    /// come. It goes on `at_any_cost`, or ends where it would take more than ten minutes.
    pub fn new(all: f64, at_any_cost: bool, progress: &'a mut (dyn FnMut(f64) + Send)) -> Self {
        Self {
            started: Clock::now(),
            all,
            at_any_cost,
            come: Mutex::new(Come { done: 0.0, spared: 0.0, progress }),
            stop: AtomicBool::new(false),
            too_much: OnceLock::new(),
        }
    }

    /// So much more is done.
    pub(super) fn come(&self, part: f64) {
        self.gone_on(part, 0.0);
    }

    /// So much more need not be done: a run broke down.
    pub(super) fn spared(&self, part: f64) {
        self.gone_on(part, part);
    }

    fn gone_on(&self, part: f64, spared: f64) {
        let mut come = self.come.lock().unwrap_or_else(PoisonError::into_inner);
        come.done += part;
        come.spared += spared;
        let done = come.done;
        (come.progress)(done);
        self.judge(self.started, (done - come.spared) / (self.all - come.spared));
    }

    /// This share is done of a run that has begun so long ago, and all of it is no more than a part of the work.
    pub(super) fn come_in_one_run(&self, begun: Clock, share: f64) {
        self.judge(begun, share);
    }

    fn judge(&self, begun: Clock, share: f64) {
        let elapsed = begun.elapsed().as_secs_f64();
        let forecast = Forecast { seconds: Some(elapsed / share), bytes: 0.0 };
        if !self.at_any_cost && JUDGED.contains(&elapsed) && share > 0.0 && forecast.is_too_much() {
            self.too_much.get_or_init(|| forecast);
            self.stop.store(true, Ordering::Relaxed);
        }
    }

    /// What runs look at: once true, they end.
    pub(super) fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    /// Whether the work was ended.
    ///
    /// # Errors
    /// [`RunError::TooLong`] if it was.
    pub(super) fn ended(&self) -> Result<(), RunError> {
        self.too_much.get().map_or(Ok(()), |forecast| Err(RunError::TooLong(*forecast)))
    }
}
