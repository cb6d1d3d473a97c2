//! Motions of drives that are made of numbers, within the machine's limits, and the search for these numbers.

pub mod course;
pub mod limits;
pub mod motion;
pub mod path;
pub(super) mod present;
pub mod search;
pub mod series;
