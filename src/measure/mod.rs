//! Signals as plain numbers: interpolation, filters, thinning, logs.

pub mod envelope;
pub mod filter;
pub mod frames;
pub mod log;
pub mod spelling;
pub mod splice;
pub mod spline;
pub mod student;
