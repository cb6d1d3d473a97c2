//! Calibration of machines that nothing holds: without clearance, free or driven by efforts alone.
//!
//! Whole runs of such machines cannot be simulated: their starts are unknown, and errors grow. [`window`] cuts
//! runs into windows and fits the start in each; [`roll`] moves a machine along one; [`shooting`] fits values of
//! effects, zeros of runs and starts together; [`sought`] says which values; [`fits`] goes from
//! short windows to long ones, and [`eliminate`] leaves out what is not certain; [`score`] by how much predictions
//! miss; [`plausible`] refuses recordings that cannot be right; [`outcome`] is the whole way, [`predict`] that of
//! a prediction; [`report`] is what is written, [`horizons`] what it says of windows. `fitting` holds all that fits.

mod fitting;
pub mod horizons;
pub mod outcome;
pub mod plausible;
pub mod predict;
pub mod report;
pub mod score;

pub use fitting::{bench, eliminate, fits, inputs, pose, roll, shooting, sought, window};
