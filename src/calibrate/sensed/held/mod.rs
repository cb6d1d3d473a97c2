//! Calibration of machines that sampled controllers hold: without clearance, what controllers ask of their drives
//! recorded beside the motion.
//!
//! Sensors of such machines declare no noise, and far below what any model of friction leaves: residuals in units of
//! noise say nothing. So a value counts by how differently stretches of the recordings pull at it, and an effect by how
//! much better it makes stretches that it was not fitted to. [`mod@bench`] looks at recordings through the machine;
//! [`terms`] says what efforts may be made of, [`candidates`] which terms a machine declares and which may be added;
//! [`model`] fits it, [`judge`] compares models, [`paired`] stretch by stretch; [`search`] is the whole way; [`plausible`]
//! refuses recordings that cannot be right; [`report`] is what is written.

pub mod bench;
pub mod candidates;
pub mod judge;
pub mod model;
pub mod paired;
pub mod plausible;
pub mod report;
pub mod search;
pub mod terms;
