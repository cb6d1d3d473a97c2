//! From recordings of a machine to the effects that its declared model lacks.
//!
//! * [`answer`]: the one way in, for any machine.
//! * [`sensed`]: any mechanism with the sensors that it has; [`record`]: the recordings that a rig would show;
//!   [`plan`]: what to record next; [`hardware`]: the studies of measured machines.
//! * The files beside them are for a 3-RPR whose twelve columns are all there, beside [`sensed`]; [`outcome::calibrate`] is the
//!   whole way, and data pass in this order:
//!   * [`recording`], [`plausibility`], `mistaken`: files in, and everything that speaks against them; nothing is repaired.
//!   * [`rattle`]: two simulations a hair apart say whether the machine is chaotic, and how many replicas are averaged.
//!   * [`commands`], [`replica`]: the commands of a recording drive a model, and its sensors look at it.
//!   * [`lens`], `measured_dynamics`: the residuals (servo, closure, dynamics) of measured data under a model; [`model`] and [`baseline`]
//!     measure their bias on simulated recordings, [`spectrum`] and `draws` their noise by frequency.
//!   * [`start`]: the swing with which a recording begins.
//!   * [`candidates`], [`screen`], [`fit`], [`least_squares`], [`instrument`]: every effect at every joint, fitted to one
//!     run's residuals and judged on another's.
//!   * [`settle`], [`whole`], [`axes`]: values that agree with whole simulations.
//!   * [`search`], [`way`], [`beside`], [`left`]: one effect after another, several hypotheses at once, until the
//!     residuals are white.
//!   * [`needed`], [`evidence`], [`unnamed`]: effects that the model can do without, rivals that explain as much, and a table
//!     of forces for what no effect explains.
//!   * [`errors`], `summary`, [`report`], `charts`, `page`, [`result`]: the folder of results; [`predict`], [`predicted`]: that of a prediction.
//!   * [`self_test`]: how often all of it is right.

pub mod answer;
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
pub mod predicted;
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
