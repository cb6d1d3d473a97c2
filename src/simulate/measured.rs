//! A machine simulated for its figures.

use super::summary::{Recorder, Summary};
use crate::engine::{self, Halt, Instant, Schedule, StepControl, Work};
use crate::mechanism::Mechanism;
use crate::model::{IdealInstant, Machine};
use crate::scenario::Scenario;
use std::ops::ControlFlow;
use std::sync::atomic::AtomicBool;
use std::time::Instant as Clock;

/// Simulates a machine for its figures, its energy balanced, and writes nothing. `observe` is shown the
/// machine and each row, beside the same instant without clearance.
///
/// ```
/// use freeplay::prelude::*;
/// use freeplay::simulate::measured;
///
/// let sets = ["simulation.duration=0.01", "simulation.settle=0"].map(str::to_owned);
/// let scenario = Scenario::load(None, &sets)?;
/// let mut machine = assemble(&scenario)?;
/// let mut rows = 0;
/// let summary = measured(&scenario, &mut machine, &mut |_, _, _| rows += 1);
/// assert_eq!(rows, machine.schedule.intervals() + 1);
/// assert_eq!(summary.halted, None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn measured(
    scenario: &Scenario,
    machine: &mut Machine,
    observe: &mut dyn FnMut(&Mechanism, &Instant, &IdealInstant),
) -> Summary {
    measured_until(scenario, machine, &AtomicBool::new(false), observe)
}

/// [`measured`] that ends between two steps once `stop` is true; its summary then says `interrupted`.
pub fn measured_until(
    scenario: &Scenario,
    machine: &mut Machine,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Mechanism, &Instant, &IdealInstant),
) -> Summary {
    summed_up(engine::run_balanced, (scenario, machine), stop, observe)
}

/// [`measured_until`] whose summary says nothing of wear, for tables that do not either.
pub fn listed_until(
    scenario: &Scenario,
    machine: &mut Machine,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Mechanism, &Instant, &IdealInstant),
) -> Summary {
    summed_up(engine::run_without_wear, (scenario, machine), stop, observe)
}

/// A way to run a mechanism.
type Way = fn(
    &Mechanism,
    StepControl,
    Schedule,
    &AtomicBool,
    &mut dyn FnMut(&Instant) -> ControlFlow<()>,
) -> Result<Work, Halt>;

fn summed_up(
    run: Way,
    (scenario, machine): (&Scenario, &mut Machine),
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Mechanism, &Instant, &IdealInstant),
) -> Summary {
    let started = Clock::now();
    let mechanism = &machine.mechanism;
    let mut recorder = Recorder::new(mechanism, scenario.simulation.settle());
    let ideal = &mut machine.ideal;
    let (control, schedule) = (machine.control, machine.schedule);
    let ended = run(mechanism, control, schedule, stop, &mut |instant| {
        let ideal = recorder.ideal_at(mechanism, ideal, instant.t);
        recorder.row(mechanism, instant, &ideal);
        observe(mechanism, instant, &ideal);
        ControlFlow::Continue(())
    });
    let (work, halted) = match ended {
        Ok(work) => (work, None),
        Err(halt) => {
            let reason = halt.to_string();
            (*halt.work, Some(reason))
        }
    };
    let wall = started.elapsed().as_secs_f64();
    recorder.finish(scenario, machine, &work, wall, halted, Vec::new())
}
