//! A mechanism from start to end: what a run is asked for, what it hands out, how it can fail.

use super::adaptive::Adaptive;
use super::fixed::Fixed;
use super::native::Native;
use crate::contact::Contact;
use crate::mechanism::{
    Actuator, Bearing, BodyState, Drive, Evaluation, JointIndex, Mechanism, angle_near,
};
use nalgebra::UnitComplex;
use std::ops::ControlFlow;

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// A fixed step of at most so many seconds: the longest that divides the row interval.
    Fixed(f64),
    /// As long as this tolerance allows: the velocity error of one step in m/s, in a machine whose
    /// joints have 0.5 mm of clearance or more; in proportion less where they have less, down to a
    /// fiftieth at 10 µm.
    Tolerance(f64),
}

/// Speed in m/s at which journals are taken to hit where the step is checked beforehand: hits in
/// the paper's machine come at 0.1–0.3 m/s, and the longest step falls with its fifth root only.
pub const TYPICAL_IMPACT_SPEED: f64 = 0.2;

/// Which instants a run hands out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Simulated time in s.
    pub duration: f64,
    /// Time between two rows in s; the first row is t = 0, the last one the end.
    pub interval: f64,
}

impl Schedule {
    /// Number of intervals; the last one is shorter if the duration is no multiple of the interval.
    pub fn intervals(&self) -> usize {
        // A relative 1e-9 forgives 0.3/0.1 = 2.9999….
        (self.duration / self.interval * (1.0 - 1e-9)).ceil().max(1.0) as usize
    }

    /// Time of row `k` in s.
    pub fn time(&self, k: usize) -> f64 {
        if k >= self.intervals() { self.duration } else { k as f64 * self.interval }
    }
}

/// What one joint has gone through.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Largest normal force in N since the row before.
    pub peak: f64,
    /// Contacts begun since the start.
    pub impacts: u64,
    /// Time in contact since the start, in s.
    pub contact_time: f64,
    /// Energy that the normal force has taken from the bodies since the start, in J, `∫ F_N δ̇ dt`:
    /// what the contact dissipated and, while it is touching, what it holds as a spring.
    pub energy: f64,
    /// Touching at the present instant.
    pub touching: bool,
}

/// Largest values since the row before, over all steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peaks {
    /// Of the output body's acceleration |(a_x, a_y)| in m/s².
    pub acceleration: f64,
    /// Of the force |F| of a drive of a prismatic joint in N.
    pub drive_force: f64,
    /// Of the torque of a drive of a revolute joint in N·m.
    pub drive_torque: f64,
}

/// Everything that is known at one instant. States, accelerations and forces belong together:
/// the forces are those at these positions and velocities, the accelerations follow from them.
#[derive(Debug)]
pub struct Instant<'a> {
    /// Time in s.
    pub t: f64,
    /// State of each body.
    pub states: &'a [BodyState],
    /// Angle of each body in rad, whole turns counted since the start.
    pub angles: &'a [f64],
    /// Forces, accelerations, contacts, commands.
    pub evaluation: &'a Evaluation,
    /// One per revolute joint.
    pub tallies: &'a [Tally],
    /// Largest values since the row before.
    pub peaks: Peaks,
}

/// What a run took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Steps of the physics engine.
    pub steps: u64,
    /// Shortest step in s.
    pub smallest_step: f64,
    /// Longest step in s.
    pub largest_step: f64,
    /// Time reached in s.
    pub reached: f64,
    /// Largest velocity error of a step in m/s, where the way of stepping estimates it.
    pub step_error: Option<f64>,
}

/// A run that had to stop. What was handed out before stands.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the simulation broke down at t = {t:.6} s in {what}; {cause}")]
pub struct Halt {
    /// When, in s.
    pub t: f64,
    /// The joint or body where it shows, and what is impossible about its state.
    pub what: String,
    /// Likely cause, and what to try.
    pub cause: String,
    /// Work done until then.
    pub work: Work,
}

