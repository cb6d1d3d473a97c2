//! The loop closed on any mechanism that a file describes, with the sensors that it has.
//!
//! [`recording`] reads what was measured; [`start`] puts the machine where a recording begins;
//! [`simulate`] shows what its sensors would have recorded; [`estimate`] says how the machine moved;
//! [`residual`] what that motion says against the model: laws of drives, closure, dynamics; [`baseline`] what
//! a right model leaves of them; [`fit`] and [`search`] find which effects are missing; [`outcome`] is the
//! whole way, [`report`] what is written of it.

pub mod baseline;
pub mod candidates;
pub mod errors;
pub mod estimate;
pub mod fit;
pub mod outcome;
mod page;
pub mod problem;
pub mod recording;
pub mod report;
pub mod residual;
pub mod search;
pub mod simulate;
pub mod start;
pub mod thresholds;
pub mod trajectory;
pub mod windows;

pub use report::{into_folder, prepare};
