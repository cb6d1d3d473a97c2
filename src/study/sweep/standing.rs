//! How far a part of a sweep has come, seen from outside: nothing is made, changed or locked for long.

use super::rows::journal::{self, lock};
use super::work::refuse_other;
use super::{Plan, RECORD_FILE, Record, Shard};
use crate::study::StudyError;
use std::path::Path;

/// How far a part of a sweep has come.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Standing {
    /// Runs of it that have no row.
    pub missing: Vec<usize>,
    /// Whether its table is written, too.
    pub complete: bool,
    /// Whether a process is at work on it.
    pub busy: bool,
}

impl Standing {
    /// That of part `shard` of a plan, whose folder is `target` if it has begun.
    ///
    /// # Errors
    /// [`StudyError`] if the folder holds another sweep, or is damaged.
    pub fn of(plan: &Plan, shard: Shard, target: &Path) -> Result<Standing, StudyError> {
        let identity = plan.identity();
        if !target.join(RECORD_FILE).exists() {
            let missing = shard.runs(identity.runs).collect();
            return Ok(Standing { missing, complete: false, busy: false });
        }
        let record = Record::read(target)?;
        refuse_other(&record, identity, shard, target)?;
        let rows = journal::read(target, identity, shard)?;
        let missing = shard.runs(identity.runs).filter(|run| !rows.contains_key(run)).collect();
        Ok(Standing { missing, complete: record.complete, busy: lock(target).is_err() })
    }
}
