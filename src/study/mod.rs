//! What users come for: a run with all its files, what can be said of a scenario without one, many runs
//! at once, and the paper's study.

pub mod chaos;
mod check;
pub mod compare;
pub mod diff;
pub mod evaluate;
mod film;
pub mod laws;
pub mod paper;
mod pictures;
mod recent;
mod run;
mod run_page;
mod study_error;
pub mod sweep;
mod watch;
pub mod wear;

pub use check::{
    Check, CheckedBody, CheckedJoint, CheckedLeg, CheckedMachine, Engines, FindingText, IdealNeeds,
    check,
};
pub use run::{Recorded, RunOutcome, SUMMARY_FILE, Terms, recorded, run};
pub use study_error::StudyError;
pub use watch::Watch;
