//! Why work with results on the disk has none.

use super::folder::FolderError;
use super::forecast::Forecast;
use crate::report::ReportError;
use std::io;

/// Why a run has no files.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A file cannot be written.
    #[error("cannot write {file}: {source}")]
    File {
        /// Its name.
        file: String,
        /// Why.
        source: io::Error,
    },
    /// It was told to stop, and an earlier result is worth more than the part of a new one.
    #[error("the run was interrupted; the earlier result stands")]
    Dropped,
    /// It would take long or write much, and nobody said that this is meant.
    #[error(
        "the run would {0}, judged by its beginning; say --yes if that is meant, or change --duration, \
         simulation.output_interval (rows) or simulation.tolerance (steps)"
    )]
    TooMuch(Forecast),
    /// Many runs would take long, and nobody said that this is meant.
    #[error(
        "this would {0}, judged by its beginning; say --yes if that is meant, or take fewer or shorter runs, or a larger \
         simulation.tolerance"
    )]
    TooLong(Forecast),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Picture(#[from] ReportError),
    /// The folder cannot get its name.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// What becomes of an error of the file system about `file`.
pub(crate) fn refused(file: &str) -> impl FnOnce(io::Error) -> RunError {
    let file = file.to_owned();
    |source| RunError::File { file, source }
}
