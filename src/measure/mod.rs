//! Signals as plain numbers: interpolation, thinning, statistics.

pub mod envelope;
pub mod spline;
