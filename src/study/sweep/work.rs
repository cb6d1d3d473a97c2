//! A sweep at work: what is not in the journal yet is run, on all threads.

use super::journal::{JOURNAL_FILE, Journal, Rows, lock};
use super::result::{Outcome, PARQUET_FILE, TABLE_FILE, put, refuse_edited_table, write};
use super::row;
use super::{Plan, RECORD_FILE, Record, SweepError};
use crate::simulate::measured;
use crate::study::folder::Folder;
use crate::study::run::{RunError, SCENARIO_FILE, refused};
use rayon::prelude::*;
use std::fs;
use std::io;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Does `work` on so many threads, by default one for each core.
///
/// # Errors
/// [`SweepError::Input`] if the system does not give so many.
pub fn on_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> R + Send,
) -> Result<R, SweepError> {
    // To rayon, zero means one for each core.
    let built = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
    let pool = built.map_err(|error| {
        SweepError::input(format!("cannot start the threads: {error}; give fewer with --threads"))
    })?;
    Ok(pool.install(work))
}

/// Makes the runs of a plan and writes everything about them into the folder `target`. Where that
/// holds a part of the same sweep already, it goes on from there; with `force`, it begins anew.
/// `progress` is told how many rows are there, and of how many.
///
/// # Errors
/// [`SweepError`]; what the folder held stands.
pub fn sweep(
    plan: &Plan,
    target: &Path,
    force: bool,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Outcome, SweepError> {
    let (journal, rows) = open(plan, target, force)?;
    let record = Record::new(plan.identity().clone(), plan.shard(), &rows, target);
    let pending: Vec<usize> =
        plan.shard().runs(plan.identity().runs).filter(|run| !rows.contains_key(run)).collect();
    progress(rows.len(), record.runs_of_shard);
    if !pending.is_empty() {
        // The tables of a sweep that is not complete (as merge leaves one) do not outlive this: they go
        // before the record that vouches for them.
        for table in [TABLE_FILE, PARQUET_FILE] {
            match fs::remove_file(target.join(table)) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    return Err(refused(table)(error).into());
                }
                _ => {}
            }
        }
        put(target, RECORD_FILE, record.to_json())?;
    }
    let state = Mutex::new((journal, rows));
    // One by one: runs differ in cost, and threads that are done take from those that are not.
    pending.par_iter().with_max_len(1).try_for_each(|run| {
        let row = row_of(plan, *run);
        let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
        let (journal, rows) = &mut *state;
        journal.append(*run, &row)?;
        rows.insert(*run, row);
        progress(rows.len(), record.runs_of_shard);
        Ok::<(), RunError>(())
    })?;
    // The journal stays locked until everything is written.
    let (journal, rows) = state.into_inner().unwrap_or_else(PoisonError::into_inner);
    let outcome = write(target, target, plan.identity(), plan.shard(), &rows)?;
    drop(journal);
    Ok(outcome)
}

/// The journal of this sweep in `target`, and the rows that are there.
fn open(plan: &Plan, target: &Path, force: bool) -> Result<(Journal, Rows), SweepError> {
    Folder::mend(target, RECORD_FILE).map_err(RunError::from)?;
    // Held until the journal is replaced: nobody works on what is thrown away.
    let replaced =
        if force && target.join(JOURNAL_FILE).exists() { Some(lock(target)?) } else { None };
    if force || !target.join(RECORD_FILE).exists() {
        create(plan, target, force)?;
    }
    drop(replaced);
    let record = Record::read(target)?;
    let mut differences = record.identity.differences(plan.identity());
    if record.shard != plan.shard() {
        differences.push(format!("--shard {} there, {} here", record.shard, plan.shard()));
    }
    if !differences.is_empty() {
        return Err(SweepError::input(format!(
            "`{}` holds another sweep: {}; choose another folder with --out, or replace it with \
             --force",
            target.display(),
            differences.join("; ")
        )));
    }
    let opened = Journal::open(target, plan.identity(), plan.shard())?;
    refuse_edited_table(target, &record)?;
    Ok(opened)
}

/// Makes the folder of a sweep without rows. It gets its name when record and journal are in it.
fn create(plan: &Plan, target: &Path, force: bool) -> Result<(), SweepError> {
    let folder = Folder::prepare(target, RECORD_FILE, force).map_err(RunError::from)?;
    let record = Record::new(plan.identity().clone(), plan.shard(), &Rows::new(), target);
    let put = |name, text: &str| put(folder.path(), name, text);
    put(RECORD_FILE, &record.to_json())?;
    put(JOURNAL_FILE, "")?;
    put(SCENARIO_FILE, &plan.base().to_toml())?;
    folder.finish().map_err(RunError::from)?;
    Ok(())
}

/// Makes run `run`.
fn row_of(plan: &Plan, run: usize) -> Vec<String> {
    match plan.machine(run) {
        Ok((scenario, mut machine)) => {
            let summary = measured(&scenario, &mut machine, &mut |_, _, _| {});
            row::of_summary(plan.values(run), &summary, plan.more())
        }
        Err(reason) => row::refused(plan.values(run), &reason, plan.more()),
    }
}
