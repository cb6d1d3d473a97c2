//! From recordings of a machine to the effects that its declared model lacks.
//!
//! * [`answer`]: the one way in, for any machine.
//! * [`sensed`]: any mechanism with the sensors that it has; [`record`]: the recordings that a rig would show;
//!   [`plan`]: what to record next; [`hardware`]: the studies of measured machines.
//! * The other folders are for a 3-RPR whose twelve columns are all there, beside [`sensed`]; [`outcome::calibrate`] is the
//!   whole way, and data pass through them in this order:
//!   * [`plausibility`] and `measured`: files in, what speaks against them, and what they say by themselves; nothing is repaired.
//!   * `values`: a [`model`] and its runs, where to start looking for values, and how these are found.
//!   * `rounds`: one effect after another, several hypotheses at once, until the residuals are white.
//!   * `results`: the whole way, its folder of results, and that of a prediction.
//!   * [`self_test`]: how often all of it is right.

pub mod answer;
pub mod hardware;
mod measured;
pub mod plan;
pub mod plausibility;
pub mod record;
mod results;
mod rounds;
pub mod self_test;
pub mod sensed;
mod values;

pub use measured::commands::LoggedCommands;
pub use measured::{commands, lens, rattle, recording, replica, spectrum, start};
pub use results::page::quantity;
pub use results::{evidence, outcome, predict, predicted, report, result};
pub use rounds::{beside, left, needed, screen, search, unnamed, way};
pub use values::{
    axes, baseline, candidates, errors, fit, instrument, least_squares, model, settle, whole,
};
