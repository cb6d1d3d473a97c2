//! A mechanism from start to end: what a run is asked for, what it hands out, how it can fail.

use super::fixed;
use crate::contact::Contact;
use crate::mechanism::{Bearing, BodyState, Evaluation, Mechanism};

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// A fixed step of at most so many seconds: the longest that divides the row interval.
    Fixed(f64),
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
    /// Touching at the present instant.
    pub touching: bool,
}

/// Everything that is known at one instant. States, accelerations and forces belong together:
/// the forces are those at these positions and velocities, the accelerations follow from them.
#[derive(Debug)]
pub struct Instant<'a> {
    /// Time in s.
    pub t: f64,
    /// State of each body.
    pub states: &'a [BodyState],
    /// Forces, accelerations, contacts, commands.
    pub evaluation: &'a Evaluation,
    /// One per revolute joint.
    pub tallies: &'a [Tally],
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
}

/// A run that had to stop. What was handed out before stands.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the simulation broke down at t = {t:.6} s in {place}: {what}; {cause}")]
pub struct Halt {
    /// When, in s.
    pub t: f64,
    /// The joint or body where it shows.
    pub place: String,
    /// What is impossible about the state.
    pub what: String,
    /// Likely cause, and what to try.
    pub cause: String,
    /// Work done until then.
    pub work: Work,
}

/// Simulates `mechanism` and calls `observe` at each row of the schedule.
pub fn run(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    observe: &mut dyn FnMut(&Instant),
) -> Result<Work, Halt> {
    match control {
        StepControl::Fixed(step) => fixed::run(mechanism, step, schedule, observe),
    }
}

/// Keeps account of the joints, and tells an impossible state from a possible one.
#[derive(Debug)]
pub(super) struct Watch {
    pub tallies: Vec<Tally>,
}

impl Watch {
    pub fn new(mechanism: &Mechanism) -> Self {
        Self { tallies: vec![Tally::default(); mechanism.revolutes.len()] }
    }

    /// Takes in the contacts at an instant that stands for `dt` s.
    pub fn record(&mut self, contacts: &[Contact], dt: f64) {
        for (tally, contact) in self.tallies.iter_mut().zip(contacts) {
            let touching = contact.normal_force > 0.0;
            tally.peak = tally.peak.max(contact.normal_force);
            if touching {
                tally.impacts += u64::from(!tally.touching);
                tally.contact_time += dt;
            }
            tally.touching = touching;
        }
    }

    /// Called after a row was handed out.
    pub fn new_row(&mut self) {
        for tally in &mut self.tallies {
            tally.peak = 0.0;
        }
    }
}

/// The first thing that is impossible at an instant, if any: a state that is no number, or a
/// journal whose penetration exceeds its bearing's radius.
pub(super) fn impossible(
    mechanism: &Mechanism,
    states: &[BodyState],
    contacts: &[Contact],
) -> Option<(String, String)> {
    let finite = |s: &BodyState| (s.position.sum() + s.twist.sum()).is_finite();
    for (joint, contact) in mechanism.revolutes.iter().zip(contacts) {
        if let Bearing::Clearance(clearance) = &joint.bearing
            && !(contact.penetration < clearance.bearing_radius)
        {
            let what = if contact.penetration.is_finite() {
                format!("the journal has left its ring by {:.3e} m", contact.penetration)
            } else {
                "the journal's position is not a number".to_owned()
            };
            return Some((format!("joint {}", joint.name), what));
        }
    }
    let body = mechanism.bodies.iter().zip(states).find(|(_, s)| !finite(s));
    body.map(|(b, _)| (b.name.clone(), "position or velocity is not a number".to_owned()))
}
