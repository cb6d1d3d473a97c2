//! The next step: the forces on the path that is predicted, and how long it may be.

use super::{Adaptive, NODES};
use crate::mechanism::{Mechanism, Situation};
use nalgebra::Vector3;

/// Shortest step in s that error control asks for where rigid joints are nearly singular. Joints that are
/// closed but for rounding ε at a distance c (rad) from such a pose leave a velocity of `ε ω/c²`: a shorter
/// step ends closer to the pose, and loses more than it wins.
const SINGULAR_STEP: f64 = 2e-5;

impl Adaptive {
    /// Makes `path` the forces at `t + tau` on the predicted path.
    #[inline]
    pub(super) fn look(&mut self, mechanism: &Mechanism, t: f64, tau: f64) {
        for (i, point) in self.path_states.iter_mut().enumerate() {
            *point = self.states[i].moved(self.now.accelerations[i], self.jerks[i], tau);
        }
        self.dynamics.forces_on_path(mechanism, t + tau, &self.path_states, &mut self.path);
        if self.coupled {
            self.dynamics.accelerations(mechanism, &self.path_states, &mut self.path);
            self.dynamics.replace_wrenches(&mut self.path);
        }
    }

    /// The next step, predicted; shortened until it is accurate: its length and where it ends, s. No sliver is left before
    /// the end: a prescribed drive would get an endless force.
    #[inline]
    pub(super) fn next_step(&mut self, mechanism: &Mechanism, t: f64, until: f64) -> (f64, f64) {
        let span = until - t;
        let at =
            Situation { t: mechanism.epoch + t, mechanism, states: &self.states, angles: None };
        let loads = mechanism.loads.iter().filter_map(|load| load.longest_step_at(at));
        let contacts = self.dynamics.longest_contact_step(mechanism, &self.now.contacts);
        let longest = loads.fold(self.longest.min(contacts), f64::min);
        let mut h = self.next_length.min(longest);
        loop {
            let last = h >= span * (1.0 - 1e-9);
            if last {
                h = span;
            } else if h > 0.5 * span {
                h = 0.5 * span;
            }
            self.look_ahead(mechanism, t, h);
            let ratio = (self.tolerance / self.step_error).sqrt().sqrt();
            // Infinite where nothing acts, NaN where the state is none: both end here.
            if ratio.is_nan() || ratio >= 0.9 {
                self.next_length = (h * (0.9 * ratio).clamp(0.3, 2.0)).min(longest);
                return (h, if last { until } else { t + h });
            }
            // Shorter steps do not help against the errors of a nearly singular pose.
            if self.coupled && self.dynamics.was_singular() {
                if h <= SINGULAR_STEP {
                    self.forced = true;
                    self.next_length = h;
                    return (h, if last { until } else { t + h });
                }
                h = (h * (0.85 * ratio).max(0.2)).max(SINGULAR_STEP);
                continue;
            }
            h *= (0.85 * ratio).max(0.2);
        }
    }

    /// Forces on a step of `h` s: the forward part of their average, what a cubic cannot follow, and the step's error.
    #[inline]
    fn look_ahead(&mut self, mechanism: &Mechanism, t: f64, h: f64) {
        let root5 = 5.0 * 5f64.sqrt();
        for i in 0..self.states.len() {
            self.errors[i] = self.now.wrenches[i] * -5.0;
            self.forward[i] = self.now.wrenches[i];
        }
        for (s, sign) in NODES.into_iter().zip([1.0, -1.0]) {
            self.look(mechanism, t, s * h);
            for i in 0..self.states.len() {
                self.errors[i] += self.path.wrenches[i] * (sign * root5);
                self.forward[i] += self.path.wrenches[i] * (5.0 * (1.0 - s));
            }
        }
        self.look(mechanism, t, h);
        for i in 0..self.states.len() {
            self.errors[i] += self.path.wrenches[i] * 5.0;
            self.forward[i] *= h / 12.0;
        }
        self.dynamics.accelerations(mechanism, &self.path_states, &mut self.path);
        self.ends.copy_from_slice(&self.path.accelerations);
        self.step_error = self.error(h);
    }

    /// Error in m/s of a step `h`: the part of the force that a cubic cannot follow, and a guard
    /// against ends of the path where the acceleration jumps.
    fn error(&self, h: f64) -> f64 {
        let mut worst = 0.0f64;
        for (i, m) in self.dynamics.inverse_masses().iter().enumerate() {
            let size = |a: Vector3<f64>| {
                // An angular speed counts with the radius of gyration √(I/m).
                (a.xy().norm_squared() + a.z * a.z * m.x / m.z).sqrt()
            };
            worst = worst.max(size(self.errors[i].component_mul(m)) / 20.0);
            let a = self.now.accelerations[i];
            worst = worst.max(0.01 * size(self.ends[i] - a - self.jerks[i] * h));
        }
        worst * h
    }
}
