//! From a recorded run to the effect that the model lacks: [`outcome::calibrate`] is the method. Around it:
//! [`recording`] and [`plausibility`] take files and refuse what cannot be right, [`rattle`] decides how often
//! to simulate, [`result`] and [`predict`] write folders of results; [`record`] makes the recordings that a rig
//! would show; [`plan`] says what to record next.

pub mod axes;
pub mod baseline;
pub mod beside;
pub mod candidates;
mod charts;
pub mod commands;
mod draws;
pub mod errors;
pub mod evidence;
pub mod fit;
pub mod hardware;
pub mod instrument;
pub mod least_squares;
pub mod left;
pub mod lens;
mod measured_dynamics;
mod mistaken;
pub mod model;
pub mod needed;
pub mod outcome;
mod page;
pub mod plan;
pub mod plausibility;
pub mod predict;
mod predict_page;
pub mod rattle;
pub mod record;
pub mod recording;
pub mod replica;
pub mod report;
pub mod result;
pub mod screen;
pub mod search;
pub mod self_test;
pub mod sensed;
pub mod settle;
pub mod spectrum;
pub mod start;
mod summary;
pub mod unnamed;
mod unnamed_picture;
pub mod way;
pub mod whole;

pub use commands::LoggedCommands;
pub use page::quantity;
