//! From recordings of a machine to the effects that its declared model lacks.
//!
//! * [`sensed`]: any mechanism with the sensors that it has, from [`sensed::prepare()`] to [`sensed::into_folder`]; [`record`]: the recordings that a rig would show;
//!   [`plan`]: what to record next; [`hardware`]: the studies of measured machines.
//! * `values` and `results`: the numbers and the files that all of them share.

pub mod hardware;
pub mod plan;
pub mod record;
mod results;
pub mod sensed;
mod values;

pub use results::page::quantity;
pub use results::{predicted, report, result, verdict};
pub use values::{draws, errors, instrument, least_squares, spectrum};
