//! Why a study has no result.

use crate::report::ReportError;
use crate::results::RunError;
use crate::scenario::{Problem, Problems};
use std::path::PathBuf;

/// Why a study has no result, or not all of it.
///
/// ```
/// use freeplay::study::StudyError;
/// use freeplay::study::sweep::Vary;
///
/// let wrong = Vary::parse("joints.clearance=1e-4..").unwrap_err();
/// assert!(matches!(&wrong, StudyError::Input(what) if what.contains("joints.clearance")));
/// ```
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// Wrong input: what, where, what would be right.
    #[error("{0}")]
    Input(String),
    /// The folder holds the rows of another sweep.
    #[error("{0}")]
    Another(String),
    /// A scenario is wrong, or has something that cannot be studied.
    #[error(transparent)]
    Scenario(#[from] Problems),
    /// A file cannot be written.
    #[error(transparent)]
    Files(#[from] RunError),
    /// The run broke down, does not balance, or has no such figure.
    #[error("{0}")]
    Failed(String),
    /// The run was told to stop.
    #[error("the run was interrupted")]
    Stopped,
    /// A sweep was told to end before its last row; its journal stands.
    #[error(
        "{finished} of {runs} rows are kept in `{folder}`; the same command goes on from there",
        folder = folder.display()
    )]
    Interrupted {
        /// Rows that are there.
        finished: usize,
        /// Rows that there will be.
        runs: usize,
        /// Where they are kept.
        folder: PathBuf,
    },
    /// A run broke down on the way to these cycles of wear.
    #[error("after {cycles:.3e} cycles: {reason}")]
    Halted {
        /// Cycles until then.
        cycles: f64,
        /// Why.
        reason: String,
    },
    /// Jumps over cycles of wear became too short to come to an end.
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

impl StudyError {
    pub(super) fn input(message: impl Into<String>) -> Self {
        StudyError::Input(message.into())
    }
}

impl From<Problem> for StudyError {
    fn from(problem: Problem) -> Self {
        Problems::from(problem).into()
    }
}

impl From<ReportError> for StudyError {
    fn from(error: ReportError) -> Self {
        StudyError::Files(error.into())
    }
}
