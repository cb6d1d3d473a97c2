//! What a way of stepping has to do for a run.

use super::energy::Exchange;
use super::looks::Looks;
use crate::mechanism::{BodyState, Evaluation, Mechanism};

/// A way of stepping. The driver asks it for a step, for the instant at which that ended, and for rows between the
/// step's ends, in turn.
pub(in crate::engine) trait Stepper {
    /// Makes the present instant that at which the last step ended, `t` in s.
    fn synchronise(&mut self, mechanism: &Mechanism, t: f64);
    /// Whether steps have to end where rows are; if not, rows are [read](Self::read).
    fn ends_at_rows(&self) -> bool {
        true
    }
    /// Makes the present instant one of the last step, `t` in s: inside it, or its end. The next step goes on from
    /// that end all the same, and is the same step. Ways of stepping that end at rows are asked for their end only.
    fn read(&mut self, _: &Mechanism, _: f64) {}
    /// States at the present instant.
    fn states(&self) -> &[BodyState];
    /// Forces, accelerations, contacts at that instant.
    fn evaluation(&self) -> &Evaluation;
    /// Normal forces inside the last step, where the way of stepping looks there.
    fn looks(&self) -> Option<&Looks> {
        None
    }
    /// What the normal force of each joint took since the last step began, in J, where the way of stepping
    /// integrates it.
    fn joint_work(&self) -> Option<&[f64]> {
        None
    }
    /// Normal force times sliding distance of each joint since the last step began, in J, where the way of stepping
    /// integrates it.
    fn slid(&self) -> Option<&[f64]> {
        None
    }
    /// Lets the sampled controllers that are due compute what they hold from the instant `t` (s) on at which the
    /// last step ended.
    fn sample(&mut self, mechanism: &Mechanism, t: f64, due: &[bool]);
    /// Makes one step from `t`, where the last one ended, of at most `until − t` s; returns the time reached,
    /// exactly `until` if it got there.
    fn advance(&mut self, mechanism: &Mechanism, t: f64, until: f64) -> f64;
    /// Estimated velocity error of the last step in m/s, if there is an estimate.
    fn step_error(&self) -> Option<f64> {
        None
    }
    /// What forces did to the bodies in the last step, where the way of stepping knows them.
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
fn equal_step(step: f64, t: f64, until: f64) -> (f64, f64) {
    let span = until - t;
    let count = (span / step * (1.0 - 1e-9)).ceil().max(1.0);
    let dt = span / count;
    (dt, if count == 1.0 { until } else { t + dt })
}

/// [`equal_step`] on a grid that does not depend on where rows are: steps that mean `step` have exactly that length,
/// and times that mean a decimal are it ([`meant`]).
pub(super) fn even_step(step: f64, t: f64, until: f64) -> (f64, f64) {
    let (dt, reached) = equal_step(step, t, until);
    let dt = if (dt - step).abs() <= 1e-9 * step { step } else { dt };
    (dt, if reached == until { until } else { meant(reached) })
}

/// 0.3 for 0.30000000000000004: the decimal of at most 12 places (1 ps) that a time in s differs from by rounding only,
/// so that the same instant is the same number however it was reached.
pub(in crate::engine) fn meant(t: f64) -> f64 {
    const PLACES: f64 = 1e12;
    let decimal = (t * PLACES).round() / PLACES;
    if (decimal - t).abs() <= 8.0 * f64::EPSILON * t.abs() { decimal } else { t }
}
