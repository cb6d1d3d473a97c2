//! Stepping at a fixed step: leapfrog, second order in time.

use super::leapfrog::Leapfrog;
use super::run::{Halt, Instant, Schedule, Watch, Work, impossible};
use super::world::World;
use crate::mechanism::{Bearing, Dynamics, Evaluation, Mechanism};
use nalgebra::Vector3;

/// Runs `mechanism` with steps of at most `step` s (see [`StepControl`](super::StepControl)).
pub(super) fn run(
    mechanism: &Mechanism,
    step: f64,
    schedule: Schedule,
    observe: &mut dyn FnMut(&Instant),
) -> Result<Work, Halt> {
    let mut world = World::new(mechanism, false);
    let mut leapfrog = Leapfrog::new(world.handles.clone(), &world.physics().bodies);
    let mut dynamics = Dynamics::new(mechanism);
    let mut now = Evaluation::new(mechanism);
    let mut next_commands = now.commands.clone();
    let mut watch = Watch::new(mechanism);
    let mut work = Work { smallest_step: f64::INFINITY, ..Work::default() };
    let mut wrenches = vec![Vector3::zeros(); mechanism.bodies.len()];
    // Ideal joints close loops, which one sweep of rapier's solver does not: it is handed the
    // joint forces with the others, and has only the drift to correct.
    let loops = mechanism.revolutes.iter().any(|j| matches!(j.bearing, Bearing::Ideal));
    for row in 0..=schedule.intervals() {
        let t_row = schedule.time(row);
        dynamics.forces(mechanism, t_row, leapfrog.states(), &mut now);
        dynamics.accelerations(mechanism, leapfrog.states(), &mut now);
        if let Some((place, what)) = impossible(mechanism, leapfrog.states(), &now.contacts) {
            return Err(halt(mechanism, step, t_row, place, what, work));
        }
        watch.record(&now.contacts, 0.0);
        let (states, tallies) = (leapfrog.states(), watch.tallies.as_slice());
        observe(&Instant { t: t_row, states, evaluation: &now, tallies });
        watch.new_row();
        if row == schedule.intervals() {
            break;
        }
        // Steps are counted in integers: a sliver left over by rounding would give a prescribed
        // drive an endless force.
        let span = schedule.time(row + 1) - t_row;
        let count = (span / step * (1.0 - 1e-9)).ceil().max(1.0) as u64;
        let dt = span / count as f64;
        for k in 0..count {
            let t = t_row + k as f64 * dt;
            if k > 0 {
                dynamics.forces(mechanism, t, leapfrog.states(), &mut now);
                if let Some((place, what)) = impossible(mechanism, leapfrog.states(), &now.contacts)
                {
                    return Err(halt(mechanism, step, t, place, what, work));
                }
                if loops {
                    dynamics.accelerations(mechanism, leapfrog.states(), &mut now);
                }
            }
            watch.record(&now.contacts, dt);
            mechanism.commands.at(t + dt, &mut next_commands);
            total(&mut wrenches, mechanism, &now, loops, leapfrog.kick());
            world.step(dt, &wrenches, |i| next_commands[i].length);
            leapfrog.record(&world.physics().bodies, dt);
            work.steps += 1;
            work.reached = t + dt;
            work.smallest_step = work.smallest_step.min(dt);
            work.largest_step = work.largest_step.max(dt);
        }
    }
    Ok(work)
}

/// The wrenches that rapier gets: those of the force laws, or with `loops` all that move the
/// bodies, times the step's share.
fn total(
    wrenches: &mut [Vector3<f64>],
    mechanism: &Mechanism,
    now: &Evaluation,
    loops: bool,
    kick: f64,
) {
    for (i, wrench) in wrenches.iter_mut().enumerate() {
        let body = &mechanism.bodies[i];
        let masses = Vector3::new(body.mass, body.mass, body.inertia);
        *wrench = if loops { now.accelerations[i].component_mul(&masses) } else { now.wrenches[i] };
        *wrench *= kick;
    }
}

/// The error for a run that broke down, with its likely cause.
fn halt(mechanism: &Mechanism, step: f64, t: f64, place: String, what: String, work: Work) -> Halt {
    let cause = match mechanism.longest_step(super::run::TYPICAL_IMPACT_SPEED) {
        Some(longest) if step > longest => format!(
            "likely the step of {step:.1e} s is too long for the contacts: try simulation.step = \
             {longest:.1e}"
        ),
        _ => "likely a drive too stiff or damped for the step, or a machine near a singularity: \
              try a shorter simulation.step, or `freeplay check`"
            .to_owned(),
    };
    Halt { t, place, what, cause, work }
}
