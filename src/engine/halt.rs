//! Why a run cannot go on: impossible states, and steps without end.

use super::account::work::Work;
use super::control::{StepControl, TYPICAL_IMPACT_SPEED};
use crate::contact::{Contact, valid_penetration};
use crate::mechanism::{Bearing, BodyState, Evaluation, Mechanism};

/// Steps that error control may take for a simulated second.
///
/// The paper's machine takes 1.3e4, and 1.2e5 at a tolerance of 1e-9 m/s; with contacts of 1e12 Pa and 1 µm
/// of clearance it takes 1.1e5, and 1.8e6 at that tolerance. Five times as many as the last are no longer a
/// machine that somebody waits for: a simulated second would take minutes.
pub const MOST_STEPS_PER_S: f64 = 1e7;

/// Simulated time in s over which steps are counted: long against any hit (0.3 ms), whose steps are the
/// shortest, and so short that the bound is met after 1e5 steps, a second.
const WINDOW: f64 = 0.01;

/// Likely cause of too many steps, and what to try.
pub(super) const TOO_MANY_STEPS: &str = "likely contacts, drives or dampers too stiff for the masses that they move: try a larger \
     simulation.tolerance, softer ones, or `freeplay check`";

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
    pub work: Box<Work>,
}

/// The first thing that is impossible at an instant, if any: a state that is no number, or a
/// journal farther outside its ring than contacts are understood; of a `row`, also any other figure
/// that is no number.
pub(super) fn impossible(
    mechanism: &Mechanism,
    states: &[BodyState],
    now: &Evaluation,
    row: bool,
) -> Option<String> {
    for (joint, contact) in mechanism.revolutes.iter().zip(&now.contacts) {
        let journal_radius = match &joint.bearing {
            Bearing::Clearance(clearance) => clearance.journal_radius,
            Bearing::Native { journal_radius, .. } => *journal_radius,
            Bearing::Ideal => continue,
        };
        let deepest = valid_penetration(journal_radius);
        if contact.penetration.is_nan() || contact.penetration >= deepest {
            let what = if contact.penetration.is_finite() {
                let parts = if joint.is_corner() {
                    "corner is in its guide"
                } else {
                    "journal has left its ring"
                };
                format!(
                    "the {parts} by {:.3e} m, and contacts are understood up to {deepest:.1e} m in a \
                     joint of its radius",
                    contact.penetration
                )
            } else {
                "the journal's position is not a number".to_owned()
            };
            return Some(format!("joint {}: {what}", joint.name));
        }
    }
    let finite = |s: &BodyState| (s.position.sum() + s.twist.sum()).is_finite();
    let body = mechanism.bodies.iter().zip(states).find(|(_, s)| !finite(s));
    let state = body.map(|(b, _)| format!("{}: position or velocity is not a number", b.name));
    state.or_else(|| if row { no_number(mechanism, now) } else { None })
}

/// The first acceleration or force that is no number, though the states are.
fn no_number(mechanism: &Mechanism, now: &Evaluation) -> Option<String> {
    let accelerations = mechanism.bodies.iter().zip(&now.accelerations);
    let mut bodies = accelerations.filter(|(_, a)| !a.sum().is_finite()).map(|(body, _)| body);
    let drives = mechanism.actuators.iter().zip(&now.drive_forces);
    let mut drives = drives.filter(|(_, effort)| !effort.is_finite()).map(|(drive, _)| drive);
    let contacts = mechanism.revolutes.iter().zip(&now.contacts);
    let force = |contact: &Contact| contact.normal_force + contact.friction_force;
    let mut joints = contacts.filter(|(_, contact)| !force(contact).is_finite());
    let body = bodies.next().map(|body| format!("{}: the acceleration is not a number", body.name));
    let drive = || Some(format!("drive {}: the effort is not a number", drives.next()?.name));
    let joint = || Some(format!("joint {}: the force is not a number", joints.next()?.0.name));
    body.or_else(drive).or_else(joint)
}

/// Why a run may have broken down, and what to try.
pub(super) fn likely_cause(mechanism: &Mechanism, control: StepControl) -> String {
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
        (StepControl::Tolerance(_) | StepControl::Direct(_), _) => "tolerance",
    };
    format!(
        "likely hits far harder than usual, contacts too soft for them, or a machine near a \
         singularity: try a smaller simulation.{key}, or `freeplay check`"
    )
}

/// Counts the steps of one window of simulated time after the other.
#[derive(Debug)]
pub(super) struct Pace {
    /// Steps that a window may take; a fixed step says itself how many there will be.
    most: Option<u64>,
    /// Time at which this window began, in s, and the steps until then.
    since: f64,
    before: u64,
}

impl Pace {
    pub fn new(control: StepControl) -> Self {
        let most = match control {
            StepControl::Fixed(_) => None,
            StepControl::Tolerance(_) | StepControl::Direct(_) => {
                Some((MOST_STEPS_PER_S * WINDOW) as u64)
            }
        };
        Self { most, since: 0.0, before: 0 }
    }

    /// What is wrong, where the run took too many steps to reach `t` (s), all in all `steps`.
    pub fn exceeded(&mut self, t: f64, steps: u64) -> Option<String> {
        let taken = steps - self.before;
        if taken > self.most? {
            return Some(format!(
                "its steps: {taken} of them for the last {:.1e} s, more than {MOST_STEPS_PER_S:.0e} \
                 for a simulated second",
                t - self.since
            ));
        }
        if t - self.since >= WINDOW {
            (self.since, self.before) = (t, steps);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Schedule, run};
    use crate::model::assemble;
    use crate::scenario::Scenario;

    /// Runs the paper's machine with some settings; how it halted, and the largest penetration of a row.
    fn halted(sets: &[&str], duration: f64) -> (Halt, f64) {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let scenario = Scenario::load(None, &sets).expect("right");
        let machine = assemble(&scenario).expect("put together");
        let mut deepest = f64::NEG_INFINITY;
        let schedule = Schedule { duration, interval: 1e-4 };
        let ended = run(&machine.mechanism, machine.control, schedule, &mut |instant| {
            let contacts = instant.evaluation.contacts.iter();
            deepest = contacts.map(|contact| contact.penetration).fold(deepest, f64::max);
        });
        (ended.expect_err("impossible"), deepest)
    }

    /// The bound was the bearing's radius: 10 mm outside the ring, forces of a law that ends at a tenth of
    /// that had long been written as results.
    #[test]
    fn a_journal_that_leaves_its_ring_is_seen_where_its_law_ends() {
        for radius in [0.01, 0.005] {
            let radius_set = format!("joints.bearing_radius={radius}");
            let sets = ["contact.stiffness=10", "contact.c_max=0", &radius_set];
            let (halt, deepest) = halted(&sets, 1.0);
            assert!(halt.what.contains("has left its ring by"), "{halt}");
            let bound = valid_penetration(radius - 5e-4);
            assert!(deepest < bound && deepest > 0.9 * bound, "{deepest:e} of {bound:e} m: {halt}");
        }
    }

    /// It went on at steps of 1 ns for as long as one waited.
    #[test]
    fn steps_without_end_are_ended() {
        let sets = ["contact.c_max=1e8", "contact.d_max=1e-9"];
        let (halt, _) = halted(&sets, 0.2);
        assert!(halt.what.contains("for a simulated second"), "{halt}");
        assert!(halt.work.steps < 10_000_000, "{} steps", halt.work.steps);
    }
}
