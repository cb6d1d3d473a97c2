//! The loop closed on any mechanism that a file describes, with the sensors that it has.
//!
//! [`recording`] reads what was measured; [`start`] puts the machine where a recording begins;
//! [`simulate`] shows what its sensors would have recorded; [`basis`] says how the machine moved, from what [`estimate`] prepares;
//! [`residual`] what that motion says against the model: laws of drives, closure, dynamics; [`baseline`] what
//! a right model leaves of them; [`fit`] and [`settle`] give a model its values, [`left`] says what it leaves;
//! [`search`] finds which effects are missing, by what `screen` finds promising, [`hypotheses`] simulates and `unseen`
//! tries where residuals are blind; `calm` what shows in a
//! rattle's size alone, `simpler` which of their values are needed, `rivals` what would explain as much in their place; [`outcome`] is the
//! whole way, [`report`] what is written of it. [`self_test`] says how often it is right.

pub mod baseline;
pub mod basis;
mod calm;
pub mod candidates;
mod cells;
mod certainty;
pub(in crate::calibrate) mod charts;
pub mod errors;
pub mod estimate;
pub mod events;
pub mod fit;
mod followed;
mod heads;
pub mod held;
pub mod hypotheses;
pub mod left;
pub mod limits;
mod linear;
mod motions;
pub mod noise;
mod other_laws;
pub mod outcome;
mod page;
mod periodic;
pub mod predict;
pub(in crate::calibrate) mod prepare;
pub mod problem;
pub mod recording;
pub mod released;
pub mod report;
pub mod residual;
mod rivals;
mod samples;
mod screen;
pub mod search;
pub mod self_test;
pub mod settle;
mod shown;
mod simpler;
pub mod simulate;
mod simulated;
pub mod start;
pub mod thresholds;
pub mod trajectory;
pub mod unnamed;
mod unseen;
mod whole;
pub mod windows;

pub use prepare::prepare;
pub use report::into_folder;
