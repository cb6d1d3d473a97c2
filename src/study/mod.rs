//! What users come for: a run with all its files, and what can be said of a scenario without one.

mod check;
mod folder;
mod pictures;
mod recent;
mod run;
mod run_page;

pub use check::{
    Check, CheckedBody, CheckedJoint, CheckedLeg, CheckedMachine, Found, Ideal, check,
};
pub use folder::{Folder, FolderError, default_name};
pub use run::{Outcome, RunError, SUMMARY_FILE, run};
