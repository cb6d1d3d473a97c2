//! Many variants of one scenario: planned, run in parallel, journalled, tabulated.
//!
//! ```text
//! --vary ─► Vary ─► Design ─► Plan ─► runs ─► rows.jsonl ─► sweep.csv · pictures · page
//! ```
//! Everything about run n follows from n: its values from the design, its figures from a simulation
//! that knows nothing of the others. So neither threads nor shards nor interruptions show in the
//! table, and the journal, one line a finished run in whatever order they finish, is all the state
//! there is. `varied` holds what is varied, `rows` everything about rows on the disk.

mod doubts;
mod forecast;
mod merge;
mod plan;
mod result;
mod rows;
mod shard;
mod standing;
mod varied;
mod work;

pub(super) use rows::row;

pub use forecast::{SweepForecast, forecast};
pub use merge::merge;
pub use plan::Plan;
pub use result::SweepOutcome;
pub use rows::record::{Identity, RECORD_FILE, Record};
pub use shard::Shard;
pub use standing::Standing;
pub use varied::design::Design;
pub use varied::vary::{Range, Values, Vary};
pub use work::{Ongoing, on_threads, sweep};

use crate::results::RunError;
use crate::scenario::Problems;
use std::path::PathBuf;

/// Why a sweep has no result, or not all of it. What the journal holds stands.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// Wrong input: what, where, what would be right.
    #[error("{0}")]
    Input(String),
    /// The folder holds the rows of another sweep.
    #[error("{0}")]
    Another(String),
    /// The scenario that is varied is wrong.
    #[error(transparent)]
    Scenario(#[from] Problems),
    /// Files cannot be written.
    #[error(transparent)]
    Write(#[from] RunError),
    /// It was told to end before its last row.
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
}

impl SweepError {
    fn input(message: impl Into<String>) -> Self {
        SweepError::Input(message.into())
    }
}
