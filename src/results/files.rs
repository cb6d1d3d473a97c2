//! Files that results have, whatever they are results of: the scenario, the page, JSON.

use super::folder::Folder;
use super::run_error::{RunError, refused};
use crate::scenario::Scenario;
use serde::Serialize;
use std::fs;

/// The scenario, written out.
pub(crate) const SCENARIO_FILE: &str = "scenario.toml";
/// The page to look at first.
pub(crate) const PAGE_FILE: &str = "index.html";
/// The page that plays a run.
pub(crate) const PLAYER_FILE: &str = "player.html";

/// Names of what [`keep_scenario`] writes.
pub(crate) fn scenario_files(scenario: &Scenario) -> Vec<String> {
    let (_, files) = scenario.to_toml_beside_files();
    [SCENARIO_FILE.to_owned()].into_iter().chain(files.into_iter().map(|(_, name)| name)).collect()
}

/// Writes the scenario and copies of the tables that it reads: the result repeats wherever it lies.
pub(crate) fn keep_scenario(scenario: &Scenario, folder: &Folder) -> Result<(), RunError> {
    let (text, files) = scenario.to_toml_beside_files();
    for (source, name) in &files {
        fs::copy(source, folder.file(name)).map_err(refused(name))?;
    }
    fs::write(folder.file(SCENARIO_FILE), text).map_err(refused(SCENARIO_FILE))
}

/// Pretty JSON with a line break at the end.
pub(crate) fn to_json(result: &impl Serialize) -> String {
    // No input makes this fail: results have only names for keys, and NaN becomes null.
    let text = serde_json::to_string_pretty(result).expect("numbers, texts and lists are JSON");
    text + "\n"
}
