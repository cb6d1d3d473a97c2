//! The page of synthetic recordings.

use super::super::results::page::errors_table;
use super::{RIG_FILE, RecordReport, TRUTH_FILE};
use crate::report::{PagePart, Picture, document, number};

const NOTE: &str = "Root mean square of the recording less a model, both through a zero-phase low-pass of fourth order \
                    at 25 Hz, first and last 60 ms left out. Before: the rig as declared, without what is hidden (a dash \
                    where nothing is); after: the machine as it is; floor: what sensor noise and rattle leave to any \
                    model.";

/// The page as HTML.
pub fn page(recorded: &RecordReport, pictures: &[&Picture]) -> String {
    let pictures: Vec<Picture> = pictures.iter().copied().cloned().collect();
    let more = [
        (
            "Recordings",
            format!("{}, {RIG_FILE}, {TRUTH_FILE} beside this page", recorded.runs.join(", ")),
        ),
        (
            "Rows",
            format!("{} a second over {} s", number(recorded.rate), number(recorded.duration_s)),
        ),
        ("Seed", recorded.seed.to_string()),
        ("Time of computing", format!("{} s", number(recorded.wall_s))),
    ];
    let provenance = recorded.provenance.lines("scenario", None, more);
    let parts = [
        PagePart::Table(errors_table(&recorded.errors, NOTE)),
        PagePart::Pictures(&pictures),
        PagePart::Provenance(&provenance),
    ];
    let title = format!("Recordings of {}", recorded.provenance.scenario_name);
    document(&title, &recorded.verdict(), &parts)
}
