//! Models against published recordings of real hardware: a driven slide and a pendulum, the two kinds of
//! joint that a 3-RPR is made of. The recordings are not part of this project; they are read from a
//! folder of the user's.

pub mod emps;
mod page;
pub mod pendulum;

pub use page::{STUDY_FILE, StudyError, emps_page, pendulum_page};

use crate::measure::log::{Channel, Log, LogError, Source};
use crate::scenario::{Scenario, Sources};
use std::path::{Path, PathBuf};

/// Environment variable that says where the recordings are.
pub const VARIABLE: &str = "FREEPLAY_MEASURED";

/// Where they are sought without it.
const DEFAULT_FOLDER: &str = "../shared/measured";

/// Why a study has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Missing {
    /// The recording is not there.
    #[error("{0} is not there")]
    Absent(PathBuf),
    /// It is there, and not what it should be.
    #[error(transparent)]
    Log(#[from] LogError),
    /// Anything else.
    #[error("{0}")]
    Wrong(String),
}

/// The folder of the recordings: as given, as the environment says, or the default.
pub fn folder(given: Option<&Path>) -> PathBuf {
    let given = given.map(Path::to_owned);
    given
        .or_else(|| std::env::var_os(VARIABLE).map(PathBuf::from))
        .unwrap_or_else(|| DEFAULT_FOLDER.into())
}

/// What is said where recordings are not there.
pub fn skipped(what: &str, missing: &Path) -> String {
    format!(
        "skipped: data not present ({} is missing). {what} Put it there, or say with --data or \
         {VARIABLE} where it is.",
        missing.display()
    )
}

/// The columns of a rig's recordings.
fn sources(rig: &Scenario, known: &[Channel]) -> Result<Sources, Missing> {
    let columns = rig.columns.clone().unwrap_or_default();
    columns.sources(known).map_err(|name| {
        let names: Vec<String> = known.iter().map(Channel::to_string).collect();
        let message = "is not a quantity of this machine's recordings";
        let help = format!("known here: t, {}", names.join(", "));
        Missing::Wrong(rig.problem(&format!("columns.{name}"), message, help).to_string())
    })
}

/// Reads the columns of a recording that has to have all of `needed`.
fn read(
    path: &Path,
    time: &Source,
    columns: &[(Channel, Source)],
    needed: &[Channel],
) -> Result<Log, Missing> {
    if let Some(channel) = needed.iter().find(|n| !columns.iter().any(|(c, _)| c == *n)) {
        let help = format!("write {channel} = \"…\" under [columns]: the name of its column");
        return Err(Missing::Wrong(format!("columns.{channel} is missing; {help}")));
    }
    if !path.is_file() {
        return Err(Missing::Absent(path.to_owned()));
    }
    Ok(Log::read_columns(path, time, columns)?)
}

/// A table of results.
#[derive(Clone, Debug)]
pub struct Table {
    /// Heads of the columns.
    pub header: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// As text with aligned columns; the first to the left, the others to the right.
    pub fn text(&self) -> String {
        let width = |k: usize| {
            let cells = self.rows.iter().chain([&self.header]);
            cells.filter_map(|row| row.get(k)).map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.header.len()).map(width).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).enumerate().map(|(k, (cell, width))| {
                if k == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
        };
        self.rows.iter().fold(line(&self.header), |text, row| text + &line(row))
    }
}
