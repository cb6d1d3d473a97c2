//! Why the study has no files.

use crate::results::RunError;
use crate::scenario::{Problem, Problems};

/// Why the study has no files.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// Something is wrong with the scenario or one of its variants.
    #[error(transparent)]
    Scenario(#[from] Problems),
    /// A file cannot be written.
    #[error(transparent)]
    Files(#[from] RunError),
}

impl From<Problem> for PaperError {
    fn from(problem: Problem) -> Self {
        Problems::from(problem).into()
    }
}
