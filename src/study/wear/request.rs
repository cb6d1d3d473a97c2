//! What a prediction of wear is asked for, and why there may be none.

use crate::report::ReportError;
use crate::results::RunError;
use crate::scenario::Problem;

/// What is to be predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearRequest {
    /// How many cycles.
    pub cycles: f64,
    /// Time of one cycle in s.
    pub period: f64,
    /// Largest error of a jump over cycles, as a share of a joint's clearance.
    pub tolerance: f64,
}

/// Why a prediction has no files.
#[derive(Debug, thiserror::Error)]
pub enum WearError {
    /// The scenario has something that wear cannot be predicted of.
    #[error(transparent)]
    Problem(#[from] Problem),
    /// A file cannot be written.
    #[error(transparent)]
    Files(#[from] RunError),
    /// A run broke down on the way.
    #[error("after {cycles:.3e} cycles: {reason}")]
    Halted {
        /// Cycles until then.
        cycles: f64,
        /// Why.
        reason: String,
    },
    /// Jumps became too short to come to an end.
    #[error(
        "after {cycles:.3e} cycles jumps of {jump:.1e} cycles still err by more than the tolerance: what is rubbed \
         differs too much from run to run; try a longer --duration, or a larger --tolerance"
    )]
    TooShort {
        /// Cycles until then.
        cycles: f64,
        /// Length of the jump that was tried.
        jump: f64,
    },
}

impl From<ReportError> for WearError {
    fn from(error: ReportError) -> Self {
        WearError::Files(error.into())
    }
}
