//! A sweep at work: what is not in the journal yet is run, on all threads.

use super::result::{PARQUET_FILE, SweepOutcome, TABLE_FILE, put, refuse_edited_table, write};
use super::rows::journal::{JOURNAL_FILE, Journal, RunRows, kept, lock};
use super::{Identity, Plan, RECORD_FILE, Record, Shard};
use crate::results::Folder;
use crate::results::SCENARIO_FILE;
use crate::results::{RunError, refused};
use crate::study::StudyError;
use rayon::prelude::*;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Does `work` on so many threads, by default one for each core.
///
/// # Errors
/// [`StudyError::Input`] if the system does not give so many.
pub fn on_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> R + Send,
) -> Result<R, StudyError> {
    // To rayon, zero means one for each core.
    let built = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
    let pool = built.map_err(|error| {
        StudyError::input(format!("cannot start the threads: {error}; give fewer with --threads"))
    })?;
    Ok(pool.install(work))
}

/// Makes the runs of a plan and writes everything about them into the folder `target`. Where that
/// holds a part of the same sweep already, it goes on from there; with `force`, it begins anew.
/// `progress` is told how many rows are there, and of how many. Once `stop` is true it ends.
///
/// ```
/// use freeplay::scenario::Source;
/// use freeplay::study::sweep::{Plan, Shard, sweep};
/// use std::sync::atomic::AtomicBool;
///
/// let sets = ["simulation.duration=0.01", "simulation.settle=0"].map(str::to_owned);
/// let vary = ["joints.clearance=1e-4,2e-4".to_owned()];
/// let plan = Plan::new(Source::read(None)?, &sets, &vary, Shard::WHOLE)?;
/// let place = tempfile::tempdir()?;
/// let done = sweep(&plan, &place.path().join("sweep"), false, &AtomicBool::new(false), &|_, _| ())?;
/// let table = std::fs::read_to_string(done.folder.join("sweep.csv"))?;
/// assert_eq!(table.lines().count(), 3, "a header and two rows");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`StudyError`]; what the folder held stands.
pub fn sweep(
    plan: &Plan,
    target: &Path,
    force: bool,
    stop: &AtomicBool,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<SweepOutcome, StudyError> {
    let ongoing = Ongoing::begin(plan, target, force)?;
    let (pending, of) = (ongoing.missing(), ongoing.runs());
    progress(ongoing.finished(), of);
    let ongoing = Mutex::new(ongoing);
    // One by one: runs differ in cost, and threads that are done take from those that are not.
    let made = pending.par_iter().with_max_len(1).try_for_each(|&run| {
        let Some(row) = plan.row(run, stop) else { return Err(None) };
        let mut ongoing = ongoing.lock().unwrap_or_else(PoisonError::into_inner);
        ongoing.add(run, row).map_err(Some)?;
        progress(ongoing.finished(), of);
        if stop.load(Ordering::Relaxed) { Err(None) } else { Ok(()) }
    });
    let ongoing = ongoing.into_inner().unwrap_or_else(PoisonError::into_inner);
    match made {
        Err(None) if ongoing.finished() < of => Err(ongoing.interrupted()),
        Err(Some(error)) => Err(error),
        _ => ongoing.finish(),
    }
}

/// The folder of a sweep at work, whose journal nobody else can write to: which rows it has, and which it
/// lacks. Dropped before its end, it keeps the rows.
#[derive(Debug)]
pub struct Ongoing {
    target: PathBuf,
    identity: Identity,
    shard: Shard,
    journal: Journal,
    rows: RunRows,
}

impl Ongoing {
    /// Makes the folder `target`, or goes on in it; with `force`, it begins anew.
    ///
    /// # Errors
    /// [`StudyError`]: it holds something else, or another process is at work there; what it held stands.
    pub fn begin(plan: &Plan, target: &Path, force: bool) -> Result<Ongoing, StudyError> {
        let (journal, rows) = open(plan, target, force)?;
        let (identity, shard) = (plan.identity().clone(), plan.shard());
        let ongoing = Ongoing { target: target.to_owned(), identity, shard, journal, rows };
        if ongoing.finished() < ongoing.runs() {
            ongoing.forget_tables()?;
        }
        Ok(ongoing)
    }

    /// The tables of a sweep that is not complete (as merge leaves one) do not outlive this: they go before
    /// the record that vouches for them.
    fn forget_tables(&self) -> Result<(), StudyError> {
        for table in [TABLE_FILE, PARQUET_FILE] {
            match fs::remove_file(self.target.join(table)) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    return Err(refused(table)(error).into());
                }
                _ => {}
            }
        }
        let record = Record::new(self.identity.clone(), self.shard, &self.rows, &self.target);
        Ok(put(&self.target, RECORD_FILE, record.to_json())?)
    }

    /// The runs of this part that have no row yet.
    pub fn missing(&self) -> Vec<usize> {
        self.shard.runs(self.identity.runs).filter(|run| !self.rows.contains_key(run)).collect()
    }

    /// Number of rows that are there.
    pub fn finished(&self) -> usize {
        self.rows.len()
    }

    /// Number of runs of this part.
    pub fn runs(&self) -> usize {
        self.shard.runs(self.identity.runs).count()
    }

    /// Keeps the row of run `run`. One that is there already, as a worker sends that was held for lost, changes nothing.
    ///
    /// # Errors
    /// [`StudyError`] if the run is none of this part, its row is no row of this table or contradicts the one
    /// that is there, or the file system refuses.
    pub fn add(&mut self, run: usize, row: Vec<String>) -> Result<(), StudyError> {
        let (cells, columns) = (row.len(), self.identity.columns.len());
        if run >= self.identity.runs || !self.shard.holds(run) || cells != columns {
            return Err(StudyError::input(format!(
                "a row of {cells} cells for run {} is none of this sweep: expected {columns} cells and a run \
                 of part {} of {} runs",
                run + 1,
                self.shard,
                self.identity.runs
            )));
        }
        let kept = kept(&row);
        match self.rows.get(&run) {
            Some(before) if *before == kept => Ok(()),
            Some(_) => Err(StudyError::input(format!(
                "run {} was made twice and came out differently: one of the machines computes wrongly",
                run + 1
            ))),
            None => {
                self.journal.append(run, &row)?;
                self.rows.insert(run, kept);
                Ok(())
            }
        }
    }

    /// Ends before all rows are there, and says how far it came.
    pub fn interrupted(&self) -> StudyError {
        StudyError::Interrupted {
            finished: self.finished(),
            runs: self.runs(),
            folder: self.target.clone(),
        }
    }

    /// Writes everything that follows from the rows. The journal stays locked until then.
    ///
    /// # Errors
    /// [`StudyError`] if files cannot be written; the rows stand.
    pub fn finish(self) -> Result<SweepOutcome, StudyError> {
        Ok(write(&self.target, &self.target, &self.identity, self.shard, &self.rows)?)
    }
}

