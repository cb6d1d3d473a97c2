//! What users come for: a run with all its files, what can be said of a scenario without one, many runs
//! at once, and the paper's study.

pub mod chaos;
mod check;
pub mod compare;
pub mod diff;
pub mod evaluate;
mod files;
mod film;
mod folder;
mod forecast;
pub mod laws;
pub mod paper;
mod pictures;
mod recent;
mod run;
mod run_error;
mod run_page;
pub mod sweep;
mod watch;
pub mod wear;

pub use check::{
    Check, CheckedBody, CheckedJoint, CheckedLeg, CheckedMachine, Engines, FindingText, IdealNeeds,
    check,
};
pub(crate) use files::PAGE_FILE;
pub use folder::{Folder, FolderError, abandon, default_name};
pub use forecast::Forecast;
pub use run::{Recorded, RunOutcome, SUMMARY_FILE, Terms, recorded, run};
pub use run_error::RunError;
pub(crate) use run_error::refused;
pub use watch::Watch;
