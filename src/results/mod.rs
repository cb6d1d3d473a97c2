//! Folders of results, whatever they are results of: each appears whole or not at all, holds the scenario that repeats it and a
//! page, and says beforehand how long it will take.

mod files;
mod folder;
mod forecast;
mod run_error;

pub(crate) use files::{
    PAGE_FILE, PLAYER_FILE, SCENARIO_FILE, keep_scenario, scenario_files, to_json,
};
pub(crate) use folder::sync;
pub use folder::{Folder, FolderError, abandon, default_name};
pub(crate) use forecast::Beginning;
pub use forecast::Forecast;
pub use run_error::RunError;
pub(crate) use run_error::refused;
