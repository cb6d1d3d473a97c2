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