/// The journal of this sweep in `target`, and the rows that are there.
fn open(plan: &Plan, target: &Path, force: bool) -> Result<(Journal, RunRows), StudyError> {
    Folder::mend(target, RECORD_FILE).map_err(RunError::from)?;
    // Held until the journal is replaced: nobody works on what is thrown away.
    let replaced =
        if force && target.join(JOURNAL_FILE).exists() { Some(lock(target)?) } else { None };
    if force || !target.join(RECORD_FILE).exists() {
        create(plan, target, force)?;
    }
    drop(replaced);
    let record = Record::read(target)?;
    refuse_other(&record, plan.identity(), plan.shard(), target)?;
    let opened = Journal::open(target, plan.identity(), plan.shard())?;
    refuse_edited_table(target, &record)?;
    Ok(opened)
}

/// Makes the folder of a sweep without rows. It gets its name when record and journal are in it.
fn create(plan: &Plan, target: &Path, force: bool) -> Result<(), StudyError> {
    let folder = Folder::prepare(target, RECORD_FILE, force).map_err(RunError::from)?;
    let record = Record::new(plan.identity().clone(), plan.shard(), &RunRows::new(), target);
    let put = |name, text: &str| put(folder.path(), name, text);
    put(RECORD_FILE, &record.to_json())?;
    put(JOURNAL_FILE, "")?;
    put(SCENARIO_FILE, &plan.base().to_toml())?;
    folder.finish().map_err(RunError::from)?;
    Ok(())
}

/// Refuses the record of another sweep, or of another part of this one.
pub(super) fn refuse_other(
    record: &Record,
    identity: &Identity,
    shard: Shard,
    folder: &Path,
) -> Result<(), StudyError> {
    let mut differences = record.identity.differences(identity);
    if record.shard != shard {
        differences.push(format!("--shard {} there, {shard} here", record.shard));
    }
    if differences.is_empty() {
        return Ok(());
    }
    Err(StudyError::Another(format!(
        "`{}` holds another sweep: {}; choose another folder with --out, or replace it with --force",
        folder.display(),
        differences.join("; ")
    )))
}
