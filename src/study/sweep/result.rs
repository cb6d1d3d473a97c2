//! The files of a sweep, from its rows: table, pictures, page, record.

use super::rows::journal::{JOURNAL_FILE, RunRows};
use super::rows::record::sha256;
use super::rows::row::{Status, status};
use super::rows::{page, pictures, statistics};
use super::{Identity, RECORD_FILE, Record, Shard};
use crate::results::sync;
use crate::results::{PAGE_FILE, SCENARIO_FILE};
use crate::results::{RunError, refused};
use crate::study::StudyError;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The table.
pub(super) const TABLE_FILE: &str = "sweep.csv";

/// The table with types, of a program that was built with the feature `parquet`. Every record names it:
/// a folder may pass from one such program to another that cannot write it.
pub(super) const PARQUET_FILE: &str = "sweep.parquet";

/// Where a file is written before it gets its name.
const UNFINISHED_FILE: &str = "unfinished.tmp";

/// What a sweep came to.
#[derive(Debug)]
pub struct SweepOutcome {
    /// What `sweep.json` says.
    pub record: Record,
    /// The text of `sweep.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

impl Record {
    /// The record of part `shard` of a sweep that has come as far as `rows`, its table not written.
    pub(super) fn new(identity: Identity, shard: Shard, rows: &RunRows, folder: &Path) -> Record {
        let count = |wanted| rows.values().filter(|row| status(row) == wanted).count();
        let texts = [
            RECORD_FILE,
            JOURNAL_FILE,
            TABLE_FILE,
            statistics::FILE,
            PARQUET_FILE,
            SCENARIO_FILE,
            PAGE_FILE,
            UNFINISHED_FILE,
        ];
        let files = texts.map(str::to_owned).into_iter().chain(pictures::files(&identity));
        Record {
            shard,
            runs_of_shard: shard.runs(identity.runs).count(),
            finished: rows.len(),
            ok: count(Status::Ok),
            halted: count(Status::Halted),
            refused: count(Status::Refused),
            complete: false,
            table_sha256: None,
            folder: folder.display().to_string(),
            files: files.collect(),
            identity,
        }
    }
}

/// Writes the files that follow from `rows` into `place`, which is or will be called `folder`.
pub(super) fn write(
    place: &Path,
    folder: &Path,
    identity: &Identity,
    shard: Shard,
    rows: &RunRows,
) -> Result<SweepOutcome, RunError> {
    let table = table(identity, rows).map_err(refused(TABLE_FILE))?;
    let mut record = Record::new(identity.clone(), shard, rows, folder);
    record.table_sha256 = Some(sha256(table.as_bytes()));
    let pictures = pictures::draw(identity, rows)?;
    // The record first: a table that it does not vouch for would pass for one edited by hand. That
    // all is complete it says last, when it is.
    put(place, RECORD_FILE, record.to_json())?;
    put(place, TABLE_FILE, &table)?;
    #[cfg(feature = "parquet")]
    {
        let table = super::rows::parquet::table(identity, rows).map_err(refused(PARQUET_FILE))?;
        put(place, PARQUET_FILE, &table)?;
    }
    if statistics::has_starts(identity) {
        let groups = statistics::groups(identity, rows);
        put(place, statistics::FILE, statistics::csv(identity, &groups))?;
    }
    for picture in &pictures {
        put(place, &picture.file, &picture.svg)?;
    }
    record.complete = record.finished == record.runs_of_shard;
    put(place, PAGE_FILE, page::page(&record, rows, &pictures))?;
    let json = record.to_json();
    put(place, RECORD_FILE, &json)?;
    Ok(SweepOutcome { record, json, folder: folder.to_owned() })
}

/// Writes a file that is never seen half written, not even after a power cut.
pub(super) fn put(place: &Path, name: &str, content: impl AsRef<[u8]>) -> Result<(), RunError> {
    let unfinished = place.join(UNFINISHED_FILE);
    fs::write(&unfinished, content)
        .and_then(|()| sync::file(&unfinished))
        .and_then(|()| fs::rename(&unfinished, place.join(name)))
        // On a disk that is full the half of it is in the way. The error is that of the writing.
        .inspect_err(|_| drop(fs::remove_file(&unfinished)))
        .map_err(refused(name))?;
    sync::names(place);
    Ok(())
}

/// Refuses a folder whose table is not as it was written: somebody's work may be in it.
pub(super) fn refuse_edited_table(folder: &Path, record: &Record) -> Result<(), StudyError> {
    let path = folder.join(TABLE_FILE);
    let table = match fs::read(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        read => read.map_err(refused(TABLE_FILE)).map_err(StudyError::Files)?,
    };
    if record.table_sha256.as_ref() == Some(&sha256(&table)) {
        return Ok(());
    }
    Err(StudyError::input(format!(
        "`{}` was truncated or edited since it was written. Nothing was changed; keep it under \
         another name, or delete it, and it is written again from {JOURNAL_FILE}",
        path.display()
    )))
}

/// `sweep.csv`: the rows by the number of their run.
fn table(identity: &Identity, rows: &RunRows) -> io::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&identity.columns)?;
    for row in rows.values() {
        writer.write_record(row)?;
    }
    let bytes = writer.into_inner().map_err(|error| error.into_error())?;
    String::from_utf8(bytes).map_err(io::Error::other)
}
