//! The drive stage against recordings of it: a recording in its own columns, what a model predicts of it, and a
//! calibration by its inverse model.

mod calibration;
mod charts;
mod drawn;
mod noise;
mod prediction;
mod rows;
mod simulated;
mod stage;

pub use calibration::{Adjusted, Calibrated, Prepared, into_folder, prepare};
pub use prediction::{Predicted, predict};
pub use simulated::read;
