//! Parameters of one joint from a recording of it alone: a driven slide by its inverse model, an arm by
//! its free swings.

pub mod inverse;
pub mod plausible;
pub mod swings;
