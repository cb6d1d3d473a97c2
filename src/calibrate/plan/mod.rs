//! What to record next: a motion that tells rivals apart, or shows an effect, as well as the machine's limits allow.
//!
//! [`prepare`](prepare::prepare) reads what is asked ([`asked`]) and within which [`limits`]; [`series`] and [`motion`] make
//! motions out of numbers, `present` takes the present one for a candidate, a [`course`] is either of one drive; [`path`] says
//! whether the machine can follow them; [`sight`] is what a calibration would see along one, [`separation`] how far apart models
//! are there, [`answer`] what that says to a question; `posing` gives questions their numbers, [`search`] finds those of motions, `chosen` looks at the best with clearance;
//! [`outcome`] is the whole way, [`instruments`] what one more sensor would bring, [`report`] and `page` what is said of it,
//! `written` the folder that it goes into.

pub mod answer;
pub mod asked;
mod chosen;
pub mod course;
pub mod instruments;
pub mod limits;
pub mod motion;
pub mod outcome;
mod page;
pub mod path;
mod posing;
pub mod prepare;
mod present;
pub mod report;
pub mod search;
pub mod separation;
pub mod series;
pub mod sight;
mod written;

pub use prepare::{Prepared, Request, prepare};
pub use report::{PLAN_FILE, Planned};
pub use written::{Done, into_folder};