/// A way of stepping. The driver asks it for the present instant, then for a step towards the next
/// row, in turn.
pub(super) trait Stepper {
    /// Makes states and evaluation those of time `t` in s.
    fn synchronise(&mut self, mechanism: &Mechanism, t: f64);
    /// States at the instant last synchronised.
    fn states(&self) -> &[BodyState];
    /// Forces, accelerations, contacts at that instant.
    fn evaluation(&self) -> &Evaluation;
    /// Largest normal force (N) of each joint inside the step that ended at that instant, where the
    /// way of stepping looks there.
    fn peaks_inside(&self) -> &[f64];
    /// Lets the sampled controllers that are due compute what they hold from the instant last
    /// synchronised on.
    fn sample(&mut self, mechanism: &Mechanism, t: f64, due: &[bool]);
    /// Makes one step from `t` of at most `until − t` s; returns the time reached, exactly `until`
    /// if it got there.
    fn advance(&mut self, mechanism: &Mechanism, t: f64, until: f64) -> f64;
    /// Estimated velocity error of the last step in m/s, if there is an estimate.
    fn step_error(&self) -> Option<f64> {
        None
    }
    /// Whether the contact forces of an instant are the means over the step that ended there, and not
    /// those of the instant itself.
    fn mean_forces(&self) -> bool {
        false
    }
}

/// Simulates `mechanism` and calls `observe` at each row of the schedule.
///
/// # Errors
/// [`Halt`] when a state turns impossible; the rows handed out before stand.
pub fn run(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    observe: &mut dyn FnMut(&Instant),
) -> Result<Work, Halt> {
    run_while(mechanism, control, schedule, &mut |instant| {
        observe(instant);
        ControlFlow::Continue(())
    })
}

/// [`run`] with an `observe` that may end it early: the work is then what was done until that row.
///
/// # Errors
/// [`Halt`] when a state turns impossible; the rows handed out before stand.
pub fn run_while(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    observe: &mut dyn FnMut(&Instant) -> ControlFlow<()>,
) -> Result<Work, Halt> {
    let native = mechanism.revolutes.iter().any(|j| matches!(j.bearing, Bearing::Native { .. }));
    match control {
        StepControl::Fixed(step) if native => {
            drive(&mut Native::new(mechanism, step), mechanism, control, schedule, observe)
        }
        StepControl::Fixed(step) => {
            drive(&mut Fixed::new(mechanism, step), mechanism, control, schedule, observe)
        }
        StepControl::Tolerance(tolerance) => {
            drive(&mut Adaptive::new(mechanism, tolerance), mechanism, control, schedule, observe)
        }
    }
}

/// Length of the next step from `t` so that steps of equal length, at most `step` s, end exactly at
/// `until`; and the time reached. (A sliver left over by rounding would give a prescribed drive an
/// endless force.)
pub(super) fn equal_step(step: f64, t: f64, until: f64) -> (f64, f64) {
    let span = until - t;
    let count = (span / step * (1.0 - 1e-9)).ceil().max(1.0);
    let dt = span / count;
    (dt, if count == 1.0 { until } else { t + dt })
}

fn drive(
    stepper: &mut dyn Stepper,
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    observe: &mut dyn FnMut(&Instant) -> ControlFlow<()>,
) -> Result<Work, Halt> {
    let mut work = Work { smallest_step: f64::INFINITY, ..Work::default() };
    let mut watch = Watch::new(mechanism);
    let mut t = 0.0;
    let mut clock = Clock::new(mechanism);
    for row in 0..=schedule.intervals() {
        let until = schedule.time(row);
        loop {
            stepper.synchronise(mechanism, t);
            let (states, now) = (stepper.states(), stepper.evaluation());
            if let Some(what) = impossible(mechanism, states, &now.contacts) {
                let cause = likely_cause(mechanism, control);
                return Err(Halt { t, what, cause, work });
            }
            watch.account(&now.contacts, stepper.mean_forces());
            watch.record(mechanism, states, now, stepper.peaks_inside());
            if t >= until {
                break;
            }
            if clock.due(t) {
                stepper.sample(mechanism, t, &clock.due);
            }
            let reached = stepper.advance(mechanism, t, clock.end(until));
            let dt = reached - t;
            watch.elapse(dt);
            t = reached;
            work.steps += 1;
            work.reached = t;
            work.smallest_step = work.smallest_step.min(dt);
            work.largest_step = work.largest_step.max(dt);
            if let Some(error) = stepper.step_error() {
                work.step_error = Some(work.step_error.map_or(error, |worst| worst.max(error)));
            }
        }
        watch.look_at_angles(stepper.states(), |_, _| true);
        let Watch { tallies, peaks, angles, .. } = &watch;
        let (states, evaluation) = (stepper.states(), stepper.evaluation());
        let instant = Instant { t, states, angles, evaluation, tallies, peaks: *peaks };
        if observe(&instant).is_break() {
            break;
        }
        watch.new_row();
    }
    Ok(work)
}

