//! From a scenario to what the engine needs, and from what the engine hands out to rows and a
//! summary.
//!
//! [`assemble`] makes a [`Machine`] of a scenario; [`findings`] says what is wrong or doubtful about
//! it before anything is simulated (`beforehand`); [`TimeSeries`] and [`Recorder`] take the instants of a run, one
//! by one and in constant memory.

mod beforehand;
mod measured;
mod provenance;
mod summary;
mod timeseries;
mod watched;

pub use crate::model::{
    FIT_SPEED, Ideal, IdealInstant, Machine, assemble, close, drive, driven, leg_use,
    radial_clearance,
};
pub use beforehand::checks::{doubts, driven_path, findings, findings_along};
pub use beforehand::finding::{Finding, Severity};
pub use beforehand::idle::neutral;
pub use beforehand::unacting::unacting;
pub use measured::{listed_until, measured, measured_until};
pub use provenance::Provenance;
pub use summary::{JointSummary, Recorder, Summary};
pub use timeseries::{RowColumns, TimeSeries};
pub use watched::{Balance, OwnError, Watched};
