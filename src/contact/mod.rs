//! What happens where a journal touches its bearing: force laws as functions of plain numbers, and
//! the forces that one clearance joint puts on its two bodies.
//!
//! Nothing here knows an engine, a mechanism or a file.

mod film;
mod friction;
mod hertz_step;
mod impact;
mod joint;
pub mod laws;
mod out_of_round;
mod ring_shape;
mod ring_table;
mod stiffness;
mod touch;
mod worn;

use laws::Loss;
use std::sync::Arc;

pub use film::{Extent, Film};
pub use friction::{CoulombFriction, Friction};
pub use hertz_step::{HertzStep, step};
pub use impact::{Impact, Moment, hit, impact};
pub use joint::{Clearance, Contact, Frame, circle_in_ring, valid_penetration};
pub use out_of_round::OutOfRound;
pub use ring_shape::RingShape;
pub use ring_table::{FEWEST_SAMPLES, RingTable};
pub use stiffness::{Material, StiffnessForm, corner_stiffness, hertz_stiffness, power_force};
pub use touch::{After, SLOWEST_IMPACT, Touch};
pub use worn::Play;

/// Normal force of a contact as a function of how deep and how fast the surfaces interpenetrate.
///
/// A law sees plain numbers only, so that any engine can ask it and any test can tabulate it.
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

    /// The same force in a hit that began at `impact_speed` m/s, above 0 (see [`Touch`]).
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
