//! From a scenario to what the engine needs, and from what the engine hands out to rows and a
//! summary.
//!
//! [`assemble`] makes a [`Machine`] of a scenario; [`findings`] says what is wrong or doubtful about
//! it before anything is simulated; [`TimeSeries`] and [`Recorder`] take the instants of a run, one
//! by one and in constant memory.

mod bodies;
mod checks;
mod conformal;
mod finding;
mod idle;
mod instruments;
mod measured;
mod oil;
mod plausible;
mod provenance;
mod restraints;
mod summary;
mod three_rpr;
mod timeseries;
mod unacting;
mod watched;

pub use crate::model::{
    FIT_SPEED, Ideal, IdealInstant, Machine, assemble, close, drive, driven, leg_use,
    radial_clearance,
};
pub use checks::{doubts, driven_path, findings, findings_along};
pub use finding::{Finding, Severity};
pub use idle::neutral;
pub use measured::{measured, measured_until};
pub use provenance::Provenance;
pub use summary::{JointSummary, Recorder, Summary};
pub use timeseries::{Columns, TimeSeries};
pub use unacting::unacting;
pub use watched::{Balance, OwnError, Watched};
