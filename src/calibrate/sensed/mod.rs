//! The loop closed on any mechanism that a file describes, with the sensors that it has.
//!
//! [`recording`] reads what was measured; [`start`] puts the machine where a recording begins;
//! [`simulate`] shows what its sensors would have recorded; [`basis`] says how the machine moved, from what [`estimate`] prepares;
//! [`residual`] what that motion says against the model: laws of drives, closure, dynamics; [`baseline`] what
//! a right model leaves of them; [`fit`] and [`search`] find which effects are missing, [`calm`] what shows in a
//! rattle's size alone, [`simpler`] which of their values are needed; [`outcome`] is the
//! whole way, [`report`] what is written of it.

pub mod baseline;
pub mod basis;
mod calm;
pub mod candidates;
pub mod errors;
pub mod estimate;
pub mod fit;
pub mod limits;
pub mod noise;
pub mod outcome;
mod page;
pub mod problem;
pub mod recording;
pub mod report;
pub mod residual;
pub mod search;
mod simpler;
pub mod simulate;
pub mod start;
pub mod thresholds;
pub mod trajectory;
pub mod unnamed;
pub mod windows;

pub use report::{into_folder, prepare};
