//! What a way of stepping has to do for a run.

use super::energy::Exchange;
use crate::mechanism::{BodyState, Evaluation, Mechanism};

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
    /// Joints whose journals hit and flew again inside the step, touching at neither end; none where steps
    /// are too short for that.
    fn brushes(&self) -> &[bool] {
        &[]
    }
    /// What the normal force of each joint took in the step in J, where the way of stepping integrates it.
    fn joint_work(&self) -> Option<&[f64]> {
        None
    }
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
    /// What forces did to the bodies in the step that ended at the instant last synchronised, where the
    /// way of stepping knows them.
    fn exchange(&self) -> Option<Exchange> {
        None
    }
    /// Whether the last step was taken although its error exceeds the tolerance.
    fn forced(&self) -> bool {
        false
    }
    /// Whether the contact forces of an instant are the means over the step that ended there, and not
    /// those of the instant itself.
    fn mean_forces(&self) -> bool {
        false
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
