//! Models of published recordings of real hardware: a driven slide and a pendulum, the two kinds of
//! joint that a 3-RPR is made of. The recordings are not part of this project; they are read from a
//! folder of the user's.

pub mod emps;
mod page;
pub mod pendulum;

pub use page::{STUDY_FILE, emps_page, pendulum_page};

use crate::measure::log::LogError;
use std::path::{Path, PathBuf};

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Missing {
    /// The recording is not there.
    #[error("{0} is not there")]
    Absent(PathBuf),
    /// It is there, and not what it should be.
    #[error(transparent)]
    Log(#[from] LogError),
    /// Anything else.
    #[error("{0}")]
    Wrong(String),
}

/// Environment variable that says where the recordings are.
pub const VARIABLE: &str = "FREEPLAY_MEASURED";

/// Where they are sought without it.
const DEFAULT_FOLDER: &str = "../shared/measured";

/// The folder of the recordings: as given, as the environment says, or the default.
pub fn folder(given: Option<&Path>) -> PathBuf {
    let given = given.map(Path::to_owned);
    given
        .or_else(|| std::env::var_os(VARIABLE).map(PathBuf::from))
        .unwrap_or_else(|| DEFAULT_FOLDER.into())
}

/// What is said where recordings are not there.
pub fn skipped(what: &str, missing: &Path) -> String {
    format!(
        "skipped: data not present ({} is missing). {what} Put it there, or say with --data or \
         {VARIABLE} where it is.",
        missing.display()
    )
}

/// A table of results.
#[derive(Clone, Debug)]
pub struct ResultsTable {
    /// Heads of the columns.
    pub header: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}
