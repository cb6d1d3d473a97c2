//! A machine that nothing holds, at rest where it is let go.

use super::start::{CalmedBodies, Closed, SWING, StartError, closed, release};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::effects::Setting;
use crate::engine::{Halt, Schedule, StepControl, Work, run_while};
use crate::mechanism::{Attachment, Bearing, Drive, JointIndex, Mechanism, Revolute};
use crate::scenario::Scenario;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Time in s for which a free machine is held by the angles of its joints before it is let go, at most: journals whose swing
/// is damped settle within 0.15 s in play of 0.4 mm. Undamped they went on, and from which place they were let go hung on the
/// last millionth of a radian.
const HELD: f64 = 1.0;

/// It is let go as soon as no body moves farther (m) between two looks (s): what creeps to its place has ten times as far to go
/// still, a thousandth of what the finest sensors see. Stopped ten times sooner, a pendulum seemed to be dragged by 3e-6 N.
const AT_REST: (f64, f64) = (5e-10, 5e-3);

/// Tolerance in m/s with which it is held, at most: errors of steps move a journal at rest by less than that then. With 1e-4 they
/// never let one rest, with 1e-5 hardly half in play of 0.4 mm, and with 1e-6 one in sixty rested late.
const HOLDING: f64 = 1e-7;

/// Natural frequency in Hz of what holds a joint's two bodies against each other: the weight of a machine of some decimetres bends
/// it by some ten-thousandths of a radian, which its coordinates, being fitted, make up for. Held by the inertia of the whole
/// machine a light link at its end took steps of 5 µs.
const HOLD: f64 = 300.0;

/// A machine that was held until it rested.
pub struct AtRest {
    /// The machine.
    pub machine: Mechanism,
    /// What holding it took.
    work: Work,
}

impl AtRest {
    /// Steps of bodies while it was held.
    pub fn steps(&self) -> u64 {
        self.work.steps * self.machine.bodies.len() as u64
    }
}

/// The machine of a rig with these effects, let go at its first row with these coordinates (m or rad) of the joints that
/// its drives leave free.
///
/// # Errors
/// As of [`released`](super::released::released).
pub fn let_go_at(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
    coordinates: &[f64],
    control: StepControl,
) -> Result<AtRest, StartError> {
    let Closed { mechanism, held } = closed(rig, effects, recording, Some(coordinates))?;
    Ok(held_there(mechanism, held.len(), control)?)
}

