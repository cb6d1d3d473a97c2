//! The page of a sweep: how the runs ended, the spread of the figures, the pictures.

use super::Record;
use super::journal::Rows;
use super::row::{FORCES, Status, status};
use crate::report::{self, Fact, Picture, number};
use crate::study::run::SCENARIO_FILE;

/// The page as HTML.
pub(super) fn page(record: &Record, rows: &Rows, pictures: &[Picture]) -> String {
    let title = format!("Sweep: {}", record.identity.provenance.scenario_name);
    report::page(&title, &lead(record, rows), &facts(record, rows), pictures, &provenance(record))
}

/// How the runs ended, in words.
fn lead(record: &Record, rows: &Rows) -> String {
    let identity = &record.identity;
    let paths = identity.columns.iter().zip(&identity.vary).map(|(path, _)| path.as_str());
    let mut lead = format!(
        "{} of {} runs over {}",
        record.finished,
        record.runs_of_shard,
        paths.collect::<Vec<_>>().join(", ")
    );
    if record.runs_of_shard < identity.runs {
        lead += &format!(" (shard {} of a sweep of {} runs)", record.shard, identity.runs);
    }
    lead += &format!(": {} reached their end", record.ok);
    for (count, how, wanted) in [
        (record.halted, "broke down on the way or do not balance", Status::Halted),
        (record.refused, "cannot be done by the machine", Status::Refused),
    ] {
        let first = rows.values().find(|row| status(row) == wanted);
        if let Some(reason) = first.and_then(|row| row.last()) {
            lead += &format!(", {count} {how} (the first: {reason})");
        }
    }
    lead + ". Each figure below is that of a run, taken as a single run takes it; sweep.csv has \
            one row a run."
}

/// Median and span of each figure over the runs that reached their end. Its columns stand behind those of the
/// varied values; the status, the last one, is no number.
fn facts(record: &Record, rows: &Rows) -> Vec<Fact> {
    let identity = &record.identity;
    let columns = identity.columns.iter().enumerate().skip(identity.vary.len());
    columns
        .filter_map(|(column, name)| {
            let ended = rows.values().filter(|row| status(row) == Status::Ok);
            let mut values: Vec<f64> =
                ended.filter_map(|row| row.get(column)?.parse().ok()).collect();
            values.sort_by(f64::total_cmp);
            let (least, most) = (values.first()?, values.last()?);
            if FORCES.contains(&name.as_str()) && (*least, *most) == (0.0, 0.0) {
                return None;
            }
            Some(Fact {
                label: name.clone(),
                value: number(values[values.len() / 2]),
                note: format!("median; from {} to {}", number(*least), number(*most)),
            })
        })
        .collect()
}

fn provenance(record: &Record) -> Vec<(String, String)> {
    let identity = &record.identity;
    let more = [
        ("SHA-256 of all runs' scenarios", identity.runs_hash.clone()),
        ("Seed", identity.seed.to_string()),
    ];
    let mut entries = identity.provenance.lines("scenario", Some(SCENARIO_FILE), more);
    entries.extend(identity.vary.iter().map(|vary| ("Varied".to_owned(), vary.clone())));
    entries
}
