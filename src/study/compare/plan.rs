//! What is simulated for a comparison: laws, steps, starts.

use crate::engine::{Engine, StepControl, TYPICAL_IMPACT_SPEED};
use crate::scenario::{Law, Mechanism, Motion, Problem, Scenario};
use crate::simulate::{Machine, assemble, radial_clearance};
use crate::study::chaos::DISPLACEMENT;
use nalgebra::Vector2;
use std::f64::consts::TAU;

/// Time in s between two looks at a run: fine enough for the forces of a hit, which lasts 3e-4 s, to
/// be sampled fairly. Steps are at most as long.
pub const SAMPLE_INTERVAL: f64 = 1e-4;

/// The laws of a comparison, in the order of its tables.
pub const LAWS: [Law; 3] = [Law::HertzStep, Law::Native, Law::Ideal];

/// How a comparison is made.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Fixed steps in s, longest first.
    pub steps: Vec<f64>,
    /// Starts over which statistics are taken.
    pub starts: usize,
}

/// One row of a comparison: a law and how it is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompareRow {
    /// The contact law.
    pub law: Law,
    /// A fixed step, or a tolerance.
    pub control: StepControl,
    /// Whether the step resolves the law's hits, as far as that is known beforehand. A rigid contact
    /// has nothing to resolve.
    pub resolved: bool,
    /// Starts that it is run from. Without clearance there is no chance: one will do.
    pub starts: usize,
}

/// Everything that is run.
#[derive(Clone, Debug)]
pub struct ComparePlan {
    /// The tables' rows: law by law, longest step first, tolerance last.
    pub rows: Vec<CompareRow>,
    /// Starts of a motion that chance has a part in.
    pub starts: usize,
}

impl ComparePlan {
    /// All runs as (start, row), start by start, so that the progress of the first ones foretells
    /// that of the others.
    pub fn runs(&self) -> Vec<(usize, usize)> {
        let of = |start: usize| {
            let rows = (0..self.rows.len()).filter(move |&row| start < self.rows[row].starts);
            rows.map(move |row| (start, row))
        };
        (0..self.starts).flat_map(of).collect()
    }
}

/// Plans a comparison.
///
/// # Errors
/// A motion table that cannot be read, a machine without joints to compare.
pub fn plan(scenario: &Scenario, options: &Options) -> Result<ComparePlan, Problem> {
    if scenario.simulation.engine == Engine::Direct {
        let message = "\"direct\" has no contacts of the physics engine's own to compare";
        return Err(scenario.problem("simulation.engine", message, "leave simulation.engine out"));
    }
    let law = machine(scenario, Law::HertzStep, tolerance(scenario), 0, 1)?;
    if law.mechanism.revolutes.iter().all(|joint| radial_clearance(&joint.bearing).is_none()) {
        return Err(no_contacts(scenario));
    }
    let longest = law.mechanism.longest_step(TYPICAL_IMPACT_SPEED).unwrap_or(f64::INFINITY);
    let servo = law.mechanism.longest_servo_step().unwrap_or(f64::INFINITY);
    let mut rows = Vec::new();
    for law in LAWS {
        let starts = if law == Law::Ideal { 1 } else { options.starts };
        let limit = if law == Law::HertzStep { longest } else { servo };
        rows.extend(options.steps.iter().map(|&step| CompareRow {
            law,
            control: StepControl::Fixed(step),
            resolved: step <= limit,
            starts,
        }));
        if law != Law::Native {
            rows.push(CompareRow { law, control: tolerance(scenario), resolved: true, starts });
        }
    }
    Ok(ComparePlan { rows, starts: options.starts })
}

/// Complains about a machine without contacts.
pub fn no_contacts(scenario: &Scenario) -> Problem {
    let message = "has no joint with clearance: there are no contacts to compare";
    let help = "expected a mechanism with clearance in a revolute joint";
    scenario.problem("mechanism.kind", message, help)
}

/// The scenario's tolerance, or the default one if it has a step.
pub fn tolerance(scenario: &Scenario) -> StepControl {
    let mut simulation = scenario.simulation.clone();
    simulation.step = None;
    simulation.step_control()
}

/// The machine of a scenario under a law, at start `start` of `starts`. A circle begins at `starts`
/// points around it; any other motion has one beginning, and so has a pendulum, which follows none: the
/// output body is displaced there by the [`DISPLACEMENT`] of pairs, which chaos makes another motion of
/// where there is chaos.
///
/// # Errors
/// A motion table that cannot be read.
pub fn machine(
    scenario: &Scenario,
    law: Law,
    control: StepControl,
    start: usize,
    starts: usize,
) -> Result<Machine, Problem> {
    let mut scenario = scenario.clone();
    scenario.contact.law = law;
    scenario.simulation.output_interval = SAMPLE_INTERVAL;
    let turn = TAU * start as f64 / starts as f64;
    if let (Mechanism::ThreeRpr(_), Motion::Circle(circle)) =
        (&scenario.mechanism, &mut scenario.motion)
    {
        circle.phase += turn;
        let mut machine = assemble(&scenario)?;
        machine.control = control;
        return Ok(machine);
    }
    let mut machine = assemble(&scenario)?;
    machine.control = control;
    if start > 0 {
        let shift = Vector2::new(turn.cos(), turn.sin()) * DISPLACEMENT;
        machine.mechanism = machine.mechanism.displaced(shift);
    }
    Ok(machine)
}
