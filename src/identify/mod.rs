//! Parameters of a driven slide from a recording of it, by its inverse model.

pub mod inverse;
pub mod plausible;
pub mod recorded;
pub mod stage;

pub use recorded::{Missing, Recorded};
