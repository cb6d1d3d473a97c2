//! A machine simulated for its figures.

use super::summary::{Recorder, Summary};
use crate::engine::{self, Instant};
use crate::mechanism::Mechanism;
use crate::model::{IdealInstant, Machine};
use crate::scenario::Scenario;
use std::ops::ControlFlow;
use std::sync::atomic::AtomicBool;
use std::time::Instant as Clock;

/// Longest time in s between two looks at the machine without clearance: ten rows by default. Peaks between rows
/// that are farther apart would be missed.
const LONGEST_LOOK: f64 = 5e-3;

/// Simulates a machine for its figures, its energy balanced, and writes nothing. `observe` is shown the
/// machine and each row, beside the same instant without clearance.
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
    let started = Clock::now();
    let mechanism = &machine.mechanism;
    let mut recorder = Recorder::new(mechanism, scenario.simulation.settle());
    let ideal = &mut machine.ideal;
    let (control, schedule) = (machine.control, machine.schedule);
    let mut before = 0.0;
    let ended = engine::run_balanced(mechanism, control, schedule, stop, &mut |instant| {
        if ideal.is_kinematic() {
            // 1e-9 forgives rounding.
            let looks = ((instant.t - before) / LONGEST_LOOK * (1.0 - 1e-9)).ceil();
            for k in 1..looks as usize {
                let t = before + (instant.t - before) * k as f64 / looks;
                recorder.ideal(mechanism, t, &ideal.at(t));
            }
            before = instant.t;
        }
        let ideal = ideal.at(instant.t);
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