/// A machine that was held at its start by the last `held` of its drives until its journals settled, and let go.
fn held_there(mut mechanism: Mechanism, held: usize, control: StepControl) -> Result<AtRest, Halt> {
    let mut holding = mechanism.clone();
    holding.loads.push(Arc::new(CalmedBodies { rate: 2.0 * slowest_swing(&mechanism) }));
    holding.epoch = -HELD;
    holding.revolutes.iter_mut().for_each(|joint| slippery(&mut joint.bearing));
    let first = holding.actuators.len() - held;
    let omega = TAU * HOLD;
    for drive in &mut holding.actuators[first..] {
        let inert = moved(&mechanism, drive.joint);
        drive.drive =
            Drive::Servo { stiffness: inert * omega * omega, damping: 2.0 * inert * omega };
    }
    for body in &mut holding.bodies {
        body.start.twist.fill(0.0);
    }
    let control = match control.tolerance() {
        Some(tolerance) => control.with_tolerance_times((HOLDING / tolerance).min(1.0)),
        None => control,
    };
    let (moved, interval) = AT_REST;
    let schedule = Schedule { duration: HELD, interval };
    let mut began = false;
    let work = run_while(&holding, control, schedule, &AtomicBool::new(false), &mut |instant| {
        let mut rests = std::mem::replace(&mut began, true);
        for (i, body) in mechanism.bodies.iter_mut().enumerate() {
            let state = instant.states[i];
            rests &= (state.position - body.start.position).norm() < moved;
            (body.start, body.angle) = (state, instant.angles[i]);
            body.start.twist.fill(0.0);
        }
        if rests { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    release(&mut mechanism, held);
    mechanism.epoch = 0.0;
    Ok(AtRest { machine: mechanism, work })
}

/// A bearing without friction: of one that grows with the speed of sliding nothing is left where a journal rests, and on the way
/// there it creeps.
fn slippery(bearing: &mut Bearing) {
    match bearing {
        Bearing::Clearance(clearance) => clearance.friction = None,
        Bearing::Native { friction, .. } => *friction = 0.0,
        Bearing::Ideal => {}
    }
}

/// The angular frequency in rad/s at which bodies swing in their play under their weight, in the widest one: `√(g/c)`, that of a
/// pendulum whose length is the clearance. Damped critically it dies fastest.
fn slowest_swing(mechanism: &Mechanism) -> f64 {
    let clearance = |joint: &Revolute| match &joint.bearing {
        Bearing::Clearance(clearance) => clearance.radial(),
        Bearing::Native { bearing_radius, journal_radius, .. } => bearing_radius - journal_radius,
        Bearing::Ideal => 0.0,
    };
    let widest = mechanism.revolutes.iter().map(clearance).fold(0.0, f64::max);
    let swing = (mechanism.gravity.norm() / widest).sqrt();
    if swing.is_normal() { swing } else { TAU * SWING }
}

/// What a drive of this joint moves: the mass in kg, or the moment of inertia about the joint in kg·m², of its two bodies, `a` and
/// `b`, against each other: `1/(1/a + 1/b)`. Steps in which what holds it acts are as short as that is small.
fn moved(mechanism: &Mechanism, joint: JointIndex) -> f64 {
    let ends = match joint {
        JointIndex::Revolute(i) => [&mechanism.revolutes[i].ring, &mechanism.revolutes[i].journal],
        JointIndex::Prismatic(i) => {
            [&mechanism.prismatics[i].base, &mechanism.prismatics[i].slider]
        }
    };
    let share = |end: &Attachment| {
        let body = &mechanism.bodies[end.body?];
        Some(match joint {
            JointIndex::Revolute(_) => body.inertia + body.mass * end.point.norm_squared(),
            JointIndex::Prismatic(_) => body.mass,
        })
    };
    1.0 / ends.into_iter().filter_map(share).map(f64::recip).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::residuals::problem::RigProblem;

    /// Held once more, a double pendulum that was let go stays where it is; however coarse steps are, it rests there.
    #[test]
    fn what_is_let_go_has_come_to_rest() {
        let problem = RigProblem::planar("planar-4");
        let recording = &problem.runs[0].recording;
        let Closed { mechanism, held } = closed(&problem.rig, &[], recording, None).unwrap();
        let hold = |machine: &Mechanism, control| {
            let held = held_there(machine.clone(), held.len(), control).unwrap();
            (held.machine, held.work)
        };
        let (held_once, _) = hold(&mechanism, problem.control);
        let mut again = mechanism.clone();
        for (body, known) in again.bodies.iter_mut().zip(&held_once.bodies) {
            (body.start, body.angle) = (known.start, known.angle);
        }
        let (held_twice, _) = hold(&again, problem.control);
        let farthest = |from: &Mechanism| {
            let pairs = held_once.bodies.iter().zip(&from.bodies);
            pairs.map(|(a, b)| (a.start.position - b.start.position).norm()).fold(0.0, f64::max)
        };
        let (moved, settled) = (farthest(&held_twice), farthest(&mechanism));
        assert!(moved < 2e-8 && settled > 1e-5, "{moved:e} m after {settled:e} m");
        let coarse = StepControl::Tolerance(1e-4);
        let (held_coarsely, work) = hold(&mechanism, coarse);
        let seconds = work.reached;
        let apart = farthest(&held_coarsely);
        assert!(apart < 2e-8 && seconds < 0.5 * HELD, "{apart:e} m, {seconds} s");
    }
}
