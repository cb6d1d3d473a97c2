//! Mechanisms with known answers, each stated as a mechanism file: closed forms, benchmark problems, and
//! exact output of other programs. Each source is named above its numbers.

mod andrews_squeezer;
mod clearance_four_bar;
mod double_pendulum;
mod leaning;
mod n_four_bar;
mod parallelogram;
mod slider_crank;
mod slider_guides;
mod stephenson;

use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::{BodyState, Dynamics, Evaluation, JointIndex, Mechanism};
use freeplay::model::{Machine, assemble};
use freeplay::scenario::Scenario;
use nalgebra::Vector3;

/// The machine of a mechanism file.
fn machine(text: &str) -> Machine {
    let scenario = Scenario::from_text(text, "known answer", &[])
        .unwrap_or_else(|problems| panic!("{problems}\n{text}"));
    assemble(&scenario).unwrap_or_else(|problem| panic!("{problem}\n{text}"))
}

/// Everything that the equations of motion say of a mechanism at time `t` (s) and these states.
fn evaluate(mechanism: &Mechanism, t: f64, states: &[BodyState]) -> Evaluation {
    let mut dynamics = Dynamics::new(mechanism);
    let mut now = Evaluation::new(mechanism);
    dynamics.forces(mechanism, t, states, &mut now);
    dynamics.accelerations(mechanism, states, &mut now);
    now
}

/// Runs a machine with ideal joints under error control, and looks at each row.
fn simulate(
    mechanism: &Mechanism,
    tolerance: f64,
    schedule: Schedule,
    observe: &mut dyn FnMut(&Instant),
) {
    let work = run(mechanism, StepControl::Tolerance(tolerance), schedule, observe).unwrap();
    println!("tolerance {tolerance:.0e} m/s: {} steps", work.steps);
}

/// Index of the body of that name.
fn body(mechanism: &Mechanism, name: &str) -> usize {
    mechanism.bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("{name}"))
}

/// Index of the revolute joint of that name.
fn revolute(mechanism: &Mechanism, name: &str) -> usize {
    match mechanism.joints().find(|(joint, _)| *joint == name) {
        Some((_, JointIndex::Revolute(index))) => index,
        other => panic!("{name}: {other:?}"),
    }
}

/// Kinetic energy and height of all bodies in J.
fn energy(mechanism: &Mechanism, states: &[BodyState]) -> f64 {
    let each = mechanism.bodies.iter().zip(states).map(|(body, state)| {
        let v: Vector3<f64> = state.twist;
        let kinetic = 0.5 * (body.mass * v.xy().norm_squared() + body.inertia * v.z * v.z);
        kinetic - body.mass * mechanism.gravity.dot(&state.position)
    });
    each.sum()
}

/// Errors with two digits, for a line of output.
fn short(errors: &[f64]) -> String {
    errors.iter().map(|error| format!("{error:.1e}")).collect::<Vec<_>>().join(" ")
}
