//! What a joint remembers of its present contact, for laws that ask how fast the hit began.

/// Slowest impact speed δ̇⁻ in m/s that a law is told. Laws with a restitution divide by it, so that a contact
/// that begins at rest would be damped without bound: at 1e-3 m/s a load of 10 N meets about 1e4 N·s/m, which
/// steps of some µs still resolve. Slower hits return more than asked, as those of real metals do, which stay
/// elastic below some cm/s (K. L. Johnson, *Contact Mechanics*, 1985, §11.5).
pub const SLOWEST_IMPACT: f64 = 1e-3;

/// Halvings of a step in which the instant of touching is sought: to 1e-12 of the step.
const HALVINGS: usize = 40;

/// State of a contact at the end of the last accepted step. It changes at accepted steps only: whatever is
/// tried, repeated or looked back at within a step is judged from the same memory.
///
/// ```
/// use freeplay::contact::Touch;
///
/// // A journal that came in at 0.2 m/s is slower at the deepest point; the hit is still one of 0.2 m/s.
/// let touched = Touch::begin(-1e-6, 0.2).after(1e-5).reached(1e-6, 0.2);
/// let deepest = touched.after(1e-5).reached(2e-6, 0.01);
/// assert!((deepest.after(1e-6).impact_speed(2e-6, 0.0) - 0.2).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    /// Penetration δ in m, negative in flight.
    penetration: f64,
    /// Its rate δ̇ in m/s.
    rate: f64,
    /// Fastest approach since the surfaces touched in m/s; 0 in flight.
    impact_speed: f64,
    /// How far bristles between the surfaces have bent, in m, and how fast the surfaces slide, in m/s: of friction that
    /// remembers.
    pub(super) bent: f64,
    pub(super) sliding: f64,
}

/// A [`Touch`] and the time in s that has passed since.
#[derive(Clone, Copy, Debug)]
pub struct After {
    /// What is remembered.
    pub touch: Touch,
    /// Time since then in s.
    pub elapsed: f64,
}

impl Touch {
    /// The memory of a run that begins with penetration δ (m) and rate δ̇ (m/s).
    pub fn begin(penetration: f64, rate: f64) -> Self {
        let flying = Touch { penetration: penetration.min(0.0), rate, ..Touch::default() };
        flying.after(0.0).reached(penetration, rate)
    }

    /// This memory, `elapsed` s later.
    pub fn after(self, elapsed: f64) -> After {
        After { touch: self, elapsed }
    }
}

impl After {
    /// Impact speed δ̇⁻ in m/s of a contact that now has penetration δ > 0 (m) and rate δ̇ (m/s).
    ///
    /// Where the last step ended in flight, the surfaces touched since: δ̇⁻ is the slope of the cubic through
    /// both states and their rates (Hermite) where it crosses zero. A contact that lasts keeps its δ̇⁻; one
    /// that a load drives inward faster than it began takes the larger rate, so that `δ̇/δ̇⁻ ≤ 1` always. Never
    /// below [`SLOWEST_IMPACT`].
    pub fn impact_speed(&self, penetration: f64, rate: f64) -> f64 {
        let begun = if self.touch.impact_speed > 0.0 {
            self.touch.impact_speed
        } else {
            self.crossing_rate(penetration, rate)
        };
        begun.max(rate).max(SLOWEST_IMPACT)
    }

    /// What is remembered from now on, with the penetration (m) and rate (m/s) that a step has reached.
    pub fn reached(&self, penetration: f64, rate: f64) -> Touch {
        let touching = penetration > 0.0;
        let impact_speed = if touching { self.impact_speed(penetration, rate) } else { 0.0 };
        Touch { penetration, rate, impact_speed, ..Touch::default() }
    }

    /// How much of the time since then surfaces have touched that now have the penetration δ > 0 (m), in s: those that
    /// flew then touched when a straight line through both penetrations does.
    pub(super) fn touching(&self, penetration: f64) -> f64 {
        let before = self.touch.penetration;
        let share = if before < 0.0 { penetration / (penetration - before) } else { 1.0 };
        share * self.elapsed
    }

    fn crossing_rate(&self, penetration: f64, rate: f64) -> f64 {
        let h = self.elapsed;
        if h <= 0.0 {
            return rate;
        }
        let [d0, r0, d1, r1] = [self.touch.penetration, self.touch.rate * h, penetration, rate * h];
        // δ = d0 + s (r0 + s (b + s a)), s from 0 to 1 over the step.
        let (a, b) = (2.0 * (d0 - d1) + r0 + r1, 3.0 * (d1 - d0) - 2.0 * r0 - r1);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let s = 0.5 * (low + high);
            if d0 + s * (r0 + s * (b + s * a)) > 0.0 { high = s } else { low = s }
        }
        (r0 + high * (2.0 * b + high * 3.0 * a)) / h
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impact_speed_is_the_rate_at_touching() {
        // δ = −1e-6 + 0.1 t − 1000 t², which Hermite's interpolation has exactly.
        let (h, at) = (3e-5f64, |t: f64| (-1e-6 + 0.1 * t - 1e3 * t * t, 0.1 - 2e3 * t));
        let (start, now) = (at(0.0), at(h));
        let memory = Touch::begin(start.0, start.1).after(h);
        let touched = (0.1 - (0.01f64 - 4e-3).sqrt()) / 2e3;
        let speed = memory.impact_speed(now.0, now.1);
        assert!((speed / at(touched).1 - 1.0).abs() < 1e-10, "{speed}");
        // An approach that quickens counts with its fastest rate.
        assert_eq!(memory.impact_speed(now.0, 0.3), 0.3);
    }

    #[test]
    fn memory_does_not_depend_on_what_was_tried() {
        let memory = Touch::begin(-1e-6, 0.1).after(2e-5);
        let first = memory.reached(9e-7, 0.09);
        for tried in [1e-8, 5e-7, -1e-7] {
            let _ = memory.impact_speed(tried, 0.2);
        }
        assert_eq!(memory.reached(9e-7, 0.09), first);
        // A contact that lasts keeps it; the end of the contact forgets it.
        let later = first.after(1e-5);
        assert_eq!(later.impact_speed(1e-6, -0.05), first.impact_speed);
        assert_eq!(later.reached(-1e-9, -0.08).impact_speed, 0.0);
    }

    #[test]
    fn a_contact_at_rest_has_the_slowest_impact() {
        let resting = Touch::begin(1e-7, 0.0);
        assert_eq!(resting.after(1.0).impact_speed(1e-7, 0.0), SLOWEST_IMPACT);
        assert_eq!(resting.after(1.0).impact_speed(1e-7, 0.3), 0.3);
    }
}
