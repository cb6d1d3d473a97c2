//! The page and the files of a difference.

use super::result::{Diff, FigureRow};
use super::{DIFF_FILE, FinishedDiff, TABLE_FILE};
use crate::report::{PagePart, PageTable, Picture, document, length, number};
use crate::results::Folder;
use crate::results::{PAGE_FILE, to_json};
use crate::results::{RunError, refused};
use crate::study::StudyError;
use std::fs;

/// The picture of every run.
pub const RUNS_FILE: &str = "every-run.svg";

/// Writes everything about a difference and gives the folder its name.
pub fn write(
    mut diff: Diff,
    pictures: &[Picture],
    folder: Folder,
) -> Result<FinishedDiff, StudyError> {
    let texts = [DIFF_FILE, TABLE_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    diff.files = texts.chain(pictures.iter().map(|picture| picture.file.clone())).collect();
    let json = to_json(&diff);
    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    write(DIFF_FILE, &json)?;
    write(TABLE_FILE, &diff.csv())?;
    for picture in pictures {
        write(&picture.file, &picture.svg)?;
    }
    write(PAGE_FILE, &page(&diff, pictures))?;
    let folder = folder.finish().map_err(RunError::from)?;
    Ok(FinishedDiff { diff, json, folder })
}

fn page(diff: &Diff, pictures: &[Picture]) -> String {
    let [a, b] = &diff.names;
    let title = format!("{a} and {b}");
    let lead: Vec<&str> = [diff.answer.as_str()]
        .into_iter()
        .chain(diff.warnings.iter().map(String::as_str))
        .collect();
    let more = [
        ("Second", format!("{}, {}", b, diff.second.scenario_hash)),
        ("Figures", format!("{DIFF_FILE}, {TABLE_FILE} beside this page")),
        ("Time of computing", format!("{} s", number(diff.wall_s))),
    ];
    let provenance = diff.provenance.lines("first", None, more);
    let parts = [
        PagePart::Table(table(diff)),
        PagePart::Pictures(pictures),
        PagePart::Provenance(&provenance),
    ];
    document(&title, &lead.join(" "), &parts)
}

fn table(diff: &Diff) -> PageTable {
    let note = match diff.of {
        "models" => format!(
            "Means over {} starts. Floor: half of the 95 % interval of the difference; figures differ that are one and a half \
             floors apart.",
            diff.starts
        ),
        _ => "Figures of both summaries, and root mean squares of columns and of what the second has more. Floor: of places \
              the sum of both runs' own errors, three times which differ; of summaries of runs that are not chaotic \
              rounding; otherwise nobody knows it."
            .to_owned(),
    };
    let header = [
        "figure",
        diff.names[0].as_str(),
        diff.names[1].as_str(),
        "difference",
        "floor",
        "differs",
    ];
    PageTable {
        id: "figures",
        title: "Figures".to_owned(),
        header: header.map(str::to_owned).into(),
        rows: diff.rows.iter().map(|row| row.cells().to_vec()).collect(),
        note,
    }
}

impl FigureRow {
    /// What tables show of it.
    pub fn cells(&self) -> [String; 6] {
        let value = |value: f64| match self.unit {
            "m" => length(value),
            "" => number(value),
            unit => format!("{} {unit}", number(value)),
        };
        let [a, b] = self.values.map(value);
        let differs = match self.differs {
            Some(true) => "yes",
            Some(false) => "no",
            None if self.one_draw => "one draw",
            None => "unknown",
        };
        let floor = self.floor.map_or("–".to_owned(), value);
        [self.label.clone(), a, b, value(self.difference), floor, differs.to_owned()]
    }
}
