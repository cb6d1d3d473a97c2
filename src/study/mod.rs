//! What users come for: a run with all its files, what can be said of a scenario without one, many runs
//! at once, and the paper's study.

pub mod chaos;
mod check;
pub mod compare;
pub mod diff;
pub mod evaluate;
mod film;
mod folder;
mod forecast;
pub mod laws;
pub mod paper;
mod pictures;
mod recent;
mod run;
mod run_page;
pub mod sweep;
pub mod wear;

pub use check::{
    Check, CheckedBody, CheckedJoint, CheckedLeg, CheckedMachine, Engines, Found, Ideal, check,
};
pub use folder::{Folder, FolderError, abandon, default_name};
pub use forecast::{Forecast, Watch};
pub use run::{Outcome, Recorded, RunError, SUMMARY_FILE, Terms, recorded, run};
pub(crate) use run::{PAGE_FILE, refused};