/// When controllers take samples: each at multiples of its own interval.
#[derive(Debug)]
struct Clock {
    /// Interval in s of each drive's controller, and how many samples it took.
    intervals: Vec<Option<(f64, u64)>>,
    /// The drives whose controllers take a sample now.
    due: Vec<bool>,
}

impl Clock {
    fn new(mechanism: &Mechanism) -> Self {
        let interval = |actuator: &Actuator| match actuator.drive {
            Drive::Sampled(cascade) => Some((cascade.interval, 0)),
            Drive::Prescribed | Drive::Servo { .. } | Drive::Effort => None,
        };
        let intervals: Vec<_> = mechanism.actuators.iter().map(interval).collect();
        Self { due: vec![false; intervals.len()], intervals }
    }

    /// Finds who takes a sample at `t` (s), and counts it; false if nobody does.
    fn due(&mut self, t: f64) -> bool {
        for (due, interval) in self.due.iter_mut().zip(&mut self.intervals) {
            // Rows and samples that mean the same time differ by rounding.
            *due = interval.is_some_and(|(dt, samples)| t >= samples as f64 * dt - 1e-9 * dt);
            if let Some((_, samples)) = interval {
                *samples += u64::from(*due);
            }
        }
        self.due.contains(&true)
    }

    /// The end of steps that may go as far as `until`: there, or at the next sample.
    fn end(&self, until: f64) -> f64 {
        self.intervals.iter().flatten().fold(until, |end, &(dt, samples)| {
            let next = samples as f64 * dt;
            // Samples that mean the same time as a row, or as another's, differ from it by rounding.
            if next < end - 1e-9 * dt { next } else { end }
        })
    }
}

/// Keeps account of what happens between rows.
#[derive(Debug)]
struct Watch {
    tallies: Vec<Tally>,
    peaks: Peaks,
    /// Angle of each body in rad, whole turns counted, when it was looked at last, and its rotation then.
    angles: Vec<f64>,
    rotations: Vec<UnitComplex<f64>>,
    /// Contacts at the instant before, and the time in s since then.
    before: Vec<Contact>,
    dt: f64,
}

impl Watch {
    fn new(mechanism: &Mechanism) -> Self {
        let joints = mechanism.revolutes.len();
        Self {
            tallies: vec![Tally::default(); joints],
            peaks: Peaks::default(),
            angles: mechanism.bodies.iter().map(|body| body.angle).collect(),
            rotations: mechanism.bodies.iter().map(|body| body.start.rotation).collect(),
            before: vec![Contact::default(); joints],
            dt: 0.0,
        }
    }

    /// Keeps account of energy. An impulse J between the rates a and b takes `J (a + b)/2`, exactly;
    /// for a force that varies over the step this is the trapezoidal rule.
    fn account(&mut self, contacts: &[Contact], mean_forces: bool) {
        for ((tally, now), before) in self.tallies.iter_mut().zip(contacts).zip(&mut self.before) {
            let [was, is] = [before.normal_force, now.normal_force];
            let force = if mean_forces { is } else { 0.5 * (was + is) };
            tally.energy += force * 0.5 * (before.rate + now.rate) * self.dt;
            *before = *now;
        }
        // A row's instant is looked at twice: the step that ended there counts once.
        self.dt = 0.0;
    }

    fn record(
        &mut self,
        mechanism: &Mechanism,
        states: &[BodyState],
        now: &Evaluation,
        inside: &[f64],
    ) {
        for (tally, peak) in self.tallies.iter_mut().zip(inside) {
            tally.peak = tally.peak.max(*peak);
        }
        for (tally, contact) in self.tallies.iter_mut().zip(&now.contacts) {
            let touching = contact.normal_force > 0.0;
            tally.peak = tally.peak.max(contact.normal_force);
            tally.impacts += u64::from(touching && !tally.touching);
            tally.touching = touching;
        }
        let acceleration = mechanism.output_acceleration(states, &now.accelerations).xy().norm();
        self.peaks.acceleration = self.peaks.acceleration.max(acceleration);
        for (actuator, effort) in mechanism.actuators.iter().zip(&now.drive_forces) {
            let peak = match actuator.joint {
                JointIndex::Prismatic(_) => &mut self.peaks.drive_force,
                JointIndex::Revolute(_) => &mut self.peaks.drive_torque,
            };
            *peak = peak.max(effort.abs());
        }
        // An arc tangent a step is dear; whole turns are counted as well every quarter of a turn.
        self.look_at_angles(states, |before, now| before.re * now.re + before.im * now.im <= 0.0);
    }

