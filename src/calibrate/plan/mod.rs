//! What to record next: a motion that tells rivals apart, or shows an effect, as well as the machine's limits allow.
//!
//! [`prepare`](prepare::prepare) reads what is asked and within which limits. In `motions`, [`series`] and [`motion`] make motions
//! out of numbers, which [`search`] finds, `present` takes the present one for a candidate, a [`course`] is either of one drive, and
//! [`path`] says whether the machine can follow them, within its [`limits`]. In `questions`, [`asked`] is what is to be known,
//! [`sight`] what a calibration would see along a motion, [`separation`] how far apart models are there, [`answer`] what that says to a
//! question, [`instruments`] what one more sensor would bring. `posing` gives questions their numbers, `chosen` looks at the best
//! motions with clearance; [`outcome`] is the whole way, [`report`] and `page` what is said of it, `written` the folder that it
//! goes into.

mod chosen;
mod motions;
pub mod outcome;
mod page;
mod posing;
pub mod prepare;
mod questions;
pub mod report;
mod written;

pub use motions::{course, limits, motion, path, search, series};
pub use questions::{answer, asked, instruments, separation, sight};

pub use prepare::{PlanRequest, PreparedPlan, prepare};
pub use report::{PLAN_FILE, Planned};
pub use written::{FinishedPlan, into_folder};
