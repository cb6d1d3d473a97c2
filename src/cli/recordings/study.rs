//! `freeplay study`: models against measured hardware.

use crate::calibrate::hardware::{
    Missing, ResultsTable, STUDY_FILE, emps, emps_page, folder, pendulum, pendulum_page, skipped,
};
use crate::cli::shared::failure::Failure;
use crate::cli::shared::options::{FolderOptions, PrintOptions};
use crate::cli::shared::progress::Spinner;
use crate::cli::shared::table::{paragraph, words_and_numbers};
use crate::scenario::Scenario;
use clap::{Args, ValueEnum};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// Identify measured hardware and judge the models on what they were not fitted to
///
/// Two published recordings, one of each kind of joint: `emps`, a driven slide, and `pendulum`, the free
/// swings of an arm. What the declared model lacks is added effect after effect, with the error before
/// and after each. The recordings are not part of freeplay; where they are not present the command says
/// so, says where to get them, and ends with exit code 0; a folder that --data names has to hold them.
///
/// Columns and units of the recordings are those of the rig's [columns]; a rig of your own makes your
/// own recording readable as it is. A wrong name, a wrong scale and a recording spliced from two runs are
/// refused with exit code 2.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// Which hardware
    which: Which,
    /// Folder of the recordings [default: $FREEPLAY_MEASURED, or ../shared/measured]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Scenario of the rig, in place of the built-in one (assets/drive-stage-declared.toml,
    /// assets/pendulum-declared.toml)
    #[arg(long, value_name = "SCENARIO")]
    rig: Option<PathBuf>,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay study emps --data measured       reads measured/emps
  freeplay study pendulum --data measured   reads measured/pendulum";

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Which {
    /// The electro-mechanical positioning system: a driven slide
    Emps,
    /// One arm of the multi-arm pendulum
    Pendulum,
}

const EMPS_SOURCE: &str = "The EMPS recordings are at nonlinearbenchmark.org (Janot, Gautier, Brunot, \
    2019); a copy is in the repository forgi86/sysid-neural-continuous, examples/EMPS/data/.";
const PENDULUM_SOURCE: &str = "The swings of the pendulum are in the repository \
    dynamicslab/MultiArm-Pendulum (arXiv 2205.06231).";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let (name, built_in, source) = match arguments.which {
        Which::Emps => ("emps", emps::RIG, EMPS_SOURCE),
        Which::Pendulum => ("pendulum", pendulum::RIG, PENDULUM_SOURCE),
    };
    let rig = match &arguments.rig {
        Some(path) => Scenario::load(Some(path), &[])?,
        None => Scenario::from_text(built_in, "built-in rig", &[])?,
    };
    let quiet = arguments.print.quiet;
    let prepare = || arguments.folder.prepare("study", name, STUDY_FILE);
    let data = folder(arguments.data.as_deref()).join(name);
    let absent = |missing: Missing| match missing {
        // A folder that somebody names has to be there.
        Missing::Absent(path) if arguments.data.is_none() => {
            let said = skipped(source, &path);
            let json = json!({"program": env!("CARGO_PKG_NAME"), "skipped": said});
            Ok(arguments.print.result(&format!("{json:#}\n"), || paragraph("", "", &said))?)
        }
        Missing::Absent(path) => {
            Err(Failure::Input(vec![format!("--data: there is no `{}`; {source}", path.display())]))
        }
        other => Err(Failure::from(other)),
    };
    let (lead, tables, folder) = match arguments.which {
        Which::Emps => {
            let read = |file: &str| emps::read(&data.join(file), &rig);
            let recordings = match (read("emps_train.csv"), read("emps_pulses.csv")) {
                (Ok(train), Ok(pulses)) => [train, pulses],
                (Err(missing), _) | (_, Err(missing)) => return absent(missing),
            };
            let folder = prepare()?;
            let found = Spinner::during(quiet, |tell| emps::study(&rig, &recordings, tell))?;
            let (lead, folder) = emps_page(&found, folder)?;
            (lead, vec![found.table(), found.parameters(), found.second_half()], folder)
        }
        Which::Pendulum => {
            let file = data.join("single_pendulum_1kHz.csv");
            let recordings = match pendulum::read(&file, &rig) {
                Ok(recordings) => recordings,
                Err(missing) => return absent(missing),
            };
            let folder = prepare()?;
            let found = Spinner::during(quiet, |tell| pendulum::study(&rig, &recordings, tell))?;
            let (lead, folder) = pendulum_page(&found, folder)?;
            (lead, vec![found.table(), found.numbers()], folder)
        }
    };
    // What --json prints is what the folder holds.
    let json = fs::read_to_string(folder.join(STUDY_FILE))?;
    Ok(arguments.print.result(&json, || text(&lead, &tables, &folder))?)
}

/// The result for people.
fn text(lead: &str, tables: &[ResultsTable], folder: &Path) -> String {
    let tables = tables.iter().map(|table| words_and_numbers(&table.header, &table.rows));
    let tables: Vec<String> = tables.collect();
    format!(
        "{}\n{}\nWritten to {}; open {}\n",
        paragraph("", "", lead),
        tables.join("\n"),
        folder.display(),
        folder.join("index.html").display()
    )
}

impl From<Missing> for Failure {
    fn from(missing: Missing) -> Self {
        Failure::Input(vec![missing.to_string()])
    }
}
