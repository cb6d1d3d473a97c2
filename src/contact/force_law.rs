//! What every force law answers.

use super::laws::Loss;
use std::sync::Arc;

/// Normal force of a contact as a function of how deep and how fast the surfaces interpenetrate.
///
/// A law sees plain numbers only, so that any engine can ask it and any test can tabulate it.
///
/// ```
/// use freeplay::contact::laws::{Given, named};
///
/// // Laws of the literature by name, here for a joint of the built-in machine.
/// let law = (named("hunt-crossley").unwrap().build)(&Given::default());
/// let [resting, approaching] = [0.0, 0.1].map(|rate| law.normal_force(1e-6, rate));
/// assert!(approaching > resting, "a law with damping pushes harder while surfaces approach");
/// assert!(law.longest_step(0.1, 0.1) < law.contact_time(0.1, 0.1));
/// ```
pub trait ForceLaw: std::fmt::Debug + Send + Sync {
    /// Normal force in N, positive when the surfaces push each other apart.
    ///
    /// `penetration` δ in m (only asked for δ > 0), `rate` δ̇ in m/s, positive while approaching. Of a law
    /// that [`remembers`](Self::remembers), the force of a hit that begins at this rate.
    fn normal_force(&self, penetration: f64, rate: f64) -> f64;

    /// Whether the force depends on how fast the hit began.
    fn remembers(&self) -> bool {
        false
    }

    /// The same force in a hit that began at `impact_speed` m/s, above 0 (see [`Touch`](super::Touch)).
    fn normal_force_after(&self, penetration: f64, rate: f64, _impact_speed: f64) -> f64 {
        self.normal_force(penetration, rate)
    }

    /// Damping ∂F/∂δ̇ in N·s/m of a law that remembers, at a penetration in a hit that began at `impact_speed`.
    fn damping(&self, _penetration: f64, _impact_speed: f64) -> f64 {
        0.0
    }

    /// Deepest penetration in m of a lossless hit of `mass` kg at `speed` m/s.
    fn deepest_penetration(&self, mass: f64, speed: f64) -> f64;

    /// Duration in s of that hit.
    fn contact_time(&self, mass: f64, speed: f64) -> f64;

    /// Stiffness K in N/mⁿ of a law whose elastic force is `K δⁿ`.
    fn stiffness(&self) -> Option<f64> {
        None
    }

    /// Deepest penetration in m up to which the law's formula holds, where it has such an end.
    fn valid_depth(&self) -> Option<f64> {
        None
    }

    /// Largest ratio of the radial clearance to the ring's radius up to which the law's assumptions hold, where it has
    /// such an end.
    fn valid_clearance(&self) -> Option<f64> {
        None
    }

    /// Penetration in m at which a contact at rest bears `force` N.
    fn resting_penetration(&self, force: f64) -> f64;

    /// The longest step in s (fixed step, explicit) that resolves a hit of `mass` kg at `speed`
    /// m/s under this law. Users are told when their step is longer.
    fn longest_step(&self, mass: f64, speed: f64) -> f64;

    /// The same law with its damping times `factor`, or `None` for a law whose damping does not scale.
    fn damped(&self, _factor: f64) -> Option<Arc<dyn ForceLaw>> {
        None
    }

    /// The law with the same elastic force and another loss, or `None` for a law without an elastic force of its own.
    fn losing(&self, _loss: Loss) -> Option<Arc<dyn ForceLaw>> {
        None
    }
}
