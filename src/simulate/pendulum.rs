//! What assembling a pendulum takes.

use super::assemble::bearing;
use super::ideal::Ideal;
use crate::engine::{self, Schedule, StepControl};
use crate::mechanism::motion::{Line, Motion};
use crate::mechanism::pendulum::{Arm, build};
use crate::mechanism::{Bearing, BodyState, Mechanism};
use crate::scenario::{Pendulum, Scenario};
use nalgebra::Vector2;
use std::sync::Arc;

/// Fixed step in s of the ideal swing: an arm of 10 cm has an error of 1e-6 of its period then.
const IDEAL_STEP: f64 = 5e-4;

/// The arm of a scenario.
pub(super) fn arm(kind: &Pendulum) -> Arm {
    Arm { mass: kind.mass, inertia: kind.inertia, length: kind.length }
}

/// Where the arm is released: nothing is commanded.
pub(super) fn rest(kind: &Pendulum) -> Arc<dyn Motion> {
    let start = arm(kind).state([kind.angle, 0.0]).position;
    Arc::new(Line { start, velocity: Vector2::zeros(), phi: kind.angle })
}

/// The pendulum, and itself with an ideal joint and no other effects. The ideal swing has no closed form:
/// it is simulated at the rows of the schedule, and known there.
pub(super) fn assemble(scenario: &Scenario, kind: &Pendulum) -> (Mechanism, Ideal) {
    let gravity: Vector2<f64> = scenario.environment.gravity.into();
    let start = [kind.angle, kind.rate];
    let ideal = build(arm(kind), Bearing::Ideal, start, gravity);
    let simulation = &scenario.simulation;
    let schedule = Schedule { duration: simulation.duration, interval: simulation.output_interval };
    let mut swing: Vec<BodyState> = Vec::with_capacity(schedule.intervals() + 1);
    // An arm that does not swing for numbers out of range shows in the run itself; here it stays.
    let _ = engine::run(&ideal, StepControl::Fixed(IDEAL_STEP), schedule, &mut |instant| {
        swing.push(instant.states[0]);
    });
    if swing.is_empty() {
        swing.push(ideal.bodies[0].start);
    }
    let states = move |t: f64| {
        let row = (t / schedule.interval).round() as usize;
        vec![swing[row.min(swing.len() - 1)]]
    };
    let mechanism = build(arm(kind), bearing(scenario, 0), start, gravity);
    (mechanism, Ideal::new(ideal, Box::new(states)))
}
