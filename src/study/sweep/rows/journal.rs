//! `rows.jsonl`: one line a finished run, in the order in which they finish.
//!
//! A line is appended whole, in one write. A process that is killed may leave the last line without
//! its end: such a line is no row, and its run is made again. Every line carries a seal (of the sweep,
//! the run and the cells), so that a line that somebody edited is not taken for a result.

use super::record::sha256;
use crate::results::{RunError, refused};
use crate::study::StudyError;
use crate::study::sweep::{Identity, Shard};
use csv::StringRecord;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::Path;

/// The journal's name in the folder of a sweep.
pub(in crate::study::sweep) const JOURNAL_FILE: &str = "rows.jsonl";

/// Rows by the number of their run.
pub(in crate::study::sweep) type RunRows = BTreeMap<usize, StringRecord>;

/// A row as it is kept: its cells in one text, as long as they are.
pub(in crate::study::sweep) fn kept(cells: &[String]) -> StringRecord {
    let mut row = StringRecord::with_capacity(cells.iter().map(String::len).sum(), cells.len());
    cells.iter().for_each(|cell| row.push_field(cell));
    row
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct JournalLine {
    run: usize,
    cells: Vec<String>,
    seal: String,
}

/// A journal that rows are appended to. Nobody else can, as long as it is open.
#[derive(Debug)]
pub(in crate::study::sweep) struct Journal {
    file: File,
    seed_of_seals: String,
    /// After a write that failed half-way another row must not follow on the same line.
    broken: bool,
}

impl Journal {
    /// Opens the journal of a folder for appending, reads what it holds, and cuts off a torn last
    /// line.
    ///
    /// # Errors
    /// [`StudyError`] if another process works on it, or it was edited.
    pub fn open(
        folder: &Path,
        identity: &Identity,
        shard: Shard,
    ) -> Result<(Journal, RunRows), StudyError> {
        let path = folder.join(JOURNAL_FILE);
        let mut file = lock(folder)?;
        let mut text = Vec::new();
        file.read_to_end(&mut text).map_err(refused(JOURNAL_FILE))?;
        let (rows, whole) = parse(&text, &path, identity, shard)?;
        file.set_len(whole as u64).map_err(refused(JOURNAL_FILE))?;
        Ok((Journal { file, seed_of_seals: identity.hash(), broken: false }, rows))
    }

    /// Appends the row of run `run`. It is there as soon as this returns, whatever happens to this
    /// process; should the whole computer fail, the last few may have to be made again.
    ///
    /// # Errors
    /// [`RunError::File`] if the file system refuses, and from then on.
    pub fn append(&mut self, run: usize, cells: &[String]) -> Result<(), RunError> {
        if self.broken {
            let source = io::Error::other("an earlier row could not be written");
            return Err(refused(JOURNAL_FILE)(source));
        }
        let seal = seal(&self.seed_of_seals, run, cells);
        let line = JournalLine { run, cells: cells.to_vec(), seal };
        // Numbers and texts always become JSON.
        let text = serde_json::to_string(&line).unwrap_or_default() + "\n";
        self.file.write_all(text.as_bytes()).map_err(|error| {
            self.broken = true;
            refused(JOURNAL_FILE)(error)
        })
    }
}

/// Opens the journal of a folder for this process alone.
pub(in crate::study::sweep) fn lock(folder: &Path) -> Result<File, StudyError> {
    let path = folder.join(JOURNAL_FILE);
    let opened = OpenOptions::new().read(true).append(true).open(&path);
    let file = opened.map_err(|error| unreadable(&path, &error))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(StudyError::input(format!(
            "another freeplay is at work on `{}`; wait for it, or choose another folder with --out",
            folder.display()
        ))),
        // A file system without locks: then the user is the one who sees to it.
        Err(TryLockError::Error(_)) => Ok(file),
    }
}

/// The rows of the journal of a folder, of which nothing is changed.
pub(in crate::study::sweep) fn read(
    folder: &Path,
    identity: &Identity,
    shard: Shard,
) -> Result<RunRows, StudyError> {
    let path = folder.join(JOURNAL_FILE);
    let text = std::fs::read(&path).map_err(|error| unreadable(&path, &error))?;
    Ok(parse(&text, &path, identity, shard)?.0)
}

/// The text of a journal that holds `rows`.
pub(in crate::study::sweep) fn text(identity: &Identity, rows: &RunRows) -> String {
    let hash = identity.hash();
    rows.iter()
        .map(|(run, cells)| {
            let cells: Vec<String> = cells.iter().map(str::to_owned).collect();
            let line = JournalLine { run: *run, seal: seal(&hash, *run, &cells), cells };
            serde_json::to_string(&line).unwrap_or_default() + "\n"
        })
        .collect()
}

fn unreadable(path: &Path, error: &io::Error) -> StudyError {
    StudyError::input(format!(
        "`{}` cannot be read: {error}; without this file the folder holds no sweep",
        path.display()
    ))
}

/// The rows in `text`, and the length of all whole lines in bytes.
fn parse(
    text: &[u8],
    path: &Path,
    identity: &Identity,
    shard: Shard,
) -> Result<(RunRows, usize), StudyError> {
    let hash = identity.hash();
    let whole = text.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let mut rows = RunRows::new();
    for (number, line) in (1..).zip(text[..whole].split_inclusive(|byte| *byte == b'\n')) {
        let damaged = |what: String| {
            StudyError::input(format!(
                "{}:{number}: {what}. Nothing was changed; restore the file, or delete this line \
                 and the sweep makes its run again",
                path.display()
            ))
        };
        let line: JournalLine = serde_json::from_slice(line)
            .map_err(|error| damaged(format!("is no row of a sweep ({error})")))?;
        if line.seal != seal(&hash, line.run, &line.cells) {
            return Err(damaged(
                "was edited, or belongs to another sweep: its seal is broken".into(),
            ));
        }
        if line.run >= identity.runs || !shard.holds(line.run) {
            return Err(damaged(format!("holds run {}, which is none of shard {shard}", line.run)));
        }
        let (cells, columns) = (line.cells.len(), identity.columns.len());
        if cells != columns {
            return Err(damaged(format!("has {cells} cells, and the table {columns} columns")));
        }
        let row = kept(&line.cells);
        if rows.get(&line.run).is_some_and(|before| *before != row) {
            return Err(damaged(format!("contradicts an earlier row of run {}", line.run)));
        }
        rows.insert(line.run, row);
    }
    Ok((rows, whole))
}

/// Sixteen hexadecimal digits over a row: a guard against slips, not against forgers.
fn seal(identity: &str, run: usize, cells: &[String]) -> String {
    let text = format!("{identity} {run} {cells:?}");
    sha256(text.as_bytes())[..16].to_owned()
}
