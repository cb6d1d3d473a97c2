//! How much each journal rubs on its ring, and where: what wear follows from.

use crate::engine::stepping::stepper::Stepper;
use crate::mechanism::Mechanism;
use std::f64::consts::TAU;

/// Directions round a ring in which rubbing is counted, the first along the x axis of the ring's body: one a degree,
/// a tenth of the arc over which a journal touches a ring that has worn by a hundredth of its clearance.
pub const WEAR_DIRECTIONS: usize = 360;

/// `∫ F_N |v_t| dt` of each joint in J, by the direction of the surface's normal: normal force times sliding distance.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Rubbing {
    /// One list of [`WEAR_DIRECTIONS`] for each revolute joint.
    pub around: Vec<Vec<f64>>,
    /// Direction (rad) and power (W) at the instant before, where journals touched.
    before: Vec<Option<[f64; 2]>>,
}

impl Rubbing {
    /// Nothing yet.
    pub fn new(mechanism: &Mechanism) -> Self {
        let joints = mechanism.revolutes.len();
        Self { around: vec![vec![0.0; WEAR_DIRECTIONS]; joints], before: vec![None; joints] }
    }

    /// Counts the `dt` s that end at the present instant of `stepper`: by the trapezoidal rule, or as a way of stepping that
    /// integrates the work itself knows. What a journal did between two instants is shared by the places where it was
    /// at both, in proportion to the powers there.
    pub fn count(&mut self, mechanism: &Mechanism, stepper: &dyn Stepper, dt: f64) {
        let (states, now) = (stepper.states(), stepper.evaluation());
        let slid = stepper.slid();
        for (j, (joint, contact)) in mechanism.revolutes.iter().zip(&now.contacts).enumerate() {
            let is = joint.rubbing(states, contact);
            let was = std::mem::replace(&mut self.before[j], is);
            let ends = [was, is].map(|end| end.unwrap_or_default());
            let trapezoid = ends.map(|[_, power]| 0.5 * power * dt);
            let both = trapezoid[0] + trapezoid[1];
            let around = &mut self.around[j];
            let scale = match slid.map(|slid| slid[j]) {
                // It came and went within the step.
                Some(work) if both == 0.0 && work > 0.0 => {
                    let e = joint.ring.rotation(states).inverse() * contact.eccentricity;
                    spread(around, e.y.atan2(e.x), work);
                    continue;
                }
                Some(work) if both > 0.0 => work / both,
                _ => 1.0,
            };
            for ([direction, _], work) in ends.into_iter().zip(trapezoid) {
                spread(around, direction, scale * work);
            }
        }
    }
}

/// Adds `work` (J) at a direction (rad), shared by the two places next to it.
fn spread(around: &mut [f64], direction: f64, work: f64) {
    if work == 0.0 {
        return;
    }
    let n = around.len();
    let place = (direction / TAU * n as f64).rem_euclid(n as f64);
    let share = place.fract();
    around[place as usize % n] += work * (1.0 - share);
    around[(place as usize + 1) % n] += work * share;
}
