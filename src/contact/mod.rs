//! What happens where a journal touches its bearing: force laws as functions of plain numbers, and
//! the forces that one clearance joint puts on its two bodies.
//!
//! `clearance` is the geometry of a round journal in a round ring, `rings` that of other rings; [`laws`] is the list of force laws.
//! Nothing here knows an engine, a mechanism or a file.

mod clearance;
mod film;
mod force_law;
mod friction;
mod hertz_step;
mod impact;
pub mod laws;
mod rings;
mod step;
mod stiffness;
mod touch;

pub use clearance::{Clearance, Contact, Frame, circle_in_ring, valid_penetration};
pub use film::{Extent, Film};
pub use force_law::ForceLaw;
pub use friction::{CoulombFriction, Friction};
pub use hertz_step::HertzStep;
pub use impact::{Impact, Moment, hit, impact};
pub use rings::out_of_round::OutOfRound;
pub use rings::ring_shape::RingShape;
pub use rings::ring_table::{FEWEST_SAMPLES, RingTable};
pub use rings::worn::Play;
pub use step::step;
pub use stiffness::{Material, StiffnessForm, corner_stiffness, hertz_stiffness, power_force};
pub use touch::{After, SLOWEST_IMPACT, Touch};
