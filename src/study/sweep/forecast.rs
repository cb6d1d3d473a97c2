//! What a sweep will take, judged by a few of its runs.

use super::Plan;
use crate::simulate::listed_until;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What a few runs say of all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepForecast {
    /// Runs that were tried.
    pub tried: usize,
    /// Mean time of a run in s on one thread, with no other beside it.
    pub run_s: f64,
}

/// Tries the first, the last and a middle one of the runs `missing` of a plan (they see what a varied key does to the
/// cost), each for `at_most`; one that would take longer is judged by the share of its time that it reached. None where nothing is missing, or the machine can do none of those.
pub fn forecast(plan: &Plan, missing: &[usize], at_most: Duration) -> Option<SweepForecast> {
    let last = missing.len().checked_sub(1)?;
    let mut chosen = [0, last / 2, last].map(|place| missing[place]).to_vec();
    chosen.dedup();
    let times: Vec<f64> = chosen.iter().filter_map(|run| time_of(plan, *run, at_most)).collect();
    let tried = times.len();
    (tried > 0).then(|| SweepForecast { tried, run_s: times.iter().sum::<f64>() / tried as f64 })
}

/// Time in s of run `run`.
fn time_of(plan: &Plan, run: usize, at_most: Duration) -> Option<f64> {
    let started = Instant::now();
    let (scenario, mut machine) = plan.machine(run).ok()?;
    let stop = AtomicBool::new(false);
    let summary = listed_until(&scenario, &mut machine, &stop, &mut |_, _, _| {
        stop.fetch_or(started.elapsed() > at_most, Ordering::Relaxed);
    });
    let took = started.elapsed().as_secs_f64();
    let share = summary.simulated_s / scenario.simulation.duration;
    let early = summary.interrupted && share > 0.0;
    Some(if early { took / share } else { took })
}
