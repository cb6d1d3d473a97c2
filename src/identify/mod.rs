//! Parameters of one joint from a recording of it alone: a driven slide by its inverse model, an arm by
//! its free swings.

pub mod arm;
pub mod inverse;
pub mod paired;
pub mod plausible;
pub mod recorded;
pub mod stage;
pub mod swings;

pub use recorded::{Missing, Recorded};
