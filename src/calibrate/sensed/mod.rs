//! The loop closed on any mechanism that a file describes, with the sensors that it has. Data pass through these folders in this
//! order; each lists its files:
//!
//! * `recorded`: files of recordings, their columns, rows and samples.
//! * `motion`: how the recorded machine moved, and what its sensors would have recorded.
//! * `residuals`: a rig and its runs ([`problem`]), and what these say against a model.
//! * `intake`: from files to a problem: everything that speaks against them.
//! * `values`: models, their values by residuals and by whole simulations, and how well they are known.
//! * `rounds`: one effect after another, several hypotheses at once.
//! * `judged`: what a model leaves, which values it needs, what would explain as much.
//! * `results`: [`outcome`], the whole way, and what is written of it.
//!
//! [`events`] finds what does not last. [`windows`]: machines that nothing holds; [`held`]: those that sampled controllers hold.
//! [`self_test`] says how often it is right. Every number that was chosen stands in [`thresholds`] with its reason.

pub mod events;
pub mod held;
mod intake;
mod judged;
mod motion;
mod recorded;
mod residuals;
mod results;
mod rounds;
pub mod self_test;
pub mod thresholds;
mod values;
pub mod windows;

pub use intake::noise;
pub(in crate::calibrate) use intake::prepare;
pub use intake::prepare::prepare;
pub use judged::{left, limits, unnamed};
pub use motion::{basis, released, simulate, start};
pub use recorded::{recording, view};
pub use residuals::{baseline, problem, residual};
pub(in crate::calibrate) use results::charts;
pub use results::ways::into_folder;
pub use results::{outcome, predict, report};
pub use rounds::{round, search, settle};
pub use values::{candidates, errors, fit, model, trajectory};
