//! What a run took.

use crate::engine::stepping::energy::Energy;
use crate::engine::stepping::stepper::Stepper;

/// What a run took.
///
/// [`run`](crate::engine::run()) has an example.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// Whether it was told to stop before its end.
    pub stopped: bool,
    /// Steps that were taken although their error exceeded the tolerance: near singular poses shorter ones
    /// win nothing.
    pub forced_steps: u64,
    /// How far rigid joints had come apart in a row, in m.
    pub drift: f64,
    /// Where the energy went, up to the end of the step that reached the last row; none where nobody asked ([`run_balanced`](crate::engine::run_balanced)), and of native contacts, whose forces are known as impulses only.
    pub energy: Option<Energy>,
    /// Normal force times sliding distance in J, of each revolute joint, in [`WEAR_DIRECTIONS`](crate::engine::WEAR_DIRECTIONS)
    /// directions of the ring's surface from the x axis of its body on; none where nobody asked ([`run_balanced`](crate::engine::run_balanced)), and
    /// nothing but zeros in joints without a contact law.
    pub rubbed: Option<Vec<Vec<f64>>>,
}

impl Work {
    /// Counts a step of `dt` s that reached `t`.
    pub(in crate::engine) fn step(&mut self, dt: f64, t: f64, stepper: &dyn Stepper) {
        self.steps += 1;
        self.reached = t;
        self.smallest_step = self.smallest_step.min(dt);
        self.largest_step = self.largest_step.max(dt);
        self.forced_steps += u64::from(stepper.forced());
        if let Some(error) = stepper.step_error() {
            self.step_error = Some(self.step_error.map_or(error, |worst| worst.max(error)));
        }
    }
}
