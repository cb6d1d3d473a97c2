//! The parts of a sweep joined.

use super::result::{SweepOutcome, put, refuse_edited_table, write};
use super::rows::journal::{self, JOURNAL_FILE, RunRows};
use super::{RECORD_FILE, Record, Shard};
use crate::results::Folder;
use crate::results::RunError;
use crate::results::SCENARIO_FILE;
use crate::study::StudyError;
use std::fs;
use std::path::{Path, PathBuf};

/// Runs and parts that are named where many are missing.
const NAMED: usize = 5;

/// Joins the folders `parts` of one sweep into the folder `target`, as if it had been one sweep from
/// the beginning; the parts stay as they are. With `partial` rows may be missing; the sweep can go on
/// in `target` later. With `force` an earlier result there is replaced.
///
/// # Errors
/// [`StudyError`] if a part is damaged or of another sweep, if parts contradict each other, if rows
/// are missing, or if files cannot be written. Nothing is lost.
pub fn merge(
    parts: &[PathBuf],
    target: &Path,
    force: bool,
    partial: bool,
) -> Result<SweepOutcome, StudyError> {
    refuse_twice(parts)?;
    let records: Vec<Record> =
        parts.iter().map(|part| Record::read(part)).collect::<Result<_, _>>()?;
    refuse_foreign(parts, &records)?;
    let (identity, first_part) = (&records[0].identity, &parts[0]);
    let mut rows = RunRows::new();
    for (part, record) in parts.iter().zip(&records) {
        refuse_edited_table(part, record)?;
        for (run, row) in journal::read(part, identity, record.shard)? {
            if rows.get(&run).is_some_and(|before| *before != row) {
                return Err(StudyError::input(format!(
                    "`{}` contradicts another part about run {}; both were made by the same \
                     version on the same scenario, so one of the machines computes wrongly or \
                     differently. Leave out the part that you do not trust",
                    part.display(),
                    run + 1
                )));
            }
            rows.insert(run, row);
        }
    }
    if !partial {
        refuse_missing(&rows, identity.runs, parts, &records)?;
    }

    let file = first_part.join(SCENARIO_FILE);
    let scenario = fs::read_to_string(&file).map_err(|error| {
        let file = file.display();
        StudyError::input(format!(
            "cannot read `{file}`: {error}; each part has the sweep's scenario"
        ))
    })?;
    let folder = Folder::prepare(target, RECORD_FILE, force).map_err(RunError::from)?;
    let place = folder.path();
    put(place, JOURNAL_FILE, journal::text(identity, &rows))?;
    put(place, SCENARIO_FILE, &scenario)?;
    let outcome = write(place, target, identity, Shard::WHOLE, &rows)?;
    folder.finish().map_err(RunError::from)?;
    Ok(outcome)
}

/// Fails if a folder is given twice, under whatever names.
fn refuse_twice(parts: &[PathBuf]) -> Result<(), StudyError> {
    let real: Vec<PathBuf> =
        parts.iter().map(|part| part.canonicalize().unwrap_or_else(|_| part.clone())).collect();
    let again = (0..real.len()).find(|&i| real[..i].contains(&real[i]));
    again.map_or(Ok(()), |i| {
        let part = parts[i].display();
        Err(StudyError::input(format!("`{part}` is given twice; expected each part once")))
    })
}

/// Fails if parts belong to another sweep than the first, and names all of them.
fn refuse_foreign(parts: &[PathBuf], records: &[Record]) -> Result<(), StudyError> {
    let (Some(first), Some(first_part)) = (records.first(), parts.first()) else {
        return Err(StudyError::input("nothing to merge; give the folders of the parts"));
    };
    let mut said = String::new();
    for (part, record) in parts.iter().zip(records) {
        let differences = record.identity.differences(&first.identity);
        if differences.is_empty() {
            continue;
        }
        said += &match said.is_empty() {
            true => format!(
                "`{}` is no part of the sweep in `{}` (here): ",
                part.display(),
                first_part.display()
            ),
            false => format!("; nor is `{}`: ", part.display()),
        };
        said += &differences.join("; ");
    }
    if said.is_empty() { Ok(()) } else { Err(StudyError::input(said)) }
}

/// Fails if a run has no row, and says which parts are not there and which are unfinished.
fn refuse_missing(
    rows: &RunRows,
    runs: usize,
    parts: &[PathBuf],
    records: &[Record],
) -> Result<(), StudyError> {
    let missing: Vec<usize> = (0..runs).filter(|run| !rows.contains_key(run)).collect();
    let Some(record) = records.first().filter(|_| !missing.is_empty()) else {
        return Ok(());
    };
    let lacks = |shard: Shard| missing.iter().any(|run| shard.holds(*run));
    let there = |shard: Shard| records.iter().any(|record| record.shard == shard);
    let mut absent: Vec<Shard> = missing.iter().map(|run| record.shard.sibling(*run)).collect();
    absent.sort_unstable();
    absent.dedup();
    absent.retain(|shard| !there(*shard));
    let shards = listed(absent.iter().map(Shard::to_string));
    let unfinished = parts.iter().zip(records).filter(|(_, record)| lacks(record.shard));
    let unfinished = unfinished.map(|(part, record)| {
        format!("`{}` (shard {}) is unfinished", part.display(), record.shard)
    });
    let mut said: Vec<String> = unfinished.collect();
    match absent.len() {
        0 => {}
        1 => said.insert(0, format!("shard {shards} is not among the parts")),
        _ => said.insert(0, format!("shards {shards} are not among the parts")),
    }
    Err(StudyError::input(format!(
        "{} of {runs} rows are missing (runs {}): {}; give all parts, let the same sweep \
         finish there, or merge what there is with --partial",
        missing.len(),
        listed(missing.iter().map(|run| (run + 1).to_string())),
        said.join("; ")
    )))
}

/// The first [`NAMED`] of them with commas between, and a sign that there are more.
fn listed(names: impl Iterator<Item = String>) -> String {
    let mut names: Vec<String> = names.take(NAMED + 1).collect();
    if names.len() > NAMED {
        names[NAMED] = "…".to_owned();
    }
    names.join(", ")
}
