//! Machines of one joint, the drive stage and the pendulum, against recordings of them: a recording in
//! its own columns, what a model predicts of it, and a calibration.

mod arm;
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
pub use simulated::{Machine, read};
