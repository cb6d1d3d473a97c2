//! From a scenario to what the engine needs, and from what the engine hands out to rows and a
//! summary.
//!
//! [`assemble`] makes a [`Machine`] of a scenario; [`findings`] says what is wrong or doubtful about
//! it before anything is simulated; [`TimeSeries`] and [`Recorder`] take the instants of a run, one
//! by one and in constant memory.

mod assemble;
mod checks;
mod drive_stage;
mod ideal;
mod motion;
mod native;
mod pendulum;
mod provenance;
mod summary;
mod three_rpr;
mod timeseries;

pub use assemble::{Machine, assemble, close, drive, driven, radial_clearance, started};
pub use checks::{Finding, Severity, findings};
pub use ideal::{Ideal, IdealInstant};
pub use native::FIT_SPEED;
pub use provenance::Provenance;
pub use summary::{JointSummary, Recorder, Summary};
pub use three_rpr::leg_use;
pub use timeseries::TimeSeries;