    /// Brings angles up to date, those of bodies for whose rotations then and now it is `due`.
    fn look_at_angles(
        &mut self,
        states: &[BodyState],
        due: impl Fn(&UnitComplex<f64>, &UnitComplex<f64>) -> bool,
    ) {
        let angles = self.angles.iter_mut().zip(&mut self.rotations);
        for ((angle, rotation), state) in angles.zip(states) {
            if due(rotation, &state.rotation) {
                *angle = angle_near(state.rotation, *angle);
                *rotation = state.rotation;
            }
        }
    }

    fn elapse(&mut self, dt: f64) {
        self.dt = dt;
        for tally in self.tallies.iter_mut().filter(|tally| tally.touching) {
            tally.contact_time += dt;
        }
    }

    /// Called after a row was handed out.
    fn new_row(&mut self) {
        self.peaks = Peaks::default();
        for tally in &mut self.tallies {
            tally.peak = 0.0;
        }
    }
}

/// The first thing that is impossible at an instant, if any: a state that is no number, or a
/// journal whose penetration exceeds its bearing's radius.
fn impossible(mechanism: &Mechanism, states: &[BodyState], contacts: &[Contact]) -> Option<String> {
    let finite = |s: &BodyState| (s.position.sum() + s.twist.sum()).is_finite();
    for (joint, contact) in mechanism.revolutes.iter().zip(contacts) {
        if let Bearing::Clearance(clearance) = &joint.bearing
            && (contact.penetration.is_nan() || contact.penetration >= clearance.bearing_radius)
        {
            let what = if contact.penetration.is_finite() {
                format!("the journal has left its ring by {:.3e} m", contact.penetration)
            } else {
                "the journal's position is not a number".to_owned()
            };
            return Some(format!("joint {}: {what}", joint.name));
        }
    }
    let body = mechanism.bodies.iter().zip(states).find(|(_, s)| !finite(s));
    body.map(|(b, _)| format!("{}: position or velocity is not a number", b.name))
}

/// Why a run may have broken down, and what to try.
fn likely_cause(mechanism: &Mechanism, control: StepControl) -> String {
    let key = match (control, mechanism.longest_step(TYPICAL_IMPACT_SPEED)) {
        (StepControl::Fixed(step), Some(longest)) if step > longest => {
            // Half of it, because two digits may round up.
            let enough = longest / 2.0;
            return format!(
                "likely the step of {step:.1e} s is too long for the contacts: try \
                 simulation.step = {enough:.1e}"
            );
        }
        (StepControl::Fixed(_), _) => "step",
        (StepControl::Tolerance(_), _) => "tolerance",
    };
    format!(
        "likely hits far harder than usual, or a machine near a singularity: try a smaller \
         simulation.{key}, or `freeplay check`"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Body;
    use nalgebra::{Vector2, Vector3};

    #[test]
    fn whole_turns_between_rows_are_counted() {
        let body = |spin| {
            let twist = Vector3::new(0.0, 0.0, spin);
            let (position, rotation) = (Vector2::zeros(), UnitComplex::new(3.0));
            Body::new("wheel", 1.0, 1.0, BodyState { position, rotation, twist })
        };
        let spins = [40.0, -25.0, 0.1];
        let mechanism = Mechanism::free(spins.map(body).to_vec());
        let schedule = Schedule { duration: 2.0, interval: 0.5 };
        for control in [StepControl::Fixed(1e-3), StepControl::Tolerance(1e-5)] {
            run(&mechanism, control, schedule, &mut |instant| {
                for (angle, spin) in instant.angles.iter().zip(spins) {
                    let expected = 3.0 + spin * instant.t;
                    assert!((angle - expected).abs() < 1e-9, "{control:?}: {angle} {expected}");
                }
            })
            .expect("runs to its end");
        }
    }
}
