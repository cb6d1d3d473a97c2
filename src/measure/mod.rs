//! Signals as plain numbers: interpolation, filters, thinning, logs, and the files that they come from.

pub mod bounded;
pub mod dialect;
pub mod envelope;
pub mod filter;
pub mod frames;
pub mod log;
pub mod shown;
pub mod spelling;
pub mod splice;
pub mod spline;
pub mod student;
