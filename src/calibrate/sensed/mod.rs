//! The loop closed on any mechanism that a file describes, with the sensors that it has. Data pass in this order:
//!
//! * [`recording`], `heads`, `samples`, `prepare`: files in, and everything that speaks against them (`followed`: machines
//!   that follow commands). [`start`], [`released`]: where a recording begins, driven or let go.
//! * [`simulate`], `simulated`, `motions`, `shown`: what sensors would have recorded, and along which commands.
//! * [`noise`]: noise other than declared. [`estimate`]: samples, smoothed as needed. [`basis`]: what says how the machine moved.
//! * [`residual`]: what that motion says against the model (laws of drives, closure, dynamics, acceleration); [`baseline`]:
//!   what a right model leaves of them, bias and noise.
//! * [`candidates`], `periodic`: where to start looking. [`model`]: effects with values. [`fit`], [`settle`]: these values,
//!   between residuals and simulations. [`left`]: what a model leaves; `by_chance`: how far chance alone leads.
//! * [`search`]: one effect after another, several hypotheses at once, in a [`round`] each; `screen`, `linear`: which promise, and
//!   what chance makes of them; `hypotheses`: those simulated; `unseen`, `other_laws`, `calm`: what residuals hardly see.
//! * `simpler`: which values are needed; `certainty`: how well they are known; `rivals`: what would explain as much, and
//!   what still stands out (`rest`). `whole`, [`trajectory`]: values from whole simulations and predictions.
//! * [`outcome`] is the whole way; [`errors`], [`limits`], [`report`], `charts`, `page`, `words` what is said of it, `written` its
//!   files, `ways` how each of three ways comes to them; [`predict`] holds a model against one recording. [`events`] finds what
//!   does not last, [`unnamed`] describes what has no name.
//! * [`windows`]: machines that nothing holds; [`held`]: those that sampled controllers hold. [`self_test`] says how often it is
//!   right. Every number that was chosen stands in [`thresholds`] with its reason.

pub mod baseline;
pub mod basis;
mod by_chance;
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
mod hypotheses;
pub mod left;
pub mod limits;
mod linear;
pub mod model;
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
mod rest;
mod rivals;
pub mod round;
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
pub(in crate::calibrate) mod ways;
mod whole;
pub mod windows;
mod words;
pub(in crate::calibrate) mod written;

pub use prepare::prepare;
pub use ways::into_folder;
